"""One search: least squares from one start, in the logarithms of the parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.fit.problem import FitProblem
from lumped.fit.space import REACH, TOUCH

Array = NDArray[np.float64]
# Of the differences: far above what an impact's integration errs by, and the search needs no better slopes.
DIFFERENCE = 1e-4
TOLERANCE, MOST_STEPS = 1e-10, 80
SOLID = ("E0", "R1", "R2")
# An impact that does not exist is this many times as far from the curve as none at all.
FAR = 10.0


@dataclass(frozen=True, eq=False)
class Found:
    """All free parameters at one end of a search, their first guess, and the residuals, shape (n,)."""

    values: Mapping[str, float]
    guess: Mapping[str, float]
    error: Array

    @property
    def norm(self) -> float:
        """How far from the curve."""
        return float(np.linalg.norm(self.error))


@dataclass(frozen=True, eq=False)
class Descent:
    """The coordinates of a search: logarithms of what is positive, the touch in shares of the contact.

    Of the 3-parameter solid a slow relaxation tells the glassy modulus E0 (1 + R1) and the rate R1/R2 at which it
    falls at first, and hardly more: in these the long valley of the error is straight, in E0 and R2 it is bent.
    `known` keeps the errors of places that have been computed, for the slopes there begin with them.
    """

    problem: FitProblem
    start: Found
    known: dict[bytes, Array] = field(default_factory=dict)

    def end(self) -> Found | None:
        """Where the search ends; None where it does not converge."""
        if not self.problem.searched:
            return self.start
        from scipy.optimize import least_squares

        search: Any = least_squares  # its stubs know only their own array shapes
        # Where no parameter changes the curve it divides by slopes of zero.
        with np.errstate(all="ignore"):
            solution = search(
                self.error, self._place(self.start.values), self.slopes, bounds=self._limits().T,
                xtol=TOLERANCE, ftol=TOLERANCE, gtol=None, max_nfev=MOST_STEPS,
            )  # fmt: skip
        try:
            values = self._whole(solution.x)
        except NotReached:
            return None
        found = Found(values, self.start.guess, solution.fun)
        return found if solution.status > 0 and found.norm < np.linalg.norm(self._nothing) else None

    def error(self, place: Array) -> Array:
        """The residuals at a place, shape (n,); where there is no impact, far from any."""
        key = place.tobytes()
        if key not in self.known:
            try:
                self.known[key] = self.problem.error(self._whole(place))
            except (BadInput, NotReached):
                self.known[key] = FAR * self._nothing
        return self.known[key]

    def slopes(self, place: Array) -> Array:
        """Forward differences, backward at an upper bound; shape (n, q)."""
        here, highest = self.error(place), self._limits()[:, 1]
        steps = np.where(place + DIFFERENCE <= highest, DIFFERENCE, -DIFFERENCE)
        columns = [(self.error(there) - here) / step for there, step in zip(place + np.diag(steps), steps, strict=True)]
        return np.array(columns).T

    @property
    def _nothing(self) -> Array:
        """The residuals of no force at all."""
        return self.problem.measured.error_of(np.zeros_like(self.problem.measured.force))

    @property
    def _straight(self) -> bool:
        """Whether the solid is searched for in its glassy modulus and rate: all of it free, and without bounds."""
        return set(SOLID) <= set(self.problem.searched) and not set(SOLID) & self.problem.space.bounds.keys()

    def _limits(self) -> Array:
        """Lowest and highest place, shape (q, 2)."""
        names, guess = self.problem.searched, self.start.guess
        limits = {name: self.problem.space.limits(name, guess[name]) for name in names}
        ends = np.array([self._plain({name: limits[name][i] for name in names}) for i in (0, 1)]).T
        if self._straight:
            rows = [names.index(name) for name in SOLID]
            ends[rows] = self._place(self.start.values)[rows, None] + np.log(REACH) * np.array([-1.0, 1.0])
        return ends

    def _place(self, values: Mapping[str, float]) -> Array:
        if not self._straight:
            return self._plain(values)
        glassy, ratio = values["E0"] * (1.0 + values["R1"]), values["R1"]
        return self._plain({**values, "E0": glassy, "R2": values["R2"] / ratio})

    def _plain(self, values: Mapping[str, float]) -> Array:
        scale = self.problem.measured.duration
        return np.array([values[n] / scale if n == TOUCH else np.log(values[n]) for n in self.problem.searched])

    def _whole(self, place: Array) -> dict[str, float]:
        """All free parameters at a place. Raises NotReached."""
        scale, names = self.problem.measured.duration, self.problem.searched
        values = {n: float(x * scale if n == TOUCH else np.exp(x)) for n, x in zip(names, place, strict=True)}
        if self._straight:
            values |= {"E0": values["E0"] / (1.0 + values["R1"]), "R2": values["R2"] * values["R1"]}
        return self.problem.whole(values, self.start.values)
