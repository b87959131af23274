"""The cheap law corrected near the most likely place by a method that is nearer to the truth, as finite elements.

What the reference's force is beyond the law's changes slowly with the parameters: taken at one place it is added to the
law's force everywhere, the least squares go on from there by the law's own slopes, and it is taken anew where they end,
until they stay. A history of the reference is asked for every curve in every round, no more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from lumped.errors import NotReached
from lumped.identify.histories import Correction, Histories
from lumped.identify.profile import Valley, quantile
from lumped.identify.record import ByReference, Shift
from lumped.identify.search import descended, reweighed
from lumped.numbers import Array
from lumped.result.history import History
from lumped.scene.scene import Scene

ROUNDS = 6  # work: each asks the reference for every curve
STAYS = 0.1  # of half an interval, or of the reference's bars: a place that moves less has been found


class Reference(Protocol):
    """The history of a scene by another method, with bars. Raises BadInput, NotReached."""

    def __call__(self, scene: Scene) -> History: ...


@dataclass(frozen=True, eq=False)
class Corrected:
    """The histories with the corrections, the most likely place with them, and what is said of both."""

    histories: Histories
    valley: Valley
    told: ByReference


def correct(histories: Histories, valleys: Sequence[Valley], corner: float | None, reference: Reference) -> Corrected:
    """The likeliest valley with a law that the reference has corrected there. Raises NotReached where it moves on."""
    valley = valleys[0]
    for runs in range(1, ROUNDS + 1):
        there, found = _round(histories, valley, corner, reference)
        step, bars = np.abs(found.sought - valley.sought), _bars(there, found.sought)
        valley = found
        if runs > 1 and np.all(step <= STAYS * np.maximum(bars, _half_widths(there, found.sought))):
            told = _told(histories, valleys, there, found, bars, runs * len(there.samples))
            return Corrected(there, found, told)
    reason = f"the parameters still move after {ROUNDS} rounds of reference histories"
    raise NotReached(f"{reason}; cure: fewer free keys, or a curve that tells them better")


def _round(
    histories: Histories, valley: Valley, corner: float | None, reference: Reference
) -> tuple[Histories, Valley]:
    """The histories with what the reference says in a valley, and where their least squares end."""
    places = valley.sought[: len(histories.keys)]
    pairs = zip(histories.scenes(places), histories.impacts(places) or (), strict=True)
    corrections = tuple(Correction.of(reference(scene), impact) for scene, impact in pairs)
    there = replace(histories, corrections=corrections, known={})
    found = descended(there, valley.sought, valley.limits)
    there = reweighed(there, found.sought, corner)
    return there, descended(there, found.sought, valley.limits)


def _bars(histories: Histories, sought: Array) -> Array:
    """How far the reference's bars can move what is sought, (size,): sum_k |(J^T J)^-1 J^T|_ik bar_k, no less."""
    bars = list[Array]()
    every = zip(histories.samples, histories.noises, histories.corrections, histories.touches(sought), strict=True)
    for one, noise, by, touch in every:
        bar = np.interp(one.time - touch, by.time, by.bar, 0.0, 0.0)
        bars.append(_largest(histories.seen(bar, noise), noise.colour) / noise.deviation)
    return np.asarray(np.abs(np.linalg.pinv(histories.slopes(sought))) @ np.concatenate(bars))


def _largest(bar: Array, colour: Array) -> Array:
    """The most that is new in every row of a column within its bar, as :func:`lumped.result.noise.whitened` sees it."""
    rows = bar.size - colour.size
    found = bar[colour.size :].copy()
    for lag, a in enumerate(colour.tolist(), start=1):
        found += abs(a) * bar[colour.size - lag : colour.size - lag + rows]
    return found


def _half_widths(histories: Histories, sought: Array) -> Array:
    """Of the intervals, by the linearized residuals, (size,)."""
    spread = np.linalg.pinv(histories.slopes(sought))
    return np.asarray(math.sqrt(quantile(histories)) * np.linalg.norm(spread, axis=1))


def _told(
    histories: Histories, valleys: Sequence[Valley], there: Histories, found: Valley, bars: Array, runs: int
) -> ByReference:
    keys, before, after = histories.keys, valleys[0].sought.tolist(), found.sought.tolist()
    moved = {
        key.name: Shift(key.at(old), key.at(new), 0.5 * (key.at(new + bar) - key.at(new - bar)))
        for key, old, new, bar in zip(keys, before, after, bars.tolist(), strict=False)
    }
    pairs = zip(there.corrections, there.samples, strict=True)
    error = max(float(np.abs(by.force).max()) / one.peak for by, one in pairs)
    return ByReference(moved, error, runs, len(valleys) - 1)
