"""Kuwabara and Kono, Brilliantov and Poschel: F = k (depth^(3/2) + (3/2) A sqrt(depth) rate), a viscous sphere.

Doi 10.1143/JJAP.26.1230, doi 10.1103/PhysRevE.53.5382: a Kelvin-Voigt sphere whose relaxation is short beside the
contact. A in s. The force is that of Hertz at the depth which A later would be reached, to first order. With
`exit = "depth"` the damper pulls at the end. The restitution falls with the fifth root of the velocity.

It is damped by x = (3/2) A (k/m)^(2/5) v_0^(1/5), m the reduced mass. No closed form of e is known: the impact is
integrated, depth'' + depth^(3/2) + x sqrt(depth) depth' = 0 from depth = 0, depth' = 1, by Taylor series.

With depth = s^2 and the time dt = 2 s dtau it is polynomial, and smooth through touch, turn and exit:
    ds/dtau = v,  dv/dtau = -2 s^2 f,  f = s^2 + x v (the force is s f),  d lost/dtau = 4 x s^2 v^2,
where v^2 + (4/5) s^5 + lost = 1 balances the energy. Its Taylor series follow from products of series, and every
step goes as far as they hold to rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import mul
from typing import ClassVar, NamedTuple

import numpy as np

from lumped.errors import NotReached, TooManySteps
from lumped.laws._damping import Family, Limit, check, check_damping, decay_of, formulas
from lumped.laws._parameters import NO_KEYS, Parameters, damped, damping_key, stiffness_key
from lumped.laws._power_law import PowerLaw
from lumped.laws.base import LawKind
from lumped.numbers import Real, bisected
from lumped.scene.scene import Scene
from lumped.schema.keys import Number
from lumped.solvers.point.bodies import Stage

TOO_DAMPED = "; beyond it e is below 1e-6"
LIMITS = {"force": Limit(1e4, TOO_DAMPED), "depth": Limit(25.0, TOO_DAMPED)}
# e = 1 - C1 x + (3/5) C1^2 x^2 - ..., C1 = (4/5) (5/4)^(3/5) B(3/5, 3/2); doi 10.1103/PhysRevE.60.4465.
C1: float = 0.8 * 1.25**0.6 * math.gamma(0.6) * math.gamma(1.5) / math.gamma(2.1)
SERIES = Number(7.0 / 12.0, 1.0)
SHORT = ", above the minimum of the series of second order"
# e falls as x^-DECAY when x is large.
DECAY = {"force": 5.0 / 3.0, "depth": 5.0}
ITERATIONS = 30  # work: impacts tried until the damping meets e
LAST_STEP = 1e-10  # rounding: of the damping, relative: a smaller step ends the search
ORDER = 28  # of the Taylor series in time
# The step over the radius of convergence: SHARE^ORDER is below rounding.
SHARE = 0.25
# x = 0 leaves one term in five, so five of the last are read for the radius.
LAST_TERMS = range(ORDER - 4, ORDER + 1)
STEPS = 500  # work: Taylor steps of one contact
Series = list[float]


@dataclass(frozen=True, kw_only=True)
class KuwabaraKono(PowerLaw):
    """The law with k, N/m^(3/2), and A, s."""

    A: float
    alpha: float = 1.5
    name: ClassVar[str] = "kuwabara_kono"

    @property
    def tensile(self) -> bool:
        """By its damper."""
        return self.A > 0.0

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The spring's and the damper's."""
        return (1.5, 0.5)

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """(3/2) A k sqrt(depth) rate."""
        return 1.5 * self.A * self.k * np.sqrt(depth) * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """Its slopes."""
        strength, root = 1.5 * self.A * self.k, np.sqrt(depth)
        return 0.5 * strength * rate / root, strength * root


def of(scene: Scene) -> KuwabaraKono:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, KuwabaraKono.name)
    k = given.stiffness(1.5)
    kind, A = given.damping(("A",))
    if kind == "e":
        A = given.meeting(FAMILY, A) / (1.5 * (k / scene.reduced_mass) ** 0.4 * scene.velocity**0.2)
    return KuwabaraKono(k=k, A=A, **given.common())


def restitution(damping: float, exit: str = "force") -> float:
    """e at x, to rounding. Raises BadInput."""
    x = check_damping(damping, exit, LIMITS)
    return math.exp(-log_restitution(x, exit)) if x else 1.0


def damping(e: float, exit: str = "force") -> float:
    """The x which meets e, by secants. Raises BadInput, NotReached.

    With p the power of the decay, -ln e is nearly linear in X = p ln(1 + C1 x/p), and equals it to first order.
    """
    decay = decay_of(e, exit)
    power = DECAY[exit]
    last, last_decay, guess = 0.0, 0.0, decay
    for _ in range(ITERATIONS):
        x = power / C1 * math.expm1(guess / power)
        if abs(guess - last) <= LAST_STEP * guess:
            return x
        found = log_restitution(x, exit)
        step = (decay - found) * (guess - last) / (found - last_decay)
        last, last_decay, guess = guess, found, guess + step
    raise NotReached(f"no damping met e = {e:g} in {ITERATIONS} impacts")


def series(e: float) -> float:
    """x of 1 - C1 x + (3/5) C1^2 x^2 = e, from e = 7/12 on; raises BadInput below, where there is none."""
    check("e", e, SERIES, SHORT)
    return 2.0 * (1.0 - e) / (C1 * (1.0 + math.sqrt(max(1.0 - 2.4 * (1.0 - e), 0.0))))


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
    return bisected(lambda tau: _at(series, tau) > 0.0, 0.0, after)[1]


def _log_of_rebound(here: Expansion, end: float) -> float:
    """-ln of the speed: from the energy while the smaller part of it is lost, else from the speed itself."""
    missing = _at(here.lost, end) + 0.8 * math.pow(max(_at(here.s, end), 0.0), 5.0)
    return -0.5 * math.log1p(-missing) if missing < 0.5 else -math.log(-_at(here.v, end))


FAMILY = Family(restitution, damping, formulas(series=series))
KEYS = damped(FAMILY, damping_key("A", "s"), stiffness=stiffness_key("N/m^1.5"), exponent=NO_KEYS)
MEMBER = LawKind(of, __doc__, KEYS, FAMILY)
