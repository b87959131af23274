"""A law as OpenSees' impact materials for a zeroLength element, and what OpenSees does differently.

Its strain is the relative displacement, m, negative in compression; the bodies touch where it equals the gap, which
is negative. Read from OpenSees' SRC/material/uniaxial/{ImpactMaterial,Hertzdamp,JankowskiImpact,ViscoelasticGap}.cpp.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from lumped.errors import BadInput, Fault
from lumped.laws._force_law import ForceLaw
from lumped.laws._power_law import PowerLaw
from lumped.laws.base import Law
from lumped.laws.hertz import HertzLaw
from lumped.laws.hertzdamp import Hertzdamp
from lumped.laws.hunt_crossley import HuntCrossley
from lumped.laws.impact_bilinear import ImpactBilinear
from lumped.laws.jankowski import Jankowski
from lumped.laws.kelvin import Kelvin
from lumped.laws.khatiwada import Khatiwada
from lumped.laws.linear_spring import LinearSpring
from lumped.laws.mahmoud import Mahmoud
from lumped.scene.scene import Scene

LAWS = (LinearSpring, Kelvin, Jankowski, Mahmoud, HertzLaw, Hertzdamp, HuntCrossley, Khatiwada, ImpactBilinear)

# OpenSees stops at a gap of zero: a law without one gets this, far below any depth, m.
LEAST_GAP = 1e-12
# The command and what stands between its values; both languages comment with #.
LANGUAGES = {
    "tcl": ("uniaxialMaterial {name} {values}", " "),
    "python": ('ops.uniaxialMaterial("{name}", {values})', ", "),
}
TANGENT = "its tangent has the wrong sign: take steps in which the mass outweighs the stiffness, or an explicit scheme"
UNITS = "SI units, N, m, s; the strain of a zeroLength element is the relative displacement, negative in compression"


@dataclass(frozen=True)
class UniaxialMaterial:
    """A material by its name in OpenSees: arguments in their order, SI; `differences` from the law, in words."""

    name: str
    arguments: Mapping[str, float]
    differences: tuple[str, ...]


def check(name: str) -> None:
    """Raise BadInput for a law which OpenSees does not have."""
    if name not in (law.name for law in LAWS):
        raise _refused(name)


def material(law: Law, scene: Scene) -> UniaxialMaterial:
    """The OpenSees material of a law made for a scene. Raises BadInput."""
    match law:
        case LinearSpring():
            return _viscoelastic_gap(law, 0.0)
        case Kelvin():
            return _viscoelastic_gap(law, law.c)
        case Jankowski() | Mahmoud():
            return _jankowski_impact(law, law.c, scene.reduced_mass)
        case HertzLaw():
            return _hertzdamp(law, 0.0)
        case Hertzdamp():
            return _hertzdamp(
                law, law.xi, "its v0 is the trial rate of the first step inside the gap, not that at touch"
            )
        case HuntCrossley():
            return _of_one_speed(law, law.chi, scene.velocity)
        case Khatiwada():
            return _of_one_speed(law, law.c / law.k, scene.velocity)
        case ImpactBilinear():
            return _impact_material(law)
    raise _refused(law.name)


def lines(law: Law, scene: Scene, tag: int = 1, language: str = "tcl") -> str:
    """The lines that define the material: comments, then the command in "tcl" or "python". Raises BadInput."""
    if language not in LANGUAGES:
        raise BadInput(Fault("opensees", "language", f"{language!r} is not accepted; accepted: {', '.join(LANGUAGES)}"))
    found = material(law, scene)
    command, comma = LANGUAGES[language]
    values = comma.join([str(tag), *(f"{value:.12g}" for value in found.arguments.values())])
    said = (f"{law.name}: {found.name} tag {' '.join(found.arguments)}", UNITS, *found.differences)
    return "\n".join([*(f"# {text}" for text in said), command.format(name=found.name, values=values)])


def _refused(name: str) -> BadInput:
    reason = f"{name} has no OpenSees material; those that have one: {', '.join(sorted(law.name for law in LAWS))}"
    return BadInput(Fault("opensees", "law", reason))


def _gap(law: ForceLaw) -> float:
    return -max(float(law.gap), LEAST_GAP)


def _viscoelastic_gap(law: PowerLaw, c: float) -> UniaxialMaterial:
    """K depth + C rate: Kelvin's, and the linear spring."""
    pulls = "pulls until the depth is zero, where this law ends as its force returns to zero"
    differences = (pulls,) if c and law.exit == "force" else ()
    return UniaxialMaterial("ViscoelasticGap", {"K": law.k, "C": c, "gap": _gap(law)}, differences)


def _jankowski_impact(law: PowerLaw, c: float, mass: float) -> UniaxialMaterial:
    """Kh depth^n + 2 xi sqrt(Meff Kh depth^(n-1)) rate in the approach: Jankowski's, and with n = 1 Mahmoud's."""
    xi = c / (2.0 * math.sqrt(mass * law.k))
    arguments = {"Kh": law.k, "xi": xi, "Meff": mass, "gap": _gap(law), "n": law.alpha}
    return UniaxialMaterial("JankowskiImpact", arguments, (TANGENT,))


def _hertzdamp(law: PowerLaw, damping: float, *differences: str) -> UniaxialMaterial:
    """Kh depth^n (1 + xiNorm rate/v0)."""
    arguments = {"Kh": law.k, "xiNorm": damping, "gap": _gap(law), "n": law.alpha}
    return UniaxialMaterial("Hertzdamp", arguments, (*differences, TANGENT))


def _of_one_speed(law: PowerLaw, factor: float, velocity: float) -> UniaxialMaterial:
    """A damping that does not follow the velocity, s/m, is Hertzdamp's at one velocity."""
    same = f"the same law at {velocity:.6g} m/s only: its damping follows the trial rate of the first step"
    return _hertzdamp(law, factor * velocity, same)


def _impact_material(law: ImpactBilinear) -> UniaxialMaterial:
    """The bilinear loop; gap and yield displacement are negative."""
    arguments = {"K1": law.k1, "K2": law.k2, "Delta_y": -law.yield_depth, "gap": _gap(law)}
    whole = "the step that closes the gap loads with K1 over its whole length, its part before touch too"
    return UniaxialMaterial("ImpactMaterial", arguments, (whole,))
