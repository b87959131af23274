"""A discrete relaxation spectrum from what it does: non-negative weights at times found from the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

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


def fitted(response: Response, target: Array, scale: Array, candidates: Array, enough: float = EXACT) -> Spectrum:
    """The spectrum whose rows come closest to `target`, (m,), each residual divided by `scale`, (m,).

    Non-negative least squares on the candidate times, then on times which have moved to the least residual: of
    what comes nearly as close as the closest, or has a root mean square of `enough`, the fewest terms.
    """
    listed = _listed(response, target, scale, candidates)
    merged = _merged(listed, candidates)
    starts = (listed,) if merged.taus.size == listed.taus.size else (merged, listed)
    found = [_polished(response, target, scale, start, candidates) for start in starts]
    allowed = max(NEARLY * min(spectrum.rms for spectrum in (*found, listed)), enough)
    close = [spectrum for spectrum in (*found, listed) if spectrum.rms <= allowed]
    fewest = min(close, key=lambda spectrum: spectrum.taus.size)
    return _pruned(response, target, scale, fewest, enough)


def residual(response: Response, target: Array, scale: Array, steady: Array, weights: Array, taus: Array) -> Array:
    """Rows of a spectrum minus `target`, over `scale`, (m,)."""
    return np.asarray((response.steady @ steady + response.of(taus) @ weights - target) / scale)


def _listed(response: Response, target: Array, scale: Array, taus: Array) -> Spectrum:
    """Non-negative least squares (Lawson and Hanson 1974, doi 10.1137/1.9781611971217) at given times."""
    from scipy.optimize import nnls

    rows = np.hstack([response.steady, response.of(taus)]) / scale[:, None]
    sizes = np.linalg.norm(rows, axis=0)
    sizes[sizes == 0.0] = 1.0
    found = nnls(rows / sizes, target / scale, maxiter=100 * rows.shape[1])[0] / sizes
    steady, weights = np.split(found, [response.steady.shape[1]])
    kept = weights > 0.0
    left = rows @ found - target / scale
    return Spectrum(steady, weights[kept], taus[kept], left)


def _merged(spectrum: Spectrum, candidates: Array) -> Spectrum:
    """Pairs of neighbours as one term at their mean time."""
    if spectrum.taus.size == 0:
        return spectrum
    places = np.searchsorted(candidates, spectrum.taus)
    runs = np.split(np.arange(places.size), np.flatnonzero(np.diff(places) > 1) + 1)
    groups = [part for run in runs for part in ([run] if run.size == PAIR else np.split(run, run.size))]
    weights = np.array([spectrum.weights[group].sum() for group in groups])
    logs = np.log(spectrum.taus) * spectrum.weights
    taus = np.exp([logs[group].sum() / weight for group, weight in zip(groups, weights, strict=True)])
    return Spectrum(spectrum.steady, weights, taus, spectrum.residual)


def _polished(response: Response, target: Array, scale: Array, start: Spectrum, candidates: Array) -> Spectrum:
    """The best times near those of `start`, moduli eliminated; `start` when the rows are too few.

    Variable projection with Kaufman's gradient (Golub and Pereyra 2003, doi 10.1088/0266-5611/19/2/201).
    """
    from scipy.optimize import least_squares

    if target.size < 2 * start.taus.size + start.steady.size or start.taus.size == 0:
        return start
    wanted = target / scale

    def projected(logs: Array) -> tuple[Array, Array]:
        rows = np.hstack([response.steady, response.of(np.exp(logs))]) / scale[:, None]
        return rows, np.linalg.qr(rows)[0]

    def misfit(logs: Array) -> Array:
        _, basis = projected(logs)
        return np.asarray(basis @ (basis.T @ wanted) - wanted)

    def gradient(logs: Array) -> Array:
        rows, basis = projected(logs)
        weights = np.linalg.lstsq(rows, wanted)[0][start.steady.size :]
        turned = response.slope(np.exp(logs)) * weights / scale[:, None]
        return np.asarray(turned - basis @ (basis.T @ turned))

    with np.errstate(all="ignore"):  # a step too far overflows, and is then refused
        found = least_squares(
            misfit, np.log(start.taus), gradient, method="lm",
            xtol=ROUNDING, ftol=ROUNDING, gtol=ROUNDING, max_nfev=MOST_EVALUATIONS,
        )  # fmt: skip
        taus = np.clip(np.exp(found.x), candidates[0], candidates[-1])
    return _listed(response, target, scale, taus)


def _pruned(response: Response, target: Array, scale: Array, spectrum: Spectrum, enough: float) -> Spectrum:
    """Without terms that do not show, and in order of time."""
    shown = np.abs(response.of(spectrum.taus) * spectrum.weights / scale[:, None]).max(axis=0, initial=0.0)
    kept = np.flatnonzero(shown > NEGLIGIBLE * max(enough, np.abs(spectrum.residual).max()))
    kept = kept[np.argsort(spectrum.taus[kept])]
    weights, taus = spectrum.weights[kept], spectrum.taus[kept]
    return Spectrum(spectrum.steady, weights, taus, residual(response, target, scale, spectrum.steady, weights, taus))
