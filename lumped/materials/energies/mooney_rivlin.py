"""Mooney and Rivlin with the volume apart; a fifth of the shear modulus by the second invariant, C01 = C10/4."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy, compression

SECOND = 0.2  # physics: share of the shear modulus by the second invariant, usual of rubber


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + kappa/2 (J - 1)^2, C10 = 0.4 mu, C01 = 0.1 mu."""
    first = invariants.first_isochoric * (0.5 * (1.0 - SECOND) * shear)
    return first + invariants.second_isochoric * (0.5 * SECOND * shear) + compression(invariants, shear, lame)


MEMBER = StrainEnergy("0.4 mu (J^(-2/3) I1 - 3) + 0.1 mu (J^(-4/3) I2 - 3) + kappa/2 (J - 1)^2", density)
