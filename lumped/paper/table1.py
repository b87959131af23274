"""The paper's Table 1, F = D(A, R, l) E* depth^alpha "(17)": eight contact geometries."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, radians, sqrt, tan
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.materials import Material, Relaxation
from lumped.numbers import Real
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.schema.keys import Key, Record, keys_of, written
from lumped.shapes import Shape
from lumped.shapes.base import SIZE
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.plate import Plate
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.shapes.sphere import Sphere
from lumped.targets import Target
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.half_space import HalfSpace
from lumped.targets.layer import Layer
from lumped.targets.plane import Plane
from lumped.targets.sphere import SphereTarget

Radius = Annotated[float, Key(SIZE, "radius")]
Thickness = Annotated[float, Key(SIZE, "thickness along the motion")]
Along = Annotated[float, Key(keys_of(Cylinder)["length"].kind, "length along the axis")]
LAYER = 10.0  # thickness over radius


class Elastic(NamedTuple):
    """Young's modulus, Pa, and Poisson's ratio of one body."""

    young: float
    nu: float


class TableRow(Record, ABC):
    """F = D E* depth^alpha for one geometry; lengths in m, areas in m^2. Raises BadInput for a length out of range.

    `number` is the row's place, `case` what the paper calls it, `printed` its D and E* as printed and `corrected`
    as they should be, `validity` where the row holds; `correction` says what is wrong and why, empty where nothing
    is. `length_name` names the length which depths are compared with, empty where the geometry has none. `single`:
    whether the half-space has one D at all. `profile`: that of the slow indentation which puts the row on trial.
    `bodies`: how many of them deform. `block`: whether it presses a block between two faces.
    """

    number: ClassVar[int]
    case: ClassVar[str]
    printed: ClassVar[tuple[str, str]]
    corrected: ClassVar[tuple[str, str]]
    length_name: ClassVar[str]
    alpha: ClassVar[float]
    validity: ClassVar[str]
    correction: ClassVar[str] = ""
    single: ClassVar[bool] = True
    profile: ClassVar[str] = "exact"
    bodies: ClassVar[int] = 1
    block: ClassVar[bool] = False

    @property
    @abstractmethod
    def factor(self) -> float:
        """D as printed, m^(2-alpha)."""

    @property
    def length(self) -> float:
        """The length which depths are compared with, m: a metre where the geometry has none."""
        return float(getattr(self, self.length_name, 1.0))

    def modulus(self, *bodies: Elastic) -> float:
        """E* as it should be, Pa: of half-spaces in series, so E/(1-nu^2) of one alone, unless a row says otherwise."""
        return contact_modulus(*bodies)

    def printed_modulus(self, *bodies: Elastic) -> float:
        """E* as printed, Pa: the right one unless a row says otherwise."""
        return self.modulus(*bodies)

    @property
    @abstractmethod
    def contact(self) -> tuple[Shape, Target]:
        """What is pressed into what, in the slow indentation that puts the row on trial."""

    def scene(self, *bodies: Elastic) -> Indenter:
        """That indentation, of the one body that deforms, or of striker and target. Raises BadInput."""
        return pressed(self.name, *self.contact, *bodies, profile=self.profile)

    def whole_scene(self, *bodies: Elastic) -> Indenter:
        """The same with bodies of their true size, where the row takes them for half-spaces."""
        return self.scene(*bodies)

    def force(self, depth: ArrayLike, *bodies: Elastic) -> Real:
        """D E* depth^alpha with the corrected E*, N; depths below zero count as zero. Raises BadInput."""
        if len(bodies) != self.bodies:
            raise BadInput(Fault(self.name, "bodies", f"accepted {self.bodies}, got {len(bodies)}"))
        return self.factor * self.modulus(*bodies) * np.maximum(depth, 0.0) ** self.alpha

    def to_dict(self) -> dict[str, object]:
        """The geometry, by the names of its lengths."""
        return written(self)


def pressed(name: str, shape: Shape, target: Target, *bodies: Elastic, profile: str = "exact") -> Indenter:
    """A shape pressed into a target, of the one body that deforms, or of striker and target. Raises BadInput."""
    first, *others = (Material(Relaxation(body.young), body.nu) for body in bodies)
    return Indenter(
        shape,
        others[0] if others else first,
        target,
        striker_material=first if others else None,
        model=Model(profile=profile),
        name=f"table1-{name}",
    )


def contact_modulus(*bodies: Elastic) -> float:
    """1/E* = sum of (1-nu^2)/E over the bodies that deform, Pa: of half-spaces in series (Hertz 1882)."""
    return 1.0 / sum((1.0 - nu**2) / young for young, nu in bodies)


@dataclass(frozen=True)
class BlockRow(TableRow):
    """F = (A/l) E* depth: a block between two faces, uniformly strained."""

    area: Annotated[float, Key(keys_of(Prism)["area"].kind, "area of a face")]
    alpha = 1.0
    block = True

    @property
    def factor(self) -> float:
        """A/l, m."""
        return self.area / self.length


@dataclass(frozen=True)
class PrismRow(BlockRow):
    """F = (A/l) E depth: uniaxial stress."""

    height: Thickness
    number = 1
    name = "prism"
    case = "polyhedral cylinder to rigid plane"
    printed = ("A/l", "E")
    corrected = printed
    length_name = "height"
    validity = "free sides, ends that slide: any nu, any slenderness"

    def modulus(self, *bodies: Elastic) -> float:
        """E, Pa."""
        return bodies[0].young

    @property
    def contact(self) -> tuple[Shape, Target]:
        """Free sides, faces that slide."""
        return Prism(self.area, self.height, "free", "sliding"), Plane()


@dataclass(frozen=True)
class PlateRow(BlockRow):
    """F = (A/l) M depth with the confined modulus M = K + 4 G/3: uniaxial strain."""

    thickness: Thickness
    number = 2
    name = "plate"
    case = "thin plate to rigid plane"
    printed = ("A/l", "E(1-nu)/((1+nu)(1-2nu))")
    corrected = printed
    length_name = "thickness"
    validity = "confined sides, or bonded faces far wider than l; nu < 0.5"

    def modulus(self, *bodies: Elastic) -> float:
        """The confined modulus, Pa. Raises BadInput where it is infinite."""
        (young, nu), *_ = bodies
        return Material(Relaxation(young), nu).confined_modulus().relaxed

    @property
    def contact(self) -> tuple[Shape, Target]:
        """Confined sides."""
        return Plate(self.area, self.thickness), Plane()


@dataclass(frozen=True)
class RoundRow(TableRow):
    """A round body, pressed into the half-space."""

    radius: Radius
    length_name = "radius"


class HertzRow(TableRow):
    """F = (4/3) sqrt(R) E* depth^(3/2) (Hertz 1882): half-spaces under paraboloids."""

    alpha = 1.5

    @property
    def factor(self) -> float:
        """(4/3) sqrt(R), m^(1/2)."""
        return 4.0 / 3.0 * sqrt(self.length)


class LineRow(TableRow):
    """F = (pi/4) l E* depth, a heuristic (Popov 2010, ISBN 978-3-642-10802-0, section 5.2); `height` is l."""

    height: float
    alpha = 1.0
    single = False
    profile = "parabola"

    @property
    def factor(self) -> float:
        """pi l/4, m."""
        return 0.25 * pi * self.height


@dataclass(frozen=True)
class PunchRow(RoundRow):
    """F = 2 R E* depth (Boussinesq 1885)."""

    number = 3
    name = "punch"
    case = "rigid cylinder to elastic plane"
    printed = ("2R", "E/(1-nu^2)")
    corrected = printed
    alpha = 1.0
    validity = "a flat end on a half-space: any depth of small strains"

    @property
    def factor(self) -> float:
        """2 R, m."""
        return 2.0 * self.radius

    @property
    def contact(self) -> tuple[Shape, Target]:
        """On the half-space."""
        return Punch(self.radius), HalfSpace()


@dataclass(frozen=True)
class SphereRow(RoundRow, HertzRow):
    """F = (4/3) sqrt(R) E* depth^(3/2) (Hertz 1882): the paraboloid of the sphere's tip."""

    number = 4
    name = "sphere"
    case = "rigid sphere to elastic plane"
    printed = ("(4/3) sqrt(R)", "E/(1-nu^2)")
    corrected = printed
    validity = "depths far below R on a half-space: a sphere is steeper than its paraboloid"

    @property
    def contact(self) -> tuple[Shape, Target]:
        """On the half-space."""
        return Sphere(self.radius), HalfSpace()


@dataclass(frozen=True)
class CylinderRow(RoundRow, LineRow):
    """F = (pi/4) l E* depth, a heuristic (Popov 2010, ISBN 978-3-642-10802-0, section 5.2); `height` is l."""

    height: Along
    number = 5
    name = "cylinder"
    case = "rigid cylinder to elastic plane (curvature surface contact)"
    printed = ("pi l/4", "E/(1-nu^2)")
    corrected = ("none: F/(E* depth) depends on the datum", "E/(1-nu^2)")
    validity = "one depth of each layer or datum: where 2 ln(2 datum/b) - nu/(1-nu) = 4"
    correction = (
        "in plane strain the half-plane has no finite compliance: "
        "depth = F/(pi E* l) [2 ln(2 datum/b) - nu/(1-nu)] (Johnson 1985, section 5.6)"
    )

    @property
    def contact(self) -> tuple[Shape, Target]:
        """On a thick layer, whose thickness stands for the datum."""
        return Cylinder(self.radius, self.height), Layer(LAYER * self.radius, "bonded")


@dataclass(frozen=True)
class ConeRow(TableRow):
    """F = 2/(pi tan(theta)) E* depth^2 (Sneddon, doi 10.1016/0020-7225(65)90019-4); `angle` is theta, degrees."""

    angle: Annotated[float, Key(keys_of(Cone)["angle"].kind, "theta")]
    number = 6
    name = "cone"
    case = "rigid cone to elastic plane"
    printed = ("2/(pi tan theta)", "E")
    corrected = ("2/(pi tan theta)", "E/(1-nu^2)")
    length_name = ""
    alpha = 2.0
    validity = "theta between face and undeformed surface; small angles, where strains are small"
    correction = "E* lacks 1/(1-nu^2): a half-space, whatever is pressed into it, answers with E/(1-nu^2)"

    @property
    def factor(self) -> float:
        """2/(pi tan(theta))."""
        return 2.0 / (pi * tan(radians(self.angle)))

    def printed_modulus(self, *bodies: Elastic) -> float:
        """E, Pa."""
        return bodies[0].young

    @property
    def contact(self) -> tuple[Shape, Target]:
        """On the half-space."""
        return Cone(self.angle), HalfSpace()


@dataclass(frozen=True)
class PairRow(TableRow):
    """Two round bodies, which both deform: half-spaces under the gap between them."""

    radius: Radius
    other_radius: Radius
    length_name = "gap's radius"
    bodies = 2

    @property
    def length(self) -> float:
        """R of the gap, 1/R = 1/R_a + 1/R_b, m."""
        return self.radius * self.other_radius / (self.radius + self.other_radius)


@dataclass(frozen=True)
class TwoSpheres(PairRow, HertzRow):
    """F = (4/3) sqrt(R) E* depth^(3/2), 1/R = 1/R_a + 1/R_b (Hertz 1882): two half-spaces under paraboloids."""

    number = 7
    name = "two_spheres"
    case = "elastic curvature surface to elastic curvature surface"
    printed = ("(4/3) sqrt(Ra Rb/(Ra+Rb))", "1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)")
    corrected = printed
    validity = "contacts far smaller than either sphere"

    @property
    def contact(self) -> tuple[Shape, Target]:
        """Two half-spaces under the gap of both spheres."""
        return Sphere(self.radius), SphereTarget(self.other_radius)

    def whole_scene(self, *bodies: Elastic) -> Indenter:
        """Both spheres free; depth is the approach of their centres of mass."""
        return pressed(self.name, Sphere(self.radius), SphereTarget(self.other_radius, "free"), *bodies)


@dataclass(frozen=True)
class TwoCylinders(PairRow, LineRow):
    """F = (pi/4) l E* depth, a heuristic (Popov 2010, ISBN 978-3-642-10802-0, section 5.2); `height` is l."""

    height: Along
    number = 8
    name = "two_cylinders"
    case = "elastic cylinder to elastic cylinder (parallel contact)"
    printed = ("pi l/4", "1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)")
    corrected = ("none: F/(E* depth) depends on where each cylinder is held", printed[1])
    validity = "one depth of each way to hold the cylinders"
    correction = (
        "in plane strain no body has a compliance of its own: to the approach each adds F (1-nu^2)/(pi E l) "
        "[2 ln(2 datum/b) - nu/(1-nu)], its datum where it is held (Johnson 1985, section 5.6)"
    )

    @property
    def contact(self) -> tuple[Shape, Target]:
        """The struck one held at its middle plane."""
        return Cylinder(self.radius, self.height), CylinderTarget(self.other_radius, "held")


# One example of every row, by its name, in the order of the table.
ROWS: Mapping[str, TableRow] = {
    row.name: row
    for row in (
        PrismRow(area=1e-4, height=0.02),
        PlateRow(area=1e-2, thickness=1e-3),
        PunchRow(radius=0.01),
        SphereRow(radius=0.01),
        CylinderRow(radius=0.01, height=0.01),
        ConeRow(angle=20.0),
        TwoSpheres(radius=0.01, other_radius=0.02),
        TwoCylinders(radius=0.01, other_radius=0.02, height=0.01),
    )
}
