"""Scenes as input files of other programs: the case in numbers, and one program a file."""
