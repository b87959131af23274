"""Ogden's three terms of vulcanised rubber, with the volume apart; doi 10.1098/rspa.1972.0026."""

from lumped.materials.energies.base import Invariants, Jet, StrainEnergy, compression, hyperbolic_cosine

# Physics: exponents, and moduli in kg/cm2, of Treloar's rubber; the latter are scaled to the shear modulus.
POWERS, MODULI = (1.3, 5.0, -2.0), (6.3, 0.012, -0.1)


def density(invariants: Invariants, shear: float, lame: float) -> Jet:
    """sum mu_p/a_p (l1^a + l2^a + l3^a - 3) of stretches over J^(1/3), 2 mu = sum mu_p a_p, + kappa/2 (J - 1)^2."""
    unit = 2.0 * shear / sum(modulus * power for modulus, power in zip(MODULI, POWERS, strict=True))
    found = compression(invariants, shear, lame)
    for modulus, power in zip(MODULI, POWERS, strict=True):
        volume = (invariants.area * invariants.hoop) ** (-power / 3.0)
        within = 2.0 * hyperbolic_cosine(invariants, power) * invariants.area ** (0.5 * power)
        found = found + ((within + invariants.hoop**power) * volume - 3.0) * (unit * modulus / power)
    return found


MEMBER = StrainEnergy(
    "sum mu_p/a_p (l1^a_p + l2^a_p + l3^a_p - 3) + kappa/2 (J - 1)^2, l of J^(-1/3) F, a = (1.3, 5, -2), "
    "mu_p in proportion to (6.3, 0.012, -0.1)",
    density,
)
