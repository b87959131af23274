"""The frames marched from row to row; in a row from happening to happening of the gaps, each located exactly.

Rows in which every gap stays far from touch are followed many at once: nothing happens there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from lumped.errors import BadInput, Fault, NotReached
from lumped.numbers import Array
from lumped.pounding.flow import TERMS, LinearBodies, longest_row
from lumped.pounding.gaps import OPEN, FrameStep, GapEvent, GapState, Mode, after, pressed, surfaced
from lumped.pounding.ground import GroundMotion
from lumped.pounding.trial import FramesAt, FrameTrial, Rules
from lumped.solvers.point.bodies import Bodies
from lumped.solvers.radau import NODES, STAGES

MOST_ROWS = 100_000  # work: a minute and half a gigabyte
MOST_STEPS = 3000  # work: of one row, more is no motion but chatter
MOST_AHEAD = 16  # work: rows of one flight

OnTime = Callable[[float], None]  # called with the time, s, that a motion has come to


def ignore(time: float) -> None:
    """Nobody waits for it."""


class Listener(Protocol):
    """Told of all that the frames do."""

    def step(self, at: FramesAt, step: FrameStep, to: FramesAt) -> None:
        """One step: where it began, and where it led."""

    def flight(self, flight: FramesFlight) -> None:
        """Rows without any contact."""


@dataclass(frozen=True, eq=False)
class FramesFlight:
    """r rows without contact: `times` (r + 1,), s, and `states` (r + 1, 2 n) between them; `within` (r, s, 2 n) at the
    points of NODES in each, where the ground's acceleration is `ground` (r, s), m/s2.
    """

    times: Array
    states: Array
    within: Array
    ground: Array


def rows(
    frames: LinearBodies, ground: GroundMotion, end_time: float, marks: Sequence[float] = ()
) -> tuple[Array, float]:
    """Times of the rows, s, from zero to the end, no kink of the ground between two of them; the longest apart.

    The `marks`, s, before the end are among them. Raises BadInput when they are too many.
    """
    longest = longest_row(frames, ground)
    kinks = np.concatenate([ground.kinks, marks])
    kinks = kinks[(kinks > 0.0) & (kinks < end_time)]
    stops = np.unique(np.concatenate([[0.0], kinks, [end_time]]))
    counts = np.maximum(np.ceil(np.diff(stops) / longest).astype(int), 1)
    if counts.sum() > MOST_ROWS:
        most = end_time * MOST_ROWS / counts.sum()
        reason = f"more than {MOST_ROWS} rows of {longest:.2g} s; accepted: at most {most:.3g} s for these structures"
        raise BadInput(Fault("motion", "end_time", reason))
    between = [
        np.linspace(low, high, n, endpoint=False) for low, high, n in zip(stops, stops[1:], counts, strict=False)
    ]
    times = np.concatenate([*between, [end_time]])
    return times, float(np.diff(times).max())


@dataclass(frozen=True, eq=False)
class FrameMarch:
    """Rules and the ground: what moves frames from row to row."""

    rules: Rules
    ground: GroundMotion

    def run(self, times: Array, listener: Listener, gaps: Sequence[GapState] = (), on_time: OnTime = ignore) -> None:
        """From the start through all rows; `gaps`: what they do there, apart by default. Raises NotReached."""
        frames = self.rules.flow.frames
        opened = tuple(gaps) or (OPEN,) * frames.distances.size
        at, length = FramesAt(0.0, frames.start, frames.depths(frames.start), opened), math.inf
        length = min([length, *(self._first_length(i, gap) for i, gap in enumerate(at.gaps) if gap.active)])
        # A trial of Newton's method may go beyond all numbers: then the step is refused.
        i, ahead = 1, 1
        with np.errstate(all="ignore"):
            while i < times.size:
                on_time(at.time)
                flight = self._flight(at, times[i - 1 : i + ahead])
                if flight is None:
                    at, length = self._row(at, float(times[i]), length, listener)
                    i, ahead = i + 1, 1
                    continue
                listener.flight(flight)
                state = flight.states[-1]
                at, length = FramesAt(float(flight.times[-1]), state, frames.depths(state), at.gaps), math.inf
                i, ahead = i + flight.times.size - 1, min(2 * ahead, MOST_AHEAD)

    def _flight(self, at: FramesAt, times: Array) -> FramesFlight | None:
        """The rows between `times` as far as every gap stays clear of its touch; None where the first one is not."""
        if any(gap is not OPEN for gap in at.gaps):
            return None
        flow, frames, lengths = self.rules.flow, self.rules.flow.frames, np.diff(times)
        shares = (lengths[:, None, None] / flow.unit * NODES.points[:, None]) ** np.arange(TERMS + 1.0)
        grounds = np.array([self.ground.series(time, flow.unit, TERMS) for time in times[:-1].tolist()])
        states, free = [at.state], list[Array]()
        for share, ground in zip(shares, grounds, strict=True):
            free.append(flow.series(states[-1], ground))
            states.append(share[-1] @ free[-1])
        within = shares @ np.array(free)
        gapped = frames.distances.size > 0
        clear = self._clear(at, within, lengths, flow.noise(np.array(free))) if gapped else lengths.size
        if clear == 0:
            return None
        ground = np.einsum("rsk,rk->rs", shares[:clear, :, :TERMS], grounds[:clear])
        return FramesFlight(times[: clear + 1], np.array(states[: clear + 1]), within[:clear], ground)

    def _clear(self, at: FramesAt, within: Array, lengths: Array, noise: Array) -> int:
        """How many rows pass before one in which some gap comes near its touch."""
        frames = self.rules.flow.frames
        depth, rate = frames.depths(within), frames.rates(within)
        first = np.vstack([frames.depths(at.state), depth[:-1, -1]])
        reach = np.maximum(first, depth.max(axis=1)) + lengths[:, None] * np.abs(rate).max(axis=1)
        near = (reach >= -2.0 * noise).any(axis=1)
        return int(near.argmax()) if near.any() else lengths.size

    def _row(self, at: FramesAt, until: float, length: float, listener: Listener) -> tuple[FramesAt, float]:
        """To the end of a row; the length proposed for the next step, s."""
        for _ in range(MOST_STEPS):
            free = self._free(at)
            start = self._begun(at, free, until - at.time)
            fresh = [i for i, gap in enumerate(start.gaps) if gap.mode is not at.gaps[i].mode]
            length = min([length, *(self._first_length(i, start.gaps[i]) for i in fresh)])
            trial = FrameTrial(self.rules, start, free)
            step, event, length = trial.accepted(min(length, until - at.time), length)
            end = until if event is None and step.length == until - at.time else at.time + step.length
            following, length = self._after(trial, step, event, end, length)
            listener.step(start, step, following)
            at = following
            if at.time >= until:
                return at, length
        raise NotReached(f"{MOST_STEPS} steps between {until:.6g} s and the row before", "an earlier motion.end_time")

    def _free(self, at: FramesAt) -> Array:
        return self.rules.flow.series(at.state, self.ground.series(at.time, self.rules.flow.unit, TERMS))

    def _begun(self, at: FramesAt, free: Array, length: float) -> FramesAt:
        """With the depths of the gaps that are apart, which the state tells: zero where they are but for rounding.

        Those that lie at depth zero and close from here on are pressed: at rest, their first motion tells.
        """
        apart = [i for i, gap in enumerate(at.gaps) if gap.mode is Mode.APART]
        if not apart:
            return at
        flow, frames = self.rules.flow, self.rules.flow.frames
        depths, gaps, noise = at.depths.copy(), list(at.gaps), flow.noise(free)
        depths[apart] = frames.depths(at.state)[apart]
        zero = [i for i in apart if depths[i] >= -2.0 * noise[i]]
        depths[zero] = 0.0
        if zero:
            first = (length / flow.unit * NODES.points[0]) ** np.arange(1.0, TERMS + 1.0)
            moved = frames.rows @ (first @ free[1:, : flow.size])
            rates = frames.rates(at.state)
            for i in (i for i in zero if moved[i] > 2.0 * noise[i] and rates[i] >= 0.0):
                gaps[i] = pressed(self.rules.laws[i], 0.0, float(rates[i]), flow.slowest(free), at.time)
        return at._replace(depths=depths, gaps=tuple(gaps))

    def _after(
        self, trial: FrameTrial, step: FrameStep, event: GapEvent | None, time: float, length: float
    ) -> tuple[FramesAt, float]:
        """The instant where a step led, and the length of the next one, s."""
        state, gaps, depths = step.states[-1], list(trial.at.gaps), step.depth[:, -1].copy()
        for i, (gap, memory) in enumerate(zip(gaps, step.memories, strict=True)):
            if gap.passed or gap.memory != memory:
                gaps[i] = replace(gap, passed=False, memory=memory)
        if event is not None:
            i, law, before = event.gap, self.rules.laws[event.gap], gaps[event.gap]
            depth, rate = float(depths[i]), float(step.rate[i, -1])
            gaps[i], depths[i] = after(event, before, law, depth, rate, self.rules.flow.slowest(trial.free), time)
            if gaps[i].active and not before.active:
                length = min(length, self._first_length(i, gaps[i]))
        gaps = [surfaced(*one, time) for one in zip(gaps, depths.tolist(), strict=True)]
        if not any(gap.active for gap in gaps):
            length = math.inf
        return FramesAt(time, state, depths, tuple(gaps)), length

    def _first_length(self, i: int, gap: GapState) -> float:
        """Of a contact, s."""
        law, bodies = self.rules.laws[i], Bodies(float(self.rules.flow.frames.reduced_masses[i]), gap.stage.speed)
        return float(self.rules.tolerance ** (law.grading(gap.stage) / STAGES) * law.time_scale(bodies))
