"""Draws from a density by an ensemble of walkers: the stretch move of Goodman and Weare, 10.2140/camcos.2010.5.65.

A walker moves along the line through another one, so that scaling or shearing all places changes nothing. The halves
of the ensemble move in turn, each along lines through the other, doi 10.1086/670067.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.fit.noise import autocovariance
from lumped.numbers import Array

STRETCH = 2.0  # the authors' choice: a move lands between 1/2 and 2 of the distance
FADED = 0.05  # a correlation below which a walker has forgotten where it was

Density = Callable[[Array], float]
Places = NDArray[np.intp]


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


def draws_of(density: Density, start: Array, steps: int, burned: int, rng: np.random.Generator) -> Draws:
    """So many steps of walkers from their start, (walkers, size), after those that are `burned` to forget it.

    `density`: its logarithm at a place, -inf where there is none. There are as many walkers as twice the coordinates
    and two, or more, an even number.
    """
    walkers, size = start.shape
    here, logs = start.copy(), np.array([density(place) for place in start])
    places, kept, taken = np.empty((steps, walkers, size)), np.empty((steps, walkers)), 0
    halves = np.arange(walkers // 2), np.arange(walkers // 2, walkers)
    for step in range(-burned, steps):
        for moving, others in (halves, halves[::-1]):
            moved = _moved(density, here, logs, moving, others, rng)
            taken += moved if step >= 0 else 0
        if step >= 0:
            places[step], kept[step] = here, logs
    return Draws(places, kept, taken / (steps * walkers))


def _moved(density: Density, here: Array, logs: Array, moving: Places, others: Places, rng: np.random.Generator) -> int:
    """Move one half where chance takes it: z with the density 1/sqrt(z), taken by z^(size - 1) p'/p; how many."""
    size, count = here.shape[1], moving.size
    z = (1.0 + (STRETCH - 1.0) * rng.random(count)) ** 2 / STRETCH
    through, chance = here[rng.choice(others, count)], np.log(rng.random(count))
    there = through + z[:, None] * (here[moving] - through)
    found = np.array([density(place) for place in there])
    taken = chance < (size - 1) * np.log(z) + found - logs[moving]
    here[moving[taken]], logs[moving[taken]] = there[taken], found[taken]
    return int(taken.sum())
