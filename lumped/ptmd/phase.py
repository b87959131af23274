"""A phase: the motion between two switches, in rows close enough that nothing happens unseen between two of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.ptmd.equations import Equations, Stages
from lumped.ptmd.switches import Switch
from lumped.ptmd.system import Start

Array = NDArray[np.float64]
ROWS_PER_PERIOD = 64
# Beyond this ratio of row to relaxation time the exponentials of a phase lose the digits that are promised.
STIFFEST = 1e5


@dataclass(frozen=True, eq=False)
class PtmdPhase:
    """Rows of time, s, shape (k,), and of the state, shape (size, k), from the start to the end of a phase.

    `at` maps a time inside to the state there; `integrals` maps it to the integrals of the equations'
    integrands since the start of the phase, shape (6,).
    """

    stages: Stages
    times: Array
    states: Array
    at: Callable[[float], Array]
    integrals: Callable[[float], Array]

    @property
    def start(self) -> float:
        """First instant, s."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """Last instant, s."""
        return float(self.times[-1])


Follow = Callable[[Stages, Array, float], tuple[PtmdPhase, Switch | None]]


def row_spacing(equations: Equations, start: Start, end_time: float, rows: int, most: int) -> float:
    """Time between two of ``rows`` a period, s: a share of the shortest one, the ring as stiff as it can be.

    Raises BadInput when the rows would be more than ``most`` or the ring relaxes far too fast for them.
    """
    spacing = 2.0 * np.pi / (rows * fastest(equations, start))
    if end_time > spacing * most:
        message = f"more than {most} rows; accepted: at most {spacing * most:.3g} s for these oscillators"
        raise BadInput(Fault("motion", "end_time", message))
    shortest = STIFFEST**-1 * spacing
    if equations.surface is not None:
        stiffness = equations.surface.stiffness
        creep = [stiffness.viscosity / stiffness.glassy] if stiffness.viscosity and stiffness.glassy else []
        if min([*stiffness.times, *creep], default=shortest) < shortest:
            message = f"relaxes in less than {shortest:.2g} s, too fast beside the vibration; cure: leave that term out"
            raise BadInput(Fault("ring", "material", message))
    return float(spacing)


def fastest(equations: Equations, start: Start) -> float:
    """Highest angular frequency, 1/s, of the undamped system with its ring pressed and not relaxed."""
    one, two = equations.system.structure, equations.system.damper
    if two is None:
        return float(np.sqrt(one.stiffness / one.mass))
    link = two.stiffness + _steepest(equations, start)
    roots = np.diag([one.mass, two.mass]) ** 0.5
    stiffness = np.array([[one.stiffness + link, -link], [-link, link]])
    scaled = np.linalg.solve(roots, np.linalg.solve(roots, stiffness).T)
    return float(np.sqrt(np.linalg.eigvalsh(scaled)[-1]))


def _steepest(equations: Equations, start: Start) -> float:
    """Largest slope of the ring's force over the depth, N/m, with all the energy of the start in it."""
    ring = equations.system.ring
    if ring is None or ring.stiffness.glassy == 0.0:
        return 0.0
    y = equations.initial(start)
    energy, power = equations.kinetic(y) + equations.potential(y), ring.exponent
    deepest = ((power + 1.0) * energy / ring.stiffness.glassy) ** (1.0 / (power + 1.0))
    return float(power * ring.stiffness.glassy * deepest ** (power - 1.0))
