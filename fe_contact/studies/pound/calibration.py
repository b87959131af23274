"""Pounding structures under laws calibrated on one reference of the impact of two storeys.

By the route of :mod:`fe_contact.studies.transfer`: then laws differ by what they say of the same impact alone, and the
reference's own bar, carried through the structures, stands beside that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from fe_contact import methods
from fe_contact.progress import Progress, silent
from fe_contact.studies.transfer.study import CALIBRATIONS, Calibration, calibrated
from fe_contact.studies.transfer.verdict import QUANTITIES
from lumped.errors import BadInput, Fault, shown
from lumped.fit.space import own_keys
from lumped.laws._force_law import ForceLaw
from lumped.pounding.case_file import PoundingCase
from lumped.pounding.gap_laws import force_of
from lumped.pounding.study import PoundStudy, pounding, study
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema import Table

TOLD = {"peak_drift": "drift", "peak_acceleration": "acceleration", "peak_force": "force", "impulse": "impulse"}


@dataclass(frozen=True, eq=False)
class PoundCalibration:
    """Laws of all gaps, calibrated ``by`` one of :data:`CALIBRATIONS` on the ``references`` of their ``impacts``."""

    by: str
    impacts: Mapping[str, Scene]
    references: Mapping[str, Result]
    numbers: Mapping[str, Mapping[str, Calibration]]

    @classmethod
    def of(
        cls, case: PoundingCase, names: Sequence[str], by: str, method: str, progress: Progress = silent
    ) -> PoundCalibration:
        """The case's law and the others. Raises BadInput, before any work where that shows it, and NotReached."""
        impacts = _impacts(case, names, by)
        references, known = dict[str, Result](), dict[tuple[float, float | None], Result]()
        for gap, scene in impacts.items():
            masses = case.frames.masses_at(case.frames.gaps[gap])
            if masses not in known:
                progress(f"reference of the storeys at {gap}")
                given = case.law.numerics if case.law else {}
                known[masses] = methods.simulate(scene, method, given, progress=progress)
            references[gap] = known[masses]
        every = dict.fromkeys([case.own_law or "", *names])
        numbers = {
            name: {gap: calibrated(name, impacts[gap], references[gap], by) for gap in impacts} for name in every
        }
        return cls(by, impacts, references, numbers)

    @property
    def laws(self) -> dict[str, tuple[ForceLaw, ...]]:
        """By their names, the case's first, one for each gap. Raises BadInput."""
        return {name: self._made(name, numbers) for name, numbers in self.numbers.items()}

    def _made(self, name: str, numbers: Mapping[str, Calibration]) -> tuple[ForceLaw, ...]:
        return tuple(force_of(name, numbers[gap].scene_at(scene)) for gap, scene in self.impacts.items())

    def farther(self) -> tuple[ForceLaw, ...]:
        """The first law, calibrated on references whose force and restitution are as much higher as their bars."""
        name = next(iter(self.numbers))
        numbers = {
            gap: calibrated(name, self.impacts[gap], _higher(one), self.by) for gap, one in self.references.items()
        }
        return self._made(name, numbers)

    def to_json(self) -> Table:
        """What pound.json says of it."""
        return {
            "by": self.by,
            "references": {
                gap: {"method": one.method, "converged": one.converged}
                | {name: vars(one.quantities[name]) for name in QUANTITIES}
                for gap, one in self.references.items()
            },
            "laws": {
                name: {gap: {"parameters": dict(one.values), "normalized_error": one.error} for gap, one in own.items()}
                for name, own in self.numbers.items()
            },
        }


def _impacts(case: PoundingCase, names: Sequence[str], by: str) -> dict[str, Scene]:
    """The impact of every gap. Raises BadInput for what cannot be calibrated."""
    if by not in CALIBRATIONS:
        raise BadInput(Fault("--calibrate", "", f"{shown(by)}: accepted {', '.join(CALIBRATIONS)}"))
    if case.law is None or case.own_law is None:
        raise BadInput(Fault("--calibrate", "", f"{case.name} has no law in a gap; accepted: a file with [law], [gap]"))
    impacts = {name: case.law.impact(case.frames, gap) for name, gap in case.frames.gaps.items()}
    for name in (case.own_law, *names):
        if not own_keys(name):
            for scene in impacts.values():
                force_of(name, scene)
    return impacts


def _higher(reference: Result) -> Result:
    """A reference with its force, all over, and its restitution higher by their bars."""
    quantities = dict(reference.quantities)
    peak, restitution = quantities["peak_force"], quantities["restitution"]
    share = max((peak.error or 0.0) / (peak.value or 1.0), quantities["history_l2"].error or 0.0)
    quantities["peak_force"] = replace(peak, value=(1.0 + share) * (peak.value or 0.0))
    if restitution.value is not None:
        quantities["restitution"] = replace(restitution, value=restitution.value + (restitution.error or 0.0))
    history = replace(reference.history, force=(1.0 + share) * reference.history.force)
    return replace(reference, quantities=quantities, history=history)


@dataclass(frozen=True, eq=False)
class CalibratedStudy:
    """A study under calibrated laws. ``bars``: by how much the measures of its first motion would change, were the
    references off by as much as their bars.
    """

    calibration: PoundCalibration
    study: PoundStudy
    bars: Mapping[str, float]

    @property
    def choice(self) -> dict[str, dict[str, float]]:
        """By law and measure: the difference to the first law's, SI."""
        first = self.study.main.measures()
        return {
            name: {measure: value - first[measure] for measure, value in motion.result.measures().items()}
            for name, motion in list(self.study.motions.items())[1:]
        }

    @property
    def errors(self) -> dict[str, float]:
        """By law, how far it is from the force that it was fitted to, "(20)", in its worst gap."""
        numbers = self.calibration.numbers
        found = {name: [one.error for one in own.values() if one.error is not None] for name, own in numbers.items()}
        return {name: max(errors) for name, errors in found.items() if errors}

    def to_json(self) -> Table:
        """What pound.json says beside the study."""
        return {"calibration": self.calibration.to_json() | {"bars": dict(self.bars), "choice": self.choice}}

    def told(self) -> list[str]:
        """What the choice of a law changes, a line a law."""
        first, name = self.study.main.measures(), next(iter(self.study.motions))
        lines = [f"bar of the reference, by {name}: {_changes(self.bars, first, '+-')}"]
        lines += [f"normalized error of {law} on the reference: {100.0 * e:.3g} %" for law, e in self.errors.items()]
        lines += [f"{other} in the place of {name}: {_changes(one, first, '')}" for other, one in self.choice.items()]
        return lines


def _changes(changes: Mapping[str, float], first: Table, sign: str) -> str:
    """Changes of measures in percent of the first law's."""
    parts = []
    for measure, said in TOLD.items():
        share = 100.0 * changes[measure] / (first[measure] or 1.0)
        parts.append(f"{said} {sign}{share:{'.2g' if sign else '+.3g'}} %")
    return ", ".join(parts)


def calibrated_study(
    case: PoundingCase, names: Sequence[str], by: str, method: str = methods.FE, progress: Progress = silent
) -> CalibratedStudy:
    """The case under its own law and others, each calibrated on the same reference, which is by a `method`.

    Raises BadInput, NotReached.
    """
    calibration = PoundCalibration.of(case, names, by, method, progress)
    found = study(case, names, progress, calibration.laws)
    other = pounding(case, calibration.farther(), "bar of the reference", progress).result.measures()
    first = found.main.measures()
    return CalibratedStudy(calibration, found, {name: abs(value - first[name]) for name, value in other.items()})
