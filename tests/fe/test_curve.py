"""Interpolation between the steps of a march: exact where it must be, honest at corners."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import cumulative_simpson

from fe_contact.budget.curve import PEAK_SHARE, PLACES, Curve, LocalPolynomials, fitted_peak, peak, seen_from_both_sides
from fe_contact.budget.variation import LATE, Variation, _at_corners, _crossings, calmest, calmest_at_corners
from fe_contact.march.impact import STEPS_ALLOWED, share_of_rest, step_length, time_left
from fe_contact.steppers.steps import Strike
from lumped import Relaxation, Scene

SEEDS = st.integers(0, 2**32 - 1)
NO_CORNERS = np.empty(0)


@given(SEEDS)
def test_local_polynomials_give_back_quintics_and_their_slopes(seed: int) -> None:
    """And the line through two nodes, where there are no more."""
    rng = np.random.default_rng(seed)
    nodes = np.cumsum(rng.uniform(0.05, 0.2, int(rng.integers(2, 30))))
    degree = min(5, len(nodes) - 1)
    quintics = [np.polynomial.Polynomial(rng.normal(size=degree + 1)) for _ in range(2)]
    places = rng.uniform(nodes[0], nodes[-1], 40)
    value, slope = LocalPolynomials.through(nodes, np.stack([p(nodes) for p in quintics])).at(places)
    size = max(np.abs(p(nodes)).max() for p in quintics) + 1.0
    np.testing.assert_allclose(value, [p(places) for p in quintics], atol=1e-8 * size)
    np.testing.assert_allclose(slope, [p.deriv()(places) for p in quintics], atol=1e-6 * size)


def bump(steps: int, jitter: float) -> Curve:
    """A force (1 - cos 2 pi t) of one second, its impulse off by turns."""
    x = np.linspace(0.0, 1.0, steps + 1)
    time = x**2
    impulse = time - np.sin(2 * np.pi * time) / (2 * np.pi) + jitter * (-1.0) ** np.arange(steps + 1) * (time > 0.0)
    mean = np.concatenate([[0.0], impulse[1:] / time[1:]])
    strike = Strike.of(Scene.load("polymer-layer"))
    return Curve(strike, 1.0, True, x, mean, time, np.array([0.0, 1.0]), np.ones(2), 0.0, {})


def force_of(time: np.ndarray, power: float) -> np.ndarray:
    return np.asarray((4.0 * time * (1.0 - time**2)) ** power)


def marched(steps: int, end: float, size: float, cut: float) -> tuple[Curve, np.ndarray]:
    """A force size t (end - t) up to a share ``cut`` of its end, of 3 kg at 2 m/s under 5 m/s2, and its rows' times."""
    time = cut * end * np.linspace(0.0, 1.0, steps + 1) ** 2
    impulse, squared = size * time**2 * (end / 2.0 - time / 3.0), 7.0 * time * (end - time)
    march: Any = SimpleNamespace(
        time=time, depth=4.0 * time - 3.0 * time**2, impulse=impulse, first_force=0.0, radius_time=time[1:],
        radius=np.sqrt(squared[1:]), separated=cut == 1.0, end_spread=0.03 * end, energy={"in": 2.0}, dent=None,
    )  # fmt: skip
    return Curve.of(march, Strike(lambda r: r**2, 3.0, 2.0, 5.0, Relaxation(1.0), 10.0)), time


@pytest.mark.parametrize("end", [1.0, 1e-3])
@pytest.mark.parametrize("cut", [1.0, 0.7])
def test_a_curve_tells_of_a_force_that_is_a_parabola_all_that_there_is(end: float, cut: float) -> None:
    """Force, impulse, depth, speed and radius at any time, in closed form; nothing before the touch, and after the end
    of what has parted. What is cut off presses on.
    """
    size = 30.0 / end**2
    curve, time = marched(40, end, size, cut)
    last = cut * end
    asked = last * np.array([0.0, 1e-4, 0.3, 0.501, 0.77, 0.9999])
    found = curve.read(asked)
    np.testing.assert_allclose(found.force, size * asked * (end - asked), rtol=1e-9, atol=1e-9 * size * end**2)
    np.testing.assert_allclose(found.impulse, size * asked**2 * (end / 2.0 - asked / 3.0), rtol=1e-9)
    np.testing.assert_allclose(found.depth, 4.0 * asked - 3.0 * asked**2, rtol=1e-9, atol=1e-15)
    velocity = 2.0 + 5.0 * asked - found.impulse / 3.0
    np.testing.assert_allclose(curve.velocity(asked, found.impulse), velocity, rtol=1e-9)
    np.testing.assert_allclose(curve.radius_at(time[1:-1]) ** 2, 7.0 * time[1:-1] * (end - time[1:-1]), rtol=1e-9)
    held = size * last * (end - last)
    outside = curve.force(np.array([-0.1 * last, last, 1.1 * last]))
    assert outside == pytest.approx([0.0, *2 * [0.0 if cut == 1.0 else held]], abs=1e-9 * size * end**2)
    assert curve.last_step == pytest.approx(time[-2])
    assert (curve.duration, curve.end_spread, curve.separated) == (last, 0.03 * end, cut == 1.0)
    impulse = size * last**2 * (end / 2.0 - last / 3.0)
    left = impulse / 3.0 - 2.0 - 5.0 * last
    assert curve.leaving_speed == pytest.approx(left)
    parted = {"duration": last, "restitution": left / 2.0} if cut == 1.0 else {"duration": None, "restitution": None}
    told = {"peak_force": size * end**2 / 4.0, "peak_time": end / 2.0, "impulse": impulse, **parted}
    told["peak_depth"] = 4.0 / 3.0 if last > 2.0 / 3.0 else 4.0 * last - 3.0 * last**2
    for name, value in curve.quantities.items():
        assert value == (told[name] if told[name] is None else pytest.approx(told[name], rel=1e-6)), name


@pytest.mark.parametrize("steps", [40, 41])
def test_rows_left_out_by_turns_leave_both_ends_and_what_alternates_is_evened_away(steps: int) -> None:
    """The rest is a polynomial of the fifth degree, which any of its rows tell."""
    x = np.linspace(0.0, 1.0, steps + 1)
    mean = 0.3 + x**2 - 2.0 * x**5
    jitter = 0.01 * (-1.0) ** np.arange(steps + 1)
    jitter[[0, -1]] = 0.0
    curve = replace(bump(steps, 0.0), x=x, mean_force=mean + jitter)
    thin = curve.thinned()
    kept = sorted({*range(0, steps + 1, 2), steps})
    assert np.array_equal(thin.x, x[kept])
    assert np.array_equal(thin.mean_force, (mean + jitter)[kept])
    assert np.array_equal(thin.depth, curve.depth[kept])
    even = curve.evened()
    assert np.array_equal(even.x, x[kept])
    near_ends = 0.01 * (x[kept] < 8.0 / steps) + 0.01 * (x[kept] > 1.0 - 8.0 / steps)
    assert np.all(np.abs(even.mean_force - mean[kept]) <= near_ends + 1e-12)
    assert np.array_equal(even.mean_force[[0, -1]], mean[[0, -1]])
    plain = replace(curve, mean_force=mean)
    asked = np.array([0.0, 0.013, 0.4, 0.999])
    read = plain.read_at(asked)
    np.testing.assert_allclose(read.mean_force, 0.3 + asked**2 - 2.0 * asked**5, atol=1e-12)
    np.testing.assert_allclose(read.depth, asked**2, atol=1e-12)
    assert np.array_equal(read.x, asked)


@pytest.mark.parametrize("within", [1e-4, 1e-2, 0.3, 8.9])
@pytest.mark.parametrize("power", [1.0, 1.5, 2.0])
def test_a_branch_that_relaxes_within_the_first_step_is_read_as_its_law_says(power: float, within: float) -> None:
    """A striker that nothing slows, a branch ``within`` the first of forty steps, ten thousand times as stiff.

    Or within the first three, which are nine times as long.
    """
    x = np.linspace(0.0, 1.0, 41)
    relaxation = Relaxation(1.0, (1e4,), (within * x[1] ** 2,))
    strike = Strike(lambda r: r**2, 1.0, 1.0, 0.0, relaxation, 10.0, power=power)
    mean = np.concatenate([[0.0], x[1:] ** (2 * power) * relaxation.felt(x[1:] ** 2, power)[1] / (power + 1.0)])
    curve = Curve(strike, 1.0, True, x, mean, x**2, np.array([0.0, 1.0]), np.array([0.0, 1.0]), 0.0, {})
    time = x[1] ** 2 * np.geomspace(1e-6, 5.0, 100)
    true = time**power * relaxation.felt(time, power)[0]
    np.testing.assert_allclose(curve.force(time), true, rtol=1e-6, atol=1e-12 * true[-1])


@pytest.mark.parametrize("power", [1.0, 1.25, 1.5])
def test_what_a_dashpot_pushes_back_at_touch_is_not_smoothed_over_the_first_steps(power: float) -> None:
    """A line that comes in steadily presses on it at once: force c (1 + t/tau). Through every other step too."""
    x = np.linspace(0.0, 1.0, 41)
    relaxation = Relaxation(1.0, viscosity=0.3)
    strike = Strike(lambda r: r**2, 1.0, 1.0, 0.0, relaxation, 10.0, power=power)
    mean = np.concatenate([[0.0], x[1:] ** (2 * power) * relaxation.felt(x[1:] ** 2, power)[1] / (power + 1.0)])
    curve = Curve(strike, 1.0, False, x, mean, x**2, np.array([0.0, 1.0]), np.array([0.0, 1.0]), 0.0, {})
    time = np.geomspace(x[1] ** 2, 1.0, 200)
    true = time**power * relaxation.felt(time, power)[0]
    np.testing.assert_allclose(curve.force(time), true, rtol=1e-6)
    assert Variation(curve, curve.thinned(), 1.0).history < 2e-3
    assert curve.first_step == pytest.approx(x[1] ** 2 if power == 1.0 else 0.0)
    begun = curve.force(x[1] ** 2 * np.linspace(0.0, 1.0, 200))
    assert begun[0] < 1e-4 * true[0]
    assert np.all(begun <= 1.2 * true[0])


@pytest.mark.parametrize(
    ("flat", "within", "told"), [(True, 1e-3, True), (False, 1e-3, False), (False, 9.1, True), (False, None, True)]
)
def test_a_force_that_begins_as_no_branch_says_is_the_polynomial_of_its_rows(
    flat: bool, within: float | None, told: bool
) -> None:
    """Under a flat end, whose area presses at once, and where no branch relaxes within the first three steps."""
    x = np.linspace(0.0, 1.0, 41)
    times = () if within is None else (within * x[1] ** 2,)
    strike = Strike(lambda r: r**2, 1.0, 1.0, 0.0, Relaxation(1.0, tuple(1e4 for _ in times), times), 10.0)
    widths = np.array([2.0, 2.0 if flat else 3.0])
    mean = 0.3 + x - 2.0 * x**4
    curve = Curve(strike, 1.0, True, x, mean, x**2, np.array([0.0, 1.0]), widths, 0.0, {})
    asked = np.array([0.004, 0.01, 0.3, 0.77, 1.0])
    found, force, depth = curve.resolved(asked)
    off = np.abs(found - (0.3 + asked - 2.0 * asked**4)).max()
    assert (off < 1e-12) == told
    assert (np.abs(force - (0.3 + 1.5 * asked - 6.0 * asked**4)).max() < 1e-10) == told
    assert depth == pytest.approx(asked**2)


def test_a_force_that_jitters_from_step_to_step_is_read_through_fewer() -> None:
    """Every other step leaves out what is off by turns: the force is right again, to what rows so far apart tell."""
    calm, true = calmest(bump(256, 1e-6)), bump(256, 0.0)
    time = np.linspace(0.1, 0.9, 50)
    off = np.abs(bump(256, 1e-6).force(time) - true.force(time)).max()
    assert len(calm.x) < 257
    assert np.abs(calm.force(time) - true.force(time)).max() < 0.2 * off


@pytest.mark.parametrize(
    ("steps", "jitter", "left"), [(256, 1e-9, 256), (256, 4e-9, 128), (52, 1e-3, 26), (44, 1e-3, 44)]
)
def test_steps_are_left_out_as_soon_as_they_jitter_more_than_they_tell(steps: int, jitter: float, left: int) -> None:
    """A jitter of 2.5e-9 changes as much of the history as half of 128 steps; and a peak needs some 24 of them."""
    assert len(calmest(bump(steps, jitter)).x) == left + 1


def crossing(steps: int, corners: int, jitter: float) -> Curve:
    """The same while its edge crosses so many elements, its impulse off by what the edge's place in one says."""
    smooth = bump(steps, 0.0)
    within = np.sin(np.pi * corners * smooth.x) ** 2 * smooth.x**2
    mean = smooth.mean_force + np.concatenate([[0.0], jitter * within[1:] / smooth.x[1:] ** 2])
    return replace(smooth, mean_force=mean, radius_x=smooth.x, radius_squared=smooth.x**2)


@pytest.mark.parametrize(("corners", "asked"), [(60, NO_CORNERS), (90, NO_CORNERS), (50, np.linspace(0.0, 1.0, 51))])
def test_a_force_that_jitters_from_element_to_element_is_evened_or_read_at_corners(
    corners: int, asked: np.ndarray
) -> None:
    """Rows left out by turns would stand anywhere within an element; of few elements steps are too short to tell."""
    curve, time = crossing(256, corners, 1e-4), np.linspace(0.1, 0.9, 50)
    true, calm = bump(256, 0.0).force(time), calmest_at_corners(curve, asked)
    assert np.abs(calm.force(time) - true).max() < 0.03 * np.abs(curve.force(time) - true).max()


@pytest.mark.parametrize("first", [0, 10])
def test_where_an_edge_meets_corners_a_curve_has_no_other_row(first: int) -> None:
    """Half a crossing lies between, however dense the rows are: before the first corner and after the last."""
    curve, crossed = bump(256, 0.0), np.linspace(0.0, 1.0, 51)[1 + first : 40]
    places = _at_corners(curve, curve, crossed).x ** 2
    assert np.all(np.diff(places) > 0.0)
    at = np.searchsorted(places, [crossed[0] - 1e-9, crossed[-1] + 1e-9])
    np.testing.assert_allclose(places[slice(*at)], crossed, rtol=1e-12)
    before, after = places[at[0] - 1], places[at[1]]
    assert 0.01 <= crossed[0] - before < 0.01 + 2.0 * np.sqrt(crossed[0]) / 256
    assert 0.01 <= after - crossed[-1] < 0.01 + 2.0 / 256


@pytest.mark.parametrize("steps", [64, 256])
def test_an_edge_is_known_to_meet_every_corner_that_it_reaches(steps: int) -> None:
    """Within a step, on its way out; the last of them in the step after which it turns."""
    smooth = bump(steps, 0.0)
    curve = replace(smooth, radius_x=smooth.x, radius_squared=np.sin(np.pi * smooth.x**2) ** 2)
    top = int(curve.radius_squared.argmax())
    last = np.sqrt(curve.radius_squared[top - 1 : top + 1].mean())
    reached = np.append(np.linspace(0.1, 0.9, 9), last)
    crossed = _crossings(curve, np.concatenate([[0.0], reached, [1.1]]))
    assert crossed == pytest.approx(np.arcsin(reached) / np.pi, abs=1.5 / steps)
    assert smooth.x[top - 1] ** 2 < crossed[-1] < smooth.x[top] ** 2
    close = np.linspace(0.0, 0.99, 5 * steps // 8)
    exact, few = np.arcsin(close) / np.pi, _crossings(curve, close)
    passed = np.flatnonzero(np.diff(exact) < 2.0 * np.sqrt(exact[1:]) / steps)  # by a step that is as long as this
    assert 0 < len(few) < len(close) - 10
    assert few.size == pytest.approx(len(close) - 1 - passed[-1], abs=1)


@pytest.mark.parametrize("steps", [40, 80, 256])
def test_a_smooth_force_keeps_its_steps(steps: int) -> None:
    assert len(calmest(bump(steps, 0.0)).x) == steps + 1


def test_a_path_pressed_deeper_by_a_share_moves_the_end_by_that_share_where_the_surface_creeps() -> None:
    """The dent is deeper, too; a striker that leaves slowly would else seem to be late by the whole change of depth."""
    smooth, share = bump(64, 0.0), 1e-3
    slow = replace(smooth.strike, mass=1.0 / (1.02 * smooth.strike.velocity))
    path = replace(smooth, strike=slow, depth=np.sin(2.2 * smooth.x**2))
    deeper = replace(path, depth=(1.0 + share) * path.depth)
    creeping, other = (Variation(path, deeper, 1.0, creeps=creeps).errors["duration"] for creeps in (True, False))
    assert creeping == pytest.approx(share * path.duration, rel=1e-6)
    assert other == pytest.approx(share * path.dense.depth[path.shares >= LATE].max() / path.leaving_speed, rel=1e-6)


def test_a_spike_between_two_rows_is_a_peak_like_any_other() -> None:
    """As a dashpot's at touch may be, narrower than the rows lie apart."""
    smooth, x, alone = bump(64, 0.0), np.linspace(0.0, 1.0, 65), 0
    for place in np.linspace(0.2, 0.4, 41):
        impulse = 0.5 * (1.0 + np.tanh((x**2 - place) / 2e-3))
        mean = np.concatenate([[0.0], impulse[1:] / x[1:] ** 2])
        spike = replace(smooth, mean_force=mean, radius_squared=np.array([1.0, 2.0]))
        alone += np.count_nonzero(spike.dense_force > PEAK_SHARE * spike.dense_force.max()) == 1
        assert spike.quantities["peak_time"] == pytest.approx(place, abs=0.02)
        assert spike.quantities["peak_force"] == pytest.approx(spike.dense_force.max(), rel=0.1)
    assert alone > 0


@pytest.mark.parametrize("place", [1e-8, 1e-6, 1e-4])
def test_a_peak_soon_after_the_touch_is_seen_where_the_steps_are_crowded_there(place: float) -> None:
    """A force t exp(1 - t) in units of its own, over in the first of six hundred shares of the contact."""
    x = np.append(0.0, np.geomspace(1e-2 * place**0.5, 1.0, 120))
    time = x[1:] ** 2 / place
    mean = np.append(0.0, np.e * (1.0 - (1.0 + time) * np.exp(-time)) / time)
    early = replace(bump(120, 0.0), x=x, mean_force=mean, depth=x**2, radius_squared=np.array([1.0, 2.0]))
    assert early.quantities["peak_force"] == pytest.approx(1.0, rel=1e-3)
    assert early.quantities["peak_time"] == pytest.approx(place, rel=2e-2)


@pytest.mark.parametrize("steps", [100, 1000])
def test_of_steps_crowded_at_touch_every_one_is_looked_into(steps: int) -> None:
    """However many there are: a force may peak within any of them, or, at a corner, where two of them meet."""
    x = np.append(0.0, np.geomspace(1e-4, 1.0, steps))
    curve = replace(bump(steps, 0.0), x=x)
    begin, end = x[:-1] ** 2 * (1.0 + 1e-9), x[1:] ** 2 * (1.0 - 1e-9)
    assert np.all(curve.shares.searchsorted(end) > curve.shares.searchsorted(begin))
    assert curve.shares[[0, -1]] == pytest.approx([0.0, 1.0], abs=1e-15)
    looked = np.sqrt(curve.shares)[:, np.newaxis]
    assert np.all(np.abs(looked - x).min(axis=0) <= 1e-9 * x)


@pytest.mark.parametrize("gravity", [1e-6, 1e-2, 9.81])
def test_a_contact_that_swings_on_its_weight_is_looked_into_at_every_step_however_weak_gravity_is(
    gravity: float,
) -> None:
    """As evenly as the steps lie, here in the root of time, to where it is cut off."""
    strike = replace(Strike.of(Scene.load("polymer-layer")), gravity=gravity)
    looked = np.sqrt(replace(bump(64, 0.0), separated=False, strike=strike).shares)
    np.testing.assert_allclose(looked, np.linspace(0.0, 1.0, looked.size), atol=1e-12)


@pytest.mark.parametrize("place", [0.01, 0.07, 0.31, 0.5, 0.64, 0.93, 0.99])
def test_the_peak_of_a_quartic_is_found_by_interpolation_and_by_fit(place: float) -> None:
    def quartic(x: np.ndarray) -> np.ndarray:
        return np.asarray(2.0 - (x - place) ** 2 * (1.0 + 0.3 * (x - place) + (x - place) ** 2))

    times = np.linspace(0.0, 1.0, 21)
    for found in (peak(times, quartic(times)), fitted_peak(0.0, 1.0, quartic(np.linspace(0.0, 1.0, PLACES)))):
        assert found == pytest.approx((place, 2.0), abs=1e-9)


@pytest.mark.parametrize("power", [1.1, 1.5, 3.0])
def test_a_fit_of_a_peak_errs_by_what_a_fit_half_as_high_changes_and_a_third_more(power: float) -> None:
    """A force [4 t (1 - t^2)]^power, no polynomial, by the best quartics through 17 of its values.

    Half as high a part of a peak is 2^(1/2) times less wide: errors of the fourth order in that fall to a quarter.
    """
    x = np.linspace(0.0, 1.0, 321)
    impulse = np.append(0.0, cumulative_simpson(2.0 * x * force_of(x**2, power), x=x))
    mean = np.append(0.0, impulse[1:] / x[1:] ** 2)
    curve = replace(bump(320, 0.0), x=x, mean_force=mean, radius_squared=np.array([1.0, 2.0]))
    peaks = list[np.ndarray]()
    for share in (0.98, 0.99):
        high = curve.dense_time[curve.dense_force > share * curve.dense_force.max()]
        times = np.linspace(high[0], high[-1], 17)
        quartic = np.polynomial.Polynomial.fit(times, curve.force(times), 4)
        (top,) = (root.real for root in quartic.deriv().roots() if high[0] < root.real < high[-1] and root.imag == 0.0)
        peaks.append(np.array([top, quartic(top)]))
    spread = np.abs(peaks[0] - peaks[1]) / (1.0 - 1.0 / 4.0)
    told = curve.with_peak_spread().peak_spread
    assert [told["peak_time"], told["peak_force"]] == pytest.approx(spread, rel=1e-4)


def test_a_fitted_peak_hardly_follows_a_jitter() -> None:
    x = np.linspace(-1.0, 1.0, PLACES)
    jitter = 1e-3 * (-1.0) ** np.arange(PLACES)
    place, height = fitted_peak(-1.0, 1.0, 1.0 - 0.02 * (x - 0.1) ** 2 + jitter)
    assert place == pytest.approx(0.1, abs=0.02)
    assert height == pytest.approx(1.0, abs=2e-4)


def test_what_is_seen_from_both_sides_is_a_parabola_where_the_samples_are_one() -> None:
    x = np.cumsum(np.random.default_rng(3).uniform(0.5, 1.5, 12))
    places, values = seen_from_both_sides(x, 3.0 + x - 0.05 * x**2)
    inner = (places >= x[2]) & (places <= x[-3])
    np.testing.assert_allclose(values[inner], (3.0 + places - 0.05 * places**2)[inner], rtol=1e-13)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("corner", [5.1, 5.5, 5.8])
@pytest.mark.parametrize("apart", [1.0, 0.01])
def test_a_corner_between_two_samples_is_found_where_a_line_would_cut_it(
    corner: float, apart: float, mirrored: bool
) -> None:
    """Between two parabolas."""
    x, side = np.arange(12.0), -1.0 if mirrored else 1.0

    def bent(x: np.ndarray) -> np.ndarray:
        away = side * (x - corner)
        return np.asarray(4.0 - 0.2 * away - 0.02 * away**2 - 0.8 * np.maximum(away, 0.0))

    places, values = seen_from_both_sides(apart * x, bent(x))
    places = places / apart
    beside = (places >= 5.0) & (places <= 6.0)
    assert np.diff(places[beside]).max() < 0.2, "the corner is looked for all along"
    error = np.abs(values - bent(places))[beside].max()
    cut = np.abs(np.interp(corner, x, bent(x)) - bent(np.array([corner]))[0])
    assert error < 0.05 * cut


@pytest.mark.parametrize("steps", [12, 48, 480])
def test_the_time_left_falls_to_a_thousandth_in_as_many_steps_as_the_grading_has(steps: int) -> None:
    left, taken = 0.02, 0
    while left > 1e-3:
        left *= 1 - share_of_rest(left, steps)
        taken += 1
    graded = steps * (np.sqrt(0.02 / 3) - np.sqrt(1e-3 / 3))
    assert 0.8 * graded <= taken <= steps * np.sqrt(0.02 / 3) + 3


@given(SEEDS)
def test_an_end_is_read_exactly_from_a_response_that_falls_along_a_parabola(seed: int) -> None:
    """Which bends a little, either way, from unequal steps, at any size of either; asked a little later."""
    rng = np.random.default_rng(seed)
    size, unit, end = 10 ** rng.uniform(-9.0, 9.0, 3)
    left = unit * np.sort(rng.uniform(0.1, 1.0, 3))[::-1]
    responses = size * left * (1.0 + rng.uniform(-0.3, 0.3) * left / unit)
    assume(left[0] - left[1] > 0.02 * unit and left[1] - left[2] > 0.02 * unit)
    assume(end < 1e3 * unit)  # the digits that a difference of times still has
    asked = float(left[2]) * rng.uniform(0.1, 1.0)
    found = time_left((end - left).tolist(), responses.tolist(), end - asked)
    assert found == pytest.approx(asked, rel=1e-6, abs=1e-9 * unit)
    assert time_left((end - left).tolist(), responses[::-1].tolist(), end - asked) is None, "it does not fall"


@pytest.mark.parametrize("steps", [8, 40, 8192])
def test_no_step_reaches_the_end_that_is_only_expected(steps: int) -> None:
    assert max(share_of_rest(left, steps) for left in np.geomspace(1e-12, 1.0, 200)) < 1.0


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5])
def test_steps_fill_the_expected_contact_half_of_them_before_the_peak_and_grow_after_it(share: float) -> None:
    lengths = np.array([step_length(done, 40, share) for done in range(44)])
    assert lengths[:20].sum() == pytest.approx(share)
    assert lengths[:40].sum() == pytest.approx(1.0)
    assert np.all(lengths[40:] > lengths[39:-1])


@pytest.mark.parametrize("steps", [40, 400])
def test_a_contact_fifty_times_as_long_as_expected_is_followed_to_its_end(steps: int) -> None:
    time, done = 0.0, 0
    while time < 50.0:
        time, done = time + step_length(done, steps, 0.5), done + 1
    assert done < min(4, STEPS_ALLOWED) * steps
