"""One step of the frames from an instant: as long as the forces are smooth, cut at what happens first.

While nothing is pressed a step is the linear motion itself. While some gaps are, their forces at all Radau points of
the step are found at once, by Newton's method.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legval
from scipy.linalg.lapack import dgetrf, dgetrs

from lumped.errors import NotReached
from lumped.laws._force_law import ForceLaw
from lumped.numbers import Array, falling_zero
from lumped.pounding.flow import FrameFlow
from lumped.pounding.gaps import FrameStep, GapEvent, GapState, Mode, events_of
from lumped.solvers.point.bodies import TINY, PointLaw, Stage, State
from lumped.solvers.point.phase import HOPELESS, ITERATIONS, LOCATIONS
from lumped.solvers.radau import NODES, SHORTEST, STAGES, Nodes, paced

SMALL, EXACT = 1e-13, 1e-14  # a correction times its ratio to the one before; a correction that is rounding
SLOW = 0.01  # work: a correction that is no smaller share of the one before asks for new slopes of the forces
PRECISE = 1e-14  # of the time reached, and of a row: where it happens
NEAR = 1e-10  # of a place in a step, which tells about when something happens
NOISE = 1e-8  # rounding: of the slowest speed that counts, which no step can resolve
FARTHEST = 1e4  # rounding: steps since touch, beyond which grading them is lost in the digits of the time


class FramesAt(NamedTuple):
    """An instant, s: the state (2 n,), the gaps, and their depths, m, (m,)."""

    time: float
    state: Array
    depths: Array
    gaps: tuple[GapState, ...]


class Rules(NamedTuple):
    """What every step of a march goes by: the linear motion, a law for each gap, and the `tolerance`.

    That is the error of a rate in one step over the speed at touch.
    """

    flow: FrameFlow
    laws: Sequence[ForceLaw]
    tolerance: float


@dataclass(frozen=True, eq=False)
class FrameTrial:
    """Steps of several lengths from one instant, of which `free` are the Taylor coefficients without forces."""

    rules: Rules
    at: FramesAt
    free: Array

    @cached_property
    def _pressed(self) -> list[int]:
        return [i for i, gap in enumerate(self.at.gaps) if gap.mode is Mode.PRESSED]

    @cached_property
    def _active(self) -> list[int]:
        """The pressed ones, and those that are followed without force."""
        return [i for i, gap in enumerate(self.at.gaps) if gap.active]

    @cached_property
    def _events(self) -> list[GapEvent]:
        """Of the gaps that are not apart."""
        return [event for i, gap in enumerate(self.at.gaps) if gap.mode is not Mode.APART for event in self._of(i)]

    @cached_property
    def _touches(self) -> dict[int, list[GapEvent]]:
        """By those that are apart."""
        return {i: self._of(i) for i, gap in enumerate(self.at.gaps) if gap.mode is Mode.APART}

    def _of(self, i: int) -> list[GapEvent]:
        """By one gap."""
        law, noise = self.rules.laws[i], float(self._noise[i])
        return events_of(i, self.at.gaps[i], law, float(self.at.depths[i]), noise, self.at.time)

    @cached_property
    def _noise(self) -> Array:
        return self.rules.flow.noise(self.free)

    def _near(self, step: FrameStep) -> list[GapEvent]:
        """The events that can lie in a step: gaps that stay far apart have none."""
        reach = np.maximum(step.first_depth, step.depth.max(axis=1, initial=-np.inf))
        reach += step.length * np.abs(step.rate).max(axis=1, initial=0.0)
        near = (i for i in np.flatnonzero(reach >= 0.0).tolist() if self.at.gaps[i].mode is Mode.APART)
        return [*self._events, *(event for i in near for event in self._touches[i])]

    @cached_property
    def _coefficients(self) -> Array:
        """Taylor coefficients of the states, the depths and the rates, (TERMS + 1, 2 n + 2 m)."""
        size, rows = self.rules.flow.size, self.rules.flow.frames.rows
        depths, rates = self.free[:, :size] @ rows.T, self.free[:, size:] @ rows.T
        depths[0] = self.at.depths
        return np.concatenate([self.free, depths, rates], axis=1)

    @cached_property
    def _first_rates(self) -> Array:
        return np.asarray(self._coefficients[0, 2 * self.rules.flow.size + len(self.at.gaps) :])

    @property
    def _precise(self) -> float:
        """To what events are located, s."""
        return PRECISE * (self.at.time + self.rules.flow.unit)

    @cached_property
    def _graded(self) -> tuple[int, float]:
        """The power of the grading, and the time of the last touch, s, from which forces still grow."""
        found = [
            (gap.touched, self.rules.laws[i].grading(gap.stage))
            for i, gap in enumerate(self.at.gaps)
            if gap.mode is Mode.PRESSED and gap.touched is not None
        ]
        touched, power = max(found, default=(0.0, 1))
        return power, touched

    @cached_property
    def _allowed(self) -> Array:
        """Roughness of the rates, m/s, of the gaps that are active."""
        speeds = np.abs(self._first_rates[self._active])
        touch = np.array([self.at.gaps[i].stage.speed for i in self._active])
        floor = NOISE * self.rules.flow.slowest(self.free)
        return np.asarray(np.maximum(self.rules.tolerance * np.maximum(speeds, touch), floor))

    def accepted(self, length: float, proposed: float) -> tuple[FrameStep, GapEvent | None, float]:
        """The step taken, at most `length` long, s, what ended it, and how long the next one may be, s."""
        shortest = self._precise * SHORTEST
        guess = np.zeros((len(self._pressed), STAGES))
        while length > 0.0:
            nodes = self._nodes(length)
            step, event = self._until_event(self._solved(length, nodes, guess))
            if step is not None and not self._active:
                return step, event, math.inf
            rough = math.inf if step is None else float((self._roughness(step) / self._allowed).max())
            if step is not None and (rough <= 1.0 or step.length <= shortest):
                following = step.length * step.nodes.following(rough)
                return step, event, max(following, proposed) if step.length < proposed else following
            if step is None:
                length *= SHORTEST
            else:
                length = step.length * step.nodes.again(rough)
            proposed = length
        raise NotReached(f"no step from {self.at.time:.6g} s on converges", "a law less stiff")

    def _roughness(self, step: FrameStep) -> Array:
        """What the last Legendre terms of the forces are worth in rates over the step, m/s, of the active gaps."""
        gain = step.gain[self._active] - step.nodes.pace * step.tension[self._active]
        last = np.abs(gain @ step.nodes.series[-2:].T).max(axis=1)
        return np.asarray(step.length * last / self.rules.flow.frames.reduced_masses[self._active])

    def _nodes(self, length: float) -> Nodes:
        power, touched = self._graded
        begun = (self.at.time - touched) / length
        return NODES.graded(power, begun) if power > 1 and begun < FARTHEST else NODES

    def _ending(self, event: GapEvent, length: float) -> Nodes:
        """The nodes of a step that ends with an event: at depth zero graded towards it."""
        gap = self.at.gaps[event.gap]
        left = self.rules.laws[event.gap].grading(gap.stage) if event.surfaces else 1
        nodes = self._nodes(length)
        return NODES.graded(left, begun=0.0, mirrored=True) if left > 1 and nodes.power == 1 else nodes

    def _until_event(self, step: FrameStep | None) -> tuple[FrameStep | None, GapEvent | None]:
        """The step, cut short at its first event; and again at one before that which only the shorter step shows."""
        event: GapEvent | None = None
        for _ in range(1 + 2 * len(self.at.gaps)):
            # what happens at once, but for rounding, nothing comes before
            at_once = step is None or (event is not None and step.length <= self._precise)
            found = None if step is None or at_once else self._first(step, event)
            if step is None or found is None:
                break
            event = found
            step = self._located(step, event)
        return step, event

    def _first(self, step: FrameStep, known: GapEvent | None) -> GapEvent | None:
        """The event that happens first within a step, other than one that is known to end it."""
        found = [
            (first, event)
            for event in self._near(step)
            if event is not known and (first := event.first(step)) is not None
        ]
        return min(found, key=lambda pair: pair[0])[1] if found else None

    def _located(self, step: FrameStep, event: GapEvent) -> FrameStep | None:
        """The step that ends where the event happens: Newton's method on its length, kept between what brackets it.

        Or one near it that is too rough anyway; None without convergence.
        """
        values, place = event.value(step), event.first(step) or 0
        low, high, length = _bracket(step, values, place)
        length = max(length, self._precise)  # two gaps of the same storeys turn at once
        nodes, guess = self._ending(event, length), step.gain
        if nodes.mirrored != step.nodes.mirrored:
            guess = np.outer(step.force[:, place], nodes.pace)
        previous: tuple[float, float] | None = None
        trial: FrameStep | None = None
        for _ in range(LOCATIONS):
            trial = self._solved(length, nodes, guess[self._pressed])
            if trial is None:
                return None
            if self._active and bool((self._roughness(trial) > HOPELESS * self._allowed).any()):
                return trial
            values = event.value(trial)
            at, slope = float(values[-1]), trial.slope(values)
            if previous is not None and previous[0] != length:
                slope = (at - previous[1]) / (length - previous[0])
            elif not math.isfinite(slope):
                slope = float(trial.rate[event.gap, -1])
            low, high = (low, length) if at <= 0.0 else (length, high)
            following = length - at / slope if slope < 0.0 else math.nan  # a value that rises leads nowhere: halved
            if at == 0.0 or abs(following - length) <= self._precise or high - low <= self._precise:
                return trial
            previous, length = (length, at), following if low < following < high else 0.5 * (low + high)
            nodes, guess = self._ending(event, length), trial.gain
        return trial

    def _solved(self, length: float, nodes: Nodes, guess: Array) -> FrameStep | None:
        """The step whose forces are those of the laws at every point; None without convergence."""
        flow, at, p, count = self.rules.flow, self.at, self._pressed, len(self.at.gaps)
        moved = flow.shares(nodes, length) @ self._coefficients
        force, gain, tension = np.zeros((3, count, STAGES))
        memories = [gap.memory for gap in at.gaps]
        parts = slice(2 * flow.size), slice(2 * flow.size, 2 * flow.size + count), slice(2 * flow.size + count, None)
        states, depth, rate = moved[:, parts[0]], moved[:, parts[1]].T, moved[:, parts[2]].T
        if p:
            over = flow.integrals(nodes, length)
            pressing = self._pressing(length, nodes, over, depth[p], rate[p])
            found = pressing.solved(guess, flow.frames.reduced_masses[p] / length)
            if found is None:
                return None
            # in place: states, depth and rate are views
            moved += np.tensordot(over @ found.T, flow.influence[: over.shape[0], :, p], ((0, 2), (0, 2)))
            force[p] = pressing.forces(depth[p], rate[p])
            gain[p] = nodes.pace * force[p]
            for i, law in zip(p, pressing.laws, strict=True):
                memories[i] = law.remembered(np.maximum(depth[i], TINY))
        for i in (i for i in self._active if i not in p):
            law, pressed = self.rules.laws[i].within(self.known(i), length), np.maximum(depth[i], TINY)
            memories[i] = law.remembered(pressed)
            tension[i] = -law.force(pressed, rate[i], at.gaps[i].stage)
        first = at.depths, self._first_rates
        return FrameStep(length, nodes, states, *first, depth, rate, force, gain, tuple(memories), tension)

    def _pressing(self, length: float, nodes: Nodes, over: Array, depth: Array, rate: Array) -> Pressing:
        """The pressed gaps within a step, from depths and rates without force, (p, s)."""
        p, flow = self._pressed, self.rules.flow
        first = 2 * flow.size
        on = flow.influence[: over.shape[0], first:].reshape(over.shape[0], 2, -1, len(self.at.gaps))
        of_both = np.tensordot(on[:, :, p][..., p], over, (0, 0)).transpose(0, 1, 3, 2, 4)
        by_gain = of_both.reshape(2, depth.size, depth.size)
        return Pressing(
            [self.rules.laws[i].within(self.known(i), length) for i in p],
            [self.at.gaps[i].stage for i in p],
            nodes.pace, depth, rate, *by_gain,
        )  # fmt: skip

    def known(self, i: int) -> State:
        """What the law of a gap knows here."""
        return State(float(self.at.depths[i]), float(self._first_rates[i]), 0.0, self.at.gaps[i].memory)


@dataclass(frozen=True, eq=False)
class Pressing:
    """The pressed gaps within one step: laws and stages, the pace of its nodes, (s,), depths and rates without force,
    (p, s), and what they get of the gains of all, (p s, p s).
    """

    laws: Sequence[PointLaw]
    stages: Sequence[Stage]
    pace: Array
    depth: Array
    rate: Array
    depth_by_gain: Array
    rate_by_gain: Array

    def forces(self, depth: Array, rate: Array) -> Array:
        """Of all gaps, N, (p, s)."""
        pressed = np.maximum(depth, TINY)
        found = (law.force(*one) for law, *one in zip(self.laws, pressed, rate, self.stages, strict=True))
        return np.array(list(found))

    def solved(self, gain: Array, scale: Array) -> Array | None:
        """The gains that are the pace times the laws' forces, by Newton's method from a guess; None if it fails.

        `scale`: the force, N, that changes a rate by itself over the step, per rate, (p,).
        """
        before, factors = 0.0, None
        for _ in range(ITERATIONS):
            depth = self.depth + (self.depth_by_gain @ gain.ravel()).reshape(gain.shape)
            rate = self.rate + (self.rate_by_gain @ gain.ravel()).reshape(gain.shape)
            factors = factors or dgetrf(self._jacobian(depth, rate))[:2]
            excess = gain - self.pace * self.forces(depth, rate)
            correction = dgetrs(*factors, excess.reshape(-1, 1))[0].reshape(gain.shape)
            gain = gain - correction
            sizes = np.abs(gain[:, 0]) + np.abs(gain[:, -1]) + scale * (np.abs(self.rate[:, 0]) + np.abs(rate[:, -1]))
            ratio = float((np.abs(correction).max(axis=1) / sizes).max())
            if not math.isfinite(ratio):
                return None
            if ratio <= EXACT or ratio * ratio <= SMALL * before:
                return gain
            factors = factors if ratio <= SLOW * before or not before else None
            before = ratio
        return None

    def _jacobian(self, depth: Array, rate: Array) -> Array:
        """Of the excess over the gains, (p s, p s)."""
        jacobian, count = np.eye(depth.size), depth.shape[1]
        pressed = np.maximum(depth, TINY)
        for k, (law, stage) in enumerate(zip(self.laws, self.stages, strict=True)):
            own = slice(k * count, (k + 1) * count)
            over_depth, over_rate = law.tangents(pressed[k], rate[k], stage)
            over_depth, over_rate = over_depth * (depth[k] > 0.0), np.reshape(over_rate, (-1, 1))
            by_depth = over_depth @ self.depth_by_gain[own] if over_depth.ndim == 2 else (
                over_depth[:, None] * self.depth_by_gain[own])  # fmt: skip
            jacobian[own] -= self.pace[:, None] * (by_depth + over_rate * self.rate_by_gain[own])
        return jacobian


def _bracket(step: FrameStep, values: Array, place: int) -> tuple[float, float, float]:
    """Between which times an event happens, s, and about when: where the polynomial through its values falls."""
    nodes, series = step.nodes, step.nodes.series @ values
    begin, end = np.append(0.0, nodes.places)[place : place + 2].tolist()
    at = falling_zero(lambda one: float(legval(2.0 * one - 1.0, series)), begin, end, close=NEAR)
    at = at if at > begin else 0.5 * (begin + end)
    share = float(paced(np.array(at), nodes.power, nodes.begun, nodes.mirrored)[0])
    low = float(nodes.points[place - 1]) if place else 0.0
    return low * step.length, min(2.0 * float(nodes.points[place]), 1.0) * step.length, share * step.length
