"""What a run tells: quantities, contacts, fields, pressure, the surface that is left."""
