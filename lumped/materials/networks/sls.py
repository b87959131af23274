"""The 3-parameter solid of the paper: a Kelvin-Voigt element (E1, C1) in a row with a spring E2, "(12)"."""

from lumped.materials.networks._ranges import MODULUS, TIME, VISCOSITY
from lumped.materials.relaxation import Relaxation
from lumped.schema.keys import Number

KEYS = (
    {"E1": MODULUS, "E2": MODULUS, "C1": VISCOSITY},
    {"E0": MODULUS, "R1": Number(1e-9, 1e9), "R2": TIME},
)


def of(**values: float) -> Relaxation:
    """E(t) = E0 (1 + R1 exp(-t/tau)), tau = R2/(1+R1), E0 = E1 E2/(E1+E2), R1 = E2/E1, R2 = C1/E1, "(25)"."""
    if "E0" in values:
        relaxed, ratio, retardation = values["E0"], values["R1"], values["R2"]
    else:
        spring, series = values["E1"], values["E2"]
        relaxed, ratio, retardation = (
            spring * series / (spring + series),
            series / spring,
            values["C1"] / spring,
        )
    return Relaxation(relaxed, (relaxed * ratio,), (retardation / (1.0 + ratio),))
