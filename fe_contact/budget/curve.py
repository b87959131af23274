"""A march as a smooth curve: interpolation between its steps, extrapolation between step lengths, quantities.

The abscissa is ``x = sqrt(t / duration)``: powers of the square root of time at first touch become a
polynomial, and marches whose ends differ a little are compared at equal shares of their contact. The force
comes from the impulse, the one quantity that a step of any scheme knows exactly, by way of the mean force
``G = impulse / t``, which stays regular at touch: ``F = d(t G)/dt = G + x/2 dG/dx``.
Between nodes lie polynomials through the nearest six, several fields at once.

A branch that relaxes within the first step leaves its time in the force, which no step would ever show. But as long as
the striker is hardly slowed its load grows by a known power of time, hence the force by a known function. What is left
of ``G`` without it is smooth.

Contact radius over time, from the radii found in the steps of a march.

The squared radius is smooth in time but for two corners: where the depth is greatest and, in a viscous contact,
where the edge leaves the place up to which the surface was pressed down. A line drawn over a corner would cut it;
a polynomial would swing. So each interval is looked at from both sides, and both must agree which way it bends.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.march.impact import Energies, balanced
from fe_contact.steppers.steps import March, Strike

FEWEST_ROWS = 5  # of a march, through which a quartic tells a peak
STENCIL = 6  # nodes of a polynomial
PLACES = 17  # equidistant, from which a quartic is fitted
FINE = np.linspace(0.0, 1.0, 201)  # where in an interval a maximum is looked for
BETWEEN = np.linspace(-1.0, 1.0, PLACES)  # places on (-1, 1) through which a quartic is fitted
NEAREST_QUARTIC = np.linalg.pinv(np.vander(BETWEEN, 5))  # from values there to its five coefficients
PEAK_SHARE = 0.98  # of its peak above which a force is near it
HALF_AS_HIGH = 0.25  # of the error of a peak's place, of fourth order in the width, is left where a fit is half as high
SHARES = np.linspace(0.0, 1.0, 601)  # of the contact, equally spaced
EARLIEST = 4  # rows after touch that tell whether steps or shares are more crowded there
DENSE = SHARES**2 * (3 - 2 * SHARES)  # shares of the contact, crowded at its ends, for peaks and norms
FIRST = 3  # steps: what relaxes later, polynomials tell
BEGUN = 1e-12  # rounding: of x, below which a contact has only begun
# Of the first step, over x, in which what presses almost at once rises by 63 %: all of it within the step.
RISING = 0.05
INSIDE = np.arange(1, 8)[:, None] / 8  # places put into every interval


@dataclass(frozen=True, eq=False)
class LocalPolynomials:
    """Newton's form through every six successive ``nodes`` (n,), which increase, or through all if they are fewer.

    ``differences`` (level, field, polynomial): divided differences on the first nodes of each polynomial.
    """

    nodes: Array
    differences: Array

    @classmethod
    def through(cls, nodes: Array, values: Array) -> LocalPolynomials:
        """Polynomials of the fields ``values`` (f, n)."""
        size = min(STENCIL, len(nodes))
        table = [values]
        for level in range(1, size):
            table.append((table[-1][:, 1:] - table[-1][:, :-1]) / (nodes[level:] - nodes[:-level]))
        return cls(nodes, np.stack([level[:, : len(nodes) - size + 1] for level in table]))

    def at(self, places: Array) -> tuple[Array, Array]:
        """Value and derivative of every field, (f, p), each by the polynomial whose nodes lie around."""
        size, fields, count = self.differences.shape
        first = np.minimum(np.maximum(self.nodes.searchsorted(places) - size // 2, 0), count - 1)
        coefficients = self.differences.take(first, axis=2)
        steps = places - self.nodes.take(first + np.arange(size - 1)[:, None])
        value, slope = coefficients[-1], np.zeros((fields, len(places)))
        for step, coefficient in zip(steps[::-1], coefficients[-2::-1], strict=True):
            slope *= step
            slope += value
            value *= step
            value += coefficient
        return value, slope


def peak(time: Array, values: Array) -> tuple[float, float]:
    """Place and height of the maximum, by the quartic through the highest sample's neighbourhood."""
    top = min(max(int(np.argmax(values)), 2), len(values) - 3)
    around = slice(top - 2, top + 3)
    span = time[top + 2] - time[top - 2]
    x = np.asarray((time[around] - time[top]) / span, dtype=np.float64)
    quartic = np.asarray(np.linalg.solve(np.vander(x), values[around]), dtype=np.float64)
    best, height = _top(quartic, float(x[0]), float(x[-1]))
    return float(time[top] + best * span), height


def fitted_peak(first: float, last: float, values: Array) -> tuple[float, float]:
    """Place between ``first`` and ``last`` and height of the maximum, by the quartic nearest to ``PLACES`` values.

    Their neighbours' mean keeps a small jitter of the values from moving the place.
    """
    best, height = _top(NEAREST_QUARTIC @ values, -1.0, 1.0)
    return first + 0.5 * (best + 1.0) * (last - first), height


def _top(quartic: Array, low: float, high: float) -> tuple[float, float]:
    """Place and height of a quartic's maximum in an interval."""
    a, b, c, d, e = quartic.tolist()
    fine = low + (high - low) * FINE
    best = float(fine[int(np.argmax((((a * fine + b) * fine + c) * fine + d) * fine))])
    spacing = (high - low) * float(FINE[1])
    best = _stationary(quartic, best, max(best - spacing, low), min(best + spacing, high))
    return best, (((a * best + b) * best + c) * best + d) * best + e


def _stationary(quartic: Array, place: float, low: float, high: float) -> float:
    """Where the quartic's derivative vanishes between ``low`` and ``high``, by Newton's method; else near its end."""
    a, b, c, d, _ = quartic.tolist()
    for _ in range(4):
        slope = ((4 * a * place + 3 * b) * place + 2 * c) * place + d
        bend = (12 * a * place + 6 * b) * place + 2 * c
        if bend >= 0.0:
            return place
        place = min(max(place - slope / bend, low), high)
    return place


@dataclass(frozen=True, eq=False)
class Reading:
    """Force, N, impulse since touch, N s, and depth, m, at some times, each (n,)."""

    force: Array
    impulse: Array
    depth: Array


@dataclass(frozen=True)
class Curve:
    """Mean force since touch (n,), N, depth (n,), m, at ``x`` (n,); squared radius at ``radius_x``; duration and how
    sharply its end can be read, s; energies of the account, J; how sharply peaks can be read, by quantity; when the
    force peaks, s, where the march knows it; the depth, m, that stays for ever in a body that yields.
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
    energy: Energies
    peak_spread: Mapping[str, float] = field(default_factory=dict)
    peaked_at: float | None = None
    dent: float | None = None

    @classmethod
    def of(cls, march: March, strike: Strike) -> Curve:
        """The curve through the steps of a march."""
        duration = float(march.time[-1])
        shares, squares = squared_radius(march)
        return cls(
            strike=strike,
            duration=duration,
            separated=march.separated,
            x=np.sqrt(march.time / duration),
            mean_force=np.concatenate([[march.first_force], march.impulse[1:] / march.time[1:]]),
            depth=march.depth,
            radius_x=np.sqrt(shares),
            radius_squared=squares,
            end_spread=march.end_spread,
            energy=march.energy,
            dent=march.dent,
        )

    def thinned(self) -> Curve:
        """The curve through every other step, both ends kept."""
        return self.through(np.unique(np.append(np.arange(0, len(self.x), 2), len(self.x) - 1)))

    def through(self, rows: npt.NDArray[np.intp]) -> Curve:
        """The curve through some of the steps only, between which it tells the mean force exactly."""
        return replace(self, x=self.x[rows], mean_force=self.mean_force[rows], depth=self.depth[rows])

    def evened(self) -> Curve:
        """The curve through every other step, halfway between these and what the steps between them tell there; both
        ends kept.

        What alternates from step to step is gone, and little of what smooth forces tell: both halves err by less than
        either does without the other.
        """
        kept, count = self.thinned(), len(self.x)
        between = self.through(np.unique([0, *range(1, count, 2), count - 1]))
        mean = 0.5 * (kept.mean_force + between.resolved(kept.x)[0])
        mean[[0, -1]] = kept.mean_force[[0, -1]]
        return replace(kept, mean_force=mean)

    def read_at(self, x: Array) -> Curve:
        """The curve through other rows, the first of them at touch."""
        mean, _, depth = self.resolved(x)
        mean[0], depth[0] = self.mean_force[0], self.depth[0]
        return replace(self, x=x, mean_force=mean, depth=depth)

    @cached_property
    def polynomials(self) -> LocalPolynomials:
        """Mean force but for how it began, and depth, between the steps, over x."""
        rest = self.mean_force - self._begun(self.x)[0]
        return LocalPolynomials.through(self.x, np.stack([rest, self.depth]))

    def resolved(self, x: Array) -> tuple[Array, Array, Array]:
        """Mean force and force, N, and depth, m, at x."""
        (rest, depth), (slope, _) = self.polynomials.at(x)
        mean, force = self._begun(x)
        return rest + mean, rest + force + 0.5 * x * slope, depth

    def _begun(self, x: Array) -> tuple[Array, Array]:
        """Mean force and force at x, N, of a load that grows on as it began, as large as the mean over the first step.

        None under a flat end, whose area presses at once, and where neither a dashpot, on which a line presses almost
        at once, nor a branch relaxes within the first steps.
        """
        relaxation, power = self.strike.relaxation, self.strike.power
        shortest = 0.0 if relaxation.viscosity > 0.0 else min(relaxation.times, default=np.inf)
        if self.flat or shortest > self.duration * self.x[: FIRST + 1][-1] ** 2:
            return np.zeros_like(x), np.zeros_like(x)
        time, first = self.duration * np.maximum(x, BEGUN) ** 2, self.duration * float(self.x[1]) ** 2
        load = self.mean_force[1] * (time / first) ** power / relaxation.felt(first, power)[1]
        now, mean = relaxation.felt(time, power)
        if self.first_step == 0.0:
            return load * mean, load * (power + 1.0) * now
        since = x / (RISING * float(self.x[1]))
        left = np.exp(-since)
        return load * mean * (1.0 - left), load * ((power + 1.0) * now * (1.0 - left) + 0.5 * mean * left * since)

    def read(self, time: Array) -> Reading:
        """Force, zero outside the contact, impulse and depth up to its end.

        What is cut off presses on: runs that touch a little later, or earlier, are cut off a little before each other.
        """
        inside = (time >= 0) & ((time < self.duration) if self.separated else True)
        x = self.share(time)
        mean, force, depth = self.resolved(x)
        return Reading(np.where(inside, np.maximum(force, 0.0), 0.0), mean * time, depth)

    def force(self, time: Array) -> Array:
        """Contact force, N; zero outside the contact."""
        return self.read(time).force

    def velocity(self, time: Array, impulse: Array) -> Array:
        """Velocity by the balance of momentum, m/s."""
        return self.strike.velocity + self.strike.gravity * time - impulse / self.strike.mass

    def radius_at(self, time: Array) -> Array:
        """Contact radius, m."""
        return np.sqrt(np.maximum(self.radius_squared_at(self.share(time)), 0.0))

    def radius_squared_at(self, x: Array) -> Array:
        """Squared contact radius, m^2, linear in time between the steps."""
        return np.asarray(np.interp(x**2, self.radius_x**2, self.radius_squared))

    def share(self, time: Array) -> Array:
        """Abscissa x of times."""
        return np.sqrt(np.minimum(np.maximum(time / self.duration, 0.0), 1.0))

    @cached_property
    def shares(self) -> Array:
        """Of the contact: crowded at both ends, or with the steps where these are more crowded at touch, about an early
        peak, or where gravity may have swung it for long.
        """
        swings = not self.separated and self.strike.gravity > 0.0
        if not swings and self.x[min(EARLIEST, self.x.size - 1)] ** 2 > DENSE[EARLIEST]:
            return DENSE
        count = len(self.x)
        places = np.linspace(0.0, count - 1.0, max(len(DENSE), 2 * count - 1))
        return np.asarray(np.interp(places, np.arange(count), self.x) ** 2)

    @cached_property
    def dense_time(self) -> Array:
        """Times as dense as the contact may ask for, s."""
        return self.duration * self.shares

    @cached_property
    def dense(self) -> Reading:
        """What there is to read at :attr:`dense_time`."""
        return self.read(self.dense_time)

    @property
    def dense_force(self) -> Array:
        """Force at :attr:`dense_time`, N."""
        return self.dense.force

    @cached_property
    def dense_velocity(self) -> Array:
        """Velocity at :attr:`dense_time`, m/s."""
        return self.velocity(self.dense_time, self.dense.impulse)

    @property
    def first_step(self) -> float:
        """Up to when a force that rises almost at once may do so in any way, s: under a line on a dashpot, else 0."""
        rises = self.strike.relaxation.viscosity > 0.0 and self.strike.power <= 1.0 and not self.flat
        return self.duration * float(self.x[1]) ** 2 if rises else 0.0

    @property
    def last_step(self) -> float:
        """When the last step ended, s: from there to separation no force is known."""
        return self.duration * float(self.x[-2]) ** 2

    @cached_property
    def leaving_speed(self) -> float:
        """Speed away from the target at the end, m/s."""
        return -float(self.dense_velocity[-1])

    @cached_property
    def near_peak(self) -> slice:
        """Dense times from the first to the last at which the force is nearly as large as ever, at least three.

        Of one that is largest at the very end the last alone may be.
        """
        near = np.flatnonzero(self.dense_force > PEAK_SHARE * self.dense_force.max())
        first, last = int(near[0]), int(near[-1])
        if first == last < len(self.shares) - 1:
            first, last = max(first - 1, 0), last + 1
        return slice(first, last + 1)

    @property
    def _force_peak(self) -> tuple[float, float]:
        if self.peaked_at is not None:
            return self.peaked_at, float(self.force(np.array([self.peaked_at]))[0])
        if self.fitless:
            return peak(self.dense_time, self.dense_force)
        return self._peak_of(self.near_peak)

    def _peak_of(self, near: slice) -> tuple[float, float]:
        """Time and height by the quartic nearest to these dense forces."""
        first, *_, last = self.dense_time[near].tolist()
        return fitted_peak(first, last, self.force(np.linspace(first, last, PLACES)))

    def with_peak_spread(self) -> Curve:
        """The curve with what the fit of its peak errs by, as the fit to the upper half of its forces tells.

        No step and no mesh tells of that: a quartic fits them all alike.
        """
        near = np.flatnonzero(self.dense_force > 0.5 * (1.0 + PEAK_SHARE) * self.dense_force.max())
        if near[0] == near[-1] or self.fitless:
            return self
        narrow, wide = self._peak_of(slice(int(near[0]), int(near[-1]) + 1)), self._force_peak
        apart = {name: abs(a - b) for name, a, b in zip(("peak_time", "peak_force"), narrow, wide, strict=True)}
        spread = {name: value / (1.0 - HALF_AS_HIGH) for name, value in apart.items()}
        return replace(self, peak_spread=spread)

    @property
    def fitless(self) -> bool:
        """Whether no place comes or goes, under a flat end, so that nothing jitters; or the striker comes to rest."""
        return self.flat or self.near_peak.stop == len(self.shares)

    @cached_property
    def flat(self) -> bool:
        """Whether the same area presses from the first touch to the last."""
        return bool(np.ptp(self.radius_squared) == 0.0)

    @cached_property
    def quantities(self) -> dict[str, float | None]:
        """The numbers of ``result.json`` but the history's own error."""
        peak_time, peak_force = self._force_peak
        _, peak_depth = peak(self.dense_time, self.dense.depth)
        impulse = float(self.mean_force[-1]) * self.duration
        return {
            "peak_force": peak_force,
            "peak_time": peak_time,
            "peak_depth": peak_depth,
            "duration": self.duration if self.separated else None,
            "restitution": self.leaving_speed / self.strike.velocity if self.separated else None,
            "impulse": impulse,
        }


def extrapolated(fine: Curve, coarse: Curve, order: int) -> Curve:
    """Richardson's extrapolation of two curves whose step lengths are as one to two."""
    found = _onwards(fine, coarse, 1 / (2**order - 1))
    return replace(found, energy=_by_speed(found))


def beyond(fine: Curve, coarse: Curve, weight: float) -> Curve:
    """The curve onwards from a coarse one by a ``weight`` of what a fine one is apart from it, at equal shares.

    It is impulses that go onwards: forces and durations that do so both would leave of their product, which hardly
    changes, the square of what they change.
    """
    found, (mean, _, _) = _onwards(fine, coarse, weight), coarse.resolved(fine.x)
    pressed, before = fine.duration * fine.mean_force, coarse.duration * mean
    found = replace(found, mean_force=(pressed + weight * (pressed - before)) / found.duration)
    return replace(found, energy=_by_speed(found))


def _onwards(fine: Curve, coarse: Curve, weight: float) -> Curve:
    """The same of forces, with the energies of squares of speeds, not of a speed's square."""
    mean, _, depth = coarse.resolved(fine.x)
    return Curve(
        strike=_strike_onwards(fine.strike, coarse.strike, weight),
        duration=fine.duration + weight * (fine.duration - coarse.duration),
        separated=fine.separated,
        x=fine.x,
        mean_force=fine.mean_force + weight * (fine.mean_force - mean),
        depth=fine.depth + weight * (fine.depth - depth),
        radius_x=fine.radius_x,
        radius_squared=fine.radius_squared + weight * (fine.radius_squared - coarse.radius_squared_at(fine.radius_x)),
        end_spread=fine.end_spread + weight * (fine.end_spread + coarse.end_spread),
        energy={name: value + weight * (value - coarse.energy[name]) for name, value in fine.energy.items()},
    )


def _by_speed(curve: Curve) -> Energies:
    """The account of an extrapolated curve: the square of a speed is that of the extrapolated speed, which is numerical
    in so far as it is not the extrapolated square.
    """
    energy, out = curve.energy, 0.5 * curve.strike.mass * curve.leaving_speed**2
    return balanced({**energy, "out": out, "numerical": energy["numerical"] + energy["out"] - out})


def _strike_onwards(fine: Strike, coarse: Strike, weight: float) -> Strike:
    """The strike of which the touch is extrapolated too: of a first one all settings know it."""
    touches = [np.array([strike.touched_at, strike.depth, strike.velocity]) for strike in (fine, coarse)]
    touched_at, depth, velocity = (touches[0] + weight * (touches[0] - touches[1])).tolist()
    return replace(fine, touched_at=touched_at, depth=depth, velocity=velocity)


def squared_radius(march: March) -> tuple[Array, Array]:
    """Shares of the contact (n,), from touch to the end, and squared radius there, m^2.

    Under a flat end it is the same from the first touch to the last.
    """
    if np.ptp(march.radius) == 0.0:
        return np.array([0.0, 1.0]), np.full(2, march.radius[0] ** 2)
    duration = float(march.time[-1])
    keep = march.radius_time < duration * (1 - 1e-9)
    time, square = march.radius_time[keep], march.radius[keep] ** 2
    last = 0.0 if march.separated else float(march.radius[-1] ** 2)
    turn = peak(march.time, march.depth)[0] if len(march.time) >= FEWEST_ROWS else duration
    growing = int(np.searchsorted(time, turn))
    if 3 <= growing < len(time) and turn < time[growing]:  # no row may stand there already
        before = slice(growing - 3, growing)
        (at_turn,), _ = LocalPolynomials.through(time[before], square[None, before]).at(np.array([turn]))
        time, square = np.insert(time, growing, turn), np.insert(square, growing, at_turn[0])
    shares = np.concatenate([[0.0], time / duration, [1.0]])
    return seen_from_both_sides(shares, np.concatenate([[0.0], square, [last]]))


def seen_from_both_sides(x: Array, y: Array) -> tuple[Array, Array]:
    """The samples with places in between, on the parabola from the left or the right, whichever bends less.

    Where the two do not lie on the same side of the straight line, the line is kept.
    """
    if len(x) < 6:
        return x, y
    slope = np.diff(y) / np.diff(x)
    bend = np.diff(slope) / (x[2:] - x[:-2])
    start, end = x[2:-3], x[3:-2]
    places = start + INSIDE * (end - start)
    line = y[2:-3] + slope[2:-2] * (places - start)
    left = y[2:-3] + (places - start) * (slope[1:-3] + bend[:-3] * (places - x[1:-4]))
    right = y[3:-2] + (places - end) * (slope[3:-1] + bend[3:] * (places - x[4:-1]))
    above, below = np.minimum(left, right), np.maximum(left, right)
    between = np.where(above > line, above, np.where(below < line, below, line))
    order = np.argsort(np.concatenate([x, places.ravel()]), kind="stable")
    return np.concatenate([x, places.ravel()])[order], np.concatenate([y, between.ravel()])[order]
