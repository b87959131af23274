"""Ranges which the networks share."""

from lumped.schema.keys import Number

MODULUS = Number(1e-3, 1e16, "Pa")
MODULUS_OR_ZERO = Number(0.0, 1e16, "Pa")
VISCOSITY = Number(1e-15, 1e25, "Pa s")
TIME = Number(1e-15, 1e15, "s")
