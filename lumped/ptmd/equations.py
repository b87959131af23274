"""The equations of motion "(33)" and "(34)", the ring's surface on both sides as part of the state, and its switches.

State, shape (size, ...): x1, v1; with a damper x2, v2; with a ring the surface at +gap, then that at -gap. In
"(33)" the force of the ring has the sign of x2 - x1 (printed with one sign for both sides, which drives the
damper out). The place of a surface is measured as q = depth^exponent, so its equations, all linear, serve every
exponent; for exponent 1 the whole motion between two switches is linear, the depth affine.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.materials import Relaxation
from lumped.ptmd.system import SIDES, Memory, PoundingDamper, Start

Array = NDArray[np.float64]
SURFACES = 4  # the first row of the surfaces
# What is integrated over time: rows of `integrands`.
DISPLACEMENT, ACCELERATION, LOST_STRUCTURE, LOST_DAMPER, LOST_RING, CUT_TENSION = range(6)


class SideStage(Enum):
    """What one side of the ring does."""

    PRESSED = "the damper presses the surface and feels its force"
    RECOVERING = "the surface creeps back under no force"
    FOLLOWED = "the surface follows the damper, its tension cut off"
    HELD = "the surface stays at its undeformed place"


Stages = tuple[SideStage, ...]


@dataclass(frozen=True)
class Surface:
    """A side of the ring. State (1 + n, ...): the place q, then the strain z_k of each Maxwell element's spring."""

    stiffness: Relaxation

    @property
    def size(self) -> int:
        """Numbers in the state of a side."""
        return 1 + len(self.stiffness.moduli)

    @cached_property
    def springs(self) -> Array:
        """What the springs carry, N, per unit of the state, shape (1 + n,)."""
        return np.array([self.stiffness.equilibrium, *self.stiffness.moduli])

    @cached_property
    def creep(self) -> Array:
        """The speed dq/dt at which the force stays what it is, zero, per unit of the state, shape (1 + n,)."""
        if self.stiffness.viscosity:
            return -self.springs / self.stiffness.viscosity
        slips = np.divide(self.stiffness.moduli, self.stiffness.times)
        return np.append(0.0, slips) / self.stiffness.glassy

    def rate(self, state: Array, speed: Array) -> Array:
        """dq/dt = speed, dz_k/dt = dq/dt - z_k/tau_k."""
        return np.concatenate([speed[None], speed - self._slip(state)])

    def force(self, state: Array, speed: Array) -> Array:
        """E_inf q + sum E_k z_k + eta dq/dt, N."""
        return np.asarray(_sum(self.springs, state) + self.stiffness.viscosity * speed)

    def recovery(self, state: Array) -> Array:
        """The speed dq/dt of a surface that nothing touches."""
        return _sum(self.creep, state)

    def stored(self, state: Array) -> float:
        """Energy of the springs, for exponent 1, J."""
        return float(0.5 * self.springs @ state**2)

    def lost(self, state: Array, speed: Array) -> Array:
        """Power spent in the dashpots, sum E_k z_k^2/tau_k + eta (dq/dt)^2, for exponent 1, W."""
        spent = _sum(self.springs[1:], state[1:] * self._slip(state))
        return np.asarray(spent + self.stiffness.viscosity * speed**2)

    def _slip(self, state: Array) -> Array:
        """z_k/tau_k: the rate of each dashpot, shape (n, ...)."""
        times = np.array(self.stiffness.times).reshape(-1, *[1] * (state.ndim - 1))
        return np.asarray(state[1:] / times)


@dataclass(frozen=True)
class Equations:
    """The system's rates, forces and energies, for one state or for many at once."""

    system: PoundingDamper

    @cached_property
    def surface(self) -> Surface | None:
        """The law of a side, None without a ring."""
        return Surface(self.system.ring.stiffness) if self.system.ring else None

    @property
    def size(self) -> int:
        """Numbers in a state."""
        bodies = 2 if self.system.damper is None else SURFACES
        return bodies + (len(SIDES) * self.surface.size if self.surface else 0)

    @property
    def linear(self) -> bool:
        """Whether the motion between two switches of the ring is linear."""
        return self.system.ring is None or self.system.ring.exponent == 1.0

    def side(self, index: int) -> slice:
        """Rows of the surface of side 0 (+gap) or 1 (-gap)."""
        size = self.surface.size if self.surface else 0
        return slice(SURFACES + index * size, SURFACES + (index + 1) * size)

    def depth(self, index: int, y: Array) -> Array:
        """Penetration of the undeformed surface of a side, m; negative where the damper is clear of it."""
        gap = self.system.ring.gap if self.system.ring else 0.0
        return np.asarray(SIDES[index] * (y[2] - y[0]) - gap)

    def place(self, index: int, y: Array) -> Array:
        """Where the damper stands, as depth^exponent, odd in the depth."""
        depth = self.depth(index, y)
        exponent = self.system.ring.exponent if self.system.ring else 1.0
        return np.asarray(np.sign(depth) * np.abs(depth) ** exponent)

    def speed(self, index: int, stage: SideStage, y: Array) -> Array:
        """Speed dq/dt of the surface of a side."""
        if self.surface is None or stage is SideStage.HELD:
            return np.zeros_like(y[0])
        if stage is SideStage.RECOVERING:
            return self.surface.recovery(y[self.side(index)])
        approach = SIDES[index] * (y[3] - y[1])
        if self.linear or self.system.ring is None:
            return np.asarray(approach)
        exponent = self.system.ring.exponent
        return np.asarray(exponent * np.maximum(self.depth(index, y), 0.0) ** (exponent - 1.0) * approach)

    def moving(self, stages: Stages, y: Array) -> Array:
        """The state, then the speeds of the surfaces of both sides, (size + 2, ...); without a ring the state alone.

        The rates are linear in these, and the integrands quadratic, for any exponent. Where a surface goes with the
        damper, and not linearly, its place is that of the damper: an integrated one drifts off, and would keep a force
        after the damper has gone.
        """
        if self.surface is None:
            return y
        found = np.concatenate([y, [self.speed(index, stage, y) for index, stage in enumerate(stages)]])
        for index in self.driven(stages):
            found[self.side(index).start] = self.place(index, y)
        return found

    def driven(self, stages: Stages) -> list[int]:
        """The sides whose surfaces go with the damper, and not linearly: else a motion is linear."""
        going = (SideStage.PRESSED, SideStage.FOLLOWED)
        return [] if self.linear else [index for index, stage in enumerate(stages) if stage in going]

    def side_force(self, index: int, stage: SideStage, y: Array) -> Array:
        """Force of a side if nothing were cut off, N, positive in compression."""
        if self.surface is None:
            return np.zeros_like(y[0])
        return self._pressed(index, self.moving(tuple(stage if i == index else SideStage.HELD for i in range(2)), y))

    def _pressed(self, index: int, moving: Array) -> Array:
        if self.surface is None:
            return np.zeros_like(moving[0])
        return self.surface.force(moving[self.side(index)], moving[self.size + index])

    def force_at_touch(self, index: int, y: Array) -> float:
        """Force of a held side that the damper just meets, N: there the depth is zero, whatever rounding left of it."""
        if self.surface is None:
            return 0.0
        return float(self.surface.force(y[self.side(index)], self.speed(index, SideStage.PRESSED, y)))

    def force(self, stages: Stages, moving: Array) -> Array:
        """f of "(33)", N: positive at x2 - x1 > gap, where it pushes the damper back and the structure along."""
        pressed = [index for index, stage in enumerate(stages) if stage is SideStage.PRESSED]
        forces = (SIDES[index] * self._pressed(index, moving) for index in pressed)
        return np.asarray(sum(forces, start=np.zeros_like(moving[0])))

    def accelerations(self, stages: Stages, moving: Array) -> tuple[Array, Array | None]:
        """Of the structure and of the damper, m/s2, "(34)"."""
        one, two = self.system.structure, self.system.damper
        own = one.stiffness * moving[0] + one.damping * moving[1]
        if two is None:
            return -own / one.mass, None
        apart, closing = moving[2] - moving[0], moving[3] - moving[1]
        link = two.stiffness * apart + two.damping * closing + self.force(stages, moving)
        return (link - own) / one.mass, -link / two.mass

    def rates(self, stages: Stages, moving: Array) -> Array:
        """dy/dt, shape (size, ...), of what `moving` gives."""
        first, second = self.accelerations(stages, moving)
        rows = [moving[1], first] if second is None else [moving[1], first, moving[3], second]
        bodies = np.array(rows)
        if self.surface is None:
            return bodies
        sides = range(len(SIDES))
        surfaces = (self.surface.rate(moving[self.side(index)], moving[self.size + index]) for index in sides)
        return np.concatenate([bodies, *surfaces])

    def integrands(self, stages: Stages, moving: Array) -> Array:
        """x1^2, a1^2, and the powers lost in both dashpots and the ring, and of the tension cut off: (6, ...)."""
        one, two = self.system.structure, self.system.damper
        rows = [moving[0] ** 2, self.accelerations(stages, moving)[0] ** 2, one.damping * moving[1] ** 2]
        rows.append(two.damping * (moving[3] - moving[1]) ** 2 if two else np.zeros_like(moving[0]))
        return np.array([*rows, *self._ring_powers(stages, moving)])

    def _ring_powers(self, stages: Stages, moving: Array) -> tuple[Array, Array]:
        """Power lost in the ring, and power that the tension cut off puts into it, W.

        Where the law has no energy of its own (exponent other than 1), lost is what it takes and does not give back.
        """
        lost, cut = np.zeros_like(moving[0]), np.zeros_like(moving[0])
        if self.surface is None:
            return lost, cut
        if not self.linear:
            return self.force(stages, moving) * (moving[3] - moving[1]), cut
        for index, stage in enumerate(stages):
            speed = moving[self.size + index]
            lost = lost + self.surface.lost(moving[self.side(index)], speed)
            if stage is SideStage.FOLLOWED:
                cut = cut + self._pressed(index, moving) * speed
        return lost, cut

    def linear_forms(self, stages: Stages) -> tuple[Array, Array]:
        """Rates and integrands of `moving` as a matrix (size, n) and as quadratic forms (6, n, n), by polarization."""
        unit = np.eye(self.size + (len(SIDES) if self.surface else 0))
        alone = self.integrands(stages, unit)
        pairs = self.integrands(stages, unit[:, :, None] + unit[:, None, :])
        return self.rates(stages, unit), np.asarray(0.5 * (pairs - alone[:, :, None] - alone[:, None, :]))

    def kinetic(self, y: Array) -> float:
        """Kinetic energy of both masses, J; `y` has the shape (size,)."""
        damper = self.system.damper.mass * y[3] ** 2 if self.system.damper else 0.0
        return float(0.5 * (self.system.structure.mass * y[1] ** 2 + damper))

    def potential(self, y: Array) -> float:
        """Energy of both springs, J."""
        damper = self.system.damper.stiffness * (y[2] - y[0]) ** 2 if self.system.damper else 0.0
        return float(0.5 * (self.system.structure.stiffness * y[0] ** 2 + damper))

    def initial(self, start: Start) -> Array:
        """The state at t = 0, the ring relaxed, shape (size,)."""
        y = np.zeros(self.size)
        y[:2] = start.x1, start.v1
        if self.system.damper:
            y[2:SURFACES] = start.x2, start.v2
        if self.surface:
            for index in range(len(SIDES)):
                y[self.side(index).start] = max(float(self.place(index, y)), 0.0)
        return y


@dataclass(frozen=True)
class Switch:
    """A change of one side: it comes when `level` falls through zero, and leads to `to`.

    `level` maps states (size, ...) to numbers (...); affine in the state for exponent 1.
    """

    side: int
    to: SideStage
    level: Callable[[Array], Array]


def switches(equations: Equations, stages: Stages) -> tuple[Switch, ...]:
    """Every change that can end a phase with these stages."""
    return tuple(switch for index, stage in enumerate(stages) for switch in _of_side(equations, index, stage))


def _of_side(equations: Equations, index: int, stage: SideStage) -> list[Switch]:
    memory = equations.system.ring.memory if equations.system.ring else Memory.RECOVERING

    def force(y: Array) -> Array:
        return equations.side_force(index, SideStage.PRESSED, y)

    def clear_of_surface(y: Array) -> Array:
        return np.asarray(y[equations.side(index).start] - equations.place(index, y))

    if stage is SideStage.PRESSED:
        return [Switch(index, SideStage.FOLLOWED if memory is Memory.CONTINUOUS else SideStage.RECOVERING, force)]
    if stage is SideStage.HELD:
        return [Switch(index, SideStage.PRESSED, lambda y: -equations.depth(index, y))]
    leave = Switch(index, SideStage.HELD, lambda y: equations.depth(index, y))
    if stage is SideStage.FOLLOWED:
        return [Switch(index, SideStage.PRESSED, lambda y: -force(y)), leave]
    touch = Switch(index, SideStage.PRESSED, clear_of_surface)
    return [touch, leave] if memory is Memory.RESET else [touch]


def after(equations: Equations, stages: Stages, switch: Switch, y: Array) -> tuple[Stages, Array]:
    """Stages and state, shape (size,), just after a switch at the state `y`."""
    side, state, to = equations.side(switch.side), y.copy(), switch.to
    if to is SideStage.HELD:
        state[side.start] = 0.0
        if stages[switch.side] is SideStage.RECOVERING:
            state[side] = 0.0
    if to is SideStage.RECOVERING:
        state[side.start] = equations.place(switch.side, y)
    if to is SideStage.PRESSED and stages[switch.side] is SideStage.RECOVERING:
        state[side.start] = equations.place(switch.side, y)
    if (
        to is SideStage.PRESSED
        and stages[switch.side] is SideStage.HELD
        and equations.force_at_touch(switch.side, y) < 0.0
    ):
        to = SideStage.FOLLOWED
    return (*stages[: switch.side], to, *stages[switch.side + 1 :]), state


def first_stages(equations: Equations, y: Array) -> Stages:
    """What both sides do at t = 0: pressed where the damper stands inside the ring and is pushed."""
    if equations.surface is None:
        return ()
    inside = [float(equations.depth(index, y)) > 0.0 for index in range(len(SIDES))]
    return tuple(_at_start(equations, index, y) if deep else SideStage.HELD for index, deep in enumerate(inside))


def _at_start(equations: Equations, index: int, y: Array) -> SideStage:
    pushed = float(equations.side_force(index, SideStage.PRESSED, y)) > 0.0
    if pushed:
        return SideStage.PRESSED
    continuous = equations.system.ring is not None and equations.system.ring.memory is Memory.CONTINUOUS
    return SideStage.FOLLOWED if continuous else SideStage.RECOVERING


def _sum(weights: Array, values: Array) -> Array:
    """Of values (n, ...) with weights (n,)."""
    return np.asarray(np.einsum("k,k...->...", weights, values))
