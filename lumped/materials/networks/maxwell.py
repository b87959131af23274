"""A spring and a dashpot in a row: a fluid."""

from lumped.materials.networks.base import Modulus, Network, Viscosity
from lumped.materials.relaxation import Relaxation


def of(E: Modulus, eta: Viscosity) -> Relaxation:
    """E(t) = E exp(-t E/eta)."""
    return Relaxation(0.0, (E,), (eta / E,))


MEMBER = Network((of,))
