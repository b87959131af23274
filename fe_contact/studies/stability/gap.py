"""Gaps down to rounding: the bouncing bar let fall from a gap, so that it touches at any moment of a step.

An explicit constraint on a surface with mass keeps the next overlap closed: it presses up to a step before the touch.
A surface without mass finds the touch within the step.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from fe_contact.studies.stability._bar import (
    BAR,
    DEFAULT,
    ENERGY,
    GRAVITY,
    IMPEDANCE,
    SPEED,
    TRANSIT,
    VELOCITY,
    bounced,
    choices,
)
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from lumped.schema import Table
from lumped.solvers.bar import StraightBar, bounces

CHART = Chart(
    rows=("scheme", "mass", "tip", "enforcement"),
    columns=("gap",),
    measures={
        "touch": Measure("error of the first touch, steps", 0.02),
        "duration_steps": Measure("duration, steps", 1.0),
        "impulse": Measure("error of the impulse", 0.01),
        "gain": Measure("energy gain", 0.02),
    },
)
WAYS = (
    {**DEFAULT, "scheme": "central_difference", "mass": "lumped", "tip": 1.0},
    {**DEFAULT, "scheme": "trapezoidal", "mass": "consistent", "tip": 1.0},
    {**DEFAULT, "scheme": "trapezoidal", "tip": 1.0},
    {**DEFAULT, "enforcement": "penalty", "penalty": 10.0},
    DEFAULT,
)
PERIODS = 0.2  # the first contact and a free flight after it


def cases(quick: bool) -> list[Case]:
    """Gaps from a rounding to a tenth of the bar; the bar falls 56 mm in a step."""
    gaps = [0.0, 1e-12, 0.004, 0.025]
    if not quick:
        gaps = [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, *np.linspace(0.004, 0.054, 11).tolist(), 0.3, 1.0]
    fixed = {"cfl": 1.0, "elements": 60, "periods": PERIODS}
    return [{**way, **fixed, "gap": gap} for way, gap in product(WAYS, gaps)]


def measure(case: Case) -> Table:
    """Errors of the first contact against the exact waves; raises MotionUnbounded or ContactNotSettled."""
    gap, step = case["gap"], choices(case).step
    exact = bounces(StraightBar(BAR.length, SPEED, IMPEDANCE), VELOCITY, GRAVITY, gap, 3.0 * TRANSIT)
    begun, ended = exact.contacts[0]
    motion = bounced({**case, "periods": case["periods"] + gap}, gap)
    start, end = motion.contacts[0]
    given = exact.momentum(ended) - exact.momentum(0.0) + BAR.density * BAR.area * BAR.length * GRAVITY * ended
    impulse = sum(sample.impulse for sample in motion.samples if sample.time < ended + 0.5 * TRANSIT)
    kept = [sample.energies.total - sample.energies.work for sample in motion.samples]
    return {
        "touch": (start - begun) / step,
        "duration_steps": (end - start - ended + begun) / step,
        "impulse": impulse / given - 1.0,
        "gain": max(kept) / ENERGY,
        "contacts": len(motion.contacts),
        "steps": len(motion.samples) - 1,
        "iterations": sum(sample.iterations for sample in motion.samples),
    }


MEMBER = MethodStudy(
    "Gap before the first touch, m: what a moment within a step changes in one contact", cases, measure, CHART
)
