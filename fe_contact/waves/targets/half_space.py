"""The half-space with waves: what it radiates never comes back, and its force is smooth.

A quarter disc so large that no echo returns, dashpots and springs beyond it. Its fields at peak force, displacement,
velocity and stress, are those of the march again, up to that instant.
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import meshes
from fe_contact.assembly.cache import cached_by_unknowns
from fe_contact.assembly.far_field import dashpots, wave_speeds
from fe_contact.assembly.forms import Array, check_compressible, isotropic, mass
from fe_contact.assembly.operators import basis_on, boundary, made, system_matrix
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import held
from fe_contact.budget.plan import SPRINGS, Plan
from fe_contact.dynamics.body import BodyState, Part
from fe_contact.dynamics.march import march
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import NO_FLOW
from fe_contact.fields import Fields, nodal_stress, subdivided, written
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.waves.balls import Ball, flying
from fe_contact.waves.impact import choices_of
from fe_contact.waves.moving import BEYOND, SMALLEST, Flying, Moving, UnitBody, WaveSide
from fe_contact.waves.plan import DEFAULTS, SMOOTH_STEPS, SPREAD, STEPS, TRAVEL, Usual, contact_time, placed
from fe_contact.waves.targets.base import WaveTarget, too_fast
from lumped.errors import BadInput, Fault
from lumped.laws import mdr
from lumped.laws.mdr import ImpactScales
from lumped.result.result import Result
from lumped.scene.geometry import changing_faults
from lumped.scene.scene import Scene

if TYPE_CHECKING:
    from fe_contact.plastic.core import YieldingCore

NEAREST = 20.0  # contact radii: the far springs' own need
NEAREST_AGAIN = 80.0  # the same where another contact begins on what they gave back of the one before
# Growth of elements into the body, of one along the radius a unit distance: where several contacts follow each other,
# the later ones begin on what the earlier ones left on its way.
ONE, SEVERAL = 3.0, 1.5
# Where a body yields, pressure reaches to the edge of the contact, which then passes every element with a jump of the
# force: it errs as elements are wide and steps are long. A softer penalty errs by chance there, by up to a quarter of
# the tolerance; a stiff one costs no more.
YIELDING_TOLERANCE = 1e-2  # default there: tighter ones take minutes
FIRM = Usual(elements=20.0, steps=400.0, penalty=1920.0, finer=2.0)
LEAST_RESTITUTION = 0.1  # a striker that comes back slower hardly comes back again


def check(scene: Scene) -> None:
    """Raise BadInput for a striker with a rim, in plane strain, or that rings on between impacts, and a changing nu."""
    if scene.striker_material is not None:
        scene.check_single("fe, where the ball rings on between contacts,")
    shape, faults = scene.geometry.shape, [*too_fast(scene), *changing_faults(scene.source, scene.geometry)]
    if shape.plane or shape.flat_radius > 0.0:
        reason = f"{shape.name}: no waves under it in this version; accepted with model.inertia: sphere, cone, power"
        faults.append(Fault(scene.source, "striker.shape", reason))
    if faults:
        raise BadInput(faults)


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open.

    Raises NotReached where even the row of springs does not come to an end, BadInput for a scheme by which what yields
    cannot flow.
    """
    check_compressible(scene)
    if scene.model.plasticity and "scheme" in given:
        _check_flows(scene, given["scheme"])
    scales = yielding_scales(scene) if scene.model.plasticity else mdr.estimate(scene, SPRINGS)
    longest = _slowest(scene, scales.restitution) * contact_time(scene, scales)
    far_radius = _far_radius(scene, scales.contact_radius, longest)
    if scene.model.plasticity:
        return placed(scene, {"tolerance": YIELDING_TOLERANCE, **given}, scales, far_radius, usual=FIRM)
    steps = SMOOTH_STEPS if scene.motion.impacts == 1 else STEPS  # what is left of one contact shakes the next
    return placed(scene, given, scales, far_radius, usual=Usual(steps=steps))


def _check_flows(scene: Scene, scheme: str) -> None:
    if WAVE_SCHEMES.get(scheme).of(DEFAULTS["rho"]).explicit:
        raise BadInput(Fault(scene.source, "numerics.scheme", NO_FLOW))


def yielding_scales(scene: Scene) -> ImpactScales:
    """Of an impact on what yields, by a coarse mesh without inertia. Raises NotReached."""
    from fe_contact.plastic.impact import curve_of, pilot  # late: only what yields needs it

    still = scene.changed({"model.inertia": False})
    march = pilot(still).march
    about = {name: value or 0.0 for name, value in curve_of(march, still).quantities.items()}
    return ImpactScales(
        contact_radius=float(march.radius.max()),
        peak_depth=about["peak_depth"],
        peak_force=about["peak_force"],
        peak_time=about["peak_time"],
        end=float(march.time[-1]),
        duration=about["duration"],
        restitution=about["restitution"],
    )


def _slowest(scene: Scene, restitution: float | None) -> float:
    """How much longer the last contact lasts than the first: as an elastic one does, with its speed to the -1/5."""
    elastic = partial(scene.profile.hertz_impact, 1.0, 1.0)
    slower = max(restitution or 1.0, LEAST_RESTITUTION) ** (scene.motion.impacts - 1)
    return elastic(slower).duration / elastic(1.0).duration


def _far_radius(scene: Scene, contact_radius: float, duration: float) -> float:
    """In contact radii: so far that pressure waves of the stiffest answer return too late, or viscosity has faded."""
    material = scene.geometry.material
    modulus = material.contact_modulus()  # the target's own, whatever strikes it
    density = material.density or 1.0
    fastest = wave_speeds(material.nu)[0] * math.sqrt(modulus.glassy / density)
    travel = max(TRAVEL * fastest * duration, SPREAD * math.sqrt(modulus.viscosity * duration / density))
    nearest = NEAREST if scene.motion.impacts == 1 else NEAREST_AGAIN
    return min(max(travel / contact_radius, nearest), RANGES["far_radius"][1])


def units(scene: Scene, numerics: WaveNumerics) -> list[UnitBody]:
    """The half-space of a scene, and a ball that strikes it."""
    balls = [] if scene.striker_material is None else [Ball.striking(scene).unit(numerics)]
    return [*balls, unit_of(scene, numerics)]


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The half-space of a scene and its striker, rigid or a ball, at first touch, in SI units."""
    if scene.striker_material is not None:
        return under_ball(scene, numerics)
    yields = yielding_core(scene, numerics) if scene.model.plasticity else None
    return Moving.under(scene, *side(scene, numerics), BEYOND * numerics.contact_radius, yields)


def yielding_core(scene: Scene, numerics: WaveNumerics) -> YieldingCore:
    """What may flow in the half-space of a scene that yields."""
    from fe_contact.plastic.core import YieldingCore  # late: only what yields needs it
    from fe_contact.plastic.ground import yielding_of

    material, unit = scene.geometry.material, unit_of(scene, numerics)
    strength, hardening = material.yield_strength, material.hardening_modulus or 0.0
    assert strength is not None  # see plasticity_faults
    yielding = yielding_of(material.nu, strength, hardening, material.contact_modulus().glassy)
    return YieldingCore.of(unit.basis, unit.free, unit.free.size + 1, numerics.contact_radius, yielding)


def under_ball(scene: Scene, numerics: WaveNumerics) -> Flying:
    """The ball of a scene and the half-space, which has the points."""
    struck, places, areas = side(scene, numerics)
    sides = [Ball.striking(scene).side(numerics, places), struck]
    return flying(scene, numerics, sides, (places, areas), (1.0, 0.0), endless=True)


def side(scene: Scene, numerics: WaveNumerics) -> tuple[WaveSide, Array, Array]:
    """The half-space of a scene in SI units, points where it may be touched, m from the axis, and their areas, m2."""
    material, a, unit = scene.geometry.material, numerics.contact_radius, unit_of(scene, numerics)
    modulus, density, (points, areas, trace) = material.contact_modulus(), material.density or 0.0, unit.zone
    # a dashpot in parallel has no wave speed of its own
    impedance = None if modulus.viscosity else (a**2 * np.sqrt(modulus.glassy * density)) * unit.dashpots[0]
    own = WaveSide(
        mass=density * a**3 * unit.mass,
        parts=(Part(a * unit.stiffness[0], modulus),),
        dashpots=impedance,
        push=unit.pushed(trace.shape[1]),
        trace=trace,
        axial=np.zeros(unit.free.size),
    )
    return own, a * points, a**2 * areas


def unit_of(scene: Scene, numerics: WaveNumerics) -> UnitBody:
    """The body of unit size that a scene's is scaled from."""
    nu = scene.geometry.material.nu
    growth = ONE if scene.motion.impacts == 1 else SEVERAL
    size = (numerics.elements_per_contact, numerics.finer, numerics.far_radius, growth)
    return unit_body(nu, size, numerics.order, numerics.mass)


@cached_by_unknowns
def unit_body(poisson: float, size: tuple[float, float, float, float], order: int, masses: str) -> UnitBody:
    """The mesh, to be assembled for contact radius and E* one; made once for all steps and penalties.

    ``size``: elements, how much finer they are at the surface, far radius, how elements grow into the body.
    """
    elements, finer, far_radius, growth = size
    basis = basis_on(made(meshes.half_space_for_waves, elements, SMALLEST, far_radius, finer, growth), order)
    return UnitBody(
        basis,
        flat(basis),
        held(basis, along=("axis",), across=()),
        masses,
        local=lambda: mass(basis),
        springs=lambda: [system_matrix(basis, poisson)],
        absorbing=lambda: [dashpots(boundary(basis, ("far",)), poisson)],
    )


def write_fields(scene: Scene, result: Result, where: Path) -> Path:
    """Write ``fields.vtu``, see :mod:`fe_contact.fields`, of an impact that was solved; its path. Raises NotReached.

    Of several contacts the first is shown.
    """
    peak_time = result.contacts[0]["peak_time"] if result.contacts else result.quantities["peak_time"].value
    fields, more = fields_at(scene, WaveNumerics(**result.numerics), peak_time or 0.0)
    return written(fields, where, more)


def fields_at(scene: Scene, numerics: WaveNumerics, time: float) -> tuple[Fields, dict[str, Array]]:
    """The fields at a time, s, to the next step, the velocity of the points (n, 2), m/s, and, of a body that yields,
    the amount of their plastic strain (n,). Raises NotReached.
    """
    body, unit, a = moving(scene, numerics), unit_of(scene, numerics), numerics.contact_radius
    state = march(body.body, body.velocity, choices_of(scene, numerics), time, body.watch).final
    points = a * unit.basis.doflocs.T
    surface = points[:, 1] == 0.0
    pressure = np.where(surface, np.interp(points[:, 0], body.places, state.pressure, right=0.0), 0.0)
    radius = float(body.places[state.signed_pressure > 0.0].max(initial=0.0))
    poisson = scene.geometry.material.nu
    law = isotropic(1 - poisson**2, poisson)  # of E* = 1
    more = {"velocity": unit.everywhere(state.velocity).reshape(-1, 2)}
    stress = nodal_stress(unit.basis, unit.everywhere(_stressed(body, state)) / a, law)
    if state.flowed is not None:
        taken, more["plastic_strain"] = yielding_core(scene, numerics).at_nodes(state.flowed)
        stress = stress - taken
    found = Fields(
        time=state.time,
        depth=float(state.displacement[-1]),
        contact_radius=radius,
        points=points,
        triangles=subdivided(unit.basis),
        displacement=unit.everywhere(state.displacement).reshape(-1, 2),
        stress=stress,
        pressure=pressure,
        contact=(surface & (points[:, 0] <= radius)).astype(np.int64),
    )
    return found, more


def _stressed(moving: Moving, state: BodyState) -> Array:
    """Modulus times displacement, of all that it remembers, (N,), N/m."""
    (part,), (branches,) = moving.body.parts, state.branches
    return part.stressed(state.displacement, branches) + part.relaxation.viscosity * state.velocity


MEMBER = WaveTarget.meshed(check, plan, units, moving, write_fields)
