"""A block on a rigid plane: a bar of elements that a wave crosses in a step; exact where nothing rests on it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fe_contact.settings import WaveNumerics
from fe_contact.studies.tradeoff.design import Settings, grid
from fe_contact.studies.tradeoff.targets._rod import forget, operations
from fe_contact.studies.tradeoff.tried import TriedBody
from fe_contact.studies.tradeoff.truth import Truth
from fe_contact.waves.targets._block import bar_of
from lumped.scene.scene import Scene
from lumped.solvers.bar import Bounces, StraightBar, bounces

BEFORE = 1.0 - 1e-12  # of a time: what comes just before it


def exact(scene: Scene) -> Truth | None:
    """By characteristics; None of a viscoelastic bar, or one with a mass behind it."""
    bar = bar_of(scene)
    if not bar.relaxation.is_elastic or bar.end_mass > 0.0:
        return None
    speed = math.sqrt(bar.relaxation.glassy / bar.density)
    straight = StraightBar(bar.length, speed, bar.density * bar.area * speed)
    motion = bounces(straight, scene.velocity, scene.gravity, 0.0, scene.end_time)
    return _told(motion, scene.motion.impacts)


def _told(motion: Bounces, impacts: int) -> Truth:
    """The first contact's quantities; the force of so many."""
    bar, contacts = motion.bar, motion.contacts[:impacts]
    _, parted = contacts[0]
    starts = np.array([piece.start for piece in motion.pieces])
    knots = np.unique(np.concatenate([starts, starts + bar.echo, np.ravel(contacts)]))
    knots = knots[knots <= contacts[-1][1]]
    inside = knots[knots <= parted]
    values = {
        "peak_force": float(motion.force(np.append(inside, inside * BEFORE)).max()),
        "duration": parted,
        "restitution": motion.momentum(parted) / (bar.mass * motion.velocity),
    }
    return Truth(values, knots, lambda times: np.where(times <= contacts[-1][1], motion.force(times), 0.0))


def variations(base: WaveNumerics, quick: bool) -> Iterator[Settings]:
    """Schemes with the masses on which they are stable or known to fail; penalties in units of modulus/element."""
    yield from grid(steps=tuple(base.steps * 2**power // 8 for power in range(1 if quick else 0, 5)))
    yield from grid(scheme=("staged", "generalised_alpha"), rho=(0.8,), mass=("redistributed",))
    yield from grid(scheme=("fully_implicit",))
    if not quick:
        yield from grid(scheme=("generalised_alpha", "trapezoidal"), rho=(0.8,), mass=("consistent", "spread"))
        yield from grid(scheme=("hht",), rho=(0.8,), mass=("redistributed", "spread"))
        yield from grid(enforcement=("penalty", "corrected", "augmented"), penalty=(1.0, 1e2))


BLOCK = TriedBody(variations, exact, operations, forget)
