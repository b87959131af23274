"""The error budget: the impact again with one setting varied at a time, by finite elements alone.

Time steps in the ratio 1 : 2 : 4 give a value (extrapolated from the two finest) and its change from the
pair before. Mesh, penalty and far field are varied on the coarsest of them, where a march is cheapest: what
they change does not depend on the step. A change between settings in the ratio 1 : 2 bounds the error by

    SAFETY / (2^order - 1) x change ,

with the lowest order that theory or the scheme promises, not the higher one that is usually seen (Roache's
grid convergence index, doi:10.1115/1.2910291).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.curve import Curve, extrapolated
from fe_contact.forms import Array
from fe_contact.impact import March, Strike, march
from fe_contact.numerics import RANGES, SCHEMES, Numerics
from fe_contact.targets import half_space
from lumped.errors import NotReached
from lumped.members import get

SAFETY = 1.25
LEAST_ORDER = {"mesh": 2, "penalty": 1, "far_field": 2}
CAUSES = ("mesh", "penalty", "time_step", "far_field")
PEAK_SHARE = 0.98  # the force's own error is the largest one while the force exceeds this share of its peak
SMOOTHING = 0.04  # share of the contact over which a pointwise change counts as the error of its neighbours


@dataclass(frozen=True)
class Change:
    """Two curves that differ in one setting, and the factor that turns their difference into an error."""

    first: Curve
    second: Curve
    factor: float

    def of(self, name: str) -> float:
        """Error of a quantity, in its unit.

        What is read at one instant takes the largest change around it: a difference of two curves may cross
        zero just there, which makes neither of them right.
        """
        first, second = self.first.quantities[name], self.second.quantities[name]
        if first is None or second is None:
            return np.inf if first is not second else 0.0
        strike = self.first.strike
        around = {
            "peak_force": float(self._force_change[self._near_peak].max()),
            "peak_depth": float(self._depth_change[self._near_depth].max()),
            "impulse": self._velocity_change * strike.mass,
            "restitution": self._velocity_change / strike.velocity,
        }
        return self.factor * max(abs(first - second), around.get(name, 0.0))

    def history(self) -> float:
        """Norm of the force's change over the norm of the force."""
        time = self.first.dense_time
        change = np.trapezoid(self._force_change**2, time)
        return self.factor * float(np.sqrt(change / np.trapezoid(self.first.dense_force**2, time)))

    def force(self, time: Array) -> Array:
        """Error of the force at times, N: the largest change in the neighbourhood of each."""
        width = max(1, round(SMOOTHING * len(self._force_change)))
        padded = np.pad(self._force_change, width, mode="edge")
        around = np.lib.stride_tricks.sliding_window_view(padded, 2 * width + 1).max(axis=1)
        return self.factor * np.interp(time, self.first.dense_time, around)

    @cached_property
    def _force_change(self) -> Array:
        return np.abs(self.first.dense_force - self.second.force(self.first.dense_time))

    @cached_property
    def _depth_change(self) -> Array:
        time = self.first.dense_time
        return np.abs(self.first.depth_at(time) - self.second.depth_at(time))

    @cached_property
    def _near_depth(self) -> Array:
        depth = self.first.depth_at(self.first.dense_time)
        return depth > PEAK_SHARE * depth.max()

    @cached_property
    def _velocity_change(self) -> float:
        """Largest change of the velocity over the second half of the contact, m/s."""
        time = self.first.dense_time
        late = time > 0.5 * self.first.duration
        shared = time * (self.second.duration / self.first.duration)
        change = self.first.velocity_at(time) - self.second.velocity_at(shared)
        return float(np.abs(change[late]).max())

    @cached_property
    def _near_peak(self) -> Array:
        force = self.first.dense_force
        return force > PEAK_SHARE * force.max()


@dataclass(frozen=True)
class TotalWork:
    """Counted work of a certified impact: unknowns of the finest mesh; factorisations and back-substitutions
    of all meshes; marches, time steps, contact problems and Newton iterations of all runs."""

    degrees_of_freedom: int
    factorizations: int
    solves: int
    marches: int
    steps: int
    contact_problems: int
    iterations: int


@dataclass(frozen=True)
class Certified:
    """A curve with what each setting contributes to its error.

    ``march`` is the finest run behind it, ``surface`` what it ran on, ``work`` that of all runs together.
    """

    curve: Curve
    march: March
    surface: ScaledSurface
    changes: Mapping[str, Change | None]
    work: TotalWork

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity by one cause, in its unit; infinite where a variation failed."""
        change = self.changes[cause]
        if change is None:
            return np.inf
        return change.history() if name == "history_l2" else change.of(name)

    def total(self, name: str) -> float:
        """Error bar of a quantity, in its unit."""
        return sum(self.error(name, cause) for cause in CAUSES)

    def force_error(self, time: Array) -> Array:
        """Half-width of the force's error band, N."""
        known = [change.force(time) for change in self.changes.values() if change is not None]
        return np.sum(known, axis=0) if known else np.zeros_like(time)


def certify(strike: Strike, poisson: float, numerics: Numerics) -> Certified:
    """March with ``numerics`` and with each setting varied; raises where the march itself fails."""
    scheme = get(SCHEMES, numerics.scheme)
    runs = _Runs(strike, poisson)
    finest = runs.march(numerics)
    fine = Curve.of(finest, strike)
    half = runs.curve(numerics.varied(steps=numerics.steps // 2))
    cheap = numerics.varied(steps=numerics.steps // 4)
    quarter = runs.curve(cheap)
    other_mesh = _other(cheap, "elements_per_contact")
    on_other_mesh = runs.curve(other_mesh)
    value = fine if half is None else extrapolated(fine, half, scheme.ORDER)
    before = None if half is None or quarter is None else extrapolated(half, quarter, scheme.ORDER)
    changes = {
        "mesh": _change(quarter, on_other_mesh, LEAST_ORDER["mesh"]),
        "penalty": _change(quarter, runs.curve(_other(cheap, "penalty")), LEAST_ORDER["penalty"]),
        "time_step": _change(value, before, scheme.ORDER),
        "far_field": _change(
            on_other_mesh, runs.curve(_other(other_mesh, "far_radius")), LEAST_ORDER["far_field"]
        ),
    }
    surface = half_space.surface(poisson, numerics)
    return Certified(value, finest, surface, changes, runs.work(surface))


class _Runs:
    """Marches of one strike with different settings, and a count of what they cost."""

    def __init__(self, strike: Strike, poisson: float) -> None:
        self._strike, self._poisson = strike, poisson
        self._marches: list[March] = []
        self._surfaces: dict[int, ScaledSurface] = {}

    def march(self, settings: Numerics) -> March:
        """One run; raises where it fails."""
        surface = half_space.surface(self._poisson, settings)
        self._surfaces[id(surface)] = surface
        self._marches.append(march(self._strike, surface, settings))
        return self._marches[-1]

    def curve(self, settings: Numerics) -> Curve | None:
        """One run as a curve, None where it fails: its cause of error is then unknown."""
        try:
            return Curve.of(self.march(settings), self._strike)
        except NotReached:
            return None

    def work(self, finest: ScaledSurface) -> TotalWork:
        """What all runs cost together."""
        works = [m.work for m in self._marches]
        return TotalWork(
            degrees_of_freedom=finest.operator.degrees_of_freedom,
            factorizations=len(self._surfaces),
            solves=sum(len(s.operator.stiffness) for s in self._surfaces.values()),
            marches=len(works),
            steps=sum(w.steps for w in works),
            contact_problems=sum(w.contact_problems for w in works),
            iterations=sum(w.iterations for w in works),
        )


def _change(first: Curve | None, second: Curve | None, order: int) -> Change | None:
    if first is None or second is None:
        return None
    return Change(first, second, SAFETY / (2**order - 1))


def _other(numerics: Numerics, key: str) -> Numerics:
    """One setting halved, or doubled where half of it is out of range."""
    value = getattr(numerics, key)
    lowest, _ = RANGES[key]
    return numerics.varied(**{key: value / 2 if value / 2 >= lowest else value * 2})
