"""The 3-parameter solid of the paper: a Kelvin-Voigt element (E1, C1) in a row with a spring E2, "(12)"."""

from typing import Annotated

from lumped.materials.material import MODULUS
from lumped.materials.networks.base import TIME, VISCOSITY, Network
from lumped.materials.relaxation import Relaxation
from lumped.schema.keys import Key, Number


def of_springs(
    E1: Annotated[float, Key(MODULUS, "spring beside the dashpot")],
    E2: Annotated[float, Key(MODULUS, "spring in series with these two: the instantaneous modulus")],
    C1: Annotated[float, Key(VISCOSITY, "dashpot beside the spring E1")],
) -> Relaxation:
    """E0 = E1 E2/(E1+E2), R1 = E2/E1, R2 = C1/E1, "(25)"."""
    return of_ratios(E1 * E2 / (E1 + E2), E2 / E1, C1 / E1)


def of_ratios(
    E0: Annotated[float, Key(MODULUS, "equilibrium modulus: after a long time")],
    R1: Annotated[float, Key(Number(1e-9, 1e9), "E2 over E1: the instantaneous modulus is E0 (1 + R1)")],
    R2: Annotated[float, Key(TIME, "time of retardation C1/E1; that of relaxation is R2/(1 + R1)")],
) -> Relaxation:
    """E(t) = E0 (1 + R1 exp(-t/tau)), tau = R2/(1+R1), "(25)"."""
    return Relaxation(E0, (E0 * R1,), (R2 / (1.0 + R1),))


MEMBER = Network((of_springs, of_ratios))
