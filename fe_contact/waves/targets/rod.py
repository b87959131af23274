"""The rod: waves that come back, forces that jump; steps and elements go together, a wave crosses one in each."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_contact.dynamics.march import Choices, march
from fe_contact.dynamics.pressed import Enforced
from fe_contact.numerics import ENFORCEMENTS, RANGES, WAVE_SCHEMES
from fe_contact.plan import Plan
from fe_contact.progress import Progress, silent
from fe_contact.targets.rod import elements, moving, speed
from fe_contact.waves.dent import Dent
from fe_contact.waves.impact import energies, left
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.rod_reading import read
from fe_contact.waves.rod_record import Run, bars, result_of
from lumped.errors import BadInput, Fault
from lumped.members import get
from lumped.model_ledger import Peak, model_ledger
from lumped.result import Result, meets
from lumped.scene import Scene
from lumped.targets.rod import Rod

DEFAULT_TOLERANCE = 1e-3
STEPS = 400  # along the contact time of the scene, at the default tolerance
FEWEST, MOST = 48, 20_000  # elements
ROUNDS = 3  # refinements before giving up


def plan(scene: Scene, given: Mapping[str, Any]) -> Plan:
    """Choose what ``given`` (checked settings) leaves open."""
    check(scene)
    rod = scene.target
    assert isinstance(rod, Rod)
    tolerance = float(given.get("tolerance", DEFAULT_TOLERANCE))
    contact_time, radius = scene.elastic_contact_time, float(np.sqrt(rod.area / np.pi))
    flat = scene.profile.fixed_radius is not None
    coarse = WaveNumerics(
        tolerance=tolerance,
        elements_per_contact=1.0,
        order=1,
        penalty=1.0,
        enforcement="exact",
        scheme="central_difference",
        steps=int(min(STEPS * max(1.0, (DEFAULT_TOLERANCE / tolerance) ** 0.5), RANGES["steps"][1])),
        far_radius=rod.length / radius,
        contact_radius=radius,
        contact_time=contact_time,
        peak_share=0.5,
        rho=1.0,
        mass="lumped" if flat else "redistributed",
    ).varied(**given)
    assert isinstance(coarse, WaveNumerics)
    more = max(FEWEST / elements(scene, coarse), 1.0)
    settings = coarse if "steps" in given else coarse.varied(steps=math.ceil(coarse.steps * more))
    shape = scene.profile.hertz_impact(scene.contact_modulus.glassy, scene.reduced_mass, scene.velocity)
    scales = Peak(shape.force, shape.depth, shape.contact_radius, contact_time)
    return Plan(settings, frozenset(given) - {"tolerance"}, model_ledger(scene, scales))


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """Force history with error bars. Raises BadInput for a scene it is not for, NotReached where no march ends."""
    cpu, wall = time.process_time(), time.perf_counter()
    chosen = plan(scene, given)
    numerics, runs = chosen.numerics, list[Run]()
    for attempt in range(ROUNDS + 1):
        assert isinstance(numerics, WaveNumerics)
        progress(f"{elements(scene, numerics)} elements along the rod")
        half = numerics.varied(steps=max(numerics.steps // 2, 4))
        assert isinstance(half, WaveNumerics)
        fine, coarse = run(scene, numerics), run(scene, half)
        runs += [fine, coarse]
        quantities = bars(fine.reading, coarse.reading)
        finer = numerics.varied(steps=2 * numerics.steps)
        assert isinstance(finer, WaveNumerics)
        stuck = "steps" in chosen.pinned or attempt == ROUNDS or elements(scene, finer) > MOST
        if stuck or meets(quantities, numerics.tolerance):
            break
        numerics = finer
    timing = {"cpu_s": time.process_time() - cpu, "wall_s": time.perf_counter() - wall}
    return result_of(scene, chosen, numerics, fine, coarse, quantities, timing, runs)


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, and for materials whose waves these elements or their end do not carry."""
    scene.check_single("fe")
    rod, material = scene.target, scene.geometry.material
    assert isinstance(rod, Rod)
    reason = ""
    if material.young.viscosity > 0.0:
        reason = "a dashpot in parallel has no wave speed for steps to follow; accepted: a material without one"
    elif rod.end == "absorbing" and not material.young.is_elastic:
        reason = 'an absorbing end lets elastic waves out; accepted: elastic, or target.end = "fixed" or "free"'
    if reason:
        raise BadInput(Fault(scene.source, "target.material.law", reason))


def run(scene: Scene, numerics: WaveNumerics) -> Run:
    """One march, its steps those in which a wave crosses an element. Raises NotReached."""
    body = moving(scene, numerics)
    count = elements(scene, numerics)
    rod = scene.target
    assert isinstance(rod, Rod)
    step = rod.length / count / speed(scene)
    choices = Choices(get(WAVE_SCHEMES, numerics.scheme).of(numerics.rho), _enforced(scene, numerics), step)
    found = march(body.body, body.velocity, choices, scene.end_time, body.watch, left)
    reading = read(found, scene, count)
    return Run(reading, energies(body, found, scene), len(found.samples) - 1, body.body.size)


def _enforced(scene: Scene, numerics: WaveNumerics) -> Enforced:
    """A flat end keeps to the rod's; any other dents it first."""
    if scene.profile.fixed_radius is not None:
        return Enforced(get(ENFORCEMENTS, numerics.enforcement), numerics.penalty * scene.contact_modulus.glassy)
    return Enforced(Dent(scene.contact_modulus.glassy, scene.profile.load_curve), 1.0)
