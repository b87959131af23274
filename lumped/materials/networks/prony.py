"""A Prony series: a spring beside Maxwell elements, and a dashpot beside them all if `eta` is given.

A series fitted to another modulus may say how well: `fit_window`, s, and the relative deviations `fit_error` in it,
`fit_error_before` and `fit_error_after`.
"""

import math
from typing import Annotated

from lumped.materials.networks.base import MODULUS_OR_ZERO, TIME, Network, Viscosity
from lumped.materials.relaxation import Fidelity, Relaxation
from lumped.schema.keys import Key, Number, Numbers

NONE = 1e-100  # rounding: Pa, of a spring whose compliance would be no number: it counts as none
DEVIATION = Number(0.0, 1e6)
WINDOW = Numbers(TIME, most=2)


def of(
    E_inf: Annotated[float, Key(MODULUS_OR_ZERO, "modulus of the spring beside them all")],
    E: Annotated[tuple[float, ...], Key(Numbers(MODULUS_OR_ZERO), "moduli of the branches")] = (),
    tau: Annotated[tuple[float, ...], Key(Numbers(TIME), "their times of relaxation")] = (),
    eta: Viscosity = 0.0,
    fit_window: Annotated[tuple[float, ...], Key(WINDOW, "shortest and longest time of a fit")] = (),
    fit_error: Annotated[float | None, Key(DEVIATION, "relative deviation in the window")] = None,
    fit_error_before: Annotated[float, Key(DEVIATION, "relative deviation at shorter times")] = math.inf,
    fit_error_after: Annotated[float, Key(DEVIATION, "relative deviation at longer times")] = math.inf,
) -> Relaxation:
    """E(t) = E_inf + sum_k E_k exp(-t/tau_k) + eta dirac(t)."""
    if len(E) != len(tau):
        raise ValueError(f"E has {len(E)} values and tau has {len(tau)}; accepted: as many of one as of the other")
    lasting, *branches = (modulus if modulus >= NONE else 0.0 for modulus in (E_inf, *E))
    if lasting + sum(branches) + eta <= 0.0:
        raise ValueError("E_inf, every E and eta are zero; accepted: at least one above zero")
    fidelity = _fidelity(fit_window, fit_error, fit_error_before, fit_error_after)
    return Relaxation(lasting, tuple(branches), tau, eta, fidelity)


def _fidelity(window: tuple[float, ...], inside: float | None, before: float, after: float) -> Fidelity | None:
    """What the series says of its fit, None when nothing."""
    if not window and inside is None and before == after == math.inf:
        return None
    if inside is None or len(window) != 2 or window[0] > window[1]:
        raise ValueError("fit_window and fit_error belong together; accepted: fit_window = [shortest, longest] in s")
    return Fidelity((window[0], window[1]), inside, before, after)


MEMBER = Network((of,))
