"""Far radius over wave travel: a sphere on an elastic half-space with waves, with dashpots at the far end or without.

Pressure waves that come back within the contact change what it loses; a mesh that ends half their travel away, where
they return with the separation, needs no dashpot at all.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import product

import numpy as np

from fe_contact.assembly.absorbing import wave_speeds
from fe_contact.dynamics.march import Motion
from fe_contact.settings import WaveNumerics
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from fe_contact.waves.half_space_body import moving
from fe_contact.waves.impact import motion
from fe_contact.waves.plan import TRAVEL, plan
from lumped import Scene
from lumped.schema import Table

CHART = Chart(
    rows=("dashpots",),
    columns=("share",),
    measures={"loss": Measure("error of the energy lost", 0.01), "force": Measure("error of the peak force", 1e-3)},
)
SCENE, NU = "polymer-sphere-waves", 0.45
COARSE = {"elements_per_contact": 4.0, "steps": 120}
FAR = 4.0  # travels: where a far end is too far to be felt


def cases(quick: bool) -> list[Case]:
    """Shares of the travel; the default's is among them."""
    shares = (0.1, TRAVEL) if quick else (0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, TRAVEL, 0.7, 1.0, 2.0)
    return [{"dashpots": dashpots, "share": share} for dashpots, share in product((True, False), shares)]


def measure(case: Case) -> Table:
    """Relative errors against a far end that no wave comes back from, on the same fine mesh."""
    found, far = struck(case["share"], case["dashpots"]), struck(FAR, True)
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
def struck(share: float, dashpots: bool) -> Motion:
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
    scene = Scene.load(SCENE, {"target.material": table})
    numerics = plan(scene, COARSE).numerics
    assert isinstance(numerics, WaveNumerics)
    fastest = wave_speeds(NU)[0] * np.sqrt(scene.contact_modulus.glassy / (scene.geometry.material.density or 1.0))
    travel = TRAVEL * float(fastest) * numerics.contact_time / numerics.contact_radius
    return scene, replace(numerics, far_radius=travel)


MEMBER = MethodStudy(
    "Far radius over the travel of a pressure wave in a contact: what the half-space takes away", cases, measure, CHART
)
