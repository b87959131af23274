"""How well each number is known: intervals by profile likelihood, correlation, posterior; and what no curve could tell.

All others, the touches too, are chosen anew at every value of a profile.

Draws are made by an ensemble of walkers: the stretch move of Goodman and Weare, 10.2140/camcos.2010.5.65. A walker
moves along the line through another one, so that scaling or shearing all places changes nothing. The halves of the
ensemble move in turn, each along lines through the other, doi 10.1086/670067. Most moves, by chance, go to a place
drawn from the linearized likelihood of the valleys instead (Metropolis, Hastings, 10.1093/biomet/57.1.97): where that
is nearly the likelihood itself, a draw forgets the one before at once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.fit.profile import Ends, WalkEnd, student
from lumped.identify.histories import Histories, Noise
from lumped.identify.record import LEVEL, Interval, Posterior
from lumped.numbers import Array
from lumped.result.noise import autocovariance, likely_colours

# Rounding: slopes by differences depend on each other to about 2e-4 where the force knows one combination alone; an
# exponent beside its factor is told by ten times as much. Safety: the share of a key in a combination that counts.
ONE, MEMBER = 5e-4, 0.1
STRETCH = 2.0  # the authors' choice: a move lands between 1/2 and 2 of the distance
FADED = 0.05  # a correlation below which a walker has forgotten where it was
WALKERS, LEAST_BURNED = 4, 10  # work: walkers over what is sought, and four more; steps to forget the start
FARTHEST, DEEPEST = 1.0, -10.0  # of a start: from its valley, and the logarithm of its density there at least
TAIL = 6.0  # degrees of freedom: a proposal has to reach farther than what it stands for
SHARE = 0.8  # of the moves that go there: the others find what lies elsewhere
SEED = 1  # of the draws: the same sample every day
COLOURS, ROUGH = 200, 1e-3  # work: colours that are tried for every curve; rounding: far below what they tell
BANDS = 200  # work: draws of which the bands of the force are made

Density = Callable[[Array], float]
Places = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Valley:
    """A likely place of all that is sought, (size,), and the limits of the search around it, (2, size)."""

    sought: Array
    limits: Array


def quantile(histories: Histories) -> float:
    """By how much the sum of squares over the noise may grow within an interval: Fisher's F(1, n - p), squared t."""
    return student(histories.freedom, LEVEL) ** 2


def growth_of_colours(histories: Histories, sought: Array) -> float:
    """How many times as far the sum of squares may grow because short silences tell the colours, and not for sure.

    The colours are integrated out of the posterior of the linearized residuals (Zellner and Tiao, J. Am. Stat. Assoc.
    59 (1964) 763): each that the silences allow has least squares, a deviation and Student's t of its own. Told is the
    square of half an interval over that by the colours taken, on average over the keys.
    """
    if not any(noise.silences for noise in histories.noises):
        return 1.0
    rng, left, slopes = np.random.default_rng(SEED), histories.differences(sought), _unseen_slopes(histories, sought)
    drawn = [
        likely_colours(noise.silences, COLOURS, rng) if noise.silences else [noise.colour] * COLOURS
        for noise in histories.noises
    ]
    every = [_refitted(histories, left, slopes, colours) for colours in zip(*drawn, strict=True)]
    _, taken = _refitted(histories, left, slopes, [noise.colour for noise in histories.noises])
    shares = [
        _half_width(shifts, widths, histories.freedom) / (student(histories.freedom, LEVEL) * width)
        for _, shifts, widths, width in zip(histories.keys, *np.stack(every, axis=2), taken, strict=False)
        if width > 0.0  # a key that changes nothing has no interval
    ]
    return float(np.mean(np.square(shares))) if shares else 1.0


def _unseen_slopes(histories: Histories, sought: Array) -> list[Array]:
    """How what is left of every curve changes with all that is sought, N, (n, size), whatever its noise."""
    white = replace(histories, noises=(Noise(1.0, np.zeros(0)),) * len(histories.samples))
    ends = np.cumsum([one.time.size for one in histories.samples])
    return np.split(white.slopes(sought), ends[:-1])


def _refitted(histories: Histories, left: Sequence[Array], slopes: Sequence[Array], colours: Sequence[Array]) -> Array:
    """How far off the least squares by other colours lie, and the deviations there, (2, size)."""
    noises = tuple(replace(noise, colour=colour) for noise, colour in zip(histories.noises, colours, strict=True))
    other = replace(histories, noises=noises)
    residuals, seen = (np.concatenate(other.whitened(columns)) for columns in (left, slopes))
    inverse = np.linalg.pinv(seen)
    off = -inverse @ residuals
    rest = residuals + seen @ off
    return np.array([off, math.sqrt(float(rest @ rest) / other.freedom) * np.linalg.norm(inverse, axis=1)])


def _half_width(shifts: Array, widths: Array, freedom: int) -> float:
    """Half of the interval around zero that holds the level of Student's t, each shifted, (n,), and so wide."""
    from scipy.optimize import brentq
    from scipy.special import stdtr

    def excess(half: float) -> float:
        outside = stdtr(freedom, (shifts - half) / widths) + stdtr(freedom, (-shifts - half) / widths)
        return float(np.mean(outside)) - (1.0 - LEVEL)

    most = float(np.max(np.abs(shifts) + student(freedom, LEVEL) * widths))  # no colour alone asks for more
    return float(brentq(excess, 0.0, 2.0 * most, rtol=ROUGH))  # rounding: beyond that end


@dataclass(frozen=True, eq=False)
class LikelihoodProfile:
    """The profile of the sum of squares over the noise, from a valley on up to `most`, by `bound` above the least."""

    histories: Histories
    valley: Valley
    most: float
    bound: float

    @cached_property
    def slopes(self) -> Array:
        """Of the residuals in the valley, (rows, size)."""
        return self.histories.slopes(self.valley.sought)

    def intervals(self) -> dict[str, Interval]:
        """Of every key, around its value in the valley."""
        keys = self.histories.keys
        return {keys[i].name: self._interval(i, *ends) for i, ends in self._ends.of(range(len(keys))).items()}

    def _interval(self, i: int, *ends: WalkEnd) -> Interval:
        key = self.histories.keys[i]
        low, high = (None if end.value is None else key.at(end.value) for end in ends)
        unfound = tuple(name for name, end in zip(("low", "high"), ends, strict=True) if not end.reached)
        return Interval(key.at(float(self.valley.sought[i])), low, high, LEVEL, key.kind.unit, unfound)

    @cached_property
    def _ends(self) -> Ends:
        """What is sought is told itself."""
        own, limits = np.eye(self.valley.sought.size), self.valley.limits
        touches = [(True, True)] * len(self.histories.samples)
        return Ends(
            seen=lambda sought: (sought, self.histories.residuals(sought)),
            slopes=lambda sought: (own, self.histories.slopes(sought)),
            best=self.valley.sought,
            first=(own, self.slopes),
            limits=limits,
            opened=np.array([*(key.opened for key in self.histories.keys), *touches]).T,
            most=self.most,
            bound=self.bound,
        )


def correlation_of(slopes: Array) -> Array:
    """Of all that is sought, by the linearized residuals, (size, size)."""
    covariance = np.linalg.pinv(slopes.T @ slopes, hermitian=True)
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))  # rounding: of what nothing tells
    return np.asarray(np.clip(covariance / np.outer(spread, spread), -1.0, 1.0))


def untold(histories: Histories, starts: Sequence[Array]) -> tuple[str, ...]:
    """Keys of which no curve of the scene could tell more than a combination, by their names: empty, if there are none.

    That is so where the force's slopes by them depend on each other at every start, at any time of relaxation.
    """
    fewest = tuple(one.name for one in histories.keys)
    for start in starts:
        slopes = histories.slopes(start)
        sizes = np.linalg.norm(slopes, axis=0)
        _, singular, axes = np.linalg.svd(slopes / np.where(sizes > 0.0, sizes, 1.0), full_matrices=False)
        shares = np.linalg.norm(axes[singular < ONE * singular[0]], axis=0)
        names = tuple(one.name for one, share in zip(histories.keys, shares.tolist(), strict=False) if share > MEMBER)
        fewest = min(fewest, names, key=len)
        if not fewest:
            break
    return fewest


@dataclass(frozen=True, eq=False)
class Draws:
    """Places (steps, walkers, size) with the logarithms of their density, (steps, walkers); share of moves taken."""

    places: Array
    logarithms: Array
    taken: float

    @property
    def rows(self) -> Array:
        """All places, (steps walkers, size), step by step."""
        return self.places.reshape(-1, self.places.shape[2])

    @property
    def effective(self) -> float:
        """As many independent draws would tell the means as well: the worst coordinate's number of draws over
        1 + 2 sum rho_k, the correlation rho_k of a walker with itself k steps later.
        """
        steps, walkers, size = self.places.shape
        return float(min(steps * walkers / self._memory(i) for i in range(size)))

    def _memory(self, coordinate: int) -> float:
        series = self.places[:, :, coordinate] - self.places[:, :, coordinate].mean()
        covariance = np.mean([autocovariance(one, len(series) - 1) for one in series.T], axis=0)
        if not covariance[0] > 0.0:
            return 1.0
        correlation = covariance[1:] / covariance[0]
        faded = np.flatnonzero(correlation < FADED)
        kept = correlation[: faded[0] if faded.size else None]
        return 1.0 + 2.0 * float(kept.sum())


@dataclass(frozen=True, eq=False)
class Linearized:
    """Student's t around every valley, (valleys, size), as wide as its slopes say: axes and widths, see `of`."""

    valleys: Array
    axes: Array
    widths: Array

    @classmethod
    def of(cls, profiles: Sequence[LikelihoodProfile], growth: float) -> Linearized:
        """`growth`: see :func:`posterior_of`. No width is above what is told from afar."""
        parts = [np.linalg.svd(one.slopes, full_matrices=False)[1:] for one in profiles]
        widths = [np.minimum(math.sqrt(growth) / np.maximum(sizes, 1e-300), FARTHEST) for sizes, _ in parts]
        return cls(np.array([one.valley.sought for one in profiles]), np.array([a for _, a in parts]), np.array(widths))

    def step(self, valley: int, rng: np.random.Generator) -> Array:
        """From a valley to a place drawn around it, (size,)."""
        far = math.sqrt(TAIL / rng.chisquare(TAIL))
        return np.asarray(self.axes[valley].T @ (far * self.widths[valley] * rng.normal(size=self.widths.shape[1])))

    def place(self, rng: np.random.Generator) -> Array:
        """A place around any valley, (size,)."""
        valley = int(rng.integers(len(self.valleys)))
        return np.asarray(self.valleys[valley] + self.step(valley, rng))

    def logarithm(self, place: Array) -> float:
        """Of the density there, but for a constant."""
        away = np.einsum("vij,vj->vi", self.axes, place - self.valleys) / self.widths
        power = -0.5 * (TAIL + place.size) * np.log1p(np.sum(away**2, axis=1) / TAIL)
        return float(np.logaddexp.reduce(power - np.log(self.widths).sum(axis=1)))


def draws_of(
    density: Density,
    start: Array,
    steps: int,
    burned: int,
    rng: np.random.Generator,
    linearized: Linearized | None = None,
) -> Draws:
    """So many steps of walkers from their start, (walkers, size), after those that are `burned` to forget it.

    `density`: its logarithm at a place, -inf where there is none. There are as many walkers as twice the coordinates
    and two, or more, an even number. `linearized`: where most moves go; without it all are stretches.
    """
    walkers, size = start.shape
    here, logs = start.copy(), np.array([density(place) for place in start])
    places, kept, taken = np.empty((steps, walkers, size)), np.empty((steps, walkers)), 0
    halves = np.arange(walkers // 2), np.arange(walkers // 2, walkers)
    for step in range(-burned, steps):
        for moving, others in (halves, halves[::-1]):
            there, favour = _stretched(here, moving, others, rng)
            if linearized is not None:
                for i in np.flatnonzero(rng.random(moving.size) < SHARE):
                    there[i] = linearized.place(rng)
                    favour[i] = linearized.logarithm(here[moving[i]]) - linearized.logarithm(there[i])
            found = np.array([density(place) for place in there])
            accepted = np.log(rng.random(moving.size)) < favour + found - logs[moving]
            here[moving[accepted]], logs[moving[accepted]] = there[accepted], found[accepted]
            taken += int(accepted.sum()) if step >= 0 else 0
        if step >= 0:
            places[step], kept[step] = here, logs
    return Draws(places, kept, taken / (steps * walkers))


def _stretched(here: Array, moving: Places, others: Places, rng: np.random.Generator) -> tuple[Array, Array]:
    """Where one half would go, z with the density 1/sqrt(z), (n, size); a move is taken by z^(size - 1) p'/p: (n,)."""
    z = (1.0 + (STRETCH - 1.0) * rng.random(moving.size)) ** 2 / STRETCH
    through = here[rng.choice(others, moving.size)]
    return through + z[:, None] * (here[moving] - through), (here.shape[1] - 1) * np.log(z)


def posterior_of(
    histories: Histories, profiles: Sequence[LikelihoodProfile], growth: float, count: int
) -> tuple[Posterior, list[Array]]:
    """At least so many draws of what is sought, and of every curve the band of the law's force, N, (2, n).

    The likelihood has the noise's deviation integrated out, as the bound of the profiles has, S^(-(n - p)/2); the prior
    is flat where the search looks: in the logarithm of what is above zero. `growth`: the sum of squares over
    the noise may grow so many times as much as of noise alone.
    """
    least = histories.squares(profiles[0].valley.sought)
    every = np.array([one.valley.limits for one in profiles])
    low, high = every[:, 0].min(axis=0), every[:, 1].max(axis=0)

    def density(place: Array) -> float:
        if np.any(place < low) or np.any(place > high):
            return -math.inf
        alone = replace(histories, known={})  # thousands of impacts would fill the memory
        return -0.5 * histories.freedom / growth * math.log(max(alone.squares(place), least) / least)

    rng, walkers = np.random.default_rng(SEED), WALKERS * histories.size + 4
    linearized = Linearized.of(profiles, growth)
    start = np.array([_begun(density, linearized, i % len(profiles), low, high, rng) for i in range(walkers)])
    steps = -(-count // walkers)
    burned = max(LEAST_BURNED, steps // 2)
    draws = draws_of(density, start, steps, burned, rng, linearized)
    return _in_units(histories, draws, walkers, burned), _bands(histories, draws)


def _begun(
    density: Density, linearized: Linearized, valley: int, low: Array, high: Array, rng: np.random.Generator
) -> Array:
    """A place drawn from the linearized likelihood of a valley, nearer where that is no place of the real one."""
    best, step = linearized.valleys[valley], linearized.step(valley, rng)
    while True:
        place = np.clip(best + step, low, high)
        if density(place) > DEEPEST or float(np.abs(step).max()) < 1e-9:  # rounding: the valley itself
            return np.asarray(place)
        step = 0.5 * step


def _in_units(histories: Histories, draws: Draws, walkers: int, burned: int) -> Posterior:
    rows, p = draws.rows, len(histories.keys)
    values = [[key.at(place) for key, place in zip(histories.keys, row, strict=False)] for row in rows[:, :p].tolist()]
    touches = np.array([histories.touches(row) for row in rows])
    logarithms = draws.logarithms.ravel()
    return Posterior(np.array(values), touches, logarithms, walkers, burned, draws.taken, draws.effective)


def _bands(histories: Histories, draws: Draws) -> list[Array]:
    """Of every curve where the law's force lies at the level of the intervals, N, (2, n)."""
    some = draws.rows[np.linspace(0, len(draws.rows) - 1, min(BANDS, len(draws.rows))).astype(int)]
    forces = [list[Array]() for _ in histories.samples]
    for row in some:
        left = replace(histories, known={}).differences(row)
        for column, one, rest in zip(forces, histories.samples, left, strict=True):
            column.append(one.force - rest)
    return [np.quantile(column, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL], axis=0) for column in forces]
