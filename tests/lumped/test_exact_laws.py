"""Two independent exact answers agree: Ting's integrals by collocation, and a row of springs by its own march."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal, localcontext
from functools import reduce
from itertools import pairwise
from types import ModuleType, SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from lumped import Result, Scene, laws, simulate
from lumped.laws import _assembly, _hereditary
from lumped.laws._assembly import Answer
from lumped.materials import Relaxation
from lumped.result.history import End
from lumped.scene.tables import Motion
from lumped.shapes.cone import Cone
from lumped.shapes.power import PowerProfile
from lumped.shapes.sphere import Sphere
from lumped.solvers.hereditary.approach import approach
from lumped.solvers.hereditary.closing import close
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.pieces import DEPTH, FORCE, alone
from lumped.solvers.mdr import march
from lumped.solvers.mdr.nest import (
    REST,
    Adaptive,
    Grid,
    Nest,
    Prescribed,
    coarse,
    coarse_beyond,
    limit,
    pace_of,
    predicted_turn,
    problem_of,
    shrinks_until,
)
from lumped.solvers.mdr.row import (
    SERIES_BELOW,
    Instant,
    Springs,
    fading,
    fadings,
    followed,
    followed_bend,
    left,
    none,
    stretched,
    yielding,
)

Array = NDArray[np.float64]

CASES: dict[str, dict[str, Any]] = {
    "elastic": {},
    "parabola": {"profile": "parabola", "moduli": (0.5,), "times": (0.3,)},
    "sls": {"relaxed": 0.5, "moduli": (0.5,), "times": (1.0,)},
    "fast sls": {"relaxed": 0.09, "moduli": (0.91,), "times": (0.01,)},
    "slow sls": {"relaxed": 0.09, "moduli": (0.91,), "times": (10.0,)},
    "three terms": {"relaxed": 0.2, "moduli": (0.3, 0.3, 0.2), "times": (0.05, 0.5, 5.0)},
    "kelvin-voigt": {"viscosity": 0.1},
    "stiff kelvin-voigt": {"viscosity": 10.0},
    "maxwell": {"relaxed": 0.0, "moduli": (1.0,), "times": (0.5,)},
    "all at once": {
        "relaxed": 0.3,
        "moduli": (0.7,),
        "times": (0.4,),
        "viscosity": 0.05,
        "gravity": 9.81,
        "velocity": 1.0,
    },
    "constant bulk": {"relaxed": 0.3, "moduli": (0.7,), "times": (0.4,), "constant": "bulk", "nu": 0.2},
    "deep": {"relaxed": 0.5, "moduli": (0.5,), "times": (1.0,), "velocity": 1.5},
}


def both(scene: Scene, tolerance: float = 1e-6) -> tuple[Result, Result]:
    return simulate(laws.ting.of(scene), scene, tolerance), simulate(laws.mdr.of(scene), scene, tolerance)


def agree(exact: Result, row: Result, tolerance: float = 1e-6) -> None:
    assert exact.converged
    assert row.converged
    assert exact.separated == row.separated
    for name in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        one, other = exact.quantities[name], row.quantities[name]
        if one.value is None or other.value is None:
            assert one.value == other.value
            continue
        apart = abs(one.value - other.value)
        assert apart <= tolerance * (1.0 if name == "restitution" else abs(one.value)), name
        assert apart <= (one.error or 0.0) + (other.error or 0.0), f"{name}: the bars do not cover the difference"
    times = np.union1d(exact.history.time, row.history.time)
    force = exact.history.force_at(times)
    apart = np.sqrt(np.trapezoid((row.history.force_at(times) - force) ** 2, times))
    assert apart <= 1.5 * tolerance * np.sqrt(np.trapezoid(force**2, times))


@pytest.mark.family
@pytest.mark.parametrize("case", CASES)
def test_ting_and_the_spring_row_agree(case: str, impact: Callable[..., Scene]) -> None:
    agree(*both(impact(**CASES[case])))


def test_ting_and_the_spring_row_agree_on_random_impacts(
    impact: Callable[..., Scene], campaign_size: Callable[[int], int]
) -> None:
    random = np.random.default_rng(20161)
    for _ in range(campaign_size(60)):
        terms = int(random.integers(0, 4))
        moduli, times = random.uniform(0.1, 3.0, terms), 10.0 ** random.uniform(-2.0, 1.0, terms)
        scene = impact(
            1.0,
            tuple(moduli.tolist()),
            tuple(times.tolist()),
            0.0 if terms else float(10.0 ** random.uniform(-2.0, 1.0)),
            nu=float(random.uniform(-0.5, 0.4999)),
            constant=str(random.choice(["poisson", "bulk"])),
            velocity=float(10.0 ** random.uniform(-3.0, 0.0)),
        )
        agree(*both(scene))


@pytest.mark.parametrize("case", ["sls", "fast sls", "kelvin-voigt"])
def test_contact_radius_of_both_agrees(case: str, impact: Callable[..., Scene]) -> None:
    exact, row = both(impact(**CASES[case]))
    times = np.linspace(0.0, 0.98 * (exact.quantities["duration"].value or 0.0), 200)
    one, other = exact.history.resampled(times).contact_radius, row.history.resampled(times).contact_radius
    assert np.abs(one - other).max() < 1e-4 * one.max()


@pytest.mark.parametrize("case", ["sls", "three terms", "kelvin-voigt", "maxwell"])
def test_spring_row_errs_by_even_powers_of_its_steps(case: str, impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES[case])
    problem = problem_of(scene)
    track = coarse(problem, scene.end_time, 16)
    nest = Nest(problem, scene.end_time, Grid(np.linspace(0.0, 1.0, 17)))
    levels, before = [nest.level(1, track.approach[-1].time)], track.approach[-1].time
    for parts in (2, 4, 8):
        turn, before = predicted_turn(before, levels[-1].turn), levels[-1].turn
        levels.append(nest.level(parts, turn))
    for order, near in ((2, 0.05), (4, 0.7)):
        for values in ([level.last for level in levels], [level.rebound[2, -1] for level in levels]):
            differences = np.abs(np.diff(values))
            rates = np.log2(differences[:-1] / differences[1:])
            assert np.all(np.abs(rates - order) < near), f"limits err as h^{order}"
        levels = [limit(one, finer, order) for one, finer in pairwise(levels)]


@pytest.mark.family
@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize("case", ["three terms", "kelvin-voigt", "constant bulk"])
def test_bars_cover_the_error_at_every_tolerance(
    law: str, case: str, impact: Callable[..., Scene], uncovered: Callable[..., dict[str, float]]
) -> None:
    scene = impact(**CASES[case])
    model = laws.get(law).of(scene)
    truth = simulate(model, scene, 1e-8)
    for tolerance in (1e-3, 1e-5):
        result = simulate(model, scene, tolerance)
        assert not uncovered(result, truth)


@pytest.mark.tenth
def test_bars_of_the_spring_row_cover_an_end_just_before_a_second_approach(
    impact: Callable[..., Scene], uncovered: Callable[..., dict[str, float]]
) -> None:
    """The edge hardly moves there: the last step is long, and cut."""
    scene = impact(0.2, (0.8,), (0.1,), gravity=9.81, velocity=0.03)
    history = simulate(laws.ting.of(scene), scene, 1e-6).history
    turn, second = float(history.time[history.depth.argmax()]), float(history.time[-1])
    for share in (0.95, 0.98, 0.99):
        ended = replace(scene, motion=Motion(end_time=turn + share * (second - turn)))
        truth = simulate(laws.ting.of(ended), ended, 1e-8)
        for tolerance in (1e-3, 1e-4):
            assert not uncovered(simulate(laws.mdr.of(ended), ended, tolerance), truth)


def test_work_grows_gently_with_the_tolerance(impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES["sls"])
    steps = [simulate(laws.mdr.of(scene), scene, tol).work["steps"] for tol in (1e-4, 1e-6)]
    assert steps[0] < 1200
    assert steps[1] < 3000
    for law, most in ((laws.ting, 260), (laws.correspondence, 220)):
        calls = [simulate(law.of(scene), scene, tol).work["force_evaluations"] for tol in (1e-4, 1e-6)]
        assert max(calls) < most


@pytest.mark.family
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
@pytest.mark.parametrize("case", [*CASES, "with gravity", "second approach", "at end_time"])
def test_energy_of_the_spring_row_closes_term_by_term(
    case: str, tolerance: float, impact: Callable[..., Scene]
) -> None:
    more: dict[str, dict[str, Any]] = {
        "with gravity": {"relaxed": 0.3, "moduli": (0.7,), "times": (0.4,), "gravity": 9.81, "velocity": 1.0},
        "second approach": {"relaxed": 0.2, "moduli": (0.8,), "times": (0.1,), "gravity": 9.81},
        "at end_time": {"relaxed": 0.5, "moduli": (0.5,), "times": (1.0,), "end_time": 0.6},
    }
    closes(impact(**{**CASES, **more}[case]), tolerance)


def closes(scene: Scene, tolerance: float) -> None:
    """Every term is a sum of its own over steps and springs: nothing is left, whatever the steps err by."""
    result = simulate(laws.mdr.of(scene), scene, tolerance)
    energy = {name: value or 0.0 for name, value in result.energy.items()}
    assert abs(energy["residual"]) <= 1e-8 * energy["in"], scene
    assert energy["viscous"] >= -tolerance * energy["in"]
    assert energy["stored"] >= -tolerance * energy["in"]
    e = result.quantities["restitution"].value
    if e is not None and scene.gravity == 0.0:
        assert energy["out"] == pytest.approx(e**2 * energy["in"], rel=1e-3, abs=tolerance * energy["in"])
    if scene.contact_modulus.is_elastic:
        assert energy["viscous"] == 0.0


def test_energy_of_the_spring_row_closes_for_any_material(
    impact: Callable[..., Scene], campaign_size: Callable[[int], int]
) -> None:
    random = np.random.default_rng(2016)
    for _ in range(campaign_size(100)):
        terms = int(random.integers(0, 4))
        relaxed = float(random.choice([0.0, 1.0])) if terms else 1.0
        moduli, times = 10.0 ** random.uniform(-2.0, 4.0, terms), 10.0 ** random.uniform(-4.0, 2.0, terms)
        viscosity = float(10.0 ** random.uniform(-3.0, 1.0)) if not terms or random.random() < 0.3 else 0.0
        exponent = float(random.uniform(1.0, 6.0))
        shape = PowerProfile(0.006 ** (1.0 - exponent), exponent) if random.random() < 0.3 else None
        scene = impact(relaxed, tuple(moduli.tolist()), tuple(times.tolist()), viscosity, shape=shape)
        closes(scene, float(10.0 ** random.uniform(-5.0, -2.0)))


def test_energy_locked_in_at_separation_is_that_of_a_direct_sum(impact: Callable[..., Scene]) -> None:
    """Kelvin-Voigt at the turn of a spring: E_inf (depth - g)^2/2 is what a spring holds when eta |rate| lets it go."""
    scene = impact(viscosity=0.1, profile="parabola")
    result = simulate(laws.mdr.of(scene), scene, 1e-7)
    history, modulus = result.history, scene.contact_modulus
    outward = history.time >= history.time[history.depth.argmax()]
    edge, rate = history.contact_radius[outward], history.velocity[outward]
    # At the edge E_inf (depth - g) + eta rate = 0: the energy there per length follows from the rate alone.
    density = (modulus.viscosity * rate) ** 2 / (2.0 * modulus.equilibrium)
    assert result.energy["stored"] == pytest.approx(-2.0 * np.trapezoid(density, edge), rel=1e-4)
    pressed = modulus.viscosity * history.velocity**2 * 2.0 * history.contact_radius
    assert result.energy["viscous"] == pytest.approx(np.trapezoid(pressed, history.time), rel=1e-4)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_springs_that_leave_at_one_time_but_for_rounding(tolerance: float, impact: Callable[..., Scene]) -> None:
    """A fluid from which the striker is pulled forgets its approach: all springs within carry the same."""
    cone = Cone(13.0)
    scene = impact(0.0, (517.0,), (1.85e-5,), gravity=-1.0, velocity=7.1e-4, shape=cone)
    row, exact = simulate(laws.mdr.of(scene), scene, tolerance), simulate(laws.ting.of(scene), scene, 1e-7)
    assert row.converged
    for name in ("peak_force", "peak_depth", "duration"):
        assert row.quantities[name].value == pytest.approx(exact.quantities[name].value, rel=tolerance)
    closes(scene, tolerance)


@pytest.mark.tenth
def test_a_solid_damped_a_million_times_too_much_is_no_crash() -> None:
    """Rows of the row's rebound lie so near to each other that the root of the time left does not tell them apart."""
    material = {"law": "kelvin_voigt", "E": 2539808694.4017277, "eta": 551145149801.6862, "nu": -0.22848906917747086}
    striker = {"shape": "power", "coefficient": 0.8865284314772984, "exponent": 5.005565559648419}
    motion = {"mass": 2.6558002194930284, "velocity": 2.561505671775805}
    scene = Scene.from_dict({"striker": striker | motion, "target": {"shape": "half_space", "material": material}})
    result = simulate(laws.mdr.of(scene), scene, 1e-4)
    assert np.isfinite(result.history.force).all()
    assert result.converged or "not reached" in result.message
    assert result.quantities["restitution"].value == pytest.approx(0.0, abs=1e-6)


def test_a_law_that_cannot_go_on_says_so(impact: Callable[..., Scene]) -> None:
    scene = impact(0.2, (0.8,), (0.1,), gravity=9.81)
    for result in both(scene, 1e-4):
        assert not result.converged
        assert not result.separated
        assert End.SECOND_APPROACH.value in result.message
        assert result.quantities["duration"].value is None


@pytest.mark.parametrize("gravity", [3.0, 9.81, 40.0])
def test_the_spring_row_ends_before_its_edge_turns(gravity: float, impact: Callable[..., Scene]) -> None:
    """Springs that are left behind and met again carry another force than it would give them."""
    for exact, row in (both(impact(0.2, (0.8,), (0.1,), gravity=gravity, velocity=v), 1e-4) for v in (0.01, 0.03)):
        assert End.SECOND_APPROACH.value in exact.message
        assert row.history.time[-1] <= exact.history.time[-1]
        off = np.abs(exact.history.force_at(row.history.time) - row.history.force)
        assert np.all(off <= row.history.force_error + 1e-4 * row.history.force.max())


def test_bars_never_rest_on_one_chance_agreement() -> None:
    from lumped.laws._assembly import bars

    class Shifted(NamedTuple):
        shift: float

        def __call__(self, times: Array) -> Array:
            return np.array([times, times, self.force(times), times])

        def force(self, times: Array) -> Array:
            return np.asarray(np.sin(np.pi * times) + self.shift * times)

    def answer(shift: float) -> Answer:
        values = dict.fromkeys(["peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse"], 1.0)
        return Answer(np.linspace(0.0, 1.0, 101), Shifted(shift), values, End.SEPARATED)

    quantities, _ = bars(answer(0.0), answer(1e-3), 1.5)
    assert quantities["peak_depth"].error == pytest.approx(0.1 * (quantities["history_l2"].error or 0.0), rel=1e-6)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize("case", ["elastic", "three terms", "kelvin-voigt", "all at once"])
def test_the_first_row_is_the_touch(law: str, case: str, impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES[case])
    history = simulate(laws.get(law).of(scene), scene, 1e-3).history
    assert (history.time[0], history.depth[0], history.velocity[0]) == (0.0, 0.0, scene.velocity)


@pytest.mark.family
@pytest.mark.parametrize("law", [laws.ting, laws.correspondence], ids=["ting", "correspondence"])
@pytest.mark.parametrize("case", ["sls", "slow sls", "three terms", "kelvin-voigt", "all at once", "deep"])
def test_the_bars_cover_the_poorer_of_the_two_integrations_too(
    law: ModuleType, case: str, impact: Callable[..., Scene]
) -> None:
    """At a corner more nodes are no better than few: what is told with more has the bar of both."""
    scene = impact(**CASES[case])
    found, truth = simulate(law.of(scene), scene, 1e-3), simulate(law.of(scene), scene, 1e-10)
    problem = _hereditary.problem_of(scene)
    settings = _hereditary.Settings(found.numerics["rtol"], _hereditary.FEW)
    poorer = _hereditary.answer_of(
        scene, problem, alone(law.solve(problem, scene.end_time / scene.elastic_contact_time, settings))
    )
    for name, value in poorer.values.items():
        bar, true = found.quantities[name].error, truth.quantities[name].value
        assert (value is None) == (true is None)
        if value is not None and true is not None and bar is not None:
            assert abs(value - true) <= bar, name
    times = found.history.time
    off = np.abs(poorer.columns.force(times) - found.history.force).max()
    assert off <= found.history.force_error.max()


@pytest.mark.parametrize(("steps", "near"), [(-1.0, True), (0.01, True), (1.0, True), (3.0, False), (5.0, False)])
def test_a_march_that_would_end_within_a_step_of_its_turn_goes_on_beyond_both(
    steps: float, near: bool, impact: Callable[..., Scene]
) -> None:
    """By some steps, so that finer ones, which turn elsewhere, all rebound; else it ends where it is told."""
    problem = problem_of(impact(0.5, (0.5,), (1.0,)))
    *_, before, last, turn = (instant.time for instant in coarse(problem, 1.0, 16).approach)
    end = turn + steps * (last - before)
    track, beyond = coarse_beyond(problem, end, 16)
    assert track.end is End.TIME
    assert (track.rebound or track.approach)[-1].time == pytest.approx(beyond)
    assert beyond == end or near
    assert not near or 1.0 < (beyond - max(end, turn)) / (last - before) < 5.0


def test_steps_at_given_instants_end_there_and_the_last_one_a_step_beyond() -> None:
    """So that the event which cuts it lies within a step as long as the others."""
    steps, now = Prescribed([1.0, 2.5, 4.0]), [0.0]
    for _ in range(3):
        at: Any = SimpleNamespace(time=now[-1])
        now.append(now[-1] + steps.propose(at))
        assert steps.accepts(at, at)
    assert now[1:3] == [1.0, 2.5]
    assert 4.0 < now[3] < 4.0 + 2.0 * 1.5


@pytest.mark.parametrize("law", ["mdr", "ting", "correspondence", "hertz"])
def test_the_force_alone_is_that_of_all_columns(
    law: str, impact: Callable[..., Scene], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the touch, after it, and when the contact is over, where nothing presses."""
    asked = list[Any]()

    def densified(rows: Array, force: Any, *rest: Any) -> Array:
        asked.append(force.__self__)
        return np.asarray(_assembly_densified(rows, force, *rest))

    _assembly_densified = _assembly.densified
    monkeypatch.setattr(_assembly, "densified", densified)
    found = simulate(getattr(laws, law).of(scene := impact(**CASES["sls"])), scene, 1e-4)
    times = np.linspace(0.0, found.history.time[-1], 97)
    (columns,) = asked
    assert columns.force(times) == pytest.approx(columns(times)[2], abs=1e-12 * found.history.force.max())
    assert columns.force(times)[[0, -1]] == pytest.approx(0.0, abs=1e-6 * found.history.force.max())


@pytest.mark.parametrize("ratio", [*np.geomspace(1e-6, 200.0, 17), np.nextafter(SERIES_BELOW, 0.0), SERIES_BELOW])
def test_a_fading_branch_is_integrated_however_long_the_step(ratio: float) -> None:
    """By Gauss' rule over the time left, u, of a step of `ratio` relaxation times: series and closed form alike."""
    tau, (places, weights) = 0.3, np.polynomial.legendre.leggauss(200)
    h = ratio * tau
    u, du = 0.5 * h * (places + 1.0), 0.5 * h * weights
    e = np.exp(-u / tau)
    integrals = (du @ e, du @ (e * (h - u)), du @ (e * (h - u) ** 2) / h, tau * (du @ np.expm1(-u / tau) ** 2))
    assert fading(tau, h) == pytest.approx((math.exp(-ratio), *integrals), rel=1e-12, abs=0.0)


@pytest.mark.parametrize("ratio", [1e-3, 0.06, 0.2, 0.35, np.nextafter(SERIES_BELOW, 0.0), SERIES_BELOW, 2.0])
def test_a_fading_branch_loses_no_digits_between_its_series_and_its_closed_form(ratio: float) -> None:
    """By the closed form in 60 digits, of which those that cancel are not missed."""
    with localcontext() as digits:
        digits.prec = 60
        x, tau = Decimal(ratio), Decimal("0.5")
        gone = 1 - (-x).exp()
        grown = x - gone
        bent, spilled = x - 2 * grown / x, grown - gone * gone / 2
        exact = [float(one) for one in (1 - gone, tau * gone, *(tau * tau * one for one in (grown, bent, spilled)))]
    assert fading(0.5, 0.5 * ratio) == pytest.approx(exact, rel=5e-15, abs=0.0)


def test_springs_together_are_the_sum_of_each_alone() -> None:
    """Of four springs: E_inf (depth - g) + eta rate + sum z_k each, z_k' = E_k rate - z_k/tau_k, z_k = Z_k - c_k."""
    modulus, rng = Relaxation(1.3, (3.0, 0.7), (0.2, 5.0), viscosity=0.4), np.random.default_rng(7)
    stiff, tau = (np.array(one)[:, None] for one in (modulus.moduli, modulus.times))
    width, rest, lacks = rng.uniform(0.1, 1.0, 4), rng.uniform(0.0, 0.5, 4), rng.normal(size=(2, 4))
    singles = [Springs.one(*one[:2], list(one[2:])) for one in np.vstack([width, rest, lacks]).T.tolist()]
    together = reduce(Springs.plus, singles)
    lifted = together.plus(singles[1], -1.0)
    for mine, its in zip(lifted, reduce(Springs.plus, [singles[0], *singles[2:]]), strict=True):
        assert mine == pytest.approx(its, rel=1e-12)
    assert none(modulus) == Springs(0.0, 0.0, 0.0, [0.0, 0.0], [0.0, 0.0])
    depth, rate, h, axis = 0.9, -0.6, 0.35, rng.normal(size=2)
    z, faded = axis[:, None] - lacks, fadings(modulus, h)
    force = together.force(modulus, depth, rate, axis.tolist(), together.kept)
    assert force == pytest.approx(width @ (1.3 * (depth - rest) + 0.4 * rate + z.sum(axis=0)), rel=1e-12)
    held = 0.5 * width @ (1.3 * (depth - rest) ** 2 + (z**2 / stiff).sum(axis=0))
    assert together.held(modulus, depth, axis.tolist()) == pytest.approx(held, rel=1e-12)
    places, weights = np.polynomial.legendre.leggauss(30)
    time, weights = 0.5 * h * (places + 1.0)[:, None, None], 0.5 * h * weights
    resting = z * np.exp(-time / tau)
    moving = resting + stiff * tau * rate * -np.expm1(-time / tau)
    impulse = weights @ (1.3 * (depth - rest) + resting.sum(axis=1)) @ width
    assert together.impulse(modulus, depth, axis.tolist(), faded, h) == pytest.approx(impulse, rel=1e-12)
    spent = weights @ (moving**2 / (stiff * tau)).sum(axis=1) @ width + 0.4 * rate**2 * width.sum() * h
    assert together.spent(modulus, axis.tolist(), faded, h, rate) == pytest.approx(spent, rel=1e-12)
    risen = weights @ (1.3 * rate * time[:, 0, 0] + 0.4 * rate + (moving - resting)[..., 0].sum(axis=1))
    assert rate * yielding(modulus, faded, h) == pytest.approx(risen, rel=1e-12)
    left_over = together.aged([0.25, 0.5])
    assert left_over.kept == pytest.approx([0.25 * width @ lacks[0], 0.5 * width @ lacks[1]], rel=1e-12)
    squares = [0.0625 * width @ lacks[0] ** 2, 0.25 * width @ lacks[1] ** 2]
    assert left_over.kept_square == pytest.approx(squares, rel=1e-12)
    assert left_over[:3] == together[:3]


def test_memories_follow_lines_and_parabolas_as_their_integral_says() -> None:
    """z' = E q - z/tau over a time, of two branches, by Gauss's rule for the integral of E q exp(-u/tau)."""
    modulus, memory = Relaxation(1.0, (3.0, 0.7), (0.2, 5.0)), [0.4, -1.1]
    begin, mean, end, h = 0.3, 1.7, 0.9, 0.6
    share, weights = np.polynomial.legendre.leggauss(30)
    share, weights = 0.5 * (share + 1.0), 0.5 * h * weights
    # through the ends, with the mean that is left once the line has its own
    parabola = begin + (end - begin) * share + 6.0 * (mean - 0.5 * (begin + end)) * share * (1.0 - share)
    faded = fadings(modulus, h)

    def exact(q: Array) -> list[float]:
        pairs = zip(modulus.moduli, modulus.times, memory, strict=True)
        return [z * math.exp(-h / t) + e * float(weights @ (q * np.exp((share - 1.0) * h / t))) for e, t, z in pairs]

    line = begin + (end - begin) * share
    assert followed(modulus, memory, faded, begin, end, h) == pytest.approx(exact(line), rel=1e-12)
    assert followed_bend(modulus, memory, faded, begin, mean, end, h) == pytest.approx(exact(parabola), rel=1e-12)
    assert stretched(modulus, memory, faded, 2.5) == pytest.approx(exact(np.full(30, 2.5)), rel=1e-12)
    assert left(modulus, h) == pytest.approx([math.exp(-3.0), math.exp(-0.12)], rel=1e-14)


@given(st.integers(0, 2**32 - 1))
def test_a_step_of_the_row_errs_by_what_the_trapezoidal_rule_makes_of_a_parabola(seed: int) -> None:
    """Of three unequal steps, over the tolerance: the velocity by the rule against its exact integral."""
    rng = np.random.default_rng(seed)
    pace = Adaptive(first=1.0, elements=int(rng.integers(8, 200)), reach=1.0, velocity=1.0)
    bend = np.polynomial.Polynomial(rng.normal(size=3))
    speed, times = bend.integ(k=float(rng.normal())), np.cumsum(rng.uniform(0.02, 1.0, 3))
    before, now, then = (Instant(time, 0.0, float(speed(time)), float(bend(time)), 0.0, 0.0) for time in times)
    by_rule = now.velocity + 0.5 * (then.time - now.time) * (now.acceleration + then.acceleration)
    largest = max(abs(now.velocity), abs(then.velocity), REST)
    wrong = abs(by_rule - then.velocity) / largest
    assert pace.error(before, now, then) * pace.tolerance == pytest.approx(wrong, rel=1e-6, abs=1e-12)
    assert pace.error(before, now, now) == 0.0, "no step"
    assert pace.error(now, now, then) == 0.0, "nothing is known of the bend"


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_steps_near_the_turn_are_judged_by_the_speed_at_touch(unit: float) -> None:
    """The same in any unit of length: where the velocity is zero its errors count by a share of that at touch."""
    pace = Adaptive(first=1.0, elements=50, reach=1.0, velocity=unit)
    at_rest = [Instant(float(time), 0.0, 0.0, unit * time**2, 0.0, 0.0) for time in (0.0, 1.0, 2.0)]
    assert pace.error(*at_rest) * pace.tolerance == pytest.approx(1.0 / 6.0 / REST)


@pytest.mark.parametrize("name", ["polymer-sphere", "polymer-cone", "rod-in-ring"])
def test_the_end_of_a_contact_is_told_with_how_steeply_its_force_falls_there(name: str) -> None:
    """With the load, as a power of the depth: by the path itself, a little before."""
    problem, settings = _hereditary.problem_of(Scene.load(name)), Settings(1e-10, 12)
    inward = alone(approach(problem, 100.0, settings))
    closing = alone(close(problem, inward, 100.0, settings))
    assert closing.last is not None
    begin = float(closing.last.breaks[0])
    first, before, last = (closing.last.state(share * begin) for share in (1.0, 0.03, 0.0))
    load, slope = (float(value[0]) for value in problem.loads(first[:1]))
    power = slope * float(first[DEPTH]) / load
    steep = (before[FORCE] - last[FORCE]) / (before[DEPTH] ** power - last[DEPTH] ** power)
    assert closing.steep == pytest.approx(steep, rel=2e-3)
    assert last[FORCE] == pytest.approx(0.0, abs=1e-12 * inward.largest)


@pytest.mark.parametrize("gravity", [20.0, 40.0])
def test_a_last_step_that_is_cut_is_doubted_where_the_force_at_its_edge_rises(
    gravity: float, impact: Callable[..., Scene]
) -> None:
    """There the edge turns before the striker does: it is told by many lengths of that step."""
    problem = problem_of(impact(0.2, (0.8,), (0.1,), gravity=gravity, velocity=0.01))
    inward = march.approach(problem, 1.0, pace_of(problem, 1.0, 16), 1000)

    def ended(time: float, doubted: bool) -> End:
        return march.rebound(replace(inward, row=inward.row.copy()), time, doubted).end

    row = inward.row.copy()
    last = march.rebound(replace(inward, row=row), 1.0).rebound[-1]
    shrinking, lengths = march.Shrinking(row, last), np.linspace(1e-5, 0.02, 2000)
    tried = [shrinking.attempt(float(length)) for length in lengths]
    turn = float(lengths[np.argmax([one.velocity > 0.0 for one in tried])])
    rise = float(lengths[np.argmin([one.pull for one in tried if one.h < turn])])
    assert rise < 0.8 * turn
    for time, doubtful, turned in (
        (0.5 * rise, False, False),
        (0.95 * rise, False, False),
        (1.25 * rise, True, False),
        (0.95 * turn, True, False),
        (1.05 * turn, True, True),
    ):
        assert shrinking.turns_before(last.time + time) is doubtful
        assert (ended(last.time + time, True) is End.SECOND_APPROACH) is doubtful
        assert (ended(last.time + time, False) is End.SECOND_APPROACH) is turned


@pytest.mark.parametrize(("gravity", "velocity"), [(3.0, 0.01), (9.81, 0.03), (40.0, 0.01)])
def test_an_edge_is_followed_until_no_march_however_fine_sees_it_turn(
    gravity: float, velocity: float, impact: Callable[..., Scene]
) -> None:
    """And for two fifths of its way back at least; not at all where it turns at once, or never."""
    scene = impact(0.2, (0.8,), (0.1,), gravity=gravity, velocity=velocity)
    problem = problem_of(scene)
    until = shrinks_until(problem, scene.end_time, 16)
    assert until is not None
    assert {coarse(problem, until, elements).end for elements in (16, 24, 32, 48, 64, 96)} == {End.TIME}
    turn = coarse(problem, until, 64).approach[-1].time
    end = simulate(laws.ting.of(scene), scene, 1e-5).history.time[-1]
    assert turn + 0.4 * (end - turn) < until < end
    assert shrinks_until(problem, turn, 16) is None
    assert shrinks_until(replace(problem, gravity=0.0), scene.end_time, 16) is None
    assert shrinks_until(replace(problem, gravity=4000.0), scene.end_time, 16) == 0.0
    assert shrinks_until(replace(problem, gravity=0.05, velocity=1e-4), 1.0, 16) is not None


@pytest.mark.parametrize("power", [1.0, 1.5, 2.0, 3.0, 5.0])
def test_only_a_dashpot_under_what_is_neither_cone_nor_parabola_needs_another_start(
    power: float, impact: Callable[..., Scene]
) -> None:
    """Its force begins as the power 2/n of the root of time, which is whole for r^1 and r^2 alone of these."""
    shape = PowerProfile(1.0, power)
    assert _hereditary.problem_of(impact(1.0, viscosity=0.3, shape=shape)).rises_steeply == (power not in (1.0, 2.0))
    assert not _hereditary.problem_of(impact(1.0, (0.5,), (0.3,), shape=shape)).rises_steeply


@pytest.mark.parametrize("power", [3.0, 5.2, 20.0])
def test_an_approach_with_another_start_is_told_from_the_touch_on(power: float, impact: Callable[..., Scene]) -> None:
    """At the speed of touch, pressed by the dashpot, 2 a eta v, a ~ depth^(1/n), over so much of the time that hardly a
    force is left, or over fifty decades.
    """
    problem = _hereditary.problem_of(impact(1.0, viscosity=0.3, shape=PowerProfile(1.0, power)))
    path = alone(approach(problem, 1.0, Settings(1e-6))).path
    end = (1e-12 * problem.shortest) ** 0.5
    roots = end * np.geomspace(max(1e-6 ** (0.5 * power), 1e-50), 1.0, 50)
    depth, velocity, _, force = path.at(roots)
    assert path.breaks[0] == 0.0
    assert velocity == pytest.approx(1.0)
    assert depth == pytest.approx(roots**2)
    assert force == pytest.approx(force[-1] * (depth / depth[-1]) ** (1.0 / power), rel=1e-5)


def test_a_sphere_begins_as_the_parabola_that_it_is_at_its_tip(impact: Callable[..., Scene]) -> None:
    """Whatever it becomes at the depths of the impact."""
    problem = _hereditary.problem_of(impact(1.0, viscosity=0.3, shape=Sphere(1.0)))
    _, (near, far) = problem.loads(np.array([1.0, 4.0]))
    assert abs(np.log2(far / near) - 1.0) > 1e-4, "the slope of a load d^(3/2) goes as the root of d"
    assert not problem.rises_steeply
