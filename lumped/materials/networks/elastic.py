"""A spring."""

from lumped.materials.networks.base import Modulus, Network
from lumped.materials.relaxation import Relaxation


def of(E: Modulus) -> Relaxation:
    """sigma = E epsilon."""
    return Relaxation(E)


MEMBER = Network((of,))
