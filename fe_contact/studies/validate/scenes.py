"""Every packaged scene: what was held against what, and by how much of its bar it errs.

Against an exact law where one has an answer, and against what is published of it. A scene's error over its bar is the
difference of two answers over the sum of both bars: up to 1 both can be true.
"""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.methods import FE, exact_laws, simulate
from fe_contact.studies import journal
from fe_contact.studies.files import Line, write_study
from fe_contact.studies.references import Move, Reference, folder, moves
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns
from lumped import laws
from lumped import simulate as simulate_law
from lumped.errors import FeContactError
from lumped.numbers import Array
from lumped.result.history import History
from lumped.result.result import NO_KEY, Quantity, Result, worst
from lumped.scene.scene import Scene
from lumped.scene.tables import load
from lumped.schema.csv_file import write_columns
from lumped.schema.files import SCENES

SCHEMA = "fe-contact/validate-scenes/1"
KEPT, HISTORIES = "scenes.jsonl", "histories.json"
DIGITS = 5  # look: of a curve that is drawn
MOST = 2  # look: scenes that the first screen names of a kind
TOLD = ("peak_force", "peak_depth", "duration", "restitution")
BESIDE = ("correspondence", "hertz", "kelvin", "jankowski", "hunt_crossley")  # laws that a reader may switch on
TIGHT = 1e-5  # asked of exact laws, a hundredth of what elements are asked for
DRAWN = 5e-4  # look: of the peak, by which a curve that is drawn may miss the rows of its history
LONG = ("-waves", "-finite", "-plastic")  # how names end that a quick answer leaves out: they take minutes
PLATEAU = 1e-6  # rounding: of an exact force, within which it is as high as its peak


@dataclass(frozen=True, eq=False)
class SceneCurve:
    """A force, N, at times, s, and the half-width of its bar, N; (n,) each."""

    time: Array
    force: Array
    error: Array


@dataclass(frozen=True, eq=False)
class SceneAnswer:
    """What is known of a scene: its quantities with their bars, and the ``curves`` of its force by name.

    ``exact``: the law that it was held against, empty without one, and the ``differences`` of all quantities;
    ``published``: the same against what is published. ``larger``: the effect that the model leaves out beyond the
    tolerance, empty where none, its ``estimate`` over the peak force, the ``key`` of the larger model. ``missed``: why
    the tolerance is not reached; ``failure``: why nothing is known.
    """

    scene: str
    method: str = ""
    tolerance: float = math.nan
    quantities: Mapping[str, Quantity] = field(default_factory=dict)
    exact: str = ""
    differences: tuple[Move, ...] = ()
    published: tuple[Move, ...] = ()
    larger: str = ""
    estimate: float | None = None
    key: str = ""
    missed: str = ""
    failure: str = ""
    curves: Mapping[str, SceneCurve] = field(default_factory=dict)

    @property
    def ratio(self) -> float:
        """The largest error over its bar; infinite where one answer alone is defined, NaN without an exact one."""
        return largest(self.differences)

    @property
    def agrees(self) -> bool:
        """Whether every quantity agrees with the exact law, the struck history too."""
        return self.ratio <= 1.0


def largest(found: Sequence[Move]) -> float:
    """The largest of some differences over both bars; NaN of none."""
    return max((one.size for one in found), default=math.nan)


def answered(name: str) -> SceneAnswer:
    """One packaged scene by its default method and its own settings; what fails with a name is told in it."""
    try:
        scene, table = load(Scene, name)
        found = simulate(scene, None, table)
        law, exact = _exact(scene) if found.method == FE else ("", None)
    except FeContactError as failure:
        return SceneAnswer(name, failure=" ".join(str(failure).split()))
    drawn = {one.method: one for one in (found, exact, *_beside(scene, found, law)) if one}
    return SceneAnswer(
        name,
        found.method,
        found.tolerance,
        found.quantities,
        law,
        () if exact is None else tuple(_differences(name, exact, found)),
        moves(name, Reference.read(folder(), name), found),
        *_larger(found),
        missed=found.message if not found.converged else "",
        curves={one: _drawn(result.history) for one, result in drawn.items()},
    )


def _exact(scene: Scene) -> tuple[str, Result | None]:
    """The first exact law that has an answer; none where none has."""
    for name in exact_laws(scene):
        found = _by_law(scene, name, TIGHT)
        if found is not None and found.converged:
            return name, found
    return "", None


def _by_law(scene: Scene, name: str, tolerance: float) -> Result | None:
    """A law's answer; none where it refuses the scene or comes to no end."""
    try:
        return simulate_law(laws.get(name).of(scene), scene, tolerance=tolerance)
    except FeContactError:
        return None


def _beside(scene: Scene, found: Result, exact: str) -> list[Result]:
    """Lumped laws that take their parameters from the scene's geometry, but for those that were asked before."""
    if not scene.has_geometry:
        return []
    tried = (_by_law(scene, name, found.tolerance) for name in BESIDE if name not in (found.method, exact))
    return [one for one in tried if one is not None]


def _differences(name: str, exact: Result, found: Result) -> Iterator[Move]:
    """What a result differs by from the exact one; on a plateau of the exact force every time is that of its peak."""
    when, peak = found.quantities["peak_time"].value or 0.0, exact.quantities["peak_force"].value or 0.0
    flat = float(exact.history.force_at(when)) >= (1.0 - PLATEAU) * peak
    for move in moves(name, Reference(exact.history, exact.quantities), found):
        yield replace(move, moved=0.0) if flat and move.quantity == "peak_time" else move


def _larger(found: Result) -> tuple[str, float | None, str]:
    """The effect that the model leaves out beyond the tolerance, how large it is, the key of the larger model."""
    if found.model_sufficient:
        return "", None, ""
    most = worst(found.model_ledger)
    return most.effect, most.estimate, most.key or NO_KEY


def _drawn(history: History) -> SceneCurve:
    """The fewest rows between which straight lines, of the force and of its bar, look the same."""
    columns = np.array([history.force, history.force_error])
    rows = thinned(history.time, columns, DRAWN * float(np.abs(history.force).max()))
    return SceneCurve(history.time[rows], history.force[rows], history.force_error[rows])


def thinned(time: Array, columns: Array, allowed: float) -> list[int]:
    """Places of the rows to keep of columns (k, n) over time (n,) so that straight lines between them miss no other row
    by more than is ``allowed``.
    """
    kept, left = {0, time.size - 1}, [(0, time.size - 1)]
    while left:
        first, last = left.pop()
        inside, width = slice(first + 1, last), time[last] - time[first]
        share = (time[inside] - time[first]) / width if width > 0.0 else np.zeros(last - first - 1)
        start, end = columns[:, first, None], columns[:, last, None]
        off = np.abs(columns[:, inside] - (start + share * (end - start))).max(axis=0)
        if off.size and off.max() > allowed:
            most = first + 1 + int(off.argmax())
            kept.add(most)
            left += [(first, most), (most, last)]
    return sorted(kept)


def chosen(quick: bool) -> tuple[str, ...]:
    """Names of the scenes that are answered, the long ones first."""
    names = [name for name in SCENES.names if not (quick and _is_long(name))]
    return tuple(sorted(names, key=lambda name: (not _is_long(name), name)))


def _is_long(name: str) -> bool:
    return name.endswith(LONG)


def make(asked: base.Request) -> base.Made:
    """All scenes; rows are kept one by one."""
    names = chosen(asked.quick)
    calls = {name: partial(answered, name) for name in names}
    found = journal.rows(asked.where / KEPT, calls, asked.progress, asked.jobs)
    return of_answers([found[name] for name in sorted(names)], [*sorted({*SCENES.names} - {*names})])


def of_answers(found: Sequence[SceneAnswer], left_out: Sequence[str] = ()) -> base.Made:
    """The section of such answers, and of the scenes that were not asked."""
    return base.Made(
        base.Section(
            headlines(found),
            tuple(sentences(found, left_out)),
            (
                base.Figure(
                    "scenes", "Error over its bar, quantity by quantity, against the exact answer", ("checks.csv",)
                ),
            ),
            (SCENES_TABLE, CHECKS_TABLE),
            _worst(found),
            HISTORIES,
            missed="; ".join(short(found)),
        ),
        (partial(write, found),),
    )


def headlines(found: Sequence[SceneAnswer]) -> tuple[base.Headline, ...]:
    """What was held against what and whether it held; which scenes need a larger model."""
    held = [one for one in found if one.exact]
    elements = [one for one in found if one.method == FE]
    apart = [one.scene for one in held if not one.agrees]
    names = ", ".join(sorted({one.exact.replace("_", " ") for one in held}))
    but = f", all but {base.named(apart, MOST)}" if apart else ""
    said = (
        f"{len(held) - len(apart)} of {len(held)} scenes by finite elements agree with an exact answer ({names}) "
        f"within both error bars{but}; {len(elements) - len(held)} more have an error bar, and no exact answer."
    )
    return base.Headline(base.DIFFERS if apart else base.VERIFIED, said), _model(found)


def _model(found: Sequence[SceneAnswer]) -> base.Headline:
    """Which scenes need a larger model, by what it would follow."""
    needed = defaultdict[str, list[str]](list)
    for one in sorted(found, key=lambda one: -(one.estimate or 0.0)):
        if one.larger:
            needed[one.larger].append(one.scene)
    if not needed:
        return base.Headline(base.HOLDS, "No scene needs a larger model at its tolerance.")
    said = "; ".join(f"{effect}: {base.named(names, MOST)}" for effect, names in needed.items())
    count = sum(map(len, needed.values()))
    return base.Headline(base.LARGER, f"{count} of {len(found)} scenes need a larger model at their tolerance. {said}.")


def sentences(found: Sequence[SceneAnswer], left_out: Sequence[str]) -> list[str]:
    """What was left out, what moved since it was published, what failed or missed its tolerance."""
    published = [one for one in found if one.published]
    moved = [one.scene for one in published if not largest(one.published) <= 1.0]
    said = [f"{len(published) - len(moved)} of {len(published)} answers agree with what is published of them, in "
            f"data/references/{': all but ' + ', '.join(moved) if moved else ''}."]  # fmt: skip
    if left_out:
        said.append(f"Left out of a quick answer, for they take minutes: {', '.join(left_out)}.")
    return [*said, *short(found)]


def short(found: Sequence[SceneAnswer]) -> list[str]:
    """Which scenes have no answer, or none within their tolerance, and why."""
    failed = [f"{one.scene}: no answer: {one.failure}" for one in found if one.failure]
    return [*failed, *(f"{one.scene}: {one.missed}" for one in found if one.missed)]


def _worst(found: Sequence[SceneAnswer]) -> base.Worst | None:
    pairs = [(one, move) for one in found for move in one.differences]
    if not pairs:
        return None
    one, most = max(pairs, key=lambda pair: pair[1].size)
    place = f"{one.scene}, {most.quantity} against {one.exact}".replace("_", " ")
    return base.Worst(most.moved, len(pairs), place)


SCENES_TABLE = base.Listing(
    "scenes.csv",
    "Every scene, its answer and its bars",
    (
        *columns("scene", "method"),
        Column("peak_force_N", "peak force, N", "peak_force_error_N"),
        Column("peak_depth_m", "peak depth, m", "peak_depth_error_m"),
        Column("duration_s", "duration, s", "duration_error_s"),
        Column("restitution", "restitution", "restitution_error"),
        Column("exact", "exact answer"),
        *columns("error_over_bar", "tolerance_reached"),
        Column("larger_model", "needs a larger model for"),
        Column("share_of_peak", "share of the peak"),
        Column("key", "selected by"),
    ),
)
CHECKS_TABLE = base.Listing(
    "checks.csv",
    "Every quantity against its exact answer",
    (
        Column("scene", "scene"),
        Column("exact", "exact answer"),
        Column("quantity", "quantity"),
        Column("exact_value", "exact"),
        Column("found", "finite elements"),
        Column("bars", "both bars"),
        Column("error_over_bar", "error over bar"),
    ),
)


def _line(one: SceneAnswer) -> Line:
    """A row of scenes.csv."""
    cells: dict[str, object] = {"scene": one.scene, "method": one.method or None}
    for name in TOLD:
        quantity = one.quantities.get(name, Quantity(None, None, "1"))
        unit = "" if name == "restitution" else "_N" if name == "peak_force" else "_m" if "depth" in name else "_s"
        cells |= {f"{name}{unit}": quantity.value, f"{name}_error{unit}": quantity.error}
    return cells | {
        "exact": one.exact or None,
        "error_over_bar": None if math.isnan(one.ratio) else one.ratio,
        "tolerance": one.tolerance,
        "tolerance_reached": "no answer" if one.failure else "no" if one.missed else "yes",
        "larger_model": one.larger or None,
        "share_of_peak": one.estimate,
        "key": one.key or None,
        "said": one.failure or one.missed or None,
    }


def _checks(one: SceneAnswer) -> list[Line]:
    """Rows of checks.csv."""
    return [
        {
            "scene": one.scene,
            "exact": one.exact,
            "quantity": move.quantity,
            "exact_value": move.published,
            "found": move.found,
            "bars": move.bars,
            "error_over_bar": move.moved,
        }
        for move in one.differences
    ]


def write(found: Sequence[SceneAnswer], where: Path) -> None:
    """Write ``scenes.csv``, ``checks.csv``, ``scenes.json``, a CSV a curve, ``histories.json`` and the chart."""
    from fe_contact.studies.validate._chart import plot_scenes

    lines = {"scenes": [_line(one) for one in found], "checks": [line for one in found for line in _checks(one)]}
    headers = {"checks": ("scene", "exact", "quantity", "exact_value", "found", "bars", "error_over_bar")}
    write_study(where, "scenes", {"schema": SCHEMA, "scenes": lines["scenes"]}, lines, headers)
    for one in found:
        _write_curves(one, where)
    histories = {one.scene: _histories(one) for one in found if one.curves}
    (where / HISTORIES).write_text(json.dumps(histories, separators=(",", ":")), encoding="utf-8")
    held = {f"{one.scene}  ({one.exact.replace('_', ' ')})": one.differences for one in found if one.differences}
    plot_scenes(held, where)


def _write_curves(one: SceneAnswer, where: Path) -> None:
    """A CSV a curve: each has times of its own."""
    for name, curve in one.curves.items():
        columns = [curve.time, curve.force, curve.error]
        write_columns(where / f"{one.scene}-{name}.csv", ("time_s", "force_N", "force_error_N"), columns)


def _histories(one: SceneAnswer) -> dict[str, object]:
    """The curves of a scene as the page draws them, and which of them is exact."""
    columns = ("time", "force", "error")
    curves = {name: {key: _rounded(getattr(curve, key)) for key in columns} for name, curve in one.curves.items()}
    return {"exact": one.exact, "curves": curves}


def _rounded(column: Array) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in column]


MEMBER = base.ReportPart(
    rank=10,
    title="Packaged scenes",
    question="Do finite elements give the exact answer, where there is one, within the error bar that they claim?",
    command="fe-contact validate --sections scenes",
    make=make,
    seconds=146,
    quick="scenes that take minutes",
)
