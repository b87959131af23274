"""The fractional Zener solid: a spring beside a spring and a springpot in a row, known by its E(s).

The Prony series that stands for it has a stated accuracy at times in `window`, s.
"""

from functools import cache
from typing import Annotated

import numpy as np

from lumped.errors import NotReached
from lumped.materials.laplace import Complex
from lumped.materials.material import MODULUS
from lumped.materials.networks.base import TIME, Network
from lumped.materials.prony_fit import of_operational
from lumped.materials.relaxation import Relaxation
from lumped.schema.keys import Key, Number, Numbers

# In units of tau: impacts far shorter or longer need a window of their own, and the model ledger says so.
WINDOW = (1e-6, 1e3)
ACCURACY = 1e-6  # default: relative deviation of the series from the law within the window


def of(
    E_inf: Annotated[float, Key(MODULUS, "equilibrium modulus: after a long time")],
    E_glass: Annotated[float, Key(MODULUS, "instantaneous modulus")],
    tau: Annotated[float, Key(TIME, "time of relaxation")],
    alpha: Annotated[float, Key(Number(0.05, 0.95), "order of the springpot")],
    window: Annotated[tuple[float, ...], Key(Numbers(TIME, most=2), "shortest and longest time to be right at")] = (),
    accuracy: Annotated[float, Key(Number(1e-8, 1e-2), "relative deviation allowed there")] = ACCURACY,
) -> Relaxation:
    """E(s) = E_inf + (E_glass - E_inf) (s tau)^alpha / (1 + (s tau)^alpha): E(t) is a Mittag-Leffler function.

    Bagley and Torvik 1983, doi 10.2514/3.8142. `window`, s, is by default 1e-6 to 1e3 tau. Raises ValueError when the
    series cannot be as accurate.
    """
    if E_glass <= E_inf:
        raise ValueError(f"E_glass = {E_glass:g} is not above E_inf = {E_inf:g}; accepted: E_glass > E_inf")
    if window and not (len(window) == 2 and window[0] < window[1]):
        raise ValueError("window is no interval; accepted: window = [shortest, longest] in s, shortest < longest")
    shortest, longest = window or (share * tau for share in WINDOW)
    try:
        return _series(E_inf, E_glass, tau, alpha, (shortest, longest), accuracy)
    except NotReached as error:
        raise ValueError(f"{error}; accepted: a looser accuracy or a shorter window") from error


@cache
def _series(
    E_inf: float, E_glass: float, tau: float, alpha: float, window: tuple[float, float], accuracy: float
) -> Relaxation:
    def operational(s: Complex) -> Complex:
        share = (s * tau) ** alpha
        return np.asarray(E_inf + (E_glass - E_inf) * share / (1.0 + share))

    return of_operational(operational, window, accuracy, relaxed=E_inf, glassy=E_glass).relaxation


MEMBER = Network((of,))
