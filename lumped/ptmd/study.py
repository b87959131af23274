"""A case with its ring, without ring, without damper; whether it converged, and what the model leaves out."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

from lumped.errors import addressed
from lumped.progress import Progress, silent
from lumped.ptmd.case_file import Case
from lumped.ptmd.free_vibration import STEP_TOLERANCE, simulate
from lumped.ptmd.result import PtmdResult
from lumped.ptmd.system import PoundingDamper
from lumped.result.result import LedgerEntry, sufficient

FINER = 1e-2 * STEP_TOLERANCE  # of the second run that tells errors
MOST_CHANGE, MOST_RESIDUAL = 1e-6, 1e-8  # safety: of a measure in finer steps, relative; of the energy balance
SMALL = 0.1  # a penetration beyond this share of a length of the ring is not small
FULL, PLAIN, BARE = "pounding damper", "damper without ring", "structure alone"


@dataclass(frozen=True)
class Convergence:
    """Contacts found at two tolerances of the steps, the largest relative change of a measure between them, and the
    energy residual over the initial energy.
    """

    step_tolerance: tuple[float, float]
    contacts: tuple[int, int]
    largest_change: float | None
    energy_residual: float

    @property
    def message(self) -> str:
        """Why the motion has not converged; empty when it has."""
        if self.largest_change is None:
            first, second = self.contacts
            return f"{first} contacts, but {second} in finer steps; cure: a shorter motion.end_time"
        if self.largest_change > MOST_CHANGE:
            return f"a measure changes by {self.largest_change:.1e} in finer steps; cure: a shorter motion.end_time"
        if self.energy_residual > MOST_RESIDUAL:
            return f"the energy balance is open by {self.energy_residual:.1e}; cure: a shorter motion.end_time"
        return ""


@dataclass(frozen=True, eq=False)
class PtmdStudy:
    """Results by variant: the case itself, named `FULL`, `PLAIN` or `BARE` by what it has, and all simpler ones."""

    case: Case
    results: dict[str, PtmdResult]
    convergence: Convergence
    ledger: tuple[LedgerEntry, ...]

    @property
    def main(self) -> PtmdResult:
        """The result of the case as given."""
        return next(iter(self.results.values()))

    @property
    def model_sufficient(self) -> bool:
        """Whether no known penetration exceeds what the contact law can bear."""
        return sufficient(self.ledger, SMALL)


def study(case: Case, progress: Progress = silent) -> PtmdStudy:
    """Simulate the case twice and its simpler variants once. Raises BadInput and NotReached.

    `progress` is told what is simulated, how far that is, and how far it will go, s.
    """

    def marched(name: str, system: PoundingDamper, tolerance: float) -> PtmdResult:
        return simulate(
            system, case.start, case.end_time, case.window, tolerance, lambda time: progress(name, time, case.end_time)
        )

    results: dict[str, PtmdResult] = {}
    with addressed(case.source, {"motion": "motion", "ring": "ring", "start": "motion"}):
        for name, system in variants(case.system).items():
            if system.damper is not None or case.start.x1 or case.start.v1:
                results[name] = marched(name, system, STEP_TOLERANCE)
        again = marched("finer steps", case.system, FINER)
    main = next(iter(results.values()))
    return PtmdStudy(case, results, convergence(main, again), ledger(case, main))


def variants(system: PoundingDamper) -> dict[str, PoundingDamper]:
    """The system as it is first, then without its ring, then without its damper."""
    found = {FULL: system, PLAIN: replace(system, ring=None), BARE: PoundingDamper(system.structure)}
    present = [FULL, PLAIN, BARE][2 if system.damper is None else 1 if system.ring is None else 0 :]
    return {name: found[name] for name in present}


def convergence(main: PtmdResult, again: PtmdResult) -> Convergence:
    """How the finer steps of `again` change the result."""
    changes: list[float] = []
    same = len(main.contacts) == len(again.contacts)
    finer = asdict(again.measures)
    for name, value in asdict(main.measures).items():
        other = finer[name]
        if value is None or other is None:
            same = same and value is other
        else:
            changes.append(abs(value - other) / abs(other) if other else abs(value))
    return Convergence(
        step_tolerance=(STEP_TOLERANCE, FINER),
        contacts=(len(main.contacts), len(again.contacts)),
        largest_change=max(changes) if same else None,
        energy_residual=abs(main.energy.residual) / main.energy.initial,
    )


def ledger(case: Case, result: PtmdResult) -> tuple[LedgerEntry, ...]:
    """The paper's first assumption, tiny deformation, against the lengths known; and a start inside the ring."""
    if case.system.ring is None:
        return ()
    depth = result.measures.peak_depth
    entries = [
        LedgerEntry(f"penetration over {name}", "small strain", depth / length, "the law holds for small shares")
        for name, length in (("the ring's thickness", case.thickness), ("the rod's radius", case.rod_radius))
        if length is not None
    ]
    if not entries:
        unknown = "give ring.thickness or ring.rod_radius"
        entries = [LedgerEntry("penetration over the ring's thickness", "small strain", None, unknown)]
    if any(contact.start == 0.0 for contact in result.contacts):
        entries.append(LedgerEntry("start inside the ring", "relaxed", None, "how long it was held there is not known"))
    return tuple(entries)
