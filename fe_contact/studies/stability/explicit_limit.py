"""Central difference with a penalty: the step that a linear bar allows, all contact closed, and the one that holds.

dt = 2/omega_max with the penalty's spring always there is no limit for contact that opens and closes: every closing
with an overlap already there may add energy. The share of it that holds is measured.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from scipy.linalg import eigh

from fe_contact.bodies.bar import falling
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.studies.stability._bar import BAR, ENERGY, GRAVITY, SPEED, bounced
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from lumped.schema import Table

GAPS = (0.0, 0.0137, 0.0291, 0.0613)  # m: touches at several moments of a step
CHART = Chart(
    rows=("mass", "penalty"), columns=("share",), measures={"gain": Measure("energy gain, worst of four gaps", 0.01)}
)


def cases(quick: bool) -> list[Case]:
    """Penalties over three decades, shares of the linear limit up to a little beyond it."""
    penalties = (1.0, 10.0) if quick else (0.1, 1.0, 3.0, 10.0, 30.0, 100.0)
    shares = (0.4, 0.9, 1.05) if quick else (0.1, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.98, 1.05)
    every = product(("lumped", "redistributed"), penalties, shares)
    return [{"mass": m, "penalty": p, "share": s, "elements": 20 if quick else 40, "periods": 1} for m, p, s in every]


def measure(case: Case) -> Table:
    """Largest energy gain over the energy at the start, the worst of some gaps; raises MotionUnbounded."""
    size = BAR.length / case["elements"]
    step = case["share"] * linear_limit(case["mass"], case["penalty"], case["elements"])
    fixed = {
        "scheme": "central_difference",
        "rho": 1.0,
        "tip": 1.0,
        "enforcement": "penalty",
        "cfl": step * SPEED / size,
    }
    motions = [bounced({**case, **fixed}, gap) for gap in GAPS]
    gains = [max(s.energies.total - s.energies.work for s in motion.samples) / ENERGY for motion in motions]
    return {"gain": max(gains), "cfl": fixed["cfl"], "steps": sum(len(motion.samples) - 1 for motion in motions)}


def linear_limit(mass: str, penalty: float, elements: int) -> float:
    """2/omega_max of the bar with its contact closed, s; a surface without mass condensed."""
    body = falling(BAR, elements, MASSES.get(mass), GRAVITY)
    stiffness = 900.0 * body.parts[0].stiffness.toarray()
    stiffness[0, 0] += penalty * 900.0 / (BAR.length / elements)
    heavy, light = body.massive, body.massless
    inside = stiffness[np.ix_(heavy, heavy)]
    if light.size:
        across = stiffness[np.ix_(heavy, light)]
        inside = inside - across @ np.linalg.solve(stiffness[np.ix_(light, light)], across.T)
    fastest = eigh(inside, body.inertia.toarray()[np.ix_(heavy, heavy)], eigvals_only=True)[-1]
    return float(2.0 / np.sqrt(fastest))


MEMBER = MethodStudy("Central difference with a penalty: share of 2/omega_max that holds", cases, measure, CHART)
