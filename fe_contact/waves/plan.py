"""Scales of an impact with waves -> its settings, the lengths of its steps, and what an error budget with them costs.

An impact without inertia places mesh and time steps: of the half-space the exact row of springs. Nothing of it enters a
value or a bar. Steps are short about an early peak of the force, doubled ever again later.

Work is counted, a unit of it is one unknown, one step later. A step is a back-substitution and a few products with
sparse matrices, so its time goes as the unknowns; factors and what contact knows of the body are kept a length of step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_contact.budget.plan import EARLY_PEAK, SOONEST_PEAK, Plan
from fe_contact.dynamics.march import MOST_WORK
from fe_contact.errors import WavesTooDear
from fe_contact.settings import RANGES, Given, Numerics, WaveNumerics
from lumped.laws.mdr import ImpactScales
from lumped.materials import Relaxation
from lumped.result.model_ledger import Peak, model_ledger, pulse_lasts
from lumped.scene.scene import Scene

DEFAULT_TOLERANCE = 3e-3  # of a peak force; what chatter at the contact's edge leaves is about a third
ELEMENTS = 9.0  # along every contact radius
FINER = 2.0  # times as many at the surface where dashpots carry much: pressure is infinite at an edge that advances
PENALTY = 120.0  # default: the contact penalty, before stiffness and dashpots raise it
STIFF = 16.0  # times as much there
MUCH = 0.5  # share of dashpots in the stiffness until the force peaks, below which FINER and STIFF count in part
STEPS = 256  # along a contact, shorter ones about an early peak
SMOOTH_STEPS = 208  # the same where no wave comes back to the contact
# Of the tolerance: by how much many echoes may swing the force in its bar; more are followed, of few, any of which may
# end the contact, half as much.
SHOWN = 0.6
STEPS_ECHO = 32.0  # the same along an echo that the force shows
FEWEST_ECHO = 8  # of them: rows between which an echo is lost agree that there is none
LOOSER = 0.75  # beyond the default tolerance elements and steps go as it to this power, as `fe-contact tradeoff` has it
FEWEST = {"elements": 2.5, "steps": 64}  # safety: halved, they still show an order
TRAVEL = 0.5  # of the contact time: an echo from the far radius returns after the contact
SPREAD = 3.0  # lengths over which a dashpot in parallel, which has no wave speed, spreads a motion in a contact
DEFAULTS: Given = {
    "order": 3,
    "enforcement": "corrected",
    "scheme": "generalised_alpha",
    "rho": 0.5,
    "mass": "consistent",
}
STEP = 300  # unknowns whose share of a step takes as long as all the rest of it
SECONDS = 1.5e-6  # of one core a unit of work: 1.1 to 1.7 of them were measured over all kinds of bodies
BYTES, AT_LEAST = 8e3, 150e6  # an unknown, and at all, as measured
MARCHES = 2.5  # that a budget takes beside the finest one, at most, in units of that
JUDGED = 0.5  # the same of one with half the steps
FLIGHT = 1.5  # a contact and the flight that follows, in contacts
MANY = 12  # contacts that are expected at most: few bodies come back so often
MOST_BYTES = 2e9  # work: memory of one march, bytes


@dataclass(frozen=True)
class Usual:
    """At the default tolerance: elements along every contact radius, times as many at the surface, steps along a
    contact, penalty.
    """

    elements: float = ELEMENTS
    steps: float = STEPS
    penalty: float = PENALTY
    finer: float = 1.0


USUAL = Usual()


class Echoes(NamedTuple):
    """How often a wave comes back in the contact time, and by which share of its peak this swings the force."""

    number: float
    swing: float


NO_ECHO = Echoes(0.0, 0.0)


def contact_time(scene: Scene, scales: ImpactScales) -> float:
    """Of the estimated impact, s, or all that there is time for."""
    return scales.duration or scene.end_time


def placed(
    scene: Scene,
    given: Given,
    scales: ImpactScales,
    far_radius: float,
    wide: float = 1.0,
    stiff: float = 1.0,
    usual: Usual = USUAL,
    echoes: Echoes = NO_ECHO,
) -> Plan:
    """What ``given`` leaves open for an impact of these scales, on a mesh that ends at ``far_radius``, contact radii.

    ``wide``: the contact radius to be ready for over the estimated one; ``stiff``: the body over a half-space under it;
    ``echoes`` are followed where the force shows them, unless there are fewer steps ``given`` than tell them.
    """
    tolerance, duration = float(given.get("tolerance", DEFAULT_TOLERANCE)), contact_time(scene, scales)
    finer, looser = max(1.0, DEFAULT_TOLERANCE / tolerance), min(1.0, DEFAULT_TOLERANCE / tolerance)
    elements = max(usual.elements * looser**LOOSER, FEWEST["elements"])
    fewest = 2 * FEWEST_ECHO * echoes.number  # half of them, which judge them, have to show echoes too
    steps = max(usual.steps * looser**LOOSER, FEWEST["steps"])
    shown = echoes.swing > SHOWN * tolerance * echoes.number / (echoes.number + 1.0)
    if shown:
        steps = max(steps, STEPS_ECHO * echoes.number * looser**LOOSER, fewest)
    steps = min(4 * math.ceil(steps * math.sqrt(finer) / 4), int(RANGES["steps"][1]))
    peak_share = min(max(scales.peak_time / duration, SOONEST_PEAK), 1.0)
    viscous = min(viscous_share(scene.contact_modulus, peak_share * duration) / MUCH, 1.0)
    chosen = {
        **DEFAULTS,
        "tolerance": tolerance,
        "elements_per_contact": elements * math.sqrt(finer),
        "finer": usual.finer + (FINER - usual.finer) * viscous,
        "penalty": usual.penalty * stiff * (1.0 + (STIFF - 1.0) * viscous),
        "steps": steps,
        "far_radius": far_radius,
        "contact_radius": wide * scales.contact_radius,
        "contact_time": duration,
        "peak_share": peak_share,
        "echoes": echoes.number,
        "swing": 0.0 if shown and given.get("steps", steps) >= fewest else echoes.swing,
    }
    lasts = pulse_lasts(scales.duration, scales.peak_time, scene.motion.end_time or duration)
    peak = Peak(scales.peak_force, scales.peak_depth, scales.contact_radius, lasts)
    return Plan(WaveNumerics(**{**chosen, **given}), frozenset(given) - {"tolerance"}, model_ledger(scene, peak))


def viscous_share(modulus: Relaxation, time: float) -> float:
    """How much of the stiffness against a steady advance for some time, s, is that of dashpots.

    A branch that has long relaxed is one of them, of viscosity modulus x time; at once it is a spring.
    """
    ratios = time / np.asarray(modulus.times)
    held = -np.expm1(-ratios) / ratios  # of a branch's modulus, at the end
    flowing = modulus.viscosity / time + float(np.dot(modulus.moduli, held * (1.0 - held)))
    return flowing / (modulus.equilibrium + modulus.viscosity / time + float(np.dot(modulus.moduli, held)))


def graded(numerics: Numerics) -> tuple[float, tuple[float, ...]]:
    """First step, s, and the times, s, from which steps are twice as long as before.

    From a share of the contact on at which a force may well peak there are ``steps`` to the contact time; half that
    time before they are half as long, down to the time of the peak.
    """
    octaves = max(math.ceil(math.log2(EARLY_PEAK / numerics.peak_share)), 0)
    times = [EARLY_PEAK * numerics.contact_time / 2**earlier for earlier in range(octaves)]
    return numerics.contact_time / numerics.steps / 2**octaves, tuple(reversed(times))


@dataclass(frozen=True)
class Cost:
    """``unknowns`` of the body, ``steps`` of the finest march and the ``work`` of all marches of one error budget."""

    unknowns: int
    steps: int
    work: float

    @classmethod
    def of(cls, unknowns: int, numerics: Numerics, impacts: int, finer: int = 0) -> Cost:
        """Of a budget with these settings; nearly every contact asked for is expected to come.

        ``finer``: unknowns of the mesh that judges one which is too coarse to be halved.
        """
        octaves = len(graded(numerics)[1])
        row = 1.0 if impacts == 1 else FLIGHT * min(impacts, MANY)
        steps = math.ceil(row * numerics.steps * (1.0 + EARLY_PEAK * octaves))
        return cls(max(unknowns, finer), steps, (MARCHES * (unknowns + STEP) + JUDGED * finer) * steps)

    @property
    def all_steps(self) -> float:
        """Of all marches of the budget, counted as if all were on the finest mesh."""
        return MARCHES * self.steps

    @property
    def seconds(self) -> float:
        """Of one core."""
        return SECONDS * self.work

    @property
    def bytes(self) -> float:
        """Of memory."""
        return AT_LEAST + BYTES * self.unknowns

    def __str__(self) -> str:
        return (
            f"{self.unknowns} unknowns, {self.steps} steps: "
            f"about {self.seconds:.2g} s of one core and {self.bytes / 1e9:.1f} GB"
        )

    def as_dict(self) -> dict[str, float]:
        """Plain data for JSON."""
        return {"unknowns": self.unknowns, "steps": self.steps, "cpu_s": self.seconds, "memory_bytes": self.bytes}

    def check(self, spent: float = 0.0) -> None:
        """Raise WavesTooDear where this, after what has been ``spent``, is more work than one march may be."""
        if spent + self.work > MOST_WORK or self.bytes > MOST_BYTES:
            raise WavesTooDear(str(self), f"{SECONDS * MOST_WORK:.2g} s and {MOST_BYTES / 1e9:.0f} GB")
