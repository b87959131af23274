"""The fit: the best of searches from several starts, its certainty, and the impact of the fitted law.

Starts by Hertz scaling from the peak and the duration, restitution from the impulse; a search is least squares from one
start, in the logarithms of the parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count, product
from typing import Any

import numpy as np

from lumped import laws
from lumped.errors import BadInput, Fault, NotReached
from lumped.fit.certainty import certainty_of
from lumped.fit.measured import Measured
from lumped.fit.problem import Coordinates, FitProblem
from lumped.fit.profile import ALIKE, forward_slopes
from lumped.fit.record import Fit
from lumped.fit.space import (
    TOUCH,
    Bounds,
    Space,
    damping_names,
    own_keys,
    own_values,
    quietly_held,
    space_of,
    three_parameters,
)
from lumped.laws import impact_bilinear
from lumped.laws._force_law import between_masses, bodies_of
from lumped.laws._parameters import Parameters
from lumped.laws._power_law import spring_contact_time, spring_of_peak
from lumped.laws.base import check_mass, simulate
from lumped.numbers import Array
from lumped.progress import Progress, silent
from lumped.result.history import History
from lumped.result.score import Curve
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice
from lumped.solvers.point.bodies import Stage

# How many searches from the starts, the nearest to the curve first, are to end near the curve, or farther from it than
# no force at all; one is enough where noise is all that is left.
FOLLOWED = 2
HAIR = 1e-4  # safety: of the range or of the guess, by which a start stays inside its bounds
RESULT_TOLERANCE = 1e-6  # of the fitted law's own impact, at the end
# Which parameter holds the peak: the first of these that is free.
STIFFNESSES = ("k", "k1", "E", "E0", "E1", "R1", "E2")
# The damper's force over the spring's, at half depth and full speed, per 1 - e: Hunt-Crossley has 3/2, Kelvin 4/pi.
DAMPER = 1.4
# The loss 1 - e that the impulse tells, and less and more, for it may tell it badly.
LOSSES = (1.0, 0.15, 3.5)
LEAST_RESTITUTION, MOST_RESTITUTION = 0.05, 0.98  # safety: of the e that the impulse tells
# Guesses of the ratio E2/E1 and of the relaxation time over the contact time.
RATIOS, TIMES = (0.3, 2.0), (0.1, 1.0, 10.0)
# Of an elastic modulus: where an echo lets the force jump, a search finds its time from one side only.
ASIDE = (1.0, 0.99, 1.01)
Values = dict[str, float]
# Of the differences: far above what an impact's integration errs by, and the search needs no better slopes.
DIFFERENCE = 1e-4
TOLERANCE, MOST_STEPS = 1e-10, 80  # of the search: relative changes that end it; work: its evaluations
NEARLY = 0.01  # safety: of the square of the noise's deviation, which one parameter more or less takes
# An impact that does not exist is this many times as far from the curve as none at all.
FAR = 10.0


def search(
    curve: History | Curve,
    law: str,
    scene: Scene,
    free: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Bounds | None = None,
    peak: bool = False,
    progress: Progress = silent,
) -> Fit:
    """See :func:`lumped.fit`."""
    check_mass(scene)
    if laws.get(law).elastic:
        laws.get(law).of(scene)  # says what it is for, before its modulus is sought
    space = space_of(law, scene, free, fixed or {}, bounds or {})
    measured = Measured.of(curve)
    if measured.points <= len(space.free):
        reason = f"{measured.points} points for {len(space.free)} parameters; accepted: more points than parameters"
        raise BadInput(Fault("curve", "", reason))
    stiff = [name for name in STIFFNESSES if name in space.free] or list(space.free)
    number, dependent = count(1), stiff[0] if peak else None
    problem = FitProblem(space, measured, dependent, lambda: progress(f"impacts of {law}", next(number), 0))
    found = best(problem)
    certainty = certainty_of(problem, found.values, found.guess)
    fitted = space.scene_at(found.values)
    result = simulate(laws.get(law).of(fitted), fitted, RESULT_TOLERANCE)
    history = replace(result.history, time=result.history.time + space.touch(found.values))
    failed = () if result.converged else (result.message,)
    return Fit(
        law=law,
        curve=curve,
        scene=fitted,
        result=result,
        history=history,
        parameters=certainty.parameters,
        held=space.held,
        covariance=certainty.covariance,
        correlation=certainty.correlation,
        normalized_error=measured.normalized_error(history.force_at(measured.time)),
        depth=certainty.depth,
        force_at_depth=certainty.force_at_depth,
        peak_held=peak,
        points=measured.points,
        warnings=(*_thinned(measured), *_held(space), *certainty.warnings, *failed),
    )


def _thinned(measured: Measured) -> tuple[str, ...]:
    """What to say where the points are fewer than the rows."""
    said = f"fitted to {measured.points} points, each the mean of {measured.together} neighbouring rows"
    return (said,) if measured.together > 1 else ()


def _held(space: Space) -> tuple[str, ...]:
    """What to say where stiffness or damping are the scene's, which nobody has asked for."""
    names = quietly_held(space)
    if not names:
        return ()
    cure = f"to find {'them' if len(names) > 1 else 'it'} too: --free {','.join((*space.free, *names))}"
    return (f"{', '.join(names)} held as the scene has {'them' if len(names) > 1 else 'it'}; {cure}",)


def best(problem: FitProblem) -> Found:
    """The nearest of the searches from the best starts. Raises NotReached, BadInput."""
    begun = sorted(_begun(problem), key=lambda found: found.norm)
    nothing, near, far = np.linalg.norm(problem.of_nothing), list[Found](), list[Found]()
    for start in begun:
        found = Descent(problem, start).end()
        if found is None:
            continue
        ended = near if found.norm < nothing else far
        ended.append(found)
        if len(ended) == FOLLOWED or (ended is near and not problem.measured.systematic(found.error)):
            break
    if not near:
        raise _no_end(", ".join(problem.space.free), len(begun), bool(far))
    return min(near, key=lambda found: found.norm)


def _no_end(names: str, begun: int, far: bool) -> NotReached:
    """Why no search is an answer, and what to do."""
    if far:
        reason = f"searches of {names} end farther from the curve than no force at all"
        return NotReached(reason, "other free parameters, as E0 of a material, or a curve of these bodies")
    return NotReached(
        f"no search of {names} converged from {begun} starts", "fewer free parameters, or bounds for them"
    )


def _begun(problem: FitProblem) -> list[Found]:
    """The starts from which an impact exists, within the bounds; raises the failure of the first if of all."""
    found, failures = [], []
    for guess in starts(problem.space, problem.measured):
        inside = {name: _inside(problem, name, guess[name]) for name in guess}
        try:
            values = problem.whole(inside, inside)
            found.append(Found(values, inside, problem.error(values)))
        except (BadInput, NotReached) as failure:
            failures.append(failure)
    if not found:
        raise failures[0]
    return found


def _inside(problem: FitProblem, name: str, guess: float) -> float:
    """A guess within the bounds, less a hair: a search begins inside them."""
    low, high = problem.space.limits(name, guess)
    hair = HAIR * min(high - low, abs(guess) or 1.0)
    return min(max(guess, low + hair), high - hair)


def starts(space: Space, measured: Measured) -> list[Values]:
    """First guesses of the free parameters, the best founded one first."""
    pulse = CurvePulse(space, measured)
    own = set(own_keys(space.law)) | {TOUCH}
    names = [name for name in (*space.free, *space.held) if name in own]
    of_network = [name for name in (*space.free, *space.held) if name not in own]
    ours = list(pulse.law_guesses(names))
    theirs = list(pulse.network_guesses()) if of_network else [{}]
    every = [{name: (law | solid)[name] for name in space.free} for law, solid in product(ours, theirs)]
    return [one for i, one in enumerate(every) if one not in every[:i]]


@dataclass(frozen=True)
class CurvePulse:
    """The curve seen as an impact of the scene's bodies."""

    space: Space
    measured: Measured

    @property
    def loss(self) -> float:
        """1 - e, e = J/(m v) - 1 from the impulse."""
        scene = self.space.scene
        e = self.measured.impulse / (scene.reduced_mass * scene.velocity) - 1.0
        return 1.0 - min(max(e, LEAST_RESTITUTION), MOST_RESTITUTION)

    def law_guesses(self, names: list[str]) -> Iterator[Values]:
        """Of the law's own parameters: the springs of the peak and of the duration, each with every loss."""
        bodies, held, own = bodies_of(self.space.scene), self.space.held, own_keys(self.space.law)
        depth = bodies.velocity * self.measured.duration / 3.0
        alpha = held.get("alpha", Parameters(self.space.scene, self.space.law).exponent() if "alpha" in own else 1.0)
        of_time = (spring_contact_time(1.0, alpha, bodies) / self.measured.duration) ** (alpha + 1.0)
        of_peak = spring_of_peak(self.measured.peak, alpha, bodies)
        dampers = [name for name in names if name in damping_names(self.space.law) and name not in held]
        for k, share in product((of_peak, of_time), LOSSES if "e" in own else (1.0,)):
            loss = min(share * self.loss, 1.0 - LEAST_RESTITUTION)
            loop = self._loop(k, 1.0 - loss) if "k1" in names else {}
            springs = {TOUCH: self.measured.begin, "alpha": alpha, "e": 1.0 - loss, "k": k, **loop, **held}
            yield springs | {name: share * self._damping(name, springs, depth) for name in dampers}

    def _loop(self, k: float, e: float) -> Values:
        """The numbers of the bilinear law by its own recipe."""
        law = LawChoice(self.space.law, {"k": k, "e": e})
        loop = impact_bilinear.of(replace(self.space.scene, law=law))
        return {"k1": loop.k1, "k2": loop.k2, "yield_depth": loop.yield_depth}

    def _damping(self, name: str, springs: Mapping[str, float], depth: float) -> float:
        """The damper's parameter whose force to the spring's is as 1 - e asks."""
        chosen = {key: springs[key] for key in self.space.free if key in springs}
        velocity = self.space.scene.velocity
        half = Stage(True, 0.5 * depth, velocity)
        bare, damped = (
            between_masses(self.space.law, self.space.scene_at(chosen | {name: value})) for value in (0.0, 1.0)
        )
        spring, damper = bare.force(half.deepest, velocity, half), damped.lost(half.deepest, velocity, half)
        return float(DAMPER * self.loss * spring / damper)

    def network_guesses(self) -> Iterator[Values]:
        """Of the material: the modulus whose Hertz impact peaks alike, shared between what lasts and what relaxes."""
        scene, held, duration = self.space.scene, self.space.held, self.measured.duration
        solid, bodies = scene.geometry.material, bodies_of(scene)
        if laws.get(self.space.law).elastic:  # waves: no Hertz impact tells their modulus, the scene's own is near
            yield from ({"E": share * solid.young.spring, **held} for share in ASIDE)
            return
        of_one = scene.profile.hertz_impact(1.0 / (1.0 - solid.nu**2), bodies.mass, bodies.velocity).force
        sudden = (self.measured.peak / of_one) ** 2.5
        lasting = {**own_values(solid.young), **held}.get("E0", sudden)
        for ratio, time in product(RATIOS, TIMES):
            shared = "E0" in self.space.free
            R1 = ratio if shared else max(sudden / lasting - 1.0, 0.1 * ratio)
            E0 = sudden / (1.0 + ratio) if shared else lasting
            guess = three_parameters(E0, R1, time * duration * (1.0 + R1))
            yield {**guess, "E": sudden, "eta": sudden * time * duration, **held}


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
    """A search in its coordinates; `known` keeps the errors of places that have been computed: slopes begin there."""

    problem: FitProblem
    start: Found
    known: dict[bytes, Array] = field(default_factory=dict)

    def end(self) -> Found | None:
        """Where the search ends, be it far from the curve; None where it does not converge."""
        if not self.problem.searched:
            return self.start
        from scipy.optimize import least_squares

        search: Any = least_squares  # its stubs know only their own array shapes
        # Where no parameter changes the curve it divides by slopes of zero.
        with np.errstate(all="ignore"):
            solution = search(
                self.error, self._coordinates.place(self.start.values), self.slopes, bounds=self._coordinates.limits(),
                xtol=TOLERANCE, ftol=TOLERANCE, gtol=None, max_nfev=MOST_STEPS,
            )  # fmt: skip
        try:
            values = self._coordinates.whole(solution.x)
        except NotReached:
            return None
        found = Found(values, self.start.guess, solution.fun)
        ended = solution.status > 0 or self._nearly(solution.fun, solution.jac)
        return found if ended else None

    def _nearly(self, error: Array, slopes: Array) -> bool:
        """Whether what the slopes promise is nothing beside what noise does to the sum of squares.

        So a search ends that creeps along a valley of what the curve does not tell, where slopes promise in vain.
        """
        left, singular, _ = np.linalg.svd(slopes, full_matrices=False)
        left = left[:, singular * ALIKE > singular[0]]
        promised, freedom = float(np.sum((left.T @ error) ** 2)), error.size - len(self.problem.searched)
        return promised * freedom <= NEARLY * float(error @ error)

    def error(self, place: Array) -> Array:
        """The residuals at a place, shape (n,); where there is no impact, far from any."""
        key = place.tobytes()
        if key not in self.known:
            try:
                self.known[key] = self.problem.error(self._coordinates.whole(place))
            except (BadInput, NotReached):
                self.known[key] = FAR * self.problem.of_nothing
        return self.known[key]

    def slopes(self, place: Array) -> Array:
        """Forward differences, backward at an upper bound; shape (n, q)."""
        return forward_slopes(self.error, place, self._coordinates.limits()[1], DIFFERENCE)

    @cached_property
    def _coordinates(self) -> Coordinates:
        return Coordinates(self.problem, self.start.values, self.start.guess, {})
