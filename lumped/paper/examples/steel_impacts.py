"""Impacts of the paper's steel ball, each computed once: the proposed model, elastic models, models of equal peak."""

from __future__ import annotations

from functools import cache

from lumped import laws, restitution
from lumped.errors import NotReached
from lumped.laws import LawKind
from lumped.laws._power_law import spring_of_peak
from lumped.materials import Material
from lumped.materials.networks import elastic, sls
from lumped.materials.relaxation import Relaxation
from lumped.paper.examples.given import Steel
from lumped.paper.examples.value import Value, read
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice, Model
from lumped.shapes import Sphere
from lumped.solvers.point.bodies import Bodies

TOLERANCE = 1e-6
EXPONENT = {"linear_spring": 1.0, "hertz": 1.5, "kelvin": 1.0, "jankowski": 1.5}
# The paper's own formulas for the damping of an asked restitution, "(7)" and "(10)".
DAMPING = {"kelvin": "anagnostopoulos", "jankowski": "equation_10"}


def scene(steel: Steel, contact_modulus: Relaxation) -> Scene:
    """The rigid ball on the half-space with this E*(t), Pa, as the paper reduces two bodies of steel to one."""
    material = Material(contact_modulus.scaled(1.0 - steel.nu**2), steel.nu)
    parabola = Model(profile="parabola")
    return Scene(Sphere(steel.radius), steel.mass, steel.velocity, material, model=parabola, name="steel ball")


@cache
def solid(steel: Steel, R1: float, R2: float, law: str = "correspondence") -> Result:
    """The 3-parameter solid with E0 = E* of "(25)"; R2 in s. Raises NotReached."""
    own = scene(steel, sls.of_ratios(E0=steel.contact_modulus, R1=R1, R2=R2))
    return _simulated(laws.get(law), own)


@cache
def hertz(steel: Steel, contact_modulus: float) -> Result:
    """The nonlinear elastic model "(4)" with the stiffness of Table 1, E* in Pa."""
    return _simulated(laws.get("hertz"), scene(steel, elastic.of(contact_modulus)))


@cache
def elastic_of_peak(steel: Steel, law: str, peak: float) -> Result:
    """`hertz` or `linear_spring` with the stiffness that makes it peak at `peak`, N."""
    return _bare(steel, law, {"k": spring_of_peak(peak, EXPONENT[law], Bodies(steel.mass, steel.velocity))})


@cache
def damped_of_peak(steel: Steel, law: str, e: float) -> Result:
    """`kelvin` or `jankowski` damped for the restitution e by the paper's own formula, at the measured peak.

    With xi held, F grows as k^(1/(1 + alpha)): mass, velocity and k have only one force among them.
    """
    xi = restitution.get(law).published[DAMPING[law]](e)
    first = spring_of_peak(steel.measured_peak, EXPONENT[law], Bodies(steel.mass, steel.velocity))
    reached = read(_bare(steel, law, {"k": first, "xi": xi}), "peak_force")
    k = first * (steel.measured_peak / reached.value) ** (1.0 + EXPONENT[law])
    return _bare(steel, law, {"k": k, "xi": xi})


@cache
def R1_of_peak(steel: Steel) -> Value:
    """The R1 with which the proposed model has the measured peak, R2 held, "(26)". Raises NotReached.

    dF/F = (2/5) dR1/(1 + R1) where the solid answers as its instantaneous spring.
    """
    from scipy.optimize import brentq

    def missing(R1: float) -> float:
        return read(solid(steel, R1, steel.R2), "peak_force").value - steel.measured_peak

    ratio = steel.measured_peak / read(hertz(steel, steel.contact_modulus), "peak_force").value
    start = ratio**2.5 - 1.0
    if start <= 0.0 or missing(0.5 * start) > 0.0 or missing(4.0 * start) < 0.0:
        message = f"no R1 makes the proposed model peak at {steel.measured_peak:g} N; accepted: above the elastic peak"
        raise NotReached(message)
    R1 = float(brentq(missing, 0.5 * start, 4.0 * start, xtol=1e-12, rtol=1e-12))
    share = read(solid(steel, R1, steel.R2), "peak_force")
    return Value(R1, 2.5 * (1.0 + R1) * share.error / share.value)


def _bare(steel: Steel, law: str, values: dict[str, float]) -> Result:
    own = Scene(None, steel.mass, steel.velocity, law=LawChoice(law, values), name=f"steel ball, {law}")
    return _simulated(laws.get(law), own)


def _simulated(law: LawKind, own: Scene) -> Result:
    return law.of(own).simulate(own, TOLERANCE)
