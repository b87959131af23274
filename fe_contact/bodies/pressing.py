"""A rigid profile pressed into a body at rest: the contact problem at one depth, elastic with unit modulus.

What the meshes share on which a contact may end anywhere.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, ContactSolution, PressedSurface, Touching
from fe_contact.errors import BodyTooThin, ContactTooWide, IndentationNotSettled
from fe_contact.settings import Numerics
from lumped.scene.indenter import Indenter
from lumped.shapes import Shape
from meshes.triangles import LEAST_BESIDE

EDGE_WINDOW = 0.02  # the contact edge may lie this far from the node where the mesh is finest
RESCALINGS = 60  # work: of the mesh, until the contact edge lies where it is finest
EDGE_ORDER = 1.5  # of the force's error where the contact ends anywhere in an element
REACH = 30.0  # of the depth: no surface that is pressed moves so far, nor does a gap as wide tell where contact ends
NODEWISE_ORDER = 0.5  # of the force's error under a rim where nodes press one by one
# of the force's error where a contact is hardly wider than a flat end, whose radius over the contact's is at least so
BESIDE_ORDER, BESIDE_RIM = 1.0, 0.9
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim
# The gap tells where contact ends up to this distance from the edge, in contact radii and in thicknesses of the body,
# but for the nearest share of it.
GAP_REACH, GAP_REACH_OF_THICKNESS, GAP_NEAREST = 0.4, 0.6, 0.2
GAP_POINTS = 16  # beyond the edge of a contact that has just begun to recede, or is steep: two elements
FEWEST = 4  # places beyond the edge that tell no parabola of the gap's power 2/3
STIFFER = 6.0  # penalty where the contact ends at a rim, over that where it may move: no edge asks for softness
# Elements along a contact radius where the contact may end anywhere, over those where it may not; a line's pressure
# ends as steeply, but less of its force lies there.
REFINEMENT, LINE_REFINEMENT = 2.5, 2.0
STRUCK_REFINEMENT = 4.0  # the same in an impact: its force must be smooth in time
FINITE_REFINEMENT = 2.0  # the same where strains are large
SHARP_REFINEMENT = 4.0  # the same with corners: of fewer elements half are nearly as many
NEAREST = 0.2  # work: of the largest distance from a flat end's rim, from where contacts of an impact are resolved
FAINT = 1e-4  # share of the peak force below which an impact's contact may be resolved less
SPHERE_REFINEMENT = 3.0  # the same on spheres, of which two may touch whose meshes do not match
WIDEST = 1.2  # rad from the first touch: a contact on a circle ends before
MARGIN = 1.35  # largest radius of the fine mesh over that of the contacts expected
FINITE_MARGIN = 1.15  # the same where strains are large: contacts are some per cent wider, or less wide, for them
DIGITS = 12  # rounding: of a ratio of lengths, so that bodies that are alike have one mesh, whatever their sizes
WIDEST_THIN = 130.0  # thicknesses of the body that a fine mesh may be wide: its elements shrink with the thickness


@dataclass(frozen=True)
class Pressed:
    """Force over modulus, m^2, and contact radius, m, at one depth; contact problems and Newton iterations spent."""

    force: float
    contact_radius: float
    problems: int
    iterations: int


@dataclass(frozen=True, eq=False)
class PressedDepths:
    """Force over modulus, m^2, and contact radius, m, at every depth, (n,); counted work.

    ``mesh_order``: the most that the mesh's order can be, where the contact ends; ``ends``: whether the body does;
    ``newton``: what another iteration would change of a force, relative, at most; ``softer`` the same at some of the
    depths under another penalty, where that was asked.
    """

    force: Array
    contact_radius: Array
    work: Mapping[str, int]
    mesh_order: float
    ends: bool
    newton: float = 0.0
    softer: PressedDepths | None = None

    def at(self, chosen: Indices) -> PressedDepths:
        """At some of the depths."""
        return replace(self, force=self.force[chosen], contact_radius=self.contact_radius[chosen])


class Meshed(Protocol):
    """The surface of one body on its mesh for E* = 1, scaled to its place; ``operator``: points and weights."""

    @property
    def operator(self) -> SurfaceOperator: ...

    @property
    def pressed(self) -> PressedSurface:
        """What contact knows of it."""


class Still(Protocol):
    """A body at rest, ready to be pressed by one profile."""

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the finite-element system behind it."""

    @property
    def mesh_order(self) -> float:
        """The most that the order of the mesh's error in the force can be, whatever that of the elements."""

    @property
    def ends(self) -> bool:
        """Whether the mesh is all of the body, so that there is no far field to err."""

    @property
    def operator(self) -> SurfaceOperator | None:
        """Of the one mesh; None of a block, which is not condensed."""

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; ``guess``: a contact radius to begin with, m. Raises NotReached."""


@dataclass(frozen=True)
class OnMesh:
    """An ``indenter`` on a body of which one mesh is known, whose sides are far away."""

    surface: Meshed
    indenter: Indenter
    numerics: Numerics
    ends: ClassVar[bool] = False

    @property
    def operator(self) -> SurfaceOperator:
        """Of the one mesh."""
        return self.surface.operator

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.operator.degrees_of_freedom


@dataclass(frozen=True)
class ScaledStill(OnMesh):
    """A body without a length of its own: the mesh is scaled until the contact edge lies in its finest elements.

    ``least``: about the smallest contact radius, m.
    """

    least: float

    @property
    def mesh_order(self) -> float:
        """That of the elements, for the edge is a node but for little; less close beside a flat end's rim.

        There the pressure grows nearly as under a punch, whose rim costs an order one or, node by node, a half.
        """
        if self.indenter.profile.flat_radius < BESIDE_RIM * self.least:
            return np.inf
        return min(BESIDE_ORDER, rim_order(self.numerics))

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m. Raises IndentationNotSettled."""
        operator, profile, fixed = self.surface.operator, self.indenter.profile, self.indenter.profile.fixed_radius
        scale, iterations = guess, 0
        for attempt in range(1, RESCALINGS + 1):
            overlap = self.indenter.target.overlap(profile, scale * operator.points, depth)
            solution, solves = _enforced(self.surface, overlap, scale, self.numerics, operator.points < 1.0)
            iterations += solution.iterations
            if not solution.converged:
                break
            edge = solution.edge(operator.points)
            if abs(edge - 1.0) <= EDGE_WINDOW:
                force = operator.force(scale, solution.pressure)
                return Pressed(force, fixed or scale * edge, attempt * solves, iterations)
            scale *= min(max(edge, 0.3), operator.points[-1])
        raise IndentationNotSettled(depth, ENFORCEMENTS.get(self.numerics.enforcement).settling)


@dataclass(frozen=True)
class FixedStill(OnMesh):
    """A body with lengths of its own, on one mesh in units of ``reference``, m: the contact may end anywhere in it.

    ``stretch``: the target's place on the surface over the mesh's coordinate; ``thickness`` of the body, in units of
    the mesh.
    """

    reference: float
    stretch: float
    thickness: float

    @property
    def mesh_order(self) -> float:
        """Less where the edge may lie anywhere in an element, at which the pressure has no slope."""
        return EDGE_ORDER if self.indenter.shape.fixed_radius is None else rim_order(self.numerics)

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; raises IndentationNotSettled, ContactTooWide."""
        operator, fixed = self.surface.operator, self.indenter.shape.fixed_radius
        overlap = self.indenter.target.overlap(self.indenter.profile, self.stretch * operator.points, depth)
        solution, solves = self._solved(overlap, guess / self.reference)
        if not solution.converged:
            raise IndentationNotSettled(depth, ENFORCEMENTS.get(self.numerics.enforcement).settling)
        edge = solution.edge(operator.points)
        if fixed is None and not np.isfinite(edge):
            raise ContactTooWide(depth)
        gap, height = -solution.signed_pressure, depth - overlap
        radius = fixed or self.reference * contact_end(operator.points, edge, gap, height, self.thickness)
        return Pressed(operator.force(self.reference, solution.pressure), radius, solves, solution.iterations)

    def _solved(self, overlap: Array, expected: float) -> tuple[ContactSolution, int]:
        """The contact problem of an overlap, (q,), m, and how many solves it took.

        The penalty counts in the body's own stiffness under a flat end of radius a over 2 a^2 (2 a in plane strain):
        E*/a on the half-space, and much more where a thin layer is confined.
        """
        operator = self.surface.operator
        unit = float(operator.punched(expected).sum()) / (2.0 * expected ** (operator.dimension - 1))
        numerics = replace(self.numerics, penalty=self.numerics.penalty * unit)
        return _enforced(self.surface, overlap, self.reference, numerics, operator.points < expected)


@dataclass(frozen=True, eq=False)
class BodyStill:
    """Contact at fixed points on one mesh, whose unit is ``scale``, m.

    ``surface`` of all bodies, in units of their common modulus; ``operator`` of the one that has the points;
    ``places`` (q,) of the points as the target counts them, m, zero at the first touch.
    """

    surface: PressedSurface
    operator: SurfaceOperator
    places: Array
    scale: float
    indenter: Indenter
    numerics: Numerics
    degrees_of_freedom: int
    ends: ClassVar[bool] = True

    @classmethod
    def alone(cls, surface: Meshed, places: Array, scale: float, indenter: Indenter, numerics: Numerics) -> BodyStill:
        """Of one body, ``surface`` of it all that yields."""
        operator = surface.operator
        return cls(surface.pressed, operator, places, scale, indenter, numerics, operator.degrees_of_freedom)

    @property
    def mesh_order(self) -> float:
        """Less where the edge may lie anywhere in an element; a rim is a node."""
        fixed = self.indenter.target.fixed_radius(self.indenter.shape)
        return EDGE_ORDER if fixed is None else rim_order(self.numerics)

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; raises IndentationNotSettled, or ContactTooWide where a contact leaves the fine mesh."""
        target, shape = self.indenter.target, self.indenter.shape
        fixed = target.fixed_radius(shape)
        overlap = target.overlap(self.indenter.profile, self.places, depth)
        penalty = self.numerics.penalty * self.scale / guess * (1.0 if fixed is None else STIFFER)
        problem = ContactProblem(self.surface, in_reach(overlap), penalty)
        enforcement = ENFORCEMENTS.get(self.numerics.enforcement)
        solution = enforcement.enforce(problem, np.abs(self.places) < guess)
        gap, height = -solution.signed_pressure, target.lead * depth - overlap
        radius = fixed or half_width(self.places, solution.signed_pressure, gap, height=height)
        if not solution.converged or radius == 0.0:
            raise IndentationNotSettled(depth, enforcement.settling)
        if not np.isfinite(radius):
            raise ContactTooWide(depth)
        force = self.operator.force(self.scale, solution.pressure)
        return Pressed(force, radius, enforcement.solves, solution.iterations)


def _enforced(
    surface: Meshed, overlap: Array, scale: float, numerics: Numerics, touching: Touching
) -> tuple[ContactSolution, int]:
    """The contact problem on the mesh scaled by ``scale``, m; and how many solves it took."""
    enforcement = ENFORCEMENTS.get(numerics.enforcement)
    operator = surface.operator
    free = in_reach(overlap) if operator.watched is None else np.maximum(overlap, -BEYOND * scale)  # a datum comes up
    problem = ContactProblem(surface.pressed, free, numerics.penalty, operator.yielding)
    return enforcement.enforce(problem, touching), enforcement.solves


def rim_order(numerics: Numerics) -> float:
    """The most that the mesh's order can be under a rim, where the pressure grows like a root without end.

    A pressure of nodes that press one by one misses some of the last facet's, which carries as a root of its size.
    """
    return NODEWISE_ORDER if ENFORCEMENTS.get(numerics.enforcement).nodewise else np.inf


def in_reach(overlap: Array) -> Array:
    """An overlap, (q,), m, whose gaps are none that is wider than any surface moves: they stay open, no less.

    Where heights rise by powers of ten within a facet, or a rim ends them, a mean over the facet would see them alone.
    """
    return np.asarray(np.maximum(overlap, -REACH * abs(overlap.max())))


def contact_end(
    points: Array, edge: float, gap: Array, height: Array, thickness: float = np.inf, touched: float = np.inf
) -> float:
    """Where the surfaces part, from the gap (q,) outside: beyond the edge it grows like the 3/2 power of the distance.

    The pressure, which falls to zero at ``edge``, rings there if that is anywhere in an element; the gap, a
    displacement, does not. In a body thinner than the contact is wide the power holds less far: ``thickness``, in the
    unit of the points. So it does in a contact that has receded from where the surface was ``touched`` and remembers,
    and under a profile that is steep: distance counts in the root of the ``height`` between the undeformed surfaces
    (q,), which under a round one is the distance.
    """
    after, rise = int(points.searchsorted(edge)), np.sqrt(height)
    start = float(np.interp(edge, points, rise))
    fewest = float(points[min(after + GAP_POINTS, points.size - 1)])
    steep = float(points[min(int(rise.searchsorted((1.0 + GAP_REACH) * start)), points.size - 1)])
    reach = min(GAP_REACH * edge, GAP_REACH_OF_THICKNESS * thickness, max(min(touched, steep), fewest) - edge)
    outside = (points > edge + GAP_NEAREST * reach) & (points < edge + reach) & np.isfinite(rise)
    if np.count_nonzero(outside) <= FEWEST or rise[outside][0] == rise[outside][-1]:  # the last: past a rim
        return edge
    real = _zeros(rise[outside], np.maximum(gap[outside], 0.0) ** (2 / 3), 1e-9 * start)
    near = [root for root in real if abs(root - start) < rise[outside][-1] - start]
    return _place(points, rise, min(near, key=lambda root: abs(root - start))) if near else edge


def _zeros(places: Array, values: Array, rounding: float) -> list[float]:
    """Where the parabola nearest to values (n,) at places (n,), ascending, is zero: up to two places.

    A pair that is complex by less than the rounding is one real place.
    """
    middle, half = 0.5 * float(places[0] + places[-1]), 0.5 * float(places[-1] - places[0])
    share = (places - middle) / half
    powers = np.stack([np.ones_like(share), share, share * share], axis=1)
    constant, slope, bend = np.linalg.lstsq(powers, values, share.size * np.finfo(float).eps)[0].tolist()
    square = slope * slope - 4.0 * bend * constant
    if square < 0.0:
        apart = half * math.sqrt(-square) / (2.0 * abs(bend))
        return [middle - half * slope / (2.0 * bend)] if apart < rounding else []
    larger = -0.5 * (slope + math.copysign(math.sqrt(square), slope))  # the sum of what has one sign
    return [middle + half * over / under for over, under in ((larger, bend), (constant, larger)) if under]


def _place(points: Array, rise: Array, value: float) -> float:
    """The place where the rise has this value, by a power between the points, by a line where a flat end has none."""
    after = int(rise.searchsorted(value))
    if after in (0, points.size):
        return float(points[min(after, points.size - 1)])
    pair = slice(after - 1, after + 1)
    if rise[after - 1] <= 0.0:
        return float(np.interp(value, rise[pair], points[pair]))
    return float(np.exp(np.interp(np.log(value), np.log(rise[pair]), np.log(points[pair]))))


def half_width(
    places: Array, signed_pressure: Array, gap: Array, touched: float = np.inf, height: Array | None = None
) -> float:
    """From the first touch to where the surfaces part; where there is a left side too, half from end to end.

    Infinite where the contact reaches the last place, 0 without contact. See :func:`contact_end`.
    """
    height = places**2 if height is None else height
    right = _end(places, signed_pressure, gap, touched, height)
    if places[0] > 0.0:
        return right
    return 0.5 * (right + _end(-places[::-1], signed_pressure[::-1], gap[::-1], touched, height[::-1]))


def _end(places: Array, signed_pressure: Array, gap: Array, touched: float, height: Array) -> float:
    """Where the surfaces part on the side of the places, ascending, that are positive."""
    side = places > 0.0
    edge = ContactSolution(signed_pressure[side], 0, True, ()).edge(places[side])
    return contact_end(places[side], edge, gap[side], height[side], touched=touched)


@dataclass(frozen=True)
class Zone:
    """Where contacts end: the largest radius, in the target's own places, and the smallest over it.

    Of a striker with a flat end also ``flat``, that end's radius over the largest, and how far ``beside`` its rim the
    smallest one ends.
    """

    reference: float
    smallest: float
    flat: float = 0.0
    beside: float = 1.0

    @classmethod
    def of(cls, radii: Array, margin: float = MARGIN, flat: float = 0.0) -> Zone:
        """Of contact radii under a ``flat`` end as wide, m."""
        least, largest = float(radii.min()), float(radii.max())
        reference, nearest = margin * largest, least - flat if least > flat else NEAREST * (largest - flat)
        beside = max(nearest / reference, LEAST_BESIDE) if flat else 1.0
        return cls(reference, least / reference, flat / reference, beside)

    @classmethod
    def struck(cls, shape: Shape, reference: float) -> Zone:
        """Of an impact whose contact grows from the first touch to nearly the ``reference``, m."""
        flat, smallest = shape.flat_radius / reference, smallest_struck(shape)
        if not flat:
            return cls(reference, smallest)
        return cls(reference, max(smallest, flat), flat, max(NEAREST * (1.0 - flat), LEAST_BESIDE))

    @classmethod
    def round(cls, radii: Array, radius: float) -> Zone:
        """Angles on a circle of this radius, of contacts that end so far, m, from the line of motion."""
        angles = np.arcsin(np.minimum(radii / radius, 1.0))
        reference = min(MARGIN * float(angles.max()), WIDEST)
        return cls(reference, min(float(angles.min()) / reference, 1.0))


def thickness_over(width: float, thickness: float) -> float:
    """Thickness of a body over the width of its fine mesh, both m. Raises BodyTooThin."""
    if width > WIDEST_THIN * thickness:
        raise BodyTooThin(width, thickness, WIDEST_THIN)
    return float(f"{thickness / width:.{DIGITS}g}")


def smallest_struck(shape: Shape) -> float:
    """Contact radius over the largest one below which elements grow no finer: F ~ a^3 of a sphere, else a^2."""
    return math.pow(FAINT, 1.0 / 3.0 if shape.tip_radius is not None and not shape.plane else 0.5)


def struck_ends(shape: Shape, numerics: Numerics) -> tuple[float, float]:
    """The smallest and the largest contact radius of an impact that a mesh is made for, m."""
    largest = numerics.contact_radius / MARGIN
    return smallest_struck(shape) * largest, largest


def held(basis: Basis, along: tuple[str, ...], across: tuple[str, ...]) -> Indices:
    """Degrees of freedom along the surface, and across it, on boundaries by their names."""
    first = [2 * basis.get_dofs(name).flatten() for name in along]
    second = [2 * basis.get_dofs(name).flatten() + 1 for name in across]
    return np.unique(np.concatenate([*first, *second]))
