"""Where finer steps find rounding alone, and where a striker settles: no more work than tells something."""

from __future__ import annotations

from collections.abc import Callable
from unittest.mock import patch

import numpy as np
import pytest
from scipy.special import beta

from lumped import Scene, laws, simulate
from lumped.load_curves.bent import BentCurve
from lumped.numbers import falling_zero
from lumped.shapes.cone import Cone
from lumped.solvers.point import phase
from lumped.solvers.point.memory import StepLoad


@pytest.mark.parametrize("name", ["polymer-sphere", "polymer-sphere-cone"])
def test_marches_of_springs_stop_where_a_bar_is_rounding(name: str) -> None:
    """Gravity away from the target leaves hardly any impulse of the contact: its bar is rounding from the first on."""
    scene = Scene.load(name, {"model.gravity": -1e5})
    found = simulate(laws.mdr.of(scene), scene, 1e-4)
    assert "impulse" in found.message
    assert not found.converged
    assert found.numerics["parts"] <= 64
    e, duration = found.quantities["restitution"], found.quantities["duration"]
    alone = (1.0 + (e.value or 0.0)) * scene.velocity / 1e5
    assert duration.value == pytest.approx(alone, rel=1e-9), "as gravity alone has it"
    assert (e.error or 1.0) < 1e-6, "and the rest is known"


def test_marches_of_springs_go_on_while_the_history_errs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the circle where a cone meets its sphere bars fall by fits and starts: one that stays is no rounding."""
    monkeypatch.setattr(laws.mdr, "_stalled", lambda widest: True)
    scene = Scene.load("polymer-sphere")
    found = simulate(laws.mdr.of(scene), scene, 1e-7)
    assert found.converged
    assert found.numerics["parts"] > 4, "more than the first march that has a bar"


@pytest.mark.tenth
def test_a_striker_that_settles_takes_few_trials_a_turn() -> None:
    """Its turns are known to ever fewer digits: no trial goes on for what is rounding."""
    scene = Scene.load("ball-bouncing", {"motion.impacts": 40, "motion.end_time": 5.0})
    trials = list[float]()
    solved = phase.solved

    def counted(law: object, stage: object, bodies: object, start: object, length: float, *more: object) -> object:
        trials.append(length)
        return solved(law, stage, bodies, start, length, *more)  # type: ignore[arg-type]

    with patch.object(phase, "solved", counted):
        found = simulate(laws.correspondence.of(scene), scene, 1e-3)
    assert "came to rest" in found.message
    assert len(trials) < 4.0 * found.work["steps"]


def test_a_load_curve_is_asked_once_for_each_trial_of_depths() -> None:
    scene = Scene.load("polymer-rounded-punch", {"motion.impacts": 2, "model.gravity": 9.81, "motion.end_time": 0.02})
    law = laws.correspondence.law_of(scene)
    load = StepLoad.of(law.load, law.load.at_rest, 1e-3, phase.NODES)
    depth, rate = np.linspace(1e-5, 2e-5, 8), np.full(8, 0.02)
    looked, radius = list[int](), BentCurve.contact_radius

    def counted(curve: BentCurve, depth: np.ndarray) -> object:
        looked.append(depth.size)
        return radius(curve, depth)

    with patch.object(BentCurve, "contact_radius", counted):
        force, (over_depth, _) = load.force(depth, rate), load.tangents(depth, rate)
        memories = load.memories(depth)
    assert looked == [8]
    again = load.force(depth.copy(), rate)
    assert np.array_equal(force, again)
    shift = 1e-9 * np.eye(8)
    slopes = np.array([(load.force(depth + row, rate) - load.force(depth - row, rate)) / 2e-9 for row in shift]).T
    assert over_depth == pytest.approx(slopes, rel=1e-4, abs=1e-4 * float(np.abs(slopes).max()))
    assert memories.shape == (1, 8)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-10])
@pytest.mark.parametrize("angle", [11.0, 27.3, 61.7])
def test_the_end_of_a_force_that_falls_as_a_square_is_known_to_the_root_of_rounding(
    angle: float, tolerance: float, impact: Callable[..., Scene]
) -> None:
    """An elastic cone's contact lasts 2 depth/v times the integral of dx/sqrt(1 - x^3) over (0, 1)."""
    scene = impact(shape=Cone(angle))
    found = simulate(laws.correspondence.of(scene), scene, tolerance)
    duration, depth = found.quantities["duration"], found.quantities["peak_depth"]
    exact = 2.0 / 3.0 * beta(1.0 / 3.0, 0.5) * (depth.value or 0.0) / scene.velocity
    assert abs((duration.value or 0.0) - exact) <= (duration.error or 0.0)
    assert (duration.error or 1.0) < 1e-8 * exact
    assert found.converged is (tolerance > 1e-9)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-7])
def test_gravity_makes_of_the_end_s_bar_one_of_the_velocity(tolerance: float, impact: Callable[..., Scene]) -> None:
    """The energy of an elastic cone is whole at the end, whenever that is, and however heavy it is beside its force."""
    scene = impact(shape=Cone(27.3))
    heavy = impact(shape=Cone(27.3), gravity=30.0 * scene.velocity / scene.elastic_contact_time)
    found = simulate(laws.correspondence.of(heavy), heavy, tolerance)
    restitution = found.quantities["restitution"]
    assert abs((restitution.value or 0.0) - 1.0) <= (restitution.error or 0.0) < 1e-5


def test_what_has_not_fallen_but_for_rounding_ends_where_it_was_seen_to() -> None:
    assert falling_zero(lambda place: 1e-17, 0.0, 1.0) == 1.0
    assert falling_zero(lambda place: 1e-17 * (2.0 - place), 0.0, 1.0) == 1.0
    assert falling_zero(lambda place: 0.25 - place, 0.0, 1.0) == pytest.approx(0.25, rel=1e-12)
