"""The paper's law: elastic-viscoelastic correspondence, "(17)" to "(19)", as a convolution.

F(t) = int_0^t E*(t-s) d(y(s)), y the elastic load curve; contact ends at the first F = 0, as the paper clips
it. Exact while the contact radius grows (Lee and Radok 1960, doi 10.1115/1.3644020), an approximation in the
rebound.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from lumped.errors import FeContactError
from lumped.laws._half_space import check_geometry
from lumped.laws._hereditary import Course, once, simulate
from lumped.laws._hereditary_force import law_of
from lumped.laws.mdr import ImpactScales
from lumped.result.ending import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema.keys import Choice, Key
from lumped.solvers.hereditary.approach import DEPTH, approach
from lumped.solvers.hereditary.closing import Closing, close
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.phase import HereditaryPhase, SinceTouch, UntilEnd
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.point import memory

ROUGH, FINE = 1e-3, 1e-6  # tolerances of scales
KEYS: Mapping[str, Key] = {
    "exit": Choice(("force", "depth"), required=False),
    "memory": Choice(memory.available(), required=False),
}


@dataclass(frozen=True)
class Correspondence:
    """The law; the rest is in the scene.

    `exit`: contact ends when the force returns to zero ("force", as the paper clips it) or at depth zero ("depth",
    the surface pulls). `memory`: what is left of it when the bodies meet again, a member of
    :mod:`lumped.solvers.point.memory`.
    """

    exit: str = "force"
    memory: str = "recovering"
    name: ClassVar[str] = "correspondence"

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises NotReached."""
        if self.exit == "force" and scene.motion.impacts == 1:
            return simulate(self.name, scene, tolerance, solve)
        return law_of(scene, self.exit, self.memory).simulate(scene, tolerance)


def of(scene: Scene) -> Correspondence:
    """The law for a scene, with the choices of `[law]`. Raises BadInput for a scene without geometry."""
    check_geometry(scene, Correspondence.name)
    law = scene.law
    return Correspondence(**(law.values if law is not None and law.name == Correspondence.name else {}))


def estimate(scene: Scene) -> ImpactScales:
    """Scales of the impact on any target with a load curve: one integration, no bars. Raises NotReached, BadInput."""
    try:
        answer = once(scene, ROUGH, solve)
    except FeContactError:  # a long step may try depths beyond the load curve which the motion never sees
        answer = once(scene, FINE, solve)
    value = {name: quantity or 0.0 for name, quantity in answer.values.items()}
    return ImpactScales(
        contact_radius=float(answer.columns(answer.times)[3].max()),
        peak_depth=value["peak_depth"],
        peak_force=value["peak_force"],
        peak_time=value["peak_time"],
        end=float(answer.times[-1]),
        duration=answer.values["duration"],
        restitution=answer.values["restitution"],
    )


def solve(problem: Hereditary, end_time: float, settings: Settings, before: Course | None = None) -> Course:
    """One integration from touch to the first F = 0, or to `end_time` in its own units. Raises NotReached."""
    inward = approach(problem, end_time, settings, before.inward if before else None)
    if not inward.turned:
        return Course((_phase(inward.path),), End.REST if inward.rests else End.TIME, inward.steps, inward)
    known = before.outward if before and isinstance(before.outward, Closing) else None
    closing = close(problem, inward, end_time, settings, known)
    steps = inward.steps + closing.steps
    phases = (_phase(closing.path),) if closing.path else ()
    if closing.last is None:
        return Course(phases, End.TIME, steps, inward, closing)
    last = HereditaryPhase(closing.last, UntilEnd(closing.end), DEPTH, DEPTH)
    return Course((*phases, last), End.SEPARATED, steps, inward, closing)


def _phase(path: Path) -> HereditaryPhase:
    return HereditaryPhase(path, SinceTouch(), DEPTH, DEPTH)
