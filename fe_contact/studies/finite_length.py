"""The free ends of a body in plane strain, measured: as long as its striker, in three dimensions, against the plane.

Both forces, at one depth, are of one section with one mesh and one penalty, so that what these err by is in both and
mostly leaves their ratio. Elastic, at small strains: of the material Poisson's ratio alone matters. The striker is
rigid, and comes in alike over all of the length.

A section in plane strain drawn out along its length, to ends that are free, is three-dimensional, linear, at rest. The
section is a mesh of the plane with its supports; along the length y stand line elements, so that shape functions
are products. A section's displacements (u, v along its axes, w along the length) strain by their values
there and by their slopes along the length, and with shape functions q(y)

    strain = B0 q + B1 dq/dy ,    K = A x M + B x C + (B x C)^T + D x S ,

where A, B, D are integrals of B0^T E B0, B0^T E B1, B1^T E B1 over the section, M, C, S those of q q, q q', q' q' over
the length, and x is Kronecker's product. What neither moves along the length nor differs there feels A alone: plane
strain on the same mesh. The middle of the length is a plane of symmetry. Where a section's base holds both of its
displacements, it holds the third one too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import (
    Array,
    Indices,
    Matrix,
    check_compressible,
    plane_strain,
    polar_strain,
    scatter,
    values,
)
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.operators import SOLVED_AT_ONCE, SolidMesh, SurfaceOperator, moduli
from fe_contact.assembly.surface import contact_quadrature, lagrange, monomials
from fe_contact.bodies.pressing import BEYOND
from fe_contact.budget.plan import DEFAULTS
from fe_contact.budget.variation import factor
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, PressedSurface
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
MOST_ENTRIES = 4_000_000  # work: of A x M; the stiffness, its factors and what is solved take half a gigabyte then
BOTH = 2.0  # halves of a section


@dataclass(frozen=True, eq=False)
class Pressable:
    """What contact knows of a body or of its section: the ``surface``, for E* = 1 in units of the mesh.

    ``places`` (q,) of its points along the section; ``pull`` (q,): force along the motion, per length, of a pressure.
    """

    surface: PressedSurface
    places: Array
    pull: Array

    @classmethod
    def plane(cls, operator: SurfaceOperator) -> Pressable:
        """A section in plane strain."""
        surface = PressedSurface(operator.stiffness, operator.trace, operator.weights, recurring=False)
        return cls(surface, operator.points, operator.pull)


def extruded(mesh: SolidMesh, poisson: float, corners: Array, order: int, held: bool = False) -> Pressable:
    """The section drawn out along ``corners`` (m,) of line elements, ascending from the middle, 0, to the end.

    ``order`` of these; ``held``: whether the end may not move along the length, so that all of it is in plane strain.
    Raises SolidTooLarge.
    """
    basis, surface = mesh.body.basis, mesh.body.surface
    length = float(corners[-1])
    along = _length(corners, order)
    matrix = _stiffness(mesh, poisson, along)
    free = np.setdiff1d(np.arange(matrix.shape[0]), _fixed(mesh, along[0].shape[0], held))
    places, weights, trace = surface.quadrature(int(basis.elem.maxdeg))
    pushed = surface.dofs[: trace.shape[1], None] + basis.N * np.arange(along[0].shape[0])
    compliance = _compliance(matrix[free][:, free], np.searchsorted(free, 3 * pushed.ravel() + 1))
    points, widths, trace_along = contact_quadrature(corners, order)
    stiffness = np.linalg.inv((compliance + compliance.T) / 2)
    areas, both = np.asarray(np.kron(weights, widths)), np.asarray(np.kron(trace, trace_along))
    return Pressable(
        PressedSurface((stiffness + stiffness.T) / 2, both, areas, recurring=False),
        np.repeat(places, points.size),
        areas * surface.motion(np.repeat(places, points.size)) / length,
    )


def _length(corners: Array, order: int) -> tuple[Matrix, Matrix, Matrix]:
    """M, C, S of line elements, sparse."""
    gauss, weight = np.polynomial.legendre.leggauss(order + 1)
    share, powers = (gauss + 1) / 2, np.arange(1, order + 1)[:, None]
    value = lagrange(share, order)
    slope = np.vander(share, order, increasing=True) @ (powers * monomials(order)[1:])
    dofs = order * np.arange(corners.size - 1)[:, None] + np.arange(order + 1)
    sizes, size = np.diff(corners)[:, None, None], order * (corners.size - 1) + 1
    parts = ((value, value, sizes), (value, slope, sizes**0), (slope, slope, 1.0 / sizes))
    mass, mixed, stiff = (
        scatter(scale * (first.T @ (weight[:, None] / 2 * second)), dofs, size).tocsr()
        for first, second, scale in parts
    )
    return mass, mixed, stiff


def _stiffness(mesh: SolidMesh, poisson: float, along: tuple[Matrix, Matrix, Matrix]) -> Matrix:
    """Of both halves of a section, half of the length, for E* = 1: degree 3 (k + N j) + c. Raises SolidTooLarge."""
    basis, (bulk, shear) = mesh.body.basis, moduli(poisson)
    law = shear * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    law[:3, :3] += bulk - 2.0 * shear / 3.0
    value, slope, weight = _strains(mesh)
    elements, points, _, functions = value.shape
    shape = (elements, 6 * points, functions)
    stress = [np.matmul(law, one) * weight[:, :, None, None] for one in (value, slope)]
    nodes = np.asarray(basis.element_dofs).T
    dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(elements, functions)
    plane, mixed, stiff = (
        scatter(np.matmul(one.reshape(shape).transpose(0, 2, 1), two.reshape(shape)), dofs, 3 * basis.N).tocsr()
        for one, two in ((value, stress[0]), (value, stress[1]), (slope, stress[1]))
    )
    for part in (plane, mixed, stiff):
        part.eliminate_zeros()  # w along the length meets u and v across it in one of them alone
    entries = plane.nnz * along[0].nnz
    if entries > MOST_ENTRIES:
        raise SolidTooLarge(entries, MOST_ENTRIES)
    twisted = sparse.kron(along[1], mixed)
    return (sparse.kron(along[0], plane) + twisted + twisted.T + sparse.kron(along[2], stiff)).tocsr()


def _strains(mesh: SolidMesh) -> tuple[Array, Array, Array]:
    """B0, B1 (elements, points, 6, 3 functions), rows xx, zz, yy, shears xz, xy, zy; areas (elements, points)."""
    basis, inner = mesh.body.basis, mesh.inner_radius
    plane = plane_strain(basis) if inner is None else polar_strain(basis, inner)
    elements, points, _, pairs = plane.shape
    shapes = values(basis, (elements, points))
    value, slope = np.zeros((2, elements, points, 6, 3 * pairs // 2))
    for component in range(2):
        value[:, :, [0, 1, 3], component::3] = plane[:, :, [0, 1, 3], component::2]
        value[:, :, 4 + component, 2::3] = plane[:, :, component, component::2]  # w by x, w by z
        slope[:, :, 4 + component, component::3] = shapes
    slope[:, :, 2, 2::3] = shapes
    wider = 1.0 if inner is None else 1.0 - np.asarray(basis.global_coordinates())[1] / inner
    return value, slope, BOTH * wider * np.asarray(basis.dx)


def _fixed(mesh: SolidMesh, sections: int, held: bool) -> Indices:
    """Degrees of freedom at zero: the supports of every section, and what may not move along the length."""
    basis, fixed = mesh.body.basis, mesh.body.fixed
    base = basis.get_dofs("base").flatten()
    bonded = bool(np.isin(2 * base, fixed).all() and np.isin(2 * base + 1, fixed).all())
    supported = np.concatenate([3 * (fixed // 2) + fixed % 2, 3 * base + 2 if bonded else base[:0]])
    everywhere = supported + 3 * basis.N * np.arange(sections)[:, None]
    lengthwise = 3 * np.arange(basis.N) + 2
    ends = [lengthwise, lengthwise + 3 * basis.N * (sections - 1)] if held else [lengthwise]
    return np.concatenate([everywhere.ravel(), *ends])


def _compliance(matrix: Matrix, pushed: Indices) -> Array:
    """Displacement of the pushed degrees of freedom under unit forces there, (n, n)."""
    solve, size = factorized(matrix), pushed.size
    answers = []
    for some in np.array_split(np.arange(size), -(-size // SOLVED_AT_ONCE)):
        load = np.zeros((matrix.shape[0], some.size))
        load[pushed[some], np.arange(some.size)] = 1.0
        answers.append(solve(load)[pushed])
    return np.hstack(answers)


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
