"""What exponent a reader gets from an impact's history of depth and force, and how far a bar of the force moves it.

Every reader but the first is a least-squares fit of a force law in which all is free, the exponent too: the law is
linear in its stiffnesses, which every trial of the rest finds at once. The histories are sampled evenly in time, as an
instrument does. Depths count in the greatest, times in the contact's.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fe_contact.assembly.forms import Array
from lumped.result.history import History

ALPHA = 1.5  # guess of every exponent: Hertz's
SAMPLES = 201  # of a history, at both ends of the contact too
FIRST = 0.1  # share of the greatest depth from which the logarithms are fitted: below it a bar of force is all
# Guesses: relaxation times over the contact's, and what share of the modulus is lost within it.
SOLIDS = ((0.05, 0.5), (0.3, 0.5), (3.0, 0.1), (30.0, 0.01))
DIFFERENCE = 1e-6  # of a free number, for slopes: the force errs by rounding alone
BETWEEN = 1e-7  # rounding: of a force between rows that lie densely, over its peak or in the norm
SEARCH = 1e-12  # tolerance of a search: rounding
RANK = 1e-7  # share of the largest singular value below which a direction is one that nothing tells
SAFETY = 1.5  # safety: of slopes at a fit that leaves residuals, which its curvature changes; of a rule's change
FARTHEST = 9.0  # safety: logarithm, of either sign, of a relaxation time over the contact's: elastic beyond
MOST_LOST = 0.999  # safety: share of the modulus that may be lost within the contact


@dataclass(frozen=True, eq=False)
class Samples:
    """A contact at even times: `depth` over the greatest, its `rate` per contact time, `force` and the half-width
    `error` of its bar over the peak, all of shape (n,); `bar`: the same in the norm of the history over the force's.

    `factor`: the elastic load at each depth over a power of it, 1 on a half-space, as who knows the thickness knows.
    `inertia`: peak force over what stops the mass within the depth in the contact time.
    """

    depth: Array
    rate: Array
    force: Array
    error: Array
    factor: Array
    bar: float
    inertia: float

    @classmethod
    def of(cls, history: History, bar: float, mass: float, factor: Callable[[Array], Array]) -> Samples:
        """Of one impact of a free mass, kg, known to `bar`; `factor` maps depths, m, to that of the load."""
        # what samples need is imported with the first ones
        from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

        rows = np.append(np.diff(history.time) > 0.0, True)
        time, duration = history.time[rows], history.time[-1] - history.time[0]
        at = np.linspace(time[0], time[-1], SAMPLES)
        course = CubicHermiteSpline(time, history.depth[rows], history.velocity[rows])
        rise = PchipInterpolator(time, history.force[rows])
        depth, force = np.maximum(course(at), 0.0), np.maximum(rise(at), 0.0)
        deepest, peak = depth.max(), force.max()
        return cls(
            depth / deepest,
            course(at, 1) * duration / deepest,
            force / peak,
            np.interp(at, time, history.force_error[rows]) / peak + BETWEEN,
            factor(depth),
            bar + BETWEEN,
            float(peak * duration**2 / (mass * deepest)),
        )

    @cached_property
    def turn(self) -> int:
        """Which sample is the deepest."""
        return int(self.depth.argmax())

    @cached_property
    def time(self) -> Array:
        """Over the contact's, shape (n,)."""
        return np.linspace(0.0, 1.0, self.depth.size)

    @property
    def half(self) -> Samples:
        """Every second sample."""
        columns = {name: getattr(self, name)[::2] for name in ("depth", "rate", "force", "error", "factor")}
        return replace(self, **columns)

    def load(self, alpha: float) -> Array:
        """The elastic load at every depth."""
        return np.where(self.depth > 0.0, self.factor * np.maximum(self.depth, 1e-300) ** alpha, 0.0)

    @property
    def of_half_space(self) -> Samples:
        """What a reader who knows of no thickness takes it for."""
        return replace(self, factor=np.ones_like(self.factor))

    def moved(self, answer: Array, alpha: float) -> float:
        """How far the bar moves an exponent `alpha` that answers so to the forces, shape (n,).

        A force that is off puts the depth off, too, whose load then is: by alpha F/depth. Both bars
        of the force hold, each is off in its own worst shape: the smaller result counts.
        """
        earlier = np.maximum(self.time[:, None] - self.time, 0.0) * self.time[1]
        slope = alpha * self.force / np.maximum(self.depth, FIRST)
        whole = answer + self.inertia * (answer * slope) @ earlier
        in_norm = np.linalg.norm(whole) * self.bar * np.linalg.norm(self.force)
        return float(min(in_norm, np.abs(whole) @ self.error))


@dataclass(frozen=True)
class ReadExponent:
    """An exponent, and how far the history's bar and the reader's own rule can move it."""

    exponent: float
    error: float


Reader = Callable[[Samples], ReadExponent]  # one way to read an exponent
ForceLaw = Callable[[Array], Array]  # of what is free, the exponent first: the columns that the stiffnesses share


def log_log(samples: Samples) -> ReadExponent:
    """The slope of ln F over ln depth while the depth grows."""
    loading = np.flatnonzero((samples.depth >= FIRST) & (np.arange(samples.depth.size) <= samples.turn))
    depth, force = np.log(samples.depth[loading]), np.log(samples.force[loading])
    weights = (depth - depth.mean()) / np.sum((depth - depth.mean()) ** 2)
    answer = np.zeros_like(samples.force)
    answer[loading] = weights / samples.force[loading]
    alpha = float(weights @ force)
    return ReadExponent(alpha, samples.moved(answer, alpha))


def hunt_crossley(samples: Samples) -> ReadExponent:
    """F = k depth^alpha (1 + chi rate), doi 10.1115/1.3423596, fitted to depth, rate and force."""

    def law(free: Array) -> Array:
        load = samples.load(free[0])
        return np.column_stack([load, load * samples.rate])

    return _fitted(law, samples, [np.array([ALPHA])])


def correspondence(samples: Samples) -> ReadExponent:
    """F = int E(t-s) d(depth^alpha), "(17)" to "(19)", of a 3-parameter solid, fitted to depth and force over time."""

    def law_of(some: Samples) -> ForceLaw:
        def law(free: Array) -> Array:
            load = some.load(free[0])
            return np.column_stack([load, _means(some.time, _relaxation(free[1])) @ np.diff(load)])

        return law

    return _with_rule(law_of, samples, [np.array([ALPHA, np.log(time)]) for time, _ in SOLIDS])


def ting(samples: Samples) -> ReadExponent:
    """The same, but in the rebound as Ting 1966 has it, doi 10.1115/1.3625192: exact on a half-space.

    F = int_0^t1 E(t-s) d(depth^alpha), where int_t1^t E(t-s) d(depth) = 0: t1 <= t had the contact radius of now. The
    depth being measured, the exponent does not tell t1, the material does.
    """

    def law_of(some: Samples) -> ForceLaw:
        def law(free: Array) -> Array:
            time, lost = _relaxation(free[1]), MOST_LOST * np.tanh(free[2])
            return _ting_force(some, free[0], time, lost / -np.expm1(-1.0 / time))[:, None]

        return law

    return _with_rule(law_of, samples, [np.array([ALPHA, np.log(time), lost]) for time, lost in SOLIDS])


def _ting_force(samples: Samples, alpha: float, time: float, loss: float) -> Array:
    """F over E(0+), for E(t)/E(0+) = 1 - loss + loss exp(-t/time); shape (n,).

    A depth, not a time, is what t1 is found by, so that elastic contact is exact at any number of samples.
    """
    turn = samples.turn
    modulus = np.tri(samples.depth.size, samples.depth.size - 1, -1) * (1.0 - loss)
    modulus += loss * _means(samples.time, time)
    depth, load = samples.depth, samples.load(alpha)
    steps, rises = np.diff(depth), np.diff(load)
    force = np.tril(modulus, -1) @ rises
    done = modulus[turn + 1 :]  # rows: times of the rebound; columns: intervals before them
    since = np.cumsum((done * steps)[:, ::-1], axis=1)[:, ::-1][:, :turn]  # int E d(depth) from an interval on
    last = np.count_nonzero(since >= 0.0, axis=1) - 1  # the interval of t1; none is left where contact is over
    row = np.arange(last.size)
    held = np.maximum(last, 0)
    there = depth[held] + since[row, held] / done[row, held]
    share = (there - depth[held]) / steps[held]
    factor = samples.factor[held] + share * np.diff(samples.factor)[held]
    until = np.cumsum(done * rises, axis=1) - done * rises
    rest = done[row, held] * (factor * np.maximum(there, 0.0) ** alpha - load[held])
    force[turn + 1 :] = np.where(last < 0, 0.0, until[row, held] + rest)
    return np.asarray(force)


def _means(time: Array, relaxation: float) -> Array:
    """The mean of exp(-(t-s)/relaxation) over every interval of s before every t, shape (n, n - 1)."""
    left = (time[:, None] - time[None, :]) / relaxation
    fading = np.exp(-np.maximum(left, 0.0)) * (left >= 0.0)
    means = np.diff(fading, axis=1) * (relaxation / (time[1] - time[0]))
    return np.tril(means, -1)


def _relaxation(logarithm: float) -> float:
    """A relaxation time over the contact's, held where a search may go."""
    return float(np.exp(min(max(logarithm, -FARTHEST), FARTHEST)))


def _with_rule(law_of: Callable[[Samples], ForceLaw], samples: Samples, starts: Sequence[Array]) -> ReadExponent:
    """Of the best of all starts on half the samples; in the bar, what half and a quarter of them change.

    The rule is of second order, but of first where the solid relaxes between two samples: then the change is the error
    itself. The smallest set counts lest the larger two err alike by chance.
    """
    half, quarter = samples.half, samples.half.half
    rough = _nearest(law_of(half), half, starts)
    coarse = _nearest(law_of(quarter), quarter, [rough])
    found = _fitted(law_of(samples), samples, [rough])
    changes = abs(found.exponent - rough[0]), 0.25 * abs(rough[0] - coarse[0])
    return ReadExponent(found.exponent, found.error + SAFETY * float(max(changes)))


def _fitted(law: ForceLaw, samples: Samples, starts: Sequence[Array]) -> ReadExponent:
    """The best fit, and how far the history's bar moves its exponent."""
    free = _nearest(law, samples, starts)
    columns, steps = law(free), DIFFERENCE * np.eye(free.size)
    shares = np.linalg.lstsq(columns, samples.force, rcond=None)[0]
    slopes = [(law(free + step) - law(free - step)) @ shares / (2.0 * DIFFERENCE) for step in steps]
    answer = np.linalg.pinv(np.column_stack([*slopes, columns]), rcond=RANK)[0]
    return ReadExponent(float(free[0]), SAFETY * samples.moved(answer, float(free[0])))


def _nearest(law: ForceLaw, samples: Samples, starts: Sequence[Array]) -> Array:
    """What is free, where the least squares end from the best of the starts."""
    # what a search needs is imported with the first one
    from scipy.optimize import least_squares

    search: Any = least_squares  # its stubs know only their own array shapes

    def off(free: Array) -> Array:
        columns = law(free)
        return np.asarray(columns @ np.linalg.lstsq(columns, samples.force, rcond=None)[0] - samples.force)

    ends = [search(off, start, method="lm", xtol=SEARCH, ftol=SEARCH) for start in starts]
    return np.asarray(min(ends, key=lambda end: float(end.cost)).x)
