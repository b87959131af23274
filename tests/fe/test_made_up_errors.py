"""Curves with errors made up: how they fall with the step is known, and so is the truth that the bars have to cover."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.special import beta, betainc

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import CAUSES, Budget, Causes
from fe_contact.budget.certify import (
    ABOUT_A_STEP,
    DAMPED_ANYWHERE,
    NODEWISE_ANYWHERE,
    Trust,
    _by_mesh,
    _judged,
    _rows,
    _time_steps,
    trust,
)
from fe_contact.budget.curve import STENCIL, Curve, extrapolated, squared_radius
from fe_contact.budget.plan import STEPS_AT_DEFAULT
from fe_contact.budget.several import _error, _flight, _late
from fe_contact.budget.variation import RIPPLED, SAFETY, STEEPER, Softening, Variation
from fe_contact.relaxing_impact import _throughout
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.steppers.steps import Strike
from fe_contact.waves import certify as certify_waves
from fe_contact.waves.certify import Moved
from fe_contact.waves.plan import DEFAULTS
from lumped.materials import Relaxation
from lumped.result.result import UNITS

STEPS, CASES = 160, 40
RULED = ("peak_force", "peak_depth", "impulse", "restitution")
STRIKE = Strike(lambda r: r**2, 1.0, 0.3, 0.0, Relaxation(1.0), 10.0)

Terms = Mapping[float, float]  # errors of the finest run, by the power of the step with which they fall
Settings = Callable[..., Numerics]


def made_up(steps: int, off: Callable[[Array], Any], late: float = 0.0, crowded: bool = False) -> Curve:
    """The force [4 t (1 - t)]^(3/2): mean force and depth ``off`` by a share at every instant, the end by a share.

    Rows crowd at touch alone, or at both ends.
    """
    x = np.linspace(0.0, 1.0, steps + 1)
    if crowded:
        x = np.sin(0.5 * np.pi * x)
    share = x**2
    impulse = 8.0 * beta(2.5, 2.5) * betainc(2.5, 2.5, share)
    mean = np.divide(impulse, share, out=np.zeros_like(share), where=share > 0.0)
    return Curve(
        strike=STRIKE,
        duration=1.0 + late,
        separated=True,
        x=x,
        mean_force=mean * (1.0 + off(share)),
        depth=share * (0.3 - 0.2945 * share) * (1.0 + off(share)),  # as fast as the impulse has it, at both ends
        radius_x=x,
        radius_squared=(share * (1.0 - share) + 1e-3) * (1.0 + off(share)),
        end_spread=0.0,
        energy=dict.fromkeys(("in", "out", "stored", "viscous", "contact", "numerical", "residual"), 0.0),
    )


TRUTH = made_up(STEPS, np.zeros_like)


@pytest.fixture
def settings(hertz_strike: Callable[..., Strike], settings_of: Settings) -> Numerics:
    return settings_of(hertz_strike(), steps=STEPS).varied(contact_time=1.0)


def judged(
    settings: Numerics,
    error: Terms,
    phase: float,
    late: Terms | None = None,
    relaxation: Relaxation | None = None,
    flat: bool = False,
) -> Budget:
    """Three runs with such errors, extrapolated and judged as the time steps of an impact are.

    Of ever another ``phase`` along the contact, so that no quantity is right by chance in every case.
    """
    strike = STRIKE if relaxation is None else replace(STRIKE, relaxation=relaxation)

    def run(numerics: Numerics) -> Curve:
        wrong, ends = (
            sum(size * (STEPS / numerics.steps) ** power for power, size in terms.items())
            for terms in (error, late or {})
        )
        found = made_up(numerics.steps, lambda share: wrong * share * (1.5 + np.cos(2.0 * share + phase)), ends)
        return replace(found, strike=strike)

    steps = _time_steps(run, settings, flat)
    changes: dict[str, Causes] = dict.fromkeys(CAUSES, ())
    nothing: Any = None
    return Budget(steps.value, nothing, changes | {"time_step": (*steps.changes, *steps.jitter)}, nothing, nothing)


def over(found: Budget, *names: str) -> dict[str, float]:
    """Errors over bars."""
    values, true = found.curve.quantities, TRUTH.quantities
    return {name: abs(values[name] - true[name]) / found.total(name) for name in names}


def sizes(seed: int) -> list[tuple[float, float]]:
    """Errors of the finest run, of either sign, and phases."""
    rng = np.random.default_rng(seed)
    return [(float(rng.choice([-1, 1]) * 10 ** rng.uniform(-4, -2)), float(rng.uniform(0, 6))) for _ in range(CASES)]


@pytest.mark.parametrize("steps", [STEPS, 16])
@pytest.mark.parametrize("relaxation", [None, Relaxation(1.0, (1.0,), (0.3,))])
def test_errors_that_halve_with_the_step_are_covered_and_no_more(
    settings: Numerics, steps: int, relaxation: Relaxation | None
) -> None:
    """Extrapolation by order two gains little on them: half of the scheme's order is missing."""
    for size, phase in sizes(1):
        found = over(judged(settings.varied(steps=steps), {1: size}, phase, relaxation=relaxation), *RULED)
        assert 0.25 < min(found.values()) <= max(found.values()) <= 1.0, (size, phase, found)


def test_the_band_of_a_force_whose_errors_halve_with_the_step_holds_it_and_is_no_wider(settings: Numerics) -> None:
    for size, phase in sizes(4)[:10]:
        history = replace(judged(settings, {1: size}, phase), numerics=settings).history()
        off, band = np.abs(history.force - TRUTH.force(history.time)), history.force_error
        assert np.all(off <= band), (size, phase)
        assert np.median(off[1:-1] / band[1:-1]) > 0.25, (size, phase)


def test_errors_of_the_schemes_order_and_the_next_are_covered_and_the_bars_are_tight(settings: Numerics) -> None:
    """Tighter where the order shows clearly, which the next one may spoil."""
    for (size, phase), share in zip(sizes(2), np.linspace(0.0, 1.5, CASES), strict=True):
        found = over(judged(settings, {2: size, 3: share * size}, phase), *RULED)
        assert max(found.values()) <= 1.0, (size, phase, found)
        if share > 0.1:
            assert found["peak_force"] > (0.5 if share < 0.2 else 0.25), (share, phase, found)
            assert min(found["impulse"], found["restitution"]) > 0.25, (size, phase, found)


def test_what_falls_with_the_schemes_order_leaves_nothing_in_the_contact_radius(settings: Numerics) -> None:
    """No bar tells it: it has to be extrapolated as the force is."""
    found, times = judged(settings, {2: 0.02}, 0.0).curve, np.linspace(0.01, 0.9, 99)
    np.testing.assert_allclose(found.radius_at(times), TRUTH.radius_at(times), rtol=1e-3)


def test_two_finest_runs_that_agree_by_chance_are_not_believed(settings: Numerics) -> None:
    """Where one order cancels the other in them, the third run shows it, by a change of another size."""
    for (size, phase), cancelled in zip(sizes(3), np.linspace(0.6, 1.3, CASES), strict=True):
        found = over(judged(settings, {1: 3.0 * size, 2: -cancelled * size}, phase), *RULED)
        assert max(found.values()) <= 1.0, (size, cancelled, found)


@pytest.mark.family
@pytest.mark.parametrize("order", [0.6, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("step", [1.0 / STEPS, 1.0 / STEPS**2])
def test_a_relaxation_as_long_as_the_steps_under_a_flat_end_is_covered_whatever_order_it_leaves(
    settings: Numerics, order: float, step: float
) -> None:
    """As long as the mean one, as the first one."""
    as_long = Relaxation(1.0, (1.0,), (step,))
    for size, phase in sizes(7):
        found = over(judged(settings, {order: size}, phase, relaxation=as_long, flat=True), *RULED)
        assert max(found.values()) <= 1.0, (size, phase, found)


def test_ends_that_move_in_proportion_to_the_step_are_covered_though_the_force_knows_nothing_of_it(
    settings: Numerics,
) -> None:
    for (size, phase), late in zip(sizes(4), np.geomspace(6e-3, 0.05, CASES), strict=True):
        found = judged(settings, {2: 0.1 * size}, phase, {1: late})
        assert over(found, "duration")["duration"] <= 1.0, late


@pytest.mark.parametrize(("lates", "median"), [((2e-4, 5e-4), 0.6), ((1e-3, 2e-3), 0.3)])
def test_ends_that_move_as_the_force_does_have_tight_bars(
    lates: tuple[float, float], median: float, settings: Numerics
) -> None:
    """By another order where the fewest steps, four times as long, err by no more than a per cent."""
    shares = []
    for (size, phase), late in zip(sizes(5), np.geomspace(*lates, CASES), strict=True):
        found = judged(settings, {2: 0.1 * size, 3: 0.02 * size}, phase, {2: late, 3: 0.2 * late})
        shares.append(over(found, "duration")["duration"])
    assert 0.25 < min(shares) <= max(shares) <= 1.0
    assert np.median(shares) == pytest.approx(median, rel=0.35)


def wave(size: float, period: float, phase: float) -> Callable[[Array], Array]:
    """A share that swings along the contact."""
    return lambda share: size * np.cos(2.0 * np.pi * (share / period) + phase)


@pytest.mark.parametrize("kind", [Variation, Moved])
def test_two_curves_that_cross_just_where_a_quantity_is_read_make_neither_of_them_right(kind: type[Variation]) -> None:
    """The second errs four times as much as the first, a little earlier or later: they cross, wherever that is."""
    rng = np.random.default_rng(6)
    missed = dict.fromkeys((*RULED, "peak_time"), 0)
    for _ in range(CASES):
        period, size, phase, shift = rng.uniform(0.08, 0.12), 10 ** rng.uniform(-5, -4), *rng.uniform(0.0, 2 * np.pi, 2)
        fine = made_up(STEPS, wave(size, period, phase))
        change = kind(fine, made_up(STEPS, wave(4.0 * size, period, shift)), 1.25 / 3.0)
        for name in missed:
            assert abs(fine.quantities[name] - TRUTH.quantities[name]) <= change.errors[name], (name, phase, shift)
        assert change.errors["peak_time"] < 100.0 * size / period, "nor is all of the contact unknown"
        times = np.linspace(0.0, 1.0, 500)
        assert np.all(np.abs(fine.force(times) - TRUTH.force(times)) <= change.force(times) + 1e-6), (phase, shift)


@pytest.mark.parametrize("flat", [False, True])
def test_a_tilt_of_the_force_moves_its_peak_by_slope_over_curvature(flat: bool) -> None:
    """[1 - 4 u^2]^(3/2) = 1 - 6 u^2 + ..., u from the top, in any unit: a slope 2 s there moves it by s/6."""
    for duration, push, tilt in ((1.0, 1.0, 1e-3), (1e-4, 50.0, -1e-2), (30.0, 1e-3, 1e-4)):
        straight, tilted = (
            replace(made_up(STEPS, off), duration=duration) for off in (np.zeros_like, lambda t, s=tilt: s * (t - 0.5))
        )
        straight, tilted = (replace(one, mean_force=push * one.mean_force) for one in (straight, tilted))
        if flat:
            straight = replace(straight, radius_squared=np.ones_like(straight.x))
        moved = Variation(straight, tilted, 1.0).errors["peak_time"] / (duration * abs(tilt) / 6.0)
        # the bar keeps room for a change that ripples, or whose slope is not its chord's
        assert moved == pytest.approx(STEEPER if flat else RIPPLED, rel=0.03)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_ends_that_are_read_badly_are_known_no_better(order: int) -> None:
    """From any two runs: each end lies anywhere within what it was said to be read to."""
    rng, used = np.random.default_rng(8), 0.0
    for _ in range(100):
        read = 10 ** rng.uniform(-6.0, -2.0, 2)
        late = rng.choice([-1.0, 1.0], 2) * read
        ends = [
            replace(made_up(steps, np.zeros_like, float(wrong)), end_spread=abs(float(wrong)))
            for steps, wrong in zip((40, 20), late, strict=True)
        ]
        found = extrapolated(ends[0], ends[1], order)
        nothing: Any = None
        bar = Budget(found, nothing, dict.fromkeys(CAUSES, ()), nothing, nothing).total("duration")
        used = max(used, abs(found.duration - 1.0) / bar)
        assert abs(found.duration - 1.0) <= bar * (1.0 + 1e-9)
    assert used > 0.95, "nor any worse"


@pytest.mark.parametrize("steps", [STEPS, 16])
def test_runs_that_end_at_quite_different_times_tell_nothing(steps: int, settings: Numerics) -> None:
    """Contacts of 2, 3 and 5 s by ever fewer steps; of sixteen, thirty-two and sixty-four steps, the last two of 6 and
    of 3.5 s.
    """
    found = judged(settings.varied(steps=steps), {2: 1e-3}, 0.0, {1: 1.0})
    assert all(found.total(name) == np.inf for name in (*RULED, "duration"))


def test_peaks_between_rows_lie_within_what_every_other_row_changes_however_little_that_weighs() -> None:
    rng, deepest, little = np.random.default_rng(9), 0.3**2 / (4.0 * 0.2945), 0
    for steps in rng.integers(16, 200, CASES):
        curve = made_up(int(steps), np.zeros_like, crowded=True)
        jitter = Variation(curve, curve.thinned(), 1.0)
        weights = _rows(jitter)
        little += "peak_time" in weights
        errors, spread = replace(jitter, weights=weights).errors, curve.with_peak_spread().peak_spread
        for name, exact in {"peak_force": 1.0, "peak_time": 0.5, "peak_depth": deepest}.items():
            assert abs(curve.quantities[name] - exact) <= errors[name] + SAFETY * spread.get(name, 0.0) + 1e-12, (
                name,
                steps,
            )
    assert little > CASES // 3


@pytest.mark.parametrize("steps", [16, 100, 300])
def test_forces_are_compared_within_every_step(steps: int) -> None:
    curve = made_up(steps, np.zeros_like, crowded=True)
    times, _ = Variation(curve, curve.thinned(), 1.0)._pointwise
    middles = 0.5 * (curve.x[1:] + curve.x[:-1])
    assert np.all(np.isin(curve.duration * middles**2, times))
    assert np.all(np.diff(times) >= 0.0)


def test_rows_that_jitter_count_whole() -> None:
    """Of any size that the rows between do not hide: then it is no matter of how far rows lie apart."""
    rng = np.random.default_rng(10)
    for size in 10 ** rng.uniform(-5.0, -2.0, CASES):
        noise = size * rng.normal(size=STEPS + 1)
        curve = made_up(STEPS, lambda share, noise=noise: noise)
        assert not _rows(Variation(curve, curve.thinned(), 1.0)), size


@pytest.mark.parametrize("fall", [1.5, 3.0, 6.0])
def test_a_skewed_peak_that_a_quartic_fits_badly_lies_within_what_half_of_it_tells(fall: float) -> None:
    """F = t^(3/2) (1 - t)^m by its exact impulse: no step and no mesh knows how the peak is read."""
    x = np.linspace(0.0, 1.0, 401)
    share = x**2
    impulse = beta(2.5, fall + 1.0) * betainc(2.5, fall + 1.0, share)
    mean = np.divide(impulse, share, out=np.zeros_like(share), where=share > 0.0)
    curve = replace(made_up(400, np.zeros_like), x=x, mean_force=mean).with_peak_spread()
    time = 1.5 / (1.5 + fall)
    exact = {"peak_time": time, "peak_force": time**1.5 * (1.0 - time) ** fall}
    nothing: Any = None
    budget = Budget(curve, nothing, dict.fromkeys(CAUSES, ()), nothing, nothing)
    for name, value in exact.items():
        bar = budget.error(name, "time_step")
        assert bar == SAFETY * curve.peak_spread[name], "as safe as every other part of it"
        assert abs(curve.quantities[name] - value) <= bar + 1e-9 * value, name
        assert curve.peak_spread[name] < 1e-3 * value, name


@pytest.mark.parametrize("over_step", [1.0 / 0.3, 1e-3])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9])
@pytest.mark.parametrize(("slow", "dashpot"), [(0.0, 0.0), (0.4, 0.0), (0.0, 0.5), (1.0, 1.0)])
def test_what_branches_faster_than_a_step_carry_is_taken_from_the_trusted_order(
    over_step: float, share: float, slow: float, dashpot: float
) -> None:
    """Down to the scheme's own, where they carry all: then they are dashpots, known to one order less.

    So where part of them is a ``dashpot``, and part of the springs is a ``slow`` branch.
    """
    unit, stiff = 1e-3, 3.0  # s that the contact lasts; the unit of all moduli
    tau, viscous = unit * over_step / STEPS, unit * share / (1.0 - share)
    relaxation = Relaxation(1.0 - slow, ((1.0 - dashpot) * viscous / tau, slow), (tau, 1e6), dashpot * viscous)
    told = {"strike": replace(STRIKE, relaxation=relaxation.scaled(stiff)), "duration": unit}
    off = (1e-3, 4e-3, 16e-3)
    fine, half, quarter = (
        replace(made_up(STEPS // 2**number, lambda s, e=error: e * s * (1.5 + np.cos(2.0 * s))), **told)
        for number, error in enumerate(off)
    )
    found = trust((fine, half, quarter), 2, (unit / STEPS, unit / STEPS), flat=False)
    assert found.orders["force"] == pytest.approx(3.0 - share)
    assert found.orders["impulse"] == pytest.approx(2.0 - share)


@pytest.mark.parametrize(("flat", "shown", "force"), [(False, 4.0, 2.0), (False, 1.2, 1.0), (True, 4.0, 1.0)])
def test_a_branch_as_long_as_a_step_leaves_extrapolation_no_order(flat: bool, shown: float, force: float) -> None:
    """What three lengths of step ``shown`` beside it: the scheme's order, which adds up to itself, or next to none."""
    strike = replace(STRIKE, relaxation=Relaxation(1.0, (0.1,), (1.0 / STEPS,)))
    off = (1e-4, shown * 1e-4, shown**2 * 1e-4)
    fine, half, quarter = (
        replace(made_up(STEPS // 2**number, lambda s, e=error: e * s * (1.5 + np.cos(2.0 * s))), strike=strike)
        for number, error in enumerate(off)
    )
    found = trust((fine, half, quarter), 2, (1.0 / STEPS, 1.0 / STEPS), flat)
    assert found.orders["force"] == force
    assert found.orders["impulse"] == found.orders["restitution"] == (2.0 if shown == 4.0 else 1.0)
    assert 0.0 < found.kept < 0.01, "a tenth of the modulus for a step of the contact's"


def test_what_a_setting_moves_a_later_touch_by_counts_by_its_least_trusted_order() -> None:
    later = replace(TRUTH, strike=replace(STRIKE, velocity=0.31))
    moved = Variation(TRUTH, later, 3.0, {"restitution": 2.0, "duration": 1.0})
    assert _error(moved, lambda strike: strike.velocity) == pytest.approx(0.06)
    assert _error(replace(moved, weights={}), lambda strike: strike.velocity) == pytest.approx(0.03)
    assert _error(None, lambda strike: strike.velocity) == np.inf


def test_the_band_of_a_force_that_is_cut_off_as_it_rises_holds_the_bar_of_its_peak() -> None:
    """Its largest force is its last one, of which no later step tells."""
    rng, x = np.random.default_rng(11), np.linspace(0.0, 1.0, STEPS + 1)
    share = x**2
    impulse = 8.0 / 0.4 * beta(2.5, 2.5) * betainc(2.5, 2.5, 0.4 * share)
    mean = np.divide(impulse, share, out=np.zeros_like(share), where=share > 0.0)
    jittered = mean * (1.0 + 1e-4 * rng.normal(size=x.size))
    cut = replace(made_up(STEPS, np.zeros_like), separated=False, mean_force=jittered)
    jitter = Variation(cut, cut.thinned(), 1.0)
    weighed = replace(jitter, weights=_rows(jitter))
    last = np.array([1.0])
    assert weighed.errors["peak_force"] > 2.0 * jitter.errors["peak_force"]
    assert weighed.force(last)[0] >= weighed.errors["peak_force"]


def test_the_bar_of_a_history_is_the_norm_of_what_changes_over_the_norm_of_the_force() -> None:
    fine, coarse = made_up(STEPS, np.zeros_like), made_up(STEPS, wave(1e-3, 0.3, 1.0))
    times = np.linspace(0.0, 1.0, 20001)
    force = fine.force(times)
    norms = [np.sqrt(np.trapezoid(values**2, times)) for values in (fine.force(times) - coarse.force(times), force)]
    assert Variation(fine, coarse, 0.5).errors["history_l2"] == pytest.approx(0.5 * norms[0] / norms[1], rel=1e-2)


def test_a_viscous_force_is_trusted_no_more_than_the_velocity_that_carries_its_errors() -> None:
    late, bands = np.linspace(0.6, 0.9, 7), []
    for relaxation in (Relaxation(1.0), Relaxation(1.0, (1.0,), (0.3,))):
        curves = (TRUTH, made_up(STEPS, lambda share: 1e-3 * share))
        fine, coarse = (replace(one, strike=replace(STRIKE, relaxation=relaxation)) for one in curves)
        bands.append(Variation(fine, coarse, 2.0, {"restitution": 4.0}).force(late))
    assert bands[1] == pytest.approx(4.0 * bands[0])


@pytest.mark.parametrize("order", [1, 2])
def test_a_later_touch_is_extrapolated_as_all_else_and_the_account_by_the_speed_found(order: int) -> None:
    """What falls with the scheme's order is gone; the square of a speed is no mean of squares."""
    errors, terms = 1e-3 * np.array([1.0, -0.5, 2.0]), {"in": 1.0, "out": 0.3, "stored": 0.2, "numerical": 0.01}

    def run(size: float) -> Curve:
        touched_at, depth, velocity = np.array([2.0, 1e-3, 0.31]) + size * errors
        strike = replace(STRIKE, touched_at=touched_at, depth=depth, velocity=velocity)
        energy = TRUTH.energy | {name: value + 1e-2 * size for name, value in terms.items()}
        return replace(made_up(STEPS, lambda share: 1e-3 * size * share), strike=strike, energy=energy, end_spread=size)

    found = extrapolated(run(1.0), run(2.0**order), order)
    strike = found.strike
    assert (strike.touched_at, strike.depth, strike.velocity) == pytest.approx((2.0, 1e-3, 0.31), rel=1e-12)
    np.testing.assert_allclose(found.mean_force, TRUTH.mean_force, rtol=1e-9, atol=1e-12)
    assert found.energy["out"] == pytest.approx(0.5 * STRIKE.mass * found.leaving_speed**2, rel=1e-12)
    assert found.energy["out"] + found.energy["numerical"] == pytest.approx(0.31)
    assert (found.energy["in"], found.energy["stored"]) == pytest.approx((1.0, 0.2))
    assert sum(found.energy.values()) == pytest.approx(2.0 * found.energy["in"]), "and is balanced"
    assert found.end_spread == pytest.approx(1.0 + (1.0 + 2.0**order) / (2.0**order - 1.0))


def test_where_no_order_shows_the_band_holds_the_whole_change_and_more_where_the_setting_deserves_less_trust() -> None:
    """By its factor, or by that of order one, whichever is more."""
    other, time = made_up(STEPS, lambda share: 1e-3 * share), np.linspace(0.1, 0.8, 50)
    once = Variation(TRUTH, other, 1.0).force(time)
    for trusted, worth in ((3.0, 3.0), (1.0, 1.25)):
        np.testing.assert_allclose(Variation(TRUTH, other, trusted, unresolved=np.inf).force(time), worth * once)


@pytest.mark.parametrize("rises", [True, False])
def test_a_force_that_is_largest_at_either_end_has_places_on_both_sides_of_its_peak(rises: bool) -> None:
    """Cut off as it rises, or fallen from the touch on."""
    force = TRUTH.x**2 if rises else 2.0 - TRUTH.x**2
    curve = replace(TRUTH, mean_force=force, separated=not rises)
    top, left, right = Variation(curve, curve, 1.0)._about_peak
    assert 0 <= left < top < right < curve.shares.size
    assert (top > 0.9 * curve.shares.size) is rises


def test_a_run_that_does_not_part_tells_nothing_of_when_another_does() -> None:
    held = replace(TRUTH, separated=False)
    for change in (Variation(TRUTH, held, 1.0), Variation(held, TRUTH, 1.0)):
        assert change.errors["duration"] == change.errors["restitution"] == np.inf
    assert Variation(held, held, 1.0).errors["duration"] == 0.0


def test_a_body_softer_by_a_share_errs_by_that_share_of_all_work_that_its_force_does() -> None:
    """In and out, whatever is left of it at the end."""
    worked = replace(TRUTH, energy=TRUTH.energy | {"in": 3.0, "out": 2.0})
    assert Softening(worked, 0.1).energies["stored"] == pytest.approx(0.5)
    strike = replace(STRIKE, mass=0.7)
    brought = 0.5 * strike.mass * strike.velocity**2
    for pulled in (0.0, 2.0):  # by gravity, along a path that errs
        given = replace(TRUTH, strike=strike, energy=TRUTH.energy | {"in": brought + pulled})
        assert Softening(given, 0.1).energies["in"] == pytest.approx(0.1 * pulled, abs=1e-12)


@pytest.mark.parametrize("worth", [1.0, 3.0])
def test_a_speed_that_errs_before_the_end_makes_the_bar_of_what_the_striker_takes_along(worth: float) -> None:
    """By the factor of the change, to first order m v dv; the account itself tells nothing of it."""
    true, slow = replace(TRUTH, strike=replace(STRIKE, mass=0.7)), 1e-4
    late = replace(true, mean_force=true.mean_force * (1.0 + slow * np.sin(np.pi * true.x**2)))
    change = Variation(true, late, worth)
    speed = change.errors["restitution"] * STRIKE.velocity
    assert speed == pytest.approx(worth * Variation(true, late, 1.0).velocity)
    assert change.energies["out"] == pytest.approx(0.7 * speed * abs(true.leaving_speed), rel=1e-3)
    other = replace(late, energy=true.energy | {"stored": 0.2})
    trusted = Variation(true, other, worth, {"restitution": 2.0}).energies
    assert trusted["stored"] == pytest.approx(2.0 * worth * 0.2)
    assert trusted["viscous"] == 0.0
    assert trusted["out"] == pytest.approx(2.0 * change.energies["out"], rel=1e-2)


def test_what_a_striker_that_stands_takes_along_errs_by_the_energy_of_the_speed_that_it_may_have() -> None:
    impulse = float(TRUTH.dense.impulse[-1])
    strike = replace(STRIKE, mass=2.0, velocity=0.5 * impulse)
    stands, leaves = (replace(made_up(STEPS, off), strike=strike) for off in (np.zeros_like, lambda t: 1e-3 * t))
    change = Variation(stands, leaves, 1.0)
    speed = change.errors["restitution"] * strike.velocity
    assert abs(stands.leaving_speed) < 1e-5 * speed
    assert change.energies["out"] == pytest.approx(speed**2, rel=1e-3)


@pytest.mark.parametrize(("power", "falls"), [(1.0, False), (1.25, False), (1.75, True), (2.0, True)])
def test_a_jitter_belongs_to_the_steps_where_it_falls_with_them(power: float, falls: bool, settings: Numerics) -> None:
    """A force jitters by the more the shorter the step in which its impulse does: as the step to one power less."""

    def run(numerics: Numerics) -> Curve:
        smooth = made_up(numerics.steps, np.zeros_like)
        by_turns = (-1.0) ** np.arange(numerics.steps + 1) * smooth.x
        return replace(smooth, mean_force=smooth.mean_force + 10.0 / numerics.steps**power * by_turns)

    assert _time_steps(run, settings, False).jitter_falls == falls


@pytest.mark.parametrize("flat", [False, True])
def test_a_jitter_errs_by_what_every_other_row_less_changes(flat: bool, settings: Numerics) -> None:
    """The same in every run, so that it is in no change of the steps; under a flat end as anywhere."""
    strike = replace(STRIKE, relaxation=Relaxation(1.0, (1.0,), (1.0 / STEPS,)))

    def run(numerics: Numerics) -> Curve:
        smooth = made_up(numerics.steps, lambda share: (STEPS / numerics.steps) * 1e-9 * share)
        by_turns = np.where(np.arange(numerics.steps + 1) % 2, 1e-5 * smooth.x, 0.0)
        return replace(smooth, strike=strike, mean_force=smooth.mean_force + by_turns)

    (jitter,) = _time_steps(run, settings, flat).jitter
    time = np.linspace(0.0, 1.0, 40001)
    force = jitter.first.force(time)
    change = np.abs(force - made_up(STEPS, np.zeros_like).force(time))
    norm = np.sqrt(np.trapezoid(change**2, time) / np.trapezoid(force**2, time))
    assert jitter.errors["history_l2"] == pytest.approx(norm, rel=0.05)


@pytest.mark.parametrize(("power", "cause"), [(0.0, "mesh"), (2.0, "time_step")])
def test_a_jitter_counts_once_by_the_steps_where_it_falls_with_them_and_else_by_the_mesh(
    power: float, cause: str, settings: Numerics
) -> None:
    """On a mesh that follows the contact, where nothing else errs."""

    def run(number: int, numerics: Numerics) -> Curve:
        size = 1e-5 * (STEPS / numerics.steps) ** power
        smooth = made_up(numerics.steps, lambda share: (STEPS / numerics.steps) * 1e-9 * share)
        by_turns = np.where(np.arange(numerics.steps + 1) % 2, size * smooth.x, 0.0)
        return replace(smooth, mean_force=smooth.mean_force + by_turns)

    nothing: Any = None
    surface: Any = SimpleNamespace(follows_contact=True)
    runs: Any = SimpleNamespace(surface=lambda one: surface)
    value, changes = _judged(runs, run, 0, settings, False)
    found = Budget(value, nothing, changes, nothing, settings)
    steps = _time_steps(partial(run, 0), settings, False)
    of_steps, jitter = (sum(one.errors["impulse"] for one in some if one) for some in (steps.changes, steps.jitter))
    assert jitter > 0.0
    expected = dict.fromkeys(CAUSES, 0.0) | {"time_step": of_steps}
    expected[cause] += jitter
    assert {one: found.error("impulse", one) for one in CAUSES} == pytest.approx(expected)


def test_a_body_softer_by_a_share_moves_the_speed_by_what_it_moves_the_impulse_and_the_force_by_the_share() -> None:
    errors = Softening(TRUTH, 1e-3).errors
    assert errors["restitution"] == pytest.approx(errors["impulse"] / (STRIKE.mass * STRIKE.velocity), rel=1e-3)
    assert errors["history_l2"] == errors["peak_force"] / TRUTH.quantities["peak_force"] == 1e-3
    assert errors["peak_depth"] == 1e-3 * TRUTH.quantities["peak_depth"]


@pytest.mark.parametrize("leaving", [1e-3, 1.0, 1e3])
def test_a_body_softer_by_a_share_moves_the_end_by_that_share_or_the_time_in_which_the_path_errs_as_much(
    leaving: float,
) -> None:
    impulse = float(TRUTH.dense.impulse[-1])
    slow = replace(TRUTH, strike=replace(STRIKE, mass=impulse / (STRIKE.velocity + leaving)))
    error = Softening(slow, 1e-3).errors["duration"]
    path = 1e-3 * (slow.quantities["peak_depth"] or 0.0) / leaving
    assert error == pytest.approx(max(path, 1e-3 * slow.duration), rel=1e-3)
    assert Softening(replace(slow, separated=False), 1e-3).errors["duration"] == 0.0


@pytest.mark.parametrize("duration", [1.0, 1e-3])
def test_a_force_of_which_nothing_errs_is_known_but_for_its_last_step(duration: float) -> None:
    """There it falls to nothing in any way from what it is at the step's beginning."""
    nothing: Any = None
    curve, last = replace(TRUTH, duration=duration), duration * (1.0 - 1.0 / STEPS) ** 2
    found = Budget(curve, nothing, dict.fromkeys(CAUSES, ()), nothing, nothing)
    times = np.array([0.0, 0.5 * last, 0.999 * last, 1.001 * last, duration])
    held = float(curve.force(np.array([last]))[0])
    assert held > 0.0
    assert found.force_error(times) == pytest.approx([0.0, 0.0, 0.0, held, held])
    pressed = replace(found, curve=replace(curve, separated=False))
    assert np.array_equal(pressed.force_error(times), np.zeros(5)), "what is cut off falls to nothing nowhere"


def test_the_bar_of_a_quantity_is_the_sum_of_what_all_settings_change_and_of_how_well_the_curve_is_read() -> None:
    """How sharply its peak and its end can be read belongs to the steps; a run that failed makes it infinite."""
    nothing: Any = None
    errors = [{name: value * (1.0 + 0.1 * number) for number, name in enumerate(UNITS)} for value in (1.0, 20.0, 300.0)]
    first, second, third = (SimpleNamespace(errors=one, force=partial(np.full_like, fill_value=one["impulse"]),
                                            energies={"in": one["peak_time"]}) for one in errors)  # fmt: skip
    changes: Any = {"mesh": (first, second), "penalty": (third,), "time_step": (second,), "far_field": ()}
    curve = replace(TRUTH, end_spread=7e3, peak_spread={"peak_force": 5e4}, energy=TRUTH.energy | {"in": 1.0})
    found = Budget(curve, nothing, changes, nothing, nothing)
    for name in UNITS:
        read = {"duration": 7e3, "peak_force": SAFETY * 5e4}.get(name, 0.0)
        share = errors[0][name]
        by_cause = {"mesh": 21.0 * share, "penalty": 300.0 * share, "time_step": read + 20.0 * share, "far_field": 0.0}
        assert {cause: found.error(name, cause) for cause in CAUSES} == pytest.approx(by_cause)
        assert found.quantities[name].error == pytest.approx(sum(by_cause.values()))
    assert found.energy_error("in") == pytest.approx(341.0 * errors[0]["peak_time"])
    times = np.array([0.1, 0.5])
    assert found.force_error(times) == pytest.approx(2 * [341.0 * errors[0]["impulse"]])
    failed = replace(found, changes=changes | {"far_field": (None,)})
    assert {failed.error(name, "far_field") for name in UNITS} == {failed.energy_error("in")} == {np.inf}
    largest = curve.dense_force.max()
    assert failed.force_error(times) == pytest.approx(2 * [341.0 * errors[0]["impulse"] + largest])


def in_units(curve: Curve, time: float, length: float, force: float) -> Curve:
    """The same contact with so many of new units to one of the old."""
    strike, relaxation = curve.strike, curve.strike.relaxation
    return replace(
        curve,
        strike=replace(
            strike,
            mass=strike.mass * force * time**2 / length,
            velocity=strike.velocity * length / time,
            relaxation=replace(relaxation, times=tuple(time * one for one in relaxation.times)),
        ),
        duration=time * curve.duration,
        mean_force=force * curve.mean_force,
        depth=length * curve.depth,
        radius_squared=length**2 * curve.radius_squared,
        end_spread=time * curve.end_spread,
        energy={name: force * length * value for name, value in curve.energy.items()},
    )


@pytest.mark.parametrize("seed", range(8))
def test_errors_are_the_same_in_all_units(seed: int) -> None:
    """Of contacts that end apart, elastic or not, that part or are cut off, on a mesh that stays or follows."""
    rng, relaxation = np.random.default_rng(seed), Relaxation(1.0, (1.0,), (0.3,)) if seed & 1 else Relaxation(1.0)
    time, length, force = units = 10 ** rng.uniform(-4.0, 4.0, 3)
    runs = [
        replace(
            made_up(STEPS // part, wave(1e-3 * part**2, 0.5, phase), late=0.02 * part),
            strike=replace(STRIKE, relaxation=relaxation),
            separated=not seed & 2,
            end_spread=1e-3 * part,
            energy={name: float(value) for name, value in zip(TRUTH.energy, rng.uniform(size=7), strict=True)},
        )
        for part, phase in ((1, 0.0), (2, 1.0), (4, 2.0))
    ]
    told = {"weights": {"restitution": 3.0, "peak_force": 2.0}, "creeps": bool(seed & 4)}

    def change(runs: list[Curve], unresolved: float | None) -> Variation:
        finer, coarser = extrapolated(runs[0], runs[1], 2), extrapolated(runs[1], runs[2], 2)
        return Variation(finer, coarser, 0.7, unresolved=unresolved, **told)

    scales = {"peak_force": force, "impulse": force * time, "peak_depth": length, "peak_time": time, "duration": time}
    places = np.linspace(0.0, 1.05, 200)
    for unresolved in (None, 0.1):
        one = change(runs, unresolved)
        other = change([in_units(run, *units) for run in runs], unresolved and unresolved * time)
        assert other.errors == pytest.approx({name: scales.get(name, 1.0) * e for name, e in one.errors.items()})
        assert other.energies == pytest.approx({name: force * length * e for name, e in one.energies.items()})
        assert other.force(time * places) == pytest.approx(force * one.force(places))


def test_no_order_is_trusted_up_to_the_second_step_of_the_coarsest_run(settings: Numerics) -> None:
    """Whose steps end at the squares of equal shares of the root of its duration; there the whole change counts."""
    runs = {STEPS // part: made_up(STEPS // part, lambda t, c=part: 1e-3 * c**2 * t, 0.01 * part) for part in (1, 2, 4)}
    change, *_ = _time_steps(lambda one: runs[one.steps], settings, False).changes
    assert change is not None
    times = 1.04 * (8 / STEPS) ** 2 * np.array([0.999, 1.001])
    band, trusted = change.force(times), replace(change, unresolved=0.0).force(times)
    assert change.factor < 1.0
    assert band == pytest.approx([1.25 / change.factor, 1.0] * trusted)


def test_a_force_that_changes_in_one_place_is_as_well_known_as_before_far_from_there() -> None:
    other = made_up(STEPS, lambda share: 1e-3 * np.exp(-(((share - 0.5) / 0.02) ** 2)))
    band = Variation(TRUTH, other, 1.0).force(np.array([0.1, 0.46, 0.5, 0.54, 0.9]))
    assert band[1:-1].min() > 0.5 * band.max()
    assert band[[0, -1]].max() < 1e-3 * band.max()


@pytest.mark.parametrize("follows", [True, False])
def test_a_mesh_that_stays_is_trusted_less_than_one_that_follows_the_contact(follows: bool, settings: Numerics) -> None:
    """Errors of order two where the mesh follows; where the edge falls anywhere the root of the pressure leaves 3/2."""
    order = 2.0 if follows else 1.5
    numerics = settings.varied(order=4, elements_per_contact=4.0)

    def run(one: Numerics) -> Curve:
        wrong = 1e-3 * (4.0 / one.elements_per_contact) ** order
        return made_up(STEPS, lambda share: wrong * share)

    _, change = _by_mesh(run, numerics, numerics, follows, {})
    assert change is not None
    off = np.abs(run(numerics).dense.impulse - TRUTH.dense.impulse).max()
    assert change.errors["impulse"] == pytest.approx(SAFETY * off, rel=1e-3)
    assert (change.unresolved is None) == follows, "no order shows in a force that jitters"


@pytest.mark.parametrize("weights", [{}, NODEWISE_ANYWHERE, DAMPED_ANYWHERE])
def test_a_mesh_that_stays_counts_longer_and_weighs_more_where_the_force_jitters(
    weights: Mapping[str, float], settings: Numerics
) -> None:
    """A change of the impulse that is over when half of the contact is still to come, and one in its second half."""
    numerics = settings.varied(order=4, elements_per_contact=4.0)

    def changed(begin: float, end: float) -> Variation:
        def run(one: Numerics) -> Curve:
            wrong = 0.0 if one == numerics else 1e-3
            return made_up(STEPS, lambda s: wrong * np.maximum((s - begin) * (end - s), 0.0) / (end - begin) ** 2)

        _, change = _by_mesh(run, numerics, numerics, False, weights)
        assert change is not None
        return change

    early, middle = changed(0.1, 0.4), changed(0.55, 0.7)
    assert early.errors["impulse"] == pytest.approx(0.0, abs=1e-12)
    assert middle.errors["impulse"] == pytest.approx(0.0, abs=1e-12) or weights
    assert middle.errors["impulse"] > 1e-5 or not weights
    assert middle.creeps == (weights is DAMPED_ANYWHERE)
    for name in RULED:
        plain = replace(middle, weights={})
        assert middle.errors[name] == pytest.approx(weights.get(name, 1.0) * plain.errors[name])


def dented(at: float, size: float = 1e-3) -> Curve:
    """Path and mean force off in a hundredth of the contact about a share of it, and nowhere else."""
    return made_up(STEPS, lambda s: size * np.maximum(1.0 - ((s - at) / 0.012) ** 2, 0.0) ** 2)


def when(deep: float) -> float:
    """The share of the contact, past the turn, after which the path is such a share of the largest depth."""
    return 0.3 / 0.589 * (1.0 + float(np.sqrt(1.0 - deep)))


@pytest.mark.parametrize("stays", [True, False])
def test_what_a_setting_changes_counts_for_a_quantity_where_it_is_read_and_nowhere_else(
    stays: bool, settings: Numerics
) -> None:
    """The largest depth where it is nearly reached, or on a mesh that stays above six tenths of it; speed, impulse and
    end in the last quarter of the contact; the history everywhere.
    """

    def change(at: float) -> dict[str, float]:
        _, found = _by_mesh(lambda one: TRUTH if one == settings else dented(at), settings, settings, not stays, {})
        assert found is not None
        return found.errors

    deepest, near, beside, away = (change(when(deep)) for deep in (1.0, 0.9, 0.66, 0.54))
    for one, counts in ((deepest, True), (near, stays), (beside, stays), (away, False)):
        assert (one["peak_depth"] > 1e-5) == counts
    for at in (0.70, 0.80):
        found = change(at)
        for name in ("impulse", "restitution", "duration"):
            assert (found[name] > 1e-5) == (at > 0.75), (name, at)
        assert found["history_l2"] > 1e-5


@pytest.mark.parametrize("duration", [1.0, 1e-3])
def test_a_viscous_force_has_no_order_within_two_steps_of_the_turn_of_its_path(duration: float) -> None:
    """Of the run with longer steps, and only of the change that is told with its time without an order."""
    viscous = replace(STRIKE, relaxation=Relaxation(1.0, viscosity=0.1))
    fine, coarse = (replace(made_up(n, np.zeros_like), strike=viscous, duration=duration) for n in (80, 40))
    rows = duration * (np.arange(41) / 40.0) ** 2
    top = int(coarse.depth.argmax())
    inside, outside = rows[[top - 2, top, top + 2]], rows[[top - 3, top + 3, 0, 40]]
    beside = np.concatenate([0.999 * rows[[top - 2]], 1.001 * rows[[top + 2]], outside])
    found = Variation(fine, coarse, 1.0, unresolved=0.0)
    inside *= [1.0001, 1.0, 0.9999]
    assert found._about_turn(inside).all()
    assert not found._about_turn(beside).any()
    assert not Variation(fine, coarse, 1.0)._about_turn(inside).any()
    elastic = replace(coarse, strike=STRIKE)
    assert not Variation(fine, elastic, 1.0, unresolved=0.0)._about_turn(inside).any()
    for depth, turns in ((coarse.x, [1.0001 * rows[38], rows[40]]), (-coarse.x, [0.0, 0.9999 * rows[2]])):
        assert Variation(fine, replace(coarse, depth=depth), 1.0, unresolved=0.0)._about_turn(np.array(turns)).all()


@pytest.mark.parametrize("trusted", [0.5, 5.0])
def test_the_band_of_a_force_counts_the_touch_and_the_steps_without_an_order_more(trusted: float) -> None:
    """And a last step more than others only where it is cut off."""
    other = made_up(STEPS // 4, lambda share: 1e-3 * (1.0 + share), 0.5)
    step, seen = (STEPS**-2, 1.5 * (4 / STEPS) ** 2)  # the first of either
    times = np.array([0.9 * step, 1.1 * step, 0.99 * seen, 1.01 * seen, 0.5, 1.0])
    least = np.array([3.0, 1.25, 1.25, 0.0, 0.0, 0.0])
    changes = Variation(TRUTH, other, 10.0).force(times) / 10.0
    weights = {"peak_force": 7.0}
    band = Variation(TRUTH, other, trusted, weights).force(times)
    assert band == pytest.approx(np.maximum(trusted, least) * changes)
    for separated in (True, False):
        ended = [replace(one, separated=separated, duration=1.0) for one in (TRUTH, other)]
        weighed, plain = (Variation(*ended, trusted, one).force(times) for one in (weights, {}))
        assert weighed == pytest.approx([1.0, 1.0, 1.0, 1.0, 1.0, 1.0 if separated else 7.0] * plain)


def test_the_steps_that_count_are_seconds_however_long_the_contact(settings: Numerics) -> None:
    """A branch as fast as a step is as fast as a step when both last a thousand times as long."""
    errors = []
    for unit in (1.0, 1e3):
        steps = [settings.steps // part for part in (1, 2, 4)]
        relaxation = Relaxation(1.0, (1.0,), (unit / steps[0],))
        strike = replace(STRIKE, relaxation=relaxation, velocity=STRIKE.velocity / unit)
        runs = {
            count: replace(made_up(count, lambda share, c=count: 30.0 / c**2 * share), duration=unit, strike=strike)
            for count in steps
        }
        found = _time_steps(lambda one, runs=runs: runs[one.steps], settings.varied(contact_time=unit), False)
        errors.append([change.errors["peak_force"] if change else np.inf for change in found.changes])
    assert errors[1] == pytest.approx(errors[0], rel=1e-6)
    assert len(errors[0]) == 2, "and leaves a share of what the finest steps change"


def test_a_later_contact_that_comes_late_moves_its_own_force() -> None:
    """By what the force changes in that time, counted from its own touch."""
    late, share = 0.01, np.linspace(0.05, 0.95, 181)
    rows: Any = SimpleNamespace(time=share, force_error=np.zeros(share.size))
    force = [(4.0 * moved * (1.0 - moved)) ** 1.5 for moved in (share - late, share, share + late)]
    expected = np.maximum(abs(force[0] - force[1]), abs(force[2] - force[1]))
    assert _late(TRUTH, rows, share, late) == pytest.approx(expected, abs=1e-3)
    assert expected.max() > 0.02


@pytest.mark.parametrize(("cause", "order"), [("mesh", 1), ("penalty", 1), ("time_step", 1), ("far_field", 2)])
def test_bars_of_waves_hold_what_falls_with_the_order_of_its_cause(
    cause: str, order: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And no less: where marches with another setting err by a lower order, their bars may be too small."""
    setting = {"mesh": "elements_per_contact", "time_step": "steps"}.get(cause, cause.replace("field", "radius"))
    numerics = WaveNumerics(**DEFAULTS, tolerance=1e-2, elements_per_contact=4.0, penalty=400.0, steps=160,
                            far_radius=20.0, contact_radius=1e-3, contact_time=1.0, peak_share=0.5)  # fmt: skip

    def off(chosen: WaveNumerics) -> float:
        return 0.1 * float(getattr(chosen, setting)) ** -order

    contact = SimpleNamespace(march=None, strike=STRIKE)
    runs: Any = SimpleNamespace(
        follow=lambda chosen: SimpleNamespace(contacts=[contact]),
        rings=False,
        curve=lambda number, chosen: made_up(STEPS, lambda share: np.full_like(share, off(chosen))),
        cheap=80,
    )
    monkeypatch.setattr(certify_waves, "curve_of", lambda *_: None)
    monkeypatch.setattr(certify_waves, "reading", lambda *_: None)
    bar = certify_waves._judged(runs, 0, numerics)[1][cause][0].errors["peak_force"]
    assert SAFETY <= bar / off(numerics) < 1.2 * SAFETY


def test_what_no_run_tells_makes_no_bar() -> None:
    """Where a variation failed nothing is known, of energies neither."""
    nothing: Any = None
    found = Budget(TRUTH, nothing, dict.fromkeys(CAUSES, ()) | {"mesh": (None,)}, nothing, nothing)
    assert found.total("peak_force") == np.inf
    assert found.energy_error("stored") == np.inf


def test_a_quantity_that_has_no_value_has_no_bar() -> None:
    """Of a contact cut off before it ends: neither when, nor how fast; all else has one."""
    nothing: Any = None
    held = replace(TRUTH, separated=False)
    found = Budget(held, nothing, dict.fromkeys(CAUSES, ()), nothing, nothing).quantities
    for name, quantity in found.items():
        assert (quantity.value is None) == (name in ("duration", "restitution")) == (quantity.error is None), name


@pytest.mark.parametrize("separated", [True, False])
def test_what_has_parted_presses_no_more_what_is_cut_off_does(separated: bool) -> None:
    """A force that jumps to nothing at the end, or goes on."""
    held = replace(made_up(STEPS, np.zeros_like), mean_force=np.ones(STEPS + 1), separated=separated)
    np.testing.assert_allclose(held.force(np.array([-0.1, 0.5, 1.01])), [0.0, 1.0, 0.0 if separated else 1.0])


def test_a_flight_follows_from_the_speed_and_the_depth_where_bodies_part() -> None:
    curve = replace(made_up(STEPS, np.zeros_like), strike=replace(STRIKE, gravity=9.81))
    time, depth, velocity, *_ = _flight(curve, 1.2)
    since = time - 1.0
    assert 0.0 < since[0] < since[-1] == pytest.approx(0.2)
    np.testing.assert_allclose(velocity, 9.81 * since - curve.leaving_speed)
    np.testing.assert_allclose(depth, curve.depth[-1] - curve.leaving_speed * since + 0.5 * 9.81 * since**2, atol=1e-9)


@pytest.mark.parametrize("rows", [2, 40])
def test_the_squared_radius_is_told_at_shares_of_any_contact(rows: int) -> None:
    """a^2 = t (T - t) of a contact of a millisecond, also where its path turns before there are three radii."""
    end = 1e-3
    time = end * np.linspace(0.0, 1.0, 2 * rows + 1)[1:]
    depth = time * (end - time)
    march: Any = SimpleNamespace(time=np.append(0.0, time), depth=np.append(0.0, depth), separated=True,
                                 radius=np.sqrt(depth), radius_time=time)  # fmt: skip
    shares, squares = squared_radius(march)
    assert shares[0] == 0.0
    assert shares[-1] == 1.0
    assert np.all(np.diff(shares) >= 0.0)
    np.testing.assert_allclose(squares, end**2 * shares * (1.0 - shares), atol=1e-3 * end**2)


@pytest.mark.parametrize("end", [1e-3, 0.5])
def test_a_contact_that_is_cut_off_is_as_wide_at_its_end_as_it_was_last(end: float) -> None:
    """Growing all the while, a^2 = 3 t, of radii that are not one; of what has parted nothing presses at last."""
    time = end * np.linspace(0.0, 1.0, 41)
    march: Any = SimpleNamespace(time=time, depth=time, separated=False, radius=np.sqrt(3.0 * time[1:]))
    march.radius_time = time[1:]
    shares, squares = squared_radius(march)
    np.testing.assert_allclose(squares, 3.0 * end * shares, rtol=1e-12, atol=1e-15 * end)
    march.separated = True
    assert squared_radius(march)[1][-1] == 0.0
    march.radius = np.full(40, 0.2)
    np.testing.assert_allclose(squared_radius(march), ([0.0, 1.0], [0.04, 0.04]), rtol=1e-12)


@pytest.mark.parametrize("before", [1, 2, 3, 9])
def test_a_squared_radius_that_turns_between_rows_is_known_there_by_those_before(before: int) -> None:
    """A parabola up to the turn, another one after it, which rows on either side do not show."""
    turn, rows = 0.413, np.random.default_rng(before).uniform(0.05, 0.4, before)
    time = np.concatenate([np.sort(rows), [0.43, 0.6, 0.8]])
    squared = np.where(time < turn, time * (2.0 - time), 0.3 * (1.0 - time))
    march: Any = SimpleNamespace(time=np.linspace(0.0, 1.0, 201), separated=True, radius=np.sqrt(squared))
    march.depth, march.radius_time = march.time * (2.0 * turn - march.time), time
    shares, squares = squared_radius(march)
    at = np.isclose(shares, turn, atol=1e-6)
    assert at.any() == (before >= 3)
    np.testing.assert_allclose(squares[at], turn * (2.0 - turn), rtol=1e-5)


def trusted(order: int, relaxation: Relaxation, flat: bool) -> Trust:
    """What three runs show that err by the scheme's own order."""
    strike = replace(STRIKE, relaxation=relaxation)
    fine, half, quarter = (
        replace(made_up(STEPS // 2**number, lambda s, e=error: e * s * (1.5 + np.cos(2.0 * s))), strike=strike)
        for number, error in enumerate((1e-4, 1e-4 * 2**order, 1e-4 * 4**order))
    )
    return trust((fine, half, quarter), order, (1.0 / STEPS, 1.0 / STEPS), flat)


@pytest.mark.parametrize("pressed", [0, 1, 2])
def test_ends_of_which_one_is_unknown_show_no_order_and_take_none(pressed: int) -> None:
    """A run that still presses has neither duration nor restitution; the force has its order all the same."""
    curves = [made_up(STEPS // 2**number, lambda s, e=4.0**number: 1e-4 * e * s) for number in range(3)]
    whole = trust((curves[0], curves[1], curves[2]), 2, (1.0 / STEPS, 1.0 / STEPS), False)
    curves[pressed] = replace(curves[pressed], separated=False)
    found = trust((curves[0], curves[1], curves[2]), 2, (1.0 / STEPS, 1.0 / STEPS), False)
    assert found == whole
    assert found.orders["duration"] == found.orders["restitution"] == found.orders["force"] == 3.0


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("flat", [False, True])
def test_a_branch_far_longer_than_a_step_takes_no_order_but_where_a_first_one_lags(order: int, flat: bool) -> None:
    """Backward differences of a contact that grows lag behind what relaxes: nothing is left to extrapolate."""
    relaxations = Relaxation(1.0, (1.0,), (30.0 / STEPS,)), Relaxation(1.0)
    slow, elastic = (trusted(order, one, flat).orders for one in relaxations)
    lags = order == 1 and not flat
    assert elastic["force"] == order + 1.0
    assert slow["force"] == (order if lags else order + 1.0)
    assert slow["impulse"] == order
    assert elastic["impulse"] == order + 1.0


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_branch_a_thousand_times_faster_than_a_step_is_a_dashpot(share: float) -> None:
    """That carries as much of the force: it takes as much trust, and leaves no more of what the steps change."""
    viscosity, time = share / (1.0 - share), 1e-3 / STEPS
    branch, dashpot = (
        trusted(2, one, False)
        for one in (Relaxation(1.0, (viscosity / time,), (time,)), Relaxation(1.0, viscosity=viscosity))
    )
    assert dashpot.orders == pytest.approx(branch.orders)
    assert dashpot.kept == branch.kept == 0.0


@pytest.mark.parametrize("times", [(), (30.0 / STEPS,), (1.0 / STEPS,), (1e-3 / STEPS,)])
def test_a_dashpot_takes_an_order_by_the_share_that_it_carries_whatever_relaxes_beside_it(
    times: tuple[float, ...],
) -> None:
    """What adds up over the contact loses next to a whole one where it carries all, and no force gains any."""
    moduli = tuple(1e-3 / time for time in times)
    without, little, much = (trusted(2, Relaxation(1.0, moduli, times, one), False).orders for one in (0.0, 0.1, 1e4))
    for name in ("force", "impulse", "restitution", "peak_depth"):
        assert much[name] <= little[name] <= without[name], name
    for name in ("impulse", "restitution", "peak_depth"):
        assert little[name] < without[name], name
        assert much[name] == pytest.approx(1.0, abs=1e-3), name


@pytest.mark.parametrize("duration", [1.0, 1e-3])
@pytest.mark.parametrize("late", [1e-5, 0.05])
def test_a_body_strained_much_errs_in_its_duration_by_no_less_a_share_than_in_its_force(
    duration: float, late: float
) -> None:
    """Two meshes may agree in when a contact ends by chance; where they do not it is left as it is."""
    first = replace(TRUTH, duration=duration)
    other = replace(made_up(STEPS, lambda s: np.full_like(s, 0.01)), duration=duration * (1.0 + late))
    change = Variation(first, replace(other, depth=first.depth), 1.3)
    whole, values = _throughout(change).errors, first.quantities
    force, end = change.errors["peak_force"] / values["peak_force"], change.errors["duration"] / values["duration"]
    assert (force > end) == (late < 0.01)
    assert whole["duration"] == pytest.approx(max(force, end) * duration)
    assert whole | {"duration": 0.0} == pytest.approx(change.errors | {"duration": 0.0})
    for same in (Variation(first, first, 1.0), Variation(*2 * [replace(first, separated=False)], 1.0)):
        assert _throughout(same) is same


def test_energy_that_is_lost_may_belong_to_any_term_that_there_is() -> None:
    """Of an account that misses 0.25 J, whichever term they are missing from lies within its bar."""
    lost = {"contact": 0.05, "numerical": -0.1, "residual": 0.1}
    account = {"in": 3.0, "out": 2.0, "stored": 0.0, "viscous": 1.0} | lost
    nothing: Any = None
    found = Budget(replace(TRUTH, energy=account), nothing, dict.fromkeys(CAUSES, ()), nothing, nothing)
    bars = dict(found.energy_errors)
    assert bars.pop("in") == bars.pop("out") == 0.0, "they are known from the motion alone"
    assert bars.pop("stored") == 0.0, "nothing is stored where there is nothing that stores"
    assert bars == pytest.approx(dict.fromkeys(("viscous", "contact", "numerical"), 0.25)), "what is left over has none"


@pytest.mark.parametrize("gravity", [0.0, 5.0])
@pytest.mark.parametrize("separated", [True, False])
def test_what_a_weight_has_done_by_the_end_is_known_as_well_as_the_end(gravity: float, separated: bool) -> None:
    """Settings that part early and late, at one speed, and agree on all work but by chance."""
    nothing: Any = None
    strike = replace(STRIKE, gravity=gravity)
    first, late = (replace(TRUTH, strike=strike, separated=separated, duration=end) for end in (1.0, 1.02))
    moved = Variation(first, late, 1.0)
    found = Budget(first, nothing, {**dict.fromkeys(CAUSES, ()), "mesh": (moved,)}, nothing, nothing)
    lifted = strike.mass * gravity * abs(first.leaving_speed) * 0.02
    assert (found.energy_error("in") >= lifted) if separated else (found.energy_error("in") == 0.0)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_lines_between_the_rows_of_a_history_err_by_little_of_the_tolerance(
    settings: Numerics, tolerance: float
) -> None:
    nothing: Any = None
    found = Budget(TRUTH, nothing, dict.fromkeys(CAUSES, ()), nothing, nothing)
    history = replace(found, numerics=settings.varied(tolerance=tolerance)).history()
    times = np.linspace(0.0, 1.0, 20001)
    off = np.abs(np.interp(times, history.time, history.force) - TRUTH.force(times))
    assert off.max() < 0.2 * tolerance * history.force.max()


@pytest.mark.parametrize("failing", [1, 2, 4])
def test_where_finer_steps_fail_other_settings_are_told_by_no_fewer_than_were_asked_for(
    settings: Numerics, failing: int
) -> None:
    few = settings.varied(steps=16)
    finest = few.steps * failing
    found = _time_steps(lambda one: TRUTH if one.steps <= finest else None, few, False)
    assert (None in found.changes) == (failing < 4), "then nothing is known of the steps"
    assert few.steps <= found.cheap <= finest, "with those that fail nothing would be known of any setting"


@pytest.mark.parametrize("steps", [STEPS_AT_DEFAULT, 4 * STENCIL - 4])
def test_usual_steps_are_halved_twice_and_fewer_than_tell_a_polynomial_are_doubled_twice(
    steps: int, settings: Numerics
) -> None:
    """A quarter of the steps that are usual costs little; what is quartered has the rows of a polynomial at least."""
    asked = list[int]()

    def run(one: Numerics) -> Curve:
        asked.append(one.steps)
        return made_up(one.steps, np.zeros_like)

    found = _time_steps(run, settings.varied(steps=steps), False)
    times = (1.0, 0.5, 0.25) if steps >= 4 * STENCIL else (1.0, 2.0, 4.0)
    assert asked == [steps * one for one in times]
    assert found.cheap == asked[-1], "other settings are told by the march that is at hand"


def test_steps_as_long_as_a_relaxation_under_a_flat_end_leave_the_finest_run_and_two_and_a_half_times_its_change(
    settings: Numerics,
) -> None:
    """No order shows: the finer of two runs errs by less than twice their distance. Other settings take few steps."""
    strike = replace(STRIKE, relaxation=Relaxation(1.0, (1.0,), (1.0 / STEPS,)))
    runs = dict[int, Curve]()

    def run(one: Numerics) -> Curve:
        made = made_up(one.steps, lambda s: 1e-3 * s * STEPS / one.steps)
        return runs.setdefault(one.steps, replace(made, strike=strike))

    found = _time_steps(run, settings, True)
    (change,), (jitter,) = found.changes, found.jitter
    assert isinstance(change, Variation)
    assert found.value is change.first is jitter.first is runs[STEPS]
    assert change.second is runs[STEPS // 2]
    assert (change.factor, jitter.factor) == (2.5, 1.0)
    assert found.cheap == STEPS // 4 in runs
    assert found.jitter_falls


@pytest.mark.parametrize("failing", [2, 4])
def test_where_fewer_steps_fail_nothing_is_known_of_them(settings: Numerics, failing: int) -> None:
    found = _time_steps(lambda one: TRUTH if one.steps != STEPS // failing else None, settings, False)
    assert found.changes == (None,)
    assert found.value is TRUTH


def test_a_path_that_errs_where_it_ends_moves_the_end_by_the_time_in_which_it_is_covered() -> None:
    """Two contacts that end at one time by chance, the striker of one a tenth of a millimetre behind."""
    behind = replace(TRUTH, depth=TRUTH.depth + 1e-4 * TRUTH.x**2)
    change = Variation(TRUTH, behind, 2.0)
    assert change.errors["duration"] == pytest.approx(2.0 * 1e-4 / abs(TRUTH.leaving_speed), rel=1e-3)


def test_a_branch_is_about_as_fast_as_a_step_where_what_it_loses_in_one_is_no_power_of_the_step() -> None:
    """Of a stress held for a step, as x = step over relaxation time: 1 - (1 - e^-x)/x, x/2 at first and 1 at last.

    Where its slope over logarithms is by more than an eighth from both, steps in the ratio 1 : 2 : 4 show no order.
    """
    logarithm = np.linspace(np.log(1e-2), np.log(1e3), 20001)
    x = np.exp(logarithm)
    slope = np.gradient(np.log(1.0 + np.expm1(-x) / x), logarithm)
    between = x[(slope < 7.0 / 8.0) & (slope > 1.0 / 8.0)]
    assert (between.min(), between.max()) == pytest.approx(ABOUT_A_STEP, rel=0.02)
