"""Locking: a thin bonded layer, nearly incompressible, by elements of every order, against its integral equation.

Linear triangles cannot keep their volume and bend: their force grows with the bulk modulus, 1/(1 - 2 nu), where the
layer's stays finite.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from fe_contact.budget.plan import DEFAULTS
from fe_contact.indentation import press, settings
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from lumped.scene.indenter import Indenter
from lumped.schema import Table

CHART = Chart(
    rows=("order", "elements"), columns=("nu",), measures={"error": Measure("error of the force, worst of four", 1e-3)}
)
LAYER = "polymer-layer"
DEPTHS = np.array([1.0, 1.37, 1.9, 2.6]) * 1e-4  # m: contacts end anywhere in an element, at 0.4 to 0.8 thicknesses


def cases(quick: bool) -> list[Case]:
    """Every order on the default's mesh, and order one on a mesh as rich as the default's; the last nu is 0.4999."""
    ratios = (0.3, 0.499, 0.4999) if quick else (0.0, 0.3, 0.45, 0.49, 0.495, 0.499, 0.4995, 0.4999)
    ways = [(1, 4.0), (1, 16.0), (DEFAULTS["order"], 4.0)] if quick else [(1, 4.0), (1, 16.0), (2, 4.0), (3, 4.0)]
    ways += [] if quick else [(DEFAULTS["order"], 4.0)]
    return [{"order": order, "elements": elements, "nu": nu} for (order, elements), nu in product(ways, ratios)]


def measure(case: Case) -> Table:
    """Largest error of the force; raises IndentationNotSettled."""
    indenter = Indenter.load(LAYER, {"target.material.nu": case["nu"]}).elastic(instant=False)
    curve = indenter.target.load_curve(indenter.profile, case["nu"])
    numerics = settings({"order": case["order"], "elements_per_contact": case["elements"]}, indenter.shape)
    found = press(indenter, DEPTHS, curve.contact_radius(DEPTHS), numerics)
    error = found.force / curve.force(DEPTHS) - 1.0
    return {"error": float(error[np.abs(error).argmax()]), **found.work}


MEMBER = MethodStudy(
    "Locking: force on a thin bonded layer by the order of the elements, over Poisson's ratio", cases, measure, CHART
)
