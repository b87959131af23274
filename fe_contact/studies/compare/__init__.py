"""Finite elements against every law: study, verdict, files, chart."""
