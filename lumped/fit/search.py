"""The fit: the best of searches from several starts, its certainty, and the impact of the fitted law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from lumped import laws
from lumped.errors import BadInput, Fault, NotReached
from lumped.fit.certainty import certainty_of
from lumped.fit.descent import Descent, Found
from lumped.fit.measured import Measured
from lumped.fit.problem import FitProblem
from lumped.fit.record import Fit
from lumped.fit.space import Bounds, space_of
from lumped.fit.starts import starts
from lumped.laws.base import check_mass, simulate
from lumped.result.history import History
from lumped.result.score import Curve, normalized_error
from lumped.scene.scene import Scene

# How many of the starts, the nearest to the curve first, are followed; one is enough where noise is all that is left.
FOLLOWED = 2
HAIR = 1e-4
RESULT_TOLERANCE = 1e-6
# Which parameter holds the peak: the first of these that is free.
STIFFNESSES = ("k", "k1", "E", "E0", "E1", "R1", "E2")


def search(
    curve: History | Curve,
    law: str,
    scene: Scene,
    free: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Bounds | None = None,
    peak: bool = False,
) -> Fit:
    """See :func:`lumped.fit`."""
    check_mass(scene)
    space = space_of(law, scene, free, fixed or {}, bounds or {})
    measured = Measured.of(curve)
    if measured.points <= len(space.free):
        reason = f"{measured.points} points for {len(space.free)} parameters; accepted: more points than parameters"
        raise BadInput(Fault("curve", "", reason))
    stiff = [name for name in STIFFNESSES if name in space.free] or list(space.free)
    problem = FitProblem(space, measured, stiff[0] if peak else None)
    found = best(problem)
    certainty = certainty_of(problem, found.values, found.guess)
    fitted = space.scene_at(found.values)
    result = simulate(laws.get(law).of(fitted), fitted, RESULT_TOLERANCE)
    history = delayed(result.history, space.touch(found.values))
    return Fit(
        law=law,
        scene=fitted,
        result=result,
        history=history,
        parameters=certainty.parameters,
        held=space.held,
        covariance=certainty.covariance,
        correlation=certainty.correlation,
        normalized_error=normalized_error(curve, measured.seen(history)),
        depth=certainty.depth,
        force_at_depth=certainty.force_at_depth,
        peak_held=peak,
        points=measured.points,
        warnings=(*_thinned(measured), *certainty.warnings, *(() if result.converged else (result.message,))),
    )


def _thinned(measured: Measured) -> tuple[str, ...]:
    """What to say where the points are fewer than the rows."""
    said = f"fitted to {measured.points} points, each the mean of {measured.together} neighbouring rows"
    return (said,) if measured.together > 1 else ()


def delayed(history: History, touch: float) -> History:
    """The history on a clock on which the bodies meet at `touch`, s."""
    return replace(history, time=history.time + touch)


def best(problem: FitProblem) -> Found:
    """The nearest of the searches from the best starts. Raises NotReached, BadInput."""
    begun = sorted(_begun(problem), key=lambda found: found.norm)
    ended: list[Found] = []
    for start in begun:
        found = Descent(problem, start).end()
        ended += [] if found is None else [found]
        if len(ended) == FOLLOWED or (found and not problem.measured.systematic(found.error)):
            break
    if not ended:
        reason = f"no search of {', '.join(problem.space.free)} converged from {len(begun)} starts"
        raise NotReached(f"{reason}; cure: fewer free parameters, or bounds for them")
    return min(ended, key=lambda found: found.norm)


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
