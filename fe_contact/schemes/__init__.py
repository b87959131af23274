"""Time integrators as numbers, one a file; the march is written once, in :mod:`fe_contact.march.impact`.

Within a step the surface displacement is linear in time, so every branch of the relaxation modulus is integrated
exactly. A member is a :class:`~fe_contact.schemes.base.MemoryScheme`.
"""
