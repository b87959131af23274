"""Bars of force laws where time is long or short beside a contact: after flights, at rest, soon after touch.

And where a faint damper, or a loop that hardly yields, leaves little to be seen.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lumped import Model, Motion, Result, Scene, laws
from lumped.laws.impact_bilinear import ImpactBilinear
from lumped.numbers import Array
from lumped.scene.tables import LawChoice


def result(
    name: str, tolerance: float, mass: float = 1.0, velocity: float = 1.0, gravity: float = 0.0, **given: float | str
) -> Result:
    """Of a law with its own numbers; `impacts` and `end_time` are the motion's."""
    motion = Motion(**{key: given.pop(key) for key in ("impacts", "end_time") if key in given})
    scene = Scene(None, mass, velocity, law=LawChoice(name, given), model=Model(gravity=gravity), motion=motion)
    return laws.get(name).of(scene).simulate(scene, tolerance)


def held(found: Result, truth: Array, rows: Array) -> None:
    """The force of these rows is the true one within its bar."""
    history = found.history
    assert float(np.max(np.abs(history.force[rows] - truth) / history.force_error[rows])) <= 1.0


@pytest.mark.parametrize(
    ("name", "own"),
    [
        ("tsuji", {"k": 740.0, "alpha_t": 0.85, "mass": 26.3, "velocity": 0.2055, "gravity": 0.0795, "exit": "depth"}),
        (
            "kuwabara_kono",
            {"k": 1.461e7, "A": 0.01755, "mass": 1.539, "velocity": 0.0040035, "gravity": 4.5857e-4, "impacts": 3},
        ),
    ],
)
def test_what_has_come_to_rest_is_borne_with_its_weight(name: str, own: dict[str, float]) -> None:
    """After so long a rest the norm of the history is that of the weight: it must be known as well as the norm is."""
    found = result(name, 1e-4, **own)
    assert found.message.startswith("not separated: the striker came to rest")
    weight = own["mass"] * own["gravity"]
    assert abs(found.history.force[-1] - weight) <= (found.quantities["history_l2"].error or 0.0) * weight


@pytest.mark.parametrize(
    ("mass", "k", "velocity", "chi"), [(30.65, 217.74, 0.033, 4.2e-7), (5.4e-4, 1529.0, 0.0128, 4e-6)]
)
def test_a_faint_damper_lets_the_force_turn_before_the_motion(
    mass: float, k: float, velocity: float, chi: float
) -> None:
    """F = k d^(3/2) (1 + chi d') is highest where (3/2) d' (1 + chi d') + chi d d'' = 0, chi d/(3/2) before it."""

    def moving(_: float, state: Array) -> list[float]:
        depth, rate = max(state[0], 0.0), state[1]
        return [rate, -k * depth**1.5 * (1.0 + chi * rate) / mass]

    def rising(time: float, state: Array) -> float:
        rate = state[1]
        return float(1.5 * rate * (1.0 + chi * rate) + chi * state[0] * moving(time, state)[1])

    rising.direction = -1.0  # type: ignore[attr-defined]
    elastic = (1.25 * mass / k * velocity**2) ** 0.4 / velocity
    solved = solve_ivp(
        moving,
        (0.0, 2.0 * elastic),
        (0.0, velocity),
        "DOP853",
        events=rising,
        rtol=3e-14,
        atol=1e-18,
        max_step=0.01 * elastic,
    )
    told = result("hunt_crossley", 1e-3, mass, velocity, k=k, alpha=1.5, chi=chi).quantities["peak_time"]
    assert abs((told.value or 0.0) - solved.t_events[0][0]) <= (told.error or 0.0)


@pytest.mark.parametrize(
    ("rate", "gravity", "impacts"),
    [(1e3, 1e-2, 8), (1e3, 1e-4, 2), (97347.38, 1e-3, 2), (97347.38, 1e-7, 2), (310.0, 1e-8, 4), (1e3, 1e-6, 4)],
)
def test_a_force_after_long_flights_is_known_as_well_as_its_time(rate: float, gravity: float, impacts: int) -> None:
    """A spring under a faint weight, in closed form: every contact is the first one again, but the digits of a time
    are those of all that has passed.
    """
    found = result("linear_spring", 1e-3, gravity=gravity, k=rate**2, impacts=impacts)
    g, omega = np.longdouble(gravity), np.longdouble(rate)
    swing = 2.0 * (np.longdouble(math.pi) + np.longdouble(1.2246467991473532e-16) - np.arctan2(omega, g)) / omega
    last = (impacts - 1) * (swing + 2.0 / g)
    since = found.history.time.astype(np.longdouble) - last
    rows = np.flatnonzero((since > 1e-3 * swing) & (since < 0.999 * swing))
    assert rows.size > 4
    truth = omega * np.sin(omega * since[rows]) + g * (1.0 - np.cos(omega * since[rows]))
    held(found, truth.astype(float), rows)


@pytest.mark.parametrize(
    ("k2", "yield_depth"), [(6.2195630845e-2, 1.7962271768e-4), (1e-3, 1e-4), (1e-4, 1e-5), (1e-2, 3e-5)]
)
def test_a_stiff_loop_unloads_a_deep_dent_as_its_depth_is_known(k2: float, yield_depth: float) -> None:
    """Loading, yielding and unloading in closed form: deep in, a digit of depth or time is many of the force."""
    mass, velocity, k1 = 11.307, 0.58988, 889.0
    found = result("impact_bilinear", 1e-6, mass, velocity, k1=k1, k2=k2, yield_depth=yield_depth)
    m, v, stiff, soft, most = (np.longdouble(x) for x in (mass, velocity, k1, k2, yield_depth))
    fast, slow, held_back = np.sqrt(stiff / m), np.sqrt(soft / m), (stiff - soft) * most
    yields = np.arcsin(most * fast / v) / fast
    rate = v * np.cos(fast * yields)
    centre = held_back / soft
    turns = yields + np.arctan2(rate / slow, most + centre) / slow
    deepest = np.hypot(most + centre, rate / slow) - centre
    peak = soft * deepest + held_back
    since = found.history.time.astype(np.longdouble) - turns
    ends = np.arccos(1.0 - held_back / peak * stiff / (stiff - soft)) / fast
    rows = np.flatnonzero((since > 0.0) & (since < 0.99 * ends))
    assert rows.size > 4
    held(found, (peak * np.cos(fast * since[rows])).astype(float), rows)


def test_what_is_cut_soon_after_touch_has_a_bar_of_its_own() -> None:
    """Two marches of the same step would agree. Kuwabara and Kono's force in sqrt(depth), where it is smooth."""
    k, damping, end, weight = 1.0, 0.5, 0.02, 1e-3

    def moving(_: float, state: Array) -> list[float]:
        s, rate, _ = state
        return [rate, 2.0 * s * (weight - k * s * (s * s + 1.5 * damping * rate)), 2.0 * s]

    solved = solve_ivp(
        moving, (0.0, 0.5), (0.0, 1.0, 0.0), "DOP853", rtol=3e-14, atol=1e-16, max_step=1e-4, dense_output=True
    )
    found = result("kuwabara_kono", 1e-3, k=k, A=damping, impacts=2, end_time=end, gravity=weight)
    time = found.history.time
    places = np.array([np.interp(one, solved.y[2], solved.t) for one in time])
    for _ in range(4):  # Newton's, for the place of a time
        s, rate, at = solved.sol(places)
        places = np.where(s > 0.0, places - (at - time) / np.maximum(2.0 * s, 1e-300), places)
    s, rate, _ = solved.sol(places)
    rows = np.flatnonzero(time > 1e-6 * end)
    held(found, k * (s**3 + 1.5 * damping * s * rate)[rows], rows)


def test_flights_however_long_leave_every_impact_its_restitution() -> None:
    """Of a flat punch, whose load is straight: nothing goes by the clock, rounded to more than a share of a contact."""
    scene = Scene.from_dict(
        {
            "striker": {"shape": "punch", "radius": 0.01, "mass": 1.0, "velocity": 0.1},
            "target": {"shape": "half_space", "material": {"law": "sls", "E0": 1e6, "R1": 0.5, "R2": 0.01, "nu": 0.45}},
            "model": {"gravity": 1e-9},
            "motion": {"impacts": 4},
            "law": {"name": "correspondence", "memory": "reset"},
        },
        "punch.toml",
    )
    found = laws.get("correspondence").of(scene).simulate(scene, 1e-2)
    speeds = np.array([one["velocity"] for one in found.contacts])
    assert found.contacts[-1]["start"] > 1e9 * (found.quantities["duration"].value or math.inf)
    assert speeds[1:] / speeds[:-1] == pytest.approx(found.quantities["restitution"].value, rel=1e-9)


def loop_left(law: ImpactBilinear, mass: float, velocity: float) -> tuple[float, float]:
    """Duration, s, and restitution of one impact on a loop that yields, in long numbers: four arcs of sines."""
    k1, k2, yields, m, v = map(np.longdouble, (law.k1, law.k2, law.yield_depth, mass, velocity))
    held, steep, soft = (k1 - k2) * yields, np.sqrt(k1 / m), np.sqrt(k2 / m)
    after = np.sqrt((v - yields * steep) * (v + yields * steep))
    deeper = m * after**2 / (k1 * yields + np.sqrt((k1 * yields) ** 2 + k2 * m * after**2))
    force = k2 * (yields + deeper) + held
    back = np.sqrt((2.0 * force - k1 * yields) * yields / m)
    times = (
        np.arcsin(yields * steep / v) / steep,
        np.arctan2(after / soft, yields + held / k2) / soft,
        np.arctan2(back / steep, force / k1 - yields) / steep,
        np.arctan2(deeper * soft, back) / soft,
    )
    return float(sum(times)), float(np.hypot(back, soft * deeper) / v)


@pytest.mark.parametrize("e", np.geomspace(1e-4, 4e-3, 6))
def test_a_loop_that_gives_hardly_anything_back_is_known_to_its_own_digits(e: float) -> None:
    """It unloads within a 1/e^2-th of its depth: a digit of the depth is many of the speed with which it is left."""
    law = {"name": "impact_bilinear", "e": float(e), "k": 1e6, "alpha": 2.2}
    motion = {"impacts": 2, "end_time": 1e3}
    scene = Scene.from_dict({"striker": {"mass": 3.0, "velocity": 0.7}, "law": law, "motion": motion})
    own = laws.get("impact_bilinear").of(scene)
    assert isinstance(own, ImpactBilinear)
    found, truth = own.simulate(scene, 1e-3).quantities, loop_left(own, 3.0, 0.7)
    for name, true in zip(("duration", "restitution"), truth, strict=True):
        assert abs((found[name].value or 0.0) - true) <= (found[name].error or 0.0), name
    assert (found["duration"].error or 1.0) < 1e-6 * truth[0]


@pytest.mark.parametrize("gravity", [1e-2, 1e-3, 1e-4])
def test_a_jump_at_a_touch_after_a_long_flight_may_come_as_late_as_that_is_rounded(gravity: float) -> None:
    """Of a dashpot beside a spring; its swing about the depth at rest, and the flight, in long numbers."""
    w, share = np.longdouble(1e3), np.longdouble(0.1)
    rest, damped, turning = gravity / w**2, share * w, w * np.sqrt(1.0 - share**2)
    slope = (1.0 - damped * rest) / turning  # depth = rest + exp(-damped t) (slope sin - rest cos)

    def swing(time: np.longdouble) -> tuple[np.longdouble, np.longdouble]:
        sine, cosine, faded = np.sin(turning * time), np.cos(turning * time), np.exp(-damped * time)
        depth = rest + faded * (slope * sine - rest * cosine)
        rate = -damped * (depth - rest) + faded * turning * (slope * cosine + rest * sine)
        return depth, rate

    end = np.longdouble(np.pi) / turning
    for _ in range(6):  # Newton
        end -= swing(end)[0] / swing(end)[1]
    leaving = -swing(end)[1]
    touch = end + 2.0 * leaving / gravity
    found = result("kelvin", 1e-3, k=1e6, xi=0.1, exit="depth", gravity=gravity, impacts=2)
    late = abs(float(found.contacts[1]["start"] - touch))
    jump = 2.0 * float(damped * leaving)
    norm = math.sqrt(np.trapezoid(found.history.force**2, found.history.time))
    assert math.sqrt(late) * jump / norm <= found.quantities["history_l2"].error


def test_flights_tell_nothing_of_the_bars_of_contacts() -> None:
    """Three contacts of a spring with flights 1e8 times as long between them: each peaks at m g + v sqrt(k m)."""
    found = result("linear_spring", 1e-3, k=1e6, velocity=10.0, gravity=1e-4, impacts=3)
    peak = found.quantities["peak_force"]
    assert abs((peak.value or 0.0) - 1e4 - 1e-4) <= (peak.error or 0.0) < 1e-2


def test_a_mass_that_hardly_moves_upon_a_soft_spring_is_followed() -> None:
    """An event may fall on the beginning of a step."""
    law = {"name": "hertzdamp", "k": 1e-3, "e": 0.1}
    scene = Scene.from_dict({"striker": {"mass": 1e6, "velocity": 1e-6}, "law": law, "model": {"gravity": 9.81}})
    assert laws.get("hertzdamp").of(scene).simulate(scene, 1e-6).history.force.max() > 0.0
