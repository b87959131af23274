"""Fields of a half-space that yields at the largest force, and the indentation left: its finest mesh once more.

Stress and plastic strain live at the points of the elements: in each they are read by the polynomial nearest to them,
of the degree of strains, and a node takes the mean of its elements. The fields end where nothing may yield, eight or
sixteen contact radii away.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array, Indices
from fe_contact.fields import Fields, at_nodes, subdivided, written
from fe_contact.plastic.course import Course, within_core
from fe_contact.plastic.ground import Ground
from fe_contact.plastic.impact import Runner, pilot, released_power
from fe_contact.plastic.path import Station, parting
from fe_contact.progress import silent
from fe_contact.settings import Numerics
from lumped.result.result import Result
from lumped.scene.scene import Scene

STRESS = [0, 3, 4, 1]  # rr, zz, hoop, rz among those of a gradient


@dataclass(frozen=True, eq=False)
class Dented:
    """Heights (n,), m, of the surface over its radius (n,), m: at the largest force, and ``left`` when it is over."""

    radius: Array
    pressed: Array
    left: Array


@dataclass(frozen=True, eq=False)
class PressedAgain:
    """A ``ground`` at the largest force, ``peak``, and at the end, ``left`` (2 N,) its displacement."""

    course: Course
    ground: Ground
    peak: Station
    left: Array

    @classmethod
    def of(cls, scene: Scene, result: Result) -> PressedAgain:
        """With the settings that the result ended with. Raises NotReached."""
        known, numerics = pilot(scene), Numerics(**result.numerics)
        course = known.course.outgrown(numerics.contact_radius / float(known.march.radius.max()))
        return within_core(course, partial(cls._of, scene, numerics))

    @classmethod
    def _of(cls, scene: Scene, numerics: Numerics, course: Course) -> PressedAgain:
        power = released_power(course)
        loading, _, places = Runner(scene, course, silent).pressed(numerics, False)
        before, last = places[-2:]
        on = (last.depth - parting(before, last, power)) / (before.depth - last.depth)
        left = last.displacement + on * (last.displacement - before.displacement)
        return cls(course, loading.presser.ground, places[0], left)

    @property
    def dent(self) -> Dented:
        """The surface, as far as the body may yield."""
        basis, unit = self.ground.basis, self.course.unit * self.peak.scale
        nodes = self._nodes
        nodes = nodes[basis.doflocs[1, nodes] == 0.0]
        nodes = nodes[np.argsort(basis.doflocs[0, nodes])]
        heights = (unit * displacement[2 * nodes + 1] for displacement in (self.peak.displacement, self.left))
        return Dented(unit * basis.doflocs[0, nodes], *heights)

    @property
    def _nodes(self) -> Indices:
        return np.unique(self.ground.basis.element_dofs[:, self.ground.elements])

    def fields(self, time: float) -> tuple[Fields, Array]:
        """At the largest force, which is at a ``time``, s; and the amount of plastic strain at the points (n,)."""
        ground, peak, unit = self.ground, self.peak, self.course.unit * self.peak.scale
        basis, nodes = ground.basis, self._nodes
        gradient = ground.body.cored.core.gradient(peak.displacement)
        stress = ground.yielding.flowed(gradient, *peak.state).stress[STRESS]
        *stresses, amount = at_nodes(basis, ground.elements, np.concatenate([stress, peak.state[1][None]]))
        triangles = subdivided(basis).reshape(basis.nelems, -1, 3)[ground.elements].reshape(-1, 3)
        place = basis.doflocs[:, nodes].T
        touching = (place[:, 1] == 0.0) & (peak.scale * place[:, 0] <= peak.radius)
        found = Fields(
            time=time,
            depth=self.course.unit * peak.depth,
            contact_radius=self.course.unit * peak.radius,
            points=unit * place,
            triangles=np.searchsorted(nodes, triangles),
            displacement=unit * peak.displacement.reshape(-1, 2)[nodes],
            stress=self.course.modulus * np.stack(stresses, axis=1)[nodes],
            pressure=self.course.modulus
            * np.where(touching, np.interp(place[:, 0], ground.points, peak.pressure), 0.0),
            contact=touching.astype(np.int64),
        )
        return found, np.maximum(amount[nodes], 0.0)

    def write_fields(self, time: float, where: Path) -> Path:
        """Write ``fields.vtu``, see :mod:`fe_contact.fields`; its path."""
        fields, amount = self.fields(time)
        return written(fields, where, {"plastic_strain": amount})
