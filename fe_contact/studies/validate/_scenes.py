"""A packaged scene answered: against an exact law where one has an answer, against what is published of it.

A scene's error over its bar is the difference of two answers over the sum of both bars: up to 1 both can be true.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fe_contact.methods import FE, exact_laws, simulate
from fe_contact.studies.references import Move, Reference, folder, moves
from lumped import laws
from lumped import simulate as simulate_law
from lumped.errors import FeContactError
from lumped.numbers import Array
from lumped.result.history import History
from lumped.result.result import NO_KEY, Quantity, Result, worst
from lumped.scene.scene import Scene
from lumped.scene.tables import load
from lumped.schema.files import SCENES

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
