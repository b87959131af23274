"""Slow indentation: its record, the exact load curves, whole spheres."""
