"""Yeoh's cubic in the first invariant, with the volume apart: softer at moderate stretch, stiff at a large one."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy, compression

QUADRATIC, CUBIC = -0.02, 0.001  # physics: C20 and C30 over C10, about those of filled rubber; a choice of the suite


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """C10 (x - 0.02 x^2 + 0.001 x^3) + kappa/2 (J - 1)^2, x = J^(-2/3) I1 - 3, C10 = mu/2."""
    x = invariants.first_isochoric
    return (x + QUADRATIC * x * x + CUBIC * x * x * x) * (0.5 * shear) + compression(invariants, shear, lame)


MEMBER = StrainEnergy("mu/2 (x - 0.02 x^2 + 0.001 x^3) + kappa/2 (J - 1)^2, x = J^(-2/3) I1 - 3", density)
