"""What accuracy costs where bodies have inertia: error against exact waves, or against a finer reference, over time.

A point is what a user gets who fixes all settings: the impact with its bars, every operator built again. The default
is what a user gets who fixes none, its refinements paid for. Where no exact waves are known the reference is asked for
a quarter of the tolerance, and what lies within its bar cannot be told from it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

from fe_contact.numerics import KEYS, WAVES
from fe_contact.progress import Progress
from fe_contact.validation.point import REFERENCE, Point, largest_bar, timed
from fe_contact.validation.truth import Truth
from fe_contact.waves.numerics import WaveNumerics
from lumped import laws, simulate
from lumped.errors import FeContactError, NotReached
from lumped.members import get
from lumped.result import Result
from lumped.scene import Scene

TARGETS = "fe_contact.validation.waves"
SHARE = 0.25  # of the tolerance, asked of a reference
LAWS = ("rod_waves", "mdr", "hertz")  # exact waves, and what is without any
LAW_TOLERANCE = 1e-6
BRIEF, REPEATS = 0.5, 3  # s; what takes less is run again, for the least of so many times


def tradeoff(scene: Scene, given: Mapping[str, Any], quick: bool, progress: Progress) -> tuple[Point, ...]:
    """Measure every point of the study.

    Raises BadInput for a target whose waves have no trade-off, NotReached where default or reference have no answer.
    """
    study = get(TARGETS, scene.target.name, scene.source, "target.shape").of(scene)
    run = partial(_run, scene, study)
    progress("finite elements as planned")
    default, cpu = _timed(partial(run, given))
    base = WaveNumerics(**default.numerics)
    progress("what errors are measured from")
    truth, reference = _truth(study.exact(scene), partial(run, {**given, "tolerance": SHARE * base.tolerance}))
    points = [*reference, _point(default, truth, cpu, study, base.tolerance)]
    chosen = _chosen(base, given, study.variations(base, quick))
    for count, numerics in enumerate(chosen, 1):
        progress("finite elements", count - 1, len(chosen))
        points.append(_varied(numerics, truth, study, run))
    return (*points, *_laws(scene, truth))


def _run(scene: Scene, study: Any, given: Mapping[str, Any]) -> Result:
    """An impact with no operator at hand."""
    study.forget()
    result: Result = get(WAVES, scene.target.name).fe(scene, given)
    return result


def _timed(run: Callable[[], Result]) -> tuple[Result, float]:
    """What a run gives and what it costs, s; the brief are run several times."""
    found, cpu = timed(run, 1)
    return (found, cpu) if cpu > BRIEF else (found, min(cpu, timed(run, REPEATS - 1)[1]))


def _truth(exact: Truth | None, finer: Callable[[], Result]) -> tuple[Truth, tuple[Point, ...]]:
    """The exact waves, or the reference and its own point."""
    if exact is not None:
        return exact, ()
    result, cpu = timed(finer, 1)
    truth = Truth.of(result)
    return truth, (Point(REFERENCE, result.numerics, cpu, bar=truth.bar, work=result.work),)


def _chosen(
    base: WaveNumerics, given: Mapping[str, Any], changes: Iterator[Mapping[str, Any]]
) -> tuple[WaveNumerics, ...]:
    """Settings around the default's, each once and never its own; those the user gave stay as they are."""
    kept = ({key: value for key, value in change.items() if key not in given} for change in changes)
    return tuple(numerics for numerics in dict.fromkeys(base.varied(**change) for change in kept) if numerics != base)


def _varied(numerics: WaveNumerics, truth: Truth, study: Any, run: Callable[[Mapping[str, Any]], Result]) -> Point:
    """A point with all settings fixed, so that nothing is refined."""
    settings = {key: value for key, value in numerics.as_dict().items() if key in KEYS}
    try:
        result, cpu = _timed(partial(run, settings))
    except NotReached as failure:
        return Point("fe", numerics.as_dict(), failure=str(failure))
    return _point(result, truth, cpu, study)


def _point(result: Result, truth: Truth, cpu: float, study: Any, default_for: float | None = None) -> Point:
    work = dict(result.work) | {"operations": study.operations(result.work)}
    settings = {**result.numerics, "tolerance": default_for}
    return Point("fe", settings, cpu, truth.errors(result), largest_bar(result), work, default_for)


def _laws(scene: Scene, truth: Truth) -> Iterator[Point]:
    """The laws that answer, each once: what they leave out is an error however finely they are integrated."""
    for name in LAWS:
        settings = {"tolerance": LAW_TOLERANCE}
        try:
            result, cpu = _timed(partial(_law, scene, name))
        except FeContactError as failure:
            yield Point(name, settings, failure=str(failure))
            continue
        yield Point(name, settings, cpu, truth.errors(result), largest_bar(result), dict(result.work))


def _law(scene: Scene, name: str) -> Result:
    return simulate(laws.get(name).of(scene), scene, LAW_TOLERANCE)
