"""Neo-Hooke with its volume apart: as Abaqus and CalculiX, C10 = mu/2, D1 = 2/kappa."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy, compression


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2."""
    return invariants.first_isochoric * (0.5 * shear) + compression(invariants, shear, lame)


MEMBER = StrainEnergy("mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2", density)
