"""What noise is: its colour, how residuals are whitened by it, and whether what is left is noise at all.

Coloured noise e_i = sum_k a_k e_(i-k) + w_i, w white, as an instrument's low pass makes it of white noise. Its colour
is told by the silence before touch and after the contact, where no model can err, or by the corner of the low pass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lumped.numbers import Array

HIGHEST_ORDER = 6  # work: of the noise's recursion; a low pass of second order needs two
LAGS, ROWS_PER_LAG = 10, 5  # of the test of the residuals, where there are rows enough
REJECTED = 0.01  # below this probability the residuals are no noise
FADED = 0.05  # a correlation below which the memory of residuals has ended


def colour_of(*silences: Array) -> Array:
    """The coefficients a_k of silences, N, each (n,), of the order of the least Bayesian criterion."""
    colours, criteria = _recursions(silences)
    return colours[int(np.argmin(criteria))]


def _recursions(silences: Sequence[Array]) -> tuple[list[Array], Array]:
    """Yule and Walker's coefficients of every order, each (order,), and the Bayesian criteria, (orders,).

    No mean is taken away: without a force there is none, and a short silence would lose its slow noise with it.
    """
    rows = sum(part.size for part in silences)
    covariance = sum((s.size * autocovariance(s, HIGHEST_ORDER) for s in silences), np.zeros(HIGHEST_ORDER + 1))
    if not covariance[0] > 0.0:
        return [np.zeros(0)], np.zeros(1)
    found, criteria = list[Array](), list[float]()
    for order in range(HIGHEST_ORDER + 1):
        found.append(_coefficients(covariance, order))
        left = max(float(covariance[0] - found[-1] @ covariance[1 : order + 1]), 1e-300)
        criteria.append(rows * math.log(left) + order * math.log(rows))
    return found, np.array(criteria)


def _coefficients(covariance: Array, order: int) -> Array:
    """Those of a recursion of an order, from the covariances of lags from zero on."""
    lags = np.abs(np.subtract.outer(np.arange(order), np.arange(order)))
    return np.asarray(np.linalg.lstsq(covariance[lags], covariance[1 : order + 1], rcond=None)[0])


def likely_colours(silences: Sequence[Array], count: int, rng: np.random.Generator) -> list[Array]:
    """So many colours that silences, N, each (n,), allow, one as likely as another.

    Orders are as frequent as their criteria say (Kass and Raftery, doi 10.1080/01621459.1995.10476572), coefficients as
    those of a regression of the rows on those before, with Jeffreys' prior. All are shuffled, to be paired with those
    of another curve.
    """
    every, criteria = _recursions(silences)
    shares = np.exp(-0.5 * (criteria - criteria.min()))
    numbers = rng.multinomial(count, shares / shares.sum()).tolist()
    drawn = [_drawn(own, silences, count, rng)[:number] for own, number in zip(every, numbers, strict=True) if number]
    found = [colour for colours in drawn for colour in colours]
    return [found[i] for i in rng.permutation(count)]


def _drawn(own: Array, silences: Sequence[Array], count: int, rng: np.random.Generator) -> Array:
    """Coefficients of an order, (count, order): around the least squares by Student's t, then as the prior says."""
    order, longer = own.size, [part for part in silences if part.size > own.size]
    before = np.concatenate([_rows_before(part, order) for part in longer])
    rows = np.concatenate([part[order:] for part in longer])
    inverse, freedom = np.linalg.pinv(before), max(rows.size - order, 1)
    left = rows - before @ (inverse @ rows)
    widths = np.sqrt(float(left @ left) / rng.chisquare(freedom, (count, 1)))
    found = inverse @ rows + widths * (rng.normal(size=(count, rows.size)) @ inverse.T)
    found[0] = own  # it fades, whatever the others do
    prior = _prior(found)
    return np.asarray(found[rng.choice(count, count, p=prior / prior.sum())])


def _rows_before(series: Array, order: int) -> Array:
    """Of every row but the first ones the rows before it, the last first, (n - order, order)."""
    rows = series.size - order
    return np.array([series[first : first + rows] for first in range(order - 1, -1, -1)]).reshape(order, rows).T


def _prior(colours: Array) -> Array:
    """Jeffreys' prior of recursions, (count, order): prod_k (1 - r_k^2)^(-k/2), none where they grow, (count,).

    It is the root of the rows' covariance over what is new in them, by the partial correlations r_k (Durbin, Levinson).
    """
    found = np.ones(len(colours))
    for order in range(colours.shape[1], 0, -1):
        last, others = colours[:, order - 1], colours[:, : order - 1]
        rest = np.where(np.abs(last) < 1.0, 1.0 - last**2, np.inf)
        found *= rest ** (-0.5 * order)
        colours = (others + last[:, None] * others[:, ::-1]) / rest[:, None]
    return found


def colour_of_corner(corner: float, step: float) -> Array:
    """The coefficient of a low pass of first order with its corner, Hz, at a time step, s: exp(-2 pi f h)."""
    return np.array([math.exp(-2.0 * math.pi * corner * step)])


def autocovariance(series: Array, most: int) -> Array:
    """Mean products of rows so many rows apart, (most + 1,), in the square of the series' unit."""
    n = series.size
    return np.array([float(series[lag:] @ series[: n - lag]) / n if lag < n else 0.0 for lag in range(most + 1)])


def whitened(series: Array, colour: Array) -> Array:
    """What is new in every row: w_i = e_i - sum_k a_k e_(i-k), (n - order, ...)."""
    order = colour.size
    rows = series.shape[0] - order
    found = series[order:].copy()
    for lag, a in enumerate(colour.tolist(), start=1):
        found -= a * series[order - lag : order - lag + rows]
    return found


def coloured(series: Array, colour: Array) -> Array:
    """A series, (n,), through the low pass that gives white noise this colour, and leaves what is steady."""
    if not colour.size:
        return series
    from scipy.signal import lfilter  # late: few records ask for it

    return np.asarray(lfilter([1.0 - colour.sum()], np.append(1.0, -colour), series))


@dataclass(frozen=True)
class Whiteness:
    """Ljung and Box's test, doi 10.1093/biomet/65.2.297: Q, lags, and how probable as much is of noise, a ratio.

    `neighbours`: the correlation of neighbouring rows.
    """

    statistic: float
    lags: int
    probability: float
    neighbours: float

    @property
    def noise(self) -> bool:
        """Whether the residuals may be noise of the colour that it was taken for."""
        return self.probability >= REJECTED

    @property
    def of_the_law(self) -> bool:
        """Whether a law leaves more than noise: that is smooth. Of neighbours that are opposed the colour is wrong."""
        return not self.noise and self.neighbours > 0.0


def whiteness(residuals: Sequence[Array]) -> Whiteness:
    """Whether the residuals of several curves, each (n,), hang together: Q = sum n (n + 2) rho_k^2/(n - k)."""
    from scipy.special import chdtrc

    total, lags, neighbours = 0.0, 0, list[float]()
    for series in residuals:
        n, most = series.size, min(LAGS, series.size // ROWS_PER_LAG)
        covariance = autocovariance(series - series.mean(), most)
        if most and covariance[0] > 0.0:
            shares = (covariance[1:] / covariance[0]) ** 2 / (n - np.arange(1, most + 1))
            total, lags = total + n * (n + 2) * float(shares.sum()), lags + most
            neighbours.append(float(covariance[1] / covariance[0]))
    return Whiteness(total, lags, float(chdtrc(lags, total)) if lags else 1.0, max(neighbours, default=0.0))


def memory(series: Array) -> float:
    """How many rows tell as much as one alone: 1 + 2 sum rho_k, until the correlation has faded, at least one."""
    n, spectrum = series.size, np.fft.rfft(series, 2 * series.size)
    covariance = np.fft.irfft(np.abs(spectrum) ** 2)[: n // 2 + 1] / n
    if not covariance[0] > 0.0:
        return 1.0
    correlation = covariance[1:] / covariance[0]
    faded = np.flatnonzero(correlation < FADED)
    return 1.0 + 2.0 * max(float(correlation[: faded[0] if faded.size else None].sum()), 0.0)
