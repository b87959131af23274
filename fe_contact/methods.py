"""Any method by its name: finite elements, a lumped law, or the cheapest of them that is exact enough."""

from __future__ import annotations

from fe_contact.errors import says_which_key
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


def default(scene: Scene) -> str:
    """The method of a scene that nobody chose one for: the law it names, else finite elements."""
    return FE if scene.law is None else scene.law.name


@says_which_key
def simulate(
    scene: Scene,
    method: str | None,
    table: Given,
    tolerance: float | None = None,
    progress: Progress = silent,
) -> Result:
    """One impact of ``scene`` by a method; see :func:`fe_contact.run` for the parameters and errors."""
    given, method = settings(table, tolerance, scene.source), method or default(scene)
    if method == FE:
        return _finite_elements(scene, given, progress)
    if method == "cheapest":
        return _cheapest(scene, given, progress)
    if method not in laws.available():
        names = (*OWN, *laws.available())
        raise BadInput(Fault("--method", "", f"{shown(method)}: accepted {', '.join(names)}{nearest(method, names)}"))
    return _lumped(scene, method, given)


def _lumped(scene: Scene, name: str, given: Given) -> Result:
    from fe_contact.budget.plan import DEFAULT_TOLERANCE

    found = simulate_law(laws.get(name).of(scene), scene, tolerance=given.get("tolerance", DEFAULT_TOLERANCE))
    if scene.has_geometry:
        scene.check_sunk(found.quantities["peak_depth"].value or 0.0)
    return found


def _finite_elements(scene: Scene, given: Given, progress: Progress) -> Result:
    from fe_contact.reference import fe

    return fe(scene, given, progress)


def _cheapest(scene: Scene, given: Given, progress: Progress) -> Result:
    """An exact law where it meets the tolerance, else finite elements; without geometry the scene's own law."""
    if scene.law is not None and not scene.has_geometry:
        return _lumped(scene, scene.law.name, given)
    for name in EXACT_WITH_INERTIA if scene.model.inertia else EXACT:
        try:
            result = _lumped(scene, name, given)
        except FeContactError:  # it has no answer here, which the next one may
            continue
        if result.converged:
            return result
    return _finite_elements(scene, given, progress)
