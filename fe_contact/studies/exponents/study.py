"""From the half-space to the thin layer: local exponent and D over contact radius, by profile, base and nu.

Lengths count in thicknesses h, depths and forces in the profile's height at r = h: where strains are small, one curve
speaks for every steepness.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.load_curves.layer import LayerCurve, LayerPunch, LineLayer, PointLayer
from lumped.load_curves.plane_contact import ParabolaProfile
from lumped.load_curves.tabulated import TabulatedCurve
from lumped.shapes import Shape
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.power import PowerProfile
from lumped.shapes.sphere import Sphere

INCOMPRESSIBLE = 0.5
FULL, QUICK = (0.0, 0.3, 0.45, 0.49, INCOMPRESSIBLE), (0.3, INCOMPRESSIBLE)
SPAN = (0.01, 10.0)  # contact radius over thickness
SMALL = 1e-3  # steepness at its end: depths stay far below the thickness
POINTS, FEW_POINTS = 61, 16
KEPT = "exponents.jsonl"


@dataclass(frozen=True)
class Profile:
    """A shape of the study: height ~ r^n, `n` infinite for the flat end; `plane`: per unit length."""

    name: str
    n: float
    plane: bool = False

    @property
    def label(self) -> str:
        """What a person calls it."""
        return f"r^{self.n:g}" if self.name == "power" else self.name

    @property
    def row(self) -> float:
        """alpha of Table 1's row: 1 + 1/n on the half-space; 1 for the cylinder, which has none there."""
        return 1.0 if self.plane else 1.0 + 1.0 / self.n

    def thin(self, base: str, nu: float | None) -> float:
        """alpha far beyond a/h = 1: strips of their own, or, incompressible and bonded, squeezed like a fluid."""
        squeezed = base == "bonded" and nu == INCOMPRESSIBLE
        return 1.0 + (((3.0 if self.plane else 4.0) if squeezed else (1.0 if self.plane else 2.0)) / self.n)

    @property
    def coefficient(self) -> float:
        """c of the height c r^n: that at r = h over h."""
        return float(SMALL / SPAN[1] ** (self.n - 1.0))

    @property
    def shape(self) -> Shape:
        """The striker, but for the flat end, whose radius is the contact's."""
        radius = 0.5 / self.coefficient
        match self.name:
            case "sphere":
                return Sphere(radius)
            case "cylinder":
                return Cylinder(radius, 1.0)
            case "cone":
                return Cone(math.degrees(math.atan(self.coefficient)))
        return PowerProfile(self.coefficient, self.n)

    @property
    def factor(self) -> float:
        """D of the row."""
        return 0.25 * np.pi if self.plane else float(self._half_space.force(1.0))

    def on(self, layer: PointLayer) -> TabulatedCurve:
        """The profile, a parabola where it is round, on a layer."""
        if self.plane:
            return LineLayer(ParabolaProfile(0.5 / self.coefficient), layer)
        return LayerCurve(self._half_space, layer)

    @property
    def _half_space(self) -> HalfSpaceCurve:
        """The axisymmetric profile on the half-space."""
        curve = self.shape.resolved("parabola").load_curve
        assert isinstance(curve, HalfSpaceCurve)
        return curve


PROFILES = (
    Profile("cone", 1.0),
    Profile("power", 1.5),
    Profile("sphere", 2.0),
    Profile("power", 4.0),
    Profile("power", 8.0),
    Profile("punch", np.inf),
    Profile("cylinder", 2.0, plane=True),
)


@dataclass(frozen=True, eq=False)
class ExponentCurve:
    """Local exponent d ln F/d ln depth and `factor`, F/(E* depth^alpha) over D of Table 1's row, at `ratio` a/h.

    `depth` over the profile's height at r = h, `force` over E* h times that height (in plane strain over E* and the
    height, per unit length); under the flat end depth is 1. All of shape (n,). `nu` None: any.
    """

    profile: Profile
    base: str
    nu: float | None
    ratio: Array
    exponent: Array
    factor: Array
    depth: Array
    force: Array

    @property
    def thin(self) -> float:
        """The exponent which it tends to."""
        return self.profile.thin(self.base, self.nu)


def curves(quick: bool, where: Path, progress: Progress = silent) -> tuple[ExponentCurve, ...]:
    """Every profile on every layer: bonded with each nu, and sliding, where nothing but E* knows nu.

    Rows are kept in the folder `where`. Raises NotReached.
    """
    ratio = tuple(np.geomspace(*SPAN, FEW_POINTS if quick else POINTS).tolist())
    calls = {
        f"{profile.label}, {named(base, nu)}": partial(curve, profile, base, nu, ratio)
        for profile in PROFILES
        for base, nu in layers(quick)
    }
    return tuple(journal.rows(where / KEPT, calls, progress).values())


def layers(quick: bool) -> Iterator[tuple[str, float | None]]:
    """Base and nu of every layer."""
    yield from (("bonded", nu) for nu in (QUICK if quick else FULL))
    yield "sliding", None


def named(base: str, nu: float | None) -> str:
    """What a person calls a layer."""
    return f"{base}, " + ("any nu" if nu is None else f"nu = {nu:g}")


def curve(profile: Profile, base: str, nu: float | None, ratio: Sequence[float] | Array) -> ExponentCurve:
    """One profile on one layer at contact radii over thickness, shape (n,). Raises NotReached."""
    ratio = np.asarray(ratio)
    layer = PointLayer(1.0, INCOMPRESSIBLE if nu is None else nu, base)
    if np.isinf(profile.n):
        kappa = np.array([LayerPunch(float(a), layer).stiffness for a in ratio]) / (2.0 * ratio)
        one = np.ones_like(ratio)
        return ExponentCurve(profile, base, nu, ratio, one, kappa, one, 2.0 * ratio * kappa)
    here = profile.on(layer).at(ratio)
    factor = here.force / (profile.factor * here.depth**profile.row)
    exponent, height = here.stiffness * here.depth / here.force, profile.coefficient
    return ExponentCurve(profile, base, nu, ratio, exponent, factor, here.depth / height, here.force / height)
