"""When a side of the ring changes what it does, and to what: the rules of each memory, "(33)" and Fig. 15."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.equations import Equations, Stages
from lumped.ptmd.surface import Stage
from lumped.ptmd.system import SIDES, Memory

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Switch:
    """A change of one side: it comes when `level` falls through zero, and leads to `to`.

    `level` maps states (size, ...) to numbers (...); affine in the state for exponent 1.
    """

    side: int
    to: Stage
    level: Callable[[Array], Array]


def switches(equations: Equations, stages: Stages) -> tuple[Switch, ...]:
    """Every change that can end a phase with these stages."""
    return tuple(switch for index, stage in enumerate(stages) for switch in _of_side(equations, index, stage))


def _of_side(equations: Equations, index: int, stage: Stage) -> list[Switch]:
    memory = equations.system.ring.memory if equations.system.ring else Memory.RECOVERING

    def force(y: Array) -> Array:
        return equations.side_force(index, Stage.PRESSED, y)

    def clear_of_surface(y: Array) -> Array:
        return np.asarray(y[equations.side(index).start] - equations.place(index, y))

    if stage is Stage.PRESSED:
        return [Switch(index, Stage.FOLLOWED if memory is Memory.CONTINUOUS else Stage.RECOVERING, force)]
    if stage is Stage.HELD:
        return [Switch(index, Stage.PRESSED, lambda y: -equations.depth(index, y))]
    leave = Switch(index, Stage.HELD, lambda y: equations.depth(index, y))
    if stage is Stage.FOLLOWED:
        return [Switch(index, Stage.PRESSED, lambda y: -force(y)), leave]
    touch = Switch(index, Stage.PRESSED, clear_of_surface)
    return [touch, leave] if memory is Memory.RESET else [touch]


def after(equations: Equations, stages: Stages, switch: Switch, y: Array) -> tuple[Stages, Array]:
    """Stages and state, shape (size,), just after a switch at the state `y`."""
    side, state, to = equations.side(switch.side), y.copy(), switch.to
    if to is Stage.HELD:
        state[side.start] = 0.0
        if stages[switch.side] is Stage.RECOVERING:
            state[side] = 0.0
    if to is Stage.RECOVERING:
        state[side.start] = equations.place(switch.side, y)
    if to is Stage.PRESSED and stages[switch.side] is Stage.RECOVERING:
        state[side.start] = equations.place(switch.side, y)
    if to is Stage.PRESSED and stages[switch.side] is Stage.HELD and equations.force_at_touch(switch.side, y) < 0.0:
        to = Stage.FOLLOWED
    return (*stages[: switch.side], to, *stages[switch.side + 1 :]), state


def first_stages(equations: Equations, y: Array) -> Stages:
    """What both sides do at t = 0: pressed where the damper stands inside the ring and is pushed."""
    if equations.surface is None:
        return ()
    inside = [float(equations.depth(index, y)) > 0.0 for index in range(len(SIDES))]
    return tuple(_at_start(equations, index, y) if deep else Stage.HELD for index, deep in enumerate(inside))


def _at_start(equations: Equations, index: int, y: Array) -> Stage:
    pushed = float(equations.side_force(index, Stage.PRESSED, y)) > 0.0
    if pushed:
        return Stage.PRESSED
    continuous = equations.system.ring is not None and equations.system.ring.memory is Memory.CONTINUOUS
    return Stage.FOLLOWED if continuous else Stage.RECOVERING
