"""A rigid cylinder pressed into an elastic ring from inside, in plane strain, per unit length.

The ring is an annulus whose outer circle is fixed: radial displacement of the inner circle, wave by wave. A pressure
cos(n theta) on the inner circle, without shear, moves it by (inner radius/E*) c_n cos(n theta). Michell's functions
with their displacements and stresses: Barber 2010, ISBN 978-90-481-3808-1, tables 8.1 and 9.1; there 2 G = 1 and the
inner radius is 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import asin, exp, inf, log
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault, NotReached
from lumped.load_curves.base import GAUSS_POINTS, LoadCurve, check_below, elastic_faults
from lumped.load_curves.plane_contact import Collocation, Grown, collocation, folded
from lumped.load_curves.tabulated import ACCURACY, certified, evaluate
from lumped.numbers import Array, Real, gauss

# Panels by the logarithm of the depth over its limit: the deeper half, and a decade each below it.
EDGES = -log(2.0) - log(10.0) * np.arange(-1.0, 18.0)
EDGES[0] = 0.0  # the limit itself
# The corner of the kernel at phi = 0 leaves convergence like the fourth power of the points.
POINTS, POINTS_PER_RADIAN, POINTS_PER_THICKNESS, NEWTON_STEPS = 32.0, 100.0, 2.5, 60
LEAST_CLEARANCE = 1e-4  # safety: inner radius less the cylinder's over the thickness: narrower rings are refused
# The half-angle is searched with this share of the points, and found by a secant over this share of itself.
SEARCH, SECANT = 0.4, 1e-5
# The search starts at or below the first, and no contact is wider than the last, rad.
FIRST_ANGLE, WIDEST = 0.5, 2.5
# c_n leaves that of a hole in an infinite body as (inner/outer)^(2n): the tail beyond exp(-TAIL) is not summed.
TAIL, LEAST_ORDER = 42.0, 12


@dataclass(frozen=True)
class RodInRing(LoadCurve):
    """Exact arcs: with D = clearance + depth the overlap is D cos(theta) + sqrt(R^2 - D^2 sin^2(theta)) - inner radius.

    Its radial pressure is found from the Fourier series of the annulus, whose outer surface is fixed. F is the
    component along the motion, the contact radius the half-length of the inner arc that is touched. Lengths in m, `nu`
    in (-1, 0.5], the clearance inner_radius - radius at least 1e-4 thickness.

    While the cylinder's arc is the exact one, F is not the slope of a stored energy: the motion turns the overlap a
    little further than cos(theta). Depths stay below thickness and radius; below 1e-17 of them all is 0.
    Raises BadInput, or NotReached where two resolutions differ by more than 1e-8 or the contact goes all the way round.
    """

    radius: float
    inner_radius: float
    thickness: float
    nu: float
    accuracy: ClassVar[float] = ACCURACY

    def __post_init__(self) -> None:
        faults = elastic_faults("ring", self.nu, radius=self.radius, thickness=self.thickness)
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
        check_below(depth, self.depth_limit, "thickness and radius,")

    def contact_radius(self, depth: ArrayLike) -> Real:
        """Half-length of the inner arc touched, m."""
        return self._at(depth)[0]

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* per unit length, m, and its slope at a depth."""
        _, force, slope, _ = self._at(depth)
        return force, slope

    def depth(self, contact_radius: ArrayLike) -> Real:
        """The least depth with this half-length of arc, m, from the equation itself; infinite where none has it."""
        half_length = np.asarray(contact_radius, dtype=float)
        depths = [self.depth_at(float(b) / self.inner_radius) if b > 0.0 else 0.0 for b in half_length.ravel()]
        return np.reshape(depths, half_length.shape)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d depth / d half-length of arc."""
        depth = np.asarray(self.depth(contact_radius))
        half_length, _, _, exponent = self._at(depth)
        product = half_length * exponent
        return np.divide(depth, product, out=np.zeros_like(depth), where=product > 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* at distances along the inner arc, from the equation itself."""
        return self.pressure_at(radius, float(self.depth(contact_radius)))

    def pressure_at(self, radius: ArrayLike, depth: float) -> Array:
        """p/E* at distances along the inner arc and a depth."""
        self.check_depth(depth)
        if depth <= 0.0:
            return np.zeros_like(np.asarray(radius, dtype=float))
        here = self.pressed(depth, 1.0)
        return here.collocation.at(here.q, np.asarray(radius, dtype=float) / here.half_width)

    def bending(self, depth: float) -> float:
        """By d2 overlap/dD2 = -R^2 sin^2(theta) (R^2 - D^2 sin^2(theta))^(-3/2), 1/m per unit length."""
        angle, distance = self._half_angle(depth, 1.0), self.clearance + depth
        rule, matrix = self._equation(angle, 1.0)
        theta = angle * rule.nodes
        square = (self.radius * np.sin(theta)) ** 2
        bend = -square * (self.radius**2 - (distance * np.sin(theta)) ** 2) ** -1.5
        pressed = np.asarray(np.linalg.solve(matrix, bend), dtype=float)
        return self.inner_radius * angle * float(rule.total(pressed * np.cos(theta)))

    def energy(self, depth: ArrayLike) -> Array:
        """Work of indentation int_0^depth F d depth."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        nodes, weights = gauss(GAUSS_POINTS)
        return np.asarray(d * (self.force(d[..., None] * nodes**2) @ (2.0 * nodes * weights)))

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

    def _at(self, depth: ArrayLike) -> Array:
        """Half-length, F/E*, its slope and dln(half-length)/dln(depth), shape (4, ...); all 0 without depth."""
        self.check_depth(depth)
        d = np.asarray(depth, dtype=float)
        place = np.log(d / self.depth_limit, out=np.full(d.shape, -np.inf), where=d > 0.0).ravel()
        answer = np.zeros((4, d.size))
        for index in np.unique(np.searchsorted(-EDGES, -place)):
            if 0 < index < EDGES.size:
                here = (place < EDGES[index - 1]) & (place >= EDGES[index])
                values, slopes = evaluate(_panel(self, index)[None], EDGES[[index, index - 1]], place[here])
                answer[:, here] = np.concatenate([np.exp(values), slopes[:1]])
        return answer.reshape(4, *d.shape)

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


@lru_cache(maxsize=256)
def _panel(ring: RodInRing, index: int) -> Array:
    """Logarithms of half-length, F/E* and dF/d depth over ln(depth/limit), shape (POINTS, 2, 3), certified."""

    def sample(place: float, refinement: float) -> Array:
        here = ring.pressed(ring.depth_limit * exp(place), refinement)
        return np.log([here.half_width, here.force, 1.0 / here.compliance])

    def error(place: float, kept: Array, fresh: Array, slopes: Array) -> float:
        return float(np.abs(kept[1:] - fresh[1:]).max())

    def named(place: float) -> str:
        return f"{ring} at a depth of {ring.depth_limit * exp(place):g} m"

    return certified((float(EDGES[index]), float(EDGES[index - 1])), sample, error, named)


def ring_compliance(nu: float, ratio: float, rule: Collocation, angle: float) -> Array:
    """Radial displacement over the inner radius of |theta| <= angle for pressure E* Q, shape (m, m).

    The sum c_0/2 + sum c_n cos(n phi) is that of a hole, in closed form with its ln and its corner at phi = 0, and the
    annulus' own rest, which is smooth; `ratio` is inner over outer radius.
    """
    own = angle * rule.nodes
    phi = own[:, None] - np.concatenate([own, -own])
    singular = (
        2.0 * np.cos(phi) * rule.logarithm - 0.5 * np.pi * _side(nu) * angle * np.sinc(phi / np.pi) * rule.distance
    )
    whole = folded(singular + rule.weight * (_hole_rest(nu, phi) - 2.0 * np.log(angle) * np.cos(phi)))
    return angle / np.pi * (whole + 2.0 * rule.weight * _annulus_rest(nu, ratio, own))


def _side(nu: float) -> float:
    """m, the weight of 1/(n^2-1) in c_n."""
    return (1.0 - 2.0 * nu) / (1.0 - nu)


def _hole_rest(nu: float, phi: Array) -> Array:
    """Smooth part of sum_{n>=2} cos(n phi) (2n + m)/(n^2-1).

    sum 2n cos(n phi)/(n^2-1) = -2 cos(phi) ln(2 sin(|phi|/2)) - 1 - cos(phi)/2,
    sum cos(n phi)/(n^2-1) = 1/2 + cos(phi)/4 - sin(|phi|) (pi-|phi|)/2, both over n >= 2 and for |phi| < 2 pi.
    """
    cosine = np.cos(phi)
    waves = -2.0 * cosine * np.log(np.sinc(0.5 * phi / np.pi)) - 1.0 - 0.5 * cosine
    return np.asarray(waves + _side(nu) * (0.5 + 0.25 * cosine + 0.5 * phi * np.sin(phi)))


def _annulus_rest(nu: float, ratio: float, theta: Array) -> Array:
    """c_0/2 + c_1 cos(phi) + sum_{n>=2} (c_n - hole's) cos(n phi), its even part in both angles, shape (m, m)."""
    rest = compliances(nu, ratio).copy()
    orders = np.arange(rest.size, dtype=float)
    rest[0] *= 0.5
    rest[2:] -= hole(nu, orders[2:])
    cosines = np.cos(np.outer(theta, orders))
    return np.asarray((cosines * rest) @ cosines.T)


@lru_cache(maxsize=64)
def compliances(nu: float, ratio: float) -> Array:
    """c_n, n = 0, 1, ..., as far as they differ from those of a hole; `ratio` is inner over outer radius."""
    last = LEAST_ORDER + int(np.ceil(-0.5 * TAIL / np.log(ratio)))
    per_shear = 1.0 / (1.0 - nu)
    return np.concatenate([[_uniform(nu, ratio)], per_shear * _waves(nu, ratio, np.arange(1.0, last + 1.0))])


def hole(nu: float, orders: Array) -> Array:
    """c_n = (2n + m)/(n^2-1), m = (1-2nu)/(1-nu), of a hole in an infinite body, n >= 2."""
    return np.asarray((2.0 * orders + _side(nu)) / (orders**2 - 1.0))


def _uniform(nu: float, ratio: float) -> float:
    """n = 0: u = A r + B/r."""
    square, slack = ratio**-2, 1.0 - 2.0 * nu
    return (square - 1.0) * slack / ((1.0 - nu) * (1.0 + slack * square))


def _waves(nu: float, ratio: float, n: Array) -> Array:
    """u_r on the inner circle for n >= 1, shape (n,): four terms, no shear inside, no displacement outside."""
    inner_u, _, normal, shear = _terms(nu, n, 1.0, ratio)
    outer_u, outer_v, _, _ = _terms(nu, n, 1.0 / ratio, ratio)
    system = np.stack([normal, shear, outer_u, outer_v], axis=-2)
    load = np.zeros((n.size, 4, 1))
    load[:, 0] = -1.0
    return np.asarray((inner_u * np.linalg.solve(system, load)[..., 0]).sum(axis=-1))


def _terms(nu: float, n: Array, r: float, ratio: float) -> tuple[Array, Array, Array, Array]:
    """u_r, u_theta, sigma_rr, sigma_rtheta (cosine and sine parts) of four solutions at r, each of shape (n, 4).

    r^(n+2) and r^n are scaled to the outer circle. For n = 1 the third, a mere translation, gives its place to the
    single-valued solution of a force, (kappa+1) r theta sin(theta) - (kappa-1) r ln(r) cos(theta).
    """
    kappa, grown = 3.0 - 4.0 * nu, (r * ratio) ** (n - 1.0)
    rising = _michell_rising(kappa, n, r) * (grown * ratio**2)
    rigid = np.stack([-n, n, -n * (n - 1.0) / r, n * (n - 1.0) / r]) * grown
    falling = _michell_falling(kappa, n, r) * r ** (1.0 - n)
    decaying = np.stack([n, n, -n * (n + 1.0) / r, -n * (n + 1.0) / r]) * r ** (-1.0 - n)
    terms = np.stack([rising, rigid, falling, decaying], axis=-1)
    return terms[0], terms[1], terms[2], terms[3]


def _michell_rising(kappa: float, n: Array, r: float) -> Array:
    """r^(n+2) cos(n theta) over r^(n-1), shape (4, n)."""
    return np.stack([(kappa - n - 1.0) * r**2, (kappa + n + 1.0) * r**2, -(n + 1.0) * (n - 2.0) * r, n * (n + 1.0) * r])


def _michell_falling(kappa: float, n: Array, r: float) -> Array:
    """r^(2-n) cos(n theta) over r^(1-n), and for n = 1 the force's solution, shape (4, n)."""
    wave = np.stack([kappa + n - 1.0, n - 1.0 - kappa, -(n + 2.0) * (n - 1.0) / r, -n * (n - 1.0) / r])
    logarithm = 2.0 * kappa * np.log(r)
    force = np.array([logarithm - 1.0, -logarithm - 1.0, (kappa + 3.0) / r, (1.0 - kappa) / r])
    return np.where(n == 1.0, force[:, None], wave)
