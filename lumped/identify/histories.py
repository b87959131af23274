"""Several measured histories together against Ting's exact law: residuals over the noise, and their slopes.

What is sought is one row of numbers: the places of the free keys, and for every curve its touch in shares of the
pulse's width. A touch costs no impact: the same force is read at other times.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.fit.measured import means
from lumped.identify.keys import FreeKey, SceneFile
from lumped.laws import ting
from lumped.laws._hereditary import once
from lumped.numbers import Array
from lumped.result.gate import MeasuredPulse
from lumped.result.history import LEAST_ROWS, History
from lumped.result.noise import coloured, whitened
from lumped.result.score import Curve
from lumped.scene.scene import Scene

RTOL = 1e-6  # of an impact's integration: a thousandth of the least noise that an instrument has
STEP, SHIFT = 1e-4, 1e-3  # of the differences: of a place, and of a touch over the width
FAR = 10.0  # an impact that does not exist is so many times as far from the curve as none
MOST_ROWS = 1200  # work: a smooth pulse is told by as many means of neighbouring rows as by all
BEFORE, AFTER = 2.0, 3.0  # work: widths of silence that are kept around the pulse
MARGIN = 0.1  # of the width, before touch and after the end: neither contact nor silence
EVEN = 0.01  # of a step: rows are as even as that where noise has a colour


@dataclass(frozen=True, eq=False)
class Samples:
    """The rows that are compared with: times, s, and forces, N, (n,); where the pulse begins and its width, s.

    `own`: what the curve's scene has of its own, by dotted keys.
    """

    time: Array
    force: Array
    start: float
    width: float
    peak: float
    own: Mapping[str, object]

    @classmethod
    def of(cls, curve: Curve, own: Mapping[str, object]) -> Samples:
        """The pulse of a curve with the silence around it; of many rows means of neighbours."""
        pulse = MeasuredPulse(curve.time, curve.force)
        near = curve.time >= pulse.start - BEFORE * pulse.width
        near &= curve.time <= pulse.end + AFTER * pulse.width
        time, force = curve.time[near], curve.force[near]
        together = -(-time.size // MOST_ROWS)
        return cls(means(time, together), means(force, together), pulse.start, pulse.width, pulse.peak, own)

    @property
    def step(self) -> float | None:
        """The time between rows, s; None where they are uneven."""
        steps = np.diff(self.time)
        mean = float(steps.mean())
        return mean if np.all(np.abs(steps - mean) <= EVEN * mean) else None


@dataclass(frozen=True)
class Impact:
    """One impact by Ting's law: its force, N, at times since touch, s, both (n,); and when it ends, s."""

    force: Callable[[Array], Array]
    end: float

    @classmethod
    def of(cls, scene: Scene) -> Impact:
        """Raises BadInput, NotReached."""
        answer = once(scene, RTOL, ting.solve)
        end = float(answer.times[-1])

        def force(time: Array) -> Array:
            inside = (time >= 0.0) & (time <= end)
            found = np.zeros(time.size)
            found[inside] = answer.columns.force(time[inside])
            return found

        return cls(force, end)

    def corrected(self, by: Correction) -> Impact:
        """The same with the difference that a reference makes."""
        return Impact(lambda time: self.force(time) + by.at(time), max(self.end, float(by.time[-1])))


@dataclass(frozen=True, eq=False)
class Correction:
    """What a reference's force is beyond the law's, N, and its bar, N, at times since touch, s, (n,)."""

    time: Array
    force: Array
    bar: Array

    @classmethod
    def of(cls, history: History, impact: Impact) -> Correction:
        """At the history's rows, and as many more as a law has that lasts longer."""
        time = np.union1d(history.time, np.linspace(0.0, max(impact.end, float(history.time[-1])), LEAST_ROWS))
        bar = np.interp(time, history.time, history.force_error)
        return cls(time, history.force_at(time) - impact.force(time), bar)

    def at(self, time: Array) -> Array:
        """The difference at other times since touch, N, (n,)."""
        return np.interp(time, self.time, self.force, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Noise:
    """Of one curve: the deviation of what is new in every row, N, and the colour, see :mod:`lumped.result.noise`.

    `silences`: what told the colour, N, each (n,); none where it is known, or white for want of rows.
    """

    deviation: float
    colour: Array
    silences: tuple[Array, ...] = ()


@dataclass(frozen=True, eq=False)
class Histories:
    """The curves, the scene's file and its free keys; what is known of the noise of each curve.

    `corrections`: what a reference adds to the law's force of every curve; none: the law's alone. `filtered`: whether
    the low pass that coloured the noise has filtered the force too.
    """

    file: SceneFile
    keys: tuple[FreeKey, ...]
    samples: tuple[Samples, ...]
    noises: tuple[Noise, ...]
    filtered: bool = False
    corrections: tuple[Correction, ...] = ()
    known: dict[bytes, tuple[Impact, ...] | None] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """How many numbers are sought."""
        return len(self.keys) + len(self.samples)

    @property
    def rows(self) -> int:
        """How many residuals there are."""
        return sum(s.time.size - n.colour.size for s, n in zip(self.samples, self.noises, strict=True))

    @property
    def freedom(self) -> int:
        """Residuals less what is sought."""
        return self.rows - self.size

    def impacts(self, places: Array) -> tuple[Impact, ...] | None:
        """The impact of every curve with the free keys at these places, (p,); None where one does not exist."""
        key = places.tobytes()
        if key not in self.known:
            try:
                every = tuple(map(Impact.of, self.scenes(places)))
                pairs = zip(every, self.corrections, strict=True) if self.corrections else ()
                self.known[key] = tuple(impact.corrected(by) for impact, by in pairs) or every
            except (BadInput, NotReached):
                self.known[key] = None
        return self.known[key]

    def scenes(self, places: Array) -> list[Scene]:
        """The scene of every curve with the free keys at these places, (p,). Raises BadInput."""
        return [self.file.scene(self.keys, places, one.own) for one in self.samples]

    def touches(self, sought: Array) -> list[float]:
        """When the bodies of each curve meet, s."""
        shares = sought[len(self.keys) :].tolist()
        return [one.start + share * one.width for one, share in zip(self.samples, shares, strict=True)]

    def differences(self, sought: Array) -> list[Array]:
        """Measured less computed force of every curve, N, each (n,)."""
        impacts = self.impacts(sought[: len(self.keys)])
        if impacts is None:
            return [FAR * one.force for one in self.samples]
        every = zip(self.samples, impacts, self.touches(sought), self.noises, strict=True)
        return [one.force - self.seen(impact.force(one.time - touch), noise) for one, impact, touch, noise in every]

    def seen(self, force: Array, noise: Noise) -> Array:
        """A force at the rows of a curve, (n,), N, as the instrument with this noise shows it."""
        return coloured(force, noise.colour) if self.filtered else force

    def pressed(self, sought: Array) -> list[NDArray[np.bool_]]:
        """Which rows of every curve lie in the contact, or nearly, each (n,): in the others is silence."""
        impacts, found = self.impacts(sought[: len(self.keys)]) or (), list[NDArray[np.bool_]]()
        for one, touch, impact in zip(self.samples, self.touches(sought), impacts, strict=True):
            since, margin = one.time - touch, MARGIN * one.width
            found.append((since >= -margin) & (since <= impact.end + margin))
        return found

    def residuals(self, sought: Array) -> Array:
        """What noise has to explain, over its deviation, of all curves one after the other, (rows,)."""
        return np.concatenate(self.whitened(self.differences(sought)))

    def squares(self, sought: Array) -> float:
        """The sum of squares of the residuals over the noise."""
        return float(np.sum(self.residuals(sought) ** 2))

    def whitened(self, columns: Sequence[Array]) -> list[Array]:
        """Columns of every curve, N, (n, ...), seen as the noise is: without its colour, over its deviation."""
        return [
            whitened(column, noise.colour) / noise.deviation for column, noise in zip(columns, self.noises, strict=True)
        ]

    def slopes(self, sought: Array) -> Array:
        """How the residuals change with all that is sought, (rows, size)."""
        here, found = self.differences(sought), np.zeros((self.rows, self.size))
        for column in range(len(self.keys)):
            there, step = self._aside(sought, column)
            changes = [(b - a) / step for a, b in zip(here, self.differences(there), strict=True)]
            found[:, column] = np.concatenate(self.whitened(changes))
        return self._of_touches(sought, found)

    def _aside(self, sought: Array, column: int) -> tuple[Array, float]:
        """A place beside, ahead or where no impact exists there behind, and how far."""
        for step in (STEP, -STEP):
            there = sought.copy()
            there[column] += step
            if self.impacts(there[: len(self.keys)]) is not None:
                break
        return there, step

    def _of_touches(self, sought: Array, found: Array) -> Array:
        """The slopes with those of the touches filled in, of each curve in its own rows."""
        impacts, first = self.impacts(sought[: len(self.keys)]), 0
        for i, (one, noise) in enumerate(zip(self.samples, self.noises, strict=True)):
            rows = slice(first, first + one.time.size - noise.colour.size)
            first = rows.stop
            if impacts is not None:
                time, shift = one.time - self.touches(sought)[i], SHIFT * one.width
                change = (impacts[i].force(time + shift) - impacts[i].force(time - shift)) / (2.0 * SHIFT)
                change = self.seen(change, noise)
                found[rows, len(self.keys) + i] = whitened(change, noise.colour) / noise.deviation
        return found
