"""Impacts with inertia, one target a file under the name it has in ``lumped.targets``.

A member is a :class:`~fe_contact.waves.targets.base.WaveTarget`.
"""
