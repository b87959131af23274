"""A spring and a dashpot side by side."""

from lumped.materials.networks.base import Modulus, Network, Viscosity
from lumped.materials.relaxation import Relaxation


def of(E: Modulus, eta: Viscosity) -> Relaxation:
    """sigma = E epsilon + eta depsilon/dt."""
    return Relaxation(E, viscosity=eta)


MEMBER = Network((of,))
