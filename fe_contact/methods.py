"""Any method by its name: finite elements, a lumped law, or the cheapest of them that is exact enough.

The methods of a scene are weighed by one rule for every command: what a law leaves out of the resolved model, then
what it costs, then the bar that it reaches. Laws answer in milliseconds, so that the first exact one is asked rather
than guessed at.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from fe_contact.errors import faults_of
from fe_contact.progress import Count, Progress, silent
from fe_contact.settings import Given, checked, tolerance_of
from lumped import laws
from lumped.errors import BadInput, Fault, FeContactError, nearest, shown
from lumped.progress import counting_steps
from lumped.result.result import Result, largest_bar, unmet
from lumped.scene.scene import Scene
from lumped.schema import Table

if TYPE_CHECKING:
    from lumped.solvers.hereditary.pieces import Followed

FE = "fe"
OWN = (FE, "cheapest")
LOADING = 0.35  # s: finite elements take no less, before they know the scene: what loading their packages takes


def settings(table: Given, tolerance: float | None, source: str) -> Table:
    """Checked settings, the tolerance taking precedence over the table's; raises BadInput."""
    given = dict(table) if tolerance is None else {**table, "tolerance": tolerance}
    return checked(given, source)


def names() -> tuple[str, ...]:
    """Of all methods."""
    return (*OWN, *laws.available())


def refusal(name: object) -> str:
    """Why this is no name of a method; empty where it is one."""
    known = names()
    if name in known:
        return ""
    hint = nearest(name, known) if isinstance(name, str) else ""
    return f"{shown(name)}: accepted {', '.join(known)}{hint}"


def default(scene: Scene) -> str:
    """The method of a scene that nobody chose one for: the law it names, else finite elements."""
    return FE if scene.law is None else scene.law.name


def simulate(
    scene: Scene,
    method: str | None,
    table: Given,
    tolerance: float | None = None,
    progress: Progress = silent,
) -> Result:
    """One impact of ``scene`` by a method; see :func:`fe_contact.run` for the parameters and errors."""
    with faults_of(scene):
        given, method = settings(table, tolerance, scene.source), default(scene) if method is None else method
        if method not in OWN:
            return _lumped(scene, method, given, progress)
        weighing = weigh(scene, given, progress) if method != FE else None
        if weighing and weighing.answer:
            return weighing.answer
        from fe_contact.reference import fe  # late: a law needs no finite elements

        found = fe(scene, given, progress)
        return replace(found, weighed=weighing.to_json()) if weighing else found


def simulation(scene: Scene, method: str, table: Given, tolerance: float | None = None) -> Followed[Result]:
    """As :func:`simulate`, by pieces, where a law has them: those of many impacts are solved together.

    For quantities alone: the history of such a law has the rows of its integration, which may lie far apart.
    """
    if method in OWN:
        return simulate(scene, method, table, tolerance)
    with faults_of(scene):
        return (yield from _by_law(scene, method, settings(table, tolerance, scene.source), dense=False))


def _lumped(scene: Scene, name: str, given: Given, progress: Progress) -> Result:
    """By a lumped law, with its steps counted. Raises BadInput for an unknown name."""
    from lumped.solvers.hereditary.pieces import alone  # late: finite elements need no law

    with counting_steps(Count.of(progress, f"time steps of {name}", 0.0)):
        return alone(_by_law(scene, name, given))


def _by_law(scene: Scene, name: str, given: Given, dense: bool = True) -> Followed[Result]:
    """By a lumped law. Raises BadInput for an unknown name."""
    if reason := refusal(name):
        raise BadInput(Fault("--method", "", reason))
    from lumped.laws.base import simulation as by_law

    found = yield from by_law(laws.get(name).of(scene), scene, tolerance_of(given), dense)
    if scene.has_geometry:
        widest = float(found.history.contact_radius.max(initial=0.0))
        scene.check_sunk(found.quantities["peak_depth"].value or 0.0, widest)
    return found


@dataclass(frozen=True)
class Weighed:
    """A method beside the others: its bar, the largest that the tolerance rules, and the processor time expected, s.

    The bar is that asked for, or the one found of a law that was asked; both None of a method that is no answer.
    `reason`: why it is taken, or is not.
    """

    method: str
    bar: float | None
    cpu_s: float | None
    reason: str
    taken: bool = False

    def __str__(self) -> str:
        if self.bar is None or self.cpu_s is None:
            return f"{self.method}: {self.reason}"
        return f"{self.method}: bar {self.bar:.1g}, {spell(self.cpu_s)}; {self.reason}"


@dataclass(frozen=True, eq=False)
class Weighing:
    """All methods of a scene, those that could answer first; ``answer``: the law's that is taken, None otherwise."""

    methods: tuple[Weighed, ...]
    answer: Result | None = None

    @property
    def taken(self) -> Weighed:
        """The method of the scene."""
        return next(one for one in self.methods if one.taken)

    def to_json(self) -> tuple[Table, ...]:
        """What result.json says of it."""
        return tuple(asdict(one) for one in self.methods)


def lines_of(weighed: Iterable[Table]) -> list[str]:
    """Of a :class:`Weighing` as result.json has it: a line for every method that could answer, one for every reason of
    others.
    """
    candidates, reasons = list[str](), dict[str, list[str]]()
    for one in (Weighed(**table) for table in weighed):
        if one.bar is None:
            reasons.setdefault(one.reason, []).append(one.method)
        else:
            candidates.append(str(one))
    return candidates + [f"{', '.join(names)}: {reason}" for reason, names in reasons.items()]


def weigh(scene: Scene, given: Given, progress: Progress = silent) -> Weighing:
    """The cheapest method whose bar is within the tolerance, and why it is that one.

    `given`: :func:`settings`. Exact laws are asked, the cheapest first, until one meets the tolerance; else it is
    finite elements. Raises BadInput, and NotReached where a scene's own law without geometry comes to no end.
    """
    tolerance = tolerance_of(given)
    exact, weighed, answer = exact_laws(scene), list[Weighed](), None
    for name in exact:
        if answer is not None:
            reason = f"as exact as {answer.method}, no cheaper"
            weighed.append(Weighed(name, tolerance, laws.get(name).seconds, reason))
            continue
        one, answer = _asked(scene, name, given, progress)
        weighed.append(one)
    weighed.append(_elements(scene, given, tolerance, answer))
    out = [Weighed(name, None, None, why_not(scene, name)) for name in laws.available() if name not in exact]
    found = Weighing((*weighed, *out), answer)
    return found if answer is None else replace(found, answer=replace(answer, weighed=found.to_json()))


def exact_laws(scene: Scene) -> tuple[str, ...]:
    """Names of the laws that are exact for the scene's resolved model, the cheapest first; of its own without geometry.

    They may still refuse a number of the scene, or not come to an end.
    """
    found = (name for name in laws.available() if not why_not(scene, name))
    return tuple(sorted(found, key=lambda name: laws.get(name).seconds))


def why_not(scene: Scene, name: str) -> str:
    """Why a law cannot stand for the scene's model: it refuses the scene, or leaves something out; empty if it can."""
    if not scene.has_geometry:
        own = scene.law is not None and scene.law.name == name
        return "" if own else "the scene has the parameters of another law"
    kind = laws.get(name)
    if left := kind.leaves_out(scene):
        return f"leaves out {left}"
    try:
        kind.of(scene)
    except BadInput as refused:
        return f"refuses {'; '.join(f'{fault.key}: {fault.message}' for fault in refused.faults)}"
    return ""


def _asked(scene: Scene, name: str, given: Given, progress: Progress) -> tuple[Weighed, Result | None]:
    """An exact law's answer, None where it has none that meets the tolerance."""
    try:
        found = _lumped(scene, name, given, progress)
    except FeContactError as refused:
        if not scene.has_geometry:
            raise
        return Weighed(name, None, None, f"has no answer: {refused}"), None
    bar, cpu = largest_bar(found.quantities), laws.get(name).seconds
    if not found.converged and scene.has_geometry:
        followed = unmet(found.quantities, found.tolerance)  # to the end of the impact, but not finely enough
        return Weighed(name, bar if followed else None, cpu, f"has no answer: {found.message}"), None
    return Weighed(name, bar, cpu, "exact for this model, and the cheapest", taken=True), found


def _elements(scene: Scene, given: Given, tolerance: float, answer: Result | None) -> Weighed:
    """Finite elements as they are expected to be, beside a law that answers or alone."""
    if not scene.has_geometry:
        return Weighed(FE, None, None, "needs a shape and a material")
    if answer is not None:
        return Weighed(FE, tolerance, LOADING, "no better, and loading them takes longer")
    from fe_contact.reference import expected  # late: a law needs no finite elements

    try:
        tolerance, seconds = expected(scene, given)
    except FeContactError as refused:  # as a run would say
        return Weighed(FE, None, None, f"has no answer: {refused}", taken=True)
    return Weighed(FE, tolerance, LOADING + seconds, "no exact law of this model meets the tolerance", taken=True)


def spell(seconds: float) -> str:
    """A processor time to a digit or two."""
    return f"{1e3 * seconds:.0f} ms" if seconds < 1.0 else f"{seconds:.2g} s"
