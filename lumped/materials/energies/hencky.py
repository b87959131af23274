"""Hencky: linear in logarithmic strains."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy, log_difference_squared


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """mu |ln U|^2 + lambda/2 (ln J)^2, in the plane |ln U|^2 = (ln j)^2/2 + 2 b^2."""
    strain = invariants.log_area**2.0 * 0.5 + 2.0 * log_difference_squared(invariants) + invariants.log_hoop**2.0
    return strain * shear + invariants.log_volume**2.0 * (0.5 * lame)


MEMBER = StrainEnergy("mu dev(ln U):dev(ln U) + kappa/2 (ln J)^2", density)
