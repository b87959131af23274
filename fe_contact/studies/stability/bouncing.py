"""The bouncing bar over every scheme, mass, enforcement, penalty and time step, for two periods."""

from __future__ import annotations

from itertools import product

from fe_contact.bodies.bar import TIP
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.studies.stability._bar import DEFAULT, measured
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from lumped.schema import Table

RHO = 0.8
SOFT = [name for name in ENFORCEMENTS.names if ENFORCEMENTS.get(name).soft]
CHART = Chart(
    rows=("scheme", "mass", "tip"),
    columns=("cfl", "enforcement", "penalty"),
    measures={
        "drift": Measure("energy drift", 1e-3),
        "ripple": Measure("ripple of the plateau", 0.02),
        "overshoot": Measure("overshoot of the first force", 0.02),
        "penetration": Measure("penetration over v L/c", 1e-3),
        "duration_steps": Measure("duration, steps", 1.0),
        "restitution": Measure("error of two contacts' impulse, m v", 0.01),
        "start": Measure("start of the tenth or last contact, periods", 0.01),
    },
)


def cases(quick: bool) -> list[Case]:
    """Quick: fewer elements, one penalty, two steps."""
    steps, penalties, elements = ((1.0, 2.0), (1.0,), 20) if quick else ((0.5, 1.0, 2.0), (0.1, 1.0, 10.0), 60)
    ways = [(name, penalty) for name in ENFORCEMENTS.names for penalty in (penalties if name in SOFT else (1.0,))]
    bodies = [*((name, 1.0) for name in MASSES.names), (DEFAULT["mass"], TIP)]
    every = product(WAVE_SCHEMES.names, bodies, ways, steps)
    return [
        {"scheme": scheme, "rho": RHO, "mass": mass, "tip": tip, "enforcement": enforcement, "penalty": penalty}
        | {"cfl": cfl, "elements": elements, "periods": 2}
        for scheme, (mass, tip), (enforcement, penalty), cfl in every
    ]


def measure(case: Case) -> Table:
    """Errors against the exact motion; raises MotionUnbounded or ContactNotSettled."""
    return measured(case)


MEMBER = MethodStudy("Bouncing bar, two periods: every scheme, mass and enforcement", cases, measure, CHART)
