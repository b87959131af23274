"""A rigid profile pressed slowly into a body of large strains: every depth from the shallowest on, on one mesh.

The penalty's bias is of first order in its softness. With U(depth) the energy in the penalty, the force of a rigid
contact is F + dU/d(depth) to that order: F is the slope of the energy, whose change by the penalty K is U/K. One
back-substitution tells dU/d(depth), and the displacement to begin the next depth with.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices
from fe_contact.assembly.operators import ElasticBody, SolidMesh, moduli
from fe_contact.bodies.pressing import PressedDepths, half_width
from fe_contact.errors import ContactTooWide
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import Numerics
from fe_contact.solids import sharp_rim
from fe_contact.solids.base import State, elliptic
from fe_contact.solids.bulk import Bulk, CoredBody, Rolled
from fe_contact.solids.contact import Obstacle, OnDeformed, OnRound, OnTop, Points, Skin, flat_places
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.newton import (
    Balance,
    BeyondRange,
    Encounter,
    Equilibrium,
    EquilibriumLost,
    balanced,
    has_tip,
    material_of,
)
from fe_contact.targets.base import TARGETS
from lumped.errors import BadInput, Fault
from lumped.materials.energies.base import Strained, energy_of, strained
from lumped.scene.geometry import Geometry, finite_faults
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes import Shape
from lumped.shapes._block import Block

MESH_ORDER = 1.5  # of the force's error where the contact ends anywhere in an element
# The same where corners have infinite stresses: at small strain twice Williams' exponent, 1.2 to 1.5, but elements much
# strained show less, down to this where the volume stays; a mesh graded to a corner would be turned inside out there.
SHARP_ORDER = 0.4
MOST_SHARP = 3.0  # work: elements along a contact from which more of them take little from that
CORRECTED = "corrected"
CORE = 0.5  # of the way from the contact to the end of the mesh strains may be large
RAMP = (0.02, 0.2, 1.0)  # shares of the penalty with which a body is pressed for the first time
FARTHEST = 2.0  # a depth over the one before it, beyond which another is put between, or under a tip another mesh
LEAST_BEGUN = 0.05  # of a depth, that a body has to be pressed by from rest at once
WIDER = (1.0, 1.3, 1.7)  # the mesh again where a contact outgrew it: small strains tell how wide it is to be
WIDENING = 0.5  # power of the depth that a contact is wide by, under a sphere
ITERATIONS = 40  # work: of Newton's method for the stretch across a block
ROUNDING = 1e-13  # of that stretch
NEAREST = 0.02  # apart in ln depth, a way is not made in halves any more


@dataclass(frozen=True, eq=False)
class Solid:
    """A body on its mesh, in units of ``unit``, m, and E*; forces in unit to the power ``dimension``.

    ``basis`` of the mesh, of which some ``elements`` may be strained much; ``ends``: whether the mesh is all of it;
    ``lead`` share of a depth by which the striker comes in here; ``sharp``: whether it has corners where stresses are
    infinite.
    """

    encounter: Encounter
    basis: Basis
    elements: Indices
    unit: float
    dimension: int
    unknowns: int
    ends: bool
    lead: float
    sharp: bool

    @property
    def mesh_order(self) -> float:
        """Of the error in the force that elements leave."""
        return SHARP_ORDER if self.sharp else MESH_ORDER

    @classmethod
    def of(cls, indenter: Indenter, radii: Array, numerics: Numerics) -> Solid:
        """For contacts that end at these ``radii``, m, about."""
        make = TARGETS.get(indenter.target.name).solid
        assert make is not None
        mesh = make(indenter, radii, numerics)
        body, unit, profile = mesh.body, mesh.unit, indenter.profile
        rolled = None if mesh.inner_radius is None else Rolled(mesh.inner_radius)
        bulk, shear = _moduli(indenter)
        energy = energy_of(indenter.material.hyperelastic)
        response = Hyperelastic(energy, shear, bulk - 2.0 * shear / 3.0)
        elements = np.arange(body.basis.nelems) if mesh.ends else _core(body)
        core = Bulk.of(body.basis, body.surface.dimension == 2, elements, rolled)
        if mesh.ends:
            whole = CoredBody.whole(core, response, body.fixed)
        else:
            whole = CoredBody.of(core, response, body.stiffness(bulk, shear), body.fixed, datum=mesh.datum)
        striker, placed = _touched(mesh, profile, rolled)
        skin = Skin.of(body.surface, numerics.order, core.size, placed)
        encounter = replace(Encounter.of(whole, skin, striker), covered=mesh.covered)
        dimension = body.surface.dimension - 1
        return cls(encounter, body.basis, elements, unit, dimension, core.size, mesh.ends, mesh.lead, mesh.sharp)

    def advanced(
        self,
        before: Equilibrium | None,
        depth: float,
        stiffness: float,
        widening: float = WIDENING,
        state: State = (),
        start: Array | None = None,
    ) -> Equilibrium:
        """To a depth, m, as :func:`advanced`. Raises EquilibriumLost, which is BeyondRange where the material ends."""
        try:
            return advanced(self.encounter, before, self.lead * depth / self.unit, stiffness, widening, state, start)
        except BeyondRange as ended:
            raise BeyondRange(self.unit * ended.depth / self.lead) from None

    def pressed(self, reached: Equilibrium) -> Reached:
        """In m. Raises ContactTooWide."""
        radius = self.unit * contact_radius(reached.balance)
        if not np.isfinite(radius):
            raise ContactTooWide(self.unit * reached.balance.depth / self.lead)
        return Reached(self.unit**self.dimension * reached.rigid_force, radius, reached.error, reached.iterations)


def _moduli(indenter: Indenter) -> tuple[float, float]:
    """Bulk and shear modulus where the modulus of force, which is a block's own, counts as one."""
    material = indenter.material
    share = material.contact_modulus().glassy / indenter.shape.modulus(material).glassy
    bulk, shear = moduli(material.nu)
    return share * bulk, share * shear


def _touched(mesh: SolidMesh, profile: Shape, rolled: Rolled | None) -> tuple[Obstacle, Callable[[Array], Array]]:
    """What touches a body, and where on it the points of its surface's coordinates are."""
    if rolled is not None:
        return OnRound((profile.tip_radius or 0.0) / mesh.unit), rolled.place_on
    if mesh.covered:
        return OnTop(0.0), flat_places
    if mesh.mean_radius is not None:
        above = OnTop(mesh.mean_radius)
        return above, above.place
    return OnDeformed(profile, mesh.unit), flat_places


def _core(body: ElasticBody) -> Indices:
    """Elements in which strains may be large."""
    mesh = body.basis.mesh
    middle = mesh.p[:, mesh.t].mean(axis=1)
    away, zone = np.hypot(*middle), body.surface.zone
    reach = zone + CORE * (np.hypot(*mesh.p).max() - zone)
    return np.asarray(np.flatnonzero(away <= reach))


def check_large(source: str, geometry: Geometry, model: Model, enforcement: str, impacts: int | None = None) -> None:
    """Raise BadInput for what is not pressed with large strains in this version, or struck in so many ``impacts``."""
    faults = finite_faults(source, model, geometry, impacts) or sharp_rim.faults(source, geometry)
    if enforcement != CORRECTED:
        reason = f"{enforcement} is not built with large strains in this version; accepted: {CORRECTED}"
        faults.append(Fault(source, "numerics.enforcement", reason))
    if faults:
        raise BadInput(faults)


def exhausted(mesh_order: float, numerics: Numerics) -> frozenset[str]:
    """Settings of a body with corners of infinite stress that are not worth what they cost any more."""
    enough = mesh_order == SHARP_ORDER and numerics.elements_per_contact >= MOST_SHARP
    return frozenset({"elements_per_contact"} if enough else ())


class Softer(NamedTuple):
    """At which of the depths to press again, and by what penalty."""

    chosen: Indices
    penalty: float


class Reached(NamedTuple):
    """At one depth: force over modulus, m^2, contact radius, m, what another iteration would change, iterations."""

    force: float
    radius: float
    newton: float
    iterations: int


def press(
    indenter: Indenter,
    depth: Array,
    radii: Array,
    numerics: Numerics,
    softer: Softer | None = None,
    counted: Counted = uncounted,
) -> PressedDepths:
    """Every depth, m, from the smallest on; ``radii`` of the contacts expected, m; ``counted`` is told of each.

    Raises NotReached.
    """
    with material_of(indenter):
        if isinstance(indenter.shape, Block) and indenter.shape.uniform:
            return _pressed_evenly(indenter, indenter.shape, depth)
        for wider in WIDER[:-1]:
            try:
                return _pressed_on_meshes(indenter, depth, wider * radii, numerics, softer, counted)
            except ContactTooWide:
                continue
        return _pressed_on_meshes(indenter, depth, WIDER[-1] * radii, numerics, softer, counted)


def _pressed_on_meshes(
    indenter: Indenter, depth: Array, radii: Array, numerics: Numerics, softer: Softer | None, counted: Counted
) -> PressedDepths:
    """Every depth, m, on a body that is not strained alike everywhere. Raises NotReached."""
    found, again, widening = dict[int, Reached](), dict[int, Reached](), _widening(depth, radii)
    for together in _together(indenter.profile, depth):
        solid, reached = Solid.of(indenter, radii[together], numerics), None
        for i in together:
            stiffness = numerics.penalty * solid.unit / float(radii[i])
            reached = solid.advanced(reached, float(depth[i]), stiffness, widening)
            found[i] = solid.pressed(reached)
            counted(1.0)
            if softer is not None and i in softer.chosen:
                again[i] = solid.pressed(_pressed_by(softer.penalty / numerics.penalty * stiffness, reached))
    told = _told(solid, found)
    return told if softer is None else replace(told, softer=_told(solid, again))


def _pressed_evenly(indenter: Indenter, block: Block, depth: Array) -> PressedDepths:
    """Every depth, m, on a ``block`` strained alike everywhere: what one point answers is what the block answers,
    whatever the mesh. Raises EquilibriumLost.
    """
    along, material = 1.0 - depth / block.thickness, indenter.material
    across = np.ones_like(along)
    answer = _answered(indenter, along, across)
    for _ in range(ITERATIONS if block.sides == "free" else 0):
        change = -answer.stress[0] / (answer.tangent[0, 0] + answer.tangent[0, 4])
        across = across + np.maximum(change, 0.5 * (np.min(along) - 1.0))
        answer = _answered(indenter, along, across)
        if np.abs(change).max() < ROUNDING:
            break
    else:
        if block.sides == "free":
            raise EquilibriumLost(f"a block pressed by {depth.max():.3g} m has no stress across it that is zero")
    bearing = [elliptic(answer.tangent[..., i]) for i in range(depth.size)]
    if not all(bearing):
        raise BeyondRange(float(depth[np.logical_not(bearing)].min()))
    force = -block.area * answer.stress[3] / block.modulus(material).relaxed
    if not np.all(force > 0.0):
        raise EquilibriumLost(f"a block pressed by {depth.max():.3g} m does not press back")
    work = {"degrees_of_freedom": 1, "contact_problems": depth.size, "iterations": ITERATIONS}
    return PressedDepths(force, block.fixed_radius * across, work, np.inf, True)


def _answered(indenter: Indenter, along: Array, across: Array) -> Strained:
    """Of points stretched so, each (n,)."""
    material, none = indenter.material, np.zeros_like(along)
    shear = material.shear.relaxed
    lame = 2.0 * shear * material.nu / (1.0 - 2.0 * material.nu)
    gradient = np.stack([across - 1.0, none, none, along - 1.0, across - 1.0])
    return strained(energy_of(material.hyperelastic), gradient, shear, lame)


def _together(profile: Shape, depth: Array) -> list[list[int]]:
    """Places of the depths, ascending, that one mesh serves: all of them, or under a tip those of about one size.

    Strains grow towards a tip as the logarithm of the distance: elements as small as a slight contact needs would turn
    inside out under a deep one.
    """
    ascending: list[int] = np.argsort(depth).tolist()
    if not has_tip(profile):
        return [ascending]
    groups = list[list[int]]()
    for i in ascending:
        if not groups or depth[i] > FARTHEST * depth[groups[-1][0]]:
            groups.append([])
        groups[-1].append(i)
    return groups


def _pressed_by(stiffness: float, reached: Equilibrium) -> Equilibrium:
    """At the same depth by another penalty. Raises EquilibriumLost."""
    here = reached.balance
    return balanced(here.encounter, here.displacement, here.depth, stiffness, here.state, here.touch.touching)


def _told(solid: Solid, found: Mapping[int, Reached]) -> PressedDepths:
    """What was found at depths, by their places, ascending."""
    rows = [found[i] for i in sorted(found)]
    force, radius, newton, iterations = (np.array(column) for column in zip(*rows, strict=True))
    work = {
        "degrees_of_freedom": solid.unknowns,
        "contact_problems": len(rows),
        "iterations": int(iterations.sum()),
    }
    return PressedDepths(force, radius, work, solid.mesh_order, solid.ends, float(newton.max()))


def _widening(depth: Array, radii: Array) -> float:
    """Power of the depth, m, that contact radii, m, grow by, about."""
    first, last = int(depth.argmin()), int(depth.argmax())
    spread = math.log(depth[last] / depth[first])
    return math.log(radii[last] / radii[first]) / spread if spread > 0.0 else WIDENING


def advanced(
    encounter: Encounter,
    before: Equilibrium | None,
    depth: float,
    stiffness: float,
    widening: float = WIDENING,
    state: State = (),
    start: Array | None = None,
) -> Equilibrium:
    """From an equilibrium, or softly from a ``start`` (2 N,) or from rest, to another depth, in as few steps as can be.

    ``widening``: power of the depth that a contact is wide by, about; ``state``: what points remember meanwhile. Raises
    EquilibriumLost.
    """
    iterations = 0
    if before is None:
        before = _begun(encounter, depth, stiffness, state, start)
        iterations = before.iterations
        if before.balance.depth == depth:
            return before
    count = math.ceil(_apart(depth, before) / math.log(FARTHEST)) or 1
    left: list[float] = np.geomspace(depth, before.balance.depth, count, endpoint=False).tolist()
    while left:
        hasty = _apart(left[-1], before) > NEAREST
        try:
            found = balanced(
                encounter,
                before.predicted(left[-1]),
                left[-1],
                stiffness,
                state,
                touching=_touching(before, left[-1], widening),
                foreseen=before.foreseen(left[-1]),
                hasty=hasty,
            )
        except EquilibriumLost:
            if not hasty:
                if before.elliptic(left[-1]):
                    raise
                raise BeyondRange(before.balance.depth) from None
            left.append(math.sqrt(left[-1] * before.balance.depth))
            continue
        before, iterations = found, iterations + found.iterations
        left.pop()
    return replace(before, iterations=iterations)


def _apart(depth: float, before: Equilibrium) -> float:
    """Of a depth from that of an equilibrium, in logarithms."""
    return abs(math.log(depth / before.balance.depth))


def _touching(before: Equilibrium, depth: float, widening: float) -> Points:
    """Points that will touch at another depth, where the contact is as wide as a power ``widening`` of it."""
    balance, wider = before.balance, (depth / before.balance.depth) ** widening
    along, touching = balance.encounter.obstacle.along(balance.touch.skin.place), balance.touch.touching
    first, last = along[touching].min(initial=0.0), along[touching].max(initial=0.0)
    return np.asarray((along >= wider * first) & (along <= wider * last))


def _begun(
    encounter: Encounter, depth: float, stiffness: float, state: State, start: Array | None = None
) -> Equilibrium:
    """From a displacement (2 N,), or from rest, to a depth, or to the part of it that can be reached at once.

    Raises EquilibriumLost.
    """
    origin, share = np.zeros(encounter.skin.size) if start is None else start, 1.0
    while True:
        try:
            return pressed_first(encounter, share * depth, stiffness, origin, state)
        except EquilibriumLost:
            share *= 0.5
            if share < LEAST_BEGUN:
                raise


def pressed_first(encounter: Encounter, depth: float, stiffness: float, start: Array, state: State = ()) -> Equilibrium:
    """From a displacement ``start`` (2 N,) far away: a stiff penalty at once would turn elements inside out."""
    iterations = 0
    for share in RAMP:
        found = balanced(encounter, start, depth, share * stiffness, state)
        start, iterations = found.balance.displacement, iterations + found.iterations
    return replace(found, iterations=iterations)


def contact_radius(balance: Balance) -> float:
    """Where the surfaces part, on the deformed surface; infinite where the contact leaves the skin."""
    touch = balance.touch
    place = (touch.skin.place + touch.displacement).reshape(2, -1)
    overlap, along = touch.overlap.depth.ravel(), balance.encounter.obstacle.along(place)
    if balance.encounter.covered:
        return float(along.max())
    at_rest = balance.encounter.obstacle.along(touch.skin.place.reshape(2, -1))
    if at_rest[0] < 0.0:  # from where the first touch has come to
        along = along - np.interp(0.0, at_rest, along)
    apart = balance.way + touch.displacement[1].ravel() - overlap  # the undeformed surfaces
    return half_width(along, overlap, -overlap, height=np.maximum(apart, 0.0))
