"""Symmetric frictionless contact in plane strain, per unit length: profiles, collocation, and the tabulated curve.

With y = x/b on the contact |x| <= b the pressure is E* Q(y)/sqrt(1-y^2) with an even Q, and Q(1) = 0 where the
profile leaves the surface smoothly. Collocation is at Chebyshev's nodes: kernels -ln|y-y'| and |y-y'|, times smooth
functions, are integrated exactly for polynomials Q; on kernels that are smooth besides, convergence is spectral.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache, cached_property
from math import inf
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.tabulated import REACH, TabulatedCurve, TabulatedState, growing_edges
from lumped.numbers import Array


@dataclass(frozen=True)
class LineProfile(ABC):
    """A symmetric convex profile with this radius of curvature at its lowest line, m. Raises BadInput."""

    radius: float

    def __post_init__(self) -> None:
        if not 0.0 < self.radius < inf:
            raise BadInput(Fault("cylinder", "radius", f"must be above 0 m, is {self.radius}"))

    @property
    @abstractmethod
    def extent(self) -> float:
        """Half-width at which the profile ends, m."""

    @abstractmethod
    def height(self, x: ArrayLike) -> Array:
        """Height above the lowest line, m."""


@dataclass(frozen=True)
class CylinderProfile(LineProfile):
    """The true cylinder."""

    @property
    def extent(self) -> float:
        """R, m."""
        return self.radius

    def height(self, x: ArrayLike) -> Array:
        """R - sqrt(R^2-x^2) = x^2/(R + sqrt(R^2-x^2)), m."""
        square = np.square(np.asarray(x, dtype=float))
        return np.asarray(square / (self.radius + np.sqrt(self.radius**2 - square)))


@dataclass(frozen=True)
class ParabolaProfile(LineProfile):
    """The parabola of the same curvature."""

    @property
    def extent(self) -> float:
        """It does not end."""
        return inf

    def height(self, x: ArrayLike) -> Array:
        """x^2/(2R), m."""
        return np.asarray(np.square(np.asarray(x, dtype=float)) / (2.0 * self.radius))


@dataclass(frozen=True)
class Collocation:
    """Even functions on (-1, 1) by their values at the m positive ones of 2m nodes.

    `nodes`, shape (m,); `logarithm` and `distance`, shape (m, 2m): the integrals of -ln|y-y'| and |y-y'| times
    Q(y')/sqrt(1-y'^2) over all nodes, negative ones last and mirrored; `weight` of one node in the integral of
    Q/sqrt(1-y^2); `edge`, shape (m,): gives Q(1).
    """

    nodes: Array
    logarithm: Array
    distance: Array
    weight: float
    edge: Array

    def total(self, q: Array) -> Array:
        """The integral of Q/sqrt(1-y^2) from -1 to 1, of the last axis."""
        return np.asarray(2.0 * self.weight * q.sum(axis=-1))

    def at(self, q: Array, y: ArrayLike) -> Array:
        """Q/sqrt(1-y^2) at any y, zero outside the contact."""
        place = np.clip(np.abs(np.asarray(y, dtype=float)), 0.0, 1.0)
        angle, own = np.arccos(place), np.arccos(self.nodes)
        orders = np.arange(0, 2 * self.nodes.size, 2)
        halved = np.where(orders == 0, 0.5, 1.0) * (2.0 / self.nodes.size)
        waves = np.cos(np.multiply.outer(angle, orders)) * halved
        even = waves @ (np.cos(np.outer(orders, own)) @ q)
        return np.asarray(np.divide(even, np.sin(angle), out=np.zeros_like(even), where=place < 1.0))


@dataclass(frozen=True)
class Grown:
    """A contact whose edge pressure vanishes: Q at the nodes, depth, F/E* per unit length, d depth/d(F/E*)."""

    collocation: Collocation
    half_width: float
    q: Array
    depth: float
    force: float
    compliance: float


@cache
def collocation(points: int) -> Collocation:
    """The rule with `points` positive nodes."""
    angles = np.pi * (np.arange(2 * points) + 0.5) / (2 * points)
    orders = np.arange(2 * points, dtype=float)
    coefficients = np.cos(np.outer(orders, angles)) / points
    coefficients[0] *= 0.5
    own = angles[:points, None]
    even = coefficients[::2].sum(axis=0)
    return Collocation(
        nodes=np.cos(angles[:points]),
        logarithm=_mirrored(_logarithms(orders, own) @ coefficients),
        distance=_mirrored(_distances(orders, own) @ coefficients),
        weight=np.pi / (2 * points),
        edge=2.0 * even[:points],
    )


def folded(matrix: Array) -> Array:
    """What a matrix over all nodes, shape (m, 2m), does to an even function, shape (m, m)."""
    points = matrix.shape[0]
    return np.asarray(matrix[:, :points] + matrix[:, points:])


def _mirrored(matrix: Array) -> Array:
    points = matrix.shape[0]
    return np.concatenate([matrix[:, :points], matrix[:, : points - 1 : -1]], axis=1)


def _logarithms(orders: Array, angle: Array) -> Array:
    """Integrals of -ln|y-y'| T_n(y')/sqrt(1-y'^2), y = cos(angle): pi T_n(y)/n, pi ln 2 for n = 0."""
    n = np.maximum(orders, 1)
    return np.where(orders == 0, np.pi * np.log(2.0), np.pi / n * np.cos(orders * angle))


def _distances(orders: Array, angle: Array) -> Array:
    """Integrals of |y-y'| T_n(y')/sqrt(1-y'^2): their second derivative is 2 T_n/sqrt(1-y^2)."""
    n = np.maximum(orders, 2)
    wave = (np.sin((n - 1) * angle) / (n - 1) - np.sin((n + 1) * angle) / (n + 1)) / n
    zeroth = (np.pi - 2.0 * angle) * np.cos(angle) + 2.0 * np.sin(angle)
    first = angle - 0.5 * np.sin(2.0 * angle) - 0.5 * np.pi
    return np.where(orders == 0, zeroth, np.where(orders == 1, first, wave))


@dataclass(frozen=True)
class LineCurve(TabulatedCurve):
    """A rigid cylinder in plane strain, per unit length. With half-width b, a radius of curvature R and a length h,
    F/E* = pi b^2/(4 R f), depth = (F/E*) [(2/pi) ln(h/b) + d], d depth/dF = (2/pi) ln(h/b) + c,
    and f, d and c are smooth down to b = 0, where f = 1. `reach`: the largest half-width served, in lengths h.
    """

    profile: LineProfile
    reach: ClassVar[float] = REACH

    @property
    @abstractmethod
    def length(self) -> float:
        """h, m."""

    @abstractmethod
    def points(self, half_width: float) -> float:
        """Nodes that resolve the pressure on a half-width, m."""

    @abstractmethod
    def smooth(self, y: Array, half_width: float, refinement: float) -> Array:
        """pi E*/2 of the surface's displacement by a unit line load at y', less -ln|y-y'|, its even part.

        At nodes y, shape (n,), of the half-width, m; shape (n, n), or (n,) over y' where y plays no part.
        """

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels grow with the distance from the middle, as long as the profile lasts."""
        return growing_edges(self.length, self.profile.extent, self.reach)

    def grown(self, half_width: float, refinement: float) -> Grown:
        """The contact at one half-width: matrix Q = depth - height for the depth at which Q(1) = 0."""
        rule = collocation(int(refinement * self.points(half_width)))
        smooth = self.smooth(rule.nodes, half_width, refinement)
        matrix = 2.0 * half_width / np.pi * (folded(rule.logarithm) + 2.0 * rule.weight * smooth)
        height = self.profile.height(half_width * rule.nodes)
        flat, bent = np.linalg.solve(matrix, np.stack([np.ones_like(height), height], axis=1)).T
        depth = float((rule.edge @ bent) / (rule.edge @ flat))
        q = depth * flat - bent
        force, stiffness = half_width * rule.total(np.stack([q, flat]))
        return Grown(rule, half_width, q, depth, float(force), 1.0 / float(stiffness))

    def sample(self, contact_radius: float, refinement: float) -> Array:
        """f, d and c."""
        here = self.grown(contact_radius, refinement)
        logarithm = 2.0 / np.pi * np.log(self.length / contact_radius)
        hertz = np.pi * contact_radius**2 / (4.0 * self.profile.radius)
        return np.array([hertz / here.force, here.depth / here.force - logarithm, here.compliance - logarithm])

    def state(self, contact_radius: Array, smooth: Array, slopes: Array) -> TabulatedState:
        """The curve from f, d and c; at b = 0 all is 0."""
        b, touched = np.where(contact_radius > 0.0, contact_radius, self.length), contact_radius > 0.0
        logarithm = 2.0 / np.pi * np.log(self.length / b)
        force = np.pi * b**2 / (4.0 * self.profile.radius * smooth[0])
        force_slope = force * (2.0 / b - slopes[0] / smooth[0])
        compliance = logarithm + smooth[1]
        slope = force_slope * compliance + force * (slopes[1] - 2.0 / (np.pi * b))
        values = (force * compliance, slope, force, 1.0 / (logarithm + smooth[2]))
        return TabulatedState(*(np.where(touched, value, 0.0) for value in values))

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* at distances from the middle of the contact, from the equation itself; zero at first touch."""
        if contact_radius == 0.0:
            return np.zeros(np.shape(radius))
        here = self.grown(contact_radius, 1.0)
        return here.collocation.at(here.q, np.asarray(radius, dtype=float) / contact_radius)
