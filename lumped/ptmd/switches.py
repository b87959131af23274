"""When a side of the ring changes what it does, and to what: the rules of each memory, "(33)" and Fig. 15."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.equations import Equations, Stages
from lumped.ptmd.surface import SideStage
from lumped.ptmd.system import SIDES, Memory

Array = NDArray[np.float64]


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
