"""Impacts of the paper's steel ball, each computed once: the proposed model, elastic models, models of equal peak."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from lumped import laws, restitution
from lumped.errors import NotReached
from lumped.laws._power_law import spring_of_peak
from lumped.laws.correspondence import HereditaryForce, law_of
from lumped.materials import Material
from lumped.materials.networks import elastic, sls
from lumped.materials.relaxation import Relaxation
from lumped.numbers import Array
from lumped.paper.given import Examples, RingLining, Steel
from lumped.paper.value import (
    MICRO,
    PERCENT,
    Value,
    Values,
    change,
    duration,
    peak,
    read,
    spread,
    times,
)  # fmt: skip
from lumped.result.result import Result
from lumped.result.score import normalized_error
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice, Model
from lumped.shapes import Sphere
from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.contact import Contact, PointMotion, contact
from lumped.solvers.point.memory import FreeSurface
from lumped.solvers.point.track import Outcome, PointTrack, outcome_of

TOLERANCE = 1e-6  # of the impacts by the laws
# Physics: of the depth in the elastic force, by law.
EXPONENT = {"linear_spring": 1.0, "hertz": 1.5, "kelvin": 1.0, "jankowski": 1.5}
R2_WIDTH = 1e-4  # of ln R2, where the lowest peak is sought
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
    return _simulated(law, own)


@cache
def hertz(steel: Steel, contact_modulus: float) -> Result:
    """The nonlinear elastic model "(4)" with the stiffness of Table 1, E* in Pa."""
    return _simulated("hertz", scene(steel, elastic.of(contact_modulus)))


@cache
def elastic_of_peak(steel: Steel, law: str, force: float) -> Result:
    """`hertz` or `linear_spring` with the stiffness that makes it peak at a force, N."""
    return _bare(steel, law, {"k": spring_of_peak(force, EXPONENT[law], Bodies(steel.mass, steel.velocity))})


@cache
def damped_of_peak(steel: Steel, law: str, e: float) -> Result:
    """`kelvin` or `jankowski` damped for the restitution e by the paper's own formula, at the measured peak.

    With xi held, F grows as k^(1/(1 + alpha)): mass, velocity and k have only one force among them.
    """
    xi = restitution.get(law).published[DAMPING[law]](e)
    first = spring_of_peak(steel.measured_peak, EXPONENT[law], Bodies(steel.mass, steel.velocity))
    reached = peak(_bare(steel, law, {"k": first, "xi": xi}))
    k = first * (steel.measured_peak / reached.value) ** (1.0 + EXPONENT[law])
    return _bare(steel, law, {"k": k, "xi": xi})


@cache
def R1_of_peak(steel: Steel) -> Value:
    """The R1 with which the proposed model has the measured peak, R2 held, "(26)". Raises NotReached.

    dF/F = (2/5) dR1/(1 + R1) where the solid answers as its instantaneous spring.
    """
    from scipy.optimize import brentq

    def missing(R1: float) -> float:
        return peak(solid(steel, R1, steel.R2)).value - steel.measured_peak

    ratio = steel.measured_peak / peak(hertz(steel, steel.contact_modulus)).value
    start = ratio**2.5 - 1.0
    if start <= 0.0 or missing(0.5 * start) > 0.0 or missing(4.0 * start) < 0.0:
        message = f"no R1 makes the proposed model peak at {steel.measured_peak:g} N; accepted: above the elastic peak"
        raise NotReached(message)
    R1 = float(brentq(missing, 0.5 * start, 4.0 * start, xtol=1e-12, rtol=1e-12))
    share = peak(solid(steel, R1, steel.R2))
    return Value(R1, 2.5 * (1.0 + R1) * share.error / share.value)


def proposed(e: Examples) -> Result:
    """The proposed model as printed."""
    return solid(e.steel, e.steel.R1, e.steel.R2)


def theoretical(e: Examples) -> Result:
    """The nonlinear elastic model with E* as printed."""
    return hertz(e.steel, e.steel.contact_modulus)


def contact_modulus(e: Examples) -> float:
    """E_s/(2 (1 - nu_s^2)), "(23)", Pa."""
    return e.steel.young / (2.0 * (1.0 - e.steel.nu**2))


def relaxation_time(of: Steel | RingLining) -> float:
    """tau = R2/(1 + R1), s."""
    return of.R2 / (1.0 + of.R1)


def springs(E0: float, R1: float, R2: float) -> list[float]:
    """E1, E2, Pa, and C1, Pa s, of a 3-parameter solid, "(24)" and "(25)"."""
    series = E0 * (1.0 + R1)
    return [series / R1, series, R2 * series / R1]


def damped_peak_times(e: Examples, law: str) -> list[Value]:
    """In us, one an assumed restitution."""
    return [times(damped_of_peak(e.steel, law, asked))[0] for asked in e.steel.restitutions]


def pulse_momenta(e: Examples) -> list[Value]:
    """m v of elastic pulses with the printed peaks and durations over the ball's: above one more leaves than came.

    F T/(m v) of a nonlinear elastic pulse is one number, whatever its stiffness.
    """
    own = peak(theoretical(e)) * duration(theoretical(e))
    return [F * T / own for F, T in zip(e.steel.pulse_peaks, e.steel.pulse_durations, strict=True)]


def pulse_distance(e: Examples) -> Value:
    """Error "(20)" between the two nonlinear elastic pulses of equal impulse with the printed peaks, %.

    By the triangle inequality it lies between the difference and the sum of their errors against the experiment.
    """
    printed = e.steel.measured_peak, e.steel.theoretical_peak
    one, other = (elastic_of_peak(e.steel, "hertz", force) for force in printed)
    errors = (read(result, "history_l2").error + result.tolerance for result in (one, other))
    return Value(normalized_error(one.history, other.history), sum(errors)) * PERCENT


def from_elastic(e: Examples, R1: float) -> list[Value]:
    """Changes of peak and duration from R2 without end to its threshold."""
    still, damped = hertz(e.steel, e.steel.contact_modulus * (1.0 + R1)), solid(e.steel, R1, e.grids.stiff_R2)
    return [change(reading(still), reading(damped)) for reading in (peak, duration)]


def fig7(e: Examples, panel: str, of: Callable[[Iterable[float]], float]) -> Result:
    """The curve of a panel at the smallest (`min`) or the largest (`max`) R1."""
    return solid(e.steel, of(e.grids.fig7_R1), e.grids.fig7_R2["abcd".index(panel)])


def ends_7(e: Examples, panel: str, reading: Callable[[Result], Value]) -> tuple[Value, Value]:
    """At the smallest and at the largest R1 of a panel of Fig. 7."""
    return reading(fig7(e, panel, min)), reading(fig7(e, panel, max))


def impulse_shares_7a(e: Examples) -> list[Value]:
    """J/(2 m v) at the smallest and at the largest R1 of Fig. 7(a)."""
    reversal = 2.0 * e.steel.mass * e.steel.velocity
    return [read(fig7(e, "a", of), "impulse") * (1.0 / reversal) for of in (min, max)]


def from_7a_to_7b(e: Examples, R1s: Iterable[float], reading: Callable[[Result], Value]) -> list[Value]:
    """Changes of a reading where R2 falls from that of the first panel to that of the second, one an R1."""
    first, second = e.grids.fig7_R2[:2]
    return [change(reading(solid(e.steel, R1, first)), reading(solid(e.steel, R1, second))) for R1 in R1s]


def spreads_7(e: Examples, R2: float) -> list[Value]:
    """Of the peaks and of the durations over the R1 of Fig. 7."""
    curves = [solid(e.steel, R1, R2) for R1 in e.grids.fig7_R1]
    return [spread(map(reading, curves)) for reading in (peak, duration)]


def peaks_8(e: Examples) -> list[list[Value]]:
    """One list a panel of Fig. 8, R2 falling."""
    return [[peak(solid(e.steel, R1, R2)) for R2 in e.grids.fig8_R2] for R1 in e.grids.fig8_R1]


def lowest_8a(e: Examples) -> Values:
    """The lowest peak at the R1 of Fig. 8(a) over all R2, N, and that R2, us."""
    from scipy.optimize import minimize_scalar

    R1, R2s = e.grids.fig8_R1[0], e.grids.fig8_R2

    def height(logarithm: float) -> float:
        return peak(solid(e.steel, R1, math.exp(logarithm))).value

    ends = math.log(min(R2s)), math.log(max(R2s))
    R2 = math.exp(float(minimize_scalar(height, bounds=ends, method="bounded", options={"xatol": R2_WIDTH}).x))
    return peak(solid(e.steel, R1, R2)), Value(R2, 2.0 * R2_WIDTH * R2) * MICRO


def _bare(steel: Steel, law: str, values: dict[str, float]) -> Result:
    own = Scene(None, steel.mass, steel.velocity, law=LawChoice(law, values), name=f"steel ball, {law}")
    return _simulated(law, own)


def _simulated(law: str, own: Scene) -> Result:
    return laws.get(law).of(own).simulate(own, TOLERANCE)


@dataclass(frozen=True)
class DentedSurface:
    """The steel ball's first impact on a solid with R1 and R2, s, and the surface after it, which Fig. 15 is about.

    There is a dent when the ball parts; it comes back, and a second impact may come before it has. The surface is the
    3-parameter solid, left to itself out of contact: its load y = depth^alpha falls as exp(-t/R2).
    """

    steel: Steel
    R1: float
    R2: float

    @cached_property
    def first(self) -> Outcome:
        """The impact on the flat surface. Raises TooManySteps."""
        return outcome_of(*self._track(self._contact))

    @property
    def parting(self) -> float:
        """When the ball and the surface part, s."""
        return self._contact.end_time

    def ball(self, times: Array) -> Array:
        """Depth of the ball at times (n,) since touch, s, m: it flies freely once it has parted."""
        track, _ = self._track(self._contact)
        return np.asarray(track(times)[0])

    def surface(self, times: Array) -> Array:
        """Depth of the surface under the ball's tip at times (n,) since touch, s, m."""
        found = self.ball(times)
        for i in np.flatnonzero(times > self.parting):
            found[i] = self._left(float(times[i]) - self.parting).depth
        return found

    def second(self, pause: float) -> Outcome:
        """The impact of an equal ball that meets the surface a pause, s, after the parting. Raises TooManySteps."""
        return outcome_of(*self._track(self._strike(self._left(pause))))

    @property
    def scene(self) -> Scene:
        """Of the first impact."""
        return scene(self.steel, sls.of_ratios(E0=self.steel.contact_modulus, R1=self.R1, R2=self.R2))

    @cached_property
    def _law(self) -> HereditaryForce:
        return law_of(self.scene)

    @cached_property
    def _contact(self) -> Contact:
        return self._strike(State(0.0, self.steel.velocity, 0.0, self._law.load.at_rest))

    def _strike(self, start: State) -> Contact:
        bodies = Bodies(self.steel.mass, self.steel.velocity)
        return contact(self._law, bodies, self._law.exit, start, 0.0, math.inf, TOLERANCE)

    def _track(self, one: Contact) -> tuple[PointTrack, Contact]:
        return PointTrack(self._law, PointMotion((one,), 0.0)), one

    def _left(self, pause: float) -> State:
        """The state in which the next ball finds the surface."""
        last = self._contact.last
        load, *memory = FreeSurface.of(self._law.load, last).at(pause).tolist()
        depth = last.depth * (max(load, 0.0) / float(self._law.load.load(last.depth))) ** (1.0 / EXPONENT["hertz"])
        return State(depth, self.steel.velocity, 0.0, tuple(memory))
