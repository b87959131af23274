"""Mesh and material to matrices: forms, surfaces and their quadrature, condensation, the far field."""
