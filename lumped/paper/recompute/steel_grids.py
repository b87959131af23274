"""Section 4.2: the parameter study of the steel ball, Fig. 7 and 8. Forces in N, times in us, changes relative."""

from __future__ import annotations

import math

from lumped.paper.examples.given import Examples
from lumped.paper.examples.steel_impacts import solid
from lumped.paper.examples.value import Value, Values, read, spread

MICRO = 1e6
# Fig. 7(b): the text sets the three largest R1 apart from the two smallest.
MANY = 3
R2_WIDTH = 1e-4  # of ln R2, where the lowest peak is sought


def peak_7a_small_R1(examples: Examples) -> Values:
    """Peak of Fig. 7(a) at the smallest R1."""
    return (_peak(examples, *_small_7(examples, 0)),)


def peak_7a_large_R1(examples: Examples) -> Values:
    """At the largest R1."""
    return (_peak(examples, *_large_7(examples, 0)),)


def duration_7a_small_R1(examples: Examples) -> Values:
    """Duration of Fig. 7(a) at the smallest R1."""
    return (_duration(examples, *_small_7(examples, 0)).times(MICRO),)


def duration_7a_large_R1(examples: Examples) -> Values:
    """At the largest R1."""
    return (_duration(examples, *_large_7(examples, 0)).times(MICRO),)


def duration_change_7a(examples: Examples) -> Values:
    """Change of the duration of Fig. 7(a) from the smallest R1 to the largest."""
    return (_duration(examples, *_large_7(examples, 0)).change_from(_duration(examples, *_small_7(examples, 0))),)


def impulse_shares_7a(examples: Examples) -> Values:
    """J/(2 m v) at the smallest and at the largest R1 of Fig. 7(a)."""
    return _impulse_share(examples, *_small_7(examples, 0)), _impulse_share(examples, *_large_7(examples, 0))


def impulse_difference_7a(examples: Examples) -> Values:
    """The difference of the two."""
    small, large = impulse_shares_7a(examples)
    return (large.minus(small),)


def changes_7b_small_R1(examples: Examples) -> Values:
    """From Fig. 7(a) to 7(b) at the two smallest R1: changes of the peaks, then of the durations."""
    grids = examples.grids
    first, second = grids.fig7_R2[:2]
    small = grids.fig7_R1[MANY:]
    peaks = (_peak(examples, R1, second).change_from(_peak(examples, R1, first)) for R1 in small)
    durations = (_duration(examples, R1, second).change_from(_duration(examples, R1, first)) for R1 in small)
    return (*peaks, *durations)


def peak_changes_7b_large_R1(examples: Examples) -> Values:
    """From Fig. 7(a) to 7(b): changes of the peaks at the three largest R1."""
    first, second = examples.grids.fig7_R2[:2]
    large = examples.grids.fig7_R1[:MANY]
    return tuple(_peak(examples, R1, second).change_from(_peak(examples, R1, first)) for R1 in large)


def peaks_7c(examples: Examples) -> Values:
    """Peaks of Fig. 7(c) at the smallest and at the largest R1."""
    return _peak(examples, *_small_7(examples, 2)), _peak(examples, *_large_7(examples, 2))


def peak_change_7c(examples: Examples) -> Values:
    """Change of the peak of Fig. 7(c) from the smallest R1 to the largest."""
    small, large = peaks_7c(examples)
    return (large.change_from(small),)


def peak_places_7c(examples: Examples) -> Values:
    """Place of the peak in the contact, t_p/T, at the smallest and at the largest R1 of Fig. 7(c)."""
    return _peak_place(examples, *_small_7(examples, 2)), _peak_place(examples, *_large_7(examples, 2))


def peak_shift_7c(examples: Examples) -> Values:
    """Change of that place from the smallest R1 to the largest."""
    small, large = peak_places_7c(examples)
    return (large.change_from(small),)


def spread_7d(examples: Examples) -> Values:
    """Spread of the peaks and of the durations of Fig. 7(d)."""
    return _spreads(examples, examples.grids.fig7_R2[-1])


def asymmetry_7d(examples: Examples) -> Values:
    """2 t_p/T - 1 of every curve of Fig. 7(d)."""
    grids = examples.grids
    places = (_peak_place(examples, R1, grids.fig7_R2[-1]) for R1 in grids.fig7_R1)
    return tuple(Value(2.0 * place.value - 1.0, 2.0 * place.error) for place in places)


def spread_at_small_R1(examples: Examples) -> Values:
    """Spread of the peaks at the smallest R1 over R2 of both figures."""
    grids = examples.grids
    return (spread(_peak(examples, min(grids.fig7_R1), R2) for R2 in (*grids.fig7_R2, *grids.fig8_R2)),)


def spread_at_soft_R2(examples: Examples) -> Values:
    """Spread of the peaks and of the durations over R1 at the threshold of R2 itself."""
    return _spreads(examples, examples.grids.soft_R2)


def peaks_8a(examples: Examples) -> Values:
    """Peaks of Fig. 8(a), R2 falling."""
    grids = examples.grids
    return tuple(_peak(examples, grids.fig8_R1[0], R2) for R2 in grids.fig8_R2)


def lowest_8a(examples: Examples) -> Values:
    """The lowest peak at the R1 of Fig. 8(a) over all R2, N, and that R2, us."""
    from scipy.optimize import minimize_scalar

    grids = examples.grids
    ends = math.log(min(grids.fig8_R2)), math.log(max(grids.fig8_R2))
    R1 = grids.fig8_R1[0]

    def height(logarithm: float) -> float:
        return _peak(examples, R1, math.exp(logarithm)).value

    R2 = math.exp(float(minimize_scalar(height, bounds=ends, method="bounded", options={"xatol": R2_WIDTH}).x))
    return _peak(examples, R1, R2), Value(R2, 2.0 * R2_WIDTH * R2).times(MICRO)


def falls_8(examples: Examples) -> Values:
    """Fig. 8(a) to (c): change from the peak at the largest R2 to the lowest one."""
    return tuple(min(peaks).change_from(peaks[0]) for peaks in _curves_8(examples))


def rises_8(examples: Examples) -> Values:
    """Fig. 8(a) to (c): change from the lowest peak to that at the smallest R2."""
    return tuple(peaks[-1].change_from(min(peaks)) for peaks in _curves_8(examples))


def gains_8(examples: Examples) -> Values:
    """Change of the peak from the smallest R1 of Fig. 8 to the largest, one an R2."""
    grids = examples.grids
    ends = max(grids.fig8_R1), min(grids.fig8_R1)
    pairs = ([_peak(examples, R1, R2) for R1 in ends] for R2 in grids.fig8_R2)
    return tuple(large.change_from(small) for large, small in pairs)


def spread_8_soft(examples: Examples) -> Values:
    """Spread of the peaks over R1 at the smallest R2 of Fig. 8."""
    grids = examples.grids
    return (spread(_peak(examples, R1, grids.fig8_R2[-1]) for R1 in grids.fig8_R1),)


def _small_7(examples: Examples, panel: int) -> tuple[float, float]:
    return min(examples.grids.fig7_R1), examples.grids.fig7_R2[panel]


def _large_7(examples: Examples, panel: int) -> tuple[float, float]:
    return max(examples.grids.fig7_R1), examples.grids.fig7_R2[panel]


def _curves_8(examples: Examples) -> list[list[Value]]:
    """Peaks over R2 of the panels whose text speaks of a fall and a rise."""
    grids = examples.grids
    return [[_peak(examples, R1, R2) for R2 in grids.fig8_R2] for R1 in grids.fig8_R1[:3]]


def _spreads(examples: Examples, R2: float) -> Values:
    curves = [(_peak(examples, R1, R2), _duration(examples, R1, R2)) for R1 in examples.grids.fig7_R1]
    return tuple(spread(values) for values in zip(*curves, strict=True))


def _peak(examples: Examples, R1: float, R2: float) -> Value:
    return read(solid(examples.steel, R1, R2), "peak_force")


def _duration(examples: Examples, R1: float, R2: float) -> Value:
    return read(solid(examples.steel, R1, R2), "duration")


def _peak_place(examples: Examples, R1: float, R2: float) -> Value:
    return read(solid(examples.steel, R1, R2), "peak_time").over(_duration(examples, R1, R2))


def _impulse_share(examples: Examples, R1: float, R2: float) -> Value:
    steel = examples.steel
    return read(solid(steel, R1, R2), "impulse", 1.0 / (2.0 * steel.mass * steel.velocity))


MEMBER = {
    function.__name__: function
    for function in (
        peak_7a_small_R1, peak_7a_large_R1, duration_7a_small_R1, duration_7a_large_R1, duration_change_7a,
        impulse_shares_7a, impulse_difference_7a, changes_7b_small_R1, peak_changes_7b_large_R1, peaks_7c,
        peak_change_7c, peak_places_7c, peak_shift_7c, spread_7d, asymmetry_7d, spread_at_small_R1, spread_at_soft_R2,
        peaks_8a, lowest_8a, falls_8, rises_8, gains_8, spread_8_soft,
    )
}  # fmt: skip
