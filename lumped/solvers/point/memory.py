"""What a material remembers under a load, and by three rules what becomes of that between two contacts (Fig. 15).

F = int E*(t-s) dy, "(17)" to "(19)", at the Radau points of a step: the Maxwell branches by collocation too. With
w_k' = (y - w_k)/tau_k the force is E_glassy y - sum E_k w_k + eta y'. At the points of one step w_k is linear in
the loads y there, w_k = q_k w_k(0) + L_k y, so the force is too: F = b + B y.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.materials import Recovery, Relaxation
from lumped.numbers import Array, Real, bisected
from lumped.schema.members import unavailable
from lumped.solvers.point.bodies import Bodies, State, flown, time_to_return
from lumped.solvers.radau import NODES, Nodes

STEPS = 16  # in a stretch of the flight, for the memory of what is followed above the surface


class Loading(Protocol):
    """What is asked of a load curve."""

    def force(self, depth: Array) -> Real:
        """The load y, m2, at a depth, m."""
        ...

    def force_and_slope(self, depth: Array) -> tuple[Real, Real]:
        """The same and its slope 2 a, m."""
        ...

    def contact_radius(self, depth: Array) -> Real:
        """a, m."""
        ...

    def depth_slope(self, contact_radius: Array) -> Real:
        """d depth over d a."""
        ...


@dataclass(frozen=True)
class HereditaryLoad:
    """An elastic load curve y(depth), m2, under the modulus E*(t), Pa; memories w_k in m2."""

    curve: Loading
    modulus: Relaxation

    @property
    def at_rest(self) -> tuple[float, ...]:
        """The memory of a relaxed surface."""
        return (0.0,) * len(self.modulus.moduli)

    def load(self, depth: Real) -> Real:
        """y, zero above the surface."""
        return self.curve.force(np.maximum(depth, 0.0))

    def load_and_slope(self, depth: Real) -> tuple[Real, Real]:
        """y and dy/d depth."""
        return self.curve.force_and_slope(np.maximum(depth, 0.0))

    def slope_slope(self, depth: Array) -> Array:
        """d2y/d depth2 = 2 da/d depth, zero where the depth is."""
        radius = np.asarray(self.curve.contact_radius(depth))
        over_radius = np.asarray(self.curve.depth_slope(radius))
        return np.asarray(np.divide(2.0, over_radius, out=np.zeros_like(radius), where=over_radius > 0.0))

    def force(self, depth: Real, rate: Real, memory: Real) -> Array:
        """F, N; `memory` has the branches first, shape (K, ...)."""
        return self.pressing(*self.load_and_slope(depth), rate, memory)

    def pressing(self, load: Real, slope: Real, rate: Real, memory: Real) -> Array:
        """The same where the load and its slope are known."""
        remembered = np.tensordot(np.array(self.modulus.moduli), np.asarray(memory), axes=(0, 0))
        return np.asarray(self.modulus.glassy * load - remembered + self.modulus.viscosity * slope * rate)


@dataclass(frozen=True, eq=False)
class StepLoad:
    """A hereditary load within one step: gains q, shape (K, s), and L, shape (K, s, s); memory at its start (K,)."""

    load: HereditaryLoad
    memory: Array
    gains: Array
    response: Array
    _known: list[tuple[Array, tuple[Real, Real]]] = field(default_factory=list, init=False, repr=False)

    @classmethod
    def of(cls, load: HereditaryLoad, memory: tuple[float, ...], length: float, nodes: Nodes) -> StepLoad:
        """For a step of `length`, s: (I + A h/tau) w = w(0) + (A h/tau) y with A the collocation's integrals."""
        terms = load.modulus.times
        one = np.eye(nodes.points.size)
        driven = np.array([nodes.once * (length / tau) for tau in terms]).reshape(-1, *one.shape)
        response = np.linalg.solve(one + driven, driven)
        gains = 1.0 - response.sum(axis=2)
        return cls(load, np.array(memory), gains, response)

    def memories(self, depth: Array) -> Array:
        """w_k at the points from the depths there, shape (K, s)."""
        return self._remembered(self._loads(depth)[0])

    def force(self, depth: Array, rate: Array) -> Array:
        """F at the points, N."""
        load, slope = self._loads(depth)
        return self.load.pressing(load, slope, rate, self._remembered(load))

    def tangents(self, depth: Array, rate: Array) -> tuple[Array, Array]:
        """dF/d depth, shape (s, s), and dF/d rate, shape (s,)."""
        modulus, slope = self.load.modulus, np.asarray(self._loads(depth)[1])
        remembered = np.tensordot(np.array(modulus.moduli), self.response, axes=(0, 0))
        over_depth = -remembered * slope
        bent = modulus.viscosity * rate * self.load.slope_slope(depth) if modulus.viscosity else 0.0
        over_depth.flat[:: depth.size + 1] += modulus.glassy * slope + bent
        return over_depth, modulus.viscosity * slope

    def _remembered(self, load: Real) -> Array:
        return np.asarray(self.gains * self.memory[:, None] + self.response @ load)

    def _loads(self, depth: Array) -> tuple[Real, Real]:
        """y and its slope, once for each array of depths: many a load curve has to look for a contact radius."""
        if not self._known or self._known[0][0] is not depth:
            self._known[:] = [(depth, self.load.load_and_slope(depth))]
        return self._known[0][1]


def continuous(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """The transfer function keeps running on the depth above zero, as if the bodies still touched.

    They meet after the top of the flight, where its force, counted as zero while it is negative, becomes positive.
    """
    if bodies.gravity <= 0.0:
        return None
    top = -last.rate / bodies.gravity
    left = top - ((time_to_return(last, bodies.gravity, 0.0) or top) - top)
    memory = _run(load, bodies, last, last.memory, 0.0, left)
    low = 2.0 * top - left
    memory = _run(load, bodies, last, memory, left, low)

    def apart(time: float) -> bool:
        there = flown(last, bodies.gravity, time)
        return bool(load.force(there.depth, there.rate, _run(load, bodies, last, memory, low, time)) <= 0.0)

    _, time = bisected(apart, low, 2.0 * top)
    kept = _run(load, bodies, last, memory, low, time)
    return time, flown(last, bodies.gravity, time)._replace(memory=kept)


def _run(
    load: HereditaryLoad, bodies: Bodies, last: State, memory: tuple[float, ...], start: float, end: float
) -> tuple[float, ...]:
    """The memory at `end` from that at `start`, times of flight, s."""
    if end <= start:
        return memory
    length = (end - start) / STEPS
    for begin in start + length * np.arange(STEPS):
        times = begin + length * NODES.points
        depth = last.depth + times * (last.rate + 0.5 * bodies.gravity * times)
        memory = tuple(StepLoad.of(load, memory, length, NODES).memories(depth)[:, -1].tolist())
    return memory


def recovering(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """Out of contact the surface creeps back freely.

    They meet after the top of the flight, when the load y of the depth is that of the free surface.
    """
    if bodies.gravity <= 0.0:
        return None
    top = -last.rate / bodies.gravity
    surface = FreeSurface.of(load, last)

    def apart(time: float) -> bool:
        depth = flown(last, bodies.gravity, time).depth
        return depth <= 0.0 or bool(load.load(depth) < surface.at(time)[0])

    _, time = bisected(apart, top, 2.0 * top)
    memory = tuple(surface.at(time)[1:].tolist())
    return time, flown(last, bodies.gravity, time)._replace(memory=memory)


@dataclass(frozen=True)
class FreeSurface:
    """A surface without force, its load y recovering; the memories, (K,), m2, follow: w_k' = (y - w_k)/tau_k."""

    load: Recovery
    remembered: Array
    times: Array

    @classmethod
    def of(cls, load: HereditaryLoad, last: State) -> FreeSurface:
        """From the end of a contact on: memories of the load are what the dashpots of a strain y have yielded."""
        recovery = Recovery.of(load.modulus, float(load.load(last.depth)), last.memory)
        return cls(recovery, np.array(last.memory), np.array(load.modulus.times))

    def at(self, time: Real) -> Array:
        """y and the memories w_k at times of any shape, shape (1 + K, ...), m2."""
        from scipy.special import exprel  # late: a single impact needs none

        times = np.asarray(time, dtype=float)
        column = (-1, *[1] * times.ndim)
        rates = (1.0 / self.times).reshape(column)
        left = np.exp(-times * rates)
        memories = self.remembered.reshape(column) * left + self.load.permanent * (1.0 - left)
        for amplitude, tau in zip(self.load.amplitudes, self.load.times, strict=True):
            # of two exponentials the slower one, and what the other fills of it
            apart, slower = np.abs(rates - 1.0 / tau), np.exp(-times * np.minimum(rates, 1.0 / tau))
            memories = memories + amplitude * rates * slower * times * exprel(-times * apart)
        return np.concatenate([self.load(times)[None], memories])


@dataclass(frozen=True)
class HeldSurface:
    """A surface at its undeformed place, y = 0, whose memories fade: w_k' = -w_k/tau_k."""

    remembered: Array
    times: Array

    @classmethod
    def of(cls, load: HereditaryLoad, last: State) -> HeldSurface:
        """From the end of a contact on."""
        return cls(np.array(last.memory), np.array(load.modulus.times))

    def at(self, time: Real) -> Array:
        """y and the memories at times of any shape, shape (1 + K, ...), m2."""
        times = np.asarray(time, dtype=float)
        column = (-1, *[1] * times.ndim)
        fading = self.remembered.reshape(column) * np.exp(-times / self.times.reshape(column))
        return np.concatenate([np.zeros_like(times)[None], fading])


def reset(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """The surface is relaxed and flat again whenever the bodies meet, at depth zero.

    Bodies that do not leave the dent by then never count as apart.
    """
    time = time_to_return(last, bodies.gravity, 0.0)
    if time is None:
        return None
    return time, flown(last, bodies.gravity, time)._replace(depth=0.0, memory=load.at_rest)


# From a load, its bodies and the state in which they parted: how long they are apart, s, and the state when contact
# begins again; None: they never meet.
Rule = Callable[[HereditaryLoad, Bodies, State], tuple[float, State] | None]
RULES: Mapping[str, Rule] = {"continuous": continuous, "recovering": recovering, "reset": reset}


def rule_of(name: str) -> Rule:
    """The rule called so; raises BadInput with the nearest name."""
    if name not in RULES:
        raise BadInput(Fault("law", "memory", unavailable(tuple(RULES), name)))
    return RULES[name]
