"""Rings of polymer: study, verdict, files, chart."""
