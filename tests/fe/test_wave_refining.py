"""Impacts with waves: steps about an early peak, a force read through chatter, and no more refined than is missing."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import linalg

import meshes
from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import SETTING
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import EARLY_PEAK
from fe_contact.budget.refine import AIM, factors, missing
from fe_contact.settings import RANGES
from fe_contact.steppers.steps import March, Strike, Work
from fe_contact.waves.certify import (
    AT,
    GROWTH,
    ORDER,
    ROWS,
    Moved,
    WaveRuns,
    certify,
    curve_of,
    reading,
    tells_of_mesh,
)
from fe_contact.waves.plan import graded, viscous_share
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import moving
from lumped import Scene
from lumped.materials import Relaxation

ROOMY = dict.fromkeys(ORDER, math.inf)
MOST = {cause: growth.most for cause, growth in GROWTH.items()}


def test_steps_are_short_about_an_early_peak_and_grow_with_the_time_since_touch() -> None:
    rng = np.random.default_rng(7)
    for share, steps in zip(10 ** rng.uniform(-6, 0, 200), rng.integers(8, 2000, 200), strict=True):
        first, doubled = graded(settings(contact_time=3.0, steps=int(steps), peak_share=float(share)))
        last = first * 2 ** len(doubled)
        assert last == pytest.approx(3.0 / steps)
        assert first <= 3.0 * min(share / EARLY_PEAK, 1.0) / steps * (1 + 1e-12)
        for number, at in enumerate(doubled, start=1):  # as many steps from touch to each time
            assert at / (first * 2**number) == pytest.approx(EARLY_PEAK * steps)


def settings(**given: Any) -> Any:
    return SimpleNamespace(**{"tolerance": 3e-3, "peak_share": 0.5, "steps": 320, "follows_echoes": False} | given)


def impact(steps: int, chatter: float, ended: float = 1.0) -> tuple[March, Strike]:
    """Force [t (T - t)]^(3/2), largest one, and chatter of some steps' period."""
    time = ended * np.linspace(0.0, 1.0, steps + 1)
    fine = ended * np.linspace(0.0, 1.0, 40 * steps + 1)
    swings = chatter * np.sin(2 * np.pi * 97.0 * fine / ended) * (fine > 0.1 * ended) * (fine < 0.9 * ended)
    force = wanted(fine / ended) + swings
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(fine))])[::40]
    march = March(
        time=time,
        depth=time * (1.2137 * ended - time),
        impulse=impulse,
        radius_time=time[1:-1],
        radius=np.sqrt(time[1:-1] * (1.2137 * ended - time[1:-1])),
        separated=True,
        photograph=tuple,
        energy={},
        first_force=0.0,
        end_spread=0.0,
        work=Work(),
    )
    return march, Strike(lambda r: r**2, 1.0, 0.5, 0.0, Relaxation(1.0), 10.0)


def wanted(share: Array) -> Array:
    return np.asarray((4.0 * share * (1.0 - share)) ** 1.5)


@pytest.mark.parametrize("steps", [320, 640, 1111])
def test_a_force_is_read_through_chatter(steps: int) -> None:
    """Half a per cent of it, of a period that the steps just see; without it within the bar of the reading."""
    calm, strike = impact(steps, 0.0)
    curve = curve_of(calm, strike, settings(steps=steps))
    off = np.abs(curve.dense_force - wanted(curve.shares))
    assert off.max() < 2e-4
    assert (off <= reading(calm, strike, settings(steps=steps)).force(curve.dense_time) + 1e-5).all()
    few = settings(steps=steps, tolerance=0.1)
    coarse = curve_of(calm, strike, few)
    off = np.abs(coarse.dense_force - wanted(coarse.shares))
    assert off.max() > 2e-4
    assert (off <= reading(calm, strike, few).force(coarse.dense_time)).all()
    noisy = curve_of(impact(steps, 5e-3)[0], strike, settings(steps=steps))
    within = (noisy.shares > 0.2) & (noisy.shares < 0.8)
    left = np.abs(noisy.dense_force - wanted(noisy.shares))[within]
    assert np.sqrt(np.mean(left**2)) < 1e-3
    assert noisy.quantities["peak_force"] == pytest.approx(1.0, abs=1e-3)


def test_a_smaller_tolerance_keeps_more_rows() -> None:
    march, strike = impact(640, 0.0)
    rows = [len(curve_of(march, strike, settings(steps=640, tolerance=t)).x) for t in (AT, 1e-4)]
    assert ROWS + 1 == rows[0] < rows[1] < 640, "both ends of so many intervals"
    assert len(curve_of(march, strike, settings(steps=640), 0.5).x) == ROWS // 2 + 1


def test_only_what_is_missing_is_refined_and_the_cheapest_first() -> None:
    """Shares of the tolerance, by two quantities."""
    small = {"mesh": [0.3, 0.1], "penalty": [0.35, 0.0], "time_step": [0.36, 0.1], "far_field": [0.0, 0.0]}
    chosen = factors({cause: np.array(share) for cause, share in small.items()}, GROWTH, ROOMY)
    assert chosen == {"mesh": 1.0, "penalty": 2.0, "time_step": 1.0, "far_field": 1.0}
    alone = {"mesh": [1.01], "penalty": [0.0], "time_step": [0.0], "far_field": [0.0]}
    chosen = factors({cause: np.array(share) for cause, share in alone.items()}, GROWTH, ROOMY)
    assert 1.0 < chosen.pop("mesh") < 1.2
    assert set(chosen.values()) == {1.0}


def test_bars_are_predicted_to_hold_or_there_is_no_room_left() -> None:
    rng = np.random.default_rng(5)
    for _ in range(200):
        shares = {cause: 10 ** rng.uniform(-4, 1, 6) for cause in ORDER}
        room = {cause: float(rng.choice([1.0, MOST[cause]])) for cause in ORDER}
        chosen = factors(shares, GROWTH, room)
        assert all(1.0 <= chosen[cause] <= room[cause] for cause in ORDER)
        bars = np.sum([shares[cause] / chosen[cause] ** ORDER[cause] for cause in ORDER], axis=0)
        full = all(chosen[cause] * GROWTH[cause].step > room[cause] for cause in ORDER)
        assert bars.max() <= AIM or full
        least = np.sum([shares[cause] for cause in ORDER], axis=0).max()
        assert least > AIM or set(chosen.values()) == {1.0}


def test_what_could_not_be_varied_is_refined_as_far_as_there_is_room() -> None:
    shares = {cause: np.array([np.inf if cause == "mesh" else 0.1]) for cause in ORDER}
    chosen = factors(shares, GROWTH, MOST)
    assert chosen["mesh"] == pytest.approx(MOST["mesh"])


def test_what_the_user_chose_is_not_refined() -> None:
    numerics = half_space.plan(Scene.load("steel-ball-waves"), {}).numerics
    shares = {cause: np.array([10.0]) for cause in ORDER}
    for cause, key in SETTING.items():
        finer = missing(shares, GROWTH, numerics, {key})
        assert getattr(finer, key) == getattr(numerics, key)
        assert all(getattr(finer, SETTING[one]) > getattr(numerics, SETTING[one]) for one in ORDER if one != cause)
    assert missing(shares, GROWTH, numerics, set(SETTING.values())) == numerics


def test_refined_settings_are_whole_where_they_count_and_never_out_of_range() -> None:
    """As a user could give them: each may be 1.2 times as large, and no more; of steps there may be twice as many."""
    numerics = half_space.plan(Scene.load("steel-ball-waves"), {}).numerics
    most = {key: RANGES[key][1] for key in SETTING.values()}
    near = numerics.varied(**{key: value / 1.2 for key, value in most.items()} | {"steps": int(most["steps"] / 2.1)})
    finer = missing({cause: np.array([10.0]) for cause in ORDER}, GROWTH, near, ())
    assert isinstance(finer.steps, int)
    assert finer.steps > near.steps
    assert all(getattr(finer, key) <= value for key, value in most.items())


@pytest.mark.tenth
def test_twice_the_steps_take_one_march_more() -> None:
    scene = Scene.load("steel-ball-waves")
    numerics = half_space.plan(scene, {"elements_per_contact": 3.0, "steps": 48, "tolerance": 0.05}).numerics
    runs = WaveRuns(scene, Strike.of(scene), moving, 24)
    first = certify(runs, numerics)
    assert first.work.marches == 5
    second = certify(runs, numerics.varied(steps=96))
    assert second.work.marches == 6
    assert second.work.steps > first.work.steps
    assert second.error("peak_force", "mesh") <= 1.5 * first.error("peak_force", "mesh")
    assert second.error("duration", "time_step") < first.error("duration", "time_step")


def test_dashpots_are_told_from_springs_by_the_time_there_is() -> None:
    assert viscous_share(Relaxation(2.0), 1.0) == 0.0
    assert viscous_share(Relaxation(2.0, viscosity=3.0), 0.5) == pytest.approx(6.0 / 8.0)
    shares = [viscous_share(Relaxation(0.0, (5.0,), (tau,)), 1.0) for tau in (1e6, 1.0, 1e-6)]
    assert shares[0] < 1e-5
    assert 0.1 < shares[1] < 0.9
    assert shares[2] > 1 - 1e-5


@pytest.mark.parametrize("kind", ["half_space", "layer"])
def test_a_finer_surface_leaves_the_body_as_coarse(kind: str) -> None:
    made = {
        "half_space": lambda finer: meshes.half_space_for_waves(6.0, 0.1, 100.0, finer),
        "layer": lambda finer: meshes.layer_for_waves(6.0, 0.1, 1.0, 8.0, finer),
    }[kind]
    one, two = made(1.0), made(2.0)
    touched = [np.count_nonzero((mesh.p[1] == 0.0) & (mesh.p[0] <= 1.0)) for mesh in (one, two)]
    assert touched[1] / touched[0] == pytest.approx(2.0, abs=0.25)
    assert two.p.shape[1] < 2.5 * one.p.shape[1]


@pytest.mark.tenth
def test_counted_factorisations_are_those_of_every_length_of_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Counted from outside; a body that nothing moves yet needs none of its mass."""
    made, factorise = [0], linalg.splu

    def counted(*args: Any, **options: Any) -> Any:
        made[0] += 1
        return factorise(*args, **options)

    monkeypatch.setattr(linalg, "splu", counted)
    scene = Scene.load("steel-ball-waves")
    coarse = {"elements_per_contact": 3.0, "steps": 40, "far_radius": 4.0, "penalty": 20.0}
    numerics = half_space.plan(scene, coarse).numerics.varied(peak_share=0.05)
    assert len(graded(numerics)[1]) > 1
    runs = WaveRuns(scene, Strike.of(scene), moving, 20)
    certify(runs, numerics)
    work = runs.work()
    assert work.marches == 5
    assert made[0] == work.factorizations > 3 * work.marches
    assert runs.curve(1, numerics) is None, "there is no second contact"


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_every_mesh_that_is_accepted_is_judged_by_one_that_can_be_made(order: int) -> None:
    low, high = RANGES["elements_per_contact"]
    numerics = half_space.plan(Scene.load("steel-ball-waves"), {"order": order}).numerics
    for elements in np.geomspace(low, high, 12):
        other, _ = tells_of_mesh(numerics.varied(elements_per_contact=float(elements)))
        meshes.half_space_for_waves(other.elements_per_contact, 0.5, 2.0)


@pytest.mark.tenth
def test_a_mesh_of_few_nodes_is_judged_by_one_that_does_not_err_alike_by_chance() -> None:
    """Ten or twelve of them along the contact radius: against one of 36, half as many miss the error."""
    scene = Scene.load("steel-ball-waves")
    numerics = half_space.plan(scene, {"steps": 64, "tolerance": 0.1, "order": 4}).numerics
    runs = WaveRuns(scene, Strike.of(scene), moving, 32)

    def curve(**changes: float) -> Curve:
        found = runs.curve(0, numerics.varied(**changes))
        assert found is not None
        return found

    truth = curve(elements_per_contact=9.0).quantities
    for elements in (2.5, 3.0):
        few = curve(elements_per_contact=elements)
        other, trusted = tells_of_mesh(numerics.varied(elements_per_contact=elements))
        bars = Moved(few, curve(elements_per_contact=other.elements_per_contact), trusted).errors
        for name, value in few.quantities.items():
            assert abs((value or 0.0) - (truth[name] or 0.0)) <= bars[name], (elements, name)
