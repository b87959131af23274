"""Section 4.3: a force cut at a plateau, which lasts until the impulse is the uncut one's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.result.history import History
from lumped.result.score import Curve

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PlateauCut:
    """The cut force, and what the cut changes: duration, s, and impulse, N s, before and after."""

    curve: Curve
    duration: tuple[float, float]
    impulse: tuple[float, float]


def plateau_cut(history: History, plateau: float) -> PlateauCut:
    """The force of `history` until it first reaches `plateau`, N, then flat until the areas are equal.

    The area is the impulse, so the striker leaves as fast as without the cut. Raises BadInput for a plateau that
    the force does not reach.
    """
    time, force = np.asarray(history.time), np.asarray(history.force)
    if not force[0] < plateau < force.max():
        accepted = f"accepted: between the first force {force[0]:.6g} N and the peak {force.max():.6g} N"
        raise BadInput(Fault("plateau cut", "plateau", f"{plateau:.6g} N; {accepted}"))
    i = int(np.argmax(force >= plateau))
    reached = float(np.interp(plateau, force[i - 1 : i + 1], time[i - 1 : i + 1]))
    rising = np.append(time[:i], reached), np.append(force[:i], plateau)
    whole, before = _impulse(time, force), _impulse(*rising)
    end = reached + (whole - before) / plateau
    curve = Curve(np.append(rising[0], [end, end]), np.append(rising[1], [plateau, 0.0]))
    durations = float(time[-1] - time[0]), end - float(time[0])
    return PlateauCut(curve, durations, (whole, _impulse(curve.time, curve.force)))


def _impulse(time: Array, force: Array) -> float:
    return float(np.trapezoid(force, time))
