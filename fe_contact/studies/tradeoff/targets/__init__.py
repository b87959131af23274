"""Trade-offs of impacts with inertia, one target a file under the name it has in ``fe_contact.waves.targets``.

A member is a :class:`~fe_contact.studies.tradeoff.tried.TriedTarget`.
"""
