"""A Prony series from a modulus known otherwise: as E(s), as samples of E(t), as storage and loss moduli.

The paper's general route (its Fig. 4): what a material is known by becomes a series, and a series goes into every law.

What is measured of a series, its decay over time or its answer to oscillations, is linear in its moduli; the discrete
spectrum that comes closest has non-negative weights at times found from the data.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault, NotReached
from lumped.materials.dynamic_moduli import DynamicModuli
from lumped.materials.laplace import Transform, relaxation_modulus
from lumped.materials.relaxation import Fidelity, Relaxation
from lumped.numbers import Array

# Candidate times a decade for data: finer than data can tell apart.
DENSE = 8.0
# Candidates reach so many decades beyond the window of the data: what relaxes outside is seen as its flank.
BEYOND_DATA = 0.5
BEYOND_WINDOW = 1.5  # the same decades for a known law in its window
# A series of log-spaced times errs as exp(-pi^2/h), h their distance in ln(time); Gauss-Newton needs fewer.
FEWEST, GROWTH, ROUNDS = 0.4, 1.25, 10
FITTED_A_DECADE, CHECKED_A_DECADE = 12, 100  # times a decade at which a series is fitted, and at which it is judged
# The largest deviation between the checked times exceeds that at them by less.
RIPPLE = 1.05
# A root mean square of this share of the tolerance is as good as none.
ENOUGH = 0.1
# The slowest term relaxes in the window by this share of the tolerance.
LAST = 0.1
# Inversion errs by some 1e-11 of the modulus.
LEAST_TOLERANCE = 1e-9
# exp(-x) is zero beyond.
FADED = 745.0
# Neighbouring candidates that both count stand for one time between them; a longer run is a continuous spectrum.
PAIR = 2
MOST_EVALUATIONS = 60  # work: of the misfit, in one search for relaxation times
ROUNDING = 1e-15  # rounding: relative changes below which that search ends
# A residual this much above the least is nearly as good; below EXACT all are.
NEARLY, EXACT = 1.02, 1e-13
# A term which nowhere changes the answer by this share of the largest residual, or of what is enough, is dropped.
NEGLIGIBLE = 1e-2


@dataclass(frozen=True)
class PronyFit:
    """A series and how far it is from what it was fitted to, relative to the modulus at each of `points`.

    Of dynamic moduli the deviation is that of the complex modulus relative to its magnitude.
    """

    relaxation: Relaxation
    max_error: float
    rms_error: float
    points: int


def of_operational(
    operational: Transform,
    window: tuple[float, float],
    tolerance: float = 1e-6,
    *,
    viscosity: float = 0.0,
    relaxed: float | None = None,
    glassy: float | None = None,
) -> PronyFit:
    """The series with few terms whose E(t) has this relative deviation at most at times in `window`, s.

    `operational` maps complex s, 1/s, to s L{E(t)}, Pa, shape kept, with the parallel `viscosity`, Pa s, in it.
    `relaxed` and `glassy`, Pa, are E at infinite and zero time without the viscosity: given, they are met too, and
    the deviation after and before the window is bounded. Raises BadInput, and NotReached when no series is as close.
    """
    _check(window, tolerance, relaxed, glassy)
    times, modulus, _ = _sampled(operational, window, FITTED_A_DECADE, viscosity, glassy)
    checked, truth, unsure = _sampled(operational, window, CHECKED_A_DECADE, viscosity, glassy)
    density, best = FEWEST * math.log(10.0) * math.log(2.0 / tolerance) / math.pi**2, math.inf
    for _ in range(ROUNDS):
        candidates = _candidates(*window, BEYOND_WINDOW, density)
        spectrum = fitted(Decay(modulus - (relaxed or 0.0), modulus, times), candidates, ENOUGH * tolerance)
        series = _relaxation(spectrum, viscosity, relaxed, last=window[1] / (LAST * tolerance))
        deviation = RIPPLE * np.abs(series(checked) / truth - 1.0) + unsure / truth
        best = min(best, float(deviation.max()))
        if best <= tolerance:
            return _told(series, deviation, window, *_outside(series, checked, truth, relaxed, glassy))
        density *= GROWTH
    raise NotReached(
        f"no Prony series of E(s) to {tolerance:g} over {window[0]:g} to {window[1]:g} s: {best:.2g} reached"
    )


def of_samples(times: ArrayLike, moduli: ArrayLike) -> PronyFit:
    """The series closest to samples E(t), Pa, at times t >= 0, s, relatively; both of shape (n,), n >= 2.

    Times may include zero and infinity. Raises BadInput for what is not positive, not finite, or of another shape.
    """
    t, values = np.asarray(times, dtype=float), np.asarray(moduli, dtype=float)
    inner = t[(t > 0.0) & np.isfinite(t)]
    if t.ndim != 1 or t.shape != values.shape or inner.size < 2 or np.isnan(t).any() or t.min() < 0.0:
        reason = "accepted: one-dimensional, as many as moduli, two or more above zero"
        raise BadInput(Fault("samples", "times", reason))
    if not np.all(np.isfinite(values)) or np.any(values <= 0.0):
        raise BadInput(Fault("samples", "moduli", "accepted: finite values above zero, in Pa"))
    spectrum = fitted(Decay(values, values, t), _candidates(inner.min(), inner.max(), BEYOND_DATA, DENSE))
    return _told(_relaxation(spectrum), np.abs(spectrum.residual), (inner.min(), inner.max()))


def of_dynamic(data: DynamicModuli, *, viscous: bool = False) -> PronyFit:
    """The series closest to storage and loss moduli, each residual relative to the magnitude of the modulus.

    `viscous` allows for a dashpot in parallel: an infinite modulus against a sudden strain, which data that end at some
    frequency cannot tell from a fast term. Times lie around the reciprocals of the measured frequencies.
    """
    magnitude = np.tile(np.abs(data.modulus), 2)
    shortest, longest = 1.0 / float(data.omega.max()), 1.0 / float(data.omega.min())
    target = Oscillation(stacked(data.modulus), magnitude, data.omega, viscous)
    spectrum = fitted(target, _candidates(shortest, longest, BEYOND_DATA, DENSE))
    series = _relaxation(spectrum, *spectrum.steady[1:].tolist())
    return _told(series, np.hypot(*np.split(spectrum.residual, 2)), (shortest, longest))


def _check(window: tuple[float, float], tolerance: float, relaxed: float | None, glassy: float | None) -> None:
    """Every fault of the arguments at once."""
    faults = []
    if len(window) != 2 or not 0.0 < window[0] < window[1] < math.inf:
        faults.append(Fault("prony fit", "window", "accepted: (shortest, longest), in s, finite and above zero"))
    if not LEAST_TOLERANCE <= tolerance < 1.0:
        faults.append(Fault("prony fit", "tolerance", f"accepted: from {LEAST_TOLERANCE:g} to below 1"))
    for name, limit in (("relaxed", relaxed), ("glassy", glassy)):
        if limit is not None and not 0.0 < limit < math.inf:
            reason = "accepted: a finite modulus above zero, in Pa; leave it out otherwise"
            faults.append(Fault("prony fit", name, reason))
    if faults:
        raise BadInput(faults)


def _sampled(
    operational: Transform,
    window: tuple[float, float],
    a_decade: int,
    viscosity: float,
    glassy: float | None,
) -> tuple[Array, Array, Array]:
    """Times, E(t) and its error, the known limit at time zero included. Raises BadInput."""
    times = np.geomspace(*window, max(8, math.ceil(a_decade * math.log10(window[1] / window[0]))))
    found = relaxation_modulus(operational, times, viscosity)
    columns = np.array([times, found.value, found.error])
    if glassy is not None:
        columns = np.column_stack([[0.0, glassy, 0.0], columns])
    if not np.all(columns[1] > columns[2]):
        message = "E(t) is not above the error of its inversion; accepted: s L{E(t)} of a passive material"
        raise BadInput(Fault("prony fit", "operational", message))
    return columns[0], columns[1], columns[2]


def _candidates(shortest: float, longest: float, beyond: float, a_decade: float) -> Array:
    """Relaxation times, log-spaced, so many a decade."""
    low, high = math.log10(shortest) - beyond, math.log10(longest) + beyond
    return np.logspace(low, high, math.ceil(a_decade * (high - low)) + 1)


def _relaxation(
    spectrum: Spectrum, viscosity: float = 0.0, relaxed: float | None = None, last: float = math.inf
) -> Relaxation:
    """The series of a spectrum; what is constant above a known equilibrium relaxes with the time `last`, s."""
    level, moduli, taus = float(spectrum.steady[0]), tuple(spectrum.weights.tolist()), tuple(spectrum.taus.tolist())
    if relaxed is None:
        return Relaxation(level, moduli, taus, viscosity)
    slow = (level,) if level > 0.0 else ()
    return Relaxation(relaxed, moduli + slow, taus + (last,) * len(slow), viscosity)


def _told(
    series: Relaxation, deviation: Array, window: tuple[float, float], before: float = math.inf, after: float = math.inf
) -> PronyFit:
    """The series with what is known of its deviations, (n,)."""
    worst, rms = float(deviation.max()), float(np.sqrt(np.mean(deviation**2)))
    told = replace(series, fidelity=Fidelity((float(window[0]), float(window[1])), worst, before, after))
    return PronyFit(told, worst, rms, deviation.size)


def _outside(
    series: Relaxation, times: Array, truth: Array, relaxed: float | None, glassy: float | None
) -> tuple[float, float]:
    """Bounds before and after the window: series and modulus both fall, so both lie between known values."""
    inner = times > 0.0
    known, found = truth[inner], series(times[inner])
    before = math.inf if glassy is None else max(glassy - found[0], series.glassy - known[0]) / known[0]
    after = math.inf if relaxed is None else max(known[-1], found[-1]) / relaxed - 1.0
    return float(before), float(after)


@dataclass(frozen=True, eq=False)
class Response(ABC):
    """What is measured of a Prony series, as rows linear in its moduli, where it should be `values`, (m,).

    Each residual is divided by its `scale`, (m,).
    """

    values: Array
    scale: Array

    @property
    @abstractmethod
    def steady(self) -> Array:
        """Rows of a unit equilibrium modulus, and of a unit viscosity where it is sought, (m, 1) or (m, 2)."""

    @abstractmethod
    def of(self, taus: Array) -> Array:
        """Rows of terms of unit modulus and these times, (m, n)."""

    @abstractmethod
    def slope(self, taus: Array) -> Array:
        """Derivative of `of` by ln tau, (m, n)."""

    @property
    def wanted(self) -> Array:
        """Values over scale, (m,)."""
        return np.asarray(self.values / self.scale)

    def rows(self, taus: Array) -> Array:
        """Steady columns, then those of terms with these times, over scale, (m, 1 + n) or (m, 2 + n)."""
        return np.asarray(np.hstack([self.steady, self.of(taus)]) / self.scale[:, None])


@dataclass(frozen=True, eq=False)
class Decay(Response):
    """E(t) at `times`, s, shape (m,), of which the first may be 0 and the last infinite."""

    times: Array

    @property
    def steady(self) -> Array:
        return np.ones((self.times.size, 1))

    def of(self, taus: Array) -> Array:
        return np.exp(-self._ages(taus))

    def slope(self, taus: Array) -> Array:
        ages = self._ages(taus)
        return np.asarray(ages * np.exp(-ages))

    def _ages(self, taus: Array) -> Array:
        with np.errstate(over="ignore"):
            return np.minimum(self.times[:, None] / taus, FADED)


@dataclass(frozen=True, eq=False)
class Oscillation(Response):
    """Storage modulus and, below it, loss modulus at angular frequencies `omega`, 1/s, (m,): 2m rows."""

    omega: Array
    viscous: bool = False

    @property
    def steady(self) -> Array:
        still, ones = np.zeros_like(self.omega), np.ones_like(self.omega)
        columns = [np.concatenate([ones, still])]
        if self.viscous:
            columns.append(np.concatenate([still, self.omega]))
        return np.column_stack(columns)

    def of(self, taus: Array) -> Array:
        turn = 1j * self.omega[:, None] * taus
        return stacked(turn / (1.0 + turn))

    def slope(self, taus: Array) -> Array:
        turn = 1j * self.omega[:, None] * taus
        return stacked(turn / (1.0 + turn) ** 2)


def stacked(modulus: NDArray[np.complex128]) -> Array:
    """Real parts above imaginary parts, (2m, ...) from (m, ...)."""
    return np.concatenate([modulus.real, modulus.imag])


@dataclass(frozen=True, eq=False)
class Spectrum:
    """`steady` moduli (1,) or (2,), `weights` and `taus` (n,), and the `residual` of every row, (m,)."""

    steady: Array
    weights: Array
    taus: Array
    residual: Array

    @property
    def rms(self) -> float:
        """Root mean square of the residual."""
        return float(np.sqrt(np.mean(self.residual**2)))


def fitted(target: Response, candidates: Array, enough: float = EXACT) -> Spectrum:
    """The spectrum whose response comes closest to the target, from candidate times, shape (n,), ascending.

    Non-negative least squares on the candidate times, then on times which have moved to the least residual: of
    what comes nearly as close as the closest, or has a root mean square of `enough`, the fewest terms. Raises
    NotReached.
    """
    weighed = _weighed(target, candidates)
    merged = _merged(weighed, candidates)
    starts = (weighed.taus,) if merged.size == weighed.taus.size else (merged, weighed.taus)
    found = [weighed, *(_weighed(target, _moved(target, start, candidates)) for start in starts)]
    allowed = max(NEARLY * min(spectrum.rms for spectrum in found), enough)
    fewest = min((s for s in found if s.rms <= allowed), key=lambda spectrum: spectrum.taus.size)
    return _pruned(target, fewest, enough)


def _weighed(target: Response, taus: Array) -> Spectrum:
    """Non-negative least squares (Lawson and Hanson 1974, doi 10.1137/1.9781611971217) at given times."""
    from scipy.optimize import nnls

    rows = target.rows(taus)
    sizes = np.linalg.norm(rows, axis=0)
    sizes[sizes == 0.0] = 1.0
    try:
        found = nnls(rows / sizes, target.wanted, maxiter=100 * sizes.size)[0] / sizes
    except RuntimeError as error:
        raise NotReached(f"the moduli of {taus.size} relaxation times were not found: {error}") from error
    steady, weights = np.split(found, [sizes.size - taus.size])
    kept = weights > 0.0
    return Spectrum(steady, weights[kept], taus[kept], rows @ found - target.wanted)


def _merged(spectrum: Spectrum, candidates: Array) -> Array:
    """The times of a spectrum, a pair of neighbours as one at their mean."""
    if spectrum.taus.size == 0:
        return spectrum.taus
    places = np.searchsorted(candidates, spectrum.taus)
    runs = np.split(np.arange(places.size), np.flatnonzero(np.diff(places) > 1) + 1)
    groups = [part for run in runs for part in ([run] if run.size == PAIR else np.split(run, run.size))]
    logs = [np.average(np.log(spectrum.taus[group]), weights=spectrum.weights[group]) for group in groups]
    return np.asarray(np.exp(logs))


def _moved(target: Response, start: Array, candidates: Array) -> Array:
    """The times near those of `start` with the least residual, moduli eliminated; `start` if the rows are too few.

    Variable projection with Kaufman's gradient (Golub and Pereyra 2003, doi 10.1088/0266-5611/19/2/201).
    """
    from scipy.optimize import least_squares

    wanted, steady = target.wanted, target.steady.shape[1]
    if start.size == 0 or wanted.size < 2 * start.size + steady:
        return start

    def basis(logs: Array) -> Array:
        return np.linalg.qr(target.rows(np.exp(logs)))[0]

    def misfit(logs: Array) -> Array:
        q = basis(logs)
        return np.asarray(q @ (q.T @ wanted) - wanted)

    def gradient(logs: Array) -> Array:
        q, taus = basis(logs), np.exp(logs)
        weights = np.linalg.lstsq(target.rows(taus), wanted)[0][steady:]
        turned = target.slope(taus) / target.scale[:, None] * weights
        return np.asarray(turned - q @ (q.T @ turned))

    with np.errstate(all="ignore"):  # a step too far overflows, and is then refused
        found = least_squares(
            misfit, np.log(start), gradient, method="lm",
            xtol=ROUNDING, ftol=ROUNDING, gtol=ROUNDING, max_nfev=MOST_EVALUATIONS,
        )  # fmt: skip
        return np.clip(np.exp(found.x), candidates[0], candidates[-1])


def _pruned(target: Response, spectrum: Spectrum, enough: float) -> Spectrum:
    """Without terms that do not show, and in order of time."""
    shown = np.abs(target.rows(spectrum.taus)[:, spectrum.steady.size :] * spectrum.weights).max(axis=0, initial=0.0)
    kept = np.flatnonzero(shown > NEGLIGIBLE * max(enough, np.abs(spectrum.residual).max()))
    kept = kept[np.argsort(spectrum.taus[kept])]
    weights, taus = spectrum.weights[kept], spectrum.taus[kept]
    residual = target.rows(taus) @ np.concatenate([spectrum.steady, weights]) - target.wanted
    return Spectrum(spectrum.steady, weights, taus, residual)
