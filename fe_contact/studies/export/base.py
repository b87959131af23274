"""A scene in the few numbers that another program's input needs, and the contract of a program's writer.

What is written meshes and solves by itself: it shares a scene's numbers with this suite and nothing else, so that an
answer of the other program checks ours. Our own answer stands in the file as a comment, with its error bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np

from fe_contact.indentation import indent
from fe_contact.methods import simulate
from fe_contact.settings import Given
from lumped.errors import BadInput, Fault
from lumped.materials import Relaxation
from lumped.numbers import Array
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema.members import Folder
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer

# A layer is free at its side, this many contact radii plus thicknesses away.
SIDE = 10.0


@dataclass(frozen=True, eq=False)
class PressedCylinder:
    """A cylinder that is pressed at its top, and the profile of the striker: lengths in m.

    `height`: of the profile over its tip, m, at a distance from the axis, m. `edge`: the largest contact radius.
    `held`: whether the body is infinite; cut off, its side and base are fixed. Else its side is free, and its base
    `bonded` or sliding.
    """

    height: Callable[[Array], Array]
    edge: float
    radius: float
    thickness: float
    held: bool
    bonded: bool
    nu: float

    def cut_off(self, far: float) -> PressedCylinder:
        """An infinite body ends so many contact radii away: a force at a depth is larger by 1.3 over this number."""
        return replace(self, radius=far * self.edge, thickness=far * self.edge) if self.held else self


def pressed(source: str, shape: Shape, target: Target, nu: float) -> Callable[[float], PressedCylinder]:
    """What it is by its largest contact radius, m. Raises BadInput for no round profile on a half-space or a layer."""
    if shape.plane or shape.fixed_radius is not None:
        reason = f"{shape.name}: accepted for another program: a round profile, as sphere, cone, power"
        raise BadInput(Fault(source, "striker.shape", reason))
    if isinstance(target, HalfSpace):
        return lambda edge: PressedCylinder(shape.height, edge, np.inf, np.inf, held=True, bonded=True, nu=nu)
    if isinstance(target, Layer):
        thickness, bonded = target.thickness, target.base == "bonded"
        return lambda edge: PressedCylinder(
            shape.height, edge, SIDE * (edge + thickness), thickness, held=False, bonded=bonded, nu=nu
        )
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
        check_linear(indenter.source, indenter.model)
        body = pressed(indenter.source, indenter.profile, indenter.target, indenter.material.nu)
        found = indent(indenter, (depth,), given)
        edge = float(found.contact_radius[0])
        force, error = float(found.force[0]), float(found.force_error[0])
        said = f"fe-contact indent --depths {depth:.9g}: {force:.6g} +- {error:.2g} N, contact radius {edge:.4g} m"
        return cls(indenter.name, body(edge), indenter.material.young.relaxed, depth, (said,))


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
        check_linear(scene.source, model)
        if model.inertia or model.gravity or scene.target_mass is not None or scene.motion.impacts > 1:
            reason = "accepted for another program: one impact of one mass, without inertia and gravity"
            raise BadInput(Fault(scene.source, "model", reason))
        if geometry.material.constant != "poisson" or geometry.striking is not None:
            reason = 'accepted for another program: constant = "poisson", and a rigid striker'
            raise BadInput(Fault(scene.source, "target.material", reason))
        body = pressed(scene.source, scene.profile, scene.target, geometry.material.nu)
        found = simulate(scene, "fe", given)
        edge = float(found.history.contact_radius.max())
        shown = [(name, found.quantities[name]) for name in ("peak_force", "peak_depth", "duration", "restitution")]
        said = tuple(f"fe-contact run: {name} {one}" for name, one in shown)
        duration = found.quantities["duration"].value or found.scene.end_time
        return cls(scene.name, body(edge), geometry.material.young, scene.mass, scene.velocity, duration, said)


def check_linear(source: str, model: Model) -> None:
    """Raise BadInput for a body that is not linear."""
    for key, wrong in (("kinematics", model.finite), ("plasticity", model.plasticity)):
        if wrong:
            reason = "accepted for another program: kinematics = 'small', plasticity = false"
            raise BadInput(Fault(source, f"model.{key}", reason))


class Program(Protocol):
    """A member of this folder: how another program is told a case."""

    suffix: ClassVar[str]
    how: ClassVar[str]  # what runs the file, {file} its name, {stem} that without its ending
    elements: ClassVar[int]  # along a contact radius, where nobody asks for others

    def static(self, case: StaticCase, elements: int) -> str:
        """The input file of a slow indentation."""

    def impact(self, case: ImpactCase, elements: int) -> str:
        """The input file of an impact. Raises BadInput where the program has none."""


PROGRAMS = Folder[Program]("fe_contact.studies.export", source="--to", key="")
