"""What an estimate expects of an impact places mesh and steps, and may be wrong: values and bars do not know of it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import fe_contact
from fe_contact.budget import plan as planning
from fe_contact.budget.plan import scales
from fe_contact.budget.runs import PILOT_STEPS, PLACED, Runs
from fe_contact.march.impact import share_of_rest, step_length
from fe_contact.steppers.steps import Strike
from lumped import Result, Scene, laws, simulate
from lumped.errors import NotReached
from lumped.laws import mdr

SCENES = ("polymer-sphere", "polymer-layer", "rod-in-ring", "polymer-cone")
CASES, SEED = 48, 20261123
RULED = ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse")
LEAST_BAND = 1e-6  # of the peak: what the exact law is asked for


@pytest.fixture
def misjudged(monkeypatch: pytest.MonkeyPatch) -> Callable[[float, float], None]:
    """Makes every estimate wrong by factors of times and of radii."""

    def install(times: float, radii: float) -> None:
        def wrong(*of: object) -> object:
            found = scales(*of)
            return replace(
                found,
                contact_radius=radii * found.contact_radius,
                peak_time=times * found.peak_time,
                duration=None if found.duration is None else times * found.duration,
            )

        monkeypatch.setattr(planning, "scales", wrong)

    return install


@functools.cache
def exact(name: str) -> Result:
    scene = Scene.load(name)
    return simulate(laws.ting.of(scene), scene, 1e-7)


def outside(found: Result, truth: Result) -> dict[str, float]:
    """Errors over bars, of the values and of the force along the history, where above one."""
    over = {}
    for name in RULED:
        value, true = found.quantities[name], truth.quantities[name]
        over[name] = abs(value.value - true.value) / (value.error + (true.error or 0.0))
    history = found.history
    errors = np.abs(history.force - truth.history.force_at(history.time))
    over["band"] = float(np.max(errors / (history.force_error + LEAST_BAND * history.force.max())))
    return {name: ratio for name, ratio in over.items() if not ratio <= 1.0}


@pytest.mark.tenth
@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-3, 1e-4])
def test_values_lie_within_their_bars_whatever_was_expected(
    tolerance: float, misjudged: Callable[[float, float], None], campaign_size: Callable[[int], int]
) -> None:
    """Layers at the finest tolerance take minutes: `--full` has them at 1e-3."""
    rng = np.random.default_rng([SEED, round(1 / tolerance)])
    names = [name for name in SCENES if tolerance > 1e-4 or Scene.load(name).target.name == "half_space"]
    for _ in range(campaign_size(CASES)):
        name, times, radii = str(rng.choice(names)), float(rng.uniform(0.4, 2.0)), float(rng.uniform(0.7, 1.5))
        misjudged(times, radii)
        found = fe_contact.run(Scene.load(name), tolerance)
        assert found.converged, (name, times, radii, found.message)
        assert not outside(found, exact(name)), (name, times, radii)


@pytest.mark.family
@pytest.mark.parametrize("times", [0.4, 0.7, 2.0])
def test_contacts_in_a_row_lie_within_both_bars_whatever_was_expected(
    times: float, misjudged: Callable[[float, float], None], uncovered: Callable[..., dict[str, float]]
) -> None:
    scene = Scene.load("ball-bouncing")
    known = fe_contact.run(scene, 1e-3)
    misjudged(times, 1.0)
    found = fe_contact.run(scene, 1e-2)
    assert not uncovered(found, known)
    assert len(found.contacts) == len(known.contacts)
    for one, other in zip(found.contacts, known.contacts, strict=True):
        for quantity in ("duration", "restitution", "peak_force"):
            apart = abs(one[quantity] - other[quantity])
            assert apart <= one[f"{quantity}_error"] + other[f"{quantity}_error"], quantity


@pytest.mark.parametrize("times", [0.4, 2.0])
def test_a_coarse_march_tells_how_long_contact_lasts_and_when_it_peaks(
    times: float, misjudged: Callable[[float, float], None]
) -> None:
    misjudged(times, 1.0)
    scene, truth = Scene.load("polymer-sphere"), exact("polymer-sphere").quantities
    numerics = planning.plan(scene, {"tolerance": 1e-3}).numerics
    placed = Runs(Strike.of(scene), scene.geometry, 1).placed(numerics, PILOT_STEPS)
    duration, peak_time = truth["duration"].value, truth["peak_time"].value
    assert abs(numerics.contact_time / duration - 1.0) > 0.5
    assert placed.contact_time == pytest.approx(duration, rel=PLACED)
    assert placed.peak_share == pytest.approx(peak_time / duration, rel=PLACED)


@pytest.mark.parametrize("late", [1.2, 1.5, 3.0])
def test_twice_the_steps_halve_every_step_past_the_expected_end(late: float) -> None:
    def step_at(steps: int) -> float:
        """The step that is being taken so late, in expected contact times."""
        time, done = 0.0, 0
        while (length := step_length(done, steps, 0.5)) + time < late:
            time, done = time + length, done + 1
        return length

    assert step_at(400) == pytest.approx(2.0 * step_at(800), rel=0.05)


@pytest.mark.parametrize("left", [0.3, 0.1, 0.03])
def test_twice_the_steps_halve_every_step_towards_separation(left: float) -> None:
    assert share_of_rest(left, 400) == pytest.approx(2.0 * share_of_rest(left, 800), rel=0.05)


def test_where_no_spring_leaves_another_law_tells_what_to_expect(monkeypatch: pytest.MonkeyPatch) -> None:
    """As may be under a ball that its weight lets go only after a thousand times that its force took to rise."""

    def lost(*_: object) -> None:
        raise NotReached("the springs at the edge did not leave")

    scene = Scene.load("polymer-sphere")
    expected = scales(scene, planning.plan(scene, {}).numerics)
    monkeypatch.setattr(mdr, "estimate", lost)
    found = scales(scene, planning.plan(scene, {}).numerics)
    for name in ("contact_radius", "peak_force", "peak_time", "duration"):
        by_springs = getattr(expected, name)  # 32 of them, which place a peak between two steps
        assert getattr(found, name) == pytest.approx(by_springs, rel=0.03), name
