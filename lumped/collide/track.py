"""Depth, rate and force of a motion at any times, from the polynomials of its steps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lumped.collide.bodies import PointLaw
from lumped.collide.contact import Contact
from lumped.collide.motion import Motion
from lumped.collide.phase import Phase
from lumped.collide.step import NODES, STAGES

Array = NDArray[np.float64]


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
        for phase in self._phases:
            inside = (times >= phase.start_time) & (times <= phase.end_time)
            if inside.any():
                found[:, inside] = self._pressed(phase, times[inside])
        return found

    @property
    def _phases(self) -> list[Phase]:
        return [phase for contact in self.motion.contacts for phase in contact.phases]

    def _fly(self, found: Array, times: Array, contact: Contact) -> None:
        """Free flight from the end of a contact on, until a later one overwrites it."""
        after = times > contact.end_time
        elapsed = times[after] - contact.end_time
        last, gravity = contact.last, self.motion.gravity
        found[0, after] = last.depth + elapsed * (last.rate + 0.5 * gravity * elapsed)
        found[1, after] = last.rate + gravity * elapsed
        found[2, after] = 0.0

    def _pressed(self, phase: Phase, times: Array) -> Array:
        """The columns within one stage."""
        lengths = np.array([step.length for step in phase.steps])
        starts = phase.start_time + np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
        place = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, starts.size - 1)
        length = lengths[place]
        share = np.clip((times - starts[place]) / length, 0.0, 1.0)
        series = np.array([NODES.series @ step.acceleration for step in phase.steps])
        basis = legendre.legvander(2.0 * share - 1.0, STAGES + 1)
        once = np.einsum("ij,ij->i", basis[:, :-1], (series @ NODES.first)[place])
        twice = np.einsum("ij,ij->i", basis, (series @ NODES.second)[place])
        begun = np.array([step.start[:2] for step in phase.steps])[place]
        rate = begun[:, 1] + length * once
        depth = begun[:, 0] + length * (begun[:, 1] * share + length * np.where(share > 0.0, twice, 0.0))
        return np.array([depth, rate, self.law.between(phase.steps, place, share, depth, rate, phase.stage)])
