"""A mass that strikes the end of an elastic rod, exactly: St Venant's waves and what they do to the striker."""
