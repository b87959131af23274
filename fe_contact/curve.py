"""A march as a smooth curve: interpolation between its steps, extrapolation between step lengths, quantities.

The abscissa is ``x = sqrt(t / duration)``: powers of the square root of time at first touch become a
polynomial, and marches whose ends differ a little are compared at equal shares of their contact. The force
comes from the impulse, the one quantity that a step of any scheme knows exactly, by way of the mean force
``G = impulse / t``, which stays regular at touch: ``F = d(t G)/dt = G + x/2 dG/dx``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fe_contact.forms import Array
from fe_contact.march import March, Strike

STENCIL = 6  # nodes of the local polynomials
DENSE = 601  # points on which peaks are sought and norms taken


@dataclass(frozen=True)
class Curve:
    """Mean force since touch (n,), N, depth (n,), m, at ``x`` (n,); squared radius at ``radius_x``; duration and how
    sharply its end can be read, s.
    """

    strike: Strike
    duration: float
    separated: bool
    x: Array
    mean_force: Array
    depth: Array
    radius_x: Array
    radius_squared: Array
    end_spread: float

    @classmethod
    def of(cls, march: March, strike: Strike) -> Curve:
        """The curve through the steps of a march."""
        duration = float(march.time[-1])
        shares, squares = _radius_through(march)
        return cls(
            strike=strike,
            duration=duration,
            separated=march.separated,
            x=np.sqrt(march.time / duration),
            mean_force=np.concatenate([[0.0], march.impulse[1:] / march.time[1:]]),
            depth=march.depth,
            radius_x=np.sqrt(shares),
            radius_squared=squares,
            end_spread=march.end_spread,
        )

    def thinned(self) -> Curve:
        """The curve through every other step, both ends kept."""
        keep = np.unique(np.append(np.arange(0, len(self.x), 2), len(self.x) - 1))
        return replace(self, x=self.x[keep], mean_force=self.mean_force[keep], depth=self.depth[keep])

    def force(self, time: Array) -> Array:
        """Contact force, N; zero outside the contact."""
        inside = (time > 0) & ((time < self.duration) if self.separated else (time <= self.duration))
        x = np.sqrt(np.where(inside, time, self.duration) / self.duration)
        mean, slope = local_polynomial(self.x, self.mean_force, x)
        return np.where(inside, np.maximum(mean + 0.5 * x * slope, 0.0), 0.0)

    def depth_at(self, time: Array) -> Array:
        """Depth, m, up to the end of the contact."""
        value, _ = local_polynomial(self.x, self.depth, self._share(time))
        return value

    def impulse_at(self, time: Array) -> Array:
        """Impulse since touch, N s."""
        mean, _ = local_polynomial(self.x, self.mean_force, self._share(time))
        return mean * time

    def velocity_at(self, time: Array) -> Array:
        """Velocity by the balance of momentum, m/s."""
        return self.strike.velocity + self.strike.gravity * time - self.impulse_at(time) / self.strike.mass

    def radius_at(self, time: Array) -> Array:
        """Contact radius, m."""
        return np.sqrt(np.maximum(self.radius_squared_at(self._share(time)), 0.0))

    def radius_squared_at(self, x: Array) -> Array:
        """Squared contact radius, m^2, linear in time between the steps."""
        return np.asarray(np.interp(x**2, self.radius_x**2, self.radius_squared))

    def _share(self, time: Array) -> Array:
        return np.sqrt(np.clip(time / self.duration, 0.0, 1.0))

    @cached_property
    def dense_time(self) -> Array:
        """Times that crowd at both ends of the contact, s."""
        share = np.linspace(0.0, 1.0, DENSE)
        return self.duration * share**2 * (3 - 2 * share)

    @cached_property
    def dense_force(self) -> Array:
        """Force at :attr:`dense_time`, N."""
        return self.force(self.dense_time)

    @cached_property
    def dense_depth(self) -> Array:
        """Depth at :attr:`dense_time`, m."""
        return self.depth_at(self.dense_time)

    @cached_property
    def leaving_speed(self) -> float:
        """Speed away from the target at the end, m/s."""
        return -float(self.velocity_at(np.array([self.duration]))[0])

    @cached_property
    def quantities(self) -> dict[str, float | None]:
        """The numbers of ``result.json`` but the history's own error."""
        peak_time, peak_force = peak(self.dense_time, self.dense_force)
        _, peak_depth = peak(self.dense_time, self.dense_depth)
        impulse = float(self.mean_force[-1]) * self.duration
        return {
            "peak_force": peak_force,
            "peak_time": peak_time,
            "peak_depth": peak_depth,
            "duration": self.duration if self.separated else None,
            "restitution": self.leaving_speed / self.strike.velocity if self.separated else None,
            "impulse": impulse,
        }


def _radius_through(march: March) -> tuple[Array, Array]:
    """Share of the contact and squared radius, from touch to the end, with the turn at the greatest depth.

    The radius grows until then and shrinks after it with another slope: a line drawn from the last sample
    before to the first one after would cut the corner.
    """
    duration = float(march.time[-1])
    keep = march.radius_time < duration * (1 - 1e-9)
    time, square = march.radius_time[keep], march.radius[keep] ** 2
    last = 0.0 if march.separated else float(march.radius[-1] ** 2)
    turn, _ = peak(march.time, march.depth)
    growing = int(np.searchsorted(time, turn))
    if 3 <= growing < len(time):
        before = slice(growing - 3, growing)
        at_turn, _ = local_polynomial(time[before], square[before], np.array([turn]))
        time, square = np.insert(time, growing, turn), np.insert(square, growing, at_turn[0])
    return np.concatenate([[0.0], time / duration, [1.0]]), np.concatenate([[0.0], square, [last]])


def extrapolated(fine: Curve, coarse: Curve, order: int) -> Curve:
    """Richardson's extrapolation of two curves whose step lengths are as one to two."""
    weight = 1 / (2**order - 1)

    def mend(field: Array, x: Array, values: Array) -> Array:
        other, _ = local_polynomial(x, values, fine.x)
        return np.asarray(field + weight * (field - other))

    duration = fine.duration + weight * (fine.duration - coarse.duration)
    return Curve(
        strike=fine.strike,
        duration=duration,
        separated=fine.separated,
        x=fine.x,
        mean_force=mend(fine.mean_force, coarse.x, coarse.mean_force),
        depth=mend(fine.depth, coarse.x, coarse.depth),
        radius_x=fine.radius_x,
        radius_squared=fine.radius_squared + weight * (fine.radius_squared - coarse.radius_squared_at(fine.radius_x)),
        end_spread=fine.end_spread + weight * (fine.end_spread + coarse.end_spread),
    )


def peak(time: Array, values: Array) -> tuple[float, float]:
    """Place and height of the maximum, by the quartic through the highest sample's neighbourhood."""
    top = min(max(int(np.argmax(values)), 2), len(values) - 3)
    around = slice(top - 2, top + 3)
    span = time[top + 2] - time[top - 2]
    quartic = np.polynomial.Polynomial.fit((time[around] - time[top]) / span, values[around], 4, domain=[-1, 1])
    first, last = (time[top - 2] - time[top]) / span, (time[top + 2] - time[top]) / span
    fine = np.linspace(first, last, 201)
    best = fine[int(np.argmax(quartic(fine)))]
    fine = np.clip(best + np.linspace(-0.005, 0.005, 101), first, last)
    best = fine[int(np.argmax(quartic(fine)))]
    return float(time[top] + best * span), float(quartic(best))


def local_polynomial(nodes: Array, values: Array, at: Array) -> tuple[Array, Array]:
    """Value and derivative of the polynomial through the nearest nodes, Newton's form; ``nodes`` increase."""
    size = min(STENCIL, len(nodes))
    first = np.clip(np.searchsorted(nodes, at) - size // 2, 0, len(nodes) - size)
    window = first[:, None] + np.arange(size)
    x = nodes[window]
    differences = values[window].astype(float)
    for level in range(1, size):
        differences[:, level:] = (differences[:, level:] - differences[:, level - 1 : -1]) / (
            x[:, level:] - x[:, :-level]
        )
    value, slope = differences[:, -1], np.zeros(len(at))
    for level in range(size - 2, -1, -1):
        step = at - x[:, level]
        slope = value + step * slope
        value = differences[:, level] + step * value
    return value, slope
