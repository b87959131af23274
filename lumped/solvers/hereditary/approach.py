"""The approach, from touch to the turn; the contact radius grows, and every law with memory agrees on it.

It is followed over r = sqrt(t): depth, load and memories are smooth in r at touch, and not in t.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lumped.errors import BadInput, NotReached
from lumped.numbers import Array
from lumped.result.history import AT_REST
from lumped.solvers.hereditary.march import HereditaryMarch, Settings, Stretch
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.pieces import FORCE, VELOCITY, Followed, HereditaryPiece, PieceAsked, over_root
from lumped.solvers.hereditary.problem import Hereditary

# A velocity of AT_REST is rest only if the striker would take longer than this share of the time so far to
# stop.
SLOW = 1e-3
# The first piece is this share of the root of the stiffest contact time.
FIRST = 0.4
# A force that the accuracy is counted in at least, in units of the problem, whose own is about one: where a load starts
# like depth over its logarithm, no first piece however short is smooth on its own scale.
FAINT = 1e-3
# Where the force rises steeply the velocity is taken as that of touch, up to this share of the stiffest contact time.
TOUCH = 1e-12
EARLIER = 0.3  # the end of such a piece over that of the next: short enough for a power of r to be a polynomial in it
MOST_EARLIER = 120  # work: of these pieces, which then begin with 1e-63 of the last one


@dataclass(frozen=True)
class Approach:
    """Its path over r; whether the striker turned at its end, or came to rest; Newton steps and largest force."""

    path: Path
    turned: bool
    rests: bool
    steps: int
    largest: float

    @property
    def end(self) -> float:
        """The time where it ended."""
        return self.path.end**2


def follow(
    problem: Hereditary,
    span: tuple[float, float],
    state: Array,
    first: float,
    over: Callable[[Array], bool],
    settings: Settings,
    largest: float = 0.0,
    before: Path | None = None,
) -> Followed[HereditaryMarch]:
    """March over a span of r from a state until `over`; `first` is the length to begin with. Raises NotReached."""
    beyond: BadInput | NotReached | None = None

    def attempt(root: float, length: float, state: Array) -> Followed[HereditaryPiece | None]:
        """A long piece may try depths beyond the load curve that the motion never sees: then a shorter one."""
        nonlocal beyond
        asked, found = PieceAsked(problem, settings.table, over_root, root, length, state), None
        try:
            if before is not None:
                found = yield asked._replace(before=before, places=root + length * settings.table.points)
            return found or (yield asked)
        except (BadInput, NotReached) as failure:
            beyond = failure
            return None

    found = yield from Stretch(attempt, FORCE, over).march(span, state, first, settings, largest, before)
    if found.stuck:
        where = f"the motion could not be followed beyond {found.path.end**2 * problem.scales.time:.6g} s"
        raise beyond or NotReached(where)
    return found


def approach(
    problem: Hereditary, end_time: float, settings: Settings, before: Approach | None = None
) -> Followed[Approach]:
    """Follow the motion to its turn, to rest, or to `end_time`, in units of the problem. Raises NotReached.

    `before` is the same approach found with fewer nodes: its pieces are kept, and it is where Newton starts.
    """
    known = None if before is None else before.path
    slow = AT_REST if problem.modulus.relaxed == 0.0 and problem.gravity == 0.0 else 0.0
    found, end = yield from _to_velocity(problem, end_time, slow, settings, known)
    if slow and found.over:
        force = float(found.path.state(end)[FORCE])
        if slow > SLOW * force * end**2:
            return Approach(found.path.until(end), False, True, found.steps, found.largest)
        found, end = yield from _to_velocity(problem, end_time, 0.0, settings, known)
    return Approach(found.path.until(end), found.over, False, found.steps, found.largest)


def _to_velocity(
    problem: Hereditary, end_time: float, slow: float, settings: Settings, before: Path | None
) -> Followed[tuple[HereditaryMarch, float]]:
    """The march until the velocity has fallen to `slow`, and the place where it has."""

    def over(values: Array) -> bool:
        return bool(values[VELOCITY].min() <= slow)

    touch = _touch(problem, settings) if problem.rises_steeply else None
    begin = touch.end if touch else 0.0
    first = 3.0 * begin or FIRST * problem.shortest**0.5
    start = problem.early(np.array([begin**2]))[:, 0]
    found = yield from follow(problem, (begin, end_time**0.5), start, first, over, settings, FAINT, before)
    if touch:
        found = replace(found, path=touch.joined(found.path))
    if not found.over:
        return found, found.path.end
    place = found.path.fall(VELOCITY, slow)
    return found, found.path.end if place is None else place


def _touch(problem: Hereditary, settings: Settings) -> Path:
    """The very first pieces, at the velocity of touch, from where the force is less than what a piece may err by."""
    end = (TOUCH * problem.shortest) ** 0.5
    earlier = min(math.ceil(math.log(settings.rtol) / (problem.power * math.log(EARLIER))), MOST_EARLIER)
    ends = end * EARLIER ** np.arange(earlier, -1.0, -1.0)
    breaks, nodes = np.append(0.0, ends), np.append(0.0, settings.table.points)
    pieces = [problem.early((low + (high - low) * nodes) ** 2) for low, high in pairwise(breaks)]
    return Path.of(breaks.tolist(), pieces)
