"""Relaxation time over time step: an impact on a standard linear solid by every scheme, against the row of springs.

Branches are integrated exactly, so that no ratio is stiff; what is left is the order of the scheme.
"""

from __future__ import annotations

from itertools import product

from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import plan
from fe_contact.march.impact import march
from fe_contact.schemes.base import SCHEMES
from fe_contact.steppers.march import Strike
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from fe_contact.targets.base import struck
from lumped import Scene, laws, simulate
from lumped.schema import Table

CHART = Chart(
    rows=("scheme", "steps"),
    columns=("ratio",),
    measures={
        "force": Measure("error of the peak force", 5e-3),
        "duration": Measure("error of the duration", 5e-3),
        "restitution": Measure("error of the restitution", 5e-3),
    },
)
SCENE = "polymer-sphere"
PRECISE = 1e-6  # of the row of springs
RELAXED, FADING = 1e6, 2e6  # Pa


def cases(quick: bool) -> list[Case]:
    """Steps along the contact, and relaxation times from a hundredth of a step to a thousand."""
    steps = (40,) if quick else (20, 40, 80, 160)
    ratios = (0.01, 1.0, 100.0) if quick else (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0)
    every = product(SCHEMES.names, steps, ratios)
    return [{"scheme": scheme, "steps": count, "ratio": ratio} for scheme, count, ratio in every]


def measure(case: Case) -> Table:
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


MEMBER = MethodStudy(
    "Relaxation time over time step: one march of a sphere on a standard linear solid", cases, measure, CHART
)
