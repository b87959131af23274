"""The pounding tuned mass damper: files, chart."""
