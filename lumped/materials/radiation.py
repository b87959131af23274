"""Energy that a force pulse radiates into an elastic half-space."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from lumped.materials import Material
from lumped.numbers import bisected, gauss

# T int (dF/dt)^2 dt / F_max^2 of the Hertz pulse: 4.5 (T v/depth) (2/5) B(4/5, 3/2), T v/depth = 2.943275.
HERTZ_PULSE = 1.8 * 2.943275 * math.gamma(0.8) * math.gamma(1.5) / math.gamma(2.3)
# The same of a line's pulse, nearly a sine: (1/2pi) int |w| |F(w)|^2 dw / F_max^2, a number without the duration.
SINE_PULSE = 1.21532
# Below this share of G^(-3/2) in phase it is not known whether the peak rises or falls. Measured by finite elements
# (tests/fe/test_half_space_waves.py): at 0.8 it falls by a ninth of what is radiated, at 0 it rises by twice as much.
LEAST_TURNED, EITHER_WAY = 0.85, 2.0
RUBBER = 0.4999  # physics: its Poisson's ratio, a bulk modulus 5000 times the shear modulus
GAUSS_POINTS = 64  # Gauss points over the angle of each part of the waves


@dataclass(frozen=True)
class Pulse:
    """A contact in short: peak force, N; duration, s; mass, kg, and kinetic energy, J, that it turns round.

    `radius`: that of contact at the peak, or the half-width in plane strain, m.
    """

    force: float
    duration: float
    mass: float
    energy: float
    radius: float


def radiation_coefficient(nu: float) -> float:
    """A(nu): a normal point force F(t) on a half-space radiates W = A/(density c_s^3) int (dF/dt)^2 dt.

    A = I/(2 pi), I the imaginary part of Lamb's integral of x sqrt(x^2-g^2)/[(2x^2-1)^2 - 4x^2 sqrt(x^2-g^2)
    sqrt(x^2-1)], g = c_s/c_p: pressure and shear waves (x < 1) and the pole of the Rayleigh wave. A(1/4) is
    Miller and Pursey 1955, doi 10.1098/rspa.1955.0245: 4.836/(2 pi 3^(3/2)).
    """
    g = math.sqrt((1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)))
    return (_both_waves(g) + _shear_waves(g) + _rayleigh_wave(g)) / (2.0 * math.pi)


def line_coefficient(nu: float) -> float:
    """B(nu): a normal line force on a half-plane, N/m, radiates B/G (1/2pi) int |w| |F(w)|^2 dw, J/m.

    B = I/pi, I Lamb's integral as above without its factor x.
    """
    g = math.sqrt((1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)))
    return (_both_waves(g, -1) + _shear_waves(g, -1) + _rayleigh_wave(g, -1)) / math.pi


def pulse_energy(nu: float, density: float, shear_speed: float, peak_force: float, duration: float) -> float:
    """Energy in J which a Hertz pulse of this peak, N, and duration, s, radiates into the half-space."""
    rate = HERTZ_PULSE * peak_force**2 / duration
    return radiation_coefficient(nu) / (density * shear_speed**3) * rate


def shear_speed(material: Material) -> float | None:
    """c_s, m/s, of the relaxed material or of a fluid's glassy one; None without density or without a spring."""
    shear = material.shear.spring
    return math.sqrt(shear / material.density) if shear and material.density else None


class Radiated(NamedTuple):
    """Share of the energy of a pulse, to first order: more than 1 where first order no longer holds.

    `lost`: whether the material takes so much of a wave that it tells how large an effect is at most, not which way.
    """

    share: float
    lost: bool


def radiated_share(material: Material, pulse: Pulse, length: float | None = None) -> Radiated | None:
    """What a Hertz pulse radiates into a half-space; None where its waves are not known.

    A solid with memory answers by its complex modulus G at the pulse's frequency, pi over the duration, a point with
    Re G^(-3/2) and a line of this `length`, m, whose pulse is nearly a sine, with Re 1/G. Where little of that is left
    by its phase, what is pressed at once counts as much as what is sent off, and the share is the most there may be.
    """
    density = material.density
    if density is None or not material.shear.spring or pulse.duration == 0.0:
        return None
    shear = complex(material.shear.operational(1j * math.pi / pulse.duration))
    power = 1.5 if length is None else 1.0
    turned = math.cos(power * cmath.phase(shear))
    lost = turned < LEAST_TURNED
    if length is not None:
        work = line_coefficient(material.nu) / abs(shear) * SINE_PULSE * pulse.force**2 / length
    else:
        work = pulse_energy(material.nu, density, math.sqrt(abs(shear) / density), pulse.force, pulse.duration)
    return Radiated(work / pulse.energy * (EITHER_WAY if lost else turned), lost)


def held_wave_speed(material: Material, time: float) -> float | None:
    """Of waves held sideways, m/s, by what is left of the modulus after a ``time``, s; None where nothing springs.

    What keeps its volume is taken as rubber is, for waves in it have no end of speed.
    """
    if material.density is None or not material.young.spring:
        return None
    confined = replace(material, nu=min(material.nu, RUBBER)).confined_modulus()
    modulus = float(confined(time)) if confined.relaxed and time > 0.0 else confined.spring
    return math.sqrt(modulus / material.density)


def met_at_once(material: Material, pulse: Pulse, area: float) -> float | None:
    """Over the peak force what a flat end of this ``area``, m2, meets at the touch: density c v; None where unknown."""
    wave, speed = held_wave_speed(material, 0.5 * pulse.duration), math.sqrt(2.0 * pulse.energy / pulse.mass)
    if wave is None or material.density is None or pulse.force == 0.0:
        return None
    return material.density * wave * speed * area / pulse.force


def _both_waves(g: float, power: int = 0) -> float:
    """The part x < g, with x = g sin; times x to this power."""
    angle, weight = (0.5 * math.pi * part for part in gauss(GAUSS_POINTS))
    x = g * np.sin(angle)
    p = g * np.cos(angle)
    s = np.sqrt(1.0 - x**2)
    return float(weight @ (x ** (1 + power) * p * p / ((2.0 * x**2 - 1.0) ** 2 + 4.0 * x**2 * p * s)))


def _shear_waves(g: float, power: int = 0) -> float:
    """The part g < x < 1, with x^2 = g^2 cos^2 + sin^2; times x to this power."""
    angle, weight = (0.5 * math.pi * part for part in gauss(GAUSS_POINTS))
    p = math.sqrt(1.0 - g * g) * np.sin(angle)
    s = math.sqrt(1.0 - g * g) * np.cos(angle)
    x2 = g * g + p * p
    # x dx = p s d(angle)
    found = 4.0 * x2 * p**3 * s**2 / ((2.0 * x2 - 1.0) ** 4 + (4.0 * x2 * p * s) ** 2)
    return float(weight @ (found * x2 ** (0.5 * power)))


def _rayleigh_wave(g: float, power: int = 0) -> float:
    """Half the residue at the root x > 1 of Rayleigh's function, found by bisection on x^2; times x to this power."""
    low, _ = bisected(lambda x2: _rayleigh(x2, g) > 0.0, 1.0, 4.0)
    p, s = math.sqrt(low - g * g), math.sqrt(low - 1.0)
    slope = 4.0 * (2.0 * low - 1.0) - 4.0 * p * s - 2.0 * low * (s / p + p / s)
    return 0.5 * math.pi * p / abs(slope) * math.pow(low, 0.5 * power)


def _rayleigh(x2: float, g: float) -> float:
    return (2.0 * x2 - 1.0) ** 2 - 4.0 * x2 * math.sqrt((x2 - g * g) * (x2 - 1.0))
