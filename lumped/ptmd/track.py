"""The whole motion: its phases in a row, and what is read off them between the rows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.equations import Equations
from lumped.ptmd.phase import PtmdPhase

Array = NDArray[np.float64]
# Rows miss the top of a vibration by no more than this share of it.
ROW_LOSS = 0.01
NEAREST = 1e-7  # share of two rows to which a top is located; its height errs by the square


@dataclass(frozen=True, eq=False)
class PtmdTrack:
    """Phases that follow one another from t = 0."""

    equations: Equations
    phases: tuple[PtmdPhase, ...]

    @property
    def end(self) -> float:
        """Last instant, s."""
        return self.phases[-1].end

    @cached_property
    def times(self) -> Array:
        """Times of all rows, s, shape (k,); twice at a switch, where a force may jump."""
        return np.concatenate([phase.times for phase in self.phases])

    @cached_property
    def states(self) -> Array:
        """States of all rows, shape (size, k)."""
        return np.concatenate([phase.states for phase in self.phases], axis=1)

    @cached_property
    def _starts(self) -> Array:
        return np.array([phase.start for phase in self.phases])

    def rows(self, reading: Callable[[PtmdPhase, Array], Array]) -> Array:
        """A reading of every row: `reading` maps a phase and its states (size, ...) to (...)."""
        return np.concatenate([reading(phase, phase.states) for phase in self.phases])

    def at(self, time: float) -> Array:
        """The state at a time, s, shape (size,)."""
        return self.phases[max(int(np.searchsorted(self._starts, time, side="right")) - 1, 0)].at(time)

    def integrals(self, time: float) -> Array:
        """Integrals of the equations' integrands from 0 to a time, s, shape (6,)."""
        parts = [phase.integrals(min(time, phase.end)) for phase in self.phases if phase.start < time]
        return np.asarray(np.sum(parts, axis=0))

    def highest(self, reading: Callable[[PtmdPhase, Array], Array]) -> float:
        """The largest value of a reading of all phases, between the rows too."""
        tops = [float(np.max(reading(phase, phase.states))) for phase in self.phases]
        least = max(tops) - ROW_LOSS * abs(max(tops))
        near = [phase for phase, top in zip(self.phases, tops, strict=True) if top >= least]
        return max(highest_of(phase, reading) for phase in near)

    @cached_property
    def turns(self) -> list[float]:
        """Times at which the structure turns, s, ascending, with both ends of the motion."""
        from scipy.optimize import brentq

        back = np.signbit(self.states[1])
        pairs = ((self.times[i], self.times[i + 1]) for i in np.flatnonzero(back[:-1] != back[1:]))
        between = (float(brentq(lambda time: self.at(time)[1], low, high, xtol=1e-13)) for low, high in pairs)
        return sorted([0.0, *between, self.end])

    def last_above(self, level: float) -> float | None:
        """When |x1| exceeds a level, m, for the last time, s; None while it still does at the end."""
        from scipy.optimize import brentq

        turns = self.turns
        heights = [float(self.at(time)[0]) for time in turns]
        above = [i for i, height in enumerate(heights) if abs(height) >= level]
        if not above or above[-1] == len(turns) - 1:
            return None
        sign = np.sign(heights[above[-1]])
        after, before = turns[above[-1]], turns[above[-1] + 1]
        return float(brentq(lambda time: sign * self.at(time)[0] - level, after, before, xtol=1e-13))


def highest_of(phase: PtmdPhase, reading: Callable[[PtmdPhase, Array], Array]) -> float:
    """The largest value of a reading of one phase, between the rows too."""
    from scipy.optimize import minimize_scalar

    values = reading(phase, phase.states)
    i = int(np.argmax(values))
    around = phase.times[max(i - 1, 0) : i + 2]
    width = float(around[-1] - around[0])
    if width == 0.0:
        return float(values[i])
    found = minimize_scalar(
        lambda share: -float(reading(phase, phase.at(float(around[0] + share * width)))),
        bounds=(0.0, 1.0),
        method="bounded",
        options={"xatol": NEAREST},
    )
    return max(float(values[i]), -float(found.fun))
