"""What accuracy costs where bodies have inertia: error against exact waves, or against a finer reference, over time.

A point is what a user gets who fixes all settings: the impact with its bars, every operator built again. The default
is what a user gets who fixes none, its refinements paid for. Where no exact waves are known the reference is asked for
a quarter of the tolerance, and what lies within its bar cannot be told from it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fe_contact.progress import Progress
from fe_contact.reference import fe
from fe_contact.settings import KEYS, Given, WaveNumerics
from fe_contact.studies import journal
from fe_contact.studies.tradeoff.point import REFERENCE, Point, largest_bar, timed
from fe_contact.studies.tradeoff.tried import TRIED
from fe_contact.studies.tradeoff.truth import Truth
from lumped import laws, simulate
from lumped.errors import FeContactError, NotReached
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema import Table

SHARE = 0.25  # of the tolerance, asked of a reference
LAWS = ("rod_waves", "mdr", "hertz")  # exact waves, and what is without any
LAW_TOLERANCE = 1e-6
KEPT = "tradeoff.jsonl"
BRIEF, REPEATS = 0.5, 3  # s; what takes less is run again, for the least of so many times


@dataclass(frozen=True, eq=False)
class Attempt:
    """What a run gives, None where it fails, and what it costs, s."""

    result: Result | None
    cpu: float = np.nan
    failure: str = ""

    @property
    def reached(self) -> Result:
        """What it gives; raises NotReached."""
        if self.result is None:
            raise NotReached(self.failure)
        return self.result


def tradeoff(scene: Scene, given: Given, quick: bool, where: Path, progress: Progress) -> tuple[Point, ...]:
    """Measure every point of the study; what runs give is kept, with the time they took, in the folder `where`.

    Raises BadInput for a target whose waves have no trade-off, NotReached where default or reference have no answer.
    """
    study = TRIED.get(scene.target.name, scene.source, "target.shape").of(scene)
    attempts = partial(journal.rows, where / KEPT, progress=progress)
    default = attempts({"finite elements as planned": partial(_fe, scene, given)}).popitem()[1]
    base = WaveNumerics(**default.reached.numerics)
    truth: Truth | None = study.exact(scene)
    reference: tuple[Attempt, ...] = ()
    if truth is None:
        finer = {**given, "tolerance": SHARE * base.tolerance}
        reference = tuple(attempts({"what errors are measured from": partial(_fe, scene, finer)}).values())
        truth = Truth.of(reference[0].reached)
    chosen = _chosen(base, given, study.variations(base, quick))
    elements = {
        f"finite elements {place} of {len(chosen)}": partial(_fe, scene, _fixed(numerics))
        for place, numerics in enumerate(chosen, 1)
    }
    found = attempts(elements | {name: partial(_law, scene, name) for name in LAWS})
    varied = zip(chosen, (found[name] for name in elements), strict=True)
    return (
        *(_reference(one, truth) for one in reference),
        _point(default, base, truth, study, base.tolerance),
        *(_point(attempt, numerics, truth, study) for numerics, attempt in varied),
        *(_of_law(name, found[name], truth) for name in LAWS),
    )


def _fe(scene: Scene, given: Given) -> Attempt:
    """An impact with no operator at hand."""
    study = TRIED.get(scene.target.name).of(scene)

    def run() -> Result:
        study.forget()
        return fe(scene, given)

    return _attempt(run, NotReached)


def _law(scene: Scene, name: str) -> Attempt:
    """A law that answers: what it leaves out is an error however finely it is integrated."""
    return _attempt(lambda: simulate(laws.get(name).of(scene), scene, LAW_TOLERANCE), FeContactError)


def _attempt(run: Callable[[], Result], named: type[FeContactError]) -> Attempt:
    """Once, or several times where that is brief; without a result for a failure of the kind named."""
    try:
        found, cpu = timed(run, 1)
        return Attempt(found, cpu if cpu > BRIEF else min(cpu, timed(run, REPEATS - 1)[1]))
    except named as failure:
        return Attempt(None, failure=str(failure))


def _chosen(base: WaveNumerics, given: Given, changes: Iterator[Given]) -> tuple[WaveNumerics, ...]:
    """Settings around the default's, each once and never its own; those the user gave stay as they are."""
    kept = ({key: value for key, value in change.items() if key not in given} for change in changes)
    return tuple(numerics for numerics in dict.fromkeys(base.varied(**change) for change in kept) if numerics != base)


def _fixed(numerics: WaveNumerics) -> Table:
    """All settings, so that nothing is refined."""
    return {key: value for key, value in numerics.as_dict().items() if key in KEYS}


def _point(
    attempt: Attempt, numerics: WaveNumerics, truth: Truth, study: Any, default_for: float | None = None
) -> Point:
    result = attempt.result
    if result is None:
        return Point("fe", numerics.as_dict(), failure=attempt.failure)
    work = dict(result.work) | {"operations": study.operations(result.work)}
    settings = {**result.numerics, "tolerance": default_for}
    return Point("fe", settings, attempt.cpu, truth.errors(result), largest_bar(result), work, default_for)


def _reference(attempt: Attempt, truth: Truth) -> Point:
    """What errors are measured from, as a point of its own."""
    result = attempt.reached
    return Point(REFERENCE, result.numerics, attempt.cpu, bar=truth.bar, work=result.work)


def _of_law(name: str, attempt: Attempt, truth: Truth) -> Point:
    settings, result = {"tolerance": LAW_TOLERANCE}, attempt.result
    if result is None:
        return Point(name, settings, failure=attempt.failure)
    return Point(name, settings, attempt.cpu, truth.errors(result), largest_bar(result), dict(result.work))
