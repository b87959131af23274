"""Support and body of each target, one a file under the name it has in ``lumped.targets`` and ``meshes``.

A member is a :class:`~fe_contact.targets.base.MeshedTarget`.
"""
