"""The error of a law over its free parameters, the peak held where that is asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.fit.candidate import Candidate, candidate
from lumped.fit.measured import Measured
from lumped.fit.space import Space

Array = NDArray[np.float64]
Values = Mapping[str, float]
# How the peak answers to a stiffness, about: the first step of the root solve.
PEAK_POWER = 0.4
PEAK_TOLERANCE, MOST_SOLVES = 1e-11, 40
LARGEST_STEP = 3.0


@dataclass(frozen=True, eq=False)
class Problem:
    """`dependent` is the free parameter that holds the peak, "(26)"; None: least squares in all of them."""

    space: Space
    measured: Measured
    dependent: str | None

    @property
    def searched(self) -> tuple[str, ...]:
        """The free parameters that the least squares find."""
        return tuple(name for name in self.space.free if name != self.dependent)

    def candidate(self, values: Values) -> Candidate:
        """The impact at these values of all free parameters. Raises BadInput, NotReached."""
        return candidate(self.space.law, self.space.scene_at(values))

    def error(self, values: Values) -> Array:
        """Residuals at all points, relative to the peak. Raises BadInput, NotReached."""
        return self.error_of(values, self.candidate(values))

    def error_of(self, values: Values, found: Candidate) -> Array:
        """Residuals of an impact that has been computed."""
        return self.measured.error_of(found.force(self.measured.time - self.space.touch(values)))

    def whole(self, searched: Values, near: Values) -> dict[str, float]:
        """All free parameters, in their order: the dependent one from the peak, from `near` on. Raises NotReached."""
        if self.dependent is None:
            return {name: searched[name] for name in self.space.free}
        held = {self.dependent: self._of_peak(self.dependent, searched, near[self.dependent])}
        return {name: {**searched, **held}[name] for name in self.space.free}

    def _of_peak(self, name: str, searched: Values, near: float) -> float:
        """The value of the parameter `name`, by secants in logarithms, at which the peak is the measured one."""
        low, high = (math.log(end) for end in self.space.limits(name, near))

        def excess(x: float) -> float:
            return math.log(self.candidate({**searched, name: math.exp(x)}).peak / self.measured.peak)

        place = math.log(near)
        off, slope = excess(place), PEAK_POWER
        for _ in range(MOST_SOLVES):
            if abs(off) < PEAK_TOLERANCE:
                return math.exp(place)
            step = -math.copysign(min(abs(off / slope), LARGEST_STEP), off / slope)
            there = min(max(place + step, low), high)
            if there == place:
                break
            try:
                off_there = excess(there)
            except BadInput:
                break
            slope = (off_there - off) / (there - place) or slope
            place, off = there, off_there
        raise NotReached(
            f"no {name} gives the measured peak, {self.measured.peak:.6g} N: at {math.exp(place):.6g} it is "
            f"{100.0 * math.expm1(off):+.3g} % off; cure: free another parameter, or fit without holding the peak"
        )
