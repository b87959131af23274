"""Peaks between rows, Gauss' points, clocks: numbers that know no physics."""

from typing import Any

Real = Any  # a float of floats, an array of arrays, of their shape: what numpy's functions return has no better type
