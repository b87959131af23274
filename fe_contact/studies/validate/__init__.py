"""The report of everything: a section a file, each of a study's own data, verdict, files and charts; one page."""
