"""A recomputed number with its error bar, and how bars go through sums, products and powers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from lumped.errors import NotReached
from lumped.result.result import Result

# Rounding of a closed form, relative to it.
ROUNDING = 1e-12
MILLI, MICRO, PERCENT, KILO = 1e3, 1e6, 100.0, 1e-3  # times an SI value: the number printed in that unit
Number: TypeAlias = "Value | float"


@dataclass(frozen=True, order=True)
class Value:
    """A number and the half-width of its error bar, in one unit; a plain number in an expression has none."""

    value: float
    error: float = 0.0

    def __add__(self, other: Number) -> Value:
        """The bars add."""
        other = _of(other)
        return Value(self.value + other.value, self.error + other.error)

    def __sub__(self, other: Number) -> Value:
        """The bars add."""
        other = _of(other)
        return Value(self.value - other.value, self.error + other.error)

    def __mul__(self, other: Number) -> Value:
        """The bars add relatively."""
        other = _of(other)
        error = abs(self.error * other.value) + abs(self.value * other.error)
        return Value(self.value * other.value, error)

    def __truediv__(self, other: Number) -> Value:
        """The bars add relatively."""
        other = _of(other)
        ratio = self.value / other.value
        return Value(ratio, abs(self.error / other.value) + abs(ratio * other.error / other.value))

    def __pow__(self, power: float) -> Value:
        """The bar grows relatively by the power."""
        return Value(self.value**power, abs(power * self.value ** (power - 1.0)) * self.error)

    __radd__, __rmul__ = __add__, __mul__

    def __rsub__(self, other: float) -> Value:
        return _of(other) - self

    def __rtruediv__(self, other: float) -> Value:
        return _of(other) / self


Values = tuple[Value, ...]


def _of(number: Number) -> Value:
    return number if isinstance(number, Value) else Value(number)


def closed(*numbers: float) -> Values:
    """Values of closed forms, which err by rounding."""
    return tuple(Value(number, ROUNDING * abs(number)) for number in numbers)


def read(result: Result, name: str) -> Value:
    """A quantity of a simulated impact, SI. Raises NotReached where it is undefined or did not converge."""
    quantity = result.quantities[name]
    if not result.converged or quantity.value is None or quantity.error is None:
        why = result.message or f"{name} is undefined"
        raise NotReached(f"{result.scene.name}, {result.method}: {why}; a smaller step or a longer end time may help")
    return Value(quantity.value, quantity.error)


def peak(impact: Result) -> Value:
    """Of the force, N."""
    return read(impact, "peak_force")


def duration(impact: Result) -> Value:
    """In s."""
    return read(impact, "duration")


def peak_place(impact: Result) -> Value:
    """Of the peak in the contact, t_p/T."""
    return read(impact, "peak_time") / duration(impact)


def times(impact: Result) -> Values:
    """Time of the peak and duration, us."""
    return read(impact, "peak_time") * MICRO, duration(impact) * MICRO


def loss(impact: Result) -> Value:
    """1 - e^2."""
    e = read(impact, "restitution")
    return (1.0 - e) * (1.0 + e)


def change(before: Value, after: Value) -> Value:
    """after/before - 1."""
    return after / before - 1.0


def spread(values: Iterable[Value]) -> Value:
    """The change from the smallest to the largest."""
    ordered = sorted(values)
    return change(ordered[0], ordered[-1])
