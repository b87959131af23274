"""A rigid cylinder inside an elastic ring whose outer surface is fixed, in plane strain, per unit length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.load_curves from lumped.load_curves.line_curve import LineCurve
from lumped.load_curves.plane_contact import Array, Collocation, Grown, collocation
from lumped.load_curves.ring_kernel import ring_compliance

POINTS, NEWTON_STEPS = 32, 40
# Panels by the contact's half-angle: its logarithm is the coordinate, because the kernel's own curvature adds
# terms angle and angle^2 ln(angle), which vanish below the first.
FIRST_EDGES = (1e-7, 1e-3, 0.03, 0.15, 0.3)
GROWTH = 1.25
LEAST_CLEARANCE = 1e-4
# No contact is wider, rad.
WIDEST = 2.6


@dataclass(frozen=True)
class Ring(LineCurve):
    """Exact arcs: with D = clearance + depth the overlap is D cos(theta) + sqrt(R^2 - D^2 sin^2(theta)) - inner radius.

    Its radial pressure is found from the Fourier series of the annulus; F is its component along the motion, the contact
    radius the half-length of the inner arc touched. `nu` in (-1, 0.5]; the clearance, inner_radius - radius, is at least
    1e-4 thickness. Depths stay below the thickness. Raises BadInput; NotReached where 1e-8 is not met.
    """

    radius: float
    inner_radius: float
    thickness: float
    nu: float

    def __post_init__(self) -> None:
        faults = [
            Fault("ring", key, f"must be above 0 m, is {value}")
            for key, value in (("radius", self.radius), ("thickness", self.thickness))
            if not 0.0 < value < inf
        ]
        if not -1.0 < self.nu <= 0.5:
            faults.append(Fault("ring", "nu", f"must lie above -1 and not above 0.5, is {self.nu}"))
        least = self.radius + LEAST_CLEARANCE * self.thickness
        if not least <= self.inner_radius < inf:
            faults.append(Fault("ring", "inner_radius", f"must be at least {least:g} m, is {self.inner_radius}"))
        if faults:
            raise BadInput(faults)

    @property
    def clearance(self) -> float:
        """Distance of the centres at first touch, m."""
        return self.inner_radius - self.radius

    @property
    def curvature_radius(self) -> float:
        """1/(1/R - 1/inner radius), m."""
        return self.radius * self.inner_radius / self.clearance

    @property
    def length(self) -> float:
        """The inner radius, m."""
        return self.inner_radius

    def coordinate(self, contact_radius: Array) -> Array:
        """Logarithm of the half-angle, constant below the first edge."""
        return np.log(np.maximum(contact_radius / self.inner_radius, FIRST_EDGES[0]))

    def radius_at(self, coordinate: float) -> float:
        """Half-length of the arc at a coordinate, m."""
        return float(self.inner_radius * np.exp(coordinate))

    def coordinate_slope(self, contact_radius: Array) -> Array:
        """1/half-length."""
        return np.where(contact_radius > FIRST_EDGES[0] * self.inner_radius, 1.0 / contact_radius, 0.0)

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels up to the half-angle at which the depth reaches the thickness."""
        widest = self._widest()
        inner = [edge for edge in FIRST_EDGES if edge * GROWTH < widest]
        growths = int(np.ceil(np.log(widest / inner[-1]) / np.log(GROWTH)))
        angles = [*inner, *np.geomspace(inner[-1], widest, growths + 1)[1:]]
        return tuple(float(self.inner_radius * angle) for angle in angles)

    def _widest(self) -> float:
        """The half-angle at which the depth reaches the thickness."""
        from scipy.optimize import brentq

        def left(angle: float) -> float:
            return self.thickness / self.grown(self.inner_radius * angle, 1.0).depth - 1.0

        return float(brentq(left, 1e-3, WIDEST, xtol=1e-13, rtol=1e-13))

    def grown(self, half_width: float, refinement: float) -> Grown:
        """The contact at one half-length of the inner arc."""
        angle = half_width / self.inner_radius
        rule = collocation(int(refinement * POINTS * (1.0 + angle)))
        return self._grown(rule, angle, ring_compliance(self.nu, self._ratio, rule, angle))

    def check_depth(self, depth: ArrayLike) -> None:
        """Raises BadInput where a depth reaches the thickness."""
        deepest = np.max(depth, initial=0.0)
        if deepest >= self.thickness:
            message = f"must stay below the thickness of {self.thickness:g} m, is {deepest:g}"
            raise BadInput(Fault("ring", "depth", message))

    def contact_radius(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Half-length of the arc touched at a depth below the thickness, m; raises BadInput for deeper ones."""
        self.check_depth(depth)
        return np.asarray(super().contact_radius(depth))

    @property
    def _ratio(self) -> float:
        """Inner over outer radius."""
        return self.inner_radius / (self.inner_radius + self.thickness)

    def _grown(self, rule: Collocation, angle: float, compliance: Array) -> Grown:
        theta, matrix = angle * rule.nodes, self.inner_radius * compliance
        distance = self._distance(theta, np.linalg.solve(matrix.T, rule.edge))
        overlap = distance - self.clearance - self._fall(theta, distance)
        q, growth = np.linalg.solve(matrix, np.stack([overlap, 1.0 - self._fall_slope(theta, distance)], axis=1)).T
        half_width = self.inner_radius * angle
        force, stiffness = half_width * rule.total(np.stack([q, growth]) * np.cos(theta))
        return Grown(rule, half_width, q, distance - self.clearance, float(force), 1.0 / float(stiffness))

    def _distance(self, theta: Array, edge: Array) -> float:
        """D with no pressure at the edge, by Newton's method, monotone from D = clearance; infinite where none has."""
        share, distance = edge / edge.sum(), self.clearance
        for _ in range(NEWTON_STEPS):
            slope = 1.0 - float(share @ self._fall_slope(theta, distance))
            if slope <= 0.0:
                return inf
            step = (self.clearance + float(share @ self._fall(theta, distance)) - distance) / slope
            distance += step
            if distance * np.sin(theta[0]) >= self.radius:
                return inf
            if abs(step) < 1e-15 * distance:
                break
        return distance

    def _fall(self, theta: Array, distance: float) -> Array:
        """Overlap at theta = 0 less that at theta, m: 2 D sin^2(theta/2) + R - sqrt(R^2 - D^2 sin^2(theta))."""
        square = (distance * np.sin(theta)) ** 2
        arc = square / (self.radius + np.sqrt(self.radius**2 - square))
        return np.asarray(2.0 * distance * np.sin(0.5 * theta) ** 2 + arc)

    def _fall_slope(self, theta: Array, distance: float) -> Array:
        """d fall / d D."""
        sine = np.sin(theta)
        arc = distance * sine**2 / np.sqrt(self.radius**2 - (distance * sine) ** 2)
        return np.asarray(2.0 * np.sin(0.5 * theta) ** 2 + arc)
