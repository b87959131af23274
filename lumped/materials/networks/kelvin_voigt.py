"""A spring and a dashpot side by side."""

from lumped.materials.networks._ranges import MODULUS, VISCOSITY
from lumped.materials.relaxation import Relaxation

KEYS = ({"E": MODULUS, "eta": VISCOSITY},)


def of(E: float, eta: float) -> Relaxation:
    """sigma = E epsilon + eta depsilon/dt."""
    return Relaxation(E, viscosity=eta)
