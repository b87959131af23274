"""A law as OpenSees' impact materials for a zeroLength element, and what OpenSees does differently.

Its strain is the relative displacement, m, negative in compression; the bodies touch where it equals the gap, which
is negative. Read from OpenSees' SRC/material/uniaxial/{ImpactMaterial,Hertzdamp,JankowskiImpact,ViscoelasticGap}.cpp.

A law that follows from a material, and remembers, has none there: the one that fits its impact best stands in for it,
and how far that departs from it at other velocities stands beside the line.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from lumped import laws
from lumped.errors import BadInput, Fault, FeContactError
from lumped.fit import Fit, fit
from lumped.fit.space import GAP
from lumped.laws._force_law import ForceLaw, between_masses, bodies_of
from lumped.laws._power_law import PowerLaw, spring_depth
from lumped.laws.base import Law, simulate
from lumped.laws.correspondence import Correspondence
from lumped.laws.hertz import HertzLaw
from lumped.laws.hertzdamp import Hertzdamp
from lumped.laws.hunt_crossley import HuntCrossley
from lumped.laws.impact_bilinear import ImpactBilinear
from lumped.laws.jankowski import Jankowski
from lumped.laws.kelvin import Kelvin
from lumped.laws.khatiwada import Khatiwada
from lumped.laws.linear_spring import LinearSpring
from lumped.laws.mahmoud import Mahmoud
from lumped.laws.mdr import SpringRow
from lumped.laws.ting import Ting
from lumped.result.history import History
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice
from lumped.schema import Table

LAWS = (LinearSpring, Kelvin, Jankowski, Mahmoud, HertzLaw, Hertzdamp, HuntCrossley, Khatiwada, ImpactBilinear)

# Laws that follow from a material, and remember: another one stands in for them.
REMEMBERING = (Correspondence, SpringRow, Ting)
# Those that OpenSees has at every velocity, the others being special cases of them; what is fitted, and chosen, as
# OpenSees does it: its gap with a dashpot pulls until the depth is zero.
STAND_INS: Mapping[str, tuple[tuple[str, ...], Table]] = {
    "kelvin": (("k", "xi"), {"exit": "depth"}),
    "jankowski": (("k", "alpha", "xi"), {}),
    "hertzdamp": (("k", "alpha", "xi"), {}),
    "impact_bilinear": (("k1", "k2", "yield_depth"), {}),
}
SHARES = tuple(3.0 ** (0.5 * i) for i in (-2, -1, 0, 1, 2))  # of the velocity: where a law is carried by default
JUDGED = ("peak_force", "peak_depth", "duration", "restitution")
FITTED_TO = 1e-6  # of the histories that are fitted and compared: far below any departure

# OpenSees stops at a gap of zero: a law without one gets this, far below any depth, m.
LEAST_GAP = 1e-12
# The command and what stands between its values; both languages comment with #.
LANGUAGES = {
    "tcl": ("uniaxialMaterial {name} {values}", " "),
    "python": ('ops.uniaxialMaterial("{name}", {values})', ", "),
}
# Newton's error with a tangent of the wrong sign shrinks 2 k/(4 m/dt^2 - k) times a step (trapezoidal rule, largest
# tangent k): 2/15 where dt is half of sqrt(m/k), not at all from 1.15 times it on.
NEWTON = 0.5
UNITS = "SI units, N, m, s; the strain of a zeroLength element is the relative displacement, negative in compression"


@dataclass(frozen=True)
class UniaxialMaterial:
    """A material by its name in OpenSees: arguments in their order, SI; `differences` from the law, in words."""

    name: str
    arguments: Mapping[str, float]
    differences: tuple[str, ...]


def check(name: str) -> None:
    """Raise BadInput for a name of no law, and for a law which OpenSees does not have and that is not stood in for."""
    laws.get(name)
    if name not in (*(law.name for law in LAWS), *(law.name for law in REMEMBERING)):
        raise _refused(name)


def material(law: Law, scene: Scene) -> UniaxialMaterial:
    """The OpenSees material of a law made for a scene. Raises BadInput."""
    match law:
        case LinearSpring():
            return _viscoelastic_gap(law, 0.0)
        case Kelvin():
            return _viscoelastic_gap(law, law.c)
        case Jankowski() | Mahmoud():
            return _jankowski_impact(law, law.c, scene)
        case HertzLaw():
            return _hertzdamp(law, 0.0, scene)
        case Hertzdamp():
            return _hertzdamp(
                law, law.xi, scene, "it takes for the velocity at touch the rate of the first step in contact"
            )
        case HuntCrossley():
            return _of_one_speed(law, law.chi, scene)
        case Khatiwada():
            return _of_one_speed(law, law.c / law.k, scene)
        case ImpactBilinear():
            return _impact_material(law)
    raise _refused(law.name)


def lines(law: Law, scene: Scene, tag: int = 1, language: str = "tcl") -> str:
    """The lines that define the material: comments, then the command in "tcl" or "python". Raises BadInput.

    For a law that remembers those of the law which stands in for it, with the gap that the scene's `[law]` says.
    Raises NotReached too where there is no such law.
    """
    if language not in LANGUAGES:
        raise BadInput(Fault("opensees", "language", f"{language!r} is not accepted; accepted: {', '.join(LANGUAGES)}"))
    if isinstance(law, REMEMBERING):
        fitted = stand_in(law, scene)
        told = [f"# {line}" for line in _departures(law, scene, fitted)]
        return "\n".join([*told, lines(between_masses(fitted.law, fitted.scene), fitted.scene, tag, language)])
    found = material(law, scene)
    command, comma = LANGUAGES[language]
    values = comma.join([str(tag), *(f"{value:.12g}" for value in found.arguments.values())])
    said = (f"{law.name}: {found.name} tag {' '.join(found.arguments)}", UNITS, *found.differences)
    return "\n".join([*(f"# {text}" for text in said), command.format(name=found.name, values=values)])


def lines_for(history: History, scene: Scene, tag: int = 1, language: str = "tcl") -> str:
    """The lines of the law that fits a scene's force history best, and how well. Raises as `stand_in` does."""
    fitted = best_fit(history, scene)
    told = f"# fitted at {scene.velocity:.6g} m/s, normalized error {fitted.error_in_words}; not elsewhere"
    return "\n".join([told, lines(between_masses(fitted.law, fitted.scene), fitted.scene, tag, language)])


def stand_in(law: Law, scene: Scene) -> Fit:
    """The law of OpenSees that fits the impact of another one best, least squares in all its numbers.

    It has the scene's gap. Raises NotReached, or BadInput, of the last law tried, where none can be fitted.
    """
    return best_fit(simulate(law, scene, FITTED_TO).history, scene)


def best_fit(history: History, scene: Scene) -> Fit:
    """The law of OpenSees that fits a force history of a scene's impact best. Raises as `stand_in` does."""
    gap = {} if scene.law is None or GAP not in scene.law.values else {GAP: scene.law.values[GAP]}
    fits, failures = list[Fit](), list[FeContactError]()
    for name, (free, choices) in STAND_INS.items():
        try:
            fits.append(fit(history, name, replace(scene, law=LawChoice(name, {**gap, **choices})), free))
        except FeContactError as failure:  # what cannot be fitted stands in for nothing, and the others may
            failures.append(failure)
    if not fits:
        raise failures[-1]
    return min(fits, key=lambda found: found.normalized_error)


def departures(law: Law, scene: Scene, found: Fit) -> dict[float, dict[str, float | None]]:
    """By velocity, m/s, and quantity: the law that stands in over the other less one.

    Of the restitution the difference; None where either has no such quantity. Raises NotReached.
    """
    other, told = between_masses(found.law, found.scene), {}
    for velocity in (share * scene.velocity for share in SHARES):
        theirs, ours = (
            simulate(one, replace(own, velocity=velocity), FITTED_TO).quantities
            for one, own in ((law, scene), (other, found.scene))
        )
        told[velocity] = {name: _departure(name, ours[name].value, theirs[name].value) for name in JUDGED}
    return told


def _departure(quantity: str, ours: float | None, theirs: float | None) -> float | None:
    if ours is None or theirs is None:
        return None
    return ours - theirs if quantity == "restitution" else ours / theirs - 1.0


def _departures(law: Law, scene: Scene, found: Fit) -> list[str]:
    """What stands in, and its table, line by line."""
    head = (
        f"OpenSees has no law with a memory: {found.law} stands in for {law.name}, fitted at {scene.velocity:.6g} m/s",
        f"normalized error {found.error_in_words}; elsewhere it departs from {law.name} by",
        f"{'m/s':>10s} {'peak force':>12s} {'peak depth':>12s} {'duration':>12s} {'restitution':>12s}",
    )
    rows = []
    for velocity, values in departures(law, scene, found).items():
        cells = (_cell(name, value) for name, value in values.items())
        rows.append(" ".join([f"{velocity:10.5g}", *(f"{cell:>12s}" for cell in cells)]))
    return [*head, *rows]


def _cell(quantity: str, value: float | None) -> str:
    if value is None:
        return "none"
    return f"{value:+.3f}" if quantity == "restitution" else f"{100.0 * value:+.2f} %"


def _refused(name: str) -> BadInput:
    known = ", ".join(sorted(law.name for law in (*LAWS, *REMEMBERING)))
    reason = f"{name} has no OpenSees material; those that have one: {known}"
    return BadInput(Fault("opensees", "law", reason))


def _gap(law: ForceLaw) -> float:
    return -max(float(law.gap), LEAST_GAP)


def _viscoelastic_gap(law: PowerLaw, c: float) -> UniaxialMaterial:
    """K depth + C rate: Kelvin's, and the linear spring."""
    pulls = "pulls until the depth is zero, where this law ends as its force returns to zero"
    differences = (pulls,) if c and law.exit == "force" else ()
    return UniaxialMaterial("ViscoelasticGap", {"K": law.k, "C": c, "gap": _gap(law)}, differences)


def _jankowski_impact(law: PowerLaw, c: float, scene: Scene) -> UniaxialMaterial:
    """Kh depth^n + 2 xi sqrt(Meff Kh depth^(n-1)) rate in the approach: Jankowski's, and with n = 1 Mahmoud's."""
    xi = c / (2.0 * math.sqrt(scene.reduced_mass * law.k))
    arguments = {"Kh": law.k, "xi": xi, "Meff": scene.reduced_mass, "gap": _gap(law), "n": law.alpha}
    return UniaxialMaterial("JankowskiImpact", arguments, (_steps(law, scene),))


def _hertzdamp(law: PowerLaw, damping: float, scene: Scene, *differences: str) -> UniaxialMaterial:
    """Kh depth^n (1 + xiNorm rate/v0)."""
    arguments = {"Kh": law.k, "xiNorm": damping, "gap": _gap(law), "n": law.alpha}
    return UniaxialMaterial("Hertzdamp", arguments, (*differences, _steps(law, scene)))


def _of_one_speed(law: PowerLaw, factor: float, scene: Scene) -> UniaxialMaterial:
    """A damping that does not follow the velocity, s/m, is Hertzdamp's at one velocity."""
    same = f"the same law at {scene.velocity:.6g} m/s only: its damping follows the rate of the first step in contact"
    return _hertzdamp(law, factor * scene.velocity, scene, same)


def _steps(law: PowerLaw, scene: Scene) -> str:
    """In which steps Newton's iteration converges all the same: those for the tangent at the largest elastic depth."""
    depth = spring_depth(law.k, law.alpha, bodies_of(scene))
    step = NEWTON * math.sqrt(scene.reduced_mass / (law.alpha * law.k * depth ** (law.alpha - 1.0)))
    told = f"take steps below {step:.2g} s at {scene.velocity:.3g} m/s, or an explicit scheme"
    return f"its tangent has the wrong sign: {told}"


def _impact_material(law: ImpactBilinear) -> UniaxialMaterial:
    """The bilinear loop; gap and yield displacement are negative."""
    arguments = {"K1": law.k1, "K2": law.k2, "Delta_y": -law.yield_depth, "gap": _gap(law)}
    whole = "the step that closes the gap loads with K1 over its whole length, its part before touch too"
    return UniaxialMaterial("ImpactMaterial", arguments, (whole,))
