"""Newton's iteration for one unknown."""

from __future__ import annotations

from collections.abc import Callable

from lumped.errors import NotReached

ITERATIONS = 60
# The error after a step is of the order of its square.
LAST_STEP = 1e-9


def newton(value_and_slope: Callable[[float], tuple[float, float]], start: float) -> float:
    """The positive root of a function given with its slope, to rounding. Raises NotReached."""
    x = start
    for _ in range(ITERATIONS):
        value, slope = value_and_slope(x)
        step = value / slope
        x -= step
        if abs(step) <= LAST_STEP * abs(x):
            return x
    raise NotReached(f"no root was found in {ITERATIONS} iterations from {start:g}")
