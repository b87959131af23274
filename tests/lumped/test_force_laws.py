"""The contract of every law that is a force between two masses: a new file is tested the day it appears."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from lumped import BadInput, Motion, Scene, laws, restitution
from lumped.numbers import Real
from lumped.result.history import End
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE
from lumped.scene.tables import LawChoice, Model
from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, Stage
from lumped.solvers.point.contact import motion
from lumped.solvers.point.track import FIVE, PointTrack, _top, peak_of

OF_GEOMETRY = {"correspondence", "ting", "mdr", "rod_waves", "bar_waves"}
NAMES = sorted(set(laws.available()) - OF_GEOMETRY)
DAMPED = [name for name in NAMES if "e" in laws.get(name).keys]
FREE = [name for name in NAMES if "alpha" in laws.get(name).keys]
# One impact for all: k = 1e6 N/m^alpha, the damping by its own key where the law has one.
OWN: dict[str, dict[str, float]] = {
    "hertz": {},
    "hertzdamp": {"xi": 0.7},
    "hunt_crossley": {"chi": 0.4},
    "impact_bilinear": {"e": 0.6},
    "jankowski": {"xi": 0.4},
    "kelvin": {"c": 500.0},
    "khatiwada": {"c": 4e5},
    "kuwabara_kono": {"A": 1e-3},
    "linear_spring": {},
    "mahmoud": {"c": 500.0},
    "tsuji": {"alpha_t": 0.6},
}
K, MASS, VELOCITY = 1e6, 2.0, 1.5


def scene(name: str, mass: float = MASS, velocity: float = VELOCITY, **values: Any) -> Scene:
    own = {"k": K, **values} if not {"k", "k1"} & values.keys() else values
    return Scene(None, mass, velocity, law=LawChoice(name, own))


def undamped(name: str) -> dict[str, float]:
    return {key: 1.0 if key == "e" else 0.0 for key in OWN[name]}


def quantities(case: Scene, tolerance: float) -> dict[str, float]:
    result = laws.get(case.law.name).of(case).simulate(case, tolerance)
    assert result.converged, result.message
    return {name: quantity.value for name, quantity in result.quantities.items()}


@pytest.mark.parametrize("alpha", [1.2, 1.5, 2.5])
def test_a_force_that_is_steep_where_contact_begins_and_ends_takes_few_steps(alpha: float) -> None:
    """There steps run in a root of the time in which the motion is smooth: else they are many."""
    case = scene("hertz", alpha=alpha)
    assert laws.hertz.of(case).simulate(case, 1e-3).work["steps"] < 50.0 / alpha


def test_every_law_has_its_case() -> None:
    assert set(OWN) == set(NAMES)
    assert set(laws.available()) >= OF_GEOMETRY


@pytest.mark.parametrize("name", NAMES)
def test_a_stiffness_is_told_in_the_unit_that_the_force_gives_it(name: str) -> None:
    keys, stage = laws.get(name).keys, Stage(True, 0.0, 0.0)
    if name in FREE:
        assert keys["k"].kind.unit == "N/m^alpha"
        return
    law = laws.get(name).of(scene(name, **undamped(name)))
    power = math.log2(float(law.force(2e-3, 0.0, stage)) / float(law.force(1e-3, 0.0, stage)))
    assert keys["k"].kind.unit == ("N/m" if power == pytest.approx(1.0) else f"N/m^{power:.3g}")


@pytest.mark.parametrize("approaching", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_tangents_are_the_slopes_of_the_force(name: str, approaching: bool) -> None:
    law, rng = laws.get(name).of(scene(name, **OWN[name])), np.random.default_rng(7)
    for _ in range(50):
        depth, rate = 10.0 ** rng.uniform(-4.0, -1.0), rng.uniform(0.0, 2.0) * (1.0 if approaching else -1.0)
        turn = 0.0 if approaching else 2.0 * depth
        kept = () if approaching else (1e-3 * K * turn,)
        stage = Stage(approaching, max(depth, turn), rng.uniform(0.5, 2.0), turn, kept)
        over_depth, over_rate = law.tangents(depth, rate, stage)
        ahead, step = 1e-6 * depth, 1e-5
        by_depth = (law.force(depth + ahead, rate, stage) - law.force(depth - ahead, rate, stage)) / (2.0 * ahead)
        by_rate = (law.force(depth, rate + step, stage) - law.force(depth, rate - step, stage)) / (2.0 * step)
        size = abs(law.force(depth, rate, stage)) + abs(law.lost(depth, rate, stage))
        assert over_depth == pytest.approx(by_depth, rel=1e-6, abs=1e-6 * size / depth)
        assert over_rate == pytest.approx(by_rate, rel=1e-6, abs=1e-6 * size)


@pytest.mark.parametrize("approaching", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_what_is_not_lost_is_the_slope_of_what_is_stored(name: str, approaching: bool) -> None:
    law, rng = laws.get(name).of(scene(name, **OWN[name])), np.random.default_rng(8)
    for depth in 10.0 ** rng.uniform(-4.0, -1.0, 50):
        turn, rate = (0.0, 0.7) if approaching else (2.0 * depth, -0.7)
        stage = Stage(approaching, max(depth, turn), 1.0, turn, () if approaching else (1e-3 * K * turn,))
        kept = law.force(depth, rate, stage) - law.lost(depth, rate, stage)
        ahead = 1e-5 * depth
        slope = (law.stored(depth + ahead, stage) - law.stored(depth - ahead, stage)) / (2.0 * ahead)
        assert kept == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize("exit", ["force", "depth"])
@pytest.mark.parametrize("name", NAMES)
def test_the_energy_ledger_closes(name: str, exit: str) -> None:
    case = scene(name, exit=exit, **OWN[name])
    energy = laws.get(name).of(case).simulate(case, 1e-3).energy
    assert energy["in"] == pytest.approx(0.5 * MASS * VELOCITY**2, rel=1e-15)
    assert abs(energy["residual"]) <= 1e-8 * energy["in"]
    lost = energy.get("viscous", 0.0) + energy.get("contact", 0.0)
    assert (lost > 1e-3 * energy["in"]) == bool(OWN[name])


@pytest.mark.parametrize("name", NAMES)
def test_without_damping_the_impact_is_the_spring_s_own(name: str) -> None:
    """The time of Hertz, (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10) d/v = 2.9432 d/v; pi sqrt(m/k) of the linear spring."""
    found = quantities(scene(name, **undamped(name)), 1e-8)
    law = laws.get(name).of(scene(name, **undamped(name)))
    alpha = getattr(law, "alpha", 1.0)
    stiffness = getattr(law, "k", getattr(law, "k1", None))
    depth = ((alpha + 1.0) * 0.5 * MASS * VELOCITY**2 / stiffness) ** (1.0 / (alpha + 1.0))
    hertz = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9)
    duration = {1.0: math.pi * math.sqrt(MASS / stiffness), 1.5: hertz * depth / VELOCITY}[alpha]
    assert found["peak_depth"] == pytest.approx(depth, rel=1e-10)
    assert found["peak_force"] == pytest.approx(stiffness * depth**alpha, rel=1e-10)
    assert found["duration"] == pytest.approx(duration, rel=2e-10)
    assert found["restitution"] == pytest.approx(1.0, abs=1e-11)


@pytest.mark.parametrize("name", FREE)
def test_with_exponent_one_the_spring_is_linear(name: str) -> None:
    found = quantities(scene(name, alpha=1.0, **undamped(name)), 1e-8)
    assert found["duration"] == pytest.approx(math.pi * math.sqrt(MASS / K), rel=1e-10)
    assert found["peak_force"] == pytest.approx(VELOCITY * math.sqrt(K * MASS), rel=1e-10)


@pytest.mark.parametrize("alpha", [0.5, 0.8, 1.0, 1.3, 1.5, 2.0, 2.5, 3.7, 5.0])
def test_the_end_of_a_power_law_is_its_beta_function(alpha: float) -> None:
    power = alpha + 1.0
    depth = (0.5 * power * MASS / K * VELOCITY**2) ** (1.0 / power)
    beta = math.gamma(1.0 / power) * math.gamma(0.5) / math.gamma(1.0 / power + 0.5)
    found = quantities(scene("hertz", alpha=alpha), 1e-8)
    assert found["duration"] == pytest.approx(2.0 * depth / VELOCITY * beta / power, rel=1e-10)
    assert found["peak_time"] == pytest.approx(0.5 * found["duration"], rel=1e-6)


@pytest.mark.parametrize("xi", [1e-6, 0.05, 0.3, 0.7, 0.99, 1.0, 1.01, 3.0, 100.0])
def test_the_end_of_the_kelvin_contact_is_where_it_should_be(xi: float) -> None:
    """Zero force comes after twice the time of the turn, zero depth after half a period."""
    omega = math.sqrt(K / MASS)
    root = math.sqrt(abs(1.0 - xi) * (1.0 + xi))
    turn = 1.0 if xi == 1.0 else (math.acos(xi) if xi < 1.0 else math.acosh(xi)) / root
    found = quantities(scene("kelvin", xi=xi), 1e-8)
    assert found["duration"] == pytest.approx(2.0 * turn / omega, rel=1e-10)
    assert found["peak_depth"] == pytest.approx(VELOCITY / omega * math.exp(-xi * turn), rel=1e-10)
    if xi <= 0.7:
        pulled = quantities(scene("kelvin", xi=xi, exit="depth"), 1e-8)
        assert pulled["duration"] == pytest.approx(math.pi / (omega * root), rel=1e-10)
    elastic = quantities(scene("mahmoud", xi=xi), 1e-8)
    assert elastic["duration"] == pytest.approx((turn + 0.5 * math.pi) / omega, rel=1e-10)


@given(data=st.data())
@pytest.mark.parametrize("name", DAMPED)
def test_the_restitution_asked_for_is_the_one_obtained(name: str, data: st.DataObject) -> None:
    def draw(low: float, high: float) -> float:
        return data.draw(st.floats(low, high))

    e, exit = draw(0.01, 0.999), data.draw(st.sampled_from(["force", "depth"]))
    values: dict[str, Any] = {"e": e, "exit": exit, "k": 10.0 ** draw(-3.0, 15.0)}
    if name in FREE:
        lowest = 0.5 if name in ("hunt_crossley", "hertzdamp", "khatiwada", "impact_bilinear") else 1.0
        values["alpha"] = draw(lowest, 5.0)
    case = scene(name, 10.0 ** draw(-12.0, 9.0), 10.0 ** draw(-6.0, 3.0), **values)
    case = Scene(None, case.mass, case.velocity, law=case.law, motion=Motion(end_time=1e12))
    outcome = laws.get(name).of(case).outcome(case, 1e-6)
    assert outcome.restitution == pytest.approx(e, abs=1e-6)


# Restitution that formulas really give, from an independent integration; the exact damping for each beside it.
REALISED = {
    0.2: (4.91917, 0.547, 0.672, 0.501, 0.266, 0.156, 0.205, 0.166),
    0.4: (2.08250, 0.620, 0.702, 0.550, 0.399, 0.363, 0.398, 0.380),
    0.6: (0.97487, 0.712, 0.756, 0.651, 0.577, 0.577, 0.577, 0.594),
    0.9: (0.16648, 0.909, 0.913, 0.901, 0.896, 0.894, 0.876, 0.900),
}
FORMULAS = (
    "hunt_crossley", "lankarani_nikravesh", "herbert_mcwhannell", "zhiying_qishao", "ye", "gonthier", "hu_guo"
)  # fmt: skip


@pytest.mark.parametrize("e", REALISED)
def test_published_dampings_of_hunt_and_crossley_give_what_they_are_known_to_give(e: float) -> None:
    exact, *given_by = REALISED[e]
    law = laws.get("hertzdamp").of(scene("hertzdamp", e=e))
    assert law.xi == pytest.approx(exact, abs=6e-6)
    for formula, expected in zip(FORMULAS, given_by, strict=True):
        for name in ("hunt_crossley", "hertzdamp"):
            case = scene(name, e=e, damping=formula)
            assert laws.get(name).of(case).outcome(case).restitution == pytest.approx(expected, abs=6e-4)


@pytest.mark.parametrize(
    ("name", "formula", "exit", "pairs"),
    [
        ("jankowski", "jankowski_2006", "force", {0.3: 0.292, 0.5: 0.495, 0.65: 0.647, 0.9: 0.900}),
        ("tsuji", "antypov_elliott", "force", {0.2: 0.325, 0.4: 0.472, 0.6: 0.632, 0.9: 0.902}),
        ("tsuji", "tsuji_polynomial", "depth", {0.5: 0.4999}),
        ("kelvin", "anagnostopoulos", "depth", {0.2: 0.2, 0.7: 0.7}),
    ],
)
def test_other_published_dampings_too(name: str, formula: str, exit: str, pairs: dict[float, float]) -> None:
    for e, expected in pairs.items():
        case = scene(name, e=e, damping=formula, exit=exit)
        assert laws.get(name).of(case).outcome(case).restitution == pytest.approx(expected, abs=6e-4)


@pytest.mark.parametrize("name", DAMPED)
def test_every_published_formula_of_the_family_can_be_asked_for(name: str) -> None:
    families = {"hertzdamp": "hunt_crossley", "khatiwada": "khatiwada", "impact_bilinear": None}
    family = families.get(name, name)
    offered = laws.get(name).keys["damping"].kind.options if "damping" in laws.get(name).keys else (restitution.EXACT,)
    if family is not None:
        assert offered == (restitution.EXACT, *restitution.get(family).published)


@pytest.mark.parametrize("x", [0.05, 0.2, 0.8, 1.6])
def test_the_viscous_sphere_has_the_restitution_of_the_literature(x: float) -> None:
    expected = {0.05: 0.94440, 0.2: 0.80097, 0.8: 0.45974, 1.6: 0.26462}[x]
    A = x / (1.5 * (K / MASS) ** 0.4 * VELOCITY**0.2)
    assert quantities(scene("kuwabara_kono", A=A), 1e-7)["restitution"] == pytest.approx(expected, abs=6e-6)


@pytest.mark.family
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
@pytest.mark.parametrize("name", NAMES)
def test_bars_cover_the_error_at_every_tolerance(name: str, tolerance: float) -> None:
    for exit in ("force", "depth"):
        case = scene(name, exit=exit, **OWN[name])
        law = laws.get(name).of(case)
        reference, result = law.simulate(case, 1e-9).quantities, law.simulate(case, tolerance).quantities
        for key in (*RULED_RELATIVE, "restitution", "peak_time"):
            off = abs(result[key].value - reference[key].value)
            assert off <= result[key].error + reference[key].error, key
        for key in RULED_ABSOLUTE:
            assert result[key].error <= tolerance


@pytest.mark.parametrize("exit", ["force", "depth"])
@pytest.mark.parametrize("name", NAMES)
def test_the_force_s_own_impulse_is_the_change_of_momentum(name: str, exit: str) -> None:
    case = scene(name, exit=exit, **OWN[name])
    result = laws.get(name).of(case).simulate(case, 1e-5)
    impulse = float(np.trapezoid(result.history.force, result.history.time))
    expected = MASS * VELOCITY * (1.0 + result.quantities["restitution"].value)
    assert impulse == pytest.approx(expected, rel=1e-5)
    assert result.quantities["impulse"].value == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("mass", "length", "time"), [(1e3, 1e-2, 60.0), (1e-3, 1e2, 1e11)])
@pytest.mark.parametrize("name", NAMES)
def test_other_units_say_the_same(name: str, mass: float, length: float, time: float) -> None:
    law = laws.get(name).of(scene(name, **OWN[name]))
    alpha, force = getattr(law, "alpha", 1.5), mass * length / time**2
    dimension = {
        "k": force / length**alpha,
        "chi": time / length,
        "A": time,
        "c": force * time / length ** (alpha + 1.0) if name == "khatiwada" else mass / time,
    }
    values = {key: value * dimension.get(key, 1.0) for key, value in {"k": K, **OWN[name]}.items()}
    here, there = scene(name, **OWN[name]), scene(name, MASS * mass, VELOCITY * length / time, **values)
    one, other = quantities(here, 1e-6), quantities(there, 1e-6)
    assert other["peak_force"] == pytest.approx(one["peak_force"] * force, rel=1e-11)
    assert other["duration"] == pytest.approx(one["duration"] * time, rel=1e-11)
    assert other["restitution"] == pytest.approx(one["restitution"], rel=1e-11)
    assert newton_steps(there) == newton_steps(here)
    bars, others = (laws.get(name).of(case).simulate(case, 1e-3).quantities for case in (here, there))
    units = {"peak_force": force, "peak_time": time, "duration": time, "restitution": 1.0}
    for key, unit in (units | {"peak_depth": length, "impulse": mass * length / time}).items():
        assert others[key].error == pytest.approx(bars[key].error * unit, rel=0.1), key


@pytest.mark.parametrize("name", NAMES)
def test_long_steps_too_balance_their_forces(name: str) -> None:
    """m a + F = m g at every point of every step, to rounding."""
    law, bodies = laws.get(name).of(scene(name, **OWN[name])), Bodies(MASS, VELOCITY, 9.81)
    found = motion(law, bodies, "force", 1, 10.0, 0.1)
    steps = [(phase.stage, step) for phase in found.contacts[0].phases for step in phase.steps]
    peak = max(step.force.max() for _, step in steps)
    for stage, step in steps:
        force = law.force(np.maximum(step.depth, TINY), step.rate, stage)
        assert step.force == pytest.approx(force, rel=0.0, abs=1e-12 * peak)


def newton_steps(case: Scene) -> int:
    """Of all steps of an impact."""
    bodies = Bodies(case.reduced_mass, case.velocity)
    found = motion(laws.get(case.law.name).of(case), bodies, "force", 1, case.end_time, 1e-6)
    return sum(step.iterations for contact in found.contacts for phase in contact.phases for step in phase.steps)


@pytest.mark.parametrize("name", NAMES)
def test_two_free_bodies_move_like_their_reduced_mass(name: str) -> None:
    held = scene(name, **OWN[name])
    free = Scene(None, 3.0 * MASS, VELOCITY, target_mass=1.5 * MASS, law=held.law)
    assert quantities(free, 1e-6) == pytest.approx(quantities(held, 1e-6), rel=1e-12)


@pytest.mark.family
@pytest.mark.parametrize("name", NAMES)
def test_many_bounces_follow_their_restitution(name: str) -> None:
    """With gravity far weaker than the contact the n-th touch has the speed v e^n, flights last 2 v/g."""
    gravity, impacts = 1e-4, 8
    own = {"e": 0.7} if name in DAMPED else {}
    law = LawChoice(name, {"k": 1e12, **own})
    case = Scene(None, MASS, VELOCITY, law=law, model=Model(gravity=gravity), motion=Motion(impacts, end_time=1e12))
    contacts = laws.get(name).of(case).simulate(case, 1e-6).contacts
    assert len(contacts) == impacts
    start = 0.0
    for one, following in pairwise(contacts):
        assert one["start"] == pytest.approx(start, rel=1e-6)
        assert following["velocity"] == pytest.approx(one["velocity"] * one["restitution"], rel=1e-6)
        start += one["duration"] + 2.0 * following["velocity"] / gravity
    assert contacts[-1]["velocity"] == pytest.approx(
        VELOCITY * math.prod(one["restitution"] for one in contacts[:-1]), rel=1e-6
    )


def test_every_bounce_on_a_damping_that_follows_its_speed_leaves_one_share_of_it() -> None:
    """Hertzdamp's xi/v0 has the speed v0 of its own contact, not that of the first one."""
    law = laws.hertzdamp.of(scene("hertzdamp", k=1e12, e=0.6))
    contacts = motion(law, Bodies(MASS, VELOCITY, 1e-7), law.exit, 6, math.inf, 1e-10).contacts
    assert [-one.last.rate / one.first.rate for one in contacts] == pytest.approx([0.6] * 6, rel=1e-8)


def test_bounces_end_where_the_speed_is_a_millionth_of_the_first() -> None:
    law, e = LawChoice("kelvin", {"k": 1e12, "e": 0.5}), 0.5
    case = Scene(None, MASS, VELOCITY, law=law, model=Model(gravity=1e-4), motion=Motion(100, end_time=1e12))
    assert len(laws.kelvin.of(case).simulate(case, 1e-6).contacts) == math.ceil(math.log(1e-6, e))


@pytest.mark.parametrize("share", [0.1, 0.9, 1.1])
def test_a_flight_that_outlasts_the_end_time_is_not_followed_to_its_touch(share: float) -> None:
    """Contact and flight of 2 v/g: the second contact counts only if it begins before the end."""
    law, flight = LawChoice("hertz", {"k": K}), 2.0 * VELOCITY / 9.81
    once = Scene(None, MASS, VELOCITY, law=law, model=Model(gravity=9.81))
    duration = laws.get("hertz").of(once).simulate(once, 1e-6).quantities["duration"].value
    case = replace(once, motion=Motion(2, duration + share * flight))
    assert len(laws.get("hertz").of(case).simulate(case, 1e-6).contacts) == (2 if share > 1.0 else 1)


@pytest.mark.family
@pytest.mark.parametrize("name", ["linear_spring", "hertz"])
def test_an_elastic_bounce_never_tires(name: str) -> None:
    case = Scene(None, MASS, VELOCITY, law=LawChoice(name, {"k": K}), model=Model(gravity=9.81), motion=Motion(50, 1e3))
    result = laws.get(name).of(case).simulate(case, 1e-6)
    assert [one["velocity"] for one in result.contacts] == pytest.approx([VELOCITY] * 50, rel=1e-10)
    periods = np.diff([one["start"] for one in result.contacts])
    assert periods == pytest.approx([result.quantities["duration"].value + 2.0 * VELOCITY / 9.81] * 49, rel=1e-10)
    assert result.history.depth.min() == pytest.approx(-(VELOCITY**2) / (2.0 * 9.81), rel=1e-6)


@pytest.mark.family
@pytest.mark.parametrize("name", NAMES)
def test_a_weight_too_heavy_to_rebound_rests_where_its_force_carries_it(name: str) -> None:
    case = Scene(
        None, MASS, 1e-3, law=LawChoice(name, {"k": K, **OWN[name]}), model=Model(gravity=1e3), motion=Motion(3, 20.0)
    )
    result = laws.get(name).of(case).simulate(case, 1e-6)
    assert abs(result.energy["residual"]) <= 1e-8 * MASS * 1e3 * result.history.depth.max()
    if "rest" in result.message:
        assert result.history.force[-1] == pytest.approx(MASS * 1e3, rel=1e-5)
        assert result.history.velocity[-1] == 0.0


def test_the_bilinear_loop_is_that_of_its_return_map() -> None:
    """Loading and reloading: k1, at most the line of k2 above; unloading: k1, at least the line k2 depth."""
    law = laws.get("impact_bilinear").of(scene("impact_bilinear", k1=3e6, k2=1e6, yield_depth=1e-3))
    turns = [0.0, 4e-3, 2.5e-3, 2.9e-3, 1e-3, 6e-3, 5.9e-3, 5.95e-3, 0.0]
    stage, depth, force, deepest = Stage(True, 0.0, 1.0), 0.0, 0.0, 0.0
    for turn in turns[1:]:
        for place in np.linspace(depth, turn, 400)[1:]:
            force += law.k1 * (place - depth)
            above = law.k1 * law.yield_depth + law.k2 * (place - law.yield_depth)
            force = min(force, above) if place > depth else max(force, law.k2 * place)
            depth = float(place)
            assert law.force(depth, 0.0, stage) == pytest.approx(force, rel=1e-9, abs=1e-9)
        deepest = max(deepest, depth)
        stage = Stage(not stage.approaching, deepest, 1.0, depth, law.kept(depth, stage))


@pytest.mark.parametrize("e", [0.3, 0.6, 0.9])
def test_the_published_bilinear_recipe_loses_other_energy_than_asked(e: float) -> None:
    """Its loss is right at the depth of the elastic impact, which the loop does not reach."""
    case = scene("impact_bilinear", e=e, damping="muthukumar")
    law = laws.get("impact_bilinear").of(case)
    depth = (1.25 * MASS * VELOCITY**2 / K) ** 0.4
    loss = (law.k1 - law.k2) * law.yield_depth * (depth - law.yield_depth)
    assert loss == pytest.approx(0.4 * K * depth**2.5 * (1.0 - e**2), rel=1e-12)
    assert law.force(depth, 0.0, Stage(True, depth, 1.0)) == pytest.approx(K * depth**1.5, rel=1e-12)
    assert e + 0.01 < quantities(case, 1e-6)["restitution"] < 1.0


@pytest.mark.parametrize("name", NAMES)
def test_one_contact_is_cheap(name: str, spent: Callable[..., int]) -> None:
    """The work, not the time: at most 40 solves of a step for five digits more than anybody needs."""
    case = scene(name, **OWN[name])
    assert spent(laws.get(name).of(case), Bodies(MASS, VELOCITY), 1e-6) <= 45


@pytest.fixture
def spent(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    from lumped.solvers.point import phase

    count, solve = [0], phase.solved

    def counted(*args: Any, **kwargs: Any) -> Any:
        count[0] += 1
        return solve(*args, **kwargs)

    def solves(law: Any, bodies: Bodies, tolerance: float) -> int:
        motion(law, bodies, "force", 1, 1e3, tolerance)
        return count[0]

    monkeypatch.setattr(phase, "solved", counted)
    return solves


def test_a_contact_that_never_ends_says_so() -> None:
    case = scene("kelvin", xi=2.0, exit="depth")
    result = laws.get("kelvin").of(case).simulate(case, 1e-4)
    assert not result.separated
    assert result.quantities["restitution"].value is None
    assert "not separated" in result.message


def test_what_no_damping_can_give_is_bad_input() -> None:
    with pytest.raises(BadInput, match=r"law\.e.*accepted"):
        laws.get("kuwabara_kono").of(scene("kuwabara_kono", e=0.2, damping="series"))


STIFF = {"xi": 1e6, "c": 1e12, "chi": 1e6, "A": 1e6, "alpha_t": 1e6}


@pytest.mark.parametrize("exit", ["force", "depth"])
@pytest.mark.parametrize("name", [name for name in NAMES if set(STIFF) & set(laws.get(name).keys)])
def test_enormous_damping_ends_with_the_right_limit_or_says_why_not(name: str, exit: str) -> None:
    """Nothing comes back of the energy; where the tolerance is not reached the result says so."""
    for key in sorted(set(STIFF) & set(laws.get(name).keys)):
        case = scene(name, exit=exit, **{key: STIFF[key]})
        result = laws.get(name).of(case).simulate(case, 1e-3)
        assert result.converged or "not reached" in result.message
        assert abs(result.energy["residual"]) <= 1e-8 * result.energy["in"]
        e = result.quantities["restitution"].value
        assert e is None or 0.0 < e < 1e-2
        assert e is not None or "not separated" in result.message


@pytest.mark.parametrize("name", NAMES)
def test_extreme_scales_change_nothing_but_the_scale(name: str) -> None:
    damped = {"e": 0.6} if name in DAMPED else {}
    for k, mass, velocity in ((1e-3, 1e-12, 1e-6), (1e15, 1e-12, 1e3), (1e-3, 1e9, 1e3), (1e15, 1e9, 1e-6)):
        found = quantities(scene(name, mass, velocity, k=k, gap=1e-12, **damped), 1e-6)
        assert found["restitution"] == pytest.approx(damped.get("e", 1.0), abs=1e-9)


@pytest.mark.parametrize("exit", ["force", "depth"])
@pytest.mark.parametrize(("name", "key"), [("tsuji", "alpha_t"), ("kuwabara_kono", "A"), ("kelvin", "xi")])
def test_hardly_any_damping_hardly_loses_energy(name: str, key: str, exit: str) -> None:
    """The force ends just before the depth, where both are least smooth."""
    for damping in (0.0, 1e-12, 1e-7, 1e-4, 1e-2):
        case = scene(name, exit=exit, **{key: damping})
        energy = laws.get(name).of(case).simulate(case, 1e-2).energy
        assert abs(energy["residual"]) <= 1e-8 * energy["in"]


@pytest.mark.parametrize("name", NAMES)
def test_the_first_row_is_the_touch(name: str) -> None:
    history = laws.get(name).of(case := scene(name, **OWN[name])).simulate(case, 1e-3).history
    assert (history.time[0], history.depth[0], history.velocity[0]) == (0.0, 0.0, VELOCITY)


@pytest.mark.parametrize("alpha", [1.05, 1.3, 1.5])
def test_a_force_steep_at_touch_is_right_from_the_first_rows_on(alpha: float) -> None:
    """Tsuji's damper rises with the power (alpha - 1)/2 of the depth, which is v t there: shares of 1e-18 matter."""
    law = laws.get("tsuji").of(case := scene("tsuji", alpha=alpha, alpha_t=0.6))
    history = law.simulate(case, 1e-3).history
    early = (history.time > 0.0) & (history.time < 1e-12 * history.time[-1])
    expected = law.force(VELOCITY * history.time[early], VELOCITY, Stage(True, 0.0, VELOCITY))
    assert early.sum() > 10
    assert history.force[early] == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(
    ("name", "damping"), [("kelvin", {"c": 500.0}), ("hertzdamp", {"xi": 5.0}), ("tsuji", {"e": 0.1})]
)
def test_a_striker_come_to_rest_under_gravity_has_an_impulse(name: str, damping: dict[str, float]) -> None:
    """m (v + g t) by the end of the history, which the rows integrate to: the weight is borne after the rest too."""
    case = replace(scene(name, velocity=0.3, k=1e5, **damping), model=Model(gravity=9.81))
    result = laws.get(name).of(case).simulate(case, 1e-3)
    assert result.converged
    assert not result.separated
    history, impulse = result.history, result.quantities["impulse"].value
    assert impulse == pytest.approx(MASS * (0.3 + 9.81 * history.time[-1]), rel=1e-6)
    assert impulse == pytest.approx(np.trapezoid(history.force, history.time), rel=1e-4)


@pytest.mark.parametrize("lean", [-1.1, 0.4, 1.1])
@pytest.mark.parametrize("top", [0.02, 0.31, 0.5, 0.83, 0.98])
def test_the_peak_of_a_quartic_force_is_its_top(top: float, lean: float) -> None:
    away = FIVE - top
    assert _top(3.0 - away**2 * (2.0 + lean * away + 0.9 * away**2)) == pytest.approx((top, 3.0), rel=1e-12)


@pytest.mark.parametrize("force", [FIVE, FIVE**2, 1.0 - (1.2 - FIVE) ** 3, -((FIVE - 1.02) ** 4)])
def test_a_force_that_only_rises_or_falls_peaks_at_an_end(force: np.ndarray) -> None:
    for place, values in ((1.0, force), (0.0, force[::-1])):
        assert _top(values) == pytest.approx((place, force[-1]), abs=1e-13)


@dataclass(frozen=True)
class Hardening(PointLaw):
    """F = k depth^3 + rate: it jumps to the velocity at touch, falls, and rises again."""

    k: float
    tensile = True

    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        return self.k * depth**3 + rate

    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        return 3.0 * self.k * depth**2, 1.0 + 0.0 * rate

    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
        return rate

    def stored(self, depth: float, stage: Stage) -> float:
        return self.k * depth**4 / 4.0

    def time_scale(self, bodies: Bodies) -> float:
        return 1.0


def test_a_force_that_jumps_at_touch_peaks_there_if_what_follows_is_hardly_lower() -> None:
    """The point where the force of the first step is told first is lower than the second hump already."""
    law = Hardening(5.08)
    track = PointTrack(law, motion(law, Bodies(1.0, 1.0, 0.0), "force", 1, 100.0, 1e-5))
    later = track(np.linspace(0.2, 1.5, 2001))[2].max()
    assert track.motion.contacts[0].phases[0].steps[0].force[0] < later < 1.0
    assert peak_of(track, track.motion.contacts[0]) == pytest.approx((0.0, 1.0), abs=1e-14)


@pytest.mark.parametrize("velocity", [1e-3, 1.0, 1e3])
def test_bounces_are_followed_until_they_count_as_at_rest_beside_the_first_one(velocity: float) -> None:
    """On spring and dashpot each leaves with one share of the last one's speed, down to 1e-6 of the first one's."""
    e, bodies = 0.15, Bodies(MASS, velocity, 1e-9 * velocity)
    law = laws.get("kelvin").of(scene("kelvin", velocity=velocity, e=e))
    found = motion(law, bodies, law.exit, 20, math.inf, 1e-8).contacts
    assert [one.first.rate / velocity for one in found] == pytest.approx([e**n for n in range(8)], rel=1e-5)


def test_what_a_motion_does_not_reach_is_no_contact() -> None:
    """Nothing follows a striker that rests, nor a touch that would come after the end."""
    heavy = laws.get("kelvin").of(scene("kelvin", k=1e5, c=500.0))
    (resting,) = motion(heavy, Bodies(MASS, 0.3, 9.81), heavy.exit, 3, math.inf, 1e-8).contacts
    assert resting.end is End.REST
    law, bodies = laws.get("hertz").of(scene("hertz")), Bodies(MASS, VELOCITY, 9.81)
    _, second = motion(law, bodies, law.exit, 2, math.inf, 1e-8).contacts
    for until, ends in ((0.999, [End.SEPARATED]), (1.0001, [End.SEPARATED, End.TIME])):
        found = motion(law, bodies, law.exit, 3, until * second.start_time, 1e-8).contacts
        assert [one.end for one in found] == ends


@pytest.mark.parametrize("exit", ["force", "depth"])
@pytest.mark.parametrize("name", ["hertzdamp", "hunt_crossley", "khatiwada"])
def test_a_law_pulls_a_striker_that_a_weight_draws_back_only_where_it_ends_with_the_depth(name: str, exit: str) -> None:
    """Faster than chi allows: against an independent integration of F = k d^alpha (1 + chi d') to its own end."""
    damping, alpha, weight = 5.0, 1.2, -0.05 * VELOCITY * math.sqrt(K / MASS)
    own = {
        "hertzdamp": {"xi": damping},
        "hunt_crossley": {"chi": damping / VELOCITY},
        "khatiwada": {"c": damping * K / VELOCITY},
    }
    case = replace(scene(name, alpha=alpha, exit=exit, **own[name]), model=Model(gravity=weight))
    result = laws.get(name).of(case).simulate(case, 1e-6)

    def rates(time: float, y: np.ndarray) -> list[float]:
        force = K * max(y[0], 0.0) ** alpha * (1.0 + damping * y[1] / VELOCITY)
        return [y[1], weight - force / MASS, force]

    def left(time: float, y: np.ndarray) -> float:
        pushes = 1.0 + damping * y[1] / VELOCITY if exit == "force" else math.inf
        return float(min(y[0] + 1e-30, pushes)) if time > 0.0 else 1.0

    left.terminal, left.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(
        rates, (0.0, 1.0), [0.0, VELOCITY, 0.0], "DOP853", events=left, rtol=1e-12, atol=1e-16, max_step=1e-5
    )
    end, (depth, rate, impulse) = float(found.t[-1]), found.y[:, -1]
    assert (depth > 1e-3 * found.y[0].max()) == (exit == "force")
    assert result.quantities["duration"].value == pytest.approx(end, rel=1e-8)
    assert result.quantities["restitution"].value == pytest.approx(-rate / VELOCITY, abs=1e-8)
    assert result.quantities["impulse"].value == pytest.approx(impulse, rel=1e-8)
    least = float(result.history.force.min())
    assert least >= 0.0 if exit == "force" else least < -1e-4 * result.history.force.max()
