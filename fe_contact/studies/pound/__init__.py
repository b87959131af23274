"""Frames that pound on each other: study, files, chart."""
