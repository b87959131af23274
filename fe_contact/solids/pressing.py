"""A rigid profile pressed slowly into a body of large strains: every depth from the shallowest on, on one mesh.

The penalty's bias is of first order in its softness. With U(depth) the energy in the penalty, the force of a rigid
contact is F + dU/d(depth) to that order: F is the slope of the energy, whose change by the penalty K is U/K. One
back-substitution tells dU/d(depth), and the displacement to begin the next depth with.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fe_contact.assembly.forms import Array, Indices
from fe_contact.assembly.operators import ElasticBody, moduli
from fe_contact.bodies.pressing import PressedDepths, contact_end
from fe_contact.contact.problem import ContactSolution
from fe_contact.errors import ContactTooWide
from fe_contact.settings import Numerics
from fe_contact.solids.base import State
from fe_contact.solids.block import press as pressed_alike
from fe_contact.solids.bulk import Bulk, CoredBody
from fe_contact.solids.contact import OnDeformed, OnRound, Skin
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.newton import Balance, Encounter, Equilibrium, EquilibriumLost, balanced
from fe_contact.solids.rolled import Rolled
from fe_contact.targets.base import TARGETS
from lumped.errors import BadInput, Fault
from lumped.materials.energies.base import energy_of
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes._block import Block
from lumped.targets import HalfSpace

MESH_ORDER = 1.5  # of the force's error where the contact ends anywhere in an element
CORRECTED = "corrected"
CORE = 0.5  # of the way from the contact to the end of the mesh strains may be large
RAMP = (0.02, 0.2, 1.0)  # shares of the penalty with which a body is pressed for the first time
FARTHEST = 2.0  # a depth over the one before it, beyond which another is put between
LEAST_BEGUN = 0.05  # of a depth, that a body has to be pressed by from rest at once
SPLITS = 12  # work: of the way to a depth that cannot be reached at once


@dataclass(frozen=True, eq=False)
class Solid:
    """A body on its mesh, in units of ``unit``, m, and E*; forces in unit to the power ``dimension``.

    ``ends``: whether the mesh is all of it.
    """

    encounter: Encounter
    unit: float
    dimension: int
    unknowns: int
    ends: bool

    @classmethod
    def of(cls, indenter: Indenter, radii: Array, numerics: Numerics) -> Solid:
        """For contacts that end at these ``radii``, m, about."""
        make = TARGETS.get(indenter.target.name).solid
        assert make is not None
        mesh = make(indenter, radii, numerics)
        body, unit, profile = mesh.body, mesh.unit, indenter.profile
        rolled = None if mesh.inner_radius is None else Rolled(mesh.inner_radius)
        bulk, shear = moduli(indenter.material.nu)
        energy = energy_of(indenter.material.hyperelastic)
        response = Hyperelastic(energy, shear, bulk - 2.0 * shear / 3.0)
        elements = np.arange(body.basis.nelems) if mesh.ends else _core(body)
        core = Bulk.of(body.basis, body.surface.dimension == 2, elements, rolled)
        places = body.basis.doflocs[:, body.surface.dofs]
        skin = Skin.of(body.surface, places, numerics.order, core.size, rolled)
        if mesh.ends:
            whole = CoredBody.whole(core, response, body.fixed)
        else:
            whole = CoredBody.of(core, response, body.stiffness(bulk, shear), body.fixed)
        striker = OnDeformed(profile, unit) if rolled is None else OnRound((profile.tip_radius or 0.0) / unit)
        return cls(Encounter.of(whole, skin, striker), unit, body.surface.dimension - 1, core.size, mesh.ends)


def _core(body: ElasticBody) -> Indices:
    """Elements in which strains may be large."""
    mesh = body.basis.mesh
    middle = mesh.p[:, mesh.t].mean(axis=1)
    away, zone = np.hypot(*middle), body.surface.zone
    reach = zone + CORE * (np.hypot(*mesh.p).max() - zone)
    return np.asarray(np.flatnonzero(away <= reach))


def check_large(source: str, geometry: Geometry, model: Model, enforcement: str) -> None:
    """Raise BadInput for what is not pressed with large strains in this version."""
    shape, target, faults = geometry.shape, geometry.target, list[Fault]()
    cure = "or model.kinematics = 'small'"

    def refuse(key: str, reason: str) -> None:
        faults.append(Fault(source, key, f"with model.kinematics = 'finite' {reason}; accepted: {cure}"))

    meshed = not (isinstance(shape, Block) and shape.uniform)
    if meshed and (target.name not in TARGETS.names or TARGETS.get(target.name).solid is None):
        able = ", ".join(name for name, member in TARGETS.members.items() if member.solid is not None)
        refuse("target.shape", f"a {shape.name} on a {target.name} is not built: {able} are")
    elif shape.plane and isinstance(target, HalfSpace):
        refuse("target.shape", "a half_space in plane strain is not built: layer and ring are")
    elif meshed and target.fixed_radius(shape) is not None:
        refuse("striker.shape", f"the rim of a {shape.name} is not built: rounded strikers, cones and powers are")
    if geometry.striker_material is not None:
        refuse("striker.material", "two bodies that yield are not built")
    if model.inertia:
        refuse("model.inertia", "waves are not built")
    if enforcement != CORRECTED:
        refuse("numerics.enforcement", f"{enforcement} is not built: {CORRECTED} is")
    if faults:
        raise BadInput(faults)


def press(indenter: Indenter, depth: Array, radii: Array, numerics: Numerics) -> PressedDepths:
    """Every depth, m, from the smallest on; ``radii`` of the contacts expected, m. Raises NotReached."""
    if isinstance(indenter.shape, Block):
        return pressed_alike(indenter, indenter.shape, depth)
    solid = Solid.of(indenter, radii, numerics)
    force, radius, newton = (np.empty_like(depth) for _ in range(3))
    reached, iterations = None, 0
    for i in np.argsort(depth):
        stiffness = numerics.penalty * solid.unit / float(radii[i])
        reached = advanced(solid.encounter, reached, float(depth[i]) / solid.unit, stiffness)
        force[i] = solid.unit**solid.dimension * reached.rigid_force
        radius[i] = solid.unit * contact_radius(reached.balance)
        newton[i], iterations = reached.error, iterations + reached.iterations
        if not np.isfinite(radius[i]):
            raise ContactTooWide(float(depth[i]))
    work = {"degrees_of_freedom": solid.unknowns, "contact_problems": depth.size, "iterations": iterations}
    return PressedDepths(force, radius, work, MESH_ORDER, solid.ends, float(newton.max()))


def advanced(encounter: Encounter, before: Equilibrium | None, depth: float, stiffness: float) -> Equilibrium:
    """From an equilibrium to that of a larger depth, by as many steps as it takes. Raises EquilibriumLost."""
    if before is None:
        before = _begun(encounter, depth, stiffness)
    if before.balance.depth == depth:
        return before
    count = math.ceil(math.log(depth / before.balance.depth) / math.log(FARTHEST)) or 1
    left = list(np.geomspace(depth, before.balance.depth, count, endpoint=False))
    iterations, splits = 0, 0
    while left:
        try:
            found = balanced(encounter, before.predicted(left[-1]), left[-1], stiffness)
        except EquilibriumLost:
            splits += 1
            if splits > SPLITS:
                raise
            left.append(0.5 * (left[-1] + before.balance.depth))
            continue
        before, iterations = found, iterations + found.iterations
        left.pop()
    return replace(before, iterations=iterations)


def _begun(encounter: Encounter, depth: float, stiffness: float) -> Equilibrium:
    """From rest to a depth, or to the part of it that can be reached at once. Raises EquilibriumLost."""
    start, share = np.zeros(encounter.skin.size), 1.0
    while True:
        try:
            return pressed_first(encounter, share * depth, stiffness, start)
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
    edge = ContactSolution(overlap, 0, True, ()).edge(along)
    if not np.isfinite(edge):
        return edge
    rise = np.asarray(balance.depth + place[1] - overlap)
    return contact_end(along, edge, -overlap, rise)
