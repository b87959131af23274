"""scipy's integrators, with their failures named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached, TooManySteps

Array = NDArray[np.float64]
MOST_EVALUATIONS = 300_000
# Explicit steps are cheaper up to about here; beyond they would be as short as the fastest decay.
STIFF = 300.0
POINTS_PER_STEP = 6


@dataclass(frozen=True)
class Path:
    """A solution: `at` maps places (n,) to states (k, n), `places` lie densely in each step, `event` ended it."""

    at: Callable[[Any], Array]
    places: Array
    end: float
    event: int | None
    evaluations: int


@dataclass(frozen=True)
class Settings:
    """Relative tolerance of the integrator, and whether the equations are stiff."""

    rtol: float
    stiff: bool

    @property
    def method(self) -> str:
        """Name of scipy's method."""
        return "Radau" if self.stiff else "DOP853"


def follow(
    rate: Callable[[float, Array], Array],
    span: tuple[float, float],
    state: Array,
    events: Sequence[Callable[[float, Array], float]],
    settings: Settings,
) -> Path:
    """Integrate until the first falling zero of an event, or to the end of the span. Raises NotReached."""
    from scipy import integrate

    evaluations = 0

    def counted(place: float, y: Array) -> Array:
        nonlocal evaluations
        evaluations += 1
        if evaluations > MOST_EVALUATIONS:
            raise TooManySteps(f"more than {MOST_EVALUATIONS} evaluations: ask for a looser tolerance")
        return rate(place, y)

    solve_ivp: Any = integrate.solve_ivp  # its stubs know only their own array shapes
    solution = solve_ivp(
        counted, span, state, method=settings.method, rtol=settings.rtol, atol=1e-3 * settings.rtol,
        dense_output=True, events=[_terminal(event) for event in events] or None,
    )  # fmt: skip
    if solution.status < 0:
        raise NotReached(f"the integration stopped: {solution.message}")
    ended = [i for i, hits in enumerate(solution.t_events or []) if hits.size]
    t = solution.t
    shares = np.arange(POINTS_PER_STEP) / POINTS_PER_STEP
    places = np.append((t[:-1, None] + shares * np.diff(t)[:, None]).ravel(), t[-1])
    event = ended[0] if solution.status == 1 else None
    return Path(_Dense(solution.sol), np.unique(places), float(t[-1]), event, evaluations)


@dataclass(frozen=True)
class _Dense:
    """scipy's dense output, also for no places at all."""

    solution: Any

    def __call__(self, places: Any) -> Array:
        if np.ndim(places) and not np.size(places):
            return np.empty((self.solution.interpolants[0].y_old.size, 0))
        return np.asarray(self.solution(places))


def _terminal(event: Callable[[float, Array], float]) -> Callable[[float, Array], float]:
    """The event in scipy's manner: attributes of the function say that it ends the run, and only falling."""

    def marked(place: float, state: Array) -> float:
        return event(place, state)

    marked.terminal = True  # type: ignore[attr-defined]
    marked.direction = -1.0  # type: ignore[attr-defined]
    return marked
