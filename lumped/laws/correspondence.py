"""The paper's law: elastic-viscoelastic correspondence, "(17)" to "(19)", as a convolution.

F(t) = int_0^t E*(t-s) d(y(s)), y the elastic load curve; contact ends at the first F = 0, as the paper clips
it. Exact while the contact radius grows (Lee and Radok 1960, doi 10.1115/1.3644020), an approximation in the
rebound.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.collide import memory
from lumped.collide.hereditary import HereditaryLoad
from lumped.ending import End
from lumped.hereditary.approach import approach, over_root
from lumped.hereditary.problem import Hereditary
from lumped.hereditary.solve import Settings, follow
from lumped.keys import Choice, Key
from lumped.laws._half_space import check_geometry
from lumped.laws._hereditary import Curves, simulate
from lumped.laws._hereditary_force import HereditaryForce
from lumped.result import Result
from lumped.scene import Scene

Array = NDArray[np.float64]
KEYS: Mapping[str, Key] = {
    "exit": Choice(("force", "depth"), required=False),
    "memory": Choice(memory.available(), required=False),
}


@dataclass(frozen=True)
class Correspondence:
    """The law; the rest is in the scene.

    `exit`: contact ends when the force returns to zero ("force", as the paper clips it) or at depth zero ("depth",
    the surface pulls). `memory`: what is left of it when the bodies meet again, a member of
    :mod:`lumped.collide.memory`.
    """

    exit: str = "force"
    memory: str = "recovering"
    name: ClassVar[str] = "correspondence"

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises NotReached."""
        if self.exit == "force" and scene.motion.impacts == 1:
            return simulate(self.name, scene, scene.profile, scene.contact_modulus, tolerance, solve)
        curve, time = scene.profile.load_curve, scene.elastic_contact_time
        load = HereditaryLoad(curve, scene.contact_modulus)
        law = HereditaryForce(exit=self.exit, rule=self.memory, load=load, scale=time, load_curve=curve)
        return law.simulate(scene, tolerance)


def of(scene: Scene) -> Correspondence:
    """The law for a scene, with the choices of `[law]`. Raises BadInput for a scene without geometry."""
    check_geometry(scene, Correspondence.name)
    law = scene.law
    return Correspondence(**(law.values if law is not None and law.name == Correspondence.name else {}))


def solve(problem: Hereditary, end_time: float, settings: Settings) -> Curves:
    """One integration from touch to the first F = 0, or to `end_time`, s."""
    inward = approach(problem, end_time / problem.scales.time, settings)
    path, end, evaluations = inward.path, End.REST if inward.rests else End.TIME, inward.path.evaluations
    if inward.turned:
        span = (0.0, float(np.sqrt(end_time / problem.scales.time)))
        zero = [lambda _, state: float(problem.force(state))]
        path = follow(over_root(problem), span, problem.start(), zero, settings)
        end = End.TIME if path.event is None else End.SEPARATED
        evaluations += path.evaluations
    closing = path.end

    def columns(times: Array) -> Array:
        elapsed = times / problem.scales.time
        state = path.at(np.minimum(np.sqrt(elapsed), closing))
        scales, after = problem.scales, elapsed > closing**2 * (1.0 + 1e-12)
        force = np.where(after, 0.0, np.maximum(problem.force(state), 0.0))
        velocity = np.where(after & inward.rests, 0.0, state[1])
        radius = problem.contact_radius(np.maximum(state[0], 0.0))
        return np.array([state[0] * scales.depth, velocity * scales.velocity, force * scales.force, radius])

    return Curves(
        force=lambda roots: problem.force(path.at(roots)),
        depth=lambda roots: path.at(roots)[0],
        roots=path.places,
        times=path.places**2,
        columns=columns,
        last=path.at(closing),
        end_time=closing**2,
        end=end,
        evaluations=evaluations,
    )
