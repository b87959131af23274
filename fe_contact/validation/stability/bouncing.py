"""The bouncing bar over every scheme, mass, enforcement, penalty and time step, for two periods."""

from __future__ import annotations

from itertools import product
from typing import Any

from fe_contact.numerics import ENFORCEMENTS
from fe_contact.validation.stability._bar import MASSES, SCHEMES, measured
from fe_contact.validation.stability.base import Case, Chart, Measure
from lumped.members import available

TITLE = "Bouncing bar, two periods: every scheme, mass and enforcement"
RHO = 0.8
BY_PENALTY = ("penalty", "corrected")  # the others' answer does not depend on it
CHART = Chart(
    rows=("scheme", "mass"),
    columns=("cfl", "enforcement", "penalty"),
    measures={
        "drift": Measure("energy drift", 1e-3),
        "ripple": Measure("ripple of the plateau", 0.02),
        "overshoot": Measure("overshoot of the first force", 0.02),
        "penetration": Measure("penetration over v L/c", 1e-3),
        "duration_steps": Measure("duration, steps", 1.0),
        "start": Measure("start of the tenth or last contact, periods", 0.01),
    },
)


def cases(quick: bool) -> list[Case]:
    """Quick: fewer elements, one penalty, two steps."""
    steps, penalties, elements = ((1.0, 2.0), (1.0,), 40) if quick else ((0.5, 0.9, 1.0, 2.0), (0.1, 1.0, 10.0), 100)
    ways = [
        (name, penalty) for name in available(ENFORCEMENTS) for penalty in (penalties if name in BY_PENALTY else (1.0,))
    ]
    every = product(available(SCHEMES), available(MASSES), ways, steps)
    return [_case(scheme, mass, *way, cfl, elements) for scheme, mass, way, cfl in every]


def _case(scheme: str, mass: str, enforcement: str, penalty: float, cfl: float, elements: int) -> dict[str, Any]:
    return {
        "scheme": scheme,
        "rho": RHO,
        "mass": mass,
        "enforcement": enforcement,
        "penalty": penalty,
        "cfl": cfl,
        "elements": elements,
        "periods": 2,
    }


def measure(case: Case) -> dict[str, Any]:
    """Errors against the exact motion; raises MotionUnbounded or ContactNotSettled."""
    return measured(case)
