"""The layer with waves: its base sends them back under the striker, its sides let them go."""

from __future__ import annotations

import math

import numpy as np

import meshes
from fe_contact.assembly.cache import cached_by_unknowns
from fe_contact.assembly.far_field import on_boundary
from fe_contact.assembly.forms import Basis, Matrix, check_compressible, mass
from fe_contact.assembly.operators import basis_on, boundary, made, moduli
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import held, thickness_over
from fe_contact.budget.plan import Plan, scales
from fe_contact.dynamics.body import Part
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.targets.layer import matrix
from fe_contact.waves.moving import BEYOND, SMALLEST, Moving, UnitBody, WaveSide
from fe_contact.waves.plan import DEFAULTS, NO_ECHO, SPREAD, TRAVEL, Echoes, contact_time, placed
from fe_contact.waves.targets.base import WaveTarget, too_fast
from lumped.errors import BadInput, Fault
from lumped.laws.mdr import ImpactScales
from lumped.materials import Relaxation
from lumped.scene.scene import Scene
from lumped.targets.layer import Layer

SPARE = 1.2  # a resonance may press the striker deeper than statics
# Width beyond the contact in thicknesses: at rest nothing is left of a load so far away, and in a contact of many
# echoes no wave fast enough to come back is left either.
NEAREST, FARTHEST = 8.0, 20.0
PLACES = 400  # of a face, between which its height is told well enough for a swing
LEAST = 4.0  # contact radii, of which half still holds the contact
ROUGH: Given = {  # work: settings of a coarse body that only tells the contact's scales
    "tolerance": 1e-2,
    "elements_per_contact": 2.0,
    "penalty": 100.0,
    "steps": 8,
    "far_radius": 20.0,
    "contact_radius": 1.0,
    "contact_time": 1.0,
    "peak_share": 0.5,
}


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; the impact without inertia places mesh and steps.

    Raises NotReached where even that does not come to an end, BadInput for a contact beyond its load curve.
    """
    check_compressible(scene)
    size = scales(scene, WaveNumerics(**DEFAULTS, **ROUGH))
    stiff = _stiffness(scene, size)
    return placed(scene, given, size, _far_radius(scene, size), SPARE, stiff, echoes=echoes(scene, size))


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, a striker with a rim, and one too fast."""
    scene.check_single("fe, where the layer rings on between contacts,")
    shape, faults = scene.geometry.shape, too_fast(scene)
    if shape.fixed_radius is not None:
        reason = f"{shape.name}: no waves under its rim in this version; accepted with model.inertia: a round profile"
        faults.append(Fault(scene.source, "striker.shape", reason))
    if faults:
        raise BadInput(faults)


def echoes(scene: Scene, size: ImpactScales) -> Echoes:
    """How often the fastest waves cross the layer and come back in the contact time, and how far they swing the force.

    Until the first of them is back every place that the face has met is pressed with rho c v, and by its echo with
    twice as much, whenever it comes. The met area A grows as a power p of the depth; of the sum of A(t - k echo) over k
    Euler and Maclaurin's formula leaves 2 zeta(-p) A(echo) beside what is smooth: 1 under a flat end, 1/6 under a
    sphere, hence about 6^(-p). A wave that goes so far in a period is damped by exp(-pi tan(loss)). What a place
    narrower than the layer is thick sends down spreads on its way.
    """
    shape, material, target = scene.profile, scene.geometry.material, scene.target
    assert isinstance(target, Layer)
    confined, density = material.confined_modulus(), material.density or 1.0
    if confined.glassy == 0.0:  # a dashpot alone sends no wave
        return NO_ECHO
    speed = math.sqrt(confined.glassy / density)
    echo = 2.0 * target.thickness / speed
    radii = np.linspace(0.0, SPARE * size.contact_radius, PLACES)
    areas = 2.0 * radii * shape.total if shape.plane else math.pi * radii**2
    depths = scene.velocity * echo * np.array([1.0, 2.0])
    met = float(np.interp(depths[0], shape.height(radii), radii))
    first, second = np.interp(depths, shape.height(radii), areas).tolist()
    left = 6.0 ** -math.log2(max(second / first, 1.0)) if first > 0.0 else 0.0
    modulus = complex(confined.operational(2.0j * math.pi / echo))
    left *= math.exp(-math.pi * modulus.imag / modulus.real)
    left *= min(met / target.thickness, 1.0) ** (2 if shape.plane else 3)
    swing = density * speed * scene.velocity * first / size.peak_force * left
    return Echoes(contact_time(scene, size) / echo, swing) if swing > 0.0 else NO_ECHO


def _stiffness(scene: Scene, size: ImpactScales) -> float:
    """Of the layer under the largest contact, over that of a half-space; at least one."""
    shape, a = scene.profile, size.contact_radius
    curve = scene.target.load_curve(shape, scene.geometry.material.nu)
    slope = float(curve.force_and_slope(size.peak_depth)[1])
    area = 2.0 * a if shape.plane else math.pi * a**2
    return max(0.5 * math.pi * slope * a / area, 1.0)


def _far_radius(scene: Scene, size: ImpactScales) -> float:
    """In contact radii, as far as pressure waves of the first answer, or a dashpot's spreading, go and come back."""
    material, duration, target = scene.geometry.material, contact_time(scene, size), scene.target
    assert isinstance(target, Layer)
    confined, density = material.confined_modulus(), material.density or 1.0
    travel = TRAVEL * math.sqrt(confined.glassy / density) * duration
    spread = SPREAD * math.sqrt(confined.viscosity * duration / density)
    width = min(max(travel, spread, NEAREST * target.thickness), FARTHEST * target.thickness)
    return min(max(1.0 + width / (SPARE * size.contact_radius), LEAST), RANGES["far_radius"][1])


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The layer of a scene at first touch, in SI units; in plane strain all of its length. Raises BodyTooThin."""
    unit, a, shape = unit_of(scene, numerics), numerics.contact_radius, scene.geometry.shape
    total, plane = shape.total, 1 if shape.plane else 0  # a dimension less to scale by
    points, areas, trace = unit.zone
    own = WaveSide(
        mass=(scene.geometry.material.density or 0.0) * total * a ** (3 - plane) * unit.mass,
        parts=_parts(scene, unit, total * a ** (1 - plane)),
        dashpots=_dashpots(scene, unit, total * a ** (2 - plane)),
        push=unit.pushed(trace.shape[1]),
        trace=trace,
        axial=np.zeros(unit.free.size),
    )
    return Moving.under(scene, own, a * points, total * a ** (2 - plane) * areas, BEYOND * a)


def unit_of(scene: Scene, numerics: WaveNumerics) -> UnitBody:
    """The layer of unit contact radius that a scene's is scaled from; one serves every material."""
    target = scene.target
    assert isinstance(target, Layer)
    thickness = thickness_over(numerics.contact_radius, target.thickness)
    sizes = (numerics.elements_per_contact, numerics.finer, thickness, numerics.far_radius)
    return unit_layer(sizes, numerics.order, target.base == "bonded", scene.geometry.shape.plane, numerics.mass)


@cached_by_unknowns
def unit_layer(
    sizes: tuple[float, float, float, float], order: int, bonded: bool, plane: bool, masses: str
) -> UnitBody:
    """The mesh, to be assembled; made once for all steps and penalties.

    ``sizes``: elements, how much finer they are at the surface, thickness, far radius. Stiffness of unit bulk and of
    unit shear modulus, dashpots on the side against motion through it and along it.
    """
    elements, finer, thickness, far_radius = sizes
    basis = basis_on(made(meshes.layer_for_waves, elements, SMALLEST, thickness, far_radius - 1.0, finer), order)
    fixed = held(basis, along=("axis", "base") if bonded else ("axis",), across=("base",))
    return UnitBody(
        basis,
        flat(basis, 2 if plane else 3),
        fixed,
        masses,
        local=lambda: mass(basis, plane),
        springs=lambda: [matrix(basis, plane, *one) for one in ((1.0, 0.0), (0.0, 1.0))],
        absorbing=lambda: [_side(basis, plane, component) for component in (0, 1)],
    )


def _side(basis: Basis, plane: bool, component: int) -> Matrix:
    """Unit impedance of one component of the motion on the side, sparse (2 N, 2 N)."""
    facets = boundary(basis, ("side",))
    radius = np.asarray(facets.global_coordinates())[0]
    tensor = np.zeros((2, 2, *radius.shape))
    tensor[component, component] = 1.0
    return on_boundary(facets, tensor, 2.0 if plane else 2 * np.pi * radius)


def _parts(scene: Scene, unit: UnitBody, scale: float) -> tuple[Part, ...]:
    """Where nu stays one modulus tells all, else volume and shape relax apart."""
    material = scene.geometry.material
    if scene.geometry.surface_remembers:
        bulk, shear = moduli(material.nu)  # of E* = 1
        return (Part(scale * (bulk * unit.stiffness[0] + shear * unit.stiffness[1]), material.contact_modulus()),)
    volume, shape = Relaxation(material.bulk), material.shear
    return Part(scale * unit.stiffness[0], volume), Part(scale * unit.stiffness[1], shape)


def _dashpots(scene: Scene, unit: UnitBody, scale: float) -> Matrix:
    """What the side's dashpots resist, of waves as fast as the first answer sends them.

    Through a bonded layer's side go pressure waves; a sliding one's slowest mode is the plate's, modulus E*, which its
    springs follow at rest. A dashpot in parallel has no wave speed of its own: none.
    """
    material, target = scene.geometry.material, scene.target
    assert isinstance(target, Layer)
    if material.young.viscosity:
        return None
    leaving = material.confined_modulus() if target.base == "bonded" else material.contact_modulus()
    density, stiff = material.density or 0.0, (leaving.glassy, material.shear.glassy)
    through, along = (math.sqrt(modulus * density) for modulus in stiff)  # Pa s/m
    return scale * (through * unit.dashpots[0] + along * unit.dashpots[1])


MEMBER = WaveTarget.meshed(check, plan, lambda scene, numerics: [unit_of(scene, numerics)], moving)
