"""The equations of motion "(33)" and "(34)", with the ring's surface on both sides as part of the state.

State, shape (size, ...): x1, v1; with a damper x2, v2; with a ring the surface at +gap, then that at -gap. In
"(33)" the force of the ring has the sign of x2 - x1 (printed with one sign for both sides, which drives the
damper out). For exponent 1 all of this is linear, the depth affine.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.surface import SideStage, Surface
from lumped.ptmd.system import SIDES, PoundingDamper, Start

Array = NDArray[np.float64]
Stages = tuple[SideStage, ...]
SURFACES = 4  # the first row of the surfaces
# What is integrated over time: rows of `integrands`.
DISPLACEMENT, ACCELERATION, LOST_STRUCTURE, LOST_DAMPER, LOST_RING, CUT_TENSION = range(6)


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
