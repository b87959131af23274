"""Error bars of force laws against closed forms: never below the error, and not far above it."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import beta

from lumped import Material, Model, Motion, Quantity, Relaxation, Scene, Sphere, laws, simulate
from lumped.indentation import FiniteSize, indent, power_law
from lumped.laws import _force_law, _hereditary
from lumped.laws._assembly import AROUND, BENDS, Answer, _largest_and_norm, _NearPeak, bars, impulse_of, values_of
from lumped.numbers import Array
from lumped.result.history import AT_REST, End
from lumped.result.result import UNITS, meets
from lumped.scene.indenter import Indenter
from lumped.scene.tables import LawChoice
from lumped.solvers.point import half_widths
from lumped.solvers.point.bodies import Bodies, Stage, State, Step
from lumped.solvers.point.contact import DEPTH_LEFT
from lumped.solvers.point.phase import PointMarch
from lumped.solvers.radau import NODES, STAGES

CASES = 600
# Where an error is rounding its size is an accident; the time of a flat peak is known to the root of rounding.
ROUNDING, ROUNDING_OF = 2e-15, {"peak_time": 1e-10}
# The bars may be this much too wide in the median.
WIDE = 100.0


def impact(rng: np.random.Generator, name: str, gravity: float = 0.0, **values: Any) -> Scene:
    values = {"k": 10.0 ** rng.uniform(3.0, 11.0), **values}
    mass, velocity = 10.0 ** rng.uniform(-3.0, 5.0), 10.0 ** rng.uniform(-2.0, 1.0)
    return Scene(None, mass, velocity, law=LawChoice(name, values), model=Model(gravity=gravity))


def spring(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """k depth^alpha: the depth by its energy, the duration by the beta function."""
    alpha = rng.choice([1.0, 1.5, 2.0, rng.uniform(1.0, 4.0)])
    scene = impact(rng, "hertz", alpha=float(alpha))
    k, power = scene.law.values["k"], alpha + 1.0
    depth = (0.5 * power * scene.mass / k * scene.velocity**2) ** (1.0 / power)
    duration = 2.0 * depth / scene.velocity * beta(1.0 / power, 0.5) / power
    return scene, {
        "peak_depth": depth,
        "peak_force": k * depth**alpha,
        "peak_time": 0.5 * duration,
        "duration": duration,
        "restitution": 1.0,
    }


def kelvin(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """The linear oscillator, to the return of its force or of its depth, "(5)" to "(7)"."""
    xi, exit = rng.uniform(0.01, 0.95), rng.choice(["force", "depth"])
    scene = impact(rng, "kelvin", xi=float(xi), exit=str(exit))
    omega, root = math.sqrt(scene.law.values["k"] / scene.mass), math.sqrt(1.0 - xi**2)
    turn = math.acos(xi) / (omega * root)
    end = 2.0 * turn if exit == "force" else math.pi / (omega * root)
    slower = math.exp(-xi * omega * end)
    return scene, {
        "peak_depth": scene.velocity / omega * math.exp(-xi * omega * turn),
        "duration": end,
        "restitution": slower,
        "impulse": scene.mass * scene.velocity * (1.0 + slower),
    }


def mahmoud(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """The oscillator until it turns, the spring alone from there."""
    xi = rng.uniform(0.01, 0.95)
    scene = impact(rng, "mahmoud", xi=float(xi))
    omega, root = math.sqrt(scene.law.values["k"] / scene.mass), math.sqrt(1.0 - xi**2)
    turn = math.acos(xi) / root
    return scene, {
        "peak_depth": scene.velocity / omega * math.exp(-xi * turn),
        "duration": (turn + 0.5 * math.pi) / omega,
        "restitution": math.exp(-xi * turn),
    }


def jankowski(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """At alpha = 3/2 a linear oscillator of ratio 2 xi/sqrt 5 in depth^(5/4): restitution exp(-ratio turn)."""
    xi = rng.uniform(0.05, 1.0)
    scene = impact(rng, "jankowski", xi=float(xi))
    ratio = 2.0 * xi / math.sqrt(5.0)
    slower = math.exp(-ratio * math.acos(ratio) / math.sqrt(1.0 - ratio**2))
    energy = 0.5 * scene.mass * (slower * scene.velocity) ** 2
    return scene, {"restitution": slower, "peak_depth": (2.5 * energy / scene.law.values["k"]) ** 0.4}


def hunt_crossley(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """ln((1 + d)/(1 - e d)) = d (1 + e); the depth from the same integral, until the turn."""
    d, alpha = rng.uniform(0.05, 4.0), rng.uniform(1.0, 3.0)
    scene = impact(rng, "hertzdamp", xi=float(d), alpha=float(alpha))

    def lack(e: float) -> float:
        return math.log1p(d) - math.log1p(-e * d) - d * (1.0 + e)

    slower = brentq(lack, 1e-9, min(1.0, 1.0 / d) * (1.0 - 1e-15), xtol=1e-16, rtol=1e-15)
    work = scene.mass * scene.velocity**2 * (d - math.log1p(d)) / d**2
    return scene, {
        "restitution": slower,
        "peak_depth": ((alpha + 1.0) * work / scene.law.values["k"]) ** (1.0 / (alpha + 1.0)),
    }


def weighed_spring(rng: np.random.Generator) -> tuple[Scene, dict[str, float]]:
    """The linear spring under gravity."""
    scene = impact(rng, "linear_spring", float(rng.uniform(0.1, 10.0)))
    return scene, swing_of(scene)


def swing_of(scene: Scene) -> dict[str, float]:
    """A linear spring swings about m g/k."""
    assert scene.law is not None
    k = scene.law.values["k"]
    omega, sunk = math.sqrt(k / scene.mass), scene.mass * scene.gravity / k
    swing = math.hypot(scene.velocity / omega, sunk)
    half = math.pi - math.atan2(scene.velocity / omega, sunk)
    return {
        "peak_depth": sunk + swing,
        "peak_force": k * (sunk + swing),
        "peak_time": half / omega,
        "duration": 2.0 * half / omega,
        "restitution": 1.0,
    }


CLOSED = (spring, kelvin, mahmoud, jankowski, hunt_crossley, weighed_spring)


def test_bars_cover_closed_forms_and_are_not_far_above(campaign_size: Callable[[int], int]) -> None:
    rng, wide = np.random.default_rng(20), defaultdict(list)
    for i in range(campaign_size(CASES)):
        scene, exact = CLOSED[i % len(CLOSED)](rng)
        assert scene.law is not None
        found = laws.get(scene.law.name).of(scene).simulate(scene, 10.0 ** rng.uniform(-7.0, -2.0)).quantities
        for name, value in exact.items():
            quantity = found[name]
            off = abs(quantity.value - value)
            assert off <= quantity.error, (scene.law, name, off, quantity.error)
            # an estimate to first order keeps room for what it does not see; rounding is no estimate
            if name != "peak_time" and quantity.error > 1e-12 * abs(value):
                assert 2.0 * off <= quantity.error, (scene.law, name, off, quantity.error)
            wide[name].append(quantity.error / max(off, ROUNDING_OF.get(name, ROUNDING) * abs(value)))
    for name, ratios in wide.items():
        assert float(np.median(ratios)) < WIDE, name


@pytest.mark.parametrize("damping", [0.0, 1e-13])
@pytest.mark.parametrize("alpha", [2.0, 2.5, 3.0])
def test_a_force_that_ends_flat_ends_within_its_bar(alpha: float, damping: float) -> None:
    """A damper so faint changes the end of a spring's contact by less than what the bar of one without would show."""
    rng = np.random.default_rng(22)
    for tolerance in (1e-3, 1e-5, 1e-6, 1e-7):
        scene, _ = spring(rng)
        assert scene.law is not None
        depth = (0.5 * (alpha + 1.0) * scene.mass * scene.velocity**2 / scene.law.values["k"]) ** (1.0 / (alpha + 1.0))
        ends = 2.0 * depth / scene.velocity * beta(1.0 / (alpha + 1.0), 0.5) / (alpha + 1.0)
        values = {"k": scene.law.values["k"], "alpha": alpha, "alpha_t": damping}
        faint = replace(scene, law=LawChoice("tsuji", values))
        duration = simulate(laws.get("tsuji").of(faint), faint, tolerance).quantities["duration"]
        changed = 100.0 * damping ** (2.0 / (alpha + 1.0)) * ends  # by the depth where spring and damper are equal
        assert abs(duration.value - ends) <= duration.error + changed, (tolerance, duration)


def test_what_a_coarse_march_lacks_is_known_to_first_order() -> None:
    """Far from rounding the bars of a spring are SAFETY times its errors, no less and no more."""
    rng, known = np.random.default_rng(25), defaultdict(list)
    for _ in range(12):
        scene, exact = spring(rng)
        found = _force_law._estimated(laws.hertz.of(scene), scene, 1e-3).quantities
        for name in ("peak_depth", "peak_force", "duration", "restitution"):
            off = abs(found[name].value - exact[name])
            if off > 1e-11 * exact[name]:
                known[name].append(found[name].error / off)
    assert len(known) == 4
    for name, ratios in known.items():
        assert ratios == pytest.approx([half_widths.SAFETY] * len(ratios), rel=0.1), name


def test_the_bar_of_a_force_is_that_of_its_largest_error() -> None:
    """Which may lie a little beside all places that are looked at."""
    scene, _ = spring(np.random.default_rng(25))
    coarse, fine = (_force_law._estimated(laws.hertz.of(scene), scene, steps) for steps in (1e-3, 1e-8))
    times = np.linspace(0.0, min(one.answer.times[-1] for one in (coarse, fine)), 1001)
    apart = np.abs(coarse.answer.columns.force(times) - fine.answer.columns.force(times)).max()
    assert 0.7 < coarse.force_error / (half_widths.SAFETY * apart) < 1.1


@pytest.mark.tenth
def test_a_force_that_ends_upright_is_known_to_its_end() -> None:
    """Below exponent one its slope over the depth is infinite there: a depth beyond it by rounding has none."""
    rng = np.random.default_rng(0)
    for _ in range(30):
        alpha = float(rng.uniform(0.5, 1.0))
        scene = impact(rng, "hertz", alpha=alpha)
        history = laws.hertz.of(scene).simulate(scene, 1e-3).history
        assert history.force_error.max() <= 1e-3 * history.force.max(), alpha


@pytest.mark.parametrize("alpha", [0.5, 1.5, 2.5])
def test_rows_lie_ever_more_densely_towards_both_ends_of_a_force_that_is_a_root_there(alpha: float) -> None:
    """Half as far away in the root in which it is smooth, down to rounding; and at the ends of all steps."""
    scene = impact(np.random.default_rng(8), "hertz", alpha=alpha)
    law = laws.hertz.of(scene)
    track = _force_law._track(law, scene, 1, 1e-5)
    power, end = law.grading(Stage(True, 0.0, scene.velocity)), track.times[-1]
    assert power > 1
    assert set(track.times) <= set(track.rows)
    near = track.rows[1:10]
    assert near[0] < 1e-25 * end
    assert near[1:] / near[:-1] == pytest.approx(2.0**power, rel=1e-9)
    left = end - track.rows  # of which rounding of the time leaves few digits
    assert 3 <= np.count_nonzero((left > 1e-12 * end) & (left < 1e-6 * end)) < 25


def test_slopes_at_the_nodes_of_a_step_are_those_of_polynomials() -> None:
    """The time of a peak errs by the slope of what the force lacks, over the curvature of the force."""
    x = half_widths.NODES.places
    for power in range(1, x.size):
        assert half_widths._slopes() @ x**power == pytest.approx(power * x ** (power - 1), abs=1e-10)


def test_a_force_that_lacks_a_share_of_itself_is_that_share_away_from_the_true_one() -> None:
    """Over all parts of a contact, whatever the unit of the force; nothing is no distance from nothing."""
    rng = np.random.default_rng(6)
    parts: list[Any] = []
    for steps in (3, 5):
        force = rng.uniform(1.0, 2.0, (steps, 4))
        part = SimpleNamespace(weights=rng.uniform(0.1, 1.0, (steps, 4)), force=force, lacking_force=-0.3 * force)
        parts.append(part)
    assert half_widths._l2(parts) == pytest.approx(0.3)
    parts[0].lacking_force[:] = 0.0
    squares = [float((part.weights * part.force**2).sum()) for part in parts]
    assert half_widths._l2(parts) ** 2 == pytest.approx(0.09 * squares[1] / sum(squares))
    for part in parts:
        part.force[:] = 0.0
    assert half_widths._l2(parts) == 0.0


@pytest.mark.parametrize("alpha", [0.5, 1.25, 1.5, 2.5])
def test_a_step_that_hardly_reaches_the_surface_ends_there_though_it_has_to_be_longer(alpha: float) -> None:
    """One step from the turn of a power law: graded towards its end it says of the same motion a little else."""
    law = laws.hertz.of(Scene(None, 1.0, 1.0, law=LawChoice("hertz", {"k": 1.0, "alpha": alpha})))
    turned, stage = State(1.0, 0.0, 0.0), Stage(False, 1.0, 1.0, 1.0)
    march = PointMarch(law, stage, Bodies(1.0, 1.0, 0.0), {"exit": DEPTH_LEFT}, math.inf, math.inf)

    def stepped(length: float) -> Step:
        found = march._solved(turned, length, np.zeros(STAGES), NODES)
        assert found is not None
        return found

    step = stepped(brentq(lambda length: stepped(length).end.depth, 1.0, 3.0) * (1.0 + 1e-12))
    found, event = march._until_event(step, 0.0)
    assert event == "exit"
    assert found is not None
    assert abs(found.end.depth) < 1e-14
    quarter = beta(1.0 / (alpha + 1.0), 0.5) / math.sqrt(2.0 * (alpha + 1.0))
    assert found.length == pytest.approx(quarter, rel=1e-4)


def test_an_end_is_known_to_1e_10_whatever_is_asked(campaign_size: Callable[[int], int]) -> None:
    rng = np.random.default_rng(21)
    for i in range(campaign_size(300)):
        scene, exact = CLOSED[i % len(CLOSED)](rng)
        assert scene.law is not None
        found = laws.get(scene.law.name).of(scene).simulate(scene, 1e-2).quantities
        # v dv = g dz: so much of the velocity is rounding of a depth to which a weight has pressed
        rounding = 1e-15 * scene.gravity * exact["peak_depth"] / scene.velocity**2
        assert abs(found["restitution"].value - exact["restitution"]) < 1e-10 + rounding
        if "duration" in exact:
            assert abs(found["duration"].value / exact["duration"] - 1.0) < 1e-10


def test_rounding_where_a_weight_presses_far_deeper_than_the_velocity() -> None:
    """It is rounding of the depth of the weight, large beside a velocity a thousand times slower than the swing.

    As large in any unit of time: where all is twenty times slower too.
    """
    rng = np.random.default_rng(77)
    for _ in range(8):
        scene, _ = weighed_spring(rng)
        swing = scene.gravity * math.sqrt(scene.mass / scene.law.values["k"])
        scene, bars_told = replace(scene, velocity=swing * 10.0 ** rng.uniform(-3.5, -2.0)), list[float]()
        weak = LawChoice("linear_spring", {"k": scene.law.values["k"] / 20.0**2})
        slow = replace(scene, velocity=scene.velocity / 20.0, law=weak, model=Model(gravity=scene.gravity / 20.0**2))
        for one in (scene, slow):
            found = laws.linear_spring.of(one).simulate(one, 1e-2).quantities
            for name, value in swing_of(one).items():
                assert abs(found[name].value - value) <= found[name].error, (name, one)
            bars_told.append(found["restitution"].error)
        assert bars_told[0] < 1e-6
        assert bars_told[1] == pytest.approx(bars_told[0], rel=0.2)


def test_what_creeps_to_rest_under_its_weight_is_said_to_rest() -> None:
    """Overdamped about its place of rest, it never turns: the force law alone carries the weight there."""
    rng = np.random.default_rng(22)
    for name in ("jankowski", "hertzdamp", "tsuji", "kelvin", "mahmoud"):
        scene = Scene(
            None, 200.0, float(rng.uniform(0.5, 1.5)), law=LawChoice(name, {"k": 2e4, "e": 0.15}),
            model=Model(gravity=float(rng.uniform(3.0, 9.0))),
        )  # fmt: skip
        law = laws.get(name).of(scene)
        result = law.simulate(scene, 1e-4)
        assert "rest" in result.message
        depth = (scene.mass * scene.gravity / law.k) ** (1.0 / law.alpha)
        assert abs(result.history.depth[-1] / depth - 1.0) < 1e-6
        assert abs(result.energy["residual"]) < 1e-6 * result.energy["in"]
        impulse, elapsed = result.quantities["impulse"], result.history.time[-1]
        given = scene.mass * (scene.velocity + scene.gravity * elapsed)
        assert abs(impulse.value - given) <= impulse.error < 1e-6 * given


def signs(error: Array) -> Array:
    """Errors of every sign, (2^n, n)."""
    return error * np.array(list(product((-1.0, 1.0), repeat=error.size)))


def test_the_bars_of_a_power_law_hold_whatever_the_signs_of_the_errors_and_no_more() -> None:
    depth, error = np.geomspace(1e-4, 1e-2, 7), np.geomspace(0.002, 0.03, 7)
    true, off = {"alpha": 1.4, "D": 3.0, "D_at_alpha": 3.0}, defaultdict(list)
    for wrong in signs(error):
        found = power_law(depth, 3.0 * depth**1.4 / (1.0 + wrong), error, 1.4)
        for name, value in true.items():
            quantity = found[name]
            off[name].append(abs(value / quantity.value - 1.0) / (quantity.error / quantity.value))
    for name, ratios in off.items():
        assert 0.9 < max(ratios) < 1.0 + 1e-9, name


@pytest.mark.parametrize("worst", [0.3, 0.9])
def test_the_bars_of_a_power_law_hold_however_little_is_known_of_a_force(worst: float) -> None:
    """Which may be so much larger than it seems, and as much smaller over one less of it."""
    depth, error = np.geomspace(1e-4, 1e-2, 3), np.array([0.01, 0.01, worst])
    found = power_law(depth, 3.0 * depth**1.4 * np.array([1.0, 1.0, 1.0 - worst]), error, 1.4)
    assert abs(found["alpha"].value - 1.4) <= found["alpha"].error
    assert abs(found["D_at_alpha"].value - 3.0) <= found["D_at_alpha"].error


def test_the_bars_of_what_finite_spheres_add_hold_whatever_the_signs_of_the_errors_and_no_more() -> None:
    x, true, off = np.geomspace(0.01, 0.1, 5), {"c": 0.3, "k": -0.2, "d": 0.7}, defaultdict(list)
    whole, error = x * (true["c"] + true["k"] * np.log(x) + true["d"] * x), 1e-3 * np.linspace(0.5, 1.0, 5)
    for wrong in signs(error):
        found = FiniteSize(x, whole + wrong, error)
        for name, value in true.items():
            off[name].append(abs(found.terms[name].value - value) / found.terms[name].error)
        slope, middle = found.slope, whole / x
        assert slope.value - slope.error <= middle.min() <= middle.max() <= slope.value + slope.error
    for name, ratios in off.items():
        assert max(ratios) == pytest.approx(1.0), name


def test_a_slow_indentation_is_hertz_s_and_tells_what_it_missed() -> None:
    """4/3 E* R^(1/2) d^(3/2), by the modulus that is left or that of an instant, whatever the order of its depths."""
    indenter = Indenter(Sphere(0.01), Material(Relaxation(1e6, (3e6,), (0.1,)), 0.3))
    depths = (2e-5, 1e-5, 4e-5)
    for instant, young in ((False, 1e6), (True, 4e6)):
        found = indent(indenter, depths, "hertz", instant, tolerance=1e-6)
        exact = 4.0 / 3.0 * 0.1 * np.array(depths) ** 1.5
        assert found.modulus == pytest.approx(young / 0.91, rel=1e-12)
        assert found.force == pytest.approx(found.modulus * exact, rel=1e-12, abs=0.0)
        assert found.contact_radius == pytest.approx(np.sqrt(0.01 * np.array(depths)), rel=1e-12, abs=0.0)
        law = {name: quantity.value for name, quantity in found.quantities.items()}
        assert law == pytest.approx({"alpha": 1.5, "D": 4.0 / 30.0, "D_at_alpha": 4.0 / 30.0}, rel=1e-9)
        assert (found.converged, found.message, found.finite_size) == (True, "", None)
    poor = replace(found, force_error=np.array([1e-9, 2e-6, 1e-9]) * found.force)
    assert not poor.converged
    assert poor.message == "tolerance 1e-06 not reached: force to 2e-06"
    assert replace(poor, tolerance=3e-6).converged
    assert indent(indenter, (1e-5, 2e-5, 1e-5), "hertz").quantities == {}, "three depths tell a law"
    deepest = indent(indenter, (4e-5,), "hertz", True, tolerance=1e-6)
    assert found.model_ledger == deepest.model_ledger
    assert found.model_ledger != indent(indenter, (1e-5,), "hertz", True, tolerance=1e-6).model_ledger


@pytest.mark.parametrize("name", ["peak_force", "restitution"])
def test_a_bar_that_is_no_number_meets_no_tolerance(name: str) -> None:
    known = {each: Quantity(1.0, 1e-6, unit) for each, unit in UNITS.items()}
    assert meets(known, 1e-3)
    assert not meets(known | {name: Quantity(1.0, math.nan, UNITS[name])}, 1e-3)


def test_of_equal_peaks_the_first_counts() -> None:
    """Nothing is lost between two contacts: rounding must not choose."""
    scene = Scene(
        None, 1340.4655985577324, 0.0018841237089712447, law=LawChoice("linear_spring", {"k": 23243414.404893115}),
        model=Model(gravity=18.56783683228212), motion=Motion(impacts=2, end_time=0.7018650897773285),
    )  # fmt: skip
    for tolerance in (1e-2, 1e-4, 1e-9):
        found = laws.linear_spring.of(scene).simulate(scene, tolerance).quantities
        assert 2.0 * found["peak_time"].value == pytest.approx(found["duration"].value, rel=1e-6)


@pytest.mark.tenth
def test_an_impulse_cut_off_is_known_to_rounding_and_no_better(uncovered: Callable[..., dict[str, float]]) -> None:
    values = {"k": 32144.44417825987, "A": 0.003044490798786051, "exit": "force"}
    scene = Scene(
        None, 210.18069387660137, 0.006025968373558844, law=LawChoice("kuwabara_kono", values),
        model=Model(gravity=0.8128138033340154),
    )  # fmt: skip
    law = laws.get("kuwabara_kono").of(scene)
    assert not uncovered(law.simulate(scene, 0.1), law.simulate(scene, 1e-9))


@pytest.mark.parametrize(
    ("law", "shape", "impact", "material", "end", "tolerance"),
    [
        (
            "ting", {"shape": "cone", "angle": 12.678381504706799}, (0.5836295470436739, 0.0017823161801486366),
            (12818.549200228883, -0.14378842349048898, 1.0199658530199498, 0.0006543161), 0.360377257446072, 0.0027685,
        ),
        (
            "mdr", {"shape": "power", "coefficient": 4.6898414531354786e-06, "exponent": 3.128982150051435},
            (1282.746720141593, 2.2319834360303643),
            (33805185.390219755, -0.1557289596975986, 114.4369837655644, 7.432226e-07), 2.222404284086163e-4, 3.9889e-5,
        ),
    ],
)  # fmt: skip
def test_an_impulse_cut_off_where_two_integrations_meet_by_chance_has_a_true_bar(
    law: str, shape: dict[str, Any], impact: tuple[float, float], material: tuple[float, ...], end: float,
    tolerance: float, uncovered: Callable[..., dict[str, float]],
) -> None:  # fmt: skip
    """Of a relaxation much faster than the contact, which is hardly resolved: by chance both tell one velocity then."""
    striker = {**shape, "mass": impact[0], "velocity": impact[1]}
    base = Scene.load("polymer-cone", {"striker": striker})
    young, nu, share, time = material
    relaxing = Material(Relaxation(young, (young * share,), (time,)), nu)
    scene = replace(base, material=relaxing, motion=Motion(end_time=end))
    found, exact = simulate(laws.get(law).of(scene), scene, tolerance), simulate(laws.ting.of(scene), scene, 1e-9)
    assert found.message == End.TIME.value
    assert not uncovered(found, exact, ["impulse"])


def test_an_impulse_cut_off_under_a_weight_is_known_as_well_as_one_that_is_not() -> None:
    """When it is cut off is no matter of numbers."""
    spring = Scene(None, 1.0, 0.5, law=LawChoice("hertz", {"k": 1e7}), model=Model(gravity=9.81))
    cut = replace(spring, motion=Motion(end_time=2e-3))
    for scene in (spring, cut):
        impulse = simulate(laws.get("hertz").of(scene), scene, 1e-6).quantities["impulse"]
        assert impulse.error < 1e-12 * impulse.value


def test_a_law_that_meets_no_tolerance_ends_at_its_tightest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_hereditary, "meets", lambda quantities, tolerance: False)
    scene = Scene.load("polymer-sphere")
    rtol = simulate(laws.ting.of(scene), scene, 1e-3).numerics["rtol"]
    assert _hereditary.TIGHTEST <= rtol < _hereditary.TIGHTEST / _hereditary.NEXT


def test_what_creeps_counts_no_energy_as_stored() -> None:
    """What a memory of the load gives back is no potential of the depth: all that is not out is lost."""
    scene = Scene.load("ball-bouncing")
    energy = simulate(laws.correspondence.of(scene), scene, 1e-3).energy
    assert energy["stored"] == 0.0
    assert energy["in"] == pytest.approx(energy["out"] + energy["viscous"], rel=1e-9)


@dataclass(frozen=True)
class Pushed:
    """The force 1 - (t - 1)^2 + by t, N; ``asked`` keeps how often it was told."""

    by: float
    asked: list[int]

    def __call__(self, times: Array) -> Array:
        return np.array([times, times, self.force(times), times])

    def force(self, times: Array) -> Array:
        self.asked.append(times.size)
        return np.asarray(1.0 - (times - 1.0) ** 2 + self.by * times)


def test_a_peak_is_sought_no_closer_than_two_integrations_place_it() -> None:
    """What they differ by may shift the peak by twice its slope; all of it is asked of both at once."""
    slope = 1e-4
    for apart in (0.0, 1e-3):
        counts, values = list[int](), dict.fromkeys(UNITS, 1.0)
        fine, coarse = (
            Answer(np.linspace(0.0, 2.0, 41), Pushed(by, counts), {**values, "peak_time": time}, End.SEPARATED)
            for by, time in ((0.0, 1.0), (slope, 1.0 + apart))
        )
        bar = bars(fine, coarse, 1.0)[0]["peak_time"].error
        assert 0.999 < bar / (apart or 2.0 * slope) < 1.2
        assert len(counts) <= 5


def test_a_peak_s_time_is_known_to_where_its_height_is_the_same_to_rounding() -> None:
    """Though two integrations agree in all that they say."""
    values = {**dict.fromkeys(UNITS, 1.0), "peak_time": 1.0}
    answer = Answer(np.linspace(0.0, 2.0, 41), Pushed(0.0, []), values, End.SEPARATED)
    bar = bars(answer, answer, 1.0)[0]["peak_time"].error or 0.0
    shifts = np.geomspace(1e-12, 1e-3, 2000)
    alike = shifts[answer.columns.force(1.0 + shifts) == 1.0].max()
    assert alike <= bar <= 2.0 * alike


@pytest.mark.parametrize(("safety", "end"), [(1.0, End.SEPARATED), (1.5, End.SEPARATED), (2.0, End.REST)])
def test_bars_are_a_safety_times_what_two_integrations_differ_by(safety: float, end: End) -> None:
    """At times that both know: of the force the largest and the norm, over the norm of the force; a tenth of the norm
    of any quantity at least, of its size but for a restitution, and of none where there is none.
    """
    slope, times = 1e-3, (np.linspace(0.0, 2.0, 401), np.linspace(0.0, 1.8, 601))
    fine = {name: 5.0 for name in UNITS if name != "history_l2"}
    fine |= {"restitution": 0.5, "peak_depth": -4.0, "duration": None, "peak_time": 1.0}
    coarse = {**fine, "peak_force": 5.1, "impulse": 5.0 - 3e-9}
    answers = [
        Answer(at, Pushed(by, []), told, end) for at, by, told in zip(times, (0.0, slope), (fine, coarse), strict=True)
    ]
    found, force = bars(*answers, safety)
    rounding = 1e-12 + (AT_REST if end is End.REST else 0.0)
    norm = slope * math.sqrt(2.0**3 / 3.0) / math.sqrt(2.0 - 4.0 / 3.0 + 2.0 / 5.0)
    errors = {name: quantity.error for name, quantity in found.items()}
    assert list(found) == list(UNITS)
    assert force == pytest.approx(safety * (2.0 * slope + 5.0 * rounding), rel=1e-12)
    assert errors["history_l2"] == pytest.approx(safety * norm + rounding, rel=1e-4)
    least = 0.1 * (errors["history_l2"] - rounding) / safety + rounding
    assert errors["peak_force"] == pytest.approx(safety * 0.1, rel=1e-12)
    assert errors["peak_depth"] == pytest.approx(safety * 4.0 * least, rel=1e-12)
    assert errors["restitution"] == pytest.approx(safety * least, rel=1e-12)
    assert errors["impulse"] == pytest.approx(safety * 5.0 * least, rel=1e-12)
    assert found["duration"] == Quantity(None, None, "s")
    assert {name: quantity.value for name, quantity in found.items()} == {"history_l2": 0.0, **fine}


def test_how_a_force_bends_is_asked_for_between_the_rows_around_its_peak() -> None:
    """Two of its own rows on either side, or as many as there are; nowhere before the touch and after the end."""
    rows, values = np.linspace(0.0, 2.0, 41), dict.fromkeys(UNITS, 1.0)
    for peak, low, high in ((1.0, 0.9, 1.1), (0.06, 0.0, 0.2), (0.02, 0.0, 0.15), (1.98, 1.9, 2.0)):
        answer = Answer(rows, Pushed(0.0, []), {**values, "peak_time": peak}, End.SEPARATED)
        near = _NearPeak.of(answer)
        assert near.places[: AROUND.size] == pytest.approx(np.linspace(low, high, AROUND.size), abs=1e-12)
        before, after = near.places[AROUND.size :].reshape(2, -1)
        assert before == pytest.approx(np.maximum(peak - np.append(near.reaches, 0.0), 0.0))
        assert after == pytest.approx(np.minimum(peak + np.append(near.reaches, 0.0), 2.0))
        assert (near.whole, near.width) == pytest.approx((2.0, high - low))
        assert near.reaches[0] == 2.0
        assert near.reaches[-1] < 1e-8 * peak
        assert near.reaches[1:] == pytest.approx(0.8 * near.reaches[:-1])
    for peak in (0.0, 2.0):
        assert not _NearPeak.of(Answer(rows, Pushed(0.0, []), {**values, "peak_time": peak}, End.SEPARATED)).places.size


def test_a_result_tells_its_bars_as_they_are_ruled() -> None:
    """Of forces, times and depths over the value, of a restitution and of the history as they are."""
    scene = impact(np.random.default_rng(3), "hertz", alpha=1.5)
    found = simulate(laws.hertz.of(scene), scene, 1e-4)
    bars_of = found.error_budget_by_quantity["integration"]
    force = found.quantities["peak_force"].value or 0.0
    assert found.error_budget["integration"] == pytest.approx(found.history.force_error[0] / force, rel=1e-12)
    assert set(bars_of) == set(UNITS)
    for name, quantity in found.quantities.items():
        relative = name in ("peak_force", "peak_depth", "peak_time", "duration", "impulse")
        unit = abs(quantity.value or 0.0) if relative else 1.0
        assert bars_of[name] == pytest.approx((quantity.error or 0.0) / unit, rel=1e-12, abs=0.0)
    rows = [simulate(laws.hertz.of(scene), scene, tolerance).history.time.size for tolerance in (1e-2, 1e-6)]
    assert 200 < rows[0] < 500 < rows[1], "as dense as the tolerance asks for"


def test_an_impulse_is_the_momentum_lost_and_what_gravity_gave_meanwhile() -> None:
    scene = Scene(None, 2.0, 3.0, law=LawChoice("hertz", {"k": 1e5}), model=Model(gravity=10.0))
    assert impulse_of(scene, End.SEPARATED, -1.5, 0.25, 9.0) == pytest.approx(2.0 * (3.0 + 1.5 + 10.0 * 0.25))
    assert impulse_of(scene, End.TIME, 0.5, 0.25, 9.0) == pytest.approx(2.0 * (3.0 - 0.5 + 10.0 * 0.25))
    assert impulse_of(scene, End.REST, 1e-9, 0.25, 9.0) == pytest.approx(2.0 * (3.0 + 10.0 * 9.0)), (
        "its weight is borne"
    )
    assert impulse_of(scene, End.SECOND_APPROACH, -1.5, 0.25, 9.0) is None
    values = values_of(scene, End.SEPARATED, (0.1, 7.0), 0.02, -1.5, 0.25)
    exact = {"peak_force": 7.0, "peak_time": 0.1, "peak_depth": 0.02, "duration": 0.25, "restitution": 0.5}
    assert values == pytest.approx({**exact, "impulse": 2.0 * (4.5 + 2.5)})
    other = values_of(scene, End.TIME, (0.1, 7.0), 0.02, 0.5, 0.25)
    assert (other["duration"], other["restitution"]) == (None, None)


@pytest.mark.parametrize("asked", [1e-5, 1e-9, 1e-10, 1e-12, 1e-20])
def test_a_march_is_compared_with_one_a_hundred_times_less_fine(asked: float) -> None:
    """As fine as is asked for once again a hundred times, but no finer than rounding lets it be."""
    marched = list[float]()

    def march(tolerance: float) -> tuple[Answer, int]:
        marched.append(tolerance)
        values = {**dict.fromkeys(UNITS, 1.0), "peak_time": 1.0}
        return Answer(np.linspace(0.0, 2.0, 41), Pushed(tolerance, []), values, End.SEPARATED), len(marched)

    judged = _force_law._compared(march, asked)
    fine, coarse = marched
    assert coarse == pytest.approx(100.0 * fine, rel=1e-12)
    assert fine == pytest.approx(max(0.01 * asked, 1e-12), rel=1e-12)
    assert judged.steps == 1, "those of the finer one"
    assert judged.answer.columns.by == fine  # type: ignore[attr-defined]  # of the test's own columns
    assert judged.force_error == pytest.approx(2.0 * (2.0 * (coarse - fine) + 1e-12), rel=1e-3)


@pytest.mark.parametrize("rate", [-3.0, 0.0, 0.4])
def test_how_a_force_bends_is_told_whatever_its_slope_there(rate: float) -> None:
    """Of a parabola exactly: of that through 1 + rate t - 2 t^2 over the width that is looked at."""
    assert BENDS @ (1.0 + rate * AROUND - 2.0 * AROUND**2) == pytest.approx(-2.0, rel=1e-12)
    assert AROUND[[0, -1]].tolist() == [0.0, 1.0], "all of it"


def test_two_forces_that_are_none_differ_by_nothing() -> None:
    """Of a striker that its end time stops before anything presses."""
    nothing = np.zeros(4)
    alone: Any = SimpleNamespace(contacts=())
    assert _largest_and_norm(alone, np.arange(4.0), nothing, nothing) == (0.0, 0.0)


@pytest.mark.parametrize("impacts", [1, 2])
@pytest.mark.parametrize("ratio", [0.5, 1e-2, 1e-4, 1e-6])
def test_the_time_of_a_flat_peak_is_known_as_far_as_rounding_lets_it(ratio: float, impacts: int) -> None:
    """A loop that goes on yielding until it turns, its force then as flat as its second stiffness is small.

    Of several impacts two marches tell the bars, which may agree about a time where the force is as high but for
    rounding; after the turn it is steep.
    """
    k1, mass, velocity = 1557.35, 10287.2, 0.132921
    k2, fast = ratio * k1, math.sqrt(k1 / mass)
    for share in (0.05, 0.18, 0.5):
        depth = share * velocity / fast
        slow, begun = math.sqrt(k2 / mass), math.asin(share)
        left = velocity * math.cos(begun)
        exact = begun / fast + math.atan(left * mass * slow / (k1 * depth)) / slow
        law = LawChoice("impact_bilinear", {"k1": k1, "k2": k2, "yield_depth": depth})
        scene = Scene(None, mass, velocity, law=law, motion=Motion(impacts, end_time=1e9))
        for tolerance in (1e-4, 1e-6, 1e-8):
            found = simulate(laws.get("impact_bilinear").of(scene), scene, tolerance).quantities["peak_time"]
            assert found.error is not None
            assert abs((found.value or 0.0) - exact) <= found.error < 0.1 * exact
