"""Pieces one after the other, each as long as the accuracy allows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumped.errors import NotReached, TooManySteps
from lumped.numbers import Array
from lumped.progress import step_done
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.pieces import Followed, HereditaryPiece
from lumped.solvers.radau import Nodes, chebyshev_through_zero, radau

POINTS = 16  # default: nodes of a piece
MOST_PIECES = 3000  # work: pieces of one march
# Safety: most and least by which the next piece is longer, and the share of what its error allows.
GROWTH, SHRINKAGE, CAUTION = 3.0, 0.15, 0.8
UNSOLVED = 0.25  # work: of the length, to try after a piece that found no solution
SHORTEST, SAME = 1e-13, 1e-14  # rounding: of the span: a piece as short fails, breaks as near are one


@dataclass(frozen=True)
class Settings:
    """What a piece may err by, as a share of the largest force so far; and its number of nodes."""

    rtol: float
    points: int = POINTS

    @property
    def table(self) -> Nodes:
        """The nodes and what belongs to them, in time itself."""
        return radau(self.points)


@dataclass(frozen=True)
class HereditaryMarch:
    """A path, its Newton steps and largest force; whether its last piece passed the event, or it got stuck."""

    path: Path
    steps: int
    largest: float
    over: bool
    stuck: bool = False


@dataclass(frozen=True)
class Stretch:
    """What is to be marched through.

    `attempt` solves the piece of a length at a place from the state there, or gives None; `force` is the field
    which the accuracy is for, and `time`, where that is a field too; `over` says whether a piece has passed the
    event that ends the march.
    """

    attempt: Callable[[float, float, Array], Followed[HereditaryPiece | None]]
    force: int
    over: Callable[[Array], bool]
    time: int | None = None

    def march(
        self,
        span: tuple[float, float],
        start: Array,
        first: float,
        settings: Settings,
        largest: float = 0.0,
        before: Path | None = None,
    ) -> Followed[HereditaryMarch]:
        """From the first place of the span until the event, or to its end. Raises TooManySteps.

        `first` is the length to begin with, `largest` the largest force so far. The breaks of a path that was
        found `before` with fewer nodes are kept.
        """
        plan = [] if before is None else before.breaks[1:].tolist()
        breaks, steps, length = [span[0]], 0, _ahead(plan, span, span[0], first)
        values: list[Array] = []
        state = start
        while len(values) < MOST_PIECES:
            step_done()
            place = breaks[-1]
            length = min(length, span[1] - place)
            piece = yield from self.attempt(place, length, state)
            factor = UNSOLVED
            if piece is not None:
                steps += piece.steps
                peak = max(largest, float(np.abs(piece.values[self.force]).max()))
                factor = _factor(self._error(piece.values, peak), settings)
                if factor >= CAUTION:
                    largest, state = peak, piece.values[:, -1]
                    values.append(piece.values)
                    breaks.append(_landed(plan, span, place + length))
                    over = self.over(piece.values)
                    if over or breaks[-1] >= span[1]:
                        return HereditaryMarch(Path.of(breaks, values), steps, largest, over)
                    # where a force begins, as a power of the time, its polynomial tells little of the next piece
                    longer = factor if len(values) > 1 else min(factor, 1.0)
                    length = _ahead(plan, span, breaks[-1], length * longer)
                    continue
            length *= factor
            if length <= SHORTEST * (span[1] - span[0]):
                if not values:
                    raise NotReached("the impact could not be followed from its very start")
                return HereditaryMarch(Path.of(breaks, values), steps, largest, False, stuck=True)
        raise TooManySteps(f"more than {MOST_PIECES} pieces: accepted: a looser tolerance, an earlier end_time")

    def _error(self, values: Array, peak: float) -> float:
        """Relative error of a piece."""
        error = tail(values[self.force]) / (peak or 1.0)
        if self.time is None:
            return error
        return max(error, tail(values[self.time]) / float(values[self.time, -1]))


def _ahead(plan: list[float], span: tuple[float, float], place: float, length: float) -> float:
    """The length up to the next break of the plan, or else the one proposed."""
    near = SAME * (span[1] - span[0])
    return next((later - place for later in plan if later - place > near), length)


def _landed(plan: list[float], span: tuple[float, float], place: float) -> float:
    """The break of the plan, or the end of the span, that was aimed at, else the place itself."""
    near = SAME * (span[1] - span[0])
    return next((known for known in (*plan, span[1]) if abs(known - place) <= near), place)


def tail(force: Array) -> float:
    """What the last two of N+1 polynomials add to a force, given at the first place and the nodes."""
    return float(np.abs(chebyshev_through_zero(force.size - 1)[-2:] @ force).sum())


def _factor(error: float, settings: Settings) -> float:
    """By how much the next piece may be longer, from the error of this one; below CAUTION this was too long."""
    if error <= 0.0:
        return GROWTH
    factor = CAUTION * (error / settings.rtol) ** (-1.0 / settings.points)
    return float(min(GROWTH, max(SHRINKAGE, factor)))
