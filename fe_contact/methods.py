"""Any method by its name: finite elements, a lumped law, or the cheapest of them that is exact enough."""

from __future__ import annotations

import numpy as np

from fe_contact.errors import faults_of
from fe_contact.progress import Progress, silent
from fe_contact.settings import Given, checked
from lumped import laws
from lumped import simulate as simulate_law
from lumped.errors import BadInput, Fault, FeContactError, nearest, shown
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema import Table

FE = "fe"
EXACT = ("mdr", "ting")  # exact in milliseconds: the row of springs on the half-space, Ting on any load curve
EXACT_WITH_INERTIA = ("rod_waves",)
OWN = (FE, "cheapest")


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
    hint = nearest(name, known) if isinstance(name, str) else ""
    return "" if name in known else f"{shown(name)}: accepted {', '.join(known)}{hint}"


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
        given, method = settings(table, tolerance, scene.source), method or default(scene)
        if method not in OWN:
            return _lumped(scene, method, given)
        result = exact(scene, given) if method != FE else None
        if result is None:
            from fe_contact.reference import fe  # late: a law needs no finite elements

            result = fe(scene, given, progress)
        return result


def _lumped(scene: Scene, name: str, given: Given) -> Result:
    """By a lumped law. Raises BadInput for an unknown name."""
    from fe_contact.budget.plan import DEFAULT_TOLERANCE

    if reason := refusal(name):
        raise BadInput(Fault("--method", "", reason))
    found = simulate_law(laws.get(name).of(scene), scene, tolerance=given.get("tolerance", DEFAULT_TOLERANCE))
    if scene.has_geometry:
        widest = float(np.nanmax(found.history.contact_radius, initial=0.0))
        scene.check_sunk(found.quantities["peak_depth"].value or 0.0, widest)
    return found


def exact(scene: Scene, given: Given) -> Result | None:
    """By the cheapest exact law, None where none meets the tolerance; without geometry by the scene's own law.

    `given`: :func:`settings`. Raises BadInput, and NotReached where the scene's own law does not come to an end.
    """
    if scene.law is not None and not scene.has_geometry:
        return _lumped(scene, scene.law.name, given)
    for name in EXACT_WITH_INERTIA if scene.model.inertia else EXACT:
        try:
            result = _lumped(scene, name, given)
        except FeContactError:  # it has no answer here, which the next one may
            continue
        if result.converged:
            return result
    return None
