"""A scene in the few numbers that another program's input needs, and the contract of a program's writer.

What is written meshes and solves by itself: it shares a scene's numbers with this suite and nothing else, so that an
answer of the other program checks ours. Our own answer stands in the file as a comment, with its error bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
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

# A half-space is cut off so many contact radii away, fixed there: its force at a depth is larger by about 1.3 over it.
FAR = 20_000.0
# A layer is free at its side, this many contact radii plus thicknesses away.
SIDE = 10.0
# Of a lattice: how far its lines are as dense as at the contact, along the surface and below it, in contact radii, and
# how the distances beyond grow.
REACH, DEEP, GROWTH = 1.5, 0.5, 1.5


@dataclass(frozen=True, eq=False)
class PressedCylinder:
    """A cylinder that is pressed at its top, and the profile of the striker: lengths in m.

    `height`: of the profile over its tip, m, at a distance from the axis, m. `edge`: the largest contact radius. What
    is beyond `reach` is never touched.
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

    @property
    def reach(self) -> float:
        """Of the contact along the surface, m."""
        return REACH * self.edge

    def lattice(self, elements: int, refined: int) -> tuple[Array, Array]:
        """Lines of a mesh of rectangles: distances from the axis and heights from the base up to 0, m.

        There are so many `elements` a contact radius, each then divided into `refined` a side: of two meshes one
        divides the other, and their answers tell how far both are from the exact one.
        """
        across = _graded(self.edge / elements, self.reach, self.radius)
        down = _graded(self.edge / elements, DEEP * self.edge, self.thickness)
        return _divided(across, refined), _divided(-down[::-1], refined)


def pressed(source: str, shape: Shape, target: Target, nu: float) -> Callable[[float], PressedCylinder]:
    """What it is by its largest contact radius, m. Raises BadInput for no round profile on a half-space or a layer."""
    if shape.plane or shape.fixed_radius is not None:
        reason = f"{shape.name}: accepted for another program: a round profile, as sphere, cone, power"
        raise BadInput(Fault(source, "striker.shape", reason))
    if isinstance(target, HalfSpace):
        return lambda edge: PressedCylinder(shape.height, edge, FAR * edge, FAR * edge, held=True, bonded=True, nu=nu)
    if isinstance(target, Layer):
        thickness, bonded = target.thickness, target.base == "bonded"
        return lambda edge: PressedCylinder(
            shape.height, edge, SIDE * (edge + thickness), thickness, held=False, bonded=bonded, nu=nu
        )
    reason = f"{target.name}: accepted for another program: half_space, layer"
    raise BadInput(Fault(source, "target.shape", reason))


def _graded(fine: float, dense: float, end: float) -> Array:
    """Places from 0 to ``end``, at equal distances of about ``fine`` up to ``dense``, then growing."""
    dense = min(dense, end)
    places = np.linspace(0.0, dense, max(round(dense / fine), 2) + 1).tolist()
    size = fine
    while places[-1] < end:
        size *= GROWTH
        places.append(places[-1] + size if places[-1] + 1.5 * size < end else end)
    return np.asarray(places)


def _divided(places: Array, parts: int) -> Array:
    """Every interval in equal parts."""
    return np.interp(np.arange(parts * (places.size - 1) + 1) / parts, np.arange(places.size), places)


@dataclass(frozen=True, eq=False)
class StaticCase:
    """An elastic body, `young` in Pa, pressed to a `depth`, m.

    `refined`: into how many its mesh's elements are divided a side. `said`: what this suite finds, a line each.
    """

    name: str
    body: PressedCylinder
    young: float
    depth: float
    refined: int
    said: tuple[str, ...]

    @classmethod
    def of(cls, indenter: Indenter, depth: float, refined: int, given: Given) -> StaticCase:
        """Of the relaxed material; our answer is made. Raises BadInput, NotReached."""
        check_linear(indenter.source, indenter.model)
        body = pressed(indenter.source, indenter.profile, indenter.target, indenter.material.nu)
        found = indent(indenter, (depth,), given)
        edge = float(found.contact_radius[0])
        force, error = float(found.force[0]), float(found.force_error[0])
        said = f"fe-contact indent --depths {depth:.9g}: {force:.6g} +- {error:.2g} N, contact radius {edge:.4g} m"
        return cls(indenter.name, body(edge), indenter.material.young.relaxed, depth, refined, (said,))


@dataclass(frozen=True, eq=False)
class ImpactCase:
    """A rigid `mass`, kg, that comes with a `velocity`, m/s, upon a body without inertia of the modulus E(t), `young`.

    `duration`: of the contact, s. `refined` and `said` as of a StaticCase, time's steps divided too.
    """

    name: str
    body: PressedCylinder
    young: Relaxation
    mass: float
    velocity: float
    duration: float
    refined: int
    said: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, refined: int, given: Given) -> ImpactCase:
        """Our answer is made. Raises BadInput for inertia, gravity, a free second mass; NotReached."""
        model, geometry = scene.model, scene.geometry
        check_linear(scene.source, model)
        if model.inertia or model.gravity or scene.target_mass is not None or scene.motion.impacts > 1:
            reason = "accepted for another program: one impact of one mass, without inertia and gravity"
            raise BadInput(Fault(scene.source, "model", reason))
        if geometry.material.constant != "poisson" or geometry.striking is not None:
            reason = 'accepted for another program: constant = "poisson", and a rigid striker'
            keys = ", ".join(f"{part}.material" for part, _ in geometry.yielding)
            raise BadInput(Fault(scene.source, keys, reason))
        body = pressed(scene.source, scene.profile, scene.target, geometry.material.nu)
        found = simulate(scene, "fe", given)
        edge = float(found.history.contact_radius.max())
        shown = [(name, found.quantities[name]) for name in ("peak_force", "peak_depth", "duration", "restitution")]
        said = tuple(f"fe-contact run: {name} {one}" for name, one in shown)
        duration = found.quantities["duration"].value or found.scene.end_time
        young, speed = geometry.material.young, scene.velocity
        return cls(scene.name, body(edge), young, scene.mass, speed, duration, refined, said)


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

    def static(self, case: StaticCase) -> str:
        """The input file of a slow indentation."""

    def impact(self, case: ImpactCase) -> str:
        """The input file of an impact. Raises BadInput where the program has none."""


PROGRAMS = Folder[Program]("fe_contact.studies.export", source="--to", key="")
