"""The record of a march: histories, snapshots and an energy account of which each term is computed on its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import pairwise

import numpy as np

from fe_contact.steppers.march import March, Work
from fe_contact.steppers.steps import State, Step, Stepping

Energies = Mapping[str, float]


def record(
    stepper: Stepping, states: Sequence[State], steps: Sequence[Step], separated: bool, end_spread: float
) -> March:
    """Gather what a march leaves behind; ``end_spread`` as in :class:`fe_contact.steppers.march.March`."""
    works, last = [step.work for step in steps], states[len(steps)]
    return March(
        time=np.array([state.time for state in states]),
        depth=np.array([state.depth for state in states]),
        impulse=np.array([state.impulse for state in states]),
        first_force=stepper.first_force,
        radius_time=np.array([step.radius_time for step in steps]),
        radius=np.array([step.radius for step in steps]),
        separated=separated,
        photograph=partial(stepper.snapshots, steps),
        energy=_energy(stepper, states, steps),
        end_spread=end_spread,
        work=Work(len(steps), sum(w.contact_problems for w in works), sum(w.iterations for w in works)),
        memory=last.memory,
        memory_time=last.time,
    )


def balanced(terms: Energies) -> dict[str, float]:
    """Energies, J, with what is left of the first of them, ``in``, when all others are taken from it."""
    known = {name: value for name, value in terms.items() if name != "residual"}
    return known | {"residual": 2 * known["in"] - sum(known.values())}


def onwards(later: Energies, earlier: Energies, flight_heat: float) -> dict[str, float]:
    """The account of a contact, J, carried on from that of an ``earlier`` one over a flight."""
    spent = {name: earlier[name] + later[name] for name in ("viscous", "radiated", "contact", "numerical")}
    spent["viscous"] += flight_heat
    given = earlier["in"] - earlier["out"] - earlier["stored"] + flight_heat + later["in"]
    return balanced({**later, **spent, "in": given})


def _energy(stepper: Stepping, states: Sequence[State], steps: Sequence[Step]) -> dict[str, float]:
    """Terms in J, each zero where a model without inertia knows none.

    ``in``: with what the body still stored at touch. ``contact``: the striker's work that does not reach the body, none
    of it where steps are short and the penalty is stiff. ``numerical``: what scheme and mesh leave unaccounted for.
    """
    strike, scheme, last = stepper.strike, stepper.scheme, states[-1]
    taken = list(zip(pairwise(states[: len(steps) + 1]), steps, strict=True))
    jumps = np.diff([state.velocity for state in states[: len(steps) + 1]])
    lost = sum(stepper.lost(before.memory, after.memory, step.length) for (before, after), step in taken)
    heats = [stepper.dissipated(before.memory, after.memory, step.length) for (before, after), step in taken]
    stored = stepper.stored(last.memory)
    crept = _crept(stored, heats[-1] / steps[-1].length, last.time - states[len(steps)].time)
    return balanced(
        {
            "in": 0.5 * strike.mass * strike.velocity**2
            + strike.mass * strike.gravity * (last.depth - strike.depth)
            + stepper.stored(states[0].memory),
            "out": 0.5 * strike.mass * last.velocity**2,
            "stored": stored - crept,
            "viscous": sum(heats) + crept,
            "radiated": 0.0,
            "contact": sum(stepper.between(before, step) for (before, _), step in taken),
            "numerical": lost + (scheme.lever - 0.5) * strike.mass * float(jumps @ jumps),
        }
    )


def _crept(stored: float, rate: float, time: float) -> float:
    """Heat of a body that nothing presses over a time, s, from what it stores, J, at a rate that falls with it; J."""
    return stored * -float(np.expm1(-max(rate, 0.0) * time / stored)) if stored > 0.0 else 0.0
