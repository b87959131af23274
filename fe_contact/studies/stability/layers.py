"""A sphere pressed on a layer whose answer is exact: how stiff a penalty may be, and which elements lock.

A soft penalty lets the surfaces overlap by pressure / penalty; a stiff one drowns in rounding, which its share of the
stiffness multiplies, and pins a facet at more points than it has nodes. Linear triangles cannot keep their volume and
bend: their force on a thin bonded layer grows with the bulk modulus, 1/(1 - 2 nu), where the layer's stays finite.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import FixedStill
from fe_contact.budget.plan import DEFAULTS
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, ContactSolution, PressedSurface
from fe_contact.indentation import press, settings
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from fe_contact.targets.base import TARGETS
from lumped.load_curves.base import LoadCurve
from lumped.scene.indenter import Indenter
from lumped.schema import Table

LAYER, NU = "polymer-layer", 0.3  # the packaged scene, and Poisson's ratio given to it
DEPTHS = np.exp(np.random.default_rng(7).uniform(np.log(1e-4), np.log(2.5e-4), 8))  # m
INSIDE = 0.7  # of the contact radius


class PressedSample(NamedTuple):
    """The layer, its exact curve, and one mesh for all depths."""

    indenter: Indenter
    curve: LoadCurve
    body: FixedStill


def conditioning_cases(quick: bool) -> list[Case]:
    """Penalties over a dozen decades; enforcements that find their own are asked at a few."""
    few = (1e3,) if quick else (1e1, 1e3, 1e5)
    many = (1.0, 1e3, 1e9) if quick else (1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e11)
    every = [product((name,), many if ENFORCEMENTS.get(name).soft else few) for name in ENFORCEMENTS.names]
    return [{"enforcement": name, "penalty": penalty} for pairs in every for name, penalty in pairs]


def conditioning_measure(case: Case) -> Table:
    """Worst of some depths; contacts that do not settle are counted, and tell no force."""
    indenter, curve, body = layer()
    operator, surface = body.surface.operator, body.surface.pressed
    enforcement, biases, ripples, conditions, iterations = ENFORCEMENTS.get(case["enforcement"]), [], [], [], 0
    for depth, radius in zip(DEPTHS, curve.contact_radius(DEPTHS), strict=True):
        overlap = indenter.target.overlap(indenter.profile, body.stretch * operator.points, depth)
        problem = ContactProblem(surface, overlap, case["penalty"] * body.reference / radius)
        found: ContactSolution = enforcement.enforce(problem, overlap > 0.0)
        iterations += found.iterations
        conditions.append(condition(surface, problem.penalty, found))
        if found.converged:
            places, pressure = body.reference * operator.points, found.pressure / body.reference
            exact = curve.pressure(places, float(radius))
            inside = places < INSIDE * radius
            ripples.append(np.sqrt(np.mean((pressure - exact)[inside] ** 2)) / exact.max())
            biases.append(abs(operator.force(body.reference, found.pressure) / float(curve.force(depth)) - 1.0))
    told = {"bias": max(biases), "ripple": float(max(ripples))} if biases else {"bias": None, "ripple": None}
    return {**told, "condition": max(conditions), "unsettled": len(DEPTHS) - len(biases), "iterations": iterations}


def condition(surface: PressedSurface, penalty: float, found: ContactSolution) -> float:
    """Largest over smallest eigenvalue of the stiffness with the penalty's springs in it."""
    springs: Array = penalty * surface.weights * found.sets[-1]
    eigenvalues = np.linalg.eigvalsh(surface.held(springs))
    return float(eigenvalues[-1] / eigenvalues[0])


@lru_cache(maxsize=1)
def layer() -> PressedSample:
    """Made once a process."""
    indenter = Indenter.load(LAYER, {"target.material.nu": NU}).elastic(instant=False)
    curve = indenter.target.load_curve(indenter.profile, NU)
    numerics = settings({}, indenter.shape)
    body = TARGETS.get(indenter.target.name).still(indenter, curve.contact_radius(DEPTHS), numerics)
    assert isinstance(body, FixedStill)
    return PressedSample(indenter, curve, body)


CONDITIONING = MethodStudy(
    "Penalty, in units of modulus over contact radius, over conditioning",
    conditioning_cases,
    conditioning_measure,
    Chart(
        rows=("enforcement",),
        columns=("penalty",),
        measures={
            "bias": Measure("error of the force, worst of eight", 1e-3),
            "ripple": Measure("error of the pressure inside 0.7 a, RMS over the peak", 1e-3),
            "condition": Measure("condition of the contact's stiffness", 1e8),
            "unsettled": Measure("contacts not settled, of eight", 0.5),
        },
    ),
)


# m: contacts end anywhere in an element, at 0.4 to 0.8 thicknesses
LOCKED_DEPTHS = np.array([1.0, 1.37, 1.9, 2.6]) * 1e-4


def locking_cases(quick: bool) -> list[Case]:
    """Every order on the default's mesh, and order one on a mesh as rich as the default's; the last nu is 0.4999."""
    ratios = (0.3, 0.499, 0.4999) if quick else (0.0, 0.3, 0.45, 0.49, 0.495, 0.499, 0.4995, 0.4999)
    ways = [(1, 4.0), (1, 16.0), (DEFAULTS["order"], 4.0)] if quick else [(1, 4.0), (1, 16.0), (2, 4.0), (3, 4.0)]
    ways += [] if quick else [(DEFAULTS["order"], 4.0)]
    return [{"order": order, "elements": elements, "nu": nu} for (order, elements), nu in product(ways, ratios)]


def locking_measure(case: Case) -> Table:
    """Largest error of the force; raises IndentationNotSettled."""
    indenter = Indenter.load(LAYER, {"target.material.nu": case["nu"]}).elastic(instant=False)
    curve = indenter.target.load_curve(indenter.profile, case["nu"])
    numerics = settings({"order": case["order"], "elements_per_contact": case["elements"]}, indenter.shape)
    found = press(indenter, LOCKED_DEPTHS, curve.contact_radius(LOCKED_DEPTHS), numerics)
    error = found.force / curve.force(LOCKED_DEPTHS) - 1.0
    return {"error": float(error[np.abs(error).argmax()]), **found.work}


LOCKING = MethodStudy(
    "Locking: force on a thin bonded layer by the order of the elements, over Poisson's ratio",
    locking_cases,
    locking_measure,
    Chart(
        rows=("order", "elements"),
        columns=("nu",),
        measures={"error": Measure("error of the force, worst of four", 1e-3)},
    ),
)

MEMBER = {
    "conditioning": CONDITIONING,
    "locking": LOCKING,
}
