"""What pressure on an arc of an annulus' inner circle does to that arc."""

from __future__ import annotations

import numpy as np

from lumped.load_curves.annulus import compliances, hole
from lumped.load_curves.plane_contact import Array, Collocation, folded


def ring_compliance(nu: float, ratio: float, rule: Collocation, angle: float) -> Array:
    """Radial displacement over the inner radius of |theta| <= angle for pressure E* Q, shape (m, m).

    The sum c_0/2 + sum c_n cos(n phi) is that of a hole, in closed form with its ln and its corner at phi = 0, and the
    annulus' own rest, which is smooth; `ratio` is inner over outer radius.
    """
    own = angle * rule.nodes
    phi = own[:, None] - np.concatenate([own, -own])
    singular = (
        2.0 * np.cos(phi) * rule.logarithm - 0.5 * np.pi * _side(nu) * angle * np.sinc(phi / np.pi) * rule.distance
    )
    whole = folded(singular + rule.weight * (_hole_rest(nu, phi) - 2.0 * np.log(angle) * np.cos(phi)))
    return angle / np.pi * (whole + 2.0 * rule.weight * _annulus_rest(nu, ratio, own))


def _side(nu: float) -> float:
    """Weight of 1/(n^2-1) in c_n."""
    return (1.0 - 2.0 * nu) / (1.0 - nu)


def _hole_rest(nu: float, phi: Array) -> Array:
    """Smooth part of sum_{n>=2} cos(n phi) (2n + m)/(n^2-1).

    sum 2n cos(n phi)/(n^2-1) = -2 cos(phi) ln(2 sin(|phi|/2)) - 1 - cos(phi)/2,
    sum cos(n phi)/(n^2-1) = 1/2 + cos(phi)/4 - sin(|phi|) (pi-|phi|)/2, both over n >= 2 and for |phi| < 2 pi.
    """
    cosine = np.cos(phi)
    waves = -2.0 * cosine * np.log(np.sinc(0.5 * phi / np.pi)) - 1.0 - 0.5 * cosine
    return np.asarray(waves + _side(nu) * (0.5 + 0.25 * cosine + 0.5 * phi * np.sin(phi)))


def _annulus_rest(nu: float, ratio: float, theta: Array) -> Array:
    """c_0/2 + c_1 cos(phi) + sum_{n>=2} (c_n - hole's) cos(n phi), its even part in both angles, shape (m, m)."""
    rest = compliances(nu, ratio).copy()
    orders = np.arange(rest.size, dtype=float)
    rest[0] *= 0.5
    rest[2:] -= hole(nu, orders[2:])
    cosines = np.cos(np.outer(theta, orders))
    return np.asarray((cosines * rest) @ cosines.T)
