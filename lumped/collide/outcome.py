"""What one contact comes to: when, how fast, how hard, how deep, how long, and how fast again."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.collide.contact import Contact
from lumped.collide.phase import Phase
from lumped.collide.track import Track
from lumped.ending import End

Array = NDArray[np.float64]
# Half the widths of the parabolas through which a peak is found, in that of its surroundings.
CLOSER = (0.5, 0.1, 0.02, 0.004, 0.0008)


class Outcome(NamedTuple):
    """One contact in SI units; `start` and `peak_time` since first touch; None where it did not end."""

    start: float
    duration: float | None
    velocity: float
    restitution: float | None
    peak_force: float
    peak_time: float
    peak_depth: float


def outcome_of(track: Track, one: Contact) -> Outcome:
    """The outcome of one contact of a track."""
    separated = one.end is End.SEPARATED
    peak_time, peak_force = peak_of(track, one)
    return Outcome(
        one.start_time,
        one.end_time - one.start_time if separated else None,
        one.first.rate,
        -one.last.rate / one.first.rate if separated and one.first.rate > 0.0 else None,
        peak_force,
        peak_time,
        one.deepest,
    )


def peak_of(track: Track, one: Contact) -> tuple[float, float]:
    """Time, s, and height, N, of the highest force of a contact."""
    steps = [(phase, step) for phase in one.phases for step in phase.steps]
    ends = one.start_time + np.cumsum([step.length for _, step in steps])
    i = int(np.argmax([step.force.max() for _, step in steps]))
    force = steps[i][1].force
    rising = force.argmax() == force.size - 1 and steps[i][1].last_slope(force) > 0.0
    k = i + 1 if rising and i + 1 < len(steps) else i
    phase, step = steps[k]
    touch = float(track.pressed(one.phases[0], np.array([one.start_time]))[2, 0])
    places = ends[k] - step.length * (1.0 - np.append(0.0, step.nodes.points))
    return max((one.start_time, touch), _vertex(track, phase, places), key=lambda peak: peak[1])


def _vertex(track: Track, phase: Phase, places: Array) -> tuple[float, float]:
    """The highest force between the first and the last of ascending places: the vertex of ever smaller parabolas."""
    values = track.pressed(phase, places)[2]
    i = int(np.argmax(values))
    time, height = float(places[i]), float(values[i])
    width = float(places[min(i + 1, places.size - 1)] - places[max(i - 1, 0)])
    for share in CLOSER:
        left, right = max(time - share * width, float(places[0])), min(time + share * width, float(places[-1]))
        trio = np.array([left, 0.5 * (left + right), right])
        low, middle, high = (float(force) for force in track.pressed(phase, trio)[2])
        bent, tilt = low - 2.0 * middle + high, low - high
        if bent < 0.0 and abs(tilt) < -2.0 * bent:
            shift, height = 0.5 * tilt / bent, middle - 0.125 * tilt**2 / bent
        else:
            shift, height = (-1.0, low) if tilt > 0.0 else (1.0, high)
        time = 0.5 * (left + right) + 0.5 * shift * (right - left)
    return time, height
