"""The record of a march: histories, snapshots and an energy account of which each term is computed on its own."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np

from fe_contact.march import March, Work
from fe_contact.steps import State, Step, Stepping


def record(
    stepper: Stepping, states: Sequence[State], steps: Sequence[Step], separated: bool, end_spread: float
) -> March:
    """Gather what a march leaves behind; ``end_spread`` as in :class:`fe_contact.march.March`."""
    works, last = [step.work for step in steps], states[len(steps)]
    return March(
        time=np.array([state.time for state in states]),
        depth=np.array([state.depth for state in states]),
        impulse=np.array([state.impulse for state in states]),
        first_force=stepper.first_force,
        radius_time=np.array([step.radius_time for step in steps]),
        radius=np.array([step.radius for step in steps]),
        separated=separated,
        photograph=partial(stepper.snapshots, steps) if stepper.accounted else tuple,
        energy=_energy(stepper, states, steps) if stepper.accounted else {},
        end_spread=end_spread,
        work=Work(len(steps), sum(w.contact_problems for w in works), sum(w.iterations for w in works)),
        memory=last.memory,
        memory_time=last.time,
    )


def _energy(stepper: Stepping, states: Sequence[State], steps: Sequence[Step]) -> dict[str, float]:
    """Terms in J; ``contact`` is what the penalty's springs hold if the bodies have not separated.

    What the body still stored at touch goes in too.
    """
    strike, last = stepper.strike, states[-1]
    memories = [state.memory for state in states[: len(steps) + 1]]
    heats = [
        stepper.dissipated(before, after, step.length)
        for (before, after), step in zip(pairwise(memories), steps, strict=True)
    ]
    terms = {
        "in": 0.5 * strike.mass * strike.velocity**2
        + strike.mass * strike.gravity * (last.depth - strike.depth)
        + stepper.stored(memories[0]),
        "out": 0.5 * strike.mass * last.velocity**2,
        "stored": stepper.stored(last.memory),
        "viscous": sum(heats),
        "radiated": 0.0,
        "contact": stepper.springs(steps[-1]) if last is steps[-1].state else 0.0,
        "numerical": 0.0,
    }
    terms["residual"] = 2 * terms["in"] - sum(terms.values())
    return terms
