"""What accuracy costs: error against the exact impact over processor time and counted work, by every method.

A finite-element point is what a user gets who fixes all settings: the impact with its error bars, from nothing but
loaded modules, so every operator is built again for every point. The default of a body with inertia is what a user gets
who fixes none, its refinements paid for. Where no exact impact is known a reference is asked for a quarter of the
tolerance, and what lies within its bar cannot be told from it. The verdict, in words: how near to the Pareto front of
all settings the planned defaults lie.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.progress import Progress
from fe_contact.reference import plan
from fe_contact.settings import RANGES, Given, Numerics, WaveNumerics
from fe_contact.studies import journal
from fe_contact.studies.files import Line, write_study
from fe_contact.studies.tradeoff.bodies import Settings, lumped, tried
from fe_contact.studies.tradeoff.point import MEASURED, REFERENCE, Answer, Point, Truth
from lumped.errors import FeContactError, NotReached
from lumped.scene.scene import Scene
from lumped.schema import Table

MARKED = (1e-3, 1e-4)  # tolerances whose defaults are marked
SHARE = 0.25  # of the tolerance, asked of a reference
KEPT = "tradeoff.jsonl"
BRIEF, REPEATS = 1.0, 3  # s; what takes less is run so often, and the least time counts
NEAR = 2.0  # a default that costs at most this multiple of the cheapest setting that does as well is near the front
WIDEST = RANGES["tolerance"][1]  # the loosest tolerance that is accepted
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

Measure = Callable[[Point], float]


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


def tradeoff(scene: Scene, given: Given, quick: bool, where: Path, progress: Progress) -> tuple[Point, ...]:
    """Measure every point of the study; what runs give is kept, with the time they took, in the folder `where`.

    Raises BadInput for a target whose waves have no trade-off, NotReached where default or reference have no answer.
    """
    body, attempts = tried(scene), partial(journal.rows, where / KEPT, progress=progress)
    known: dict[Numerics, Attempt] = {}
    if body.planned is None:
        plans = defaults(scene, given)
        base = next(iter(plans.values()))
        marked = {numerics.varied(tolerance=base.tolerance): tolerance for tolerance, numerics in plans.items()}
    else:
        (default,) = attempts({"finite elements as planned": partial(_planned, scene, given)}).values()
        base = WaveNumerics(**default.reached.settings)
        marked, known = {base: base.tolerance}, {base: default}
    truth, points = body.exact(scene), list[Point]()
    if truth is None:
        finer = {**given, "tolerance": SHARE * base.tolerance}
        (reference,) = attempts({"what errors are measured from": partial(_planned, scene, finer)}).values()
        truth = Truth.of(reference.reached)
        points.append(_reference(reference))
    chosen = tuple(dict.fromkeys((*marked, *varied(base, given, body.variations(base, quick)))))
    elements = {
        f"finite elements {place} of {len(chosen)}": partial(_fixed, scene, numerics)
        for place, numerics in enumerate(chosen, 1)
        if numerics not in known
    }
    asked = body.lumped(quick)
    others = {
        f"law {place} of {len(asked)}: {one[0]}": partial(_lumped, scene, *one) for place, one in enumerate(asked, 1)
    }
    found = attempts(elements | others)
    left = [numerics for numerics in chosen if numerics not in known]
    known |= {numerics: found[name] for numerics, name in zip(left, elements, strict=True)}
    points += [_of_elements(numerics, known[numerics], truth, marked.get(numerics)) for numerics in chosen]
    judges = {method: exact(scene) for method, exact in body.others.items()}
    laws = zip(asked, others, strict=True)
    return (*points, *(_point(*one, found[name], judges.get(one[0], truth)) for one, name in laws))


def defaults(scene: Scene, given: Given) -> dict[float, Numerics]:
    """The planned settings of the marked tolerances, and of the one given. Raises NotReached."""
    asked = dict.fromkeys((*MARKED, float(given.get("tolerance", MARKED[0]))))
    return {tolerance: plan(scene, {**given, "tolerance": tolerance}).numerics for tolerance in asked}


def varied(base: Numerics, given: Given, changes: Iterable[Settings]) -> tuple[Numerics, ...]:
    """Settings around the default's, each once and never its own; those the user gave stay as they are."""
    kept = ({key: value for key, value in change.items() if key not in given} for change in changes)
    return tuple(numerics for numerics in dict.fromkeys(base.varied(**change) for change in kept) if numerics != base)


def _planned(scene: Scene, given: Given) -> Attempt:
    """An impact with the settings that a user gives, refined."""
    planned = tried(scene).planned
    assert planned is not None
    return _attempt(partial(planned, scene, given), NotReached)


def _fixed(scene: Scene, numerics: Numerics) -> Attempt:
    """An impact with all settings fixed, so that nothing is refined."""
    return _attempt(partial(tried(scene).run, scene, numerics), NotReached)


def _lumped(scene: Scene, method: str, settings: Settings) -> Attempt:
    """A law that answers: what it leaves out is an error however finely it is integrated."""
    return _attempt(partial(lumped, scene, method, settings), FeContactError)


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


def _of_elements(numerics: Numerics, attempt: Attempt, truth: Truth, default_for: float | None) -> Point:
    """A choice of settings; ``default_for`` the tolerance for which it is planned."""
    settings = numerics.as_dict() if attempt.answer is None else attempt.answer.settings
    return _point("fe", {**settings, "tolerance": default_for}, attempt, truth, default_for)


def _point(method: str, settings: Settings, attempt: Attempt, truth: Truth, default_for: float | None = None) -> Point:
    answer = attempt.answer
    if answer is None:
        return Point(method, settings, default_for=default_for, failure=attempt.failure)
    return Point(method, settings, attempt.cpu, truth.errors(answer), answer.bar, answer.work, default_for)


def _reference(attempt: Attempt) -> Point:
    """What errors are measured from, as a point of its own."""
    answer = attempt.reached
    work = {name: count for name, count in answer.work.items() if name != "operations"}
    return Point(REFERENCE, answer.settings, attempt.cpu, bar=answer.bar, work=work)


def finite_elements(points: Iterable[Point]) -> tuple[Point, ...]:
    """The finite-element points that have an answer."""
    return tuple(point for point in points if point.method == "fe" and not point.failure)


def front(points: Iterable[Point], cost: Measure, merit: Measure) -> tuple[Point, ...]:
    """Points than which none is at once cheaper and better, the cheapest first."""
    best, found = np.inf, []
    for point in sorted(points, key=lambda p: (cost(p), merit(p))):
        if merit(point) < best:
            best = merit(point)
            found.append(point)
    return tuple(found)


def excess(point: Point, points: Iterable[Point], merit: Measure, wanted: float) -> float:
    """Processor time of a point over the least of those whose merit is at most ``wanted``; nan if there is none."""
    equals = [other.cpu for other in points if merit(other) <= wanted]
    return point.cpu / min(equals) if equals else np.nan


def verdict(points: Iterable[Point]) -> tuple[str, ...]:
    """A sentence a default: what it costs beside the cheapest setting that does as well; whether bars cover."""
    tried, known = finite_elements(points), known_to(points)
    sentences = [_sentence(point, tried) for point in tried if point.default_for is not None]
    return (*sentences, *([f"the reference is known to {known:.1g}"] if known else []), _covered(tried, known))


def known_to(points: Iterable[Point]) -> float:
    """The bar of the reference that errors are measured from; 0 where that is exact."""
    return max((point.bar or 0.0 for point in points if point.method == REFERENCE), default=0.0)


def _covered(tried: tuple[Point, ...], known: float) -> str:
    """Of the settings that claim anything: a bar beyond every accepted tolerance says that nothing is known."""
    claiming = [point for point in tried if (point.bar or 0.0) <= WIDEST]
    covered = sum(point.error <= (point.bar or 0.0) + known for point in claiming)
    said = f"the claimed bar covers the error in {covered} of {len(claiming)} settings"
    silent = len(tried) - len(claiming)
    return f"{said}; {silent} claim nothing below {WIDEST:g}" if silent else said


def _sentence(point: Point, tried: tuple[Point, ...]) -> str:
    assert point.default_for is not None
    start = f"default for {point.default_for:g}: error {point.error:.1g}, bar {point.bar:.1g}"
    if (point.bar or 0.0) > point.default_for:
        return f"{start}; misses the tolerance, so that a run refines it"
    claimed = excess(point, tried, lambda p: p.bar or np.inf, point.default_for)
    true = excess(point, tried, lambda p: p.error, point.error)
    worst = max(claimed, true)
    place = "on" if worst == 1.0 else f"within a factor {NEAR:g} of" if worst <= NEAR else "off"
    return f"{start}; {_times(claimed)} whose bar meets the tolerance, {_times(true)} as accurate: {place} the front"


def _times(factor: float) -> str:
    """Cost beside the least."""
    return "the cheapest" if factor == 1.0 else f"{factor:.2f} times the cheapest"


def write_tradeoff(scene: Scene, points: Sequence[Point], where: Path) -> Table:
    """Write ``tradeoff.csv`` and ``tradeoff.json`` into a folder, made when it is not there; the latter's content."""
    described = [vars(point) | {"error": point.error} for point in points]
    content = {"schema": SCHEMA, "scene": scene.to_dict(), "verdict": verdict(points), "points": described}
    return write_study(where, "tradeoff", content, {"tradeoff": [_line(point) for point in points]})


def _line(point: Point) -> Line:
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
    }
