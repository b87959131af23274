"""A case under its own law, without pounding, and under other laws; each motion marched twice for its error bars.

The coarser march takes longer steps and, where slabs have waves, half their modes; then a third one has a quarter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from lumped.errors import addressed
from lumped.laws._force_law import ForceLaw
from lumped.pounding.case_file import PoundingCase
from lumped.pounding.frames import PoundingFrames
from lumped.pounding.simulation import FramesResult, simulate
from lumped.progress import Progress, silent

NO_CONTACT = "no contact"  # the variant whose structures pass through each other
COARSE, FINE = 1e-6, 1e-8  # step tolerances of the two marches
SAFETY = 2.0  # safety: two marches may agree by chance
ROUNDING = 1e-12  # rounding: of a sum over thousands of steps, relative
# Of the polynomial through the points of a row, which both marches share: a sixth of the shortest period at most.
BETWEEN_POINTS = 1e-9
POLYNOMIALS = ("peak_drift", "peak_displacement", "peak_acceleration")
# What a converged motion may err by: a peak force, relative; the energy, of all that came in.
MOST_ERROR, MOST_RESIDUAL = 1e-4, 1e-8
MOST_OF_WAVES = 5e-2  # of the peak force, where slabs have waves: modes meet their fronts slowly


@dataclass(frozen=True, eq=False)
class Pounding:
    """The finest of the marches under a law, and by how much others differ in every measure, times SAFETY."""

    laws: tuple[ForceLaw, ...]
    result: FramesResult
    errors: dict[str, float]

    @property
    def relative(self) -> float:
        """Error bar of the peak force over it."""
        return self.errors["peak_force"] / (self.result.peak_force or 1.0)

    @property
    def message(self) -> str:
        """Why it has not converged; empty when it has."""
        slabs = self.result.frames.slabs
        coarser = "coarser steps with half the modes" if slabs else "coarser steps"
        cure = "cure: an earlier motion.end_time" + (", more modes of a slab" if slabs else "")
        if self.errors["contacts"]:
            return f"{len(self.result.contacts)} contacts, but others on {coarser}; {cure}"
        if self.relative > (MOST_OF_WAVES if slabs else MOST_ERROR):
            return f"the peak force changes by {self.relative:.1e} on {coarser}; {cure}"
        if self.result.energy.open_share > MOST_RESIDUAL:
            return f"the energy balance is open by {self.result.energy.open_share:.1e}; {cure}"
        return ""


@dataclass(frozen=True, eq=False)
class PoundStudy:
    """By law, the file's own first; and the same structures without contact. Of a file without gaps that alone."""

    case: PoundingCase
    motions: dict[str, Pounding]
    apart: FramesResult

    @property
    def main(self) -> FramesResult:
        """The motion of the case as given."""
        return next((motion.result for motion in self.motions.values()), self.apart)

    @property
    def message(self) -> str:
        """What did not converge; empty when all did."""
        return "; ".join(f"{name}: {motion.message}" for name, motion in self.motions.items() if motion.message)


def study(
    case: PoundingCase,
    names: Sequence[str] = (),
    progress: Progress = silent,
    calibrated: Mapping[str, tuple[ForceLaw, ...]] | None = None,
) -> PoundStudy:
    """The case under its own law and these others. Raises BadInput, before any work, and NotReached.

    `progress` is told what is marched, how far that is, and how far it will go, s. `calibrated`: laws by their names,
    one for each gap, in the place of those that the file gives by its keys.
    """
    own = case.own_law
    every = dict.fromkeys([own, *names]) if own else {}
    laws = calibrated or {name: case.laws(None if name == own else name) for name in every if name}
    motions = {}
    with addressed(case.source, {"motion": "motion"}):
        for name, one in laws.items():
            motions[name] = pounding(case, one, name, progress)
        free = PoundingFrames(case.frames.left, case.frames.right)
        apart = simulate(
            free, (), case.ground, case.end_time, on_time=lambda time: progress(NO_CONTACT, time, case.end_time)
        )
        return PoundStudy(case, motions, apart)


def pounding(
    case: PoundingCase, laws: tuple[ForceLaw, ...], message: str = "", progress: Progress = silent
) -> Pounding:
    """One motion with its error bars. Raises NotReached.

    `progress` is told by the `message` how far its marches are together, and will go, s.
    Modes meet a motion by chance at times: half of what the next halving changes is the least that waves are told by.
    """
    halved = (1, 2) if case.frames.slabs else (0,)
    ways = [(case.frames, FINE), *((replace(case.frames, halvings=n), COARSE) for n in halved)]

    def marched(number: int) -> FramesResult:
        (frames, tolerance), end = ways[number], case.end_time
        return simulate(
            frames,
            laws,
            case.ground,
            end,
            tolerance,
            lambda time: progress(message, number * end + time, len(ways) * end),
        )

    fine = marched(0)
    others = [marched(number).measures() for number in range(1, len(ways))]
    errors = {
        name: SAFETY * max(abs(value - others[0][name]), 0.5 * abs(others[0][name] - others[-1][name]))
        + (BETWEEN_POINTS if name in POLYNOMIALS else ROUNDING) * abs(value)
        for name, value in fine.measures().items()
    }
    errors["contacts"] = SAFETY * abs(len(fine.contacts) - others[0]["contacts"])
    return Pounding(laws, fine, errors)
