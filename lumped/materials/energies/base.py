"""The contract of an energy, and how its stress and tangent follow from its formula.

In a plane of symmetry or of revolution F is a 2 x 2 block F2 and the stretch t out of the plane, and any isotropic
energy is a function of three numbers: of t, of the block's j = det F2, and of D = F2:F2 - 2 j, which is (F_rr - F_zz)^2
+ (F_rz + F_zr)^2 and cancels no digit at small strain. Formulas are written in jets: numbers that carry their first and
second derivatives in (D, j, t) along.

Functions of the two stretches in the plane are smooth where they are equal: with l1 = sqrt(j) e^b, l2 = sqrt(j) e^-b
and q = D/(2 j) = cosh(2 b) - 1, both b^2 and cosh(n b) are analytic in q: they solve q (q + 2) f'' + (1 + q) f' = s(f),
which gives their series, and f'' from f'.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial

from lumped.numbers import Array
from lumped.schema.members import Folder

SMALL = 0.1  # rounding: q below which the series is summed, whose terms fall as (q/2)^n
TERMS = 14  # rounding: as many terms reach 1e-16 there


@dataclass(frozen=True, eq=False)
class Jet:
    """A function at points (...): its ``value`` (...), ``first`` (3, ...) and ``second`` derivatives (3, 3, ...)."""

    value: Array
    first: Array
    second: Array

    def of(self, value: Array, first: Array, second: Array) -> Jet:
        """A function of this one, by its own value and two derivatives, (...)."""
        outer = self.first[:, None] * self.first[None]
        return Jet(value, first * self.first, second * outer + first * self.second)

    def __add__(self, other: Jet | float) -> Jet:
        if isinstance(other, Jet):
            return Jet(self.value + other.value, self.first + other.first, self.second + other.second)
        return Jet(self.value + other, self.first, self.second)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + -1.0 * other

    def __mul__(self, other: Jet | float) -> Jet:
        if not isinstance(other, Jet):
            return Jet(other * self.value, other * self.first, other * self.second)
        mixed = self.first[:, None] * other.first[None]
        first = self.first * other.value + self.value * other.first
        second = self.second * other.value + self.value * other.second + mixed + np.swapaxes(mixed, 0, 1)
        return Jet(self.value * other.value, first, second)

    __rmul__ = __mul__

    def __pow__(self, power: float) -> Jet:
        """For a positive function, or a whole power."""
        first = power * self.value ** (power - 1.0)
        return self.of(self.value**power, first, power * (power - 1.0) * self.value ** (power - 2.0))


def logarithm(jet: Jet, less_one: Array) -> Jet:
    """ln of a jet whose value less one is known, (...)."""
    inverse = 1.0 / jet.value
    return jet.of(np.log1p(less_one), inverse, -(inverse**2))


@dataclass(frozen=True, eq=False)
class Invariants:
    """``shape`` D, ``area`` j, ``hoop`` t as jets; ``area_rise`` j - 1, ``hoop_rise`` t - 1, (...), to all digits."""

    shape: Jet
    area: Jet
    hoop: Jet
    area_rise: Array
    hoop_rise: Array

    @classmethod
    def of(cls, gradient: Array) -> Invariants:
        """Of a displacement gradient in components (rr, rz, zr, zz, tt), (5, ...)."""
        rr, rz, zr, zz, tt = gradient
        rise = rr + zz + (rr * zz - rz * zr)
        unit, none = np.eye(3), np.zeros((3, 3))
        stretched = ((rr - zz) ** 2 + (rz + zr) ** 2, 1.0 + rise, 1.0 + tt)
        more = (1,) * tt.ndim
        shape, area, hoop = (
            Jet(value, row.reshape(3, *more), none.reshape(3, 3, *more))
            for value, row in zip(stretched, unit, strict=True)
        )
        return cls(shape, area, hoop, rise, tt)

    @property
    def log_area(self) -> Jet:
        """ln j."""
        return logarithm(self.area, self.area_rise)

    @property
    def log_hoop(self) -> Jet:
        """ln t."""
        return logarithm(self.hoop, self.hoop_rise)

    @property
    def log_volume(self) -> Jet:
        """ln J, J = j t."""
        return self.log_area + self.log_hoop

    @property
    def volume_rise(self) -> Jet:
        """J - 1."""
        volume = self.area * self.hoop
        rise = self.area_rise + self.hoop_rise + self.area_rise * self.hoop_rise
        return Jet(rise, volume.first, volume.second)

    @property
    def first_isochoric(self) -> Jet:
        """J^(-2/3) I1 - 3, I1 = D + 2 j + t^2."""
        return (self.shape + 2.0 * self.area + self.hoop**2) * (self.area * self.hoop) ** (-2.0 / 3.0) - 3.0

    @property
    def second_isochoric(self) -> Jet:
        """J^(-4/3) I2 - 3, I2 = j^2 + t^2 (D + 2 j)."""
        whole = self.area**2 + self.hoop**2 * (self.shape + 2.0 * self.area)
        return whole * (self.area * self.hoop) ** (-4.0 / 3.0) - 3.0


def compression(invariants: Invariants, shear: float, lame: float) -> Jet:
    """kappa/2 (J - 1)^2, kappa = lambda + 2 mu/3: the volume's part of what is split."""
    return invariants.volume_rise**2.0 * (0.5 * (lame + 2.0 * shear / 3.0))


def log_difference_squared(invariants: Invariants) -> Jet:
    """b^2, b = (ln l1 - ln l2)/2."""
    powers = np.arange(1, TERMS)
    ratios = -(powers**2) / ((powers + 1.0) * (2.0 * powers + 1.0))
    series = np.concatenate([[0.0, 0.5], 0.5 * np.cumprod(ratios)])

    def closed(b: Array) -> tuple[Array, Array, Array]:
        return b**2, 2.0 * b, np.full_like(b, 0.5)

    return _of_stretches(invariants, series, closed)


def hyperbolic_cosine(invariants: Invariants, power: float) -> Jet:
    """cosh(n b) = (l1^n + l2^n)/(2 j^(n/2))."""
    powers = np.arange(TERMS)
    series = np.cumprod(np.append(1.0, (0.25 * power**2 - powers**2) / ((powers + 1.0) * (2.0 * powers + 1.0))))

    def closed(b: Array) -> tuple[Array, Array, Array]:
        value = np.cosh(power * b)
        return value, power * np.sinh(power * b), 0.25 * power**2 * value

    return _of_stretches(invariants, series, closed)


def _of_stretches(invariants: Invariants, series: Array, closed: Callable[[Array], tuple[Array, Array, Array]]) -> Jet:
    """Of q, by its coefficients, and by its value, derivative in b and s(f) at b."""
    ratio = invariants.shape * (0.5 * invariants.area**-1.0)
    small = ratio.value < SMALL
    near = np.where(small, ratio.value, 0.0)
    found = [polynomial.polyval(near, polynomial.polyder(series, order)) for order in range(3)]
    q = np.where(small, 1.0, ratio.value)
    sine = np.sqrt(q * (q + 2.0))
    value, slope, source = closed(0.5 * np.arcsinh(sine))
    first = slope / (2.0 * sine)
    second = (source - (1.0 + q) * first) / (q * (q + 2.0))
    return ratio.of(*(np.where(small, low, high) for low, high in zip(found, (value, first, second), strict=True)))


@dataclass(frozen=True)
class StrainEnergy:
    """A member of this folder: its ``formula``, as a record spells it; ``density`` W(invariants, mu, lambda), Pa.

    ``splits``: whether it is one of the volume and one of what changes none; ``softens``: in compression, until waves
    of some direction have no speed.
    """

    formula: str
    density: Callable[[Invariants, float, float], Jet]
    splits: bool = True
    softens: bool = False


@dataclass(frozen=True, eq=False)
class Strained:
    """``energy`` W (...), Pa; first Piola-Kirchhoff ``stress`` (5, ...) and ``tangent`` dP/dF (5, 5, ...), Pa.

    ``pulls`` (2, ...) derivatives of W by D and j, which weigh :data:`BENDS` in the tangent, and ``drifts`` (2, 5, ...)
    theirs by the gradient.
    """

    energy: Array
    stress: Array
    tangent: Array
    pulls: Array
    drifts: Array


# Second derivatives of D and of j in (rr, rz, zr, zz, tt): physics.
BENT_SHAPE = 2.0 * np.array(
    [[1, 0, 0, -1, 0], [0, 1, 1, 0, 0], [0, 1, 1, 0, 0], [-1, 0, 0, 1, 0], [0, 0, 0, 0, 0]], dtype=float
)
BENT_AREA = np.array(
    [[0, 0, 0, 1, 0], [0, 0, -1, 0, 0], [0, -1, 0, 0, 0], [1, 0, 0, 0, 0], [0, 0, 0, 0, 0]], dtype=float
)

BENDS = (BENT_SHAPE, BENT_AREA)


def strained(energy: StrainEnergy, gradient: Array, shear: float, lame: float) -> Strained:
    """What an energy answers to a displacement gradient (5, ...), of components (rr, rz, zr, zz, tt).

    `shear` mu and `lame` lambda, Pa. Infinite energy, and no stress, where any volume or stretch is not positive.
    """
    rr, rz, zr, zz, tt = gradient
    invariants = Invariants.of(gradient)
    if not (np.all(invariants.area.value > 0.0) and np.all(invariants.hoop.value > 0.0)):
        none = np.zeros((5, *gradient.shape))
        return Strained(np.full(tt.shape, np.inf), np.zeros_like(gradient), none, none[:2, 0], none[:2])
    density = energy.density(invariants, shear, lame)
    rise = np.zeros((3, *gradient.shape))
    rise[0, :4] = 2.0 * (rr - zz), 2.0 * (rz + zr), 2.0 * (rz + zr), 2.0 * (zz - rr)
    rise[1, :4] = 1.0 + zz, -zr, -rz, 1.0 + rr
    rise[2, 4] = 1.0
    stress = np.einsum("a...,ai...->i...", density.first, rise)
    pushed = np.einsum("ab...,bj...->aj...", density.second, rise)
    tangent = np.einsum("ai...,aj...->ij...", rise, pushed)
    tangent += bent(density.first[:2])
    return Strained(density.value, stress, tangent, density.first[:2], pushed[:2])


def bent(pulls: Array) -> Array:
    """What derivatives of W by D and j, (2, ...), add to a tangent, (5, 5, ...)."""
    more = (1,) * (pulls.ndim - 1)
    return np.asarray(sum(pull * bend.reshape(5, 5, *more) for pull, bend in zip(pulls, BENDS, strict=True)))


ENERGIES = Folder[StrainEnergy]("lumped.materials.energies", "material", "hyperelastic")
DEFAULT = "neo_hooke"


def energy_of(name: str | None) -> StrainEnergy:
    """The energy a material names, or the one that stands for its silence."""
    return ENERGIES.get(name or DEFAULT)
