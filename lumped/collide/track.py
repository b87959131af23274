"""Depth, rate and force of a motion at any times, from the polynomials of its steps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lumped.collide.bodies import PointLaw
from lumped.collide.contact import Contact
from lumped.collide.motion import Motion
from lumped.collide.nodes import STAGES, place_of
from lumped.collide.phase import Phase
from lumped.collide.step import Step

Array = NDArray[np.float64]


class Row(NamedTuple):
    """The steps of a stage side by side, n of them: starts and lengths, s, and what their nodes are, shape (n,).

    `rates` and `depths`, shape (n, s + 1), are the Legendre coefficients of rate and depth over the place.
    """

    starts: Array
    lengths: Array
    powers: Array
    begun: Array
    mirrored: NDArray[np.bool_]
    rates: Array
    depths: Array

    @classmethod
    def of(cls, phase: Phase) -> Row:
        """Those of a phase."""
        lengths = np.array([step.length for step in phase.steps])
        starts = phase.start_time + np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
        powers = np.array([float(step.nodes.power) for step in phase.steps])
        begun = np.array([step.nodes.begun for step in phase.steps])
        mirrored = np.array([step.nodes.mirrored for step in phase.steps])
        rates = np.array([_series(step, step.gain, step.start.rate) for step in phase.steps])
        depths = np.array([_series(step, step.nodes.pace * step.rate, step.start.depth) for step in phase.steps])
        return cls(starts, lengths, powers, begun, mirrored, rates, depths)


@dataclass(frozen=True)
class Track:
    """A motion under its law, dense in time."""

    law: PointLaw
    motion: Motion

    @cached_property
    def times(self) -> Array:
        """Where its steps begin and end, s, ascending; the force may jump at touch, so the instant before is there."""
        ends = [np.cumsum([phase.start_time, *(s.length for s in phase.steps)]) for phase in self._phases]
        touches = np.array([contact.start_time for contact in self.motion.contacts[1:]])
        parted = np.array([contact.end_time for contact in self.motion.contacts[:-1]])
        return np.unique(np.concatenate([*ends, np.nextafter(touches, 0.0), np.nextafter(parted, np.inf)]))

    def __call__(self, times: Array) -> Array:
        """Depth, m, rate, m/s, and force, N, at `times`, shape (n,) from zero on: shape (3, n).

        Where two contacts or stages meet the later one speaks, but the end of a contact is its own.
        """
        found = np.zeros((3, times.size))
        for contact in self.motion.contacts:
            self._fly(found, times, contact)
        for phase, row in zip(self._phases, self._rows, strict=True):
            inside = (times >= phase.start_time) & (times <= phase.end_time)
            if inside.any():
                found[:, inside] = self._pressed(phase, row, times[inside])
        return found

    @cached_property
    def _phases(self) -> list[Phase]:
        return [phase for contact in self.motion.contacts for phase in contact.phases]

    @cached_property
    def _rows(self) -> list[Row]:
        return [Row.of(phase) for phase in self._phases]

    def _fly(self, found: Array, times: Array, contact: Contact) -> None:
        """Free flight from the end of a contact on, until a later one overwrites it."""
        after = times > contact.end_time
        elapsed = times[after] - contact.end_time
        last, gravity = contact.last, self.motion.gravity
        found[0, after] = last.depth + elapsed * (last.rate + 0.5 * gravity * elapsed)
        found[1, after] = last.rate + gravity * elapsed
        found[2, after] = 0.0

    def _pressed(self, phase: Phase, row: Row, times: Array) -> Array:
        """The columns within one stage."""
        which = np.clip(np.searchsorted(row.starts, times, side="right") - 1, 0, row.starts.size - 1)
        share = np.clip((times - row.starts[which]) / row.lengths[which], 0.0, 1.0)
        place = place_of(share, row.powers[which], row.begun[which], row.mirrored[which])
        basis = legendre.legvander(2.0 * place - 1.0, STAGES)
        rate = np.einsum("ij,ij->i", basis, row.rates[which])
        depth = np.einsum("ij,ij->i", basis, row.depths[which])
        return np.array([depth, rate, self.law.between(phase.steps, which, share, depth, rate, phase.stage)])


def _series(step: Step, slope: Array, start: float) -> Array:
    """The coefficients of what begins at `start` and has this slope over the place, times the length."""
    series = step.length * (step.nodes.series @ slope @ step.nodes.first)
    series[0] += start
    return series
