"""The paper's numbers recomputed: an expression of the examples for every name that `data/paper/*.csv` has of them.

It gives values in the unit of the claim that names it. A plain number is a closed form, which errs by rounding; what
is simulated has a bar of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TypeAlias

from lumped import restitution
from lumped.errors import BadInput, Fault, nearest
from lumped.paper import concrete_impacts as concrete
from lumped.paper import left_out
from lumped.paper.given import Examples
from lumped.paper.ring_impacts import (
    alone,
    decay,
    frequency,
    impacts,
    mass_in_dashpot,
    plain,
    pounding,
    stiffness,
)
from lumped.paper.steel_impacts import (
    R1_of_peak,
    contact_modulus,
    damped_peak_times,
    elastic_of_peak,
    ends_7,
    fig7,
    from_7a_to_7b,
    from_elastic,
    hertz,
    impulse_shares_7a,
    lowest_8a,
    peaks_8,
    proposed,
    pulse_distance,
    pulse_momenta,
    relaxation_time,
    solid,
    spreads_7,
    springs,
    theoretical,
)
from lumped.paper.value import (
    KILO,
    MICRO,
    MILLI,
    PERCENT,
    Value,
    Values,
    change,
    closed,
    duration,
    loss,
    peak,
    peak_place,
    read,
    spread,
    times,
)
from lumped.result.score import POINTS
from lumped.solvers.stereomechanics import Collision
from lumped.targets.base import LOST_FORCE

Outcome: TypeAlias = "Value | float | Iterable[Value | float]"
Expression = Callable[[Examples], Outcome]
Recomputation = Callable[[Examples], Values]
POUND = 0.45359237  # kg
# Profiles c r^n on a half-space: flat punch, parabola, cone.
PROFILES = (math.inf, 2.0, 1.0)
# Tabor's representative strain is 0.2 a/R; while a grows as sqrt(R depth) its rate is of the order 0.4 v/a.
STRAIN_RATE = 0.4
# Fig. 7(b): the text sets the three largest R1 apart from the two smallest.
MANY = 3
# Masses, kg, velocities, m/s, and e of a collision to try "(2)" on.
COLLISION = Collision(3.0, 5.0, 1.0, 0.6, 2.0)
ASKED = (0.1, 0.5, 0.9)  # restitutions at which published formulas are tried
NUS = (0.3, 0.45, 0.49, 0.5)  # Poisson's ratios at which formulas are tried
TRANSFORM_AT = 2.0  # 1/s
ACCELERATION, DISPLACEMENT = "max_acceleration", "rms_displacement"
CONE_ANGLE = math.radians(30.0)  # half the opening, rad, at which a formula for cones is tried


def available() -> tuple[str, ...]:
    """Names of all recomputations, as "steel_ball.proposed_peak"."""
    return tuple(f"{example}.{name}" for example, expressions in EXPRESSIONS.items() for name in expressions)


def get(name: str) -> Recomputation:
    """The recomputation of a name; raises BadInput with the nearest one."""
    if name not in available():
        raise BadInput(Fault("recompute", name, f"unknown{nearest(name, available())}"))
    example, _, number = name.partition(".")
    expression = EXPRESSIONS[example][number]
    return lambda examples: _values(expression(examples))


def _values(found: Outcome) -> Values:
    every = [found] if isinstance(found, Value | float | int) else found
    return tuple(one if isinstance(one, Value) else closed(one)[0] for one in every)


def _momentum(c: Collision) -> list[float]:
    """V2' of "(2)" as printed and corrected, m/s; momentum after by both, and before, kg m/s."""
    first, second = c.velocities_after
    momenta = c.mass_1 * c.velocity_1, c.mass_2 * c.velocity_2
    misprinted = c.velocity_2 - (1.0 + c.e) * (momenta[0] - momenta[1]) / (c.mass_1 + c.mass_2)
    after = (c.mass_1 * first + c.mass_2 * other for other in (misprinted, second))
    return [misprinted, second, *after, sum(momenta)]


def _energy_loss(c: Collision) -> list[float]:
    """Loss of "(2)" as printed and corrected, J."""
    closing, (first, second) = c.velocity_1 - c.velocity_2, c.velocities_after
    return [0.5 * (1.0 + c.e) * c.reduced_mass * closing * (closing + second - first), c.energy_lost]


def _obtained(law: str, formula: str, exit: str | None = None) -> list[float]:
    """The restitution obtained with a published damping where 0.1, 0.5 and 0.9 are asked."""
    family = restitution.get(law)
    options = (exit,) if exit else ()
    return [family.restitution(family.published[formula](e), *options) for e in ASKED]


def _modulus_twice(e: Examples) -> list[Value]:
    """E0 = E* put into E* of Table 1 once more: share of the elastic peak, and the peak, N."""
    twice = peak(hertz(e.steel, e.steel.contact_modulus / (2.0 * (1.0 - e.steel.nu**2))))
    return [twice / peak(theoretical(e)), twice]


EXPRESSIONS: Mapping[str, Mapping[str, Expression]] = {
    "review": {
        # alpha of a profile c r^n, Sneddon 1965, doi 10.1016/0020-7225(65)90019-4
        "exponents": lambda e: [Value(1.0 + 1.0 / n) for n in PROFILES],
        # 0.4 v/a at the elastic peak
        "strain_rate": lambda e: (
            STRAIN_RATE * e.steel.velocity / (e.steel.radius * read(theoretical(e), "peak_depth")) ** 0.5
        ),
        "intervals": lambda e: POINTS - 1,
    },
    "steel_ball": {
        "ball": lambda e: [e.steel.radius * MILLI, e.steel.mass],
        "fall": lambda e: e.steel.velocity,
        "contact_modulus": contact_modulus,
        "fitted_R1": lambda e: R1_of_peak(e.steel),
        "memory": lambda e: [
            Value(relaxation_time(e.steel)) * MILLI,
            relaxation_time(e.steel) / duration(proposed(e)),
        ],
        "springs": lambda e: springs(e.steel.contact_modulus, e.steel.R1, e.steel.R2),
        "proposed_peak": lambda e: peak(proposed(e)),
        "proposed_peak_time": lambda e: times(proposed(e))[0],
        "proposed_duration": lambda e: times(proposed(e))[1],
        "theoretical_peak": lambda e: peak(theoretical(e)),
        "theoretical_peak_exact": lambda e: peak(hertz(e.steel, contact_modulus(e))),
        "refitted_times": lambda e: times(solid(e.steel, R1_of_peak(e.steel).value, e.steel.R2)),
        "hertz_times": lambda e: times(elastic_of_peak(e.steel, "hertz", e.steel.measured_peak)),
        "linear_times": lambda e: times(elastic_of_peak(e.steel, "linear_spring", e.steel.measured_peak)),
        "kelvin_peak_times": lambda e: damped_peak_times(e, "kelvin"),
        "jankowski_peak_times": lambda e: damped_peak_times(e, "jankowski"),
        "pulse_momenta": pulse_momenta,
        # mass, velocity and radius drop out, and the fitted solid is elastic: one material needs the ratio one
        "modulus_ratio": lambda e: (1.0 + e.steel.R1) * (e.steel.theoretical_peak / e.steel.measured_peak) ** 2.5,
        "pulse_distance": pulse_distance,
        "change_at_stiff_R2": lambda e: [*from_elastic(e, e.steel.R1), *from_elastic(e, max(e.grids.fig7_R1))],
    },
    "steel_grids": {
        "peak_7a_small_R1": lambda e: peak(fig7(e, "a", min)),
        "peak_7a_large_R1": lambda e: peak(fig7(e, "a", max)),
        "duration_7a_small_R1": lambda e: duration(fig7(e, "a", min)) * MICRO,
        "duration_7a_large_R1": lambda e: duration(fig7(e, "a", max)) * MICRO,
        "duration_change_7a": lambda e: change(*ends_7(e, "a", duration)),
        "impulse_shares_7a": impulse_shares_7a,
        "impulse_difference_7a": lambda e: impulse_shares_7a(e)[1] - impulse_shares_7a(e)[0],
        "changes_7b_small_R1": lambda e: [
            *from_7a_to_7b(e, e.grids.fig7_R1[MANY:], peak),
            *from_7a_to_7b(e, e.grids.fig7_R1[MANY:], duration),
        ],
        "peak_changes_7b_large_R1": lambda e: from_7a_to_7b(e, e.grids.fig7_R1[:MANY], peak),
        "peaks_7c": lambda e: ends_7(e, "c", peak),
        "peak_change_7c": lambda e: change(*ends_7(e, "c", peak)),
        "peak_places_7c": lambda e: ends_7(e, "c", peak_place),
        "peak_shift_7c": lambda e: change(*ends_7(e, "c", peak_place)),
        "spread_7d": lambda e: spreads_7(e, e.grids.fig7_R2[-1]),
        "asymmetry_7d": lambda e: [
            2.0 * peak_place(solid(e.steel, R1, e.grids.fig7_R2[-1])) - 1.0 for R1 in e.grids.fig7_R1
        ],
        "spread_at_small_R1": lambda e: spread(
            peak(solid(e.steel, min(e.grids.fig7_R1), R2)) for R2 in (*e.grids.fig7_R2, *e.grids.fig8_R2)
        ),
        "spread_at_soft_R2": lambda e: spreads_7(e, e.grids.soft_R2),
        "peaks_8a": lambda e: peaks_8(e)[0],
        "lowest_8a": lowest_8a,
        # Fig. 8(a) to (c), whose text speaks of a fall and a rise
        "falls_8": lambda e: [change(peaks[0], min(peaks)) for peaks in peaks_8(e)[:3]],
        "rises_8": lambda e: [change(min(peaks), peaks[-1]) for peaks in peaks_8(e)[:3]],
        "gains_8": lambda e: [
            change(*(peak(solid(e.steel, of(e.grids.fig8_R1), R2)) for of in (min, max))) for R2 in e.grids.fig8_R2
        ],
        "spread_8_soft": lambda e: spread(peaks[-1] for peaks in peaks_8(e)),
    },
    "concrete_pole": {
        "peaks": lambda e: [peak(one) * KILO for one in left_out.at_lower_velocity(e.concrete)],
        # Hertz's peak, v^(6/5), and duration, v^(-1/5), and a linear peak, v
        "velocity_ratios": lambda e: [
            (max(e.concrete.velocities) / min(e.concrete.velocities)) ** power for power in (1.2, -0.2, 1.0)
        ],
        "solid": lambda e: [
            e.concrete.E2 / e.concrete.E1,
            e.concrete.E1 * e.concrete.E2 / (e.concrete.E1 + e.concrete.E2),
            e.concrete.E2,
        ],
        "memory": concrete.memory,
        # by both readings of an error of the peak: (model - experiment)/experiment, then model/experiment
        "peak_ratios": lambda e: [
            (1.0 + e.concrete.peak_error) / (1.0 + e.concrete.jankowski_peak_error),
            e.concrete.peak_error / e.concrete.jankowski_peak_error,
        ],
        "plateau": concrete.plateau,
    },
    "ring": {
        "springs": lambda e: [*springs(e.ring.E0, e.ring.R1, e.ring.R2), MILLI * relaxation_time(e.ring)],
        "loss_peak": lambda e: [
            0.5 * e.ring.R1 / math.sqrt(1.0 + e.ring.R1),
            math.sqrt(1.0 + e.ring.R1) / (2.0 * math.pi * e.ring.R2),
        ],
        "relaxed_stiffnesses": lambda e: [stiffness(e.ring, nu).relaxed for nu in e.ring.nus],
        "impacts": impacts,
    },
    "pounding_damper": {
        "first_frequency": lambda e: frequency(e.ptmd.k1, e.ptmd.m1),
        "damping_ratio": lambda e: PERCENT * e.ptmd.c1 / (2.0 * math.sqrt(e.ptmd.k1 * e.ptmd.m1)),
        "damper_mass": lambda e: POUND * e.ptmd.damper_pounds,
        "structure_stiffness": lambda e: e.ptmd.m1 * (2.0 * math.pi * e.ptmd.frequency) ** 2,
        "structure_dashpot": lambda e: 2.0 * e.ptmd.damping_ratio * math.sqrt(e.ptmd.k1 * e.ptmd.m1),
        "damper_dashpot": lambda e: 2.0 * e.ptmd.damping_ratio * math.sqrt(e.ptmd.k2 * e.ptmd.m2),
        "mass_in_dashpot": lambda e: mass_in_dashpot(e.ptmd),
        "damper_frequencies": lambda e: [frequency(e.ptmd.k2, mass) for mass in (e.ptmd.m2, mass_in_dashpot(e.ptmd))],
        "first_penetration": lambda e: e.ptmd.displacement - e.ptmd.gap,
        "decay_changes": lambda e: map(change, decay(e, alone), decay(e, pounding)),
        "decay": lambda e: [*decay(e, pounding), *decay(e, alone)],
        "pounding_against_plain": lambda e: [
            plain(e, DISPLACEMENT) * MILLI,
            change(plain(e, DISPLACEMENT), pounding(e, DISPLACEMENT)),
        ],
        "acceleration_change": lambda e: change(alone(e, ACCELERATION), pounding(e, ACCELERATION)),
        "acceleration_change_structure": lambda e: change(
            alone(e, ACCELERATION), pounding(e, ACCELERATION, "structure")
        ),
        "largest_accelerations": lambda e: [
            alone(e, ACCELERATION),
            *(pounding(e, ACCELERATION, start) for start in ("both", "structure")),
        ],
        "quiet_share": lambda e: 1.0 - pounding(e, "last_contact") * (1.0 / e.ptmd.end_time),
        "contacts": lambda e: [
            Value(pounding(e, "contacts").value),
            pounding(e, "last_contact"),
            pounding(e, "peak_force"),
            pounding(e, "peak_depth") * MILLI,
        ],
    },
    "misprints": {
        "momentum": lambda e: _momentum(COLLISION),
        "energy_loss": lambda e: _energy_loss(COLLISION),
        "kelvin_restitution": lambda e: _obtained("kelvin", "anagnostopoulos", "force"),
        "jankowski_restitution": lambda e: [
            *_obtained("jankowski", "equation_10"),
            *_obtained("jankowski", "jankowski_2006"),
        ],
        # for depth t at s = 2: (L{depth})^(3/2) as printed in "(18)", and L{depth^(3/2)}
        "power_transform": lambda e: [TRANSFORM_AT**-3.0, math.gamma(2.5) * TRANSFORM_AT**-2.5],
        "modulus_twice": _modulus_twice,
        "losses": lambda e: [loss(proposed(e)), loss(concrete.slow(e.concrete))],
        # where pi l/4 is right in depth = F'/(pi E*) (2 ln(2 h/a) - nu/(1 - nu)), Johnson, ISBN 978-0-521-34796-9
        "line_contact_datum": lambda e: [0.5 * math.exp(2.0 + nu / (2.0 * (1.0 - nu))) for nu in NUS],
        # E over E/(1 - nu^2), minus one: steel, incompressible; and the factor of a misread angle
        "cone_modulus": lambda e: [
            -(e.steel.nu**2),
            -(NUS[-1] ** 2),
            math.tan(0.5 * math.pi - CONE_ANGLE) / math.tan(CONE_ANGLE),
        ],
        "ring_instability": lambda e: [
            e.ptmd.k2 - stiffness(e.ring, e.ring.nu).relaxed,
            stiffness(e.ring, e.ring.nu).relaxed * e.ptmd.gap,
        ],
    },
    "assumptions": {
        "steel_strain": lambda e: left_out.strained(proposed(e)),
        "steel_inertia": lambda e: [left_out.radiated(e.steel, one) for one in (theoretical(e), proposed(e))],
        # energy radiated by the pulse over the energy lost by viscosity
        "steel_loss": lambda e: left_out.radiated(e.steel, proposed(e)) * (1.0 / LOST_FORCE) / loss(proposed(e)),
        "steel_yield": lambda e: left_out.yielded(theoretical(e), e.steel.yield_strength),
        "concrete_strain": lambda e: [
            value for one in left_out.at_lower_velocity(e.concrete) for value in left_out.strained(one)
        ],
        "concrete_inertia": lambda e: left_out.radiated_into_pole(e.concrete),
        "concrete_yield": lambda e: [
            value
            for one in left_out.at_lower_velocity(e.concrete)
            for value in left_out.yielded(one, e.concrete.strength)
        ],
        "ring_strain": left_out.ring_strained,
        "ring_inertia": left_out.ring_moved,
    },
}
