"""Ting 1966: the exact impact on a viscoelastic half-space, doi 10.1115/1.3625192.

Contact that grows and shrinks once; the approach is that of the correspondence law, the rebound its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.ending import End
from lumped.hereditary.approach import Approach, approach
from lumped.hereditary.problem import Hereditary
from lumped.hereditary.rebound import Rebound
from lumped.hereditary.solve import Path, Settings
from lumped.laws._half_space import KEYS as KEYS
from lumped.laws._half_space import check
from lumped.laws._hereditary import Curves, simulate
from lumped.result import Result
from lumped.scene import Scene

Array = NDArray[np.float64]
ENDS = {0: End.SEPARATED, 1: End.SECOND_APPROACH, None: End.TIME}


@dataclass(frozen=True)
class Ting:
    """The law; everything it needs is in the scene."""

    name: ClassVar[str] = "ting"

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """One impact to this tolerance. Raises NotReached."""
        return simulate(self.name, scene, scene.profile, scene.contact_modulus, tolerance, solve)


def of(scene: Scene) -> Ting:
    """The law for a scene: every half-space has it. Raises BadInput for a scene without geometry."""
    check(scene, Ting.name)
    return Ting()


def solve(problem: Hereditary, end_time: float, settings: Settings) -> Curves:
    """One integration from touch to the end of contact, or to `end_time`, s."""
    last = end_time / problem.scales.time
    inward = approach(problem, last, settings)
    rebound = Rebound(problem, inward)
    outward = rebound.follow(last, settings) if inward.turned else None
    end = ENDS[outward.event] if outward else End.REST if inward.rests else End.TIME
    roots = inward.path.places
    return Curves(
        force=lambda places: problem.force(inward.path.at(places)),
        depth=lambda places: inward.path.at(places)[0],
        roots=roots,
        times=np.concatenate([roots**2, outward.places[1:]]) if outward else roots**2,
        columns=_Columns(problem, inward, rebound, outward),
        last=outward.at(outward.end) if outward else inward.path.at(inward.path.end),
        end_time=outward.end if outward else inward.end,
        end=end,
        evaluations=inward.path.evaluations + (outward.evaluations if outward else 0),
    )


@dataclass(frozen=True)
class _Columns:
    """Depth, velocity, force and contact radius at any times, s; shape (4, n), SI."""

    problem: Hereditary
    inward: Approach
    rebound: Rebound
    outward: Path | None

    def __call__(self, times: Array) -> Array:
        elapsed = times / self.problem.scales.time
        early = elapsed <= self.inward.end
        found = np.empty((4, times.size))
        found[:, early] = self._approach(elapsed[early])
        found[:, ~early] = self._rebound(elapsed[~early]) if self.outward else self._rest(elapsed[~early])
        scales = self.problem.scales
        units = np.array([scales.depth, scales.velocity, scales.force, 1.0])
        return np.asarray(found * units[:, None])

    def _approach(self, time: Array) -> Array:
        state = self.inward.state(time)
        return np.array([state[0], state[1], self.problem.force(state), self.problem.contact_radius(state[0])])

    def _rebound(self, time: Array) -> Array:
        assert self.outward is not None
        time = np.minimum(time, self.outward.end)
        state = self.outward.at(time)
        force, deepest = self.rebound.pressed(time, state)
        return np.array([state[0], state[1], force, self.problem.contact_radius(deepest)])

    def _rest(self, time: Array) -> Array:
        depth = self.inward.state(time)[0]
        still = np.zeros_like(time)
        return np.array([depth, still, still, self.problem.contact_radius(depth)])
