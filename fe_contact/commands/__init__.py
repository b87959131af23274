"""The commands of ``fe-contact``, one a file: each offers ``SUMMARY``, ``arguments(parser)``, ``execute(args)``.

``execute`` returns the exit code 0 or 3 and raises named failures for the others. What several commands
share is in ``base.py``.
"""
