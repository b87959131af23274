"""From the half-space to the thin layer: local exponent and D over contact radius, by profile, base and nu.

Lengths count in thicknesses h, depths and forces in the profile's height at r = h: where strains are small, one curve
speaks for every steepness. Finite elements check points on the curves. Every exponent here is local, the slope
d ln F/d ln depth at a point.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.files import Line, lines_of
from fe_contact.studies.finite_exponents import SHARES, StrainedRow
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.load_curves.layer import LayerCurve, LayerPunch, LineLayer, PointLayer
from lumped.load_curves.plane_contact import ParabolaProfile
from lumped.load_curves.tabulated import TabulatedCurve
from lumped.materials import Material, Relaxation
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.schema import Table
from lumped.shapes import Shape
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.power import PowerProfile
from lumped.shapes.punch import Punch
from lumped.shapes.sphere import Sphere
from lumped.targets.layer import Layer

INCOMPRESSIBLE = 0.5  # physics: Poisson's ratio
FULL, QUICK = (0.0, 0.3, 0.45, 0.49, INCOMPRESSIBLE), (0.3, INCOMPRESSIBLE)  # Poisson's ratios of bonded layers
SPAN = (0.01, 10.0)  # contact radius over thickness
SMALL = 1e-3  # steepness at its end: depths stay far below the thickness
POINTS, FEW_POINTS = 61, 16  # ratios along the span, in full and quick
TOLERANCE = 3e-4  # of the indentations by finite elements
AROUND = (1.15**-2, 1.15**-1, 1.0, 1.15, 1.15**2)  # depths over that of a place: two chords, one twice as long
MIDDLE = 2  # index among them of the place itself
ANY = 0.3  # nu on a sliding base, where it does not count
TRIED = (0.1, 1.0, 5.0)  # contact radii over thickness at which finite elements check the row
PLACES = {("bonded", 0.3): TRIED, ("bonded", 0.49): TRIED[1:], ("sliding", None): TRIED[1:2]}
QUICK_PLACES = {("bonded", 0.3): TRIED[1:2]}
FINITE_NU = 0.45  # of layers that are strained much
# On them, by what a person calls them: as steep as strikers are, lengths in thicknesses.
STEEP: Mapping[str, Shape] = {
    "sphere, R = h": Sphere(1.0),
    "sphere, R = 5 h": Sphere(5.0),
    "cone of 20 degrees": Cone(20.0),
    "0.1 r^4": PowerProfile(0.1, 4.0),
    "cylinder, R = h": Cylinder(1.0, 1.0),
}
QUICK_STEEP = ("sphere, R = h",)
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

    def on_layer(self, base: str, nu: float | None) -> Line:
        """What begins all that is written of it on a layer."""
        return {"shape": self.name, "profile_exponent": self.n, "base": base, "nu": nu}

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

    @property
    def lines(self) -> list[Line]:
        """Its lines of exponents.csv; a depth under the flat end says nothing."""
        flat = np.isinf(self.profile.n)
        return lines_of(
            {
                **self.profile.on_layer(self.base, self.nu),
                "a_over_h": self.ratio,
                "method": "exact",
                "exponent": self.exponent,
                "exponent_error": 0.0,
                "D_over_row": self.factor,
                "D_over_row_error": 0.0,
                "depth_over_height": None if flat else self.depth,
                "force_over_height": None if flat else self.force,
                "row_exponent": self.profile.row,
                "thin_exponent": self.thin,
            }
        )

    def to_dict(self) -> Table:
        """Its part of exponents.json: both ends."""
        return {
            **self.profile.on_layer(self.base, self.nu),
            "row_exponent": self.profile.row,
            "thin_exponent": self.thin,
            "exponent": [float(self.exponent[0]), float(self.exponent[-1])],
            "a_over_h": [float(self.ratio[0]), float(self.ratio[-1])],
            "D_over_row": [float(self.factor[0]), float(self.factor[-1])],
        }

    @property
    def told(self) -> str:
        """One line for a person."""
        ends = f"alpha {self.exponent[0]:.3f} to {self.exponent[-1]:.3f} at a/h = {self.ratio[-1]:g}"
        return f"{self.profile.label:12s} {named(self.base, self.nu):18s} {ends}, thin limit {self.thin:.3f}"


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


@dataclass(frozen=True)
class Check:
    """One point: local `exponent` d ln F/d ln depth and `factor`, with bars; the exact ones beside."""

    profile: Profile
    base: str
    nu: float | None
    ratio: float
    exponent: Quantity
    factor: Quantity
    exact_exponent: float
    exact_factor: float
    converged: bool

    @property
    def covered(self) -> bool:
        """Whether both bars reach the exact values."""
        pairs = ((self.exponent, self.exact_exponent), (self.factor, self.exact_factor))
        return all(abs((one.value or 0.0) - exact) <= (one.error or 0.0) + 1e-9 for one, exact in pairs)

    @property
    def line(self) -> Line:
        """Its line of exponents.csv."""
        return {
            **self.profile.on_layer(self.base, self.nu),
            "a_over_h": self.ratio,
            "method": "fe",
            "exponent": self.exponent.value,
            "exponent_error": self.exponent.error,
            "D_over_row": self.factor.value,
            "D_over_row_error": self.factor.error,
            "row_exponent": self.profile.row,
            "thin_exponent": self.profile.thin(self.base, self.nu),
        }

    @property
    def told(self) -> str:
        """One line for a person."""
        return (
            f"{self.profile.label:12s} {named(self.base, self.nu):18s} a/h = {self.ratio:g} by FE: "
            f"alpha {self.exponent.value:.5f} +- {self.exponent.error:.0e} (exact {self.exact_exponent:.5f}), "
            f"D {self.factor.value:.5f} +- {self.factor.error:.0e} (exact {self.exact_factor:.5f})"
        )


def checks(quick: bool, where: Path, progress: Progress = silent, jobs: int = 1) -> tuple[Check, ...]:
    """Every named profile at a few places; rows are kept in the folder `where`. Raises NotReached."""
    calls = {
        f"{profile.label}, {named(base, nu)}, FE at a/h = {ratio:g}": partial(check, profile, base, nu, ratio)
        for profile in PROFILES
        if profile.name != "power" or (profile.n == 4.0 and not quick)
        for (base, nu), tried in (QUICK_PLACES if quick else PLACES).items()
        for ratio in tried
    }
    return tuple(journal.rows(where / KEPT, calls, progress, jobs).values())


def check(profile: Profile, base: str, nu: float | None, ratio: float) -> Check:
    """One point; raises NotReached."""
    layer = PointLayer(1.0, ANY if nu is None else nu, base)
    depth, force, exponent = _exact(profile, layer, ratio)
    around = depth * np.array(AROUND)
    shape = Punch(ratio) if np.isinf(profile.n) else profile.shape
    material, model = Material(Relaxation(1.0), layer.nu), Model(profile="parabola")
    scene = Indenter(shape, material, target=Layer(1.0, base), model=model)
    found = indent(scene, tuple(around.tolist()), {"tolerance": TOLERANCE})
    relative, level = found.force_error / found.force, found.force / found.modulus
    row = (2.0 * ratio if np.isinf(profile.n) else profile.factor) * depth**profile.row
    return Check(
        profile,
        base,
        nu,
        ratio,
        exponent=_local(np.log(around), np.log(level), relative),
        factor=Quantity(float(level[MIDDLE] / row), float(relative[MIDDLE] * level[MIDDLE] / row), "1"),
        exact_exponent=exponent,
        exact_factor=force / row,
        converged=found.converged,
    )


def finite_rows(quick: bool) -> tuple[StrainedRow, ...]:
    """Layers of unit thickness as large strains try them, against the row of the half-space."""
    shapes = {name: STEEP[name] for name in (QUICK_STEEP if quick else STEEP)}
    bases = ("bonded",) if quick else ("bonded", "sliding")
    return tuple(_strained(name, shape, base) for name, shape in shapes.items() for base in bases)


def _strained(name: str, shape: Shape, base: str) -> StrainedRow:
    material = Material(Relaxation(1.0), FINITE_NU)
    modulus = shape.modulus(material).relaxed
    factor = 0.25 * np.pi if shape.plane else float(shape.resolved("parabola").load_curve.force(1.0))
    alpha = 1.0 if shape.plane else shape.exponent_of_force
    pressed = Indenter(shape, material, target=Layer(1.0, base))
    return StrainedRow(f"{name}, {base} layer", pressed, SHARES, factor * modulus, alpha, shape.tip_radius, 1.0)


def _local(depth: Array, force: Array, error: Array) -> Quantity:
    """The slope in the middle of five logarithms, by both chords, whose difference counts in the bar."""
    slopes, errors = np.empty(2), np.empty(2)
    for i in range(2):  # the long one, the short one
        span = depth[-1 - i] - depth[i]
        slopes[i], errors[i] = (force[-1 - i] - force[i]) / span, (error[i] + error[-1 - i]) / span
    bent = (slopes[1] - slopes[0]) / 3.0
    return Quantity(float(slopes[1] + bent), float((4.0 * errors[1] + errors[0]) / 3.0 + abs(bent)), "1")


def _exact(profile: Profile, layer: PointLayer, ratio: float) -> tuple[float, float, float]:
    """The depth with this contact radius, in thicknesses, the force there over E*, and the local exponent."""
    if np.isinf(profile.n):
        return SMALL, float(LayerPunch(ratio, layer).stiffness) * SMALL, 1.0
    here = profile.on(layer).at(np.asarray(ratio))
    return float(here.depth), float(here.force), float(here.stiffness * here.depth / here.force)
