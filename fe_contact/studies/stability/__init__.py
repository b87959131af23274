"""Where methods break, and why the defaults do not: maps over their settings, one study a file.

A member is a :class:`~fe_contact.studies.stability.base.MethodStudy`.
"""
