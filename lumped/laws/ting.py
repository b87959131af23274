"""Ting 1966: the exact impact on a viscoelastic half-space, doi 10.1115/1.3625192.

Contact that grows and shrinks once; the approach is that of the correspondence law, the rebound its own.

The rebound is exact where an overlap o(depth) of the surfaces goes straight with the depth. In a ring it bends: since
the earlier time t1 at which the contact was as wide it has left an impression
    o'' M,   M = int_{t1}^t E(t-s) (depth(s) - depth(t1)) d depth(s) ,
which presses on the held contact. To first order that counts as an error of the law.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lumped.laws._hereditary import SAFETY, Course, HereditaryLaw, Solve, simulation
from lumped.laws.base import LawKind, check_load_curve, waves
from lumped.materials import Relaxation
from lumped.numbers import Array, running_integral
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.solvers.hereditary import rebound as back
from lumped.solvers.hereditary.approach import approach
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import ByField, HereditaryPhase, SinceTouch
from lumped.solvers.hereditary.pieces import DEPTH, Followed
from lumped.solvers.hereditary.problem import Hereditary

ROWS, LOOKS = 60, 9  # of the rebound, and depths, at which what overlaps bend by is told


@dataclass(frozen=True)
class Ting(HereditaryLaw):
    """The law; everything it needs is in the scene."""

    name: ClassVar[str] = "ting"

    @property
    def solve(self) -> Solve:
        """That of the whole contact."""
        return solve

    def simulation(self, scene: Scene, tolerance: float, dense: bool = True) -> Followed[Result]:
        """One impact to this tolerance. Raises NotReached."""
        return simulation(self.name, scene, tolerance, solve, bent, dense)


def of(scene: Scene) -> Ting:
    """The law for a scene: every target with a load curve has it. Raises BadInput for one without."""
    check_load_curve(scene, Ting.name)
    scene.check_single(Ting.name)
    return Ting()


def solve(problem: Hereditary, end_time: float, settings: Settings, before: Course | None = None) -> Followed[Course]:
    """One integration from touch to the end of contact, or to `end_time` in its own units. Raises NotReached."""
    inward = yield from approach(problem, end_time, settings, before.inward if before else None)
    growing = HereditaryPhase(inward.path, SinceTouch(), DEPTH, DEPTH)
    if not inward.turned:
        return Course((growing,), End.REST if inward.rests else End.TIME, inward.steps, inward)
    known = before.outward if before and isinstance(before.outward, back.Rebound) else None
    outward = yield from back.rebound(problem, inward, end_time, settings, known)
    shrinking = HereditaryPhase(outward.path, ByField(outward.path), back.DEPTH, back.EDGE)
    return Course((growing, shrinking), outward.end, inward.steps + outward.steps, inward, outward)


def bent(problem: Hereditary, course: Course) -> tuple[dict[str, float], float]:
    """To first order, what overlaps that bend with the depth make of the quantities, and of the force, N; SI."""
    scales, deepest = problem.scales, float(course.phases[0].last[0])
    if len(course.phases) == 1 or not problem.curve.bending(scales.depth * deepest):
        return {}, 0.0
    back = _Back.of(problem, course)
    rows = np.unique(np.linspace(back.turn + 1, back.times.size - 1, ROWS).astype(int))
    time, edge = back.times[rows], back.edge[rows]
    left = np.array([back.felt(0.5 * (back.depth - back.edge[i]) ** 2, i) for i in rows])
    pressed = np.abs(left * _bending(problem, edge, deepest))
    speed = running_integral(pressed, time)
    moved = np.interp(back.times, time, running_integral(speed, time))
    felt = np.array([back.felt(moved, i) for i in rows])
    force = pressed + problem.loads(edge)[1] * felt
    closing = (back.felt(back.depth, rows[-1], 0.0) - back.felt(back.depth, rows[-2], 0.0)) / (time[-1] - time[-2])
    norm = np.trapezoid(course.force(back.times) ** 2, back.times)
    errors = {
        "duration": scales.time * float(felt[-1] / abs(closing)),
        "restitution": float(speed[-1]),
        "impulse": scales.mass * scales.velocity * float(speed[-1]),
        "history_l2": float(np.sqrt(np.trapezoid(force**2, time) / norm)),
    }
    return {name: SAFETY * error for name, error in errors.items()}, SAFETY * scales.force * float(force.max())


def _bending(problem: Hereditary, edge: Array, deepest: float) -> Array:
    """What a unit of M presses with where the contact is as wide as at the depths ``edge``, (n,)."""
    depths, unit = deepest * np.linspace(0.0, 1.0, LOOKS)[1:], problem.scales.depth**2 / problem.scales.load
    known = [unit * problem.curve.bending(problem.scales.depth * float(depth)) for depth in depths]
    return np.asarray(np.interp(edge, np.append(0.0, depths), np.append(0.0, known)))


@dataclass(frozen=True, eq=False)
class _Back:
    """A course at its times (n,): its depth, that at which the approach was as wide, and which time is the ``turn``."""

    modulus: Relaxation
    times: Array
    depth: Array
    edge: Array
    turn: int

    @classmethod
    def of(cls, problem: Hereditary, course: Course) -> _Back:
        times = np.unique(course.times)
        depth, _, _, edge = course.at(times)
        return cls(problem.modulus, times, depth, edge, int(np.searchsorted(times, course.phases[0].times[-1])))

    def felt(self, field: Array, row: int, since: float | None = None) -> float:
        """int E(t-s) d field(s) up to a row's time, of a field (n,), ``since`` the approach was as wide, or a time."""
        before, now = slice(self.turn + 1), float(self.times[row])
        start = np.interp(self.edge[row], self.depth[before], self.times[before]) if since is None else since
        places = np.concatenate([[start], self.times[(self.times > start) & (self.times < now)], [now]])
        change, length, ages = np.diff(np.interp(places, self.times, field)), np.diff(places), now - places
        mean = np.full(length.size, self.modulus.equilibrium)
        for modulus, tau in zip(self.modulus.moduli, self.modulus.times, strict=True):
            mean += modulus * tau * np.diff(np.exp(-ages / tau)) / length
        return float(mean @ change + self.modulus.viscosity * change[-1] / length[-1])


MEMBER = LawKind(of, __doc__, leaves_out=waves, seconds=0.008)
