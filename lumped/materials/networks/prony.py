"""A Prony series: a spring beside Maxwell elements, and a dashpot beside them all if `eta` is given."""

from dataclasses import replace

from lumped.keys import Numbers
from lumped.materials.networks._ranges import MODULUS_OR_ZERO, TIME, VISCOSITY
from lumped.materials.relaxation import Relaxation

KEYS = (
    {
        "E_inf": MODULUS_OR_ZERO,
        "E": Numbers(MODULUS_OR_ZERO, required=False),
        "tau": Numbers(TIME, required=False),
        "eta": replace(VISCOSITY, required=False),
    },
)


def of(E_inf: float, E: tuple[float, ...] = (), tau: tuple[float, ...] = (), eta: float = 0.0) -> Relaxation:
    """E(t) = E_inf + sum_k E_k exp(-t/tau_k) + eta dirac(t)."""
    if len(E) != len(tau):
        raise ValueError(f"E has {len(E)} values and tau has {len(tau)}; accepted: as many of one as of the other")
    if E_inf + sum(E) + eta <= 0.0:
        raise ValueError("E_inf, every E and eta are zero; accepted: at least one above zero")
    return Relaxation(E_inf, E, tau, eta)
