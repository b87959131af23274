"""What the printed formulas give, and what the right ones do: the numbers of `data/paper/misprints.csv`."""

from __future__ import annotations

import math

from lumped import restitution
from lumped.paper.examples.concrete_impacts import proposed
from lumped.paper.examples.given import Examples
from lumped.paper.examples.ring_impact import stiffness
from lumped.paper.examples.steel_impacts import hertz, solid
from lumped.paper.examples.value import Value, Values, closed, read
from lumped.solvers.stereomechanics import Collision

# Masses, kg, velocities, m/s, and e of a collision to try "(2)" on.
COLLISION = Collision(3.0, 5.0, 1.0, 0.6, 2.0)
ASKED = (0.1, 0.5, 0.9)
NUS = (0.3, 0.45, 0.49, 0.5)
TRANSFORM_AT = 2.0  # 1/s
CONE_ANGLE = math.radians(30.0)


def momentum(examples: Examples) -> Values:
    """V2' of "(2)" as printed and corrected, m/s; momentum after by both, and before, kg m/s."""
    c, (first, second) = COLLISION, COLLISION.velocities_after
    momenta = c.mass_1 * c.velocity_1, c.mass_2 * c.velocity_2
    misprinted = c.velocity_2 - (1.0 + c.e) * (momenta[0] - momenta[1]) / (c.mass_1 + c.mass_2)
    after = (c.mass_1 * first + c.mass_2 * other for other in (misprinted, second))
    return closed(misprinted, second, *after, sum(momenta))


def energy_loss(examples: Examples) -> Values:
    """Loss of "(2)" as printed and corrected, J."""
    c = COLLISION
    closing, (first, second) = c.velocity_1 - c.velocity_2, c.velocities_after
    return closed(0.5 * (1.0 + c.e) * c.reduced_mass * closing * (closing + second - first), c.energy_lost)


def kelvin_restitution(examples: Examples) -> Values:
    """Restitution obtained with "(7)" where the force is cut at zero; asked: 0.1, 0.5, 0.9."""
    family = restitution.get("kelvin")
    return closed(*(family.restitution(family.published["anagnostopoulos"](e), "force") for e in ASKED))


def jankowski_restitution(examples: Examples) -> Values:
    """Restitution obtained with "(10)", then with the formula of 2006; asked: 0.1, 0.5, 0.9."""
    family = restitution.get("jankowski")
    formulas = ("equation_10", "jankowski_2006")
    return closed(*(family.restitution(family.published[formula](e)) for formula in formulas for e in ASKED))


def power_transform(examples: Examples) -> Values:
    """For depth t at s = 2: (L{depth})^(3/2) as printed in "(18)", and L{depth^(3/2)}."""
    return closed(TRANSFORM_AT**-3.0, math.gamma(2.5) * TRANSFORM_AT**-2.5)


def modulus_twice(examples: Examples) -> Values:
    """E0 = E* put into E* of Table 1 once more: share of the elastic peak, and the peak, N."""
    steel = examples.steel
    once, twice = (
        read(hertz(steel, modulus), "peak_force")
        for modulus in (steel.contact_modulus, steel.contact_modulus / (2.0 * (1.0 - steel.nu**2)))
    )
    return twice.over(once), twice


def losses(examples: Examples) -> Values:
    """1 - e^2 of the fitted steel ball and of the concrete striker with the smallest assumed radius."""
    steel, concrete = examples.steel, examples.concrete
    striker = proposed(concrete, min(concrete.radii), min(concrete.velocities))
    found = (read(one, "restitution") for one in (solid(steel, steel.R1, steel.R2), striker))
    return tuple(Value((1.0 - e.value) * (1.0 + e.value), 2.0 * e.error) for e in found)


def line_contact_datum(examples: Examples) -> Values:
    """Datum depth over half-width at which pi l/4 is right, (1/2) exp(2 + nu/(2 (1 - nu))); nu 0.3 to 0.5.

    From depth = F'/(pi E*) (2 ln(2 h/a) - nu/(1 - nu)), Johnson, ISBN 978-0-521-34796-9.
    """
    return closed(*(0.5 * math.exp(2.0 + nu / (2.0 * (1.0 - nu))) for nu in NUS))


def cone_modulus(examples: Examples) -> Values:
    """E of Table 1's cone over E/(1 - nu^2), minus one: steel, incompressible; and the factor of a misread angle."""
    misread = math.tan(0.5 * math.pi - CONE_ANGLE) / math.tan(CONE_ANGLE)
    return closed(-(examples.steel.nu**2), -(NUS[-1] ** 2), misread)


def ring_instability(examples: Examples) -> Values:
    """Net stiffness k2 - K of the side where "(33)" has the wrong sign, N/m; jump at touch without the gap, N."""
    relaxed = stiffness(examples.ring, examples.ring.nu).relaxed
    return closed(examples.ptmd.k2 - relaxed, relaxed * examples.ptmd.gap)


MEMBER = {
    function.__name__: function
    for function in (
        momentum, energy_loss, kelvin_restitution, jankowski_restitution, power_transform, modulus_twice, losses,
        line_contact_datum, cone_modulus, ring_instability,
    )
}  # fmt: skip
