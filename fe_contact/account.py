"""The record of a march: histories, snapshots and an energy account of which each term is computed on its own."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType

import numpy as np

from fe_contact.bodies.memory import step_law
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.march import March, Snapshot, Strike, Work
from fe_contact.numerics import Numerics
from fe_contact.steps import State, Step


def record(
    strike: Strike,
    surface: ScaledSurface,
    numerics: Numerics,
    scheme: ModuleType,
    states: Sequence[State],
    steps: Sequence[Step],
    separated: bool,
    end_spread: float,
) -> March:
    """Gather what a march leaves behind; ``end_spread`` as in :class:`fe_contact.march.March`."""
    ends = np.array([step.state.time for step in steps])
    lengths = np.array([step.length for step in steps])
    approaching = np.array([step.state.velocity > 0 for step in steps])
    # growing contact is found at the end of the step, receding contact where the force is sampled
    radius_time = np.where(approaching, ends, ends - (1 - scheme.SAMPLE) * lengths)
    works = [step.work for step in steps]
    return March(
        time=np.array([state.time for state in states]),
        depth=np.array([state.depth for state in states]),
        impulse=np.array([state.impulse for state in states]),
        radius_time=radius_time,
        radius=np.array([step.radius for step in steps]),
        separated=separated,
        snapshots=tuple(_snapshot(step, surface, scheme) for step in steps),
        energy=_energy(strike, surface, numerics, scheme, states[-1], steps),
        end_spread=end_spread,
        work=Work(len(steps), sum(w.contact_problems for w in works), sum(w.iterations for w in works)),
    )


def _snapshot(step: Step, surface: ScaledSurface, scheme: ModuleType) -> Snapshot:
    return Snapshot(
        time=step.state.time - (1 - scheme.SAMPLE) * step.length,
        contact_radius=step.radius,
        radii=step.scale * surface.operator.points,
        pressure=step.solution.pressure / step.scale,
    )


def _energy(
    strike: Strike,
    surface: ScaledSurface,
    numerics: Numerics,
    scheme: ModuleType,
    last: State,
    steps: Sequence[Step],
) -> dict[str, float]:
    """Terms in J; ``contact`` is what the penalty's springs hold if the bodies have not separated."""
    final = steps[-1]
    stiffness = numerics.penalty * step_law(strike.relaxation, scheme, final.length).now
    springs = 0.5 * final.scale * float(surface.operator.weights @ final.solution.pressure**2) / stiffness
    terms = {
        "in": 0.5 * strike.mass * strike.velocity**2 + strike.mass * strike.gravity * last.depth,
        "out": 0.5 * strike.mass * last.velocity**2,
        "stored": last.memory.stored(strike.relaxation),
        "viscous": sum(step.heat for step in steps),
        "radiated": 0.0,
        "contact": springs if last is final.state else 0.0,
        "numerical": 0.0,
    }
    terms["residual"] = 2 * terms["in"] - sum(terms.values())
    return terms
