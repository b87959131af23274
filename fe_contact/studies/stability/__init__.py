"""Where methods break, and why the defaults do not: maps over their settings, one study a file.

A study offers ``TITLE``; ``cases(quick)``, a list of settings, each a flat table; ``measure(case)``, the numbers of one
case, which may raise a named failure: that is a finding, not a crash; and ``CHART``, how its map is drawn.
"""
