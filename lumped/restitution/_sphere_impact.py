"""The impact depth'' + depth^(3/2) + x sqrt(depth) depth' = 0 from depth = 0, depth' = 1, by Taylor series.

With depth = s^2 and the time dt = 2 s dtau it is polynomial, and smooth through touch, turn and exit:
    ds/dtau = v,  dv/dtau = -2 s^2 f,  f = s^2 + x v (the force is s f),  d lost/dtau = 4 x s^2 v^2,
where v^2 + (4/5) s^5 + lost = 1 balances the energy. Its Taylor series follow from products of series, and every
step goes as far as they hold to rounding.
"""

from __future__ import annotations

import math
from operator import mul
from typing import NamedTuple

from lumped.errors import TooManySteps

ORDER = 28
# The step over the radius of convergence: SHARE^ORDER is below rounding.
SHARE = 0.25
# x = 0 leaves one term in five, so five of the last are read for the radius.
LAST_TERMS = range(ORDER - 4, ORDER + 1)
STEPS = 500
HALVINGS = 54

Series = list[float]


class Expansion(NamedTuple):
    """Taylor coefficients in tau, each of length ORDER + 1."""

    s: Series
    v: Series
    f: Series
    lost: Series


def log_restitution(x: float, exit: str) -> float:
    """-ln e where the force ends (f = 0) or the depth does (s = 0), to rounding. Raises TooManySteps."""
    s, v, lost = 0.0, 1.0, 0.0
    for _ in range(STEPS):
        here = _expand(s, v, lost, x)
        step = _step(here)
        if end := _end(here, step, exit):
            return _log_of_rebound(here, end)
        s, v, lost = _at(here.s, step), _at(here.v, step), _at(here.lost, step)
    raise TooManySteps(f"the contact had not ended after {STEPS} Taylor steps at a damping of {x:g}")


def _expand(s: float, v: float, lost: float, x: float) -> Expansion:
    here, depth, square = Expansion([s], [v], [], [lost]), Series(), Series()
    for n in range(ORDER + 1):
        depth.append(_product(here.s, here.s))
        square.append(_product(here.v, here.v))
        here.f.append(depth[n] + x * here.v[n])
        if n < ORDER:
            here.s.append(here.v[n] / (n + 1))
            here.v.append(-2.0 * _product(depth, here.f) / (n + 1))
            here.lost.append(4.0 * x * _product(depth, square) / (n + 1))
    return here


def _product(one: Series, other: Series) -> float:
    """The last known coefficient of the product of two series."""
    return float(sum(map(mul, one, reversed(other))))


def _at(series: Series, step: float) -> float:
    value = 0.0
    for coefficient in reversed(series):
        value = value * step + coefficient
    return value


def _step(here: Expansion) -> float:
    size = max(abs(here.s[0]), abs(here.v[0]))
    largest = ((max(abs(here.s[j]), abs(here.v[j])), j) for j in LAST_TERMS)
    return SHARE * min(math.pow(size / term, 1.0 / j) for term, j in largest if term)


def _end(here: Expansion, step: float, exit: str) -> float:
    """tau of the exit when it lies within the step, else 0.

    At small x the force is negative for so short a while that both ends of a step can miss it: it is sought before
    the end of depth.
    """
    surfaced = _at(here.s, step) < 0.0
    if surfaced:
        step = _zero(here.s, step)
    if exit == "depth":
        return step if surfaced else 0.0
    return _zero(here.f, step) if surfaced or _at(here.f, step) < 0.0 else 0.0


def _zero(series: Series, after: float) -> float:
    """The change of sign, by halving, of what is positive at 0 and negative at `after`."""
    before = 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (before + after)
        if _at(series, middle) > 0.0:
            before = middle
        else:
            after = middle
    return after


def _log_of_rebound(here: Expansion, end: float) -> float:
    """-ln of the speed: from the energy while the smaller part of it is lost, else from the speed itself."""
    missing = _at(here.lost, end) + 0.8 * math.pow(max(_at(here.s, end), 0.0), 5.0)
    return -0.5 * math.log1p(-missing) if missing < 0.5 else -math.log(-_at(here.v, end))
