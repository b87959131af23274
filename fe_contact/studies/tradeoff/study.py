"""What accuracy costs: error against the exact impact over processor time and counted work, by every method.

A finite-element point is what a user gets who fixes all settings: the impact with its error bars, from nothing but
loaded modules, so every operator is built again for every point. A default is what a user gets who fixes none, its
refinements paid for. Errors are measured from the exact law of the scene's model where there is one, itself judged by
another one where there are two; else from finite elements finer than the default's in steps and mesh, and what lies
within their bar cannot be told from them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_contact.methods import exact_laws, why_not
from fe_contact.progress import Progress
from fe_contact.reference import expected, plan
from fe_contact.settings import DEFAULT_TOLERANCE, Given, Numerics, WaveNumerics
from fe_contact.studies import journal
from fe_contact.studies.files import Line, write_study
from fe_contact.studies.tradeoff.point import MEASURED, REFERENCE, Answer, Point, Truth
from fe_contact.studies.tradeoff.tried import ROW, Settings, asked_laws, by_elements, by_law, fixed, variations
from fe_contact.studies.tradeoff.verdict import WIDEST, verdict
from lumped.errors import FeContactError, NotReached
from lumped.scene.scene import Scene
from lumped.schema import Table

# Finite elements that stand for the truth: times as many of each as the default has, which leaves a quarter of what
# steps of order two err by, and not half of it where a mesh is of order four; all else is the default's.
FINER = {"steps": 2, "elements_per_contact": 1.25}
TIGHTEST = 1e-8  # asked of laws that do
LOOSER = 10.0  # times the tolerance: what is marked too; tighter by as much where a law is the truth
KEPT = "tradeoff.jsonl"
BRIEF, REPEATS = 0.4, 3  # s; what takes less is run so often, and the least time counts
# Work, s: of a quick study for settings beside the default's, and the fewest of them. Without an exact law it weighs
# a looser tolerance too, as the finer elements that stand for one take several times as long as the default.
QUICK, FEWEST = 4.0, 1
SCHEMA = "fe-contact/tradeoff/1"
SETTING_COLUMNS = (
    "tolerance", "elements", "order", "elements_per_contact", "steps", "enforcement", "penalty", "far_radius",
    "scheme", "rho", "mass",
)  # fmt: skip
COUNTED = (
    "operations", "degrees_of_freedom", "factorizations", "solves", "marches", "steps", "contact_problems",
    "iterations",
)  # fmt: skip
WORK = {"steps": "steps_taken"}  # columns of what is counted, where a setting has its name


@dataclass(frozen=True, eq=False)
class Attempt:
    """What a run gives, None where it fails, and what it costs, s."""

    answer: Answer | None
    cpu: float = np.nan
    failure: str = ""

    @property
    def reached(self) -> Answer:
        """What it gives; raises NotReached."""
        if self.answer is None:
            raise NotReached(self.failure)
        return self.answer


# Measures calls by their names, or takes what is kept of them.
Attempts = Callable[[dict[str, partial[Attempt]]], dict[str, Attempt]]


class Tried(NamedTuple):
    """Settings of finite elements, what came of them, and the tolerance for which they are the plan's, if for one."""

    settings: Given
    attempt: Attempt
    default_for: float | None = None


@dataclass(frozen=True, eq=False)
class Tradeoff:
    """The points of a scene, and the ``tolerance`` for which it is weighed."""

    scene: Scene
    tolerance: float
    points: tuple[Point, ...]

    def __repr__(self) -> str:
        return "\n".join(self.verdict)

    @property
    def verdict(self) -> tuple[str, ...]:
        """In words, advice first."""
        return verdict(self.points, self.tolerance)


def tradeoff(scene: Scene, given: Given, quick: bool, where: Path, progress: Progress) -> Tradeoff:
    """Measure every point of the study; what runs give is kept, with the time they took, in the folder `where`.

    Raises BadInput for a scene that finite elements refuse, NotReached where default or reference have no answer.
    """
    if scene.has_geometry:
        expected(scene, given)  # what finite elements refuse is said before anything is written
    attempts: Attempts = partial(journal.rows, where / KEPT, progress=progress)
    laws, exact = asked_laws(scene, quick), _exact(scene, attempts)
    asked = {f"law {place} of {len(laws)}: {one[0]}": partial(_law, scene, *one) for place, one in enumerate(laws, 1)}
    answers = attempts(asked)
    tolerance = _tolerance(scene, given, loose=quick and not exact)
    if scene.has_geometry:
        defaults = _defaults(scene, given, _marked(tolerance, quick, bool(exact)), attempts)
        base = _base(scene, defaults)
        exact = exact or _finer(scene, base, attempts)
        seconds = expected(scene, {**given, "tolerance": tolerance})[1]
        elements = [*defaults, *_around(scene, given, base, quick, seconds, attempts)]
    else:
        elements = []
    truths = {name: Truth.of(one.reached) for name, one in exact.items()}
    points = [_reference(*one) for one in exact.items()]
    points += [_of_elements(scene, one, truths) for one in elements]
    points += [_of_law(scene, *one, attempt, truths) for one, attempt in zip(laws, answers.values(), strict=True)]
    return Tradeoff(scene, tolerance, tuple(points))


def _tolerance(scene: Scene, given: Given, loose: bool) -> float:
    """That for which a scene is weighed: the one given, else that of its plan; a ``loose`` study is content with more.

    Raises NotReached, BadInput.
    """
    asked = given.get("tolerance")
    if asked is None:
        asked = plan(scene, given).numerics.tolerance if scene.has_geometry else DEFAULT_TOLERANCE
    return float(min(LOOSER * asked, WIDEST) if loose else asked)


def _marked(tolerance: float, quick: bool, exact: bool) -> tuple[float, ...]:
    """The tolerances whose defaults are measured, that of the study first."""
    if quick:
        return (tolerance,)
    looser = min(LOOSER * tolerance, WIDEST)
    return tuple(dict.fromkeys((tolerance, looser, tolerance / LOOSER) if exact else (tolerance, looser)))


def _exact(scene: Scene, attempts: Attempts) -> dict[str, Attempt]:
    """The impact by every law that is exact for the scene's model, and has an answer. Raises NotReached without any
    for a scene of a law's own parameters.
    """
    tightest = {"tolerance": TIGHTEST}
    found = attempts({name: partial(_law, scene, name, tightest) for name in exact_laws(scene)})
    known = {name: attempt for name, attempt in found.items() if attempt.answer is not None}
    if not known and not scene.has_geometry:
        raise NotReached("; ".join(attempt.failure for attempt in found.values()))
    return known


def _defaults(scene: Scene, given: Given, marked: Sequence[float], attempts: Attempts) -> list[Tried]:
    """Of so many tolerances."""
    plans = {f"finite elements as planned for {one:g}": {**given, "tolerance": one} for one in marked}
    found = attempts({name: partial(_by_elements, scene, asked) for name, asked in plans.items()})
    return [Tried(plans[name], found[name], one) for name, one in zip(plans, marked, strict=True)]


def _base(scene: Scene, defaults: Sequence[Tried]) -> Numerics:
    """The settings with which the first default ended; raises NotReached where it has no answer."""
    kind = WaveNumerics if scene.model.inertia else Numerics
    return kind(**defaults[0].attempt.reached.settings)


def _finer(scene: Scene, base: Numerics, attempts: Attempts) -> dict[str, Attempt]:
    """The impact by finite elements that nobody weighs."""
    finer = base.varied(**{key: getattr(base, key) * times for key, times in FINER.items()})
    name = f"finite elements of {finer.steps} steps and {finer.elements_per_contact:.3g} elements"
    return attempts({name: partial(_by_elements, scene, fixed(finer))})


def _around(
    scene: Scene, given: Given, base: Numerics, quick: bool, seconds: float, attempts: Attempts
) -> Iterator[Tried]:
    """Settings around the default's, all fixed; of a quick study as many as it has time for if each takes so many
    ``seconds``, as is expected of the default: the same on a slower machine.
    """
    chosen = varied(base, given, variations(scene, base, quick))
    chosen = chosen[: max(FEWEST, int(QUICK / seconds))] if quick else chosen
    names = (f"finite elements {place} of {len(chosen)}" for place in range(1, len(chosen) + 1))
    calls = {name: partial(_by_elements, scene, fixed(one)) for name, one in zip(names, chosen, strict=True)}
    for one, attempt in zip(chosen, attempts(calls).values(), strict=True):
        yield Tried(one.as_dict(), attempt)


def varied(base: Numerics, given: Given, changes: Iterable[Settings]) -> tuple[Numerics, ...]:
    """Settings around the default's, each once and never its own; those the user gave stay as they are."""
    kept = ({key: value for key, value in change.items() if key not in given} for change in changes)
    return tuple(numerics for numerics in dict.fromkeys(base.varied(**change) for change in kept) if numerics != base)


def _by_elements(scene: Scene, given: Given) -> Attempt:
    """An impact with the settings that a user gives, refined where some are left open."""
    return _attempt(partial(by_elements, scene, given), NotReached)


def _law(scene: Scene, method: str, settings: Settings) -> Attempt:
    """A law that answers: what it leaves out is an error however finely it is integrated."""
    return _attempt(partial(by_law, scene, method, settings), FeContactError)


def _attempt(run: Callable[[], Answer], named: type[FeContactError]) -> Attempt:
    """Once, or several times where that is brief; without an answer for a failure of the kind named."""
    spent = list[float]()
    try:
        while not spent or (len(spent) < REPEATS and spent[0] < BRIEF):
            start = time.process_time()
            answer = run()
            spent.append(time.process_time() - start)
        return Attempt(answer, min(spent))
    except named as failure:
        return Attempt(None, failure=str(failure))


def _of_elements(scene: Scene, one: Tried, truths: Mapping[str, Truth]) -> Point:
    """A choice of settings; waves may make the force jump."""
    answer, truth = one.attempt.answer, next(iter(truths.values()))
    if answer is None:
        return Point("fe", one.settings, default_for=one.default_for, failure=one.attempt.failure)
    errors = truth.errors(answer, smooth=not scene.model.inertia)
    settings = {**answer.settings, "tolerance": one.default_for}
    return Point("fe", settings, one.attempt.cpu, errors, answer.bar, answer.work, one.default_for)


def _of_law(scene: Scene, method: str, settings: Settings, attempt: Attempt, truths: Mapping[str, Truth]) -> Point:
    """A law's point, which another truth judges where one is known: the one that has least in common with it."""
    missing = "" if method == ROW else why_not(scene, method)
    if attempt.answer is None:
        return Point(method, settings, failure=attempt.failure, leaves_out=missing)
    answer, names = attempt.answer, [name for name in truths if name != method]
    truth = truths[names[-1] if names else method]
    errors = truth.errors(answer, smooth=True)
    return Point(method, settings, attempt.cpu, errors, answer.bar, answer.work, leaves_out=missing)


def _reference(name: str, attempt: Attempt) -> Point:
    """What errors are measured from, as a point of its own; between its rows it is known to what it was asked for."""
    answer = attempt.reached
    bar, work = max(answer.bar or 0.0, TIGHTEST), {n: count for n, count in answer.work.items() if n != "operations"}
    return Point(REFERENCE, {**answer.settings, "from": name}, attempt.cpu, bar=bar, work=work)


def write_tradeoff(found: Tradeoff, where: Path) -> Table:
    """Write ``tradeoff.csv`` and ``tradeoff.json`` into a folder, made when it is not there; the latter's content."""
    described = [vars(point) | {"error": point.error} for point in found.points]
    content = {
        "schema": SCHEMA,
        "scene": found.scene.to_dict(),
        "tolerance": found.tolerance,
        "verdict": found.verdict,
        "points": described,
    }
    return write_study(where, "tradeoff", content, {"tradeoff": [line_of(point) for point in found.points]})


def line_of(point: Point) -> Line:
    """Its row of tradeoff.csv."""
    return {
        "method": point.method,
        **{key: point.settings.get(key) for key in SETTING_COLUMNS},
        "default_for": point.default_for,
        "cpu_s": point.cpu,
        "error": point.error,
        "bar": point.bar,
        **{f"{name}_error": point.errors.get(name) for name in (*MEASURED, "history")},
        **{WORK.get(key, key): point.work.get(key) for key in COUNTED},
        "failure": point.failure or None,
        "leaves_out": point.leaves_out or None,
    }
