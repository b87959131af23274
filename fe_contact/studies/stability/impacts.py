"""Impacts against exact answers: relaxation times far from a step, exits with tension, far ends that waves feel.

Branches are integrated exactly, so that no ratio of relaxation time to step is stiff; what is left is the order of the
scheme. Contact that cannot pull ends when the force does, by finite elements as in Kelvin's law; ended at depth zero, a
force of 2 xi omega m v would have pulled, and the restitution is less by the work of it. Pressure waves that come back
within the contact change what it loses; a mesh that ends half their travel away, where they return with the separation,
needs no dashpot at all.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from itertools import product

import numpy as np

import fe_contact
from fe_contact.assembly.far_field import wave_speeds
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import plan
from fe_contact.dynamics.march import Motion
from fe_contact.march.impact import march
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import WaveNumerics
from fe_contact.steppers.steps import Strike
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from fe_contact.targets.base import struck
from fe_contact.waves.impact import motion
from fe_contact.waves.plan import TRAVEL
from fe_contact.waves.targets.half_space import moving
from fe_contact.waves.targets.half_space import plan as plan_waves
from lumped import Scene, laws, simulate
from lumped.restitution import kelvin
from lumped.schema import Table

SCENE = "polymer-sphere"
PRECISE = 1e-6  # of the row of springs and of Kelvin's law
RELAXED, FADING = 1e6, 2e6  # Pa


def relaxation_cases(quick: bool) -> list[Case]:
    """Steps along the contact, and relaxation times from a hundredth of a step to a thousand."""
    steps = (40,) if quick else (20, 40, 80, 160)
    ratios = (0.01, 1.0, 100.0) if quick else (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0)
    every = product(SCHEMES.names, steps, ratios)
    return [{"scheme": scheme, "steps": count, "ratio": ratio} for scheme, count, ratio in every]


def relaxation_measure(case: Case) -> Table:
    """Relative errors; raises the named failures of a march."""
    scene = relaxing(case["ratio"] / case["steps"])
    numerics = plan(scene, {"steps": case["steps"], "scheme": case["scheme"]}).numerics
    strike = Strike.of(scene)
    found = march(strike, struck(scene.geometry, numerics), numerics)
    exact = simulate(laws.mdr.of(scene), scene, PRECISE).quantities
    value = Curve.of(found, strike).quantities
    names = {"force": "peak_force", "duration": "duration", "restitution": "restitution"}
    errors = {short: (value[name] or 0.0) / (exact[name].value or 1.0) - 1.0 for short, name in names.items()}
    return {**errors, "contact_problems": found.work.contact_problems, "iterations": found.work.iterations}


def relaxing(share: float) -> Scene:
    """The sphere on a solid whose relaxation time is this share of its elastic contact time."""
    table = {"law": "prony", "E_inf": RELAXED, "E": [FADING], "tau": [1.0], "nu": 0.3}
    contact_time = Scene.load(SCENE, {"target.material": table}).elastic_contact_time
    return Scene.load(SCENE, {"target.material": {**table, "tau": [share * contact_time]}})


RELAXATION = MethodStudy(
    "Relaxation time over time step: one march of a sphere on a standard linear solid",
    relaxation_cases,
    relaxation_measure,
    Chart(
        rows=("scheme", "steps"),
        columns=("ratio",),
        measures={
            "force": Measure("error of the peak force", 5e-3),
            "duration": Measure("error of the duration", 5e-3),
            "restitution": Measure("error of the restitution", 5e-3),
        },
    ),
)


MASS, VELOCITY, STIFFNESS = 0.05, 0.1, 1e4  # physics: of the striker, kg and m/s; of the spring, N/m
HEIGHT, AREA = 0.02, 4e-4  # m, m2: of the packaged block
WAYS = ("finite elements", "force", "depth")


def tension_cases(quick: bool) -> list[Case]:
    """Shares of critical damping."""
    dampings = (0.1, 0.6) if quick else (0.01, 0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 0.99)
    return [{"way": way, "xi": xi} for way, xi in product(WAYS, dampings)]


def tension_measure(case: Case) -> Table:
    """Tension, and the restitution's distance from exp(-2 xi arccos(xi)/sqrt(1 - xi^2))."""
    xi = case["xi"]
    if case["way"] == WAYS[0]:
        result = fe_contact.run(block(xi), tolerance=1e-3)
    else:
        scene = oscillator(xi, case["way"])
        result = simulate(laws.kelvin.of(scene), scene, PRECISE)
    force, value = result.history.force, result.quantities["restitution"].value
    error = (value or 0.0) - kelvin.restitution(xi)
    return {"tension": max(0.0, -float(force.min())) / float(force.max()), "restitution": error}


def block(xi: float) -> Scene:
    """The packaged block, of Kelvin's solid."""
    dashpot = 2.0 * xi * math.sqrt(STIFFNESS * MASS)
    table = {"law": "kelvin_voigt", "E": STIFFNESS * HEIGHT / AREA, "eta": dashpot * HEIGHT / AREA, "nu": 0.45}
    return Scene.load("polymer-prism", {"striker.material": table, "striker.mass": MASS, "striker.velocity": VELOCITY})


def oscillator(xi: float, way: str) -> Scene:
    """The same by Kelvin's law."""
    law = {"name": "kelvin", "k": STIFFNESS, "xi": xi, "exit": way}
    return Scene.from_dict({"name": "kelvin", "striker": {"mass": MASS, "velocity": VELOCITY}, "law": law})


TENSION = MethodStudy(
    "Exit with tension: Kelvin's solid by damping, contact ended by force or by depth",
    tension_cases,
    tension_measure,
    Chart(
        rows=("way",),
        columns=("xi",),
        measures={
            "tension": Measure("largest tension over the largest force", 1e-6),
            "restitution": Measure("error of the restitution of what cannot pull", 1e-3),
        },
    ),
)


WITH_WAVES, NU = "polymer-sphere-waves", 0.45  # the packaged scene, and Poisson's ratio given to it
COARSE = {"elements_per_contact": 4.0, "steps": 120}  # work: of the mesh and of the march
FAR = 4.0  # travels: where a far end is too far to be felt


def far_radius_cases(quick: bool) -> list[Case]:
    """Shares of the travel; the default's is among them."""
    shares = (0.1, TRAVEL) if quick else (0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, TRAVEL, 0.7, 1.0, 2.0)
    return [{"dashpots": dashpots, "share": share} for dashpots, share in product((True, False), shares)]


def far_radius_measure(case: Case) -> Table:
    """Relative errors against a far end that no wave comes back from, on the same fine mesh."""
    found, far = impact(case["share"], case["dashpots"]), impact(FAR, True)
    return {
        "loss": lost(found) / lost(far) - 1.0,
        "force": float(found.force.max() / far.force.max()) - 1.0,
        "radius": settled()[1].far_radius * case["share"] / TRAVEL,
        "steps": len(found.samples) - 1,
        "iterations": sum(sample.iterations for sample in found.samples),
    }


def lost(found: Motion) -> float:
    """Share of the striker's energy that it does not take along, 1 - e^2."""
    return 1.0 - (float(found.samples[-1].velocity[0]) / settled()[0].velocity) ** 2


@lru_cache(maxsize=2)
def impact(share: float, dashpots: bool) -> Motion:
    """The impact with the far end at a share of the travel."""
    scene, numerics = settled()
    body = moving(scene, replace(numerics, far_radius=numerics.far_radius * share / TRAVEL))
    if not dashpots:
        body = replace(body, body=replace(body.body, dashpots=None))
    return motion(body, scene, numerics)


@lru_cache(maxsize=1)
def settled() -> tuple[Scene, WaveNumerics]:
    """The scene, elastic, and its settings on a coarse mesh, the far radius at the plan's share of the travel."""
    table = {"law": "elastic", "E": 1.8e6, "nu": NU, "density": 1000.0}
    scene = Scene.load(WITH_WAVES, {"target.material": table})
    numerics = plan_waves(scene, COARSE).numerics
    assert isinstance(numerics, WaveNumerics)
    fastest = wave_speeds(NU)[0] * np.sqrt(scene.contact_modulus.glassy / (scene.geometry.material.density or 1.0))
    travel = TRAVEL * float(fastest) * numerics.contact_time / numerics.contact_radius
    return scene, replace(numerics, far_radius=travel)


FAR_RADIUS = MethodStudy(
    "Far radius over the travel of a pressure wave in a contact: what the half-space takes away",
    far_radius_cases,
    far_radius_measure,
    Chart(
        rows=("dashpots",),
        columns=("share",),
        measures={"loss": Measure("error of the energy lost", 0.01), "force": Measure("error of the peak force", 1e-3)},
    ),
)

MEMBER = {
    "far_radius": FAR_RADIUS,
    "relaxation": RELAXATION,
    "tension": TENSION,
}
