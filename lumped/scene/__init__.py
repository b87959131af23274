"""A scene: its tables and their reader, geometry, pairs of bodies, estimated scales."""
