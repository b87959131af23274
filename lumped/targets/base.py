"""The contract of a target: what is struck."""

from __future__ import annotations

import math
from abc import ABC
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material
from lumped.materials.plasticity import first_yield
from lumped.materials.radiation import Pulse, radiated_share
from lumped.numbers import Array
from lumped.schema import Table
from lumped.schema.keys import Record, written
from lumped.shapes._block import Block
from lumped.shapes.base import Shape
from lumped.targets._strains import Pressed, StrainField

NO_SPEED = "a dashpot alone has no wave speed"
MOVES = "{:.2g} of the striker's mass moves with it"
LOST_FORCE = 0.3  # of the peak, relatively, over the share of the energy that is lost


class LeftOut(NamedTuple):
    """What a contact errs by in its peak force without the body's inertia, relatively, None where that is not known,
    and a note; `either`: whether up or down is not known.
    """

    size: float | None
    note: str
    either: bool = False


@dataclass(frozen=True)
class FreeEnd:
    """Where plane strain ends: softer by a ``share`` of the force there, which fades over a ``reach``, m.

    As the pressure of a film does that flows out at an end: by exp(-y/reach) alone, by cosh between two of them.
    """

    share: float
    reach: float

    def softer(self, length: float) -> float:
        """By what share of its force a body of a length, m, with two of them."""
        halves = 0.5 * length / self.reach
        return self.share * math.tanh(halves) / halves


class Target(Record, ABC):
    """The geometry of a struck body; its `name` is that of the scene file, its keys stand beside its fields.

    `deformable`: whether it has a material. `has_inertia`: whether its waves can be followed; `only_with_inertia`:
    whether nothing is left of it without them. `large_strains`: whether they are built of it, or of what strikes it, at
    all. `endless`: whether it goes on beyond any mesh. `pinched`: whether it gives way as a whole where its material
    does, nothing beside it holding.
    """

    has_inertia: ClassVar[bool] = False
    only_with_inertia: ClassVar[bool] = False
    deformable: ClassVar[bool] = True
    large_strains: ClassVar[bool] = False
    endless: ClassVar[bool] = False
    pinched: ClassVar[bool] = False
    through: ClassVar[str] = ""  # what no depth may reach, where that is the height pressed
    lead: ClassVar[float] = 1.0  # how much an overlap at the first touch grows per depth
    strikers: ClassVar[tuple[str, ...]] = ()  # names of the only shapes that strike it, where it is for few
    called: ClassVar[str] = ""  # in words, where its name is none

    @property
    def owner(self) -> str:
        """The table of a scene file whose material is pressed: of a rigid target the striker's."""
        return "target" if self.deformable else "striker"

    @property
    def needs_density(self) -> str:
        """A note of the model ledger."""
        return f"needs {self.owner}.material.density"

    @property
    def has_length(self) -> bool:
        """Whether the body has a length of its own, beside which a contact is small or large."""
        return True

    @property
    def body_depth(self) -> float | None:
        """How far the body reaches beneath the contact, m; None where nothing bounds it, or its section is round."""
        return None

    def pressed_height(self, shape: Shape) -> float | None:
        """What is flattened as a whole, m, which a depth strains by its share; None where only the contact is."""
        return self.body_depth

    def strains(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> StrainField:
        """Small strains, about, at a `depth`, m, under a contact of `contact_radius`, m, as :meth:`pressed` has it."""
        return self.pressed(shape, nu, depth, contact_radius).strains()

    def pressed(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> Pressed:
        """The body as a layer, pressed by `depth`, m, so that the contact ends at `contact_radius`, m.

        Here its base holds it.
        """

        def fall(along: Array) -> Array:
            place = np.abs(along) / self.length_of_place
            return np.asarray(self.overlap(shape, 0.0, depth) - self.overlap(shape, place, depth))

        return Pressed(nu, depth, contact_radius, fall, shape.plane, self.body_depth or math.inf)

    @property
    def length_of_place(self) -> float:
        """Length along the surface per unit of its places, m."""
        return 1.0

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> Array:
        """Interpenetration of the undeformed surfaces, m, positive inside; broadcasts over r and depth, m.

        `r` is the place on the surface, zero at first touch: a radius, m, or what else the target counts in. Here that
        of a flat surface, depth - height(r).
        """
        return np.asarray(np.asarray(depth, dtype=float) - shape.height(r))

    def round_radius(self, shape: Shape) -> float:
        """Radius, m, of the smallest round surface that a contact may lie on, infinite where all are flat."""
        return shape.tip_radius or float("inf")

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """The elastic answer to this shape, exact, per unit E* (and per unit length in plane strain).

        Raises BadInput where none is known.
        """
        raise BadInput(Fault(self.name, "target.shape", "no exact load curve in this version; accepted: --method fe"))

    def contact_time(self, local: float, material: Material, mass: float) -> float:
        """Elastic contact time of a mass, kg, s, where a half-space would answer in `local`; here the same."""
        return local

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """What a contact without the body's inertia errs by.

        Here as on the half-space: waves take the share w of the energy, half of it before the peak, and
        F ~ energy^(3/5) loses 0.3 w, as does nearly a line's F ~ energy^(1/2).
        """
        found = radiated_share(material, pulse, shape.total if shape.plane else None)
        if found is None:
            return LeftOut(None, self.needs_density if material.density is None else NO_SPEED)
        said = f"radiates {min(found.share, 1.0):.2g} of the kinetic energy"
        said = f"{said}, and its material takes most of that" if found.lost else said
        return LeftOut(min(LOST_FORCE * found.share, 1.0), said, found.lost)

    def left_out_of_both(self, shape: Shape, material: Material, striking: Material, pulse: Pulse) -> LeftOut:
        """The same where the striker has a material, too: as of two half-spaces, which send off what each does."""
        own, other = self.inertia_left_out(shape, material, pulse), self.inertia_left_out(shape, striking, pulse)
        if own.size is None or other.size is None:
            needs = "needs striker.material.density" if striking.density is None else NO_SPEED
            return own if own.size is None else LeftOut(None, needs)
        both = min(own.size + other.size, 1.0)
        return LeftOut(both, f"{own.note}, its striker {other.note}", own.either or other.either)

    def mises(self, shape: Shape, nu: float, force: float, contact_radius: float) -> float:
        """Largest stress in an elastic contact under a `force`, N, of `contact_radius`, m, by von Mises, Pa.

        Hertz': the peak pressure is 3/2 of the mean, 4/pi of a line's.
        """
        if shape.plane:
            return 2.0 * force / (math.pi * contact_radius * shape.total) / first_yield(nu, plane=True)
        return 1.5 * force / (math.pi * contact_radius**2) / first_yield(nu)

    def sides(self, shape: Shape) -> str:
        """What holds the sides of what is strained alike everywhere, "free" or "confined"; empty where nothing is."""
        return ""

    def met_flat(self, shape: Shape) -> tuple[float, bool]:
        """Area, m2, that is met at once, and whether its echoes come back before they have spread. A half-space's."""
        return math.pi * shape.flat_radius**2, False

    def ends(self, shape: Shape, nu: float, contact_radius: float) -> FreeEnd | None:
        """What an end of a body as long as a shape in plane strain gives way, under a contact this wide, m.

        None where it is not known.
        """
        return None

    def waves_under(self, shape: Shape) -> bool:
        """Whether `model.inertia` can be true under a striker of this shape."""
        return self.has_inertia and shape.flat_radius == 0.0

    def rings_on(self, shape: Shape) -> bool:
        """Whether waves are left when the contact ends, so that finite elements follow one impact with them."""
        return True

    def steady_waves(self, shape: Shape) -> bool:
        """Whether its waves are followed only while Poisson's ratio stays the same."""
        return False

    def strained_instead(self, shape: Shape) -> str:
        """What can have large strains in place of this body under a striker of this shape; empty where it can."""
        if self.large_strains:
            return ""
        return "a rigid striker on target.shape = " + ('"layer"' if shape.plane else '"half_space" or "layer"')

    def yielding_faults(self, source: str, shape: Shape, inertia: bool) -> list[Fault]:
        """What is wrong with a striker of this shape that has a material as the target has, with inertia or without."""
        reason = f'target.shape = "{self.name}" is struck by a rigid body in this version; leave it out'
        return [Fault(source, "striker.material", reason)]

    def whole_mass(self, density: float) -> float | None:
        """Mass, kg, of the whole body of a density, kg/m3, which flies when struck; None where it is held."""
        return None

    def inertia_faults(self, source: str, striker: Material | None) -> list[Fault]:
        """What is wrong with this target where it has inertia, under a striker of a material or, None, a rigid one."""
        return []

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput, naming the key, for a striker which this target is not for: without `strikers` any rigid one
        will do.
        """
        if self.strikers and shape.name not in self.strikers:
            reason = f"{shape.name}: {self.called or f'a {self.name}'} is struck by a {self.strikers[0]}"
            raise BadInput(Fault(source, "striker.shape", reason))
        if isinstance(shape, Block):
            raise BadInput(Fault(source, "striker.shape", f'{shape.name}: it strikes target.shape = "plane" alone'))

    def fixed_radius(self, shape: Shape) -> float | None:
        """Contact radius that no depth changes, m; None where it grows with the depth."""
        return shape.fixed_radius

    def check_depth(self, shape: Shape, depth: float) -> str:
        """What is wrong with a depth, m, of this shape: `through` the body, or past the striker's equator; or empty."""
        height, radius = self.pressed_height(shape), shape.tip_radius
        if self.through and height is not None and depth >= height:
            return f"accepted below {self.through} {height:g} m"
        return f"accepted below the striker's radius {radius:g} m" if radius is not None and depth >= radius else ""

    def check_contact(self, contact_radius: float) -> str:
        """What is wrong with a contact as wide, m; empty where nothing is."""
        return ""

    def to_dict(self) -> Table:
        """The geometry's part of the target's table."""
        return {"shape": self.name} | written(self)


def vibrations(material: Material, pulse: Pulse) -> LeftOut:
    """A free ball's own: v/c in order of magnitude, as what is left of them (Rayleigh 1906).

    They answer the kinks with which a force t^(3/2) begins and ends: (time of a wave / contact time)^5 ~ v/c.
    """
    stiffness = material.young.spring
    if material.density is None or not stiffness:
        return LeftOut(None, NO_SPEED)
    share = math.sqrt(2.0 * pulse.energy / pulse.mass) / math.sqrt(stiffness / material.density)
    return LeftOut(min(share, 1.0), "order of magnitude: v/c, of the ball's own vibrations")
