"""A recomputed number with its error bar."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from lumped.errors import NotReached
from lumped.result.result import Result

# Rounding of a closed form, relative to it.
ROUNDING = 1e-12


class Value(NamedTuple):
    """A number and the half-width of its error bar, in one unit."""

    value: float
    error: float = 0.0

    def times(self, factor: float) -> Value:
        """In another unit."""
        return Value(self.value * factor, self.error * abs(factor))

    def by(self, other: Value) -> Value:
        """The product self other; the bars add relatively."""
        error = abs(self.error * other.value) + abs(self.value * other.error)
        return Value(self.value * other.value, error)

    def over(self, other: Value) -> Value:
        """The ratio self/other; the bars add relatively."""
        ratio = self.value / other.value
        return Value(ratio, abs(self.error / other.value) + abs(ratio * other.error / other.value))

    def change_from(self, other: Value) -> Value:
        """self/other - 1."""
        ratio = self.over(other)
        return Value(ratio.value - 1.0, ratio.error)

    def minus(self, other: Value) -> Value:
        """The difference; the bars add."""
        return Value(self.value - other.value, self.error + other.error)


Values = tuple[Value, ...]


def closed(*numbers: float) -> Values:
    """Values of closed forms, which err by rounding."""
    return tuple(Value(number, ROUNDING * abs(number)) for number in numbers)


def read(result: Result, name: str, factor: float = 1.0) -> Value:
    """A quantity of a simulated impact in another unit. Raises NotReached where it is undefined or did not converge."""
    quantity = result.quantities[name]
    if not result.converged or quantity.value is None or quantity.error is None:
        why = result.message or f"{name} is undefined"
        raise NotReached(f"{result.scene.name}, {result.method}: {why}; a smaller step or a longer end time may help")
    return Value(quantity.value, quantity.error).times(factor)


def spread(values: Iterable[Value]) -> Value:
    """The largest over the smallest, minus one."""
    ordered = sorted(values)
    return ordered[-1].change_from(ordered[0])
