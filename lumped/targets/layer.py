"""A layer on a rigid foundation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.key_table import check_fields
from lumped.keys import Choice, Key, Number
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material
from lumped.radiation import Pulse
from lumped.shapes.base import Shape
from lumped.targets.base import Target

KEYS: Mapping[str, Key] = {
    "thickness": Number(1e-9, 1e6, "m"),
    "base": Choice(("bonded", "sliding")),
}


@dataclass(frozen=True)
class Layer(Target):
    """A layer of this thickness, m, bonded to a rigid foundation or sliding on it without leaving it."""

    thickness: float
    base: str
    name: ClassVar[str] = "layer"
    keys: ClassVar[Mapping[str, Key]] = KEYS
    has_inertia: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_fields("layer", self, KEYS)

    @property
    def body_depth(self) -> float:
        """Its thickness, m."""
        return self.thickness

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
        """depth - height(r)."""
        return np.asarray(np.asarray(depth, dtype=float) - shape.height(r))

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """By the layer's integral equation."""
        from lumped.load_curves.layer import Layer as Elastic
        from lumped.load_curves.layer_curve import LayerCurve, LayerPunch
        from lumped.load_curves.line_layer import LineLayer

        elastic = Elastic(self.thickness, nu, self.base)
        if shape.plane:
            return LineLayer(shape.line_profile, elastic)
        if shape.fixed_radius is not None:
            return LayerPunch(shape.fixed_radius, elastic)
        return LayerCurve(shape.load_curve, elastic)

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> tuple[float | None, str]:
        """A thin layer radiates nothing, but answers the slower the nearer its first resonance, four transits, is.

        As a spring with mass it yields more by (2 h/(c T))^2, c of waves across it, and F ~ stiffness^(2/5). A thick
        one is a half-space: the smaller of the two.
        """
        radiated, note = super().inertia_left_out(shape, material, pulse)
        if radiated is None or material.density is None:
            return radiated, note
        modulus = material.confined_modulus()
        speed = math.sqrt((modulus.relaxed or modulus.glassy) / material.density)
        resonance = 0.4 * (2.0 * self.thickness / (speed * pulse.duration)) ** 2
        if resonance >= radiated:
            return radiated, note
        return resonance, "(2 h/(c T))^2 of its compliance: the layer's first resonance; model.inertia"

    def check_depth(self, shape: Shape, depth: float) -> str:
        """Neither through the layer nor past the equator."""
        if depth >= self.thickness:
            return f"accepted below the layer's thickness {self.thickness:g} m"
        return super().check_depth(shape, depth)


def of(thickness: float, base: str) -> Layer:
    """A layer of `thickness`, m, on a `base`."""
    return Layer(thickness, base)
