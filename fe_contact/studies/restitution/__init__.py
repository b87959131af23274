"""Restitution asked for against obtained: table, files, chart."""
