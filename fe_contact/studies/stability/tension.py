"""Exit with tension: a block of Kelvin's solid, which a dashpot holds back if its contact ends with the depth.

Contact that cannot pull ends when the force does, by finite elements as in Kelvin's law; ended at depth zero, a force
of 2 xi omega m v would have pulled, and the restitution is less by the work of it.
"""

from __future__ import annotations

import math
from itertools import product

import fe_contact
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from lumped import Scene, laws, simulate
from lumped.restitution import kelvin
from lumped.schema import Table

CHART = Chart(
    rows=("way",),
    columns=("xi",),
    measures={
        "tension": Measure("largest tension over the largest force", 1e-6),
        "restitution": Measure("error of the restitution of what cannot pull", 1e-3),
    },
)
MASS, VELOCITY, STIFFNESS = 0.05, 0.1, 1e4
HEIGHT, AREA = 0.02, 4e-4  # m, m2: of the packaged block
WAYS = ("finite elements", "force", "depth")
PRECISE = 1e-6


def cases(quick: bool) -> list[Case]:
    """Shares of critical damping."""
    dampings = (0.1, 0.6) if quick else (0.01, 0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 0.99)
    return [{"way": way, "xi": xi} for way, xi in product(WAYS, dampings)]


def measure(case: Case) -> Table:
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


MEMBER = MethodStudy(
    "Exit with tension: Kelvin's solid by damping, contact ended by force or by depth", cases, measure, CHART
)
