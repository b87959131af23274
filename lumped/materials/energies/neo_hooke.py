"""Neo-Hooke, compressible: as FElupe's NeoHookeCompressible, Bonet and Wood, Kratos."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2, with I1 - 3 = D + 2 (j - 1) + (t^2 - 1)."""
    area, hoop = invariants.area_rise, invariants.hoop_rise
    flat = invariants.area.of(area - invariants.log_area.value, area / (1.0 + area), (1.0 + area) ** -2)
    stretch = 0.5 * hoop * (2.0 + hoop) - invariants.log_hoop.value
    out = invariants.hoop.of(stretch, hoop * (2.0 + hoop) / (1.0 + hoop), 1.0 + (1.0 + hoop) ** -2)
    return (0.5 * invariants.shape + flat + out) * shear + invariants.log_volume**2.0 * (0.5 * lame)


MEMBER = StrainEnergy("mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2", density, splits=False)
