"""Any method by its name: finite elements, a lumped law, or the cheapest of them that is exact enough."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fe_contact.numerics import checked
from fe_contact.progress import Progress, silent
from lumped import laws
from lumped import simulate as simulate_law
from lumped.errors import BadInput, Fault, nearest
from lumped.result import Result
from lumped.scene import Scene

FE = "fe"
EXACT = "mdr"  # exact for a rigid striker on a homogeneous half-space, in milliseconds
OWN = (FE, "cheapest")


def settings(table: Mapping[str, Any], tolerance: float | None, source: str) -> dict[str, Any]:
    """Checked settings, the tolerance taking precedence over the table's; raises BadInput."""
    given = dict(table) if tolerance is None else {**table, "tolerance": tolerance}
    return checked(given, source)


def default(scene: Scene) -> str:
    """The method of a scene that nobody chose one for: the law it names, else finite elements."""
    return FE if scene.law is None else scene.law.name


def simulate(
    scene: Scene,
    method: str | None,
    table: Mapping[str, Any],
    tolerance: float | None = None,
    progress: Progress = silent,
) -> Result:
    """One impact of ``scene`` by a method; see :func:`fe_contact.run` for the parameters and errors."""
    given, method = settings(table, tolerance, scene.source), method or default(scene)
    if method == FE:
        from fe_contact.reference import fe

        return fe(scene, given, progress)
    name = _cheapest(scene) if method == "cheapest" else method
    if name not in laws.available():
        names = (*OWN, *laws.available())
        raise BadInput(Fault("--method", "", f"{method!r}: accepted {', '.join(names)}{nearest(method, names)}"))
    from fe_contact.plan import DEFAULT_TOLERANCE

    return simulate_law(laws.get(name).of(scene), scene, tolerance=given.get("tolerance", DEFAULT_TOLERANCE))


def _cheapest(scene: Scene) -> str:
    """The exact law of a geometry; without one there is only the scene's own law."""
    return EXACT if scene.has_geometry or scene.law is None else scene.law.name
