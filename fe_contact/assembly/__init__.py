"""Mesh and material to matrices: forms, surfaces and their quadrature, condensation, what stands for the infinite."""
