"""Corners of the numbers a user may give: every law ends with the right limit, or says by name why not."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lumped import Material, Model, Motion, Relaxation, Scene, laws
from lumped.errors import BadInput, TooManySteps
from lumped.laws import correspondence, ting
from lumped.laws._hereditary import once
from lumped.result.history import End
from lumped.scene.tables import LawChoice
from lumped.shapes.power import PowerProfile
from lumped.solvers.point import contact
from lumped.solvers.point.bodies import Bodies, PointLaw, Stage, State
from lumped.targets.layer import Layer

NAMES = [name for name in laws.available() if "k" in laws.get(name).keys]
DAMPINGS = ("xi", "c", "chi", "A", "alpha_t")
# Each law has this many impacts in the whole campaign.
CASES = 60


def corner(rng: np.random.Generator, name: str) -> Scene:
    """Stiffness, mass, speed and damping over decades; a gap hardly there; either exit; gravity, or none, that changes
    the speed by a tenth within the contact.
    """
    keys = laws.get(name).keys
    values: dict[str, Any] = {"k": 10.0 ** rng.uniform(-3.0, 15.0), "exit": str(rng.choice(["force", "depth"]))}
    values["gap"] = float(rng.choice([0.0, 1e-12]))
    if "alpha" in keys:
        values["alpha"] = float(rng.uniform(1.0, 5.0))
    damping = [key for key in DAMPINGS if key in keys]
    if "e" in keys and (not damping or rng.random() < 0.5):
        values["e"] = float(rng.choice([0.01, 0.999, rng.uniform(0.01, 0.999)]))
    elif damping:
        values[str(rng.choice(damping))] = 10.0 ** rng.uniform(-12.0, 6.0)
    mass, velocity = 10.0 ** rng.uniform(-12.0, 9.0), 10.0 ** rng.uniform(-6.0, 3.0)
    scene = Scene(None, mass, velocity, law=LawChoice(name, values))
    lasting = laws.get(name).of(scene).elastic_contact_time(scene)
    gravity = min(float(rng.choice([0.0, 0.1])) * velocity / lasting, 1e6)
    # what gravity holds may swing for ever
    end_time = 10.0 * lasting if gravity else min(1e6 * lasting, 1e12)
    return replace(scene, model=Model(gravity=gravity), motion=Motion(end_time=end_time))


@pytest.mark.tenth
@pytest.mark.parametrize("name", NAMES)
def test_every_corner_ends_or_says_why_not(name: str, campaign_size: Callable[[int], int]) -> None:
    rng = np.random.default_rng(len(name))
    for _ in range(campaign_size(CASES)):
        scene = corner(rng, name)
        law = laws.get(name).of(scene)
        try:
            result = law.simulate(scene, 1e-3)
        except TooManySteps:  # a named end too; no other error is
            continue
        assert result.converged or result.message, scene
        assert np.isfinite(result.history.force).all()
        e, energy = result.quantities["restitution"].value, result.energy
        turned_over = energy["in"] + scene.mass * scene.gravity * result.history.depth.max()
        assert abs(energy["residual"]) <= 1e-6 * turned_over, scene
        # what has not yet climbed out of its dent under gravity may be faster than it came, not richer
        assert e is None or e >= 0.0, scene
        assert energy["out"] <= energy["in"] * (1.0 + 1e-9), scene
        if e is not None and not scene.gravity and "e" in scene.law.values:
            assert e == pytest.approx(scene.law.values["e"], abs=1e-6), scene


def test_a_weight_far_above_the_impact_is_followed_to_its_end() -> None:
    """It turns and would part within the very first piece of a rough march, which tries depths below the layer."""
    soft = Material(Relaxation(2.29e6, (1.79e6, 2.01e6), (5.7e-3, 2.34e-2)), 0.49)
    blunt, layer = PowerProfile(2316.7, 2.615), Layer(1.524e-4, "sliding")
    scene = Scene(blunt, 0.18423, 8.179e-5, soft, target=layer, model=Model(gravity=9.81))
    result = correspondence.of(scene).simulate(scene, 1e-4)
    assert 0.0 < result.history.depth.max() < 0.5 * layer.thickness
    turned_over = scene.mass * scene.gravity * result.history.depth.max()
    assert abs(result.energy["residual"]) <= 1e-4 * turned_over
    duration, change = result.history.time[-1], result.history.velocity[0] - result.history.velocity[-1]
    impulse = scene.mass * (scene.gravity * duration + change)
    assert result.quantities["impulse"].value == pytest.approx(impulse, rel=1e-4)


@pytest.mark.tenth
def test_a_weight_at_rest_is_followed_until_any_time() -> None:
    """Where accelerations are rounding, pieces are as long as they like: work grows with the time's logarithm."""
    solid, layer = Material(Relaxation(6e5, (1.2e6,), (6.7e-3,)), 0.45), Layer(2e-3, "bonded")
    scene = Scene(PowerProfile(83.0, 2.0), 0.05, 1e-3, solid, target=layer, model=Model(gravity=9.81))
    work = []
    for end in (1.0, 1e6, 1e12):
        result = correspondence.of(scene).simulate(replace(scene, motion=Motion(end_time=end)), 1e-3)
        assert result.history.force[-1] == pytest.approx(scene.mass * scene.gravity, rel=1e-6)
        work.append(result.work["force_evaluations"])
    assert max(work) < 10 * work[0]


def test_a_weight_that_swings_for_ever_is_followed_to_the_time_that_its_failure_names(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A loop of two stiffnesses far apart soon yields no more: then it swings by the stiffer one and loses nothing."""
    monkeypatch.setattr(contact, "MOST_TURNS", 300)
    mass, velocity, gravity, k1 = 17.5, 5.12, 100.0, 2.97e8
    loop = {"k1": k1, "k2": k1 / 23000.0, "yield_depth": 8.4e-6}
    scene = Scene(None, mass, velocity, law=LawChoice("impact_bilinear", loop), model=Model(gravity=gravity))
    law = laws.get("impact_bilinear").of(scene)
    with pytest.raises(TooManySteps, match="turns without separation") as failure:
        law.simulate(scene, 1e-3)
    cure = re.search(r"motion\.end_time of at most (\S+) s", str(failure.value))
    assert cure
    result = law.simulate(replace(scene, motion=Motion(end_time=float(cure[1]))), 1e-3)
    assert result.converged
    assert result.message == End.TIME.value
    late = result.history.time > 0.5 * result.history.time[-1]
    assert np.ptp(result.history.depth[late]) < loop["yield_depth"]
    swing = 2.0 * np.pi * np.sqrt(mass / k1)
    assert result.history.time[-1] > 120.0 * swing, "two turns a swing, but for a fifth at most"


def test_a_weight_that_breaks_through_its_layer_is_named() -> None:
    """The striker would pass its whole thickness."""
    layer = Layer(1.524e-4, "sliding")
    scene = Scene(PowerProfile(2316.7, 2.615), 0.18423, 1.0, Material(Relaxation(1e5), 0.49), target=layer)
    with pytest.raises(BadInput, match="below the layer's thickness"):
        correspondence.estimate(scene)


@pytest.mark.parametrize("stiff", [1.46615438830300e14, 3e15])
def test_a_branch_without_time_is_a_dashpot_at_its_cost(stiff: float) -> None:
    """A pace that is balanced by forces of 1e8 times its own is known to their rounding, no better."""
    block, spring, viscosity = Scene.load("polymer-prism-waves"), 1.8e6, 1.8e4
    fast, none = Relaxation(spring, (stiff,), (viscosity / stiff,)), Relaxation(spring, viscosity=viscosity)
    scenes = [replace(block, material=Material(young, 0.45), model=Model()) for young in (fast, none)]
    branch, dashpot = (ting.of(scene).simulate(scene, 1e-3) for scene in scenes)
    assert branch.work["force_evaluations"] < 3 * dashpot.work["force_evaluations"]
    for name in ("duration", "restitution", "impulse"):
        found, expected = branch.quantities[name].value, dashpot.quantities[name].value
        assert found == pytest.approx(expected, rel=1e-5), name


def test_a_pull_far_above_the_force_leaves_it_all_its_digits() -> None:
    """The load at the depth to which gravity lets it come, times the modulus of an instant."""
    scene = Scene.load("polymer-sphere", {"model.gravity": -1e5, "target.material.E2": 5e8})
    result = ting.of(scene).simulate(scene, 1e-3)
    depth = result.quantities["peak_depth"].value
    assert depth == pytest.approx(0.5 * scene.velocity**2 / 1e5, rel=1e-6)
    elastic = scene.contact_modulus.glassy * float(scene.load_curve.force(depth))
    assert result.quantities["peak_force"].value == pytest.approx(elastic, rel=0.01)


@pytest.mark.parametrize(("name", "damping"), [("hertz", {}), ("tsuji", {"e": 0.5})])
def test_a_force_below_the_rounding_of_gravity_is_its_springs_at_the_turn(name: str, damping: Any) -> None:
    law = LawChoice(name, {"k": 1e5, **damping})
    scene = Scene(None, 0.05, 1e-5, law=law, model=Model(gravity=-1e5), motion=Motion(end_time=1e-3))
    history = laws.get(name).of(scene).simulate(scene, 1e-3).history
    turn = history.depth.argmax()
    assert history.depth[turn] == pytest.approx(0.5 * scene.velocity**2 / 1e5, rel=1e-9)
    assert history.force[turn] == pytest.approx(1e5 * history.depth[turn] ** 1.5, rel=1e-6)


@pytest.mark.parametrize("gravity", [0.5, 3.0, 30.0])
@pytest.mark.parametrize("speed", [0.02, 0.1, 1.0])
def test_bodies_meet_again_at_the_surface_or_where_a_dashpot_no_longer_holds(gravity: float, speed: float) -> None:
    """k d + c d' from a dent 1 mm deep: on a parabola of time, turned before the surface or after."""
    dent, stiffness, damping = 1e-3, 2e3, 200.0
    stages = list[Stage]()

    def force(depth: float, rate: float, stage: Stage) -> float:
        stages.append(stage)
        return stiffness * depth + damping * rate

    law: Any = SimpleNamespace(force=force)
    last = State(dent, -speed, 0.2)
    found = PointLaw.returned(law, Bodies(1.0, 2.0, gravity), last)
    assert found is not None
    time, state = found
    square = speed**2 - 2.0 * gravity * dent
    if square >= 0.0:
        assert time == pytest.approx((speed + square**0.5) / gravity)
        assert state[:3] == pytest.approx((0.0, square**0.5, 0.2), abs=1e-12)
    else:
        a, b, c = 0.5 * stiffness * gravity, damping * gravity - stiffness * speed, stiffness * dent - damping * speed
        rises = max(np.roots([a, b, c]))
        assert time == pytest.approx(rises, abs=1e-9)
        assert state.rate == pytest.approx(gravity * rises - speed, abs=1e-7)
        assert set(stages) == {Stage(False, dent, 2.0)}
    assert PointLaw.returned(law, Bodies(1.0, 2.0, 0.0), last) is None
    assert PointLaw.returned(law, Bodies(1.0, 2.0, -1.0), last) is None


def test_a_weight_however_light_brings_back_what_a_dashpot_holds(impact: Callable[..., Scene]) -> None:
    """It takes 1.4 % of the velocity at touch in an elastic contact's time; without it the striker leaves."""
    scene = impact(0.5, (0.5,), (0.3,), viscosity=3.0, end_time=300.0)
    pulled = replace(scene, model=Model(gravity=0.014 * scene.velocity / scene.elastic_contact_time))
    away, back = (once(one, 1e-3, ting.solve) for one in (scene, pulled))
    assert away.end is End.SEPARATED
    assert back.end is End.SECOND_APPROACH
    assert back.values["restitution"] is None
    depth = back.columns(back.times)[0]
    assert 0.0 < depth[-1] < depth.max(), "in its dent, on the way back"
