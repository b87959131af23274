"""St Venant and Kirchhoff: linear in Green's strain, as codes take "linear elastic" with large displacements.

It softens in compression and is then no longer elliptic.
"""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """lambda/2 (tr E)^2 + mu E:E; with x = D + 2 (j - 1), 4 E:E = x^2 + 2 D - 2 (j - 1)^2 + (t^2 - 1)^2."""
    area = invariants.area + -1.0
    area = Jet(invariants.area_rise, area.first, area.second)
    rise = invariants.hoop_rise
    hoop = invariants.hoop.of(rise * (2.0 + rise), 2.0 * invariants.hoop.value, 2.0 + 0.0 * rise)
    plane = invariants.shape + 2.0 * area
    squares = plane * plane + 2.0 * invariants.shape - 2.0 * area * area + hoop * hoop
    trace = plane + hoop
    return squares * (0.25 * shear) + trace * trace * (0.125 * lame)


MEMBER = StrainEnergy("lambda/2 (tr E)^2 + mu E:E", density, splits=False, softens=True)
