"""Peaks between rows, Gauss' points, clocks: numbers that know no physics."""
