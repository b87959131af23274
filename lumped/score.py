"""Distances between two force histories: the paper's normalized error, "(20)" and "(21)", and more."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.history import History, read_columns
from lumped.interpolation import peak

Array = NDArray[np.float64]
POINTS = 201
# A force counts as gone when it is this share of its peak; the last row of a finished contact may hold
# rounding.
GONE, NEARLY_GONE = 1e-9, 1e-6


@dataclass(frozen=True, eq=False)
class Curve:
    """A measured force: time in s, never decreasing, and force in N, both of shape (n,)."""

    time: Array
    force: Array

    def force_at(self, time: ArrayLike) -> Array:
        """Force at other times, N: linear between the rows, zero outside them."""
        return np.asarray(np.interp(np.asarray(time, dtype=float), self.time, self.force, left=0.0, right=0.0))


@dataclass(frozen=True)
class Score:
    """How far a candidate is from a reference.

    `normalized_error`: "(20)" as a norm over a norm, on 201 points of the common time, the shorter curve
    continued by zero. The other fields: candidate/reference - 1; restitution: candidate - reference. None
    where undefined.
    """

    normalized_error: float
    peak_force: float
    peak_time: float | None
    peak_depth: float | None
    duration: float | None
    restitution: float | None
    impulse: float | None


def score(reference: History | Curve, candidate: History | Curve) -> Score:
    """Score a candidate against a reference; both start at time zero, the first touch. Raises BadInput."""
    ours, theirs = _features(candidate), _features(reference)
    if not theirs["peak_force"]:
        raise BadInput(Fault("score", "reference", "has no force above zero; accepted: a contact"))
    ratios = {name: _ratio(ours[name], theirs[name]) for name in theirs if name != "restitution"}
    e, e_reference = ours["restitution"], theirs["restitution"]
    return Score(
        normalized_error=normalized_error(reference, candidate),
        peak_force=ratios["peak_force"] or 0.0,
        peak_time=ratios["peak_time"],
        peak_depth=ratios["peak_depth"],
        duration=ratios["duration"],
        restitution=None if e is None or e_reference is None else e - e_reference,
        impulse=ratios["impulse"],
    )


def normalized_error(reference: History | Curve, candidate: History | Curve) -> float:
    """The error "(20)", "(21)": sqrt(sum (F - F_ref)^2)/sqrt(sum F_ref^2).

    Over 201 equally spaced times from zero to the later end; a curve that has ended counts as zero.
    """
    times = np.linspace(0.0, max(float(reference.time[-1]), float(candidate.time[-1])), POINTS)
    measured = reference.force_at(times)
    return float(np.linalg.norm(candidate.force_at(times) - measured) / np.linalg.norm(measured))


def read_curve(path: Path) -> Curve:
    """A measured curve: a CSV file with the columns time_s and force_N at least. Raises BadInput."""
    columns = read_columns(path, ("time_s", "force_N"))
    if np.any(np.diff(columns["time_s"]) < 0.0):
        raise BadInput(Fault(str(path), "time_s", "decreases; accepted: times in order"))
    if columns["force_N"].max() <= 0.0:
        raise BadInput(Fault(str(path), "force_N", "never above zero; accepted: compression positive"))
    return Curve(columns["time_s"], columns["force_N"])


def _features(curve: History | Curve) -> dict[str, float | None]:
    """What two curves are compared by."""
    time, force = curve.time, curve.force
    impulse = float(np.trapezoid(force, time))
    if isinstance(curve, Curve):
        top = int(np.argmax(force))
        found = {"peak_time": float(time[top]), "peak_force": float(force[top])}
        return {
            **found,
            "duration": _duration(time, force),
            "impulse": impulse,
            "peak_depth": None,
            "restitution": None,
        }
    peak_time, peak_force = peak(time, force)
    duration = _duration(time, force)
    return {
        "peak_time": peak_time,
        "peak_force": peak_force,
        "peak_depth": peak(time, curve.depth)[1],
        "duration": duration,
        "impulse": impulse,
        "restitution": None if duration is None else float(-curve.velocity[-1] / curve.velocity[0]),
    }


def _duration(time: Array, force: Array) -> float | None:
    """From the first row to the first return of the force to zero after its peak; None if it never does."""
    top = int(np.argmax(force))
    if force[-1] > NEARLY_GONE * force[top]:
        return None
    gone = force[top:] <= max(float(force[-1]), GONE * float(force[top]))
    return float(time[top + int(np.argmax(gone))] - time[0])


def _ratio(ours: float | None, theirs: float | None) -> float | None:
    return ours / theirs - 1.0 if ours is not None and theirs else None
