"""Small strains inside a body that is pressed, and what large ones change of its force to first order.

At a depth the energy changes by that of its cubic terms, and by the work against a profile which the surface moves
along, both in the field of small strains: the first variation at an equilibrium. A layer is known wave by wave, by
2 G u = grad(phi + z psi) - 4 (1 - nu) psi e_z (Papkovich and Neuber), phi and psi of cosh(k z) and sinh(k z), z from
its base. Its pressure is (1 - fall(r)/fall(a))^g: where it is thick g = 1/2, Hertz's under a parabola, round or in
plane strain; where it is thin g = 1, each column pressed by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, inf, pi

import numpy as np

from lumped.materials.energies.base import Invariants, StrainEnergy, strained
from lumped.numbers import Array, gauss

STEP = 1e-3  # rounding: largest strain at which odd differences tell the cubic terms
LAST_NU = 0.4999  # nearer to 1/2 nothing changes but digits
# Measured, of O-rings: with less left of the bulk modulus first order is out by 2 to 5, with more by 2 at most.
FIRM = 0.5
ALIKE = np.array([1.0, 0.0, 0.0, 1.0, 1.0])  # the same stretch in every direction
# Lengths in contact radii a: a layer as thick is a half-space; the body is followed to so many beside the contact and
# below it, or to so many thicknesses h beside it; the shortest wave is as long as a over the one, or h over the other.
THICK, BESIDE, BELOW, SIDEWAYS, PER_CONTACT, PER_THICKNESS = 1e3, 5.0, 6.0, 4.0, 30.0, 6.0
POINTS, OUTSIDE, DEEP, LEAST = 14, 12, 14, 16  # within the contact, beside it, below it; of waves and of a pressure
NEAR = 1e-5  # rounding: of a place, steps of the quotient that tells a profile's slope


@dataclass(frozen=True, eq=False)
class StrainField:
    """Displacement gradients (rr, rz, zr, zz, tt), shape (5, n), and their volumes (n,), at G = 1.

    `energy` of the whole, work of the `gap`; `power`: force x depth over energy; strains grow as depth^`growth`.
    `datum` (5, n): what takes from the cubic terms as it meets them, where depth is measured from what gives way.
    """

    nu: float
    gradient: Array
    volume: Array
    energy: float
    gap: float
    power: float
    growth: float
    datum: Array | None = None

    def change(self, law: StrainEnergy, struck: bool = False) -> float:
        """Of the force at a depth, relatively; `struck`: of the peak force where the work is given, not the depth.

        F = k d^n (1 + q d^m) has done the work k d^(n+1)/(n+1) (1 + q d^m (n+1)/(n+1+m)).
        """
        terms = self._cubic(law, self.gradient)
        if self.datum is not None:  # what a cubic form changes by, to first order, exactly
            alike = np.abs(self.gradient).max(axis=0) / np.abs(self.datum).max(axis=0)
            more, less = (self._cubic(law, self.gradient + sign * alike * self.datum) for sign in (1.0, -1.0))
            terms = terms - (0.5 * (more - less) - self._cubic(law, alike * self.datum)) / alike
        grown = 1.0 + self.growth if struck else self.power + self.growth
        return (float(terms @ self.volume) + self.gap) / self.energy * grown / self.power

    def _cubic(self, law: StrainEnergy, gradient: Array) -> Array:
        """Terms of the energy's density, (n,)."""
        scale = STEP / np.abs(gradient).max(axis=0)
        both, lame = scale * np.stack([gradient, -gradient], axis=1), 2.0 * self.nu / (1.0 - 2.0 * self.nu)
        more, less = law.density(Invariants.of(both), 1.0, lame).value
        return np.asarray(0.5 * (more - less) / scale**3)

    def collapses(self, law: StrainEnergy) -> bool:
        """Whether so little is left of the bulk modulus that what is pressed through gives way: below nu = 0 that is
        small, and most energies lose it where the volume shrinks. Over all points, each as its small strains weigh.
        """
        if self.nu >= 0.0:
            return False
        rr, rz, zr, zz, tt = self.gradient
        lame, swells = 2.0 * self.nu / (1.0 - 2.0 * self.nu), rr + zz + tt
        squares = rr**2 + zz**2 + tt**2 + 0.5 * (rz + zr) ** 2
        weight = (0.5 * lame * swells**2 + squares) * self.volume
        whole = ((1.0 + rr) * (1.0 + zz) > rz * zr) & (tt > -1.0)  # what small strains turn inside out tells nothing
        tangent = strained(law, self.gradient[:, whole], 1.0, lame).tangent
        bulk = np.einsum("i,ij...,j->...", ALIKE, tangent, ALIKE) / (9.0 * lame + 6.0)
        return float(bulk @ weight[whole]) < FIRM * float(weight[whole].sum())


def alike(nu: float, strain: float, free: bool) -> StrainField:
    """A body shortened by a `strain` everywhere, its sides `free` or held."""
    nu = min(nu, LAST_NU)
    across, modulus = (nu * strain, 2.0 * (1.0 + nu)) if free else (0.0, 2.0 * (1.0 - nu) / (1.0 - 2.0 * nu))
    gradient = np.array([[across], [0.0], [0.0], [-strain], [across]])
    return StrainField(nu, gradient, np.ones(1), 0.5 * modulus * strain**2, 0.0, 2.0, 1.0)


@dataclass(frozen=True)
class Pressed:
    """A surface pressed by `depth`, m, where the overlap has a `fall`(r), m, to the edge of the contact at `radius`, m.

    In `plane` strain or round; `moving`: whether the surface moves along that profile, not with it. The body is
    `thickness`, m, deep, on a "bonded" or a "sliding" `base`.
    """

    nu: float
    depth: float
    radius: float
    fall: Callable[[Array], Array]
    plane: bool
    thickness: float = inf
    base: str = "bonded"
    moving: bool = True

    def strains(self) -> StrainField:
        """Inside, lengths in contact radii."""
        thick, nu = min(self.thickness / self.radius, THICK), min(self.nu, LAST_NU)
        beside, below = min(BESIDE, SIDEWAYS * thick), min(thick, BELOW)
        (inner, near), (away, far), (z, deep) = _within(POINTS), _from(beside, OUTSIDE), _from(below, DEEP)
        r, across = np.append(inner, 1.0 + away), np.append(near, far)
        area = 2.0 * across if self.plane else 2.0 * pi * r * across
        k, pressed = self._spectrum(max(PER_CONTACT, PER_THICKNESS / thick), 1.0 + beside)
        even, odd = _kernels(np.outer(r, k), self.plane)
        waves = pressed[:, None] * _waves(k[:, None], np.append(thick - z, thick), thick, nu, self.base)
        out, sheared, lift, stretch = (kernel @ one for kernel, one in zip((odd, odd, even, even), waves, strict=True))
        hoop = np.zeros_like(out) if self.plane else out / r[:, None]
        gradient = np.stack([(k * even) @ waves[0] - hoop, sheared, -(k * odd) @ waves[2], stretch, hoop])
        depth, touched = self.depth / self.radius, slice(POINTS)
        scale = depth / -float(waves[2, :, -1].sum())
        pushed = scale * self._pressure(inner) * area[touched]
        energy = -0.5 * scale * float(pushed @ lift[touched, -1])
        gap = scale * self._met(pushed, inner, out[touched, -1], energy) if self.moving else 0.0
        power = float(pushed.sum()) * depth / energy
        volume, growth = np.outer(area, deep).ravel(), self._growth
        return StrainField(nu, scale * gradient[..., :-1].reshape(5, -1), volume, energy, gap, power, growth)

    def _spectrum(self, last: float, farthest: float) -> tuple[Array, Array]:
        """Waves up to the `last`, (n,), that are told apart as far out, and what each counts for in the pressure."""
        share, weight = gauss(LEAST + ceil(last * farthest))
        r, across = _within(LEAST + ceil(last))
        k, even = last * share, _kernels(last * np.outer(share, r), self.plane)[0]
        measure, per_wave = (across, 2.0 / pi) if self.plane else (r * across, last * share)
        return k, even @ (self._pressure(r) * measure) * last * weight * per_wave

    def _pressure(self, r: Array) -> Array:
        """At places, but for a factor; under a flat end it grows to the rim."""
        if self._rim:
            return np.asarray((1.0 - r**2) ** (0.5 * self._thin - 0.5))
        edge = float(self.fall(np.array(self.radius)))
        return np.asarray(np.maximum(1.0 - self.fall(self.radius * r) / edge, 0.0) ** (0.5 + 0.5 * self._thin))

    def _met(self, pushed: Array, r: Array, sideways: Array, energy: float) -> float:
        """Work against the profile at places, where the surface moves `sideways` by so much at a scale of one.

        A rim that the surface moves in under presses a wider part of it: of `energy`, which is as the radius where the
        body is thick, as the area where each column is pressed by itself.
        """
        if self._rim:
            return -(1.0 + self._thin) * energy * float(sideways[-1])
        return -float((pushed * self._slope(r)) @ sideways)

    @property
    def _rim(self) -> bool:
        """Whether the profile is flat up to where the contact ends."""
        return float(self.fall(np.array(self.radius))) == 0.0

    def _slope(self, r: Array) -> Array:
        """Of the profile at places."""
        ends = (self.fall(self.radius * r * (1.0 + sign * NEAR)) for sign in (1.0, -1.0))
        return np.asarray((next(ends) - next(ends)) / (2.0 * NEAR * self.radius * r))

    @property
    def _thin(self) -> float:
        """From 0, a half-space, to 1."""
        return self.radius / (self.radius + self.thickness)

    @property
    def _growth(self) -> float:
        """Of the strains depth/a where it is thick, as the profile is deep at a; of depth/h where it is thin."""
        edge, slope = float(self.fall(np.array(self.radius))), float(self._slope(np.ones(1))[0])
        wider = edge / (self.radius * slope) if slope > 0.0 else 0.0
        return 1.0 - wider * (1.0 - self._thin)


def _within(points: int) -> tuple[Array, Array]:
    """Places in the contact, crowded to its edge at 1, and weights."""
    share, weight = gauss(points)
    angle = 0.5 * pi * share
    return np.sin(angle), 0.5 * pi * np.cos(angle) * weight


def _from(reach: float, points: int) -> tuple[Array, Array]:
    """Distances up to a reach, crowded at zero, and weights."""
    share, weight = gauss(points)
    return reach * share**2, 2.0 * reach * share * weight


def _kernels(phase: Array, plane: bool) -> tuple[Array, Array]:
    """What is even and what is odd along the surface."""
    from scipy.special import j0, j1  # late: a scene that is only read needs none

    return (np.cos(phase), np.sin(phase)) if plane else (j0(phase), j1(phase))


def _waves(k: Array, up: Array, thickness: float, nu: float, base: str) -> Array:
    """Of waves k (n, 1) at heights (m,) from the base to the surface, last, G = 1 and a pressure of one: (4, n, m).

    Displacement sideways (odd) and its slope upwards, displacement upwards (even) and its slope.
    """
    rising, falling = np.exp(k * (up - thickness)), np.exp(-k * (up + thickness))
    cosh, sinh = rising + falling, rising - falling  # but for a factor, alike in both

    def solution(phi: Array, phi_slope: Array, psi: Array, psi_slope: Array) -> Array:
        whole, slope = phi + up * psi, phi_slope + up * psi_slope
        sideways, rise = -k * whole, slope - (3.0 - 4.0 * nu) * psi
        stretch, pressed = k**2 * whole, 2.0 * (1.0 - nu) * psi_slope
        shear = -k * (slope + psi)
        return np.stack(
            [sideways, shear, rise, stretch - (2.0 - 4.0 * nu) * psi_slope, shear - k * rise, stretch - pressed]
        )

    none = np.zeros_like(cosh)
    first = solution(none, none, sinh, k * cosh)
    if base == "sliding":
        other = solution(cosh, k * sinh, none, none)
    else:
        other = solution((3.0 - 4.0 * nu) / k * sinh, (3.0 - 4.0 * nu) * cosh, cosh, k * sinh)
    (shear, normal), (shear_too, normal_too) = first[4:, :, -1:], other[4:, :, -1:]
    balanced = (shear_too * first - shear * other) / (shear * normal_too - normal * shear_too)
    return np.asarray(0.5 * balanced[:4])
