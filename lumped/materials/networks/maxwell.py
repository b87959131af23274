"""A spring and a dashpot in a row: a fluid."""

from lumped.materials.networks._ranges import MODULUS, VISCOSITY
from lumped.materials.relaxation import Relaxation

KEYS = ({"E": MODULUS, "eta": VISCOSITY},)


def of(E: float, eta: float) -> Relaxation:
    """E(t) = E exp(-t E/eta)."""
    return Relaxation(0.0, (E,), (eta / E,))
