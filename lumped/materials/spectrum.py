"""A discrete relaxation spectrum from what it does: non-negative weights at times found from the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached

Array = NDArray[np.float64]
# Neighbouring candidates that both count stand for one time between them; a longer run is a continuous spectrum.
PAIR = 2
MOST_EVALUATIONS = 60
ROUNDING = 1e-15
# A residual this much above the least is nearly as good; below EXACT all are.
NEARLY, EXACT = 1.02, 1e-13
# A term which nowhere changes the answer by this share of the largest residual, or of what is enough, is dropped.
NEGLIGIBLE = 1e-2


class Response(Protocol):
    """What is measured of a Prony series, as rows linear in its moduli."""

    @property
    def steady(self) -> Array:
        """Rows of a unit equilibrium modulus, and of a unit viscosity where it is sought, (m, 1) or (m, 2)."""

    def of(self, taus: Array) -> Array:
        """Rows of terms of unit modulus and these times, (m, n)."""

    def slope(self, taus: Array) -> Array:
        """Derivative of `of` by ln tau, (m, n)."""


@dataclass(frozen=True, eq=False)
class AskedResponse:
    """What the response should be, `values` (m,), and what each residual is divided by, `scale` (m,)."""

    response: Response
    values: Array
    scale: Array

    @property
    def wanted(self) -> Array:
        """Values over scale, (m,)."""
        return np.asarray(self.values / self.scale)

    def rows(self, taus: Array) -> Array:
        """Steady columns, then those of terms with these times, over scale, (m, 1 + n) or (m, 2 + n)."""
        return np.asarray(np.hstack([self.response.steady, self.response.of(taus)]) / self.scale[:, None])

    def slope(self, taus: Array) -> Array:
        """Derivative of the columns of the terms by ln tau, (m, n)."""
        return np.asarray(self.response.slope(taus) / self.scale[:, None])


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


def fitted(target: AskedResponse, candidates: Array, enough: float = EXACT) -> Spectrum:
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


def _weighed(target: AskedResponse, taus: Array) -> Spectrum:
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


def _moved(target: AskedResponse, start: Array, candidates: Array) -> Array:
    """The times near those of `start` with the least residual, moduli eliminated; `start` if the rows are too few.

    Variable projection with Kaufman's gradient (Golub and Pereyra 2003, doi 10.1088/0266-5611/19/2/201).
    """
    from scipy.optimize import least_squares

    wanted, steady = target.wanted, target.response.steady.shape[1]
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
        turned = target.slope(taus) * weights
        return np.asarray(turned - q @ (q.T @ turned))

    with np.errstate(all="ignore"):  # a step too far overflows, and is then refused
        found = least_squares(
            misfit, np.log(start), gradient, method="lm",
            xtol=ROUNDING, ftol=ROUNDING, gtol=ROUNDING, max_nfev=MOST_EVALUATIONS,
        )  # fmt: skip
        return np.clip(np.exp(found.x), candidates[0], candidates[-1])


def _pruned(target: AskedResponse, spectrum: Spectrum, enough: float) -> Spectrum:
    """Without terms that do not show, and in order of time."""
    shown = np.abs(target.rows(spectrum.taus)[:, spectrum.steady.size :] * spectrum.weights).max(axis=0, initial=0.0)
    kept = np.flatnonzero(shown > NEGLIGIBLE * max(enough, np.abs(spectrum.residual).max()))
    kept = kept[np.argsort(spectrum.taus[kept])]
    weights, taus = spectrum.weights[kept], spectrum.taus[kept]
    residual = target.rows(taus) @ np.concatenate([spectrum.steady, weights]) - target.wanted
    return Spectrum(spectrum.steady, weights, taus, residual)
