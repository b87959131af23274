"""A rigid profile pressed slowly into a body of large strains: every depth from the shallowest on, on one mesh.

The penalty's bias is of first order in its softness. With U(depth) the energy in the penalty, the force of a rigid
contact is F + dU/d(depth) to that order: F is the slope of the energy, whose change by the penalty K is U/K. One
back-substitution tells dU/d(depth), and the displacement to begin the next depth with.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array, Indices
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.operators import ElasticBody, moduli
from fe_contact.bodies.pressing import PressedDepths, contact_end
from fe_contact.contact.problem import ContactSolution
from fe_contact.errors import ContactTooWide
from fe_contact.settings import Numerics
from fe_contact.solids.bulk import Body, Bulk
from fe_contact.solids.contact import OnDeformed, Skin
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.newton import Balance, Equilibrium, EquilibriumLost, Pressing, balanced
from fe_contact.targets.base import TARGETS
from lumped.materials.energies.base import DEFAULT, ENERGIES
from lumped.scene.indenter import Indenter

MESH_ORDER = 1.5  # of the force's error where the contact ends anywhere in an element
CORE = 0.5  # of the way from the contact to the end of the mesh strains may be large
RAMP = (0.01, 0.05, 0.25)  # shares of the penalty with which a body is pressed for the first time
FARTHEST = 1.5  # a depth over the one before it, beyond which another is put between
HALVINGS = 6  # work: of the way to a depth that cannot be reached at once


@dataclass(frozen=True, eq=False)
class Solid:
    """A body on its mesh, in units of ``unit``, m, and E*; forces in unit to the power ``dimension``.

    ``ends``: whether the mesh is all of it.
    """

    pressing: Pressing
    unit: float
    dimension: int
    unknowns: int
    ends: bool

    @classmethod
    def of(cls, indenter: Indenter, radii: Array, numerics: Numerics) -> Solid:
        """For contacts that end at these ``radii``, m, about."""
        make = TARGETS.get(indenter.target.name).solid
        assert make is not None
        body, unit = make(indenter, radii, numerics)
        bulk, shear = moduli(indenter.material.nu)
        energy = ENERGIES.get(indenter.material.hyperelastic or DEFAULT)
        response = Hyperelastic(energy, shear, bulk - 2.0 * shear / 3.0)
        core = Bulk.of(body.basis, body.surface.dimension == 2, _core(body))
        places = body.basis.doflocs[:, body.surface.dofs]
        skin = Skin.of(body.surface, places, numerics.order, core.size)
        whole = Body.of(core, response, body.stiffness(bulk, shear), body.fixed)
        pressing = Pressing.of(whole, skin, OnDeformed(indenter.profile, unit))
        return cls(pressing, unit, body.surface.dimension - 1, core.size, False)


def _core(body: ElasticBody) -> Indices:
    """Elements in which strains may be large."""
    mesh = body.basis.mesh
    middle = mesh.p[:, mesh.t].mean(axis=1)
    away, zone = np.hypot(*middle), body.surface.zone
    reach = zone + CORE * (np.hypot(*mesh.p).max() - zone)
    return np.asarray(np.flatnonzero(away <= reach))


def press(indenter: Indenter, depth: Array, radii: Array, numerics: Numerics) -> PressedDepths:
    """Every depth, m, from the smallest on; ``radii`` of the contacts expected, m. Raises NotReached."""
    solid = Solid.of(indenter, radii, numerics)
    force, radius, reached, iterations = np.empty_like(depth), np.empty_like(depth), None, 0
    for i in np.argsort(depth):
        stiffness = numerics.penalty * solid.unit / float(radii[i])
        reached = advanced(solid.pressing, reached, float(depth[i]) / solid.unit, stiffness)
        force[i] = solid.unit**solid.dimension * reached.rigid_force
        radius[i] = solid.unit * _contact_radius(reached.balance)
        iterations += reached.iterations
        if not np.isfinite(radius[i]):
            raise ContactTooWide(float(depth[i]))
    work = {"degrees_of_freedom": solid.unknowns, "contact_problems": depth.size, "iterations": iterations}
    return PressedDepths(force, radius, work, MESH_ORDER, solid.ends)


@dataclass(frozen=True, eq=False)
class Reached:
    """Equilibrium at a ``depth``; ``rate`` (2 N,) of its displacement by the depth; ``rigid_force`` without penalty."""

    depth: float
    balance: Balance
    rate: Array
    rigid_force: float
    iterations: int

    @classmethod
    def of(cls, depth: float, found: Equilibrium, iterations: int) -> Reached:
        """With what one back-substitution tells."""
        balance, free = found.balance, found.balance.pressing.body.free
        touch = balance.touch
        rate = np.zeros_like(balance.displacement)
        rate[free] = factorized(balance.tangent(convex=False))(-touch.stiffening[free])
        rigid = touch.force + touch.force + float(touch.forces @ rate)
        return cls(depth, balance, rate, rigid, iterations)

    def displacement(self, depth: float) -> Array:
        """To begin another depth with, (2 N,)."""
        return self.balance.displacement + (depth - self.depth) * self.rate


def advanced(pressing: Pressing, before: Reached | None, depth: float, stiffness: float) -> Reached:
    """From what was ``reached`` to a larger depth, by as many steps as it takes. Raises EquilibriumLost."""
    if before is None:
        return _first(pressing, depth, stiffness)
    count = math.ceil(math.log(depth / before.depth) / math.log(FARTHEST)) or 1
    iterations, split = 0, 0
    left = list(np.geomspace(depth, before.depth, count, endpoint=False))
    while left:
        try:
            found = balanced(pressing, before.displacement(left[-1]), left[-1], stiffness)
        except EquilibriumLost:
            split += 1
            if split > HALVINGS:
                raise
            left.append(0.5 * (left[-1] + before.depth))
            continue
        iterations += found.iterations
        before = Reached.of(left.pop(), found, iterations)
    return before


def _first(pressing: Pressing, depth: float, stiffness: float) -> Reached:
    """From rest: a stiff penalty pressed in at once would turn elements inside out."""
    displacement, iterations = np.zeros(pressing.skin.size), 0
    for share in (*RAMP, 1.0):
        found = balanced(pressing, displacement, depth, share * stiffness)
        displacement, iterations = found.balance.displacement, iterations + found.iterations
    return Reached.of(depth, found, iterations)


def _contact_radius(balance: Balance) -> float:
    """Where the surfaces part, on the deformed surface; infinite where the contact leaves the skin."""
    touch = balance.touch
    place = (touch.skin.place + touch.displacement).reshape(2, -1)
    overlap = touch.overlap.depth.ravel()
    edge = ContactSolution(overlap, 0, True, ()).edge(place[0])
    if not np.isfinite(edge):
        return edge
    rise = np.asarray(balance.depth + place[1] - overlap)
    return contact_end(place[0], edge, -overlap, rise)
