"""The elastic layer on a rigid foundation, which wave by wave yields less than the half-space.

Round contact, line contact, and the closed forms of a thin layer. Under an axisymmetric profile the dual integral
equation is reduced to Fredholm's of the second kind and solved by Nystrom's method. With x, s, t in thicknesses, phi
the pressure's Abel transform and g the one-dimensional profile of the indenter,
    phi(t) - int_0^ratio k(s, t) phi(s) ds = depth - g(t),  k(s, t) = (2/pi) int_0^inf (1-L(u)) cos(us) cos(ut) du,
    F/E* = 2 thickness int_0^ratio phi dt,  phi(ratio) = 0 where the profile leaves the surface smoothly.
L = 1 leaves phi = depth - g: the half-space. Lebedev and Ufliand 1958, J. Appl. Math.
Mech. 22, 442-450.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault, nearest
from lumped.load_curves.base import LoadCurve, check_below, elastic_faults
from lumped.load_curves.fixed_area import FixedArea, under_flat_end
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.load_curves.plane_contact import LineCurve
from lumped.load_curves.tabulated import REACH, TabulatedCurve, TabulatedState, broken_edges, growing_edges
from lumped.numbers import Array, gauss

BASES = ("bonded", "sliding")
# Beyond this wavenumber (times thickness) the deficit is below rounding.
LAST_WAVENUMBER = 22.0
WAVE_POINTS = 24  # Gauss points of each panel of wavenumbers
# Places between two bends of a face that are next to one another, and more for every thickness between them.
POINTS_BETWEEN, POINTS_MORE = 24, 1


@dataclass(frozen=True)
class PointLayer:
    """Thickness in m, Poisson's ratio in (-1, 0.5] and `base`: "bonded" or "sliding" (held normally, both ways).

    A pressure cos(k x) on its surface raises the displacement 2 L(k thickness) cos(k x)/(E* k): L -> 1 on the
    half-space. Raises BadInput.
    """

    thickness: float
    nu: float
    base: str = "bonded"

    def __post_init__(self) -> None:
        faults = elastic_faults("layer", self.nu, thickness=self.thickness)
        if self.base not in BASES:
            message = f"is one of {', '.join(BASES)}, not {self.base!r}{nearest(self.base, BASES)}"
            faults.append(Fault("layer", "base", message))
        if faults:
            raise BadInput(faults)

    def check_depth(self, depth: ArrayLike) -> None:
        """Raises BadInput where a depth reaches the thickness."""
        check_below(depth, self.thickness, "the layer's thickness")


def deficit(nu: float, base: str, u: Array) -> Array:
    """1 - L(u) at wavenumbers u (times thickness), shape (n,), written without a difference.

    Bonded: L = (2 kappa sinh 2u - 4u)/(2 kappa cosh 2u + 1 + kappa^2 + 4u^2), kappa = 3 - 4 nu; sliding:
    L = sinh^2 u/(sinh u cosh u + u), which knows no nu.
    Hayes et al. 1972, J. Biomech. 5, 541-551.
    """
    if base == "sliding":
        return np.asarray((1.0 + 2.0 * u - np.exp(-2.0 * u)) / (np.sinh(2.0 * u) + 2.0 * u))
    kappa = 3.0 - 4.0 * nu
    rest = 1.0 + kappa**2 + 4.0 * u**2
    return np.asarray((2.0 * kappa * np.exp(-2.0 * u) + rest + 4.0 * u) / (2.0 * kappa * np.cosh(2.0 * u) + rest))


def waves(ratio: float, refinement: float) -> tuple[Array, Array]:
    """Wavenumbers (times thickness) and their weights, enough for a contact of half-width `ratio` thicknesses."""
    panels = int(np.ceil(refinement * (7.0 + 1.2 * ratio)))
    nodes, weights = gauss(WAVE_POINTS)
    width = LAST_WAVENUMBER / panels
    return (width * (np.arange(panels)[:, None] + nodes)).ravel(), np.tile(width * weights, panels)


@dataclass(frozen=True)
class LayerCurve(TabulatedCurve):
    """What a layer answers to the profile which the half-space answers by the curve `half_space`.

    Contact radii up to 20 thicknesses and up to 0.85 of a sphere's radius; a depth of a thickness or more raises
    BadInput. Relative accuracy 1e-8, or NotReached; of the pressure under a face that bends 1e-4.
    """

    half_space: LoadCurve
    layer: PointLayer

    def __post_init__(self) -> None:
        if not isinstance(self.half_space, HalfSpaceCurve):
            message = "must be a curve of the half-space under a profile"
            raise BadInput(Fault("layer", "half_space", message))

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels grow with the distance from the axis, and from every bend of the face."""
        smooth = growing_edges(self.layer.thickness, self.half_space.extent)
        least = self.half_space.least_radius
        inside = [edge for edge in smooth if edge > least]
        return broken_edges([least, *inside], self.breaks, self.half_space.root_before, self.layer.thickness)

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """Those of the half-space's own curve; on the axis a bend is a tip's curvature."""
        return tuple(one for one in self.half_space.breaks if one > 0.0)

    def sample(self, contact_radius: float, refinement: float) -> Array:
        """Depth, force and stiffness over those of the half-space at this contact radius."""
        equation, h = self._equation(contact_radius, refinement), self.layer.thickness
        nodes, weights, edge, punch = equation.between([one / h for one in self.breaks if one < contact_radius])
        profile = self.half_space.depth(h * nodes)
        own, own_force = (float(of(contact_radius)) for of in (self.half_space.depth, self.half_space.force_at))
        depth = (own + (weights * edge) @ profile) / (1.0 + equation.weights @ equation.edge)
        force = 2.0 * h * ((weights * punch) @ (depth - profile))
        stiffness = 2.0 * h * (equation.weights @ equation.punch)
        return np.array([depth / own, force / own_force, stiffness / (2.0 * contact_radius)])

    def state(self, contact_radius: Array, smooth: Array, slopes: Array) -> TabulatedState:
        """The half-space's values times the tabulated ratios."""
        a, curve = contact_radius, self.half_space
        own = curve.depth(a)
        slope = curve.depth_slope(a) * smooth[0] + own * slopes[0]
        return TabulatedState(own * smooth[0], slope, curve.force_at(a) * smooth[1], 2.0 * a * smooth[2])

    def contact_radius(self, depth: ArrayLike) -> Array:
        """Contact radius a at a depth below the thickness, m; raises BadInput for deeper ones."""
        self.layer.check_depth(depth)
        return np.asarray(super().contact_radius(depth))

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p(r)/E* = -(1/pi) int_r^a phi'(t)/sqrt(t^2-r^2) dt, zero outside: the half-space's and a smooth part."""
        equation = self._equation(contact_radius, 1.0)
        depth = float(self.depth(contact_radius))
        phi = equation.answer(depth - self.half_space.depth(self.layer.thickness * equation.nodes))
        inner = abel(equation, phi, np.asarray(radius, dtype=float) / self.layer.thickness)
        return self.half_space.pressure(radius, contact_radius) + inner / self.layer.thickness

    def _equation(self, contact_radius: float, refinement: float) -> DualEquation:
        ratio = contact_radius / self.layer.thickness
        return dual_equation(self.layer.nu, self.layer.base, ratio, refinement)


@dataclass(frozen=True)
class LayerPunch(FixedArea):
    """A flat-ended cylinder of this radius, up to 20 thicknesses, on a layer: F = 2 kappa E* a depth.

    Raises BadInput beyond. Hayes et al. 1972, J. Biomech. 5, 541-551, tabulate kappa.
    """

    radius: float
    layer: PointLayer
    accuracy: ClassVar[float] = 1e-10

    def __post_init__(self) -> None:
        reach = REACH * self.layer.thickness
        if not 0.0 < self.radius <= reach:
            raise BadInput(Fault("punch", "radius", f"must lie above 0 and up to {reach:g} m, is {self.radius}"))

    @cached_property
    def stiffness(self) -> float:
        """2 kappa a, m."""
        return float(2.0 * self.layer.thickness * (self._equation.weights @ self._equation.punch))

    def pressure_at(self, radius: ArrayLike, depth: float) -> Array:
        """(1/pi) [phi(a)/sqrt(a^2-r^2) - int_r^a phi'/sqrt(t^2-r^2) dt] with the punch's phi."""
        equation, pressed = self._equation, max(depth, 0.0)
        edge = pressed * (1.0 + float(equation.weights @ equation.edge))
        inner = abel(equation, pressed * equation.punch, np.asarray(radius, dtype=float) / self.layer.thickness)
        return under_flat_end(radius, self.radius, edge) + inner / self.layer.thickness

    @property
    def _equation(self) -> DualEquation:
        return dual_equation(self.layer.nu, self.layer.base, self.radius / self.layer.thickness)


def abel(equation: DualEquation, phi: Array, r: Array) -> Array:
    """-(1/pi) int_r^ratio psi'(t)/sqrt(t^2-r^2) dt of phi's smooth part psi, r in thicknesses, zero outside.

    psi' by a polynomial on (0, ratio), of as many points as resolve phi itself.
    """
    points, half = equation.nodes.size, 0.5 * equation.ratio or 1.0  # nothing touches yet
    slopes = chebyshev.chebinterpolate(
        lambda x: equation.correction_slope(phi, half * (x + 1.0)),  # type: ignore[type-var]  # numpy's stub: one number
        points - 1,
    )
    reach = np.sqrt(np.maximum(equation.ratio**2 - r**2, 0.0))
    nodes, weights = gauss(points)
    t = np.hypot(reach[..., None] * nodes, np.abs(r)[..., None])
    inside = np.minimum(t / half, 2.0) - 1.0
    slope = np.divide(chebyshev.chebval(inside, slopes), t, out=np.zeros_like(t), where=t > 0.0)
    return np.asarray(-reach * (slope @ weights) / np.pi)


@dataclass(frozen=True)
class DualEquation:
    """The equation of one layer at one contact radius, `ratio` thicknesses. Lengths count in thicknesses."""

    nu: float
    base: str
    ratio: float
    refinement: float = 1.0

    @cached_property
    def nodes(self) -> Array:
        """Places t, shape (n,), crowded at both ends: powers of t and the logarithm of a sphere's rim are met there."""
        return self.ratio * np.sin(0.5 * np.pi * self._rule[0]) ** 2

    @cached_property
    def weights(self) -> Array:
        """Weights of the integral over t, shape (n,)."""
        return self.ratio * 0.5 * np.pi * np.sin(np.pi * self._rule[0]) * self._rule[1]

    @cached_property
    def punch(self) -> Array:
        """phi of a flat punch at unit depth, shape (n,)."""
        return self.answer(np.ones_like(self.nodes))

    @cached_property
    def edge(self) -> Array:
        """What a unit of source at each node adds to phi at the edge, shape (n,), weights apart."""
        return self.answer(self._kernel_at(np.array([self.ratio]))[0])

    def answer(self, source: Array) -> Array:
        """phi at the nodes for the right-hand side at the nodes, both of shape (n,)."""
        matrix = np.eye(self.nodes.size) - self._kernel_at(self.nodes) * self.weights
        return np.asarray(np.linalg.solve(matrix, source))

    def between(self, breaks: Sequence[float]) -> tuple[Array, Array, Array, Array]:
        """Places crowded also at `breaks`, ascending, weights, and `edge` and `punch` there, each of shape (m,)."""
        if not breaks:
            return self.nodes, self.weights, self.edge, self.punch
        ends = np.array((0.0, *breaks, self.ratio))
        longest = float(np.diff(ends).max())
        share, weights = gauss(int(self.refinement * (POINTS_BETWEEN + POINTS_MORE * longest)))
        nodes = (ends[:-1, None] + np.diff(ends)[:, None] * np.sin(0.5 * np.pi * share) ** 2).ravel()
        each = (np.diff(ends)[:, None] * 0.5 * np.pi * np.sin(np.pi * share) * weights).ravel()
        u, density = self._spectrum
        waves_there = np.cos(np.outer(nodes, u)) * density
        of_edge, of_punch = ((self.weights * phi) @ np.cos(np.outer(self.nodes, u)) for phi in (self.edge, self.punch))
        return nodes, each, waves_there @ (np.cos(u * self.ratio) + of_edge), 1.0 + waves_there @ of_punch

    def correction_slope(self, phi: Array, t: Array) -> Array:
        """phi'(t) less the slope of its source, at any t; shapes (n,), (...) and (...)."""
        u, density = self._spectrum
        spectrum = -u * density * ((self.weights * phi) @ np.cos(np.multiply.outer(self.nodes, u)))
        return np.asarray(np.sin(np.multiply.outer(t, u)) @ spectrum)

    @property
    def _rule(self) -> tuple[Array, Array]:
        return gauss(int(self.refinement * (32.0 + 6.0 * self.ratio)))

    @cached_property
    def _spectrum(self) -> tuple[Array, Array]:
        """Wavenumbers and (2/pi) (1-L) du."""
        u, weights = waves(self.ratio, self.refinement)
        return u, 2.0 / np.pi * weights * deficit(self.nu, self.base, u)

    def _kernel_at(self, t: Array) -> Array:
        """k(s, t) for s at the nodes, shape (m, n)."""
        u, density = self._spectrum
        return np.asarray((np.cos(np.outer(t, u)) * density) @ np.cos(np.outer(u, self.nodes)))


@lru_cache(maxsize=1024)
def dual_equation(nu: float, base: str, ratio: float, refinement: float = 1.0) -> DualEquation:
    """The equation, with what it has already answered."""
    return DualEquation(nu, base, ratio, refinement)


@dataclass(frozen=True)
class LineLayer(LineCurve):
    """u(x) = (2/(pi E*)) int p(x') int_0^inf L(u) cos(u(x-x')/h)/u du dx': half-widths up to 20 thicknesses and to
    0.85 of a true cylinder's radius; a depth of a thickness or more raises BadInput. Relative accuracy 1e-8, or
    NotReached. Johnson 1985, ISBN 978-0-521-34796-9, chapter 5.
    """

    layer: PointLayer

    @property
    def length(self) -> float:
        """The thickness, m."""
        return self.layer.thickness

    def points(self, half_width: float) -> float:
        """The more, the wider the contact is over the thickness."""
        return 20.0 + 4.0 * half_width / self.layer.thickness

    def contact_radius(self, depth: ArrayLike) -> Array:
        """Half-width at a depth below the thickness, m; raises BadInput for deeper ones."""
        self.layer.check_depth(depth)
        return np.asarray(super().contact_radius(depth))

    def smooth(self, y: Array, half_width: float, refinement: float) -> Array:
        """Of -ln|x| = int_0^inf (cos(ux) - exp(-2u))/u du - ln 2, x in thicknesses, what the deficit takes away."""
        ratio = half_width / self.layer.thickness
        u, weights = waves(ratio, refinement)
        cosines = np.cos(np.outer(ratio * y, u))
        density = weights / u
        held = cosines * (density * deficit(self.layer.nu, self.layer.base, u)) @ cosines.T
        return np.asarray(density @ np.exp(-2.0 * u) - held + np.log(2.0) - np.log(ratio))
