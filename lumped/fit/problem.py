"""The error of a law over its free parameters, the peak held where that is asked for, and where these are sought.

One impact of a law, as a fit needs it: depth and force at any time, and the peak, at the least cost.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped import laws
from lumped.errors import BadInput, NotReached
from lumped.fit.measured import Measured
from lumped.fit.space import REACH, TOUCH, Space
from lumped.laws._force_law import ForceLaw, bodies_of
from lumped.laws._hereditary import HereditaryLaw, Solve, once
from lumped.numbers import Array, local
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.solvers.point.contact import motion
from lumped.solvers.point.track import PointTrack, peak_of

Values = Mapping[str, float]
# How the peak answers to a stiffness, about: the first step of the root solve.
PEAK_POWER = 0.4
# Rounding: of the logarithm of the peak over the measured one; work: solves for it, more is no convergence.
PEAK_TOLERANCE, MOST_SOLVES = 1e-11, 40
LARGEST_STEP = 3.0  # safety: of the logarithm of a stiffness, in one step of that search
# Below what the differences of a Jacobian see.
STEP_TOLERANCE, INTEGRATOR_TOLERANCE, RESULT_TOLERANCE = 1e-8, 1e-9, 1e-6
NOTHING = 1e-12  # rounding: of what is added before a logarithm
PLACES = 801  # times of the contact at which depth and force are read
# In the coordinates of a 3-parameter solid of which all is sought.
SOLID = ("E0", "R1", "R2")


@dataclass(frozen=True, eq=False)
class FitProblem:
    """`dependent` is the free parameter that holds the peak, "(26)"; None: least squares in all of them.

    `on_impact` is called before every impact.
    """

    space: Space
    measured: Measured
    dependent: str | None
    on_impact: Callable[[], None] = lambda: None

    @property
    def searched(self) -> tuple[str, ...]:
        """The free parameters that the least squares find."""
        return tuple(name for name in self.space.free if name != self.dependent)

    def candidate(self, values: Values) -> Candidate:
        """The impact at these values of all free parameters. Raises BadInput, NotReached."""
        self.on_impact()
        return candidate(self.space.law, self.space.scene_at(values))

    def error(self, values: Values) -> Array:
        """Residuals at all points, relative to the peak. Raises BadInput, NotReached."""
        return self.error_of(values, self.candidate(values))

    @cached_property
    def of_nothing(self) -> Array:
        """The residuals of no force at all."""
        return self.measured.error_of(np.zeros_like(self.measured.force))

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
            f"{100.0 * math.expm1(off):+.3g} % off",
            "free another parameter, or fit without holding the peak",
        )


@dataclass(frozen=True)
class Candidate:
    """`columns` maps times from zero to `end`, s, to depth, m, and force, N, shape (2, n); `peak` in N."""

    columns: Callable[[Array], Array]
    peak: float
    end: float

    def force(self, time: Array) -> Array:
        """F at any times since touch, N: none before touch and after the end."""
        inside = (time >= 0.0) & (time <= self.end)
        return np.where(inside, self.columns(np.clip(time, 0.0, self.end))[1], 0.0)

    def half_depth(self) -> float:
        """Half of the greatest depth, m."""
        return 0.5 * float(self.columns(np.linspace(0.0, self.end, PLACES))[0].max())

    def force_at_depth(self, depth: float) -> float:
        """F in the approach at a depth, N."""
        inward, force = self.columns(np.linspace(0.0, self.end, PLACES))
        way = slice(0, int(np.argmax(inward)))
        return float(local(inward[way], force[way], np.array([depth]))[0])


def candidate(name: str, scene: Scene) -> Candidate:
    """The impact of a scene by the law of this name. Raises BadInput, NotReached."""
    law = laws.get(name).of(scene)
    if isinstance(law, ForceLaw):
        return _of_force_law(law, scene)
    if isinstance(law, HereditaryLaw) and law.solve is not None:
        return _of_memory(law.solve, scene)
    return _of_result(law.simulate(scene, RESULT_TOLERANCE))


def _of_force_law(law: ForceLaw, scene: Scene) -> Candidate:
    until = scene.end_time_of(law.elastic_contact_time(scene))
    track = PointTrack(law, motion(law, bodies_of(scene), law.exit, 1, until, STEP_TOLERANCE))
    (contact,) = track.motion.contacts

    def columns(time: Array) -> Array:
        depth, _, force = track(time)
        return np.array([depth, np.maximum(force, 0.0) if law.exit == "force" else force])

    return Candidate(columns, peak_of(track, contact)[1], contact.end_time)


def _of_memory(solve: Solve, scene: Scene) -> Candidate:
    answer = once(scene, INTEGRATOR_TOLERANCE, solve)
    return Candidate(lambda time: answer.columns(time)[[0, 2]], answer.values["peak_force"] or 0.0, answer.times[-1])


def _of_result(result: Result) -> Candidate:
    history, peak = result.history, result.quantities["peak_force"].value or 0.0
    return Candidate(lambda t: np.array([history.resampled(t).depth, history.force_at(t)]), peak, history.time[-1])


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Where the parameters of a problem are sought: logarithms of what is positive, the touch in shares of the contact.

    Of the 3-parameter solid a slow relaxation tells the glassy modulus E0 (1 + R1) and the rate R1/R2 at which it
    falls at first, and hardly more: in these the long valley of the error is straight, in E0 and R2 it is bent.
    `near` are values of all that is free, around which a held peak is met. `beside`, in a parameter's unit: what is
    added before its logarithm, so that none of it is not infinitely far away.
    """

    problem: FitProblem
    near: Values
    guess: Values
    beside: Values

    @property
    def straight(self) -> bool:
        """Whether the solid is sought by its glassy modulus and rate: all of it free, and without bounds."""
        return set(SOLID) <= set(self.problem.searched) and not set(SOLID) & self.problem.space.bounds.keys()

    def limits(self) -> Array:
        """Lowest and highest place, shape (2, q)."""
        names = self.problem.searched
        limits = {name: self._own_limits(name) for name in names}
        ends = np.array([self._plain({name: limits[name][i] for name in names}) for i in (0, 1)])
        if self.straight:
            rows = [names.index(name) for name in SOLID]
            ends[:, rows] = self.place(self.near)[rows] + np.log(REACH) * np.array([[-1.0], [1.0]])
        for name in self.beside.keys() - self.problem.space.bounds.keys():
            ends[0, names.index(name)] = self.counted(name, 0.0)
        return ends

    def opened(self) -> NDArray[np.bool_]:
        """Which limits only end the search, shape (2, q); others are asked for, or the parameter itself ends there."""
        rows = list[tuple[bool, bool]]()
        for name in self.problem.searched:
            low, high = self._own_limits(name)
            key, solid = self.problem.space.free[name], self.straight and name in SOLID
            bound = name in self.problem.space.bounds
            whole = bound or name in self.beside
            rows.append((not whole and (solid or low > key.low), solid or (not bound and high < key.high)))
        return np.array(rows, dtype=bool).T

    def _own_limits(self, name: str) -> tuple[float, float]:
        """Those asked for; a touch that nobody has bounded lies within a contact's length of where the force begins."""
        space, measured = self.problem.space, self.problem.measured
        if name == TOUCH and name not in space.bounds:
            return measured.begin - measured.duration, measured.begin + measured.duration
        low, high = space.limits(name, self.guess[name])
        return low, high

    def place(self, values: Values) -> Array:
        """Where values are sought, shape (q,)."""
        if not self.straight:
            return self._plain(values)
        glassy, ratio = values["E0"] * (1.0 + values["R1"]), values["R1"]
        return self._plain({**values, "E0": glassy, "R2": values["R2"] / ratio})

    def _plain(self, values: Values) -> Array:
        return np.array([self.counted(name, values[name]) for name in self.problem.searched])

    def counted(self, name: str, value: float) -> float:
        """A value of one parameter, sought or not, as it is counted."""
        if name == TOUCH:
            return value / self.problem.measured.duration
        return float(np.log(value + self.beside.get(name, 0.0)))

    def value(self, name: str, counted: float) -> float:
        """The value of one parameter that is counted so."""
        if name == TOUCH:
            return counted * self.problem.measured.duration
        beside, low = self.beside.get(name, 0.0), self.problem.space.free[name].low
        value = math.exp(counted) - beside
        return value if value > low + NOTHING * beside else low

    def size(self, name: str, value: float) -> float:
        """How fast the value of a parameter grows as it is counted."""
        return self.problem.measured.duration if name == TOUCH else value + self.beside.get(name, 0.0)

    def whole(self, place: Array) -> dict[str, float]:
        """All free parameters at a place. Raises NotReached."""
        values = {n: self.value(n, x) for n, x in zip(self.problem.searched, place.tolist(), strict=True)}
        if self.straight:
            values |= {"E0": values["E0"] / (1.0 + values["R1"]), "R2": values["R2"] * values["R1"]}
        return self.problem.whole(values, self.near)
