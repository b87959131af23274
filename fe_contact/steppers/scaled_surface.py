"""A homogeneous half-space seen through its surface, on a mesh that follows the contact.

The half-space has no length of its own: scaling the mesh by a contact radius ``a`` divides its compliance
by ``a`` and changes nothing else. So one operator, made for radius one, serves every instant, and the
contact edge always lies in the finest elements instead of anywhere in a coarse one. With the nodal forces
and the pressure in units of the unit mesh,

    displacement x modulus = C_unit forces / a ,   pressure = unit pressure / a ,   force = a sum(W p_unit).

A time step solves the contact problem on the mesh scaled to the contact radius expected in it. Where the edge turns out
to lie outside the mesh's finest elements, the mesh is scaled again and the step redone.

A step knows its mean pressure alone, with a kink wherever the edge stood at the end of an earlier step. At an instant
the surface within the contact is the striker's, its memory is known, and nothing presses outside. With the mesh scaled
to the contact radius a, so that its finest node is the edge, compliance C and mass M of the nodes up to there,

    pressure = M^-1 C^-1 w / a ,    w = E_inf u + sum_k E_k z_k + viscosity du/dt .

In the march a surface moves on a straight line within a step. Where the contact arrives in the middle of one, the
gap closes like the power 3/2 of the time left. No force notices, but the branches z_k are left with a kink at every
former edge: at an instant they get what the straight line missed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.cache import Recipe, cached_surface
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SurfaceOperator, operator_of
from fe_contact.assembly.surface import monomials
from fe_contact.bodies.memory import StepLaw, SurfaceBody, SurfaceMemory, area_weights, graded, interpolate
from fe_contact.bodies.pressing import BEYOND, EDGE_WINDOW, RESCALINGS, in_reach
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, ContactSolution, PressedSurface, Touching, count, moved
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import (
    Inertia,
    OfSurface,
    Snapshot,
    State,
    Step,
    Stepping,
    Strike,
    Work,
    coming_square,
    radius_time,
)
from fe_contact.steppers.struck import Deformable, Guesses
from lumped.materials import Relaxation
from lumped.numbers import gauss

LEAST_KEPT = 0.05  # share of its area that a contact is expected to keep over a step
PATIENCE = 8  # rescalings after which the window widens by half each time: the edge may jitter in the last tail
MEMORY_POINTS = 1000  # radii at which the surface's past is remembered, at least
POINTS_A_STEP = 8  # of them: every step reads between them, and what that errs by adds up under a dashpot
MEMORY_REACH = 1.25  # memory extends to this multiple of the expected contact radius
COARSE = np.geomspace(1e-6, 1.0, 200)  # where, in units of the memory's reach, the first contact is looked for
CLOSING = 1.5  # power of the time left with which the gap closes before an edge
EDGE = 1.0 - 1e-9  # of the unit mesh, safe from rounding
SHARES, WEIGHTS = gauss(8)  # of a step, by Gauss's rule
FARTHEST = 1.0  # logarithm of a scale over the expected one, up to about which one is looked for that ends at a node
NEAR_NODE = 1e-3  # work: of the distance of two nodes, within which the edge is brought to one
ANYWHERE = 0.5  # the same window where nodes press one by one and none ends the contact: the mesh stays
VANISHING = 1e-4  # contact that shrinks by this much within a step is lost


class Stepper(OfSurface):
    """Takes steps: what stays the same through an impact is held here, what changes is passed and returned.

    The memory also keeps the pressure that each of its branches carries, for the energies.
    ``expected``: contact radii, m, of the first steps where a like march has told them, for as many as it did.
    """

    shortest = 3e-4
    first_force = 0.0

    def __init__(
        self,
        strike: Strike,
        surface: ScaledSurface,
        numerics: Numerics,
        expected: Sequence[float] | Array = (),
    ) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.relaxation, self.scheme = strike.relaxation, SCHEMES.get(numerics.scheme)
        self.enforcement = ENFORCEMENTS.get(numerics.enforcement)
        points = max(MEMORY_POINTS, POINTS_A_STEP * numerics.steps)
        if isinstance(strike.memory, SurfaceMemory):  # of a contact before, in other steps perhaps
            points = strike.memory.areas.size
        self.radii = graded(MEMORY_REACH * numerics.contact_radius, points)
        self.heights = strike.height(self.radii)
        self.areas = area_weights(self.radii)
        self.expected = expected
        self.unit = count(surface.operator.points < 1.0)

    def at_rest(self) -> SurfaceMemory:
        """Of the displacement and of the pressure, at the memory's radii."""
        return SurfaceMemory.at_rest(self.areas, self.relaxation, fields=2)

    def standing(self) -> int:
        """The axis."""
        return 0

    def clearance(self, surface: SurfaceMemory, depth: float) -> Array:
        """Gap of the surfaces at the memory's radii, m."""
        return np.asarray(surface.strain[0] + self.heights - depth)

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s, from a state reached by ``steps``.

        Raises ContactLost, ContactNotSettled or MemoryTooSmall.
        """
        law = self.law(length)
        inertia = Inertia.of(self.strike, self.scheme, state, length)
        carried = state.memory.carried(law)
        scale, edge, solution, work = self._settle(inertia, steps, law, carried[0])
        pressure, radius = solution.pressure, scale * edge
        force = scale * float(self.surface.operator.weights @ pressure)
        strain = self._strain(law, carried, inertia.depth(force), radius, scale, pressure)
        moved = inertia.moved(force, state.memory.advanced(law, strain))
        axis = float(law.now * strain[0, 0] + carried[0, 0])
        found_at = radius_time(self.scheme, moved.velocity, state.time, length)
        return Step(length, moved, force, radius, found_at, axis, solution, scale, work)

    def snapshots(self, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
        """Pressures at instants: at the end of a step while the contact grows, else where it is sampled."""
        return _at_instants(self, steps)

    def between(self, before: State, step: Step) -> float:
        """Work of the striker in a step that does not reach the body, J: where surfaces meet or part within it."""
        after = step.state
        sunk = after.memory.strain[0] - before.memory.strain[0]
        reached = self.areas @ (self._spread(step.solution.pressure, step.scale) * sunk)
        return float(step.force * (after.depth - before.depth) - reached)

    def _settle(
        self, inertia: Inertia, steps: Sequence[Step], law: StepLaw, carried: Array
    ) -> tuple[float, float, ContactSolution, Work]:
        """Scale the mesh until the contact edge lies in its finest elements: scale, edge on the unit mesh, solution."""
        points, state = self.surface.operator.points, inertia.state
        free_depth, spent = inertia.free_depth, Work(1)
        scale = self._expected_radius(state, steps, inertia.length) or self._overlap_radius(law, carried, free_depth)
        guesses, window = self._guesses(steps), EDGE_WINDOW
        if self.enforcement.nodewise:
            problem_of = partial(self._problem, inertia, law, carried)
            found, spent = self._at_node(problem_of, state.time, scale, guesses)
            if found is not None:
                return (*found, spent)
            scale, window = steps[-1].scale if steps else scale, ANYWHERE
        for attempt in range(RESCALINGS):
            problem = self._problem(inertia, law, carried, scale)
            solution = self._solved(problem, guesses, state.time)
            spent = spent.more(self.enforcement.solves, solution.iterations)
            edge = solution.edge(points)
            if abs(edge - 1) <= window * 1.5 ** max(attempt - PATIENCE, 0):
                return scale, edge, solution, spent
            scale *= min(max(edge, 0.3), points[-1])
            if scale < VANISHING * (steps[-1].radius if steps else self.numerics.contact_radius * VANISHING):
                raise ContactLost(state.time)
            guesses = self._centred(solution)
        raise ContactNotSettled(state.time, self.enforcement.settling)

    def _problem(self, inertia: Inertia, law: StepLaw, carried: Array, scale: float) -> ContactProblem:
        """Contact on the mesh scaled by so much, m. Raises MemoryTooSmall."""
        radii, limit = scale * self.surface.operator.points, self.radii[-1]
        if radii[-1] > limit:
            raise MemoryTooSmall(radii[-1])
        height = np.minimum(self.strike.height(radii), BEYOND * radii[-1])  # a profile may end
        overlap = law.now * (inertia.free_depth - height) + interpolate(carried, limit, radii)
        yielding = law.now * inertia.give * scale
        return ContactProblem(self.surface.pressed, in_reach(overlap), self.numerics.penalty, yielding)

    def _solved(self, problem: ContactProblem, guesses: Guesses, time: float) -> ContactSolution:
        """Raises ContactNotSettled."""
        solution: ContactSolution = self.enforcement.enforce(problem, *guesses)
        if not solution.converged:
            raise ContactNotSettled(time, self.enforcement.settling)
        return solution

    def _at_node(
        self, problem_of: Callable[[float], ContactProblem], time: float, expected: float, guesses: Guesses
    ) -> tuple[tuple[float, float, ContactSolution] | None, Work]:
        """Scale, edge and solution where the contact ends at the node at the edge, and the work; None where at no scale
        near the ``expected`` one, m, as of a last touch in a ring.

        Where nodes press one by one the force depends on where between two of them the contact ends, beside a flat end
        by two per cent. With the end at a node it is as smooth in time as the motion.
        """
        known, surface = dict[float, tuple[ContactSolution, float]](), self.surface

        def reaching(scale: float) -> float:
            if scale not in known:
                solution = self._solved(problem_of(scale), guesses, time)
                known[scale] = solution, surface.from_edge(solution.signed_pressure)
            return known[scale][1]

        most = EDGE * float(self.radii[-1]) / float(surface.operator.points[-1])
        expected = min(expected, most)
        step, near, found = math.log1p(surface.spacing), expected, None
        wider = reaching(near) > 0.0
        while (reaching(near) > 0.0) is wider and step < FARTHEST:
            if wider and near == most:
                raise MemoryTooSmall(self.radii[-1])
            step *= 2.0
            near = min(expected * math.exp(step if wider else -step), most)
        if (reaching(near) > 0.0) is not wider:
            from scipy.optimize import brentq  # late: penalties need none

            scale = float(brentq(reaching, expected, near, xtol=NEAR_NODE * surface.spacing * expected))
            reaching(scale)
            found = scale, 1.0, known[scale][0]
        iterations = sum(solution.iterations for solution, _ in known.values())
        return found, Work(1).more(len(known) * self.enforcement.solves, iterations)

    def _guesses(self, steps: Sequence[Step]) -> tuple[Touching, ...]:
        """Points that may touch in the coming step."""
        if not steps:
            return (self.surface.operator.points < 1.0,)
        return self._centred(steps[-1].solution) if len(steps) < len(self.expected) else steps[-1].solution.sets

    def _centred(self, solution: ContactSolution) -> tuple[Touching, ...]:
        """Sets of another step or scale, moved so that the last of them, whose edge is the contact's, ends at one."""
        by = self.unit - count(solution.sets[-1])
        return tuple(moved(touching, by) for touching in solution.sets)

    def _expected_radius(self, state: State, steps: Sequence[Step], length: float) -> float:
        """Contact radius in the coming step, if it is not told: its square is smooth in time, and zero at touch.

        Zero in the first step, of which nothing is known.
        """
        if len(steps) < len(self.expected):
            return float(self.expected[len(steps)])
        if not steps:
            return 0.0
        square = coming_square(steps, radius_time(self.scheme, state.velocity, state.time, length))
        return float(np.sqrt(max(square, LEAST_KEPT * steps[-1].radius ** 2)))

    def _overlap_radius(self, law: StepLaw, carried: Array, free_depth: float) -> float:
        """About the radius up to which the striker would overlap a surface that nothing presses."""
        radii = self.radii[-1] * COARSE
        past = interpolate(carried, self.radii[-1], radii)
        open_ = law.now * (free_depth - self.strike.height(radii)) + past <= 0.0
        return float(radii[int(open_.argmax()) if open_.any() else -1])

    def _strain(
        self, law: StepLaw, carried: Array, depth: float, radius: float, scale: float, pressure: Array
    ) -> Array:
        """Surface displacement at the memory's radii after the step and its pressure; (2, r)."""
        strain = np.empty_like(carried)
        touching = int(self.radii.searchsorted(radius))
        outside = self.radii[touching:] / scale
        # in contact the surface is the striker's: what penalty is left in the trace must not be remembered
        strain[0, :touching] = depth - self.heights[:touching]
        stress = self.surface.sample(self.surface.response(pressure), outside)
        strain[0, touching:] = (stress - carried[0, touching:]) / law.now
        strain[1] = (self._spread(pressure, scale) - carried[1]) / law.now
        return strain

    def _spread(self, pressure: Array, scale: float) -> Array:
        """A pressure on the unit mesh, (q,), at the memory's radii, (r,), Pa, with the same force if they see one."""
        operator = self.surface.operator
        spread = np.interp(self.radii / scale, operator.points, pressure / scale, right=0.0)
        total = float(self.areas @ spread)
        return spread * (scale * float(operator.weights @ pressure) / total) if total > 0.0 else spread


@dataclass(frozen=True)
class ScaledSurface(Deformable):
    """Contact surface of the half-space; ``operator`` is condensed for contact radius 1 and E* = 1.

    ``follows_contact``: whether the mesh follows the contact; where it stays, the same points seldom touch twice.
    """

    operator: SurfaceOperator
    follows_contact: bool = True

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps on the mesh that follows the contact, or that stays."""
        if self.follows_contact:
            return Stepper(strike, self, numerics, expected)
        return super().stepper(strike, numerics, expected)

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> SurfaceBody:
        """The body on a mesh that stays, of unit length ``scale``, m: contact modulus E*(t), Pa, and time scheme."""
        return SurfaceBody(self.operator, self.pressed, relaxation, scheme, scale)

    @cached_property
    def pressed(self) -> PressedSurface:
        """What contact knows of it: one object, since the answers to a surface are kept by its identity."""
        operator = self.operator
        return PressedSurface(operator.stiffness, operator.trace, operator.weights, self.follows_contact)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """Where the mesh follows the contact, what the snapshot says: it has no roughness to be freed of."""
        return (snapshot.radii, snapshot.pressure) if self.follows_contact else super().felt(snapshot)

    @cached_property
    def spacing(self) -> float:
        """Distance of the node at the edge from the next, on the unit mesh."""
        return float(self.operator.nodes[self._edge + 1] - self.operator.nodes[self._edge])

    def from_edge(self, signed_pressure: Array) -> float:
        """The largest of a signed pressure (q,) on the unit mesh at the node at the edge and those beyond."""
        return float(self.operator.projected(signed_pressure)[self._edge :].max())

    @cached_property
    def _edge(self) -> int:
        """The node at the edge."""
        return int(self.operator.nodes.searchsorted(EDGE))

    def response(self, pressure: Array) -> Array:
        """Displacement times modulus of all surface nodes, (n_s,), under a unit-mesh pressure (q,)."""
        operator = self.operator
        return operator.response @ (operator.trace.T @ (operator.weights * pressure))

    def sample(self, nodal: Array, radii: Array) -> Array:
        """Evaluate a nodal surface field at increasing radii in units of the contact radius, outside the mesh as 1/r.

        Beyond the far radius the field is the point force's, which the far boundary condition stands for.
        """
        corners, places, members = self._facets
        ends = radii.searchsorted(corners)
        ends[0] = 0
        reach = ends[-1]
        table = np.concatenate([places, monomials(self.operator.order) @ nodal[members]])
        start, stretch, *coefficients, field = np.repeat(table, ends[1:] - ends[:-1], axis=1)
        x = (radii[:reach] - start) * stretch
        for coefficient in reversed(coefficients):
            field *= x
            field += coefficient
        return np.concatenate([field, nodal[-1] * corners[-1] / radii[reach:]])

    @cached_property
    def _facets(self) -> tuple[Array, Array, npt.NDArray[np.intp]]:
        """Corners (f + 1,) of the surface's facets; where each starts and one over its length, (2, f); its nodes."""
        order, nodes = self.operator.order, self.operator.nodes
        corners = nodes[::order]
        members = np.arange(order + 1)[:, None] + order * np.arange(len(corners) - 1)
        return corners, np.stack([corners[:-1], 1 / np.diff(corners)]), members


@cached_surface
def on_mesh(body: Recipe[ElasticBody], poisson: float) -> ScaledSurface:
    """A body with lengths of its own, condensed for this Poisson's ratio: its mesh stays while the contact grows."""
    return ScaledSurface(operator_of(body, poisson), follows_contact=False)


def _at_instants(stepper: Stepper, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
    """One snapshot a step, when its contact radius was: pressure (q,), Pa, at the mesh's points, zero outside."""
    operator = stepper.surface.operator
    zone = int(operator.nodes.searchsorted(EDGE)) + 1
    radii = np.array([step.radius for step in steps])
    # what pulls at the last points is the error of the radius: a contact never does
    unit = np.maximum(_pressures(operator, _stresses(stepper, steps, operator.nodes[:zone, None] * radii)), 0.0)
    forces = radii * (operator.weights @ unit)
    return tuple(
        Snapshot(step.radius_time, float(force), step.radius, step.radius * operator.points, pressure)
        for step, force, pressure in zip(steps, forces, (unit / radii).T, strict=True)
    )


def _pressures(operator: SurfaceOperator, stresses: Array) -> Array:
    """Unit-mesh pressures at the points, (q, s), that hold displacements times modulus, (m, s), of the contact's nodes.

    Exactly the nodal forces' moments; none beyond the edge.
    """
    zone = len(stresses)
    inside = int(operator.points.searchsorted(EDGE))
    trace, weights = operator.trace[:inside, :zone], operator.weights[:inside, None]
    forces = np.linalg.solve(operator.response[:zone, :zone], stresses)
    found = np.zeros((len(operator.points), stresses.shape[1]))
    found[:inside] = trace @ np.linalg.solve(trace.T @ (weights * trace), forces)
    return found


def _stresses(stepper: Stepper, steps: Sequence[Step], places: Array) -> Array:
    """w at places (m, s), m, one column a step; Pa m."""
    times = np.array(stepper.relaxation.times)
    missed = np.zeros((len(times), len(stepper.radii)))
    found = np.empty_like(places)
    before, edge = stepper.touch(), 0.0
    read_at = before.time
    for number, step in enumerate(steps):
        missed *= np.exp(-(step.radius_time - read_at) / times)[:, None]
        if step.radius > edge:
            missed += _missed(stepper, before, step, edge)
        found[:, number] = _stress(stepper, before, step, missed, places[:, number])
        before, edge, read_at = step.state, step.radius, step.radius_time
    return found


def _stress(stepper: Stepper, before: State, step: Step, missed: Array, places: Array) -> Array:
    """w at places (m,), m, when the contact radius was that of a step; ``missed`` (k, r) goes to the branches."""
    relaxation, after = stepper.relaxation, step.state
    share = (step.radius_time - before.time) / step.length
    depth = before.depth + share * (after.depth - before.depth)
    velocity = before.velocity + share * (after.velocity - before.velocity)
    strain = before.memory.strain + share * (after.memory.strain - before.memory.strain)
    law = stepper.law(share * step.length)
    branches = before.memory.advanced(law, strain).branches[:, 0] + missed
    now = relaxation.equilibrium * (depth - stepper.strike.height(places)) + relaxation.viscosity * velocity
    return np.asarray(now + interpolate(np.asarray(relaxation.moduli) @ branches, stepper.radii[-1], places))


def _missed(stepper: Stepper, before: State, step: Step, edge: float) -> Array:
    """What the branches (k, r) miss, m, of a step in which the contact grew from ``edge``, m.

    Of a detour from the straight line, dz/dt = du/dt - z/tau leaves -1/tau times its faded integral.
    """
    after, ratios = step.state, step.length / np.array(stepper.relaxation.times)
    beside = slice(int(stepper.radii.searchsorted(edge, "right")), None)
    radii = stepper.radii[beside]
    height = np.minimum(stepper.heights[beside], BEYOND * stepper.radii[-1])  # a profile may end
    wide = np.maximum(before.memory.strain[0, beside] - (before.depth - height), np.finfo(float).tiny)
    narrow = np.clip(after.memory.strain[0, beside] - (after.depth - height), 0.0, EDGE * wide)
    reached = (radii**2 - edge**2) / (step.radius**2 - edge**2)
    arrival = np.where(radii < step.radius, reached, 1.0 / (1.0 - (narrow / wide) ** (1 / CLOSING)))
    left = np.maximum(1.0 - SHARES[:, None] / arrival, 0.0)
    detour = wide * left**CLOSING - (wide + SHARES[:, None] * (narrow - wide))
    missed = np.zeros((len(ratios), len(stepper.radii)))
    missed[:, beside] = -ratios[:, None] * ((WEIGHTS * np.exp(-np.outer(ratios, 1 - SHARES))) @ detour)
    return missed
