"""The bouncing bar of Doyen, Ern and Piperno 2011, doi:10.1137/100791440, by any choices, against its exact motion.

Four studies: every scheme over two periods, the schemes of the paper over ten, gaps down to rounding, and the steps
that central difference allows with a penalty.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import product

import numpy as np
from scipy.linalg import eigh

from fe_contact.assembly.forms import Array
from fe_contact.bodies.bar import TIP, Bar, falling, pitch
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.march import Choices, Motion, march
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced
from fe_contact.settings import Given
from fe_contact.studies.stability.base import Case, Chart, Measure, MethodStudy
from fe_contact.waves.line_reading import clustered
from lumped.materials import Relaxation
from lumped.schema import Table
from lumped.solvers.bar import Bounces, StraightBar, bounces

BAR = Bar(length=10.0, area=1.0, density=1.0, relaxation=Relaxation(900.0))
# Physics: of waves, m/s; of the bar, kg/s; at touch, m/s; m/s2.
SPEED, IMPEDANCE, VELOCITY, GRAVITY = 30.0, 30.0, 10.0, 10.0
TRANSIT = BAR.length / SPEED
PERIOD = 16 * TRANSIT  # two contacts of two transits each
TENTH = 10  # contact whose start is judged, or the last of fewer
MIDDLE = (0.1, 0.9)  # of a plateau, where its ripple is measured
DEFAULT: Given = {  # what ``fe-contact run bar`` takes
    "scheme": "staged",
    "rho": 1.0,
    "mass": "redistributed",
    "tip": TIP,
    "enforcement": "exact",
    "penalty": 1.0,
}
MEASURES = {
    "drift": Measure("energy drift", 1e-3),
    "ripple": Measure("ripple of the plateau", 0.02),
    "overshoot": Measure("overshoot of the first force", 0.02),
    "penetration": Measure("penetration over v L/c", 1e-3),
    "duration_steps": Measure("duration, steps", 1.0),
    "restitution": Measure("error of two contacts' impulse, m v", 0.01),
    "start": Measure("start of the tenth or last contact, periods", 0.01),
}
ENERGY = 0.5 * BAR.density * BAR.area * BAR.length * VELOCITY**2  # physics: of the bar at first touch, J


def choices(case: Case) -> Choices:
    """Scheme, enforcement and step; ``cfl`` is speed x step / element, ``penalty`` in units of modulus / element."""
    size = pitch(BAR.length, case["elements"], case["tip"])
    return Choices(
        scheme=WAVE_SCHEMES.get(case["scheme"]).of(case["rho"]),
        enforced=Enforced(ENFORCEMENTS.get(case["enforcement"]), case["penalty"] * 900.0 / size),
        step=case["cfl"] * size / SPEED,
    )


def bounced(case: Case, gap: float = 0.0, gravity: float = GRAVITY) -> Motion:
    """The bar's motion over some periods; raises the named failures of a march."""
    elements = case["elements"]
    body = falling(BAR, elements, MASSES.get(case["mass"]), gravity, gap, case["tip"])
    watch = np.full((1, elements + 1), 1.0 / (elements + 1))
    return march(body, np.full(elements + 1, -VELOCITY), choices(case), case["periods"] * PERIOD, watch)


@lru_cache(maxsize=8)
def exact(periods: float) -> Bounces:
    """The same motion by characteristics."""
    return bounces(StraightBar(BAR.length, SPEED, IMPEDANCE), VELOCITY, GRAVITY, 0.0, periods * PERIOD)


def measured(case: Case) -> Table:
    """What went wrong by how much; see :data:`MEASURES`; raises the named failures of a march."""
    motion, wanted = bounced(case), exact(case["periods"])
    time, force, step = motion.time, motion.force, choices(case).step
    begun = [start for start, _ in clustered(motion.contacts, 2 * TRANSIT)]
    due = [start for start, _ in wanted.contacts]
    touched, opened = motion.contacts[0]  # until it opens for the first time: chatter makes it short
    known = min(len(begun), len(due), TENTH) - 1
    pressed = wanted.force(np.minimum(time, 2 * TRANSIT * (1 - 1e-9)))
    inside = (time > MIDDLE[0] * 2 * TRANSIT) & (time < MIDDLE[1] * 2 * TRANSIT)
    trend, gain = _energies(motion)
    impulse = sum(sample.impulse for sample in motion.samples if sample.time <= 4 * TRANSIT)
    return {
        "drift": trend,
        "gain": gain,
        "ripple": float(np.sqrt(np.mean((force[inside] - pressed[inside]) ** 2)) / pressed[inside].mean()),
        "overshoot": float(force[time < 4 * TRANSIT].max() / pressed.max() - 1.0),
        "penetration": max(float(sample.overlap.max()) for sample in motion.samples) / (VELOCITY * TRANSIT),
        "duration_steps": (opened - touched - 2 * TRANSIT) / step,
        "start": (begun[known] - due[known]) / PERIOD if known > 0 else math.nan,  # the first is where all begin
        "restitution": (impulse - 800.0 / 3.0) / (BAR.length * VELOCITY),
        "contacts": len(motion.contacts) / len(due),
        "steps": len(motion.samples) - 1,
        "stages": motion.stages,
        "iterations": sum(sample.iterations for sample in motion.samples),
        "residual": max(abs(sample.energies.residual) for sample in motion.samples) / ENERGY,
    }


def _energies(motion: Motion) -> tuple[float, float]:
    """Change of the energy's mean from the first period to the last, and the largest gain, over that at the start."""
    kept: Array = np.array([s.energies.total - s.energies.work for s in motion.samples]) / ENERGY
    time = motion.time
    span = min(PERIOD, 0.5 * time[-1])
    return float(kept[time >= time[-1] - span].mean() - kept[time <= span].mean()), float(kept.max())


RHO = 0.8  # given to every scheme on trial: below 1 high frequencies are damped, where a scheme can
SOFT = [name for name in ENFORCEMENTS.names if ENFORCEMENTS.get(name).soft]


def bouncing_cases(quick: bool) -> list[Case]:
    """Quick: fewer elements, one penalty, two steps."""
    steps, penalties, elements = ((1.0, 2.0), (1.0,), 12) if quick else ((0.5, 1.0, 2.0), (0.1, 1.0, 10.0), 60)
    ways = [(name, penalty) for name in ENFORCEMENTS.names for penalty in (penalties if name in SOFT else (1.0,))]
    bodies = [*((name, 1.0) for name in MASSES.names), (DEFAULT["mass"], TIP)]
    every = product(WAVE_SCHEMES.names, bodies, ways, steps)
    return [
        {"scheme": scheme, "rho": RHO, "mass": mass, "tip": tip, "enforcement": enforcement, "penalty": penalty}
        | {"cfl": cfl, "elements": elements, "periods": 2}
        for scheme, (mass, tip), (enforcement, penalty), cfl in every
    ]


BOUNCING = MethodStudy(
    "Bouncing bar, two periods: every scheme, mass and enforcement",
    bouncing_cases,
    measured,
    Chart(rows=("scheme", "mass", "tip"), columns=("cfl", "enforcement", "penalty"), measures=MEASURES),
)

JUDGED = ("drift", "ripple", "duration_steps", "start")
ROWS = (
    ("trapezoidal", 1.0, "consistent", 1.0, "exact"),
    ("trapezoidal", 1.0, "consistent", 1.0, "penalty"),
    ("hht", 0.8, "consistent", 1.0, "penalty"),
    ("generalised_alpha", 0.8, "consistent", 1.0, "penalty"),
    ("fully_implicit", 0.0, "consistent", 1.0, "exact"),
    ("central_difference", 1.0, "lumped", 1.0, "penalty"),
    ("central_difference", 1.0, "lumped", 1.0, "exact"),
    ("trapezoidal", 1.0, "redistributed", 1.0, "penalty"),
    ("trapezoidal", 1.0, "redistributed", 1.0, "exact"),
    ("generalised_alpha", 0.8, "redistributed", 1.0, "corrected"),
    ("central_difference", 1.0, "redistributed", 1.0, "penalty"),
    ("central_difference", 1.0, "redistributed", 1.0, "exact"),
    ("central_difference", 1.0, "redistributed", 0.5, "exact"),
    ("central_difference", 1.0, "spread", 1.0, "exact"),
    ("staged", 1.0, "lumped", 1.0, "penalty"),
    ("staged", 1.0, "redistributed", 1.0, "exact"),
    ("trapezoidal", 1.0, "redistributed", TIP, "exact"),
    ("staged", 1.0, "redistributed", TIP, "corrected"),
    ("staged", 1.0, "redistributed", TIP, "exact"),
)
KEYS = ("scheme", "rho", "mass", "tip", "enforcement")


def table_cases(quick: bool) -> list[Case]:
    """Exact and penalty enforcement on the usual mass; damped schemes; a surface without mass, implicit and explicit.

    Quick: a scheme of every kind, the default among them, in steps in which a wave crosses an element.
    """
    rows, steps = (ROWS[:: len(ROWS) // 3], (1.0,)) if quick else (ROWS, (1.0, 2.0))
    fixed = {"penalty": 1.0, "elements": 100, "periods": 10}
    return [{**dict(zip(KEYS, row, strict=True)), **fixed, "cfl": cfl} for row in rows for cfl in steps]


def table_measure(case: Case) -> Table:
    """Errors against the exact motion, and whether all limits are kept."""
    found = measured(case)
    kept = all(abs(found[name]) <= MEASURES[name].limit for name in JUDGED)
    return found | {"all_kept": kept}


TABLE = MethodStudy(
    "Bouncing bar, ten periods: the schemes of the paper cited",
    table_cases,
    table_measure,
    Chart(rows=("scheme", "mass", "tip", "enforcement"), columns=("cfl",), measures=MEASURES),
)

GAP_WAYS = (
    {**DEFAULT, "scheme": "central_difference", "mass": "lumped", "tip": 1.0},
    {**DEFAULT, "scheme": "trapezoidal", "mass": "consistent", "tip": 1.0},
    {**DEFAULT, "scheme": "trapezoidal", "tip": 1.0},
    {**DEFAULT, "enforcement": "penalty", "penalty": 10.0},
    DEFAULT,
)
GAP_PERIODS = 0.2  # the first contact and a free flight after it


def gap_cases(quick: bool) -> list[Case]:
    """Gaps from a rounding to a tenth of the bar, which falls 56 mm in a step, so that it touches at any moment of one.

    An explicit constraint on a surface with mass keeps the next overlap closed: it presses up to a step before the
    touch. A surface without mass finds the touch within the step.
    """
    gaps = [0.0, 1e-12, 0.004, 0.025]
    if not quick:
        gaps = [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, *np.linspace(0.004, 0.054, 11).tolist(), 0.3, 1.0]
    fixed = {"cfl": 1.0, "elements": 60, "periods": GAP_PERIODS}
    return [{**way, **fixed, "gap": gap} for way, gap in product(GAP_WAYS, gaps)]


def gap_measure(case: Case) -> Table:
    """Errors of the first contact against the exact waves; raises MotionUnbounded or ContactNotSettled."""
    gap, step = case["gap"], choices(case).step
    waves = bounces(StraightBar(BAR.length, SPEED, IMPEDANCE), VELOCITY, GRAVITY, gap, 3.0 * TRANSIT)
    begun, ended = waves.contacts[0]
    motion = bounced({**case, "periods": case["periods"] + gap}, gap)
    start, end = motion.contacts[0]
    given = waves.momentum(ended) - waves.momentum(0.0) + BAR.density * BAR.area * BAR.length * GRAVITY * ended
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


GAP = MethodStudy(
    "Gap before the first touch, m: what a moment within a step changes in one contact",
    gap_cases,
    gap_measure,
    Chart(
        rows=("scheme", "mass", "tip", "enforcement"),
        columns=("gap",),
        measures={
            "touch": Measure("error of the first touch, steps", 0.02),
            "duration_steps": Measure("duration, steps", 1.0),
            "impulse": Measure("error of the impulse", 0.01),
            "gain": Measure("energy gain", 0.02),
        },
    ),
)

GAPS = (0.0, 0.0137, 0.0291, 0.0613)  # m: touches at several moments of a step


def limit_cases(quick: bool) -> list[Case]:
    """Penalties over three decades, shares of the linear limit up to a little beyond it.

    dt = 2/omega_max with the penalty's spring always there is no limit for contact that opens and closes: every closing
    with an overlap already there may add energy. The share of it that holds is measured.
    """
    penalties = (1.0, 10.0) if quick else (0.1, 1.0, 3.0, 10.0, 30.0, 100.0)
    shares = (0.4, 0.9, 1.05) if quick else (0.1, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.98, 1.05)
    every = product(("lumped", "redistributed"), penalties, shares)
    return [{"mass": m, "penalty": p, "share": s, "elements": 20 if quick else 40, "periods": 1} for m, p, s in every]


def limit_measure(case: Case) -> Table:
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


EXPLICIT_LIMIT = MethodStudy(
    "Central difference with a penalty: share of 2/omega_max that holds",
    limit_cases,
    limit_measure,
    Chart(
        rows=("mass", "penalty"),
        columns=("share",),
        measures={"gain": Measure("energy gain, worst of four gaps", 0.01)},
    ),
)

MEMBER = {
    "bouncing": BOUNCING,
    "explicit_limit": EXPLICIT_LIMIT,
    "gap": GAP,
    "table": TABLE,
}
