"""A scene in the few numbers that another program's input needs, and the contract of a program's writer.

What is written meshes and solves by itself: it shares a scene's numbers with this suite and nothing else, so that an
answer of the other program checks ours. Our own answer stands in the file as a comment, with its error bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

from fe_contact.indentation import indent
from fe_contact.methods import simulate
from fe_contact.settings import Given
from lumped.errors import BadInput, Fault
from lumped.materials import Relaxation
from lumped.numbers import Array
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema.members import Folder
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer

# A half-space is cut off so many contact radii away, fixed there: its force at a depth is larger by 1.3 over this number.
FAR = 200.0
# A layer is free at its side, this many contact radii plus thicknesses away.
SIDE = 10.0


@dataclass(frozen=True, eq=False)
class PressedCylinder:
    """A cylinder that is pressed at its top, and the profile of the striker: lengths in m.

    `height`: of the profile over its tip, m, at a distance from the axis, m. `edge`: the largest contact radius.
    `held`: whether the side and the base are fixed, as those of a body cut off from an infinite one; else the side is
    free, and the base `bonded` or sliding.
    """

    height: Callable[[Array], Array]
    edge: float
    radius: float
    thickness: float
    held: bool
    bonded: bool
    nu: float

    @classmethod
    def of(cls, source: str, shape: Shape, target: Target, nu: float, edge: float) -> PressedCylinder:
        """Raises BadInput for what is no round profile on a half-space or a layer."""
        if shape.plane or shape.fixed_radius is not None:
            reason = f"{shape.name}: accepted for another program: a round profile, as sphere, cone, power"
            raise BadInput(Fault(source, "striker.shape", reason))
        if isinstance(target, HalfSpace):
            return cls(shape.height, edge, FAR * edge, FAR * edge, held=True, bonded=True, nu=nu)
        if isinstance(target, Layer):
            wide, bonded = SIDE * (edge + target.thickness), target.base == "bonded"
            return cls(shape.height, edge, wide, target.thickness, held=False, bonded=bonded, nu=nu)
        reason = f"{target.name}: accepted for another program: half_space, layer"
        raise BadInput(Fault(source, "target.shape", reason))


@dataclass(frozen=True, eq=False)
class StaticCase:
    """An elastic body, `young` in Pa, pressed to a `depth`, m; `said`: what this suite finds, a line each."""

    name: str
    body: PressedCylinder
    young: float
    depth: float
    said: tuple[str, ...]

    @classmethod
    def of(cls, indenter: Indenter, depth: float, given: Given) -> StaticCase:
        """Of the relaxed material; our answer is made. Raises BadInput, NotReached."""
        found = indent(indenter, (depth,), given)
        edge = float(found.contact_radius[0])
        body = PressedCylinder.of(indenter.source, indenter.profile, indenter.target, indenter.material.nu, edge)
        force, error = float(found.force[0]), float(found.force_error[0])
        said = f"fe-contact indent --depths {depth:.9g}: {force:.6g} +- {error:.2g} N, contact radius {edge:.4g} m"
        return cls(indenter.name, body, indenter.material.young.relaxed, depth, (said,))


@dataclass(frozen=True, eq=False)
class ImpactCase:
    """A rigid `mass`, kg, that comes with a `velocity`, m/s, upon a body without inertia of the modulus E(t), `young`.

    `duration`: of the contact, s.
    """

    name: str
    body: PressedCylinder
    young: Relaxation
    mass: float
    velocity: float
    duration: float
    said: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, given: Given) -> ImpactCase:
        """Our answer is made. Raises BadInput for inertia, gravity, a free second mass; NotReached."""
        model, geometry = scene.model, scene.geometry
        if model.inertia or model.gravity or model.finite or scene.target_mass is not None or scene.motion.impacts > 1:
            reason = "accepted for another program: one impact of one mass, without inertia, gravity, large strains"
            raise BadInput(Fault(scene.source, "model", reason))
        if geometry.material.constant != "poisson" or geometry.striking is not None:
            reason = 'accepted for another program: constant = "poisson", and a rigid striker'
            raise BadInput(Fault(scene.source, "target.material", reason))
        found = simulate(scene, "fe", given)
        edge = float(found.history.contact_radius.max())
        body = PressedCylinder.of(scene.source, scene.profile, scene.target, geometry.material.nu, edge)
        shown = [(name, found.quantities[name]) for name in ("peak_force", "peak_depth", "duration", "restitution")]
        said = tuple(
            f"fe-contact run: {name} {one.value:.6g} +- {one.error or 0.0:.2g} {one.unit}" for name, one in shown
        )
        duration = found.quantities["duration"].value or found.scene.end_time
        return cls(scene.name, body, geometry.material.young, scene.mass, scene.velocity, duration, said)


class Program(Protocol):
    """A member of this folder: how another program is told a case."""

    suffix: ClassVar[str]
    how: ClassVar[str]  # what runs the file, {file} its name

    def static(self, case: StaticCase) -> str:
        """The input file of a slow indentation."""

    def impact(self, case: ImpactCase) -> str:
        """The input file of an impact. Raises BadInput where the program has none."""


PROGRAMS = Folder[Program]("fe_contact.studies.export", source="--to", key="")
