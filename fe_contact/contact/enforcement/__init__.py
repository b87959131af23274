"""Ways to keep two surfaces apart, one a file, each an :class:`~fe_contact.contact.enforcement.base.Enforcement`."""
