"""Time integrators as numbers, one a file, each a :class:`~fe_contact.dynamics.schemes.base.Family`."""
