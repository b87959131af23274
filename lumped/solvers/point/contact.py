"""One contact: approach and rebound by turns, until the bodies part, rest, or the time is over; and contacts in a row.

Between two of them the bodies fly freely, and gravity may bring them back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lumped.errors import TooManySteps
from lumped.numbers import Array
from lumped.result.history import AT_REST, End
from lumped.solvers.point.bodies import Bodies, PointLaw, Stage, State
from lumped.solvers.point.phase import DEPTH, RATE, Event, PointMarch, PointPhase
from lumped.solvers.radau import STAGES

EXITS = ("exit", "let go")  # the events that end a contact
MOST_TURNS = 2000  # work: phases of one contact, each until a turn or a corner of the law
SOONER = 0.9  # safety: of the time that they reach, less what two digits round
# Of the velocity at touch: what leaves so slowly creeps back for ever, but for rounding.
FAINTEST_EXIT = 1e-20
# Contacts whose velocity at touch is below this share of the first one's: the bodies count as at rest.
FAINTEST = 1e-6


@dataclass(frozen=True)
class Contact:
    """The phases of one contact and how it ended."""

    phases: tuple[PointPhase, ...]
    end: End

    @property
    def start_time(self) -> float:
        """Touch, s."""
        return self.phases[0].start_time

    @property
    def end_time(self) -> float:
        """When it ended, s."""
        return self.phases[-1].end_time

    @property
    def first(self) -> State:
        """The state at touch."""
        return self.phases[0].steps[0].start

    @property
    def last(self) -> State:
        """The state at its end."""
        return self.phases[-1].last.end

    @property
    def deepest(self) -> float:
        """Largest depth, m; a contact that begins in the dent before, on the way out, is deepest at its touch."""
        return max(self.first.depth, *(float(step.depth.max()) for phase in self.phases for step in phase.steps))


def contact(
    law: PointLaw, bodies: Bodies, exit_rule: str, start: State, time: float, until: float, tolerance: float
) -> Contact:
    """One contact from `start` at `time`, s, to its end or to `until`, s. Raises TooManySteps.

    `exit_rule`: "force", contact ends when the force returns to zero, or "depth", at depth zero.
    `tolerance`: error of the rate in one step, relative to the velocity at first touch.
    """
    scale = law.time_scale(bodies)
    stage = Stage(start.rate > 0.0, start.depth, abs(start.rate) or bodies.velocity, start.depth)
    # An end that cuts the contact early is no first step of its own: two marches would take the same one and agree.
    length = tolerance ** (law.grading(stage) / STAGES) * min(scale, until - time)
    corners = law.corners(stage)
    phases: list[PointPhase] = []
    for _ in range(MOST_TURNS):
        events = _events(law, stage, exit_rule, bodies) | _corner(stage, corners)
        march = PointMarch(law, stage, bodies, events, until, tolerance * bodies.velocity)
        phase = march.phase(start, time, length)
        phases.append(phase)
        start, time, length = phase.last.end, phase.end_time, phase.last.length
        if phase.event is None:
            return Contact(tuple(phases), End.TIME)
        if phase.event == "rest":
            return Contact(tuple(phases), End.REST)
        if phase.event in EXITS:
            faint = abs(start.rate) < FAINTEST_EXIT * bodies.velocity
            return Contact(tuple(phases), End.REST if faint else End.SEPARATED)
        if phase.event == "corner":
            corners = corners[1:]
            continue
        stage = following(law, stage, start.depth)
        start, corners = start._replace(rate=0.0), law.corners(stage)
        if abs(phase.last.last_acceleration) * scale < AT_REST * bodies.velocity:
            return Contact(tuple(phases), End.REST)
    # Under a weight they never part where the law loses nothing in small swings, as a loop that no longer yields.
    raise TooManySteps(
        f"contact: {MOST_TURNS} turns without separation reach {time:.3g} s of {until:.3g} s; "
        f"accepted: a motion.end_time of at most {SOONER * time:.2g} s"
    )


def following(law: PointLaw, stage: Stage, depth: float) -> Stage:
    """The stage after one which turns at a depth, m."""
    deepest, kept = max(stage.deepest, depth), law.kept(depth, stage)
    return Stage(not stage.approaching, deepest, stage.speed, depth, kept)


def leaving(law: PointLaw, stage: Stage, exit_rule: str, bodies: Bodies) -> dict[str, Event]:
    """What ends a contact: the force where the law can pull and must not, else the depth.

    And the rate of bodies that a weight draws apart, from which on a law that else never pulls would.
    """
    if law.tensile and exit_rule == "force":
        return {"exit": FORCE_LEFT}
    rate = law.letting_go(stage)
    if exit_rule == "depth" or bodies.gravity >= 0.0 or rate == -math.inf:
        return {"exit": DEPTH_LEFT}
    let_go = Event(lambda step: step.rate - rate, lambda step: step.last_acceleration, told_by=RATE)
    return {"exit": DEPTH_LEFT, "let go": let_go}


def _events(law: PointLaw, stage: Stage, exit_rule: str, bodies: Bodies) -> dict[str, Event]:
    """What ends a stage: the turn of the motion, and in the rebound the end of contact."""
    if stage.approaching:
        return {"turn": TURN}
    return leaving(law, stage, exit_rule, bodies) | {"turn": TURN_BACK}


def _corner(stage: Stage, corners: tuple[float, ...]) -> dict[str, Event]:
    """The next corner of the force within a stage."""
    if not corners:
        return {}
    sign, depth = (1.0 if stage.approaching else -1.0), corners[0]
    return {"corner": Event(lambda step: sign * (depth - step.depth), lambda step: -sign * step.end.rate)}


def force_left(depth: Array, force: Array) -> Array:
    """The force as long as there is depth; above the surface its mean stiffness times the depth goes on."""
    beyond = force.max() / depth.max() if depth.max() > 0.0 else 1.0
    return np.asarray(np.where(depth > 0.0, force, beyond * depth))


TURN = Event(lambda step: step.rate, lambda step: step.last_acceleration)
TURN_BACK = Event(lambda step: -step.rate, lambda step: -step.last_acceleration)
DEPTH_LEFT = Event(lambda step: step.depth, lambda step: step.end.rate, told_by=DEPTH)
FORCE_LEFT = Event(
    lambda step: force_left(step.depth, step.force), lambda step: step.last_slope(step.force), rough=True
)


@dataclass(frozen=True)
class PointMotion:
    """Contacts in order; between two of them depth is that of free flight. `gravity`: m/s2 towards the target.

    `weight`: N, what a striker at rest is borne with.
    """

    contacts: tuple[Contact, ...]
    gravity: float
    weight: float = 0.0

    @property
    def end(self) -> End:
        """How the last contact ended."""
        return self.contacts[-1].end

    @property
    def steps(self) -> int:
        """How many it took."""
        return sum(len(phase.steps) for one in self.contacts for phase in one.phases)


def motion(law: PointLaw, bodies: Bodies, exit_rule: str, impacts: int, until: float, tolerance: float) -> PointMotion:
    """Up to `impacts` contacts, the first at time zero, followed until `until`, s. Raises TooManySteps."""
    state, time, contacts = law.touch(bodies), 0.0, list[Contact]()
    while len(contacts) < impacts:
        # A trial of Newton's method may go beyond all numbers: then the step is refused.
        with np.errstate(all="ignore"):
            contacts.append(contact(law, bodies, exit_rule, state, time, until, tolerance))
        if contacts[-1].end is not End.SEPARATED:
            break
        again = law.returned(bodies, contacts[-1].last)
        if again is None or contacts[-1].end_time + again[0] >= until:
            break
        time, state = contacts[-1].end_time + again[0], again[1]
        if abs(state.rate) < FAINTEST * bodies.velocity:
            break
    return PointMotion(tuple(contacts), bodies.gravity, bodies.mass * bodies.gravity)
