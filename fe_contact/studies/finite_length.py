"""The free ends of a body in plane strain, measured: as long as its striker, in three dimensions, against the plane.

Both forces, at one depth, are of one section with one mesh and one penalty, so that what these err by is in both and
mostly leaves their ratio. Elastic, at small strains: of the material Poisson's ratio alone matters. The striker is
rigid, and comes in alike over all of the length.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array, check_compressible
from fe_contact.bodies.extruded import Pressable, extruded
from fe_contact.bodies.pressing import BEYOND
from fe_contact.budget.plan import DEFAULTS
from fe_contact.budget.variation import factor
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem
from fe_contact.errors import ContactTooWide, IndentationNotSettled, SolidTooLarge, faults_of
from fe_contact.indentation import ROUNDING, expected, settings
from fe_contact.progress import Progress, silent
from fe_contact.targets.base import TARGETS
from fe_contact.targets.layer import SIDES
from fe_contact.threads import one_thread
from lumped.scene.indenter import Indenter
from lumped.targets.layer import Layer

ORDERS = (4, 3)  # of the section's elements: the higher one that memory lets; one less tells how far it is off
ALONG = 3  # order of the elements along the length
ELEMENTS = 1.0  # work: elements_per_contact of the section
FIRST = 1.0 / 3.0  # work: element at an end over the body's depth or half its length; the next ones double
THINNEST = 0.02  # rounding: length over the body's depth below which a slice is in plane stress all through, to 1e-4
FAR = 15.0  # work: far_radius of a layer that holds its sides by its base
SOFTER = 0.5  # penalty that the measurement is repeated with, over its own
# Work: by cause, what elements of the lower order are made coarser by.
COARSER: Mapping[str, Mapping[str, float]] = {"section": {"elements": 0.5}, "length": {"first": 2.0}}
NEARER = {"far": 0.5}  # the same of what does not end with its mesh
CORNER = 1.0  # order of what they change: the stress where an end meets what holds it promises no more
# Work: depths over the one asked for, which tell errors: where in an element a contact ends, one alone may hide them.
ACCOMPANYING = (1.0, 0.92, 0.84, 0.76, 0.68)


@dataclass(frozen=True)
class MeasuredEnds:
    """What they change of the force at a depth, relatively, and the ``budget`` of its error, by cause."""

    change: float
    budget: Mapping[str, float]

    @property
    def error(self) -> float:
        """Of all causes."""
        return ROUNDING + sum(self.budget.values())


@dataclass(frozen=True, eq=False)
class Bodies:
    """A ``section`` and the same ``drawn`` out to free ends, on meshes whose unit is ``unit``, m.

    ``radius`` of the contact expected, in that unit; ``stiffness`` of the section under a flat end as wide, over its
    width; ``ends``: whether the mesh is all of it.
    """

    indenter: Indenter
    section: Pressable
    drawn: Pressable
    unit: float
    radius: float
    stiffness: float
    ends: bool

    @classmethod
    def of(
        cls,
        indenter: Indenter,
        radius: float,
        order: int,
        elements: float = 1.0,
        first: float = 1.0,
        far: float = 1.0,
    ) -> Bodies:
        """For a contact of about a ``radius``, m; elements and lengths over those of this module. Raises NotReached."""
        given = {"order": order, "elements_per_contact": ELEMENTS * elements, "far_radius": far * _far(indenter)}
        target, numerics = indenter.target, settings(given, indenter.shape)
        make = TARGETS.get(target.name).solid
        assert make is not None
        assert target.body_depth is not None
        mesh = make(indenter, np.array([radius]), numerics)
        length = 0.5 * max(indenter.shape.total, THINNEST * target.body_depth)
        operator = mesh.body.condensed(indenter.material.nu).operator
        corners = _corners(length, FIRST * first * min(target.body_depth, length)) / mesh.unit
        drawn = extruded(mesh, indenter.material.nu, corners, ALONG)
        half = radius / mesh.unit
        stiffness = float(operator.punched(half).sum()) / (2.0 * half)
        section = Pressable.plane(operator)
        return cls(indenter, section, drawn, mesh.unit, half, stiffness, mesh.ends)

    def changes(self, depths: Array, penalty: float = 1.0) -> Array:
        """Of the force at depths, m, (n,). Raises IndentationNotSettled, ContactTooWide."""
        stiffness = penalty * DEFAULTS["penalty"] * self.stiffness
        plane, free = (
            np.array([self._force(body, float(depth), stiffness) for depth in depths])
            for body in (self.section, self.drawn)
        )
        return np.asarray(free / plane - 1.0)

    def _force(self, body: Pressable, depth: float, penalty: float) -> float:
        target, surface = self.indenter.target, body.surface
        places = self.unit / target.length_of_place * body.places
        overlap = target.overlap(self.indenter.profile, places, depth) / self.unit
        problem = ContactProblem(surface, np.maximum(overlap, -BEYOND), penalty)
        found = ENFORCEMENTS.get(DEFAULTS["enforcement"]).enforce(problem, body.places < self.radius)
        if not found.converged:
            raise IndentationNotSettled(depth)
        if np.any(found.pressure[body.places == body.places[-1]] > 0.0):
            raise ContactTooWide(depth)
        return float(body.pull @ found.pressure)


@one_thread
def free_ends(indenter: Indenter, depth: float, progress: Progress = silent) -> MeasuredEnds:
    """Free ends of a layer or a ring, as long as its striker, pressed to a depth, m. Raises NotReached, BadInput."""
    with faults_of(indenter):
        check_compressible(indenter)
        indenter.checked((depth,))
        radius = float(expected(indenter, np.array([depth]), settings({}, indenter.shape))[0])
        depths, trusted = depth * np.array(ACCOMPANYING), factor(CORNER, finer=False)
        progress("a body with free ends in three dimensions")
        base, order = _finest(indenter, radius)
        changes, softer = base.changes(depths), base.changes(depths, SOFTER)
        coarser = COARSER if base.ends else {**COARSER, "far_field": NEARER}
        progress("the same, of a lower order", 1, 2 + len(coarser))
        lower = Bodies.of(indenter, radius, order - 1).changes(depths)
        apart = {"penalty": softer - changes, "order": lower - changes}
        for count, (cause, setting) in enumerate(coarser.items(), 2):
            progress(f"the same, coarser: {cause}", count, 2 + len(coarser))
            apart[cause] = Bodies.of(indenter, radius, order - 1, **setting).changes(depths) - lower
    return MeasuredEnds(float(changes[0]), {cause: trusted * float(abs(one).max()) for cause, one in apart.items()})


def _far(indenter: Indenter) -> float:
    """Where meshes end, as settings have it: a sliding layer is stretched as far beside a contact as it is long."""
    target = indenter.target
    if not isinstance(target, Layer) or target.base != "sliding":
        return FAR
    return max(float(DEFAULTS["far_radius"]), indenter.shape.total / (SIDES * target.thickness))


def _finest(indenter: Indenter, radius: float) -> tuple[Bodies, int]:
    """Of the highest order that memory lets, and that order. Raises SolidTooLarge."""
    high, low = ORDERS
    try:
        return Bodies.of(indenter, radius, high), high
    except SolidTooLarge:
        return Bodies.of(indenter, radius, low), low


def _corners(length: float, first: float) -> Array:
    """Ends of elements along a length, m, from its middle to its end: the last is the ``first``, the others double."""
    sizes = [first]
    while sum(sizes) + 3.0 * sizes[-1] < length:
        sizes.append(2.0 * sizes[-1])
    return length - np.array([length, *np.cumsum(sizes)[::-1], 0.0])
