"""The rod: waves that come back, forces that jump; steps and elements go together, a wave crosses one in each.

Line elements with a striker on their end.

A dent in the end of a rod: the force that a half-space of its material would answer with, given by the model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sparse

import meshes
from fe_contact.assembly.forms import scatter
from fe_contact.budget.plan import Plan
from fe_contact.contact.enforcement.base import ENFORCEMENTS, Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching
from fe_contact.dynamics.body import Part, Pressing
from fe_contact.dynamics.march import Choices, march
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced
from fe_contact.errors import RodTooLong
from fe_contact.progress import Counted, Progress, uncounted
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.waves.impact import energies, left
from fe_contact.waves.line import LINE, Doubling, Run, witness
from fe_contact.waves.line_reading import read_rod
from fe_contact.waves.moving import Moving, WaveSide, with_rigid
from fe_contact.waves.plan import Cost
from fe_contact.waves.targets.base import WaveTarget
from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.hertz import HertzImpact
from lumped.result.model_ledger import Peak, model_ledger
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.targets.rod import Rod

DEFAULT_TOLERANCE = 1e-3  # default: relative, of every certified quantity of a rod
STEPS = 400  # along the contact time of the scene, at the default tolerance
FEWEST, MANY, MOST = 48, 2_500, 20_000  # elements: at first, and as far as they are doubled
MOST_MESHED = 100_000  # at all
LIGHT = 16.0  # of them in the part of the rod that is as heavy as the striker
# The fewest of them that a wave crosses while a flat striker is slowed to 1/e, and the most of which so few may be: a
# front's force lasts no longer, and whatever steps pass over it agree that it is less.
SLOWED, MOST_SLOWED = 6, 5_000
WHOLE = 0.95  # of them at least, as a plan takes a whole number
FRONT = 40.0  # of them which a wave crosses while the dent's force grows to that of a front
RELAXED = 6.0  # of them which it crosses in the shortest relaxation time
COARSEST = 8  # of them that a user's own steps may leave
ROUNDING = 1e-9  # of the striker's velocity, below which it does not leave the rod
MOST_STEPS = 60  # work: Newton's, of the dent in one step
PRECISE = 1e-13  # of the overlap


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open."""
    rod = scene.target
    assert isinstance(rod, Rod)
    tolerance = float(given.get("tolerance", DEFAULT_TOLERANCE))
    contact_time, radius = scene.elastic_contact_time, float(np.sqrt(rod.area / np.pi))
    flat = scene.profile.fixed_radius is not None
    coarse = WaveNumerics(
        tolerance=tolerance,
        **LINE,
        **_usual(scene),
        steps=int(min(STEPS * max(1.0, (DEFAULT_TOLERANCE / tolerance) ** 0.5), RANGES["steps"][1])),
        far_radius=rod.length / radius,
        contact_radius=radius,
        contact_time=contact_time,
    ).varied(**given)
    shape = scene.profile.hertz_impact(scene.contact_modulus.glassy, scene.reduced_mass, scene.velocity)
    more = max(_fewest(scene, None if flat else shape) / elements(scene, coarse), 1.0)
    settings = coarse if "steps" in given else coarse.varied(steps=math.ceil(coarse.steps * more))
    _check_steps(scene, settings)
    scales = Peak(shape.force, shape.depth, shape.contact_radius, contact_time)
    return Plan(settings, frozenset(given) - {"tolerance"}, model_ledger(scene, scales))


def _fewest(scene: Scene, dent: HertzImpact | None) -> float:
    """Elements at first: what the striker's mass, a dent and a relaxation need.

    A heavy striker dents the rod until the dent presses as hard as a front, impedance x velocity, soon after touch.
    """
    times, crossing = scene.geometry.material.uniaxial_modulus().times, transit(scene)
    needs = [FEWEST, LIGHT * rod_mass(scene) / scene.reduced_mass]
    if dent is not None:
        impedance = rod_mass(scene) / crossing
        share = impedance * scene.velocity / dent.force
        grown = share ** (1.0 / scene.profile.exponent_of_force) * dent.depth / scene.velocity
        needs.append(FRONT * crossing / grown)  # by this or by LIGHT a wave crosses 64 in the time of a dent, or more
    needs += [RELAXED * crossing / min(times)] if times else []
    return max(min(max(needs), MANY), min(_slowing(scene), MOST_SLOWED))


def _slowing(scene: Scene) -> float:
    """Elements with which enough steps slow a flat striker; a dent makes forces grow and fade by itself."""
    return SLOWED * rod_mass(scene) / scene.reduced_mass if scene.profile.fixed_radius is not None else 0.0


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings."""
    return Cost.of(elements(scene, numerics), numerics, scene.motion.impacts)


def way(scene: Scene, chosen: Plan, progress: Progress) -> Doubling:
    """Marched with steps and elements together; a dent tells what is left out when it is known."""
    numerics = chosen.numerics
    assert isinstance(numerics, WaveNumerics)
    most, dented = MOST * numerics.steps / elements(scene, numerics), scene.profile.fixed_radius is None
    return Doubling(scene, chosen, partial(run, scene), partial(_varied, scene), most, dented, progress)


def _usual(scene: Scene) -> Table:
    """Our method: steps that follow a wave; a flat end's mass takes its jumps, a dent needs a surface without."""
    mass = "redistributed" if scene.profile.fixed_radius is None else "lumped"
    return {"enforcement": "exact", "scheme": "central_difference", "mass": mass}


def _check_steps(scene: Scene, numerics: WaveNumerics) -> None:
    """Raise BadInput for steps so long that half of them say nothing, or that they pass over the force of a front,
    RodTooLong for a rod of too many elements.
    """
    count = elements(scene, numerics)
    if count < COARSEST:
        reason = f"{numerics.steps} in {numerics.contact_time:.3g} s: a wave crosses the rod in {count} of them"
        fewest = math.ceil(COARSEST * numerics.contact_time / transit(scene))
        raise BadInput(Fault(scene.source, "numerics.steps", f"{reason}; accepted: from {fewest}, or none given"))
    if count > MOST_MESHED:
        raise RodTooLong(transit(scene), count, MOST_MESHED)
    if count < WHOLE * _slowing(scene):
        raise BadInput(_passed_over(scene, numerics))


def _passed_over(scene: Scene, numerics: WaveNumerics) -> Fault:
    """The fault of steps that pass over the force of a front on a light striker."""
    if _slowing(scene) <= MOST_SLOWED:
        fewest = math.ceil(_slowing(scene) * numerics.contact_time / transit(scene))
        reason = f"{numerics.steps} pass over the force of a front on striker.mass"
        return Fault(scene.source, "numerics.steps", f"{reason}; accepted: from {fewest}, or none given")
    least = SLOWED / MOST_SLOWED * rod_mass(scene)
    other = ", or --method rod_waves" if scene.geometry.material.young.is_elastic else ""
    reason = f"{scene.mass:g}: so light on the rod that steps pass over the force of a front"
    return Fault(scene.source, "striker.mass", f"{reason}; accepted: from {least:.3g}{other}")


def _varied(scene: Scene, numerics: WaveNumerics) -> dict[str, WaveNumerics]:
    """Steps and elements are one; where another method than ours is chosen, what it errs by."""
    return {"time_step": numerics.varied(steps=numerics.steps // 2), **witness(numerics, _usual(scene))}


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, and for materials whose waves these elements or their end do not carry."""
    scene.check_single("fe, where the rod rings on between contacts,")
    rod, material = scene.target, scene.geometry.material
    assert isinstance(rod, Rod)
    reason = ""
    if material.young.viscosity > 0.0:
        reason = "a dashpot in parallel has no wave speed for steps to follow; accepted: a material without one"
    elif rod.end == "absorbing" and not material.young.is_elastic:
        reason = 'an absorbing end lets elastic waves out; accepted: elastic, or target.end = "fixed" or "free"'
    if reason:
        raise BadInput(Fault(scene.source, "target.material.law", reason))


def run(scene: Scene, numerics: WaveNumerics, counted: Counted = uncounted) -> Run:
    """One march, its steps, ``counted``, those in which a wave crosses an element. Raises NotReached."""
    body = moving(scene, numerics)
    count = elements(scene, numerics)
    step = transit(scene) / count
    choices = Choices(WAVE_SCHEMES.get(numerics.scheme).of(numerics.rho), _enforced(scene, numerics), step)
    gone = partial(left, slow=ROUNDING * scene.velocity)  # of a light striker's force an echo finds but rounding
    found = march(body.body, body.velocity, choices, scene.end_time, body.watch, gone, counted)
    reading = read_rod(found, scene, count, gone(found.samples[-1]))
    return Run(reading, energies(body, found, scene), len(found.samples) - 1, body.body.size)


def _enforced(scene: Scene, numerics: WaveNumerics) -> Enforced:
    """A flat end keeps to the rod's; any other dents it first."""
    if scene.profile.fixed_radius is not None:
        return Enforced(ENFORCEMENTS.get(numerics.enforcement), numerics.penalty * scene.contact_modulus.glassy)
    return Enforced(Enforcement(Dent(scene.contact_modulus.glassy, scene.profile.load_curve).enforce), 1.0)


@dataclass(frozen=True)
class Dent:
    """A way to keep rod and striker apart at one point: force = modulus x load curve of the overlap that is left."""

    modulus: float
    curve: LoadCurve

    def enforce(self, problem: ContactProblem, *guesses: Touching) -> ContactSolution:
        """Newton on dent + yielding x force = overlap, convex, from above; a budget used up is not converged."""
        trace, free = problem.surface.trace, float(problem.overlap[0])
        yielding = float(trace[0] @ np.linalg.solve(problem.surface.stiffness, trace[0]))
        dent, iteration = free, 0
        while dent > 0.0 and iteration < MOST_STEPS:
            iteration += 1
            force, slope = self._force(dent)
            change = (dent + yielding * force - free) / (1.0 + yielding * slope)
            dent -= change
            if abs(change) <= PRECISE * free:
                break
        signed = np.array([self._force(dent)[0] if dent > 0.0 else dent])
        return ContactSolution(signed, iteration, iteration < MOST_STEPS, (signed > 0.0,))

    def _force(self, dent: float) -> tuple[float, float]:
        """N, and N/m."""
        force, slope = self.curve.force_and_slope(dent)
        return self.modulus * float(force), self.modulus * float(slope)


def elements(scene: Scene, numerics: WaveNumerics) -> int:
    """How many a wave crosses one a step."""
    return max(round(transit(scene) * numerics.steps / numerics.contact_time), 1)


def rod_mass(scene: Scene) -> float:
    """Of the whole rod, kg."""
    rod = scene.target
    assert isinstance(rod, Rod)
    return (scene.geometry.material.density or 0.0) * rod.area * rod.length


def speed(scene: Scene) -> float:
    """Of the fastest waves along the rod, m/s."""
    material = scene.geometry.material
    return float(np.sqrt(material.uniaxial_modulus().glassy / (material.density or 1.0)))


def transit(scene: Scene) -> float:
    """How long they take from one end to the other, s."""
    rod = scene.target
    assert isinstance(rod, Rod)
    return rod.length / speed(scene)


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The rod of a scene at first touch, in SI units; displacements count along the motion."""
    rod, material = scene.target, scene.geometry.material
    assert isinstance(rod, Rod)
    mesh = meshes.rod(elements(scene, numerics))
    dofs, size = mesh.t.T, mesh.p.shape[1]
    length = rod.length / len(dofs)
    density, modulus = material.density or 0.0, material.uniaxial_modulus()
    of_element = density * rod.area * length / 6 * np.array([[2.0, 1.0], [1.0, 2.0]])
    springs = rod.area / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = np.setdiff1d(np.arange(size), mesh.boundaries["end"] if rod.end == "fixed" else [])
    mass = MASSES.get(numerics.mass).of(np.tile(of_element, (len(dofs), 1, 1)), dofs, size, np.array([0]))
    stiffness = scatter(np.tile(springs, (len(dofs), 1, 1)), dofs, size).tocsc()
    own = WaveSide(
        mass=mass[free][:, free],
        parts=(Part(stiffness[free][:, free], modulus),),
        dashpots=_dashpot(rod.impedance(modulus.glassy, density), free.size) if rod.end == "absorbing" else None,
        push=sparse.csc_matrix(([1.0], ([0], [0])), shape=(free.size, 1)),
        trace=np.ones((1, 1)),
        axial=np.zeros(free.size),
    )
    push = sparse.vstack([own.push, sparse.csc_matrix([[-1.0]])]).tocsc()
    pressing = Pressing(push, own.trace, weights=np.ones(1), clearance=np.zeros(1))
    return Moving(with_rigid(scene, own, pressing), scene.velocity, np.zeros(1), endless=False)


def _dashpot(impedance: float, size: int) -> sparse.csc_matrix:
    """On the last of so many nodes, all the rod that goes on behind it."""
    return sparse.csc_matrix(([impedance], ([size - 1], [size - 1])), shape=(size, size))


MEMBER = WaveTarget(check=check, plan=plan, cost=cost, way=way)
