"""Where methods break, and why the defaults do not: maps over their settings; a file a family of studies.

A member is a table of :class:`~fe_contact.studies.stability.base.MethodStudy` by the names of the files they write.
"""
