"""A layer on a rigid foundation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.base import LoadCurve
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.schema.key_table import check_fields
from lumped.schema.keys import Choice, Key, Number
from lumped.shapes.base import Shape
from lumped.targets._layer_mass import moving_share
from lumped.targets.base import MOVES, Target

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
        from lumped.load_curves.layer import PointLayer as Elastic
        from lumped.load_curves.layer_curve import LayerCurve, LayerPunch
        from lumped.load_curves.line_layer import LineLayer

        elastic = Elastic(self.thickness, nu, self.base)
        if shape.plane:
            return LineLayer(shape.line_profile, elastic)
        if shape.fixed_radius is not None:
            return LayerPunch(shape.fixed_radius, elastic)
        return LayerCurve(shape.load_curve, elastic)

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> tuple[float | None, str]:
        """What of the layer moves with the striker adds m_a to its mass m: the peak force falls by m_a/m.

        A thick one is a half-space: the smaller of the two.
        """
        radiated, note = super().inertia_left_out(shape, material, pulse)
        if material.density is None:
            return radiated, note
        modulus, a = material.contact_modulus(), pulse.radius
        plate = math.sqrt((modulus.relaxed or modulus.glassy) / material.density)
        way = 0.25 * plate * pulse.duration / self.thickness  # half as far as its waves go until the peak
        share = moving_share(material.nu, self.base, a / self.thickness, way, shape.plane)
        area = 2.0 * a * shape.total if shape.plane else math.pi * a**2
        added = share * material.density * area * self.thickness / pulse.mass
        if radiated is not None and radiated <= added:
            return radiated, note
        return added, MOVES.format(added)

    def check_depth(self, shape: Shape, depth: float) -> str:
        """Neither through the layer nor past the equator."""
        if depth >= self.thickness:
            return f"accepted below the layer's thickness {self.thickness:g} m"
        return super().check_depth(shape, depth)


def of(thickness: float, base: str) -> Layer:
    """A layer of `thickness`, m, on a `base`."""
    return Layer(thickness, base)
