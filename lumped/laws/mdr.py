"""The method of dimensionality reduction: the half-space exactly, by a row of springs (numpy only)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from lumped.errors import BadInput, Fault, NotReached
from lumped.laws._assembly import Answer, assemble, bars, values_of, wider
from lumped.laws.base import LawKind, check_geometry, check_half_space, waves
from lumped.numbers import Array, Clock, local, peak
from lumped.result.history import End
from lumped.result.result import Quantity, Result, largest_bar, meets
from lumped.scene.scene import Scene
from lumped.solvers.mdr.nest import (
    Level,
    Nest,
    alike,
    coarse,
    coarse_beyond,
    limit,
    pace_of,
    predicted_turn,
    problem_of,
    shrinks_until,
)

# Of the fields of Instant the force, and those which are seen: depth, velocity, force, edge.
FORCE, SEEN = 4, [1, 2, 4, 5]
# Steps of the first march's approach, whatever the tolerance: a tighter one begins with the marches of a looser one
# and goes on from there, so it never costs less. With eight, three marches bring 1e-3 mostly. Where they lie a march of
# more elements says: one of eight would make them uneven, and many finer ones needed.
INTERVALS, ELEMENTS = 8, 16
MOST_PARTS = 512  # 4096 steps, which err by rounding
# So many marches of which none halves the widest bar that was before, while the history is known as well as asked:
# what is left of that bar is rounding.
STALLED, NO_BETTER = 2, 0.5
# Rows through which the polynomials of a rebound run that goes on beyond the end.
ROWS_BEYOND = 6
# Did limits of two err by h^2 alone, that of three would err by a third of what it differs from the first. A force that
# begins like t^(1/n), of a dashpot under a profile r^n, errs more at once, and so does a peak between coarse rows.
SAFETY = 2.0


@dataclass(frozen=True)
class ImpactScales:
    """Scales of one impact: m, m, N, and s for the times. `end` is the last time followed.

    `duration` and `restitution` are None without separation before the scene's end time.
    """

    contact_radius: float
    peak_depth: float
    peak_force: float
    peak_time: float
    end: float
    duration: float | None
    restitution: float | None


@dataclass(frozen=True)
class SpringRow:
    """The row of springs as a law; everything it needs is in the scene."""

    name: ClassVar[str] = "mdr"
    needs_mass: ClassVar[bool] = True

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """One impact, the steps cut until every bar is within the tolerance. Raises NotReached."""
        clock = Clock()
        problem = problem_of(scene)
        track, stop = coarse_beyond(problem, scene.end_time, ELEMENTS)
        nest = Nest.around(problem, stop, track, pace_of(problem, stop, ELEMENTS), INTERVALS)
        if stop > scene.end_time:
            nest = replace(nest, cut=scene.end_time)
        shrinks = None if track.end is End.SEPARATED else shrinks_until(problem, scene.end_time, ELEMENTS)
        again = shrinks is not None
        if shrinks is not None:
            nest = replace(nest, end_time=shrinks or stop, turns=not shrinks, cut=None)
        nest, level, before = nest.begun(track.approach[-1].time)
        levels, limits, widest, parts, steps = [level], list[Level](), list[float](), 1, level.steps
        answer = None
        while parts < MOST_PARTS:
            parts *= 2
            turn = predicted_turn(before, levels[-1].turn)
            before = levels[-1].turn
            level = nest.level(parts, turn)
            steps += level.steps
            if not alike(levels[-1], level):  # the coarser one has missed what comes just before the end time
                levels, limits, answer = [level], [], None
                continue
            levels.append(level)
            limits.append(limit(levels[-2], levels[-1], 2))
            if len(limits) > 1:
                answer, quantities, force_error = _judged(scene, levels[-3:], limits[-2:], again)
                widest.append(largest_bar(quantities))
                known = (quantities["history_l2"].error or 0.0) <= tolerance
                if meets(quantities, tolerance) or (known and _stalled(widest)):
                    break
        if answer is None:
            raise NotReached("finer and coarser steps of the spring row end differently", "a later motion.end_time")
        work = {"steps": steps, "springs": levels[-1].approach.shape[1]}
        numerics = {"levels": len(levels), "parts": parts}
        return assemble(self.name, scene, tolerance, answer, quantities, force_error, clock, numerics, work)


def of(scene: Scene) -> SpringRow:
    """The law for a scene: every half-space has it. Raises BadInput without geometry, and for a fixed contact area."""
    check_geometry(scene, SpringRow.name)
    check_half_space(scene, SpringRow.name)
    scene.check_single(SpringRow.name)
    if scene.profile.flat_radius > 0.0:
        reason = "its springs touch all at once; accepted: ting"
        raise BadInput(Fault(scene.source, "striker.shape", f"{scene.profile.name}: {reason}"))
    return SpringRow()


def estimate(scene: Scene, elements: int = 70) -> ImpactScales:
    """Scales of the impact from one coarse march, good to about 1/elements^2. Raises NotReached."""
    track = coarse(problem_of(scene), scene.end_time, elements)
    fields = np.array(track.approach + track.rebound).T
    time, depth, velocity, _, force, edge = fields
    separated = track.end is End.SEPARATED
    return ImpactScales(
        contact_radius=float(edge.max()),
        peak_depth=float(depth.max()),
        peak_force=float(force.max()),
        peak_time=float(time[force.argmax()]),
        end=float(time[-1]),
        duration=float(time[-1]) if separated else None,
        restitution=float(-velocity[-1]) / scene.velocity if separated else None,
    )


def _judged(
    scene: Scene, levels: Sequence[Level], limits: Sequence[Level], again: bool
) -> tuple[Answer, dict[str, Quantity], float]:
    """The answer of three marches and their two limits, its quantities with bars, and the bar of the force, N."""
    answer = _answer(scene, limit(limits[0], limits[1], 4), again)
    quantities, force_error = bars(answer, _answer(scene, limits[0], again), SAFETY)
    marches = [_answer(scene, level, again) for level in levels]
    quantities = wider(quantities, _without_order(quantities, [march.values for march in marches]))
    # Steps cut by an end that no whole step follows err by no even power: limits may gain nothing on the
    # finest march. The one before it errs about four times as much.
    if any(level.within_step for level in levels):
        others, least = bars(answer, marches[1], 1.0)
        quantities, force_error = wider(quantities, others), max(force_error, least)
    return answer, quantities, force_error


def _without_order(
    quantities: Mapping[str, Quantity], marches: Sequence[Mapping[str, float | None]]
) -> dict[str, Quantity]:
    """The quantities with bars for what three marches do not tell by h^2 yet, finer and finer by halves.

    A peak between coarse rows may err by no power, and two limits then agree by chance. Where marches err by h^2, the
    first two differ four times as much as the last two. The share by which they do not, squared because limits take
    away two orders, is what the answer may still have of the finest march's error. This error is how far that march is
    from the answer, or a fourth of how far the one before is.
    """
    found = dict(quantities)
    for name, first in marches[0].items():
        value, second, third = quantities[name].value, marches[1][name], marches[2][name]
        if value is None or first is None or second is None or third is None:
            continue
        error = max(abs(third - value), abs(second - value) / 4.0)
        earlier, expected = first - second, 4.0 * (second - third)
        share = min(abs(earlier - expected) / abs(expected), 1.0) if expected else 1.0
        found[name] = replace(quantities[name], error=SAFETY * share**2 * error)
    return found


def _stalled(widest: Sequence[float]) -> bool:
    """Whether the last marches, by the widest bar after each, found nothing that the ones before had not."""
    return len(widest) > STALLED and min(widest[-STALLED:]) > NO_BETTER * min(widest[:-STALLED])


def _answer(scene: Scene, level: Level, again: bool) -> Answer:
    """The dense answer of one level, which stops because the striker approaches `again`, or as the level does."""
    end, separated = End.SECOND_APPROACH if again else level.end, level.end is End.SEPARATED
    dense, whole = _Dense(level, separated), level.approach
    if level.rebound.size:
        whole = _ascending(np.hstack([level.approach, level.rebound[:, 1:]]))
    time, (depth, velocity, force, _) = whole[0], whole[SEEN]
    if level.end is End.TIME and time[-1] > level.last:
        time = np.append(time[time < level.last], level.last)
        depth, velocity, force, _ = dense(time)
    values = values_of(scene, end, peak(time, force), float(depth.max()), float(velocity[-1]), float(time[-1]))
    said, mass = "" if separated else end.value, scene.reduced_mass
    return Answer(time, dense, values, end, _energy(scene, level), said, mass=mass)


@dataclass(frozen=True)
class _Dense:
    """Depth, velocity, force, contact radius at times (n,), shape (4, n): local cubics in the root of time."""

    level: Level
    separated: bool

    def __call__(self, times: Array) -> Array:
        columns = self._of(SEEN, times)
        columns[2:] = np.maximum(columns[2:], 0.0)
        return columns

    def force(self, times: Array) -> Array:
        """The force alone, shape (n,)."""
        return np.asarray(np.maximum(self._of([FORCE], times)[0], 0.0))

    def _of(self, fields: list[int], times: Array) -> Array:
        """Fields of Instant, shape (fields, n)."""
        approach, rebound = self.level.approach, self._rebound
        turn, last = self.level.turn, self.level.last
        found = np.empty((len(fields), times.size))
        early = times <= turn
        found[:, early] = local(np.sqrt(approach[0]), approach[fields], np.sqrt(times[early]))
        late = np.minimum(times[~early], last)
        if rebound.size and self.separated:
            found[:, ~early] = local(-np.sqrt(last - rebound[0]), rebound[fields], -np.sqrt(last - late))
        elif rebound.size:
            found[:, ~early] = local(rebound[0], rebound[fields], late, ROWS_BEYOND)
        else:  # at rest
            found[:, ~early] = np.array([0.0, approach[1, -1], 0.0, 0.0, 0.0, approach[5, -1]])[fields, None]
        return found

    @cached_property
    def _rebound(self) -> Array:
        return _ascending(self.level.rebound)


def _ascending(fields: Array) -> Array:
    """The last row and those before which ascend to it: springs may leave at one time but for rounding, that of the
    time left until the last.
    """
    if not fields.size:
        return fields
    left = np.sqrt(np.maximum(fields[0, -1] - fields[0], 0.0))
    later = (np.diff(np.minimum.accumulate(left), prepend=np.inf) < 0.0) & (left > 0.0)
    later[-1] = True
    return fields[:, later]


def _energy(scene: Scene, level: Level) -> dict[str, float | None]:
    """Energies at the end, J, the limits of what every march counts step by step; `stored`: in springs, pressed or
    released with what they could not give back.
    """
    fallen, out, spent, held = level.energies.tolist()
    given = 0.5 * scene.reduced_mass * scene.velocity**2 + fallen
    return {"in": given, "out": out, "viscous": spent, "stored": held, "residual": given - out - spent - held}


MEMBER = LawKind(of, __doc__, leaves_out=waves, seconds=0.015)
