"""The bouncing bar of Doyen, Ern and Piperno 2011, doi:10.1137/100791440, by any choices, against its exact motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.bar import TIP, Bar, falling, pitch
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.march import Choices, Motion, march
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.pressed import Enforced
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.settings import Given
from fe_contact.studies.stability.base import Case
from lumped.materials import Relaxation
from lumped.schema import Table
from lumped.solvers.bar import Bounces, StraightBar, bounces

BAR = Bar(length=10.0, area=1.0, density=1.0, relaxation=Relaxation(900.0))
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
ENERGY = 0.5 * BAR.density * BAR.area * BAR.length * VELOCITY**2


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
    """What went wrong by how much; see :data:`fe_contact.studies.stability.bouncing.CHART`."""
    motion, wanted = bounced(case), exact(case["periods"])
    time, force, step = motion.time, motion.force, choices(case).step
    contact = BarContact(motion, 2 * TRANSIT)
    begun, due = [start for start, _ in contact.lasting], [start for start, _ in wanted.contacts]
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
        "duration_steps": (contact.first - 2 * TRANSIT) / step,
        "start": (begun[known] - due[known]) / PERIOD if known >= 0 else math.nan,
        "restitution": (impulse - 800.0 / 3.0) / (BAR.length * VELOCITY),
        "contacts": len(motion.contacts) / len(due),
        "steps": len(motion.samples) - 1,
        "stages": motion.stages,
        "iterations": sum(sample.iterations for sample in motion.samples),
        "residual": max(abs(sample.energies.residual) for sample in motion.samples) / ENERGY,
    }


@dataclass(frozen=True)
class BarContact:
    """Contacts of a motion, those apart that follow each other within a ``duration``, s."""

    motion: Motion
    duration: float

    @property
    def lasting(self) -> list[tuple[float, float]]:
        """The first of every cluster with the end of its last."""
        found = list[tuple[float, float]]()
        for start, end in self.motion.contacts:
            if found and start - found[-1][1] < self.duration:
                found[-1] = (found[-1][0], end)
            else:
                found.append((start, end))
        return found

    @property
    def first(self) -> float:
        """How long the first contact lasts until it opens for the first time, s; chatter makes it short."""
        start, end = self.motion.contacts[0]
        return end - start


def _energies(motion: Motion) -> tuple[float, float]:
    """Change of the energy's mean from the first period to the last, and the largest gain, over that at the start."""
    kept: Array = np.array([s.energies.total - s.energies.work for s in motion.samples]) / ENERGY
    time = motion.time
    span = min(PERIOD, 0.5 * time[-1])
    return float(kept[time >= time[-1] - span].mean() - kept[time <= span].mean()), float(kept.max())
