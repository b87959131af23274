"""Displacement, stress, pressure and contact status of the half-space at peak force, as a VTU file.

A viscoelastic body of constant Poisson's ratio has, at every instant, the displacement of the elastic body with
the same surface displacement, and the stress of the elastic body under the same pressure. So two
back-substitutions give the whole interior, on a finer mesh than the impact's: a stress is a derivative. With a body
of constant bulk modulus the interior does not follow from the surface, and nothing is written. With large strains the
fields are those of the impact's own mesh, where strains may be large, with Cauchy's stress, the pressure on the
deformed surface, and points where they are at rest: the deformed body is where the displacement takes them.

Cells and points of ``fields.vtu``: every finite element is cut along its own nodes into linear triangles, so
that the points are the nodes of the element, at (x, y, z) = (r, z, 0) m with the body at z <= 0. Point data:

    displacement   (u_r, u_z, 0), m
    stress_rr, stress_zz, stress_hoop, stress_rz    Pa, tension positive, averaged over the elements at a node
    pressure       Pa, on the contact surface; zero elsewhere
    contact        1 where the bodies touch, 0 elsewhere
    velocity       (v_r, v_z, 0), m/s, of a body with inertia, whose fields are those of the march itself
    plastic_strain its amount, sqrt(2/3) times the length of its path, of a body that yields

The contact pressure is as the body feels it, without what its shape functions cannot see. The march keeps it at
quadrature points, where the surface's memory leaves a roughness of some per cent that has no moment against any shape
function: projected onto them it is smooth, and its integral unchanged. Where the mesh follows the contact it is read
otherwise, see :mod:`fe_contact.steppers.scaled_surface`, and has no such roughness.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices, isotropic
from fe_contact.assembly.operators import SurfaceOperator, WholeBody
from fe_contact.bodies.pressing import BEYOND
from fe_contact.budget.certify import Certified
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem
from fe_contact.settings import Numerics
from fe_contact.solids.newton import Equilibrium
from fe_contact.solids.pressing import Solid, contact_radius
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.steppers.steps import Snapshot
from fe_contact.targets.base import TARGETS
from lumped.errors import BadInput, Fault
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.targets import HalfSpace
from lumped.targets.layer import Layer

FINER = 1.5  # elements along the contact radius, over those of the impact
STRESSES = ("stress_rr", "stress_zz", "stress_hoop", "stress_rz")


@dataclass(frozen=True, eq=False)
class Fields:
    """The body at one instant, s; ``depth``, m, and ``contact_radius``, m, of the striker.

    ``points`` (n, 2), m, radius and axial coordinate; ``triangles`` (t, 3); ``displacement`` (n, 2), m;
    ``stress`` (n, 4), Pa, see ``STRESSES``; ``pressure`` (n,), Pa; ``contact`` (n,), 1 or 0.
    """

    time: float
    depth: float
    contact_radius: float
    points: Array
    triangles: Indices
    displacement: Array
    stress: Array
    pressure: Array
    contact: Indices


def check_fields(scene: Scene) -> None:
    """Raises BadInput where the interior does not follow from the surface, or has another section than (r, z).

    That is a relaxing body of constant bulk modulus; plane strain, flat ends, and what is no half-space and no layer.
    """
    shape, target, material = scene.geometry.shape, scene.target, scene.geometry.material
    if shape.plane or target.fixed_radius(shape) is not None or not isinstance(target, HalfSpace | Layer):
        reason = f"{shape.name} on {target.name}: accepted with --fields: a round profile on half_space or layer"
        raise BadInput(Fault(scene.source, "target.shape", reason))
    if material.constant == "bulk" and not material.young.is_elastic:
        reason = "'bulk': the interior does not follow from the surface; accepted with --fields: \"poisson\""
        raise BadInput(Fault(scene.source, "target.material.constant", reason))


def write_fields(scene: Scene, certified: Certified, where: Path) -> Path:
    """Write ``fields.vtu`` into the folder ``where``, made when it is not there; its path. Raises BadInput."""
    return written(fields_at_peak(scene, certified), where)


def written(fields: Fields, where: Path, more: Mapping[str, Array] = MappingProxyType({})) -> Path:
    """The file ``fields.vtu`` in a folder, with what ``more`` is known of its points, (n,) or (n, 2); its path."""
    import meshio

    data: dict[str, np.ndarray[Any, Any]] = {"displacement": _lifted(fields.displacement)}
    data |= dict(zip(STRESSES, fields.stress.T, strict=True))
    data |= {"pressure": fields.pressure, "contact": fields.contact}
    data |= {name: values if values.ndim == 1 else _lifted(values) for name, values in more.items()}
    where.mkdir(parents=True, exist_ok=True)
    path = where / "fields.vtu"
    meshio.Mesh(_lifted(fields.points), [("triangle", fields.triangles)], point_data=data).write(path)
    return path


def fields_at_peak(scene: Scene, certified: Certified) -> Fields:
    """The fields in the step in which the force peaks. Raises BadInput, see :func:`check_fields`."""
    check_fields(scene)
    march = certified.march
    assert isinstance(certified.surface, ScaledSurface)
    step = peak_step(certified)
    pressure = felt(certified, step)
    depth = float(np.interp(pressure.time, march.time, march.depth))
    length = scale(certified.surface.operator, march.snapshots[step])
    finer = certified.numerics.varied(elements_per_contact=FINER * certified.numerics.elements_per_contact)
    meshed = TARGETS.get(scene.target.name).whole
    assert meshed is not None
    body = meshed(scene.geometry, finer)
    surface = replace(certified.surface, operator=body.operator)
    operator, points = body.operator, length * body.basis.doflocs.T
    touching = (points[:, 1] == 0.0) & (points[:, 0] <= pressure.contact_radius)
    pressed = body.solve(operator.trace.T @ (operator.weights * pressure.at(length * operator.points)))
    return Fields(
        time=pressure.time,
        depth=depth,
        contact_radius=pressure.contact_radius,
        points=points,
        triangles=subdivided(body.basis),
        displacement=_indented(scene, surface, body, finer, depth, length).reshape(-1, 2),
        stress=nodal_stress(body.basis, pressed, isotropic(1 - operator.poisson**2, operator.poisson)),
        pressure=np.where(touching, pressure.at(points[:, 0]), 0.0),
        contact=touching.astype(np.int64),
    )


def strained_fields(result: Result, solid: Solid, found: Equilibrium) -> Fields:
    """Of large strains, from the equilibrium where the force peaks. Raises BadInput, see :func:`check_fields`.

    What a facet bears along the motion over its shadow, r dr of the deformed surface, is the pressure.
    """
    check_fields(result.scene)
    modulus = result.scene.contact_modulus.glassy
    displacement, loaded = found.rigid
    gradient = loaded.bulk.gradient(displacement)
    values = np.concatenate([cauchy(loaded.answer.stress, gradient), gradient[[0, 4]]])
    *stresses, along, around = at_nodes(solid.basis, solid.elements, values)
    nodes = np.unique(solid.basis.element_dofs[:, solid.elements])
    triangles = subdivided(solid.basis).reshape(solid.basis.nelems, -1, 3)[solid.elements].reshape(-1, 3)
    touch, place, moved = found.balance.touch, solid.basis.doflocs[:, nodes].T, displacement.reshape(-1, 2)[nodes]
    radius = contact_radius(found.balance)
    touching = (place[:, 1] == 0.0) & (place[:, 0] + moved[:, 0] <= radius)
    borne = np.interp(place[:, 0], touch.skin.place[0].ravel(), touch.pressure.ravel())
    shadow = ((1.0 + along) * (1.0 + around))[nodes]
    return Fields(
        time=result.quantities["peak_time"].value or 0.0,
        depth=solid.unit * found.balance.depth / solid.lead,
        contact_radius=solid.unit * radius,
        points=solid.unit * place,
        triangles=np.searchsorted(nodes, triangles),
        displacement=solid.unit * moved,
        stress=modulus * np.stack(stresses, axis=1)[nodes],
        pressure=modulus * np.where(touching, borne / shadow, 0.0),
        contact=touching.astype(np.int64),
    )


def cauchy(stress: Array, gradient: Array) -> Array:
    """Cauchy's stress P F^T/J, (4, ...) as ``STRESSES``, of Piola and Kirchhoff's first, (5, ...)."""
    rr, rz, zr, zz, tt = gradient
    volume = ((1.0 + rr) * (1.0 + zz) - rz * zr) * (1.0 + tt)
    radial = stress[0] * (1.0 + rr) + stress[1] * rz
    axial = stress[2] * zr + stress[3] * (1.0 + zz)
    sheared = stress[0] * zr + stress[1] * (1.0 + zz)
    return np.asarray(np.stack([radial, axial, stress[4] * (1.0 + tt), sheared]) / volume)


def _indented(
    scene: Scene, surface: ScaledSurface, body: WholeBody, numerics: Numerics, depth: float, length: float
) -> Array:
    """Displacement (2 N,), m, of the body of unit modulus indented to a depth, on the unit mesh scaled to ``length``.

    Until the contact begins to shrink, which is never before the force peaks, the surface has the shape of an
    elastic one at the same depth (Lee and Radok 1960, doi:10.1115/1.3644020).
    """
    operator = body.operator
    height = np.minimum(scene.profile.height(length * operator.points), BEYOND * length)
    enforcement = ENFORCEMENTS.get(numerics.enforcement)
    problem = ContactProblem(surface.pressed, depth - height, numerics.penalty)
    solution = enforcement.enforce(problem, operator.points < 1.0)
    return np.asarray(body.solve(operator.trace.T @ (operator.weights * solution.pressure)))


def nodal_stress(basis: Basis, displacement: Array, law: Array) -> Array:
    """Stress (N, 4) at the nodes of a scalar basis, the mean over the elements that meet there.

    Parameters
    ----------
    basis : scalar scikit-fem basis with N degrees of freedom, coordinates (r, z).
    displacement : (2 N,), degree 2 k + c for node k and component c.
    law : stress over strain, (4, 4), see :func:`fe_contact.assembly.forms.isotropic`.
    """
    from skfem import CellBasis  # late: a body that is known already needs none

    at_nodes = CellBasis(basis.mesh, basis.elem, quadrature=(basis.elem.doflocs.T, np.ones(len(basis.elem.doflocs))))
    nodal = displacement.reshape(-1, 2)[basis.element_dofs]  # (local node, element, component)
    gradient = sum(
        np.einsum("ec,dep->ecdp", value, shape[0].grad) for value, shape in zip(nodal, at_nodes.basis, strict=True)
    )  # (element, component, direction, local node)
    radius = basis.doflocs[0, basis.element_dofs].T
    radial = nodal[:, :, 0].T
    # on the axis u_r / r is 0/0 and its limit du_r/dr
    hoop = np.where(radius > 0.0, radial / np.where(radius > 0.0, radius, 1.0), gradient[:, 0, 0])
    strain = np.stack([gradient[:, 0, 0], gradient[:, 1, 1], hoop, gradient[:, 0, 1] + gradient[:, 1, 0]])
    dofs = basis.element_dofs.T.ravel()
    shared = np.bincount(dofs, minlength=basis.N)
    sums = [np.bincount(dofs, component.ravel(), basis.N) for component in strain]
    return np.asarray((law @ (np.stack(sums) / shared)).T)


def at_nodes(basis: Basis, elements: Indices, values: Array) -> Array:
    """Values (k, e, points) of some elements at all nodes (k, N); zero where there is none."""
    degree = max(basis.elem.maxdeg - 1, 1)  # that of strains
    local = values @ (_monomials(basis.elem.doflocs, degree) @ np.linalg.pinv(_monomials(basis.X.T, degree))).T
    dofs = basis.element_dofs[:, elements].T.ravel()
    shared = np.maximum(np.bincount(dofs, minlength=basis.N), 1)
    return np.stack([np.bincount(dofs, part.ravel(), basis.N) for part in local]) / shared


def _monomials(places: Array, degree: int) -> Array:
    """Of coordinates (n, 2), up to a degree, (n, m)."""
    x, y = places.T
    return np.stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)], axis=1)


def subdivided(basis: Basis) -> Indices:
    """Linear triangles (t, 3) on the nodes of the elements of a scalar basis: order squared an element."""
    order = int(basis.elem.maxdeg)
    lattice = {tuple(place): k for k, place in enumerate(np.rint(order * basis.elem.doflocs).astype(int).tolist())}
    upright = [((i, j), (i + 1, j), (i, j + 1)) for i in range(order) for j in range(order - i)]
    turned = [((i, j), (i - 1, j), (i, j - 1)) for i in range(1, order) for j in range(1, order - i + 1)]
    local = np.array([[lattice[corner] for corner in triangle] for triangle in upright + turned])
    return np.asarray(basis.element_dofs[local].transpose(2, 0, 1).reshape(-1, 3), dtype=np.int64)


def _lifted(plane: Array) -> Array:
    """Vectors (n, 2) of the half-plane as vectors (n, 3) of space."""
    return np.column_stack([plane, np.zeros(len(plane))])


@dataclass(frozen=True, eq=False)
class Pressure:
    """Pressure (n,), Pa, at radii (n,), m, of the surface in one step; time, s; contact radius, m."""

    time: float
    contact_radius: float
    radii: Array
    values: Array

    def at(self, radii: Array) -> Array:
        """Pressure at other radii, linear in between, zero beyond the contact."""
        return np.where(radii <= self.contact_radius, np.interp(radii, self.radii, self.values), 0.0)


def felt(certified: Certified, step: int) -> Pressure:
    """Pressure in a step of the finest march."""
    snapshot = certified.march.snapshots[step]
    radii, values = certified.surface.felt(snapshot)
    return Pressure(snapshot.time, snapshot.contact_radius, radii, values / certified.curve.strike.total)


def scale(operator: SurfaceOperator, snapshot: Snapshot) -> float:
    """Length of the unit mesh in a step, m."""
    return float(snapshot.radii[0] / operator.points[0])


def peak_step(certified: Certified) -> int:
    """Index of the step of largest force."""
    return int(np.argmax([snapshot.force for snapshot in certified.march.snapshots]))


def nearest_step(certified: Certified, time: float) -> int:
    """Index of the step whose pressure lies nearest to a time, s."""
    return int(np.argmin([abs(s.time - time) for s in certified.march.snapshots]))
