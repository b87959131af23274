"""Any convex axisymmetric profile on an elastic layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.dual_equation import DualEquation, dual_equation
from lumped.load_curves.fixed_area import FixedArea, under_flat_end
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.load_curves.layer import Array, Layer
from lumped.load_curves.tabulated import REACH, State, TabulatedCurve, growing_edges
from lumped.numbers.quadrature import gauss


@dataclass(frozen=True)
class LayerCurve(TabulatedCurve):
    """What a layer answers to the profile which the half-space answers by the curve `half_space`.

    Contact radii up to 20 thicknesses and up to 0.85 of a sphere's radius; a depth of a thickness or more raises
    BadInput. Relative accuracy 1e-8, or NotReached.
    """

    half_space: LoadCurve
    layer: Layer

    def __post_init__(self) -> None:
        if not isinstance(self.half_space, HalfSpaceCurve):
            message = "must be a curve of the half-space under a profile that touches at a point"
            raise BadInput(Fault("layer", "half_space", message))

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels grow with the distance from the axis."""
        return growing_edges(self.layer.thickness, self.half_space.extent)

    def sample(self, contact_radius: float, refinement: float) -> Array:
        """Depth, force and stiffness over those of the half-space at this contact radius."""
        equation, h = self._equation(contact_radius, refinement), self.layer.thickness
        profile = self.half_space.depth(h * equation.nodes)
        punch, edge, weights = equation.punch, equation.edge, equation.weights
        own = float(self.half_space.depth(contact_radius))
        depth = (own + (weights * edge) @ profile) / (1.0 + weights @ edge)
        force = 2.0 * h * ((weights * punch) @ (depth - profile))
        stiffness = 2.0 * h * (weights @ punch)
        return np.array([depth / own, force / self._own_force(contact_radius), stiffness / (2.0 * contact_radius)])

    def state(self, contact_radius: Array, smooth: Array, slopes: Array) -> State:
        """The half-space's values times the tabulated ratios."""
        a, own = contact_radius, self.half_space.depth(contact_radius)
        slope = self.half_space.depth_slope(a) * smooth[0] + own * slopes[0]
        return State(own * smooth[0], slope, self._own_force(a) * smooth[1], 2.0 * a * smooth[2])

    def contact_radius(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Contact radius a at a depth below the thickness, m; raises BadInput for deeper ones."""
        self.layer.check_depth(depth)
        return np.asarray(super().contact_radius(depth))

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """p(r)/E* = -(1/pi) int_r^a phi'(t)/sqrt(t^2-r^2) dt, zero outside: the half-space's and a smooth part."""
        equation = self._equation(contact_radius, 1.0)
        depth = float(self.depth(contact_radius))
        phi = equation.answer(depth - self.half_space.depth(self.layer.thickness * equation.nodes))
        inner = abel(equation, phi, np.asarray(radius, dtype=float) / self.layer.thickness)
        return self.half_space.pressure(radius, contact_radius) + inner / self.layer.thickness

    def _own_force(self, contact_radius: ArrayLike) -> NDArray[np.float64]:
        """F/E* of the half-space at this contact radius, m^2."""
        return np.asarray(self.half_space.force_at(contact_radius))

    def _equation(self, contact_radius: float, refinement: float) -> DualEquation:
        ratio = contact_radius / self.layer.thickness
        return dual_equation(self.layer.nu, self.layer.base, ratio, refinement)


@dataclass(frozen=True)
class LayerPunch(FixedArea):
    """A flat-ended cylinder of this radius, up to 20 thicknesses, on a layer: F = 2 kappa E* a depth.

    Raises BadInput beyond. Hayes et al. 1972, J. Biomech. 5, 541-551, tabulate kappa.
    """

    radius: float
    layer: Layer
    accuracy: ClassVar[float] = 1e-10

    def __post_init__(self) -> None:
        reach = REACH * self.layer.thickness
        if not 0.0 < self.radius <= reach:
            raise BadInput(Fault("punch", "radius", f"must lie above 0 and up to {reach:g} m, is {self.radius}"))

    @cached_property
    def stiffness(self) -> float:
        """2 kappa a, m."""
        return float(2.0 * self.layer.thickness * (self._equation.weights @ self._equation.punch))

    def pressure_at(self, radius: ArrayLike, depth: float) -> NDArray[np.float64]:
        """(1/pi) [phi(a)/sqrt(a^2-r^2) - int_r^a phi'/sqrt(t^2-r^2) dt] with the punch's phi."""
        equation, pressed = self._equation, max(depth, 0.0)
        edge = pressed * (1.0 + float(equation.weights @ equation.edge))
        inner = abel(equation, pressed * equation.punch, np.asarray(radius, dtype=float) / self.layer.thickness)
        return under_flat_end(radius, self.radius, edge) + inner / self.layer.thickness

    @property
    def _equation(self) -> DualEquation:
        return dual_equation(self.layer.nu, self.layer.base, self.radius / self.layer.thickness)


def abel(equation: DualEquation, phi: Array, r: Array) -> Array:
    """-(1/pi) int_r^ratio psi'(t)/sqrt(t^2-r^2) dt of phi's smooth part psi, r in thicknesses, zero outside."""
    reach = np.sqrt(np.maximum(equation.ratio**2 - r**2, 0.0))
    nodes, weights = gauss(equation.nodes.size)
    t = np.hypot(reach[..., None] * nodes, np.abs(r)[..., None])
    slope = np.divide(equation.correction_slope(phi, t), t, out=np.zeros_like(t), where=t > 0.0)
    return np.asarray(-reach * (slope @ weights) / np.pi)
