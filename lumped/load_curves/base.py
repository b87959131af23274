"""The contract of a load curve: what an elastic body answers to one rigid profile pressed slowly into it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import inf
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, Real, gauss

GAUSS_POINTS = 48  # Gauss points over the contact radius, for the work of indentation


def elastic_faults(body: str, nu: float, **lengths: float) -> list[Fault]:
    """What is wrong with a body's lengths, m, by their names, and with its Poisson's ratio."""
    wrong = {key: length for key, length in lengths.items() if not 0.0 < length < inf}
    faults = [Fault(body, key, f"must be above 0 m, is {length}") for key, length in wrong.items()]
    if not -1.0 < nu <= 0.5:
        faults.append(Fault(body, "nu", f"must lie above -1 and not above 0.5, is {nu}"))
    return faults


def check_below(depth: ArrayLike, limit: float, said: str) -> None:
    """Raises BadInput where a depth reaches the limit, m, which is `said` in words."""
    deepest = np.max(np.asarray(depth), initial=0.0)
    if deepest >= limit:
        raise BadInput(Fault("depth", "", f"a depth of {deepest:.3g} m; accepted below {said} {limit:g} m"))


class LoadCurve(ABC):
    """Frictionless indentation of an elastic body by one convex profile.

    Everything is per unit contact modulus E* = E/(1-nu^2): an axisymmetric curve gives F/E* in m^2, pressure/E*
    in 1 and energy/E* in m^3; a plane one gives them per unit length, F/E* in m and energy/E* in m^2, and its
    contact radius is the half-width. Depths and radii in m; arguments are scalars or arrays; a depth below zero
    counts as zero. `accuracy`: relative, of forces and radii. `closed`: a form that answers a row of depths the same to
    the bit whatever rows are beside it, with no iteration that ends for all of them at once.
    """

    accuracy: ClassVar[float] = 1e-12
    closed: ClassVar[bool] = False

    @property
    def extent(self) -> float:
        """The contact radius that no depth reaches, m: infinite unless the profile ends."""
        return float("inf")

    @property
    def least_radius(self) -> float:
        """Contact radius of the first touch of a profile, m: zero, but under its flat end."""
        return 0.0

    @property
    def breaks(self) -> tuple[float, ...]:
        """Contact radii, ascending, m, beyond which depth(a) starts anew as a root does: where the face bends."""
        return ()

    @property
    def root_before(self) -> float:
        """Where depth(a), continued below zero, would be none again, m: near a tip that is hardly one."""
        return float("-inf")

    def force(self, depth: ArrayLike) -> Real:
        """F/E* at a depth."""
        return self.force_and_slope(depth)[0]

    @abstractmethod
    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and its slope at a depth: at the edge the profile meets the surface with the stiffness of a flat punch.

        Where the force alone costs less, it has a formula of its own.
        """

    @abstractmethod
    def contact_radius(self, depth: ArrayLike) -> Real:
        """Contact radius a at a depth."""

    @abstractmethod
    def depth(self, contact_radius: ArrayLike) -> Real:
        """Depth at a contact radius."""

    @abstractmethod
    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d depth / d a."""

    @abstractmethod
    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """Pressure p/E* at a distance from the axis while the contact has this radius, zero outside of it."""

    def bending(self, depth: float) -> float:
        """F/E* over e^2/2 of a depth that goes on by e, m, for what the overlaps of a held contact bend: zero, 1/m.

        A target whose overlaps do not all grow by the same in every stretch of the way says what they do.
        """
        return 0.0

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F/E* at a contact radius."""
        return self.force(self.depth(contact_radius))

    def energy(self, depth: ArrayLike) -> Array:
        """Work of indentation int_0^depth F d depth = int_0^a F(x) depth'(x) dx."""
        a = np.asarray(self.contact_radius(np.maximum(np.asarray(depth, dtype=float), 0.0)))
        nodes, weights = gauss(GAUSS_POINTS)
        x = a[..., None] * nodes
        return np.asarray(a * ((self.force_at(x) * self.depth_slope(x)) @ weights))
