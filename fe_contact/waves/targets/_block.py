"""A block with inertia on a rigid plane: a bar of line elements, each of which a wave crosses in one step.

Depth and velocity are those of the centre of mass of block and rigid mass, which the force moves.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from fe_contact.bodies.bar import TIP, Bar, falling, pitch
from fe_contact.budget.plan import Plan
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.march import Choices, march
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced
from fe_contact.progress import Counted, Progress, uncounted
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.impact import account, account_before
from fe_contact.waves.line import LINE, Doubling, Run, witness
from fe_contact.waves.line_reading import DEPTH, Ending, read_bar
from fe_contact.waves.plan import Cost
from fe_contact.waves.targets.base import WaveTarget
from lumped.errors import BadInput, Fault
from lumped.result.model_ledger import Peak, gravity
from lumped.result.result import LedgerEntry
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.shapes._block import Block

DEFAULT_TOLERANCE = 3e-3  # default: relative, of every certified quantity of a bar: looser than of a rod
STEPS, MANY, MOST = 200, 1600, 12_800  # while a wave goes to the far end and back: at first, and at all
LIGHT = 32.0  # of them in the part of the bar that is as heavy as the mass behind it
# The fewest of them in which that mass is slowed to 1/e, and the most of which so few may be: its echo trebles the
# force for no longer, and whatever steps pass over it agree that there is none.
SLOWED, MOST_SLOWED = 3, 6400
USUAL: Table = {"enforcement": "exact", "scheme": "staged"}
PAUSE = 0.25  # of that time within which several contacts count as one


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; a sudden force or the energy of many contacts is kept."""
    bar, echo = bar_of(scene), echo_time(scene)
    numerics = WaveNumerics(
        tolerance=DEFAULT_TOLERANCE,
        **LINE,
        **USUAL,
        steps=_steps(bar),
        far_radius=bar.length / _block(scene).fixed_radius,
        contact_radius=_block(scene).fixed_radius,
        contact_time=echo,
        mass=usual_mass(scene),
    ).varied(**given)
    _check_mass(scene, bar, numerics)
    return Plan(numerics, frozenset(given) - {"tolerance"}, _ledger(scene, bar))


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings."""
    return Cost.of(_elements(numerics), numerics, scene.motion.impacts)


def way(scene: Scene, chosen: Plan, progress: Progress) -> Doubling:
    """Marched with steps and elements together."""
    return Doubling(scene, chosen, partial(run, scene), partial(_varied, scene), MOST, False, progress)


def check(scene: Scene) -> None:
    """Raise BadInput where waves in the block are not one-dimensional, or have no speed."""
    bar_of(scene)


def _steps(bar: Bar) -> int:
    """So many at first that the echo of a light mass, which is no longer than its share of the bar's, is resolved."""
    echo = LIGHT / _share(bar) if bar.end_mass else 0.0
    return 4 * math.ceil(max(min(max(STEPS, echo), MANY), min(_fewest(bar), MOST_SLOWED)) / 4)


def _share(bar: Bar) -> float:
    """Of the mass behind a bar, over the bar's own: 2 m/Z over the time of an echo."""
    return bar.end_mass / (bar.density * bar.area * bar.length)


def _fewest(bar: Bar) -> float:
    """Steps in an echo of which enough slow the mass behind the bar."""
    return 2.0 * SLOWED / _share(bar) if bar.end_mass else 0.0


def _check_mass(scene: Scene, bar: Bar, numerics: WaveNumerics) -> None:
    """Raise BadInput where steps pass over the echo of a mass behind the bar."""
    fewest = _fewest(bar)
    if numerics.steps >= fewest:
        return
    if fewest <= MOST_SLOWED:
        reason = (
            f"{numerics.steps} pass over the echo of striker.mass; accepted: from {math.ceil(fewest)}, or none given"
        )
        raise BadInput(Fault(scene.source, "numerics.steps", reason))
    least = 2.0 * SLOWED / MOST_SLOWED * bar.end_mass / _share(bar)
    reason = (
        f"{bar.end_mass:g}: so light behind the block that steps pass over its echo; accepted: 0, or from {least:.3g}"
    )
    raise BadInput(Fault(scene.source, "striker.mass", reason))


def _elements(numerics: WaveNumerics) -> int:
    """Along the bar: a wave there and back crosses every one twice, each time in a step."""
    return numerics.steps // 2


def usual_mass(scene: Scene) -> str:
    """One contact ends with the march: mass at its nodes carries its jumps exactly. More of them need a surface
    without mass, or each would cost the energy of the mass that it stops.
    """
    return "lumped" if scene.motion.impacts == 1 else "redistributed"


def usual_tip(scene: Scene) -> float:
    """Length of the element at the contact over the others', as the usual mass asks for."""
    return 1.0 if scene.motion.impacts == 1 else TIP


def _varied(scene: Scene, numerics: WaveNumerics) -> dict[str, WaveNumerics]:
    """Settings with one cause of error changed: steps and elements together; what another method than ours errs by."""
    half = numerics.varied(steps=numerics.steps // 2)
    return {"time_step": half, **witness(numerics, USUAL | {"mass": usual_mass(scene)})}


def bar_of(scene: Scene) -> Bar:
    """The bar that the block is; raises BadInput where waves in it are not one-dimensional, or have no speed."""
    block, material, faults = _block(scene), scene.geometry.material, []
    if not block.uniform:
        reason = "bonded: waves between free sides and held faces are not one-dimensional; accepted: sliding"
        faults.append(Fault(scene.source, "striker.faces", reason))
    modulus = block.modulus(material)
    if modulus.viscosity > 0.0:
        reason = "a dashpot in parallel has no wave speed for steps to follow; accepted: a material without one"
        faults.append(Fault(scene.source, "striker.material.law", reason))
    if faults:
        raise BadInput(faults)
    return Bar(block.thickness, block.area, material.density or 0.0, modulus, scene.reduced_mass)


def echo_time(scene: Scene) -> float:
    """2 L/c of the fastest waves, s."""
    bar = bar_of(scene)
    return 2.0 * bar.length * math.sqrt(bar.density / bar.relaxation.glassy)


def run(scene: Scene, numerics: WaveNumerics, counted: Counted = uncounted) -> Run:
    """One march, its steps, ``counted``, those in which a wave crosses an element. Raises NotReached."""
    bar, echo = bar_of(scene), echo_time(scene)
    elements = _elements(numerics)
    tip = usual_tip(scene)
    body = falling(bar, elements, MASSES.get(numerics.mass), scene.gravity, tip=tip)
    size = pitch(bar.length, elements, tip)
    choices = Choices(
        scheme=WAVE_SCHEMES.get(numerics.scheme).of(numerics.rho),
        enforced=Enforced(ENFORCEMENTS.get(numerics.enforcement), numerics.penalty * bar.relaxation.glassy / size),
        step=0.5 * echo * size / bar.length,
    )
    carried = np.asarray(body.inertia.sum(axis=0)).ravel()
    watch = -carried[None, :] / carried.sum()
    pause = 0.0 if scene.motion.impacts == 1 else PAUSE * echo
    ending = Ending(scene.motion.impacts, pause)
    found = march(body, np.full(body.size, -scene.velocity), choices, scene.end_time, watch, ending, counted)
    followed = 2 * elements if choices.scheme.explicit and not body.massless.size else None
    first = bar.area * math.sqrt(bar.density * bar.relaxation.glassy) * scene.velocity
    reading, contacts = read_bar(found, carried.sum(), scene, pause, echo, followed, first)
    energy = account(found, carried.sum())  # stored: strain, and motion about the centre of mass
    if reading.separated:
        fallen = float(found.samples[-1].displacement[0] - reading.rows[DEPTH, -1])
        energy = account_before(energy, fallen, carried.sum() * scene.gravity)
    return Run(reading, energy, len(found.samples) - 1, body.size, contacts)


def _block(scene: Scene) -> Block:
    block = scene.geometry.shape
    assert isinstance(block, Block)
    return block


def _ledger(scene: Scene, bar: Bar) -> tuple[LedgerEntry, ...]:
    """What one-dimensional small waves leave out, relative to the peak force."""
    speed = math.sqrt(bar.relaxation.glassy / bar.density)
    slim = scene.geometry.material.nu * _block(scene).fixed_radius / bar.length
    sideways = 0.0 if _block(scene).sides == "confined" else slim**2
    slow = scene.profile.hertz_impact(bar.relaxation.glassy, scene.swinging_mass, scene.velocity).force
    force = max(speed * bar.density * bar.area * scene.velocity, slow)
    strain = scene.velocity / speed
    return (
        LedgerEntry("inertia of the striker", "included", 0.0),
        LedgerEntry("lateral inertia", "neglected", sideways, "(nu radius/length)^2, Rayleigh; but at wave fronts"),
        LedgerEntry("finite strain", "small displacements", None, "v/c of either sign", spread=(-strain, strain)),
        gravity(scene, scene.model, Peak(force, 0.0, 0.0, 0.0), bar.density * bar.area * bar.length + bar.end_mass),
    )


BLOCK = WaveTarget(check=check, plan=plan, cost=cost, way=way)
