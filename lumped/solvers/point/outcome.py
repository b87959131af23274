"""What one contact comes to: when, how fast, how hard, how deep, how long, and how fast again."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.result.history import End
from lumped.solvers.point.contact import Contact
from lumped.solvers.point.phase import PointPhase
from lumped.solvers.point.track import PointTrack

Array = NDArray[np.float64]
# Half the widths of the quartics through which a peak is found, in that of its surroundings, and their points.
CLOSER = (0.5, 0.1, 0.03)
FIVE = np.linspace(0.0, 1.0, 5)
QUARTIC = np.linalg.inv(np.vander(FIVE, increasing=True))
NEWTONS = 8


class Outcome(NamedTuple):
    """One contact in SI units; `start` and `peak_time` since first touch; None where it did not end."""

    start: float
    duration: float | None
    velocity: float
    restitution: float | None
    peak_force: float
    peak_time: float
    peak_depth: float


def outcome_of(track: PointTrack, one: Contact) -> Outcome:
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


def peak_of(track: PointTrack, one: Contact) -> tuple[float, float]:
    """Time, s, and height, N, of the highest force of a contact."""
    steps = [(phase, step) for phase in one.phases for step in phase.steps]
    ends = one.start_time + np.cumsum([step.length for _, step in steps])
    i = int(np.argmax([step.force.max() for _, step in steps]))
    force = steps[i][1].force
    rising = force.argmax() == force.size - 1 and steps[i][1].last_slope(force) > 0.0
    k = i + 1 if rising and i + 1 < len(steps) else i
    phase, step = steps[k]
    touch = track.touching(one)
    places = ends[k] - step.length * (1.0 - np.append(0.0, step.nodes.points))
    return max((one.start_time, touch), _vertex(track, phase, places), key=lambda peak: peak[1])


def _vertex(track: PointTrack, phase: PointPhase, places: Array) -> tuple[float, float]:
    """The highest force between the first and the last of ascending places: the top of ever narrower quartics."""
    values = track.pressed(phase, places)[2]
    i = int(np.argmax(values))
    first, last = float(places[max(i - 1, 0)]), float(places[min(i + 1, places.size - 1)])
    time, height = 0.5 * (first + last), 0.0
    for share in CLOSER:
        left, right = max(time - share * (last - first), first), min(time + share * (last - first), last)
        place, height = _top(track.pressed(phase, left + (right - left) * FIVE)[2])
        time = left + (right - left) * place
    return time, height


def _top(values: Array) -> tuple[float, float]:
    """The place in [0, 1] and the height of the top of the quartic with these values at FIVE, by Newton's method."""
    c = (QUARTIC @ values).tolist()
    place, height = float(FIVE[values.argmax()]), float(values.max())
    for _ in range(NEWTONS):
        tilt = c[1] + place * (2.0 * c[2] + place * (3.0 * c[3] + place * 4.0 * c[4]))
        bent = 2.0 * c[2] + place * (6.0 * c[3] + place * 12.0 * c[4])
        following = min(max(place - tilt / bent, 0.0), 1.0) if bent < 0.0 else place
        if following == place:
            break
        place = following
    return place, max(height, c[0] + place * (c[1] + place * (c[2] + place * (c[3] + place * c[4]))))
