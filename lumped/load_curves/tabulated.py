"""Load curves known only by solving an integral equation at each contact radius: solved at a few, certified, kept.

What is kept are smooth functions of the contact radius, by Chebyshev polynomials on panels; they are found when first
needed, from the smallest contact outwards.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from lumped.errors import NotReached
from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.numbers import Array, Real, gauss

POINTS = 14  # Chebyshev points of a panel
COSINES = np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)  # Chebyshev points on (-1, 1)
# Of the way from a panel's middle to its end: no node lies there.
TESTED_AT = 0.985
# A panel is certified by an equation with finer quadrature.
ACCURACY, REFINEMENT = 1e-8, 1.5
# Newton's method squares its error: a step of 1e-6 leaves 1e-12.
NEWTON_STEPS, LAST_STEP, STARTS_PER_PANEL = 10, 1e-6, 50
NEAR = 1e-13  # rounding: of a flat end's radius, contacts no wider are that end
# The largest contact radius served, in lengths of the body and in radii of a profile that ends; panels grow outwards
# by this factor from the first, whose end is the lesser of two shares of the same.
REACH, SHARE_OF_EXTENT = 20.0, 0.85
# The shares: of the body's length, of the profile's extent; and the factor.
FIRST_PANEL, FIRST_OF_EXTENT, GROWTH = 0.3, 0.3, 1.6
# A panel over its distance from the last break before it, and so much more of it where no other follows; rounding, of a
# panel: no place is nearer to its break.
BROKEN_GROWTH, FEWER, LEAST_SHARE = 1.2, 1.5, 1e-24
# Over the body's length, a panel that begins as a root does: two as wide err by 1e-8, one and a half by 1e-9.
WIDEST_ROOTED = 1.0


def panel(low: float, high: float, sample: Callable[[float], Array]) -> Array:
    """Coefficients of smooth functions and of their slopes on one panel, shape (POINTS, 2, m).

    `sample` gives the m functions at one place, shape (m,).
    """
    places = 0.5 * (low + high) + 0.5 * (high - low) * COSINES
    values = chebyshev.chebfit(COSINES, np.array([sample(float(place)) for place in places]), POINTS - 1)
    slopes = np.concatenate([chebyshev.chebder(values), np.zeros((1, values.shape[1]))])
    return np.stack([values, slopes * 2.0 / (high - low)], axis=1)


def evaluate(tables: Array, edges: Array, place: Array) -> tuple[Array, Array]:
    """Functions and slopes at places, each of shape (m, n), from panels between ascending edges.

    `tables` has shape (k, POINTS, 2, m), `edges` (k+1,), `place` (n,); the outer panels go on beyond their ends.
    """
    index = np.clip(np.searchsorted(edges, place) - 1, 0, len(tables) - 1)
    z = (2.0 * place - edges[index] - edges[index + 1]) / (edges[index + 1] - edges[index])
    both = np.asarray(chebyshev.chebval(z, np.moveaxis(tables[index], 0, -1), tensor=False), dtype=float)
    return both[0], both[1]


def certified(
    ends: tuple[float, float],
    sample: Callable[[float, float], Array],
    error: Callable[[float, Array, Array, Array], float],
    named: Callable[[float], str],
) -> Array:
    """One panel, shape (POINTS, 2, m), of functions sampled at a place with a refinement.

    `error` tells, from a place, what is kept there, what a finer sample says, both (m, 1), and the slopes, by how much
    they differ; `named` what is found at a place. Raises NotReached where that is too much.
    """
    low, high = ends
    table = panel(low, high, lambda place: sample(place, 1.0))
    place = 0.5 * (low + high) + 0.5 * (high - low) * TESTED_AT
    kept, slopes = evaluate(table[None], np.array(ends), np.array([place]))
    found = error(place, kept, sample(place, REFINEMENT)[:, None], slopes)
    if not found <= ACCURACY:
        raise NotReached(f"{named(place)}: two resolutions differ by {found:.1e}")
    return table


class TabulatedState(NamedTuple):
    """A curve at contact radii: depth, its slope over the radius, F/E* and dF/d depth, of one shape."""

    depth: Real
    depth_slope: Real
    force: Real
    stiffness: Real


class TabulatedCurve(LoadCurve):
    """A curve that is solved at single contact radii and tabulated between, to a relative accuracy of 1e-8.

    Raises NotReached when two resolutions of the equation differ by more, and for depths beyond the last panel.
    """

    accuracy: ClassVar[float] = ACCURACY

    @property
    @abstractmethod
    def edges(self) -> tuple[float, ...]:
        """Contact radii between which the panels lie, ascending, the last the largest one served, m."""

    @abstractmethod
    def sample(self, contact_radius: float, refinement: float) -> Array:
        """The functions, smooth between the breaks, at one contact radius, shape (3,)."""

    @abstractmethod
    def state(self, contact_radius: Array, smooth: Array, slopes: Array) -> TabulatedState:
        """The curve from its smooth functions and their slopes, shapes (m,), (3, m) and (3, m)."""

    def at(self, contact_radius: ArrayLike) -> TabulatedState:
        """The curve at contact radii up to the last edge, m."""
        a = np.asarray(contact_radius, dtype=float)
        panels = int(np.searchsorted(self.edges, a.max(initial=0.0)))
        if panels > len(self.edges) - 1:
            raise NotReached(f"the load curve serves contact radii up to {self.edges[-1]:g} m, not {a.max():g}")
        return TabulatedState(*(np.reshape(part, a.shape) for part in self._at(a.ravel(), max(panels, 1))))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """Depth at a contact radius, m."""
        return self.at(contact_radius).depth

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d depth / d a."""
        return self.at(contact_radius).depth_slope

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F/E* at a contact radius."""
        return self.at(contact_radius).force

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and dF/d depth at a depth: that of a flat punch with the contact radius there."""
        here = self.at(self.contact_radius(depth))
        return here.force, here.stiffness

    def contact_radius(self, depth: ArrayLike) -> Real:
        """Contact radius at a depth, m, by Newton's method in logarithms from a table."""
        asked, least = np.maximum(np.asarray(depth, dtype=float), 0.0), self.edges[0]
        wanted = asked.ravel()[asked.ravel() > 0.0]
        radius = np.full(asked.size, least)
        if wanted.size:
            panels = self._panels_down_to(float(wanted.max()))
            start = least + np.exp(_extended(np.log(wanted), *_start(self, panels)))
            radius[asked.ravel() > 0.0] = self._invert(wanted, start, panels)
        return radius.reshape(asked.shape)

    def energy(self, depth: ArrayLike) -> Array:
        """Work of indentation, as every curve's, but from break to break."""
        if not self.breaks:
            return super().energy(depth)
        a, least = np.asarray(self.contact_radius(depth)), self.edges[0]
        starts = np.array((least, *(one for one in self.breaks if least < one < a.max(initial=0.0))))
        before = np.cumsum([0.0, *self._work(starts[:-1], starts[1:])])
        last = np.maximum(np.searchsorted(starts, a) - 1, 0)
        return np.asarray(before[last] + self._work(starts[last], a))

    def _work(self, low: Array, high: Array) -> Array:
        """int F(x) depth'(x) dx between radii without a break between them, per unit E*, (...)."""
        nodes, weights = gauss(GAUSS_POINTS)
        width = np.asarray(high - low)
        here = self.at(low[..., None] + width[..., None] * nodes**2)
        return np.asarray(width * ((here.force * here.depth_slope) @ (2.0 * nodes * weights)))

    def _invert(self, depth: Array, radius: Array, panels: int) -> Array:
        least, floor = self.edges[0], NEAR * self.edges[0]
        beyond = np.maximum(radius - least, floor)
        for _ in range(NEWTON_STEPS):
            here = self._at(least + beyond, panels)
            step = np.log(here.depth / depth) * here.depth / (beyond * here.depth_slope)
            beyond = np.clip(beyond * np.exp(-step), floor, self.edges[panels] - least)
            far = np.abs(step) * np.sqrt(beyond / (least + beyond)) >= LAST_STEP
            if not np.any(far & ((beyond > floor) | (step < 0.0))):
                return np.asarray(least + beyond)
        raise NotReached(f"the contact radius at a depth of {depth.max():g} m was not found")

    def _panels_down_to(self, depth: float) -> int:
        for panels in range(1, len(self.edges)):
            if _start(self, panels)[0][-1] >= math.log(depth):
                return panels
        reason = f"the contact grows beyond {self.edges[-1]:g} m"
        raise NotReached(f"the load curve at a depth of {depth:g} m: {reason}", "a smaller depth, a lower velocity")

    def _at(self, radius: Array, panels: int) -> TabulatedState:
        edges = np.array(self.edges[: panels + 1])
        place, rate = _stretched(radius, edges, self.breaks)
        smooth, slopes = evaluate(_tables(self, panels), edges, place)
        return self.state(radius, smooth, slopes * rate)


def _stretched(radius: Array, edges: Array, breaks: tuple[float, ...]) -> tuple[Array, Array]:
    """Places in the panels, m, and how fast they grow with the radius, (n,): beyond a break its root is a place."""
    if not breaks:
        return radius, np.ones_like(radius)
    index = np.clip(np.searchsorted(edges, radius) - 1, 0, edges.size - 2)
    low, width = edges[index], np.diff(edges)[index]
    root = np.sqrt(np.maximum((radius - low) / width, LEAST_SHARE))
    rooted = np.isin(low, breaks)
    return np.where(rooted, low + width * root, radius), np.where(rooted, 0.5 / root, 1.0)


def broken_edges(edges: Sequence[float], breaks: Sequence[float], before: float, length: float) -> tuple[float, ...]:
    """Edges of panels that begin anew at every break among them, m, and grow with the distance from the last one.

    From the first break b itself it is that of -b: beyond b functions go by sqrt(a^2 - b^2), whose other end that is;
    they fade within the body's `length`, m. `before`: where they would break below the first edge, m, or minus
    infinity.
    """
    ends, found = sorted({*edges[1:], *(one for one in breaks if edges[0] < one < edges[-1])}), [edges[0]]
    for end in ends:
        while found[-1] < end:
            low = found[-1]
            wide = BROKEN_GROWTH * (low - max([before, *(one if one < low else -one for one in breaks if one <= low)]))
            if low in breaks:
                wide = min(wide, WIDEST_ROOTED * length)
            found.append(low + wide if low + FEWER * wide < end else end)
    return tuple(found)


def growing_edges(length: float, extent: float, reach: float = REACH) -> tuple[float, ...]:
    """Edges of panels from 0 to `reach` lengths of the body, m, or a share of what the profile has, `extent`, m."""
    first = min(FIRST_PANEL * length, FIRST_OF_EXTENT * extent)
    last = min(reach * length, SHARE_OF_EXTENT * extent)
    growths = int(np.ceil(np.log(last / first) / np.log(GROWTH)))
    return (0.0, *(float(edge) for edge in np.geomspace(first, last, growths + 1)))


def _extended(x: Array, known_x: Array, known_y: Array) -> Array:
    """Linear interpolation, and beyond the first known place the straight line through the first two."""
    slope = (known_y[1] - known_y[0]) / (known_x[1] - known_x[0])
    return np.where(x < known_x[0], known_y[0] + slope * (x - known_x[0]), np.interp(x, known_x, known_y))


@lru_cache(maxsize=256)
def _start(curve: TabulatedCurve, panels: int) -> tuple[Array, Array]:
    """Logarithms of depth and of what the contact radius is above its least, ascending: the inversion starts there."""
    shares = np.linspace(0.0, 1.0, STARTS_PER_PANEL + 1)[1:]
    edges = np.array(curve.edges[: panels + 1])
    radius = (edges[:-1, None] + np.diff(edges)[:, None] * shares).ravel()
    return np.log(curve._at(radius, panels).depth), np.log(radius - edges[0])


@lru_cache(maxsize=256)
def _tables(curve: TabulatedCurve, panels: int) -> Array:
    """The first panels, shape (panels, POINTS, 2, 3)."""
    return np.stack([_panel(curve, index) for index in range(panels)])


@lru_cache(maxsize=1024)
def _panel(curve: TabulatedCurve, index: int) -> Array:
    """One panel, shape (POINTS, 2, 3), certified."""

    def error(place: float, kept: Array, fresh: Array, slopes: Array) -> float:
        one, other = (curve.state(np.array([radius_at(place)]), smooth, slopes) for smooth in (kept, fresh))
        ratios = (one.depth / other.depth, one.force / other.force, one.stiffness / other.stiffness)
        return max(abs(float(ratio[0]) - 1.0) for ratio in ratios)

    low, high = curve.edges[index : index + 2]
    rooted = low in curve.breaks

    def radius_at(place: float) -> float:
        return low + (place - low) ** 2 / (high - low) if rooted else place

    def sample(place: float, refinement: float) -> Array:
        return curve.sample(radius_at(place), refinement)

    return certified((low, high), sample, error, lambda a: f"the load curve at a contact radius of {radius_at(a):g} m")
