"""A spring."""

from lumped.materials.networks._ranges import MODULUS
from lumped.materials.relaxation import Relaxation

KEYS = ({"E": MODULUS},)


def of(E: float) -> Relaxation:
    """sigma = E epsilon."""
    return Relaxation(E)
