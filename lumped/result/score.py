"""Distances between two force histories: the paper's normalized error, "(20)" and "(21)", and more."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, peak, running_integral
from lumped.result.history import ForceOverTime, History
from lumped.schema.shown import html_table

POINTS = 201  # equally spaced times at which two curves are compared
GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)  # shares of an interval: exact for the square of a line
# A force counts as gone when it is this share of its peak; the last row of a finished contact may hold
# rounding.
GONE, NEARLY_GONE = 1e-9, 1e-6
RATIOS = ("peak_time", "peak_depth", "duration", "impulse", "work")
DIFFERENCES = ("restitution", "loss", "peak_shift")
NO_MOTION: dict[str, float | None] = dict.fromkeys(("peak_depth", "restitution", "work", "loss"))


@dataclass(frozen=True, eq=False)
class Curve(ForceOverTime):
    """A measured force: time in s, never decreasing, and force in N, both of shape (n,).

    `remarks`: what was guessed when it was read, as units; `units`: those of its file, of time and force.
    """

    time: Array
    force: Array
    remarks: tuple[str, ...] = ()
    units: tuple[str, str] = ("s", "N")


@dataclass(frozen=True)
class Score:
    """How far a candidate is from a reference.

    `normalized_error`: "(20)" as a norm over a norm, on 201 points of the common time, the shorter curve
    continued by zero; `shape`: the same ratio after both are scaled to unit peak and unit duration. Candidate/reference
    - 1: peak_force, peak_time, peak_depth, duration, impulse, and `work`, int F d depth up to the greatest depth.
    Candidate - reference: restitution; `loss`, the share of that work which the rebound does not give back;
    `peak_shift`, the peak's time over the duration. None where undefined.
    """

    normalized_error: float
    peak_force: float
    peak_time: float | None
    peak_depth: float | None
    duration: float | None
    restitution: float | None
    impulse: float | None
    work: float | None
    loss: float | None
    shape: float | None
    peak_shift: float | None

    def __repr__(self) -> str:
        return "\n".join(f"{name:16s} {said}" for name, said in self._lines())

    def _repr_html_(self) -> str:
        return html_table(("compared", "candidate against reference"), self._lines())

    def _lines(self) -> Iterator[tuple[str, str]]:
        """Every comparison in per cent, the restitution as it is."""
        for name, value in vars(self).items():
            share = value if value is None or name == "restitution" else 100.0 * value
            yield name, "undefined" if share is None else f"{share:+.4g}{'' if name == 'restitution' else ' %'}"


def score(reference: History | Curve, candidate: History | Curve) -> Score:
    """Score a candidate against a reference; both start at time zero, the first touch. Raises BadInput."""
    ours, theirs = _features(candidate), _features(reference)
    if not theirs["peak_force"]:
        raise BadInput(Fault("score", "reference", "has no force above zero; accepted: a contact"))
    return Score(
        normalized_error=normalized_error(reference, candidate),
        peak_force=_ratio(ours["peak_force"], theirs["peak_force"]) or 0.0,
        **{name: _ratio(ours[name], theirs[name]) for name in RATIOS},
        **{name: _difference(ours[name], theirs[name]) for name in DIFFERENCES},
        shape=_shape_error(reference, candidate, theirs, ours),
    )


def normalized_error(reference: History | Curve, candidate: History | Curve) -> float:
    """The error "(20)", "(21)": sqrt(sum (F - F_ref)^2)/sqrt(sum F_ref^2).

    Over 201 equally spaced times from zero, or from the first of both where that is later, to the later end; a curve
    that has ended counts as zero. Infinite where the candidate lasts so long that none of them meets the reference.
    """
    first = max(0.0, min(float(reference.time[0]), float(candidate.time[0])))
    times = np.linspace(first, max(float(reference.time[-1]), float(candidate.time[-1])), POINTS)
    measured = reference.force_at(times)
    size = float(np.linalg.norm(measured))
    return float(np.linalg.norm(candidate.force_at(times) - measured)) / size if size else np.inf


def _features(curve: History | Curve) -> dict[str, float | None]:
    """What two curves are compared by."""
    time, force = curve.time, curve.force
    peak_time, peak_force = peak(time, force) if isinstance(curve, History) else _top(time, force)
    duration = _duration(time, force)
    found = {
        "peak_time": peak_time,
        "peak_force": peak_force,
        "duration": duration,
        "impulse": float(np.trapezoid(force, time)),
        "peak_shift": (peak_time - float(time[0])) / duration if duration else None,
    }
    return found | (_motion_of(curve, duration) if isinstance(curve, History) else NO_MOTION)


def _motion_of(history: History, duration: float | None) -> dict[str, float | None]:
    """What needs the depth: None where the bodies do not part."""
    work = running_integral(history.force, history.depth)
    given, ended = float(work[int(np.argmax(history.depth))]), duration is not None
    return {
        "peak_depth": peak(history.time, history.depth)[1],
        "restitution": float(-history.velocity[-1] / history.velocity[0]) if ended else None,
        "work": given,
        "loss": float(work[-1]) / given if ended and given > 0.0 else None,
    }


def _top(time: Array, force: Array) -> tuple[float, float]:
    """The highest row: between the rows of a measurement nothing is known."""
    top = int(np.argmax(force))
    return float(time[top]), float(force[top])


def _shape_error(
    reference: History | Curve,
    candidate: History | Curve,
    theirs: dict[str, float | None],
    ours: dict[str, float | None],
) -> float | None:
    """The error "(20)" of the two curves over their durations and peaks; None where one does not end."""
    if not theirs["duration"] or not ours["duration"] or not ours["peak_force"]:
        return None
    return normalized_error(_unit(reference, theirs), _unit(candidate, ours))


def _unit(curve: History | Curve, features: dict[str, float | None]) -> Curve:
    """The curve from touch on, time over duration, force over peak."""
    time = (curve.time - curve.time[0]) / (features["duration"] or 1.0)
    return Curve(time, curve.force / (features["peak_force"] or 1.0))


def _duration(time: Array, force: Array) -> float | None:
    """From the first row to the first return of the force to zero after its peak; None if it never does."""
    top = int(np.argmax(force))
    if force[-1] > NEARLY_GONE * force[top]:
        return None
    gone = force[top:] <= max(float(force[-1]), GONE * float(force[top]))
    return float(time[top + int(np.argmax(gone))] - time[0])


def _ratio(ours: float | None, theirs: float | None) -> float | None:
    return ours / theirs - 1.0 if ours is not None and theirs else None


def _difference(ours: float | None, theirs: float | None) -> float | None:
    return None if ours is None or theirs is None else ours - theirs


def distance(force: Callable[[Array], Array], other: Callable[[Array], Array], knots: Array) -> float:
    """Norm over time of the difference over that of `force`, both straight between `knots` (k,), s, ascending.

    Two knots of one time stand where a force jumps.
    """
    lengths = np.diff(knots)[:, None]
    places = knots[:-1, None] + lengths * GAUSS
    known = force(places)
    return float(np.sqrt(np.sum(lengths * (other(places) - known) ** 2) / np.sum(lengths * known**2)))
