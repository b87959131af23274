"""A rigid cylinder pressed into an elastic ring from inside: the contact at one depth, in plane strain."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, inf

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault, NotReached
from lumped.load_curves.plane_contact import Array, Collocation, Grown, collocation
from lumped.load_curves.ring_kernel import ring_compliance

# The corner of the kernel at phi = 0 leaves convergence like the fourth power of the points.
POINTS, POINTS_PER_RADIAN, POINTS_PER_THICKNESS, NEWTON_STEPS = 32.0, 100.0, 2.5, 60
LEAST_CLEARANCE = 1e-4
# The half-angle is searched with this share of the points, and found by a secant over this share of itself.
SEARCH, SECANT = 0.4, 1e-5
# The search starts at or below the first, and no contact is wider than the last, rad.
FIRST_ANGLE, WIDEST = 0.5, 2.5


@dataclass(frozen=True)
class RingContact:
    """Exact arcs: with D = clearance + depth the overlap is D cos(theta) + sqrt(R^2 - D^2 sin^2(theta)) - inner radius.

    Its radial pressure is found from the Fourier series of the annulus, whose outer surface is fixed. Lengths in m,
    `nu` in (-1, 0.5], the clearance inner_radius - radius at least 1e-4 thickness. Raises BadInput.
    """

    radius: float
    inner_radius: float
    thickness: float
    nu: float

    def __post_init__(self) -> None:
        sizes = (("radius", self.radius), ("thickness", self.thickness))
        faults = [Fault("ring", key, f"must be above 0 m, is {size}") for key, size in sizes if not 0.0 < size < inf]
        if not -1.0 < self.nu <= 0.5:
            faults.append(Fault("ring", "nu", f"must lie above -1 and not above 0.5, is {self.nu}"))
        least = self.radius + LEAST_CLEARANCE * self.thickness
        if not least <= self.inner_radius < inf:
            message = f"must be at least {least:g} m around this cylinder, is {self.inner_radius}"
            faults.append(Fault("ring", "inner_radius", message))
        if faults:
            raise BadInput(faults)

    @property
    def clearance(self) -> float:
        """Distance of the centres at first touch, m."""
        return self.inner_radius - self.radius

    @property
    def depth_limit(self) -> float:
        """The lesser of thickness and radius, m."""
        return min(self.thickness, self.radius)

    def check_depth(self, depth: ArrayLike) -> None:
        """Raises BadInput where a depth reaches the limit."""
        deepest = np.max(np.asarray(depth), initial=0.0)
        if deepest >= self.depth_limit:
            message = f"a depth of {deepest:.3g} m; accepted below thickness and radius, {self.depth_limit:g} m"
            raise BadInput(Fault("depth", "", message))

    def pressed(self, depth: float, refinement: float) -> Grown:
        """The contact at one depth, m; its force is the component along the motion. Raises NotReached."""
        angle = self._half_angle(depth, refinement)
        rule, matrix = self._equation(angle, refinement)
        theta, distance = angle * rule.nodes, self.clearance + depth
        sources = np.stack([depth - self._fall(theta, distance), 1.0 - self._fall_slope(theta, distance)], axis=1)
        q, growth = np.linalg.solve(matrix, sources).T
        half_length = self.inner_radius * angle
        force, stiffness = half_length * rule.total(np.stack([q, growth]) * np.cos(theta))
        if not min(force, stiffness) > 0.0:
            raise NotReached(f"the ring at a depth of {depth:g} m: {theta.size} points do not resolve the pressure")
        return Grown(rule, half_length, q, depth, float(force), 1.0 / float(stiffness))

    def depth_at(self, angle: float) -> float:
        """The least depth with this half-angle, by Newton's method, monotone from 0; infinite where none has it."""
        theta, share = self._edge(angle, 1.0)
        depth = 0.0
        for _ in range(NEWTON_STEPS):
            distance = self.clearance + depth
            slope = 1.0 - float(share @ self._fall_slope(theta, distance))
            step = (float(share @ self._fall(theta, distance)) - depth) / slope
            if slope <= 0.0 or (distance + step) * np.sin(theta).max() >= self.radius:
                return inf
            if step <= 1e-13 * depth:
                return depth
            depth += step
        raise NotReached(f"the depth in the ring at a half-angle of {angle:g} was not found in {NEWTON_STEPS} steps")

    def _half_angle(self, depth: float, refinement: float) -> float:
        """The half-angle at whose ends the pressure vanishes: searched with few points, found by a secant with all."""
        angle = self._searched(depth, SEARCH * refinement)
        here, before = (self._excess(at, depth, refinement) for at in (angle, angle * (1.0 - SECANT)))
        return angle * (1.0 - SECANT * here / (here - before))

    def _searched(self, depth: float, refinement: float) -> float:
        """The half-angle where the excess ends; raises NotReached where it does not."""
        from scipy.optimize import brentq

        distance = self.clearance + depth
        widest = min(WIDEST, asin(min(1.0, self.radius / distance)) if distance > self.radius else WIDEST)
        guess = (depth * self.radius / (self.inner_radius * self.clearance)) ** 0.5
        low = high = min(guess, FIRST_ANGLE, 0.9 * widest)
        while self._excess(low, depth, refinement) < 0.0:
            low *= 0.5
        while self._excess(high, depth, refinement) > 0.0:
            if high > 0.999 * widest:
                raise NotReached(f"the contact in the ring at a depth of {depth:g} m has no end")
            low, high = high, min(1.4 * high, 0.9995 * widest)
        return float(brentq(self._excess, low, high, args=(depth, refinement), xtol=1e-300, rtol=1e-9))

    def _excess(self, angle: float, depth: float, refinement: float) -> float:
        """Above 0 while a contact of this half-angle still presses at its ends."""
        theta, share = self._edge(angle, refinement)
        return 1.0 - float(share @ self._fall(theta, self.clearance + depth)) / depth

    def _edge(self, angle: float, refinement: float) -> tuple[Array, Array]:
        """Angles of the nodes, and the share of each in what keeps the edge free of pressure; shapes (m,)."""
        rule, matrix = self._equation(angle, refinement)
        edge = np.asarray(np.linalg.solve(matrix.T, rule.edge), dtype=float)
        return angle * rule.nodes, edge / edge.sum()

    def _equation(self, angle: float, refinement: float) -> tuple[Collocation, Array]:
        width = angle * self.inner_radius / self.thickness
        rule = collocation(int(refinement * (POINTS + POINTS_PER_RADIAN * angle + POINTS_PER_THICKNESS * width)))
        ratio = self.inner_radius / (self.inner_radius + self.thickness)
        return rule, self.inner_radius * ring_compliance(self.nu, ratio, rule, angle)

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
