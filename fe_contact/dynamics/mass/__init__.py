"""Ways to put an element's mass on its nodes, one a file, each a :class:`~fe_contact.dynamics.mass.base.Mass`."""
