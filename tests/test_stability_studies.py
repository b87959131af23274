"""Every study of stability: each method fails as theory predicts, and the default beside it holds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from fe_contact.budget.plan import DEFAULTS
from fe_contact.studies.stability import bars, impacts, layers
from fe_contact.studies.stability.bars import DEFAULT, choices
from fe_contact.waves.plan import TRAVEL
from lumped.materials.radiation import pulse_energy, shear_speed
from lumped.restitution import kelvin

# locking


def layer_error(order: int, nu: float, elements: float = 4.0) -> float:
    return float(layers.locking_measure({"order": order, "elements": elements, "nu": nu})["error"])


def test_linear_triangles_lock_as_the_bulk_modulus_grows() -> None:
    """Their excess force grows with 1/(1 - 2 nu), tenfold from 0.499 to 0.4999, until the layer hardly moves."""
    coarse, fine = ([layer_error(1, nu, elements) for nu in (0.499, 0.4999)] for elements in (4.0, 16.0))
    assert coarse[1] > 5.0
    assert 4.0 < coarse[1] / coarse[0] < 10.0
    assert 4.0 < fine[1] / fine[0] < 10.0
    assert fine[1] > 1.0  # with a mesh as rich as the default's


@pytest.mark.parametrize("nu", [0.3, 0.499, 0.4999])
def test_the_default_does_not_lock(nu: float) -> None:
    assert abs(layer_error(DEFAULTS["order"], nu)) < 1e-3


# relaxation time over time step


def relaxed(scheme: str, steps: int, ratio: float) -> dict[str, Any]:
    return impacts.relaxation_measure({"scheme": scheme, "steps": steps, "ratio": ratio})


@pytest.mark.tenth
def test_backward_euler_loses_restitution_at_every_relaxation_time() -> None:
    """Order one: half the error with twice the steps, however the relaxation time compares with them."""
    for ratio in (0.01, 1.0, 100.0):
        coarse, fine = relaxed("backward_euler", 40, ratio), relaxed("backward_euler", 80, 2.0 * ratio)
        assert coarse["restitution"] < -0.1
        assert coarse["restitution"] / fine["restitution"] == pytest.approx(2.0, rel=0.2)


@pytest.mark.tenth
def test_the_default_follows_every_relaxation_time() -> None:
    """Order two from a hundredth of a step to a thousand steps, with no ratio that is stiff."""
    for ratio in (0.01, 1.0, 100.0, 1000.0):
        coarse, fine = relaxed(DEFAULTS["scheme"], 40, ratio), relaxed(DEFAULTS["scheme"], 80, 2.0 * ratio)
        assert max(abs(coarse[name]) for name in ("force", "duration", "restitution")) < 3e-3
        assert coarse["force"] / fine["force"] == pytest.approx(4.0, rel=0.25)


# penalty over conditioning


def pressed(enforcement: str, penalty: float) -> dict[str, Any]:
    return layers.conditioning_measure({"enforcement": enforcement, "penalty": penalty})


def test_a_penalty_is_too_soft_or_too_stiff_and_the_default_is_neither() -> None:
    """Bias falls as 1/penalty, condition grows with it; where no digit is left no contact settles."""
    soft, softer, stiff, stiffer = (pressed("penalty", p) for p in (100.0, 10.0, 1e7, 1e9))
    assert softer["bias"] / soft["bias"] == pytest.approx(10.0, rel=0.2)
    assert stiffer["condition"] / stiff["condition"] == pytest.approx(100.0, rel=0.01)
    assert stiffer["bias"] < 3e-4  # what settles balances, however its pressure ripples
    assert stiffer["ripple"] > 10.0 * pressed("penalty", 1e5)["ripple"]
    drowned = pressed("penalty", 1e11)
    assert drowned["unsettled"] == len(layers.DEPTHS)
    assert drowned["bias"] is None
    default = pressed(DEFAULTS["enforcement"], DEFAULTS["penalty"])
    assert default["bias"] < 3e-4
    assert default["ripple"] < 1e-4
    assert default["condition"] < 1e5
    assert default["unsettled"] == 0


@pytest.mark.parametrize("penalty", [1.0, 30.0, 1e3, 1e5])
def test_multipliers_made_of_shape_functions_stand_still_whatever_the_penalty(penalty: float) -> None:
    """More points on a facet than nodes: held at every point, a facet would drive its multipliers on for ever."""
    found = pressed("augmented", penalty)
    assert found["unsettled"] == 0
    assert found["bias"] < 3e-4
    assert found["ripple"] < 3e-4


# exit with tension


@pytest.mark.parametrize("xi", [0.1, 0.6])
def test_contact_that_ends_with_the_depth_has_pulled(xi: float) -> None:
    """The oscillator's force down to depth zero, in closed form; finite elements end where the force does."""
    damped = math.sqrt(1.0 - xi**2)
    phase = np.linspace(0.0, math.pi / damped, 200_001)
    force = np.exp(-xi * phase) * (
        2.0 * xi * np.cos(damped * phase) + (1 - 2 * xi**2) / damped * np.sin(damped * phase)
    )
    pulled = impacts.tension_measure({"way": "depth", "xi": xi})
    assert pulled["tension"] == pytest.approx(-force.min() / force.max(), rel=1e-3)
    assert pulled["restitution"] == pytest.approx(kelvin.restitution(xi, "depth") - kelvin.restitution(xi), rel=1e-6)
    held = impacts.tension_measure({"way": impacts.WAYS[0], "xi": xi})
    assert held["tension"] == 0.0
    assert abs(held["restitution"]) < 1e-3


# gaps


def fallen(way: dict[str, Any], height: float) -> dict[str, Any]:
    case = {**way, "cfl": 1.0, "elements": 60, "periods": bars.GAP_PERIODS, "gap": height}
    return bars.gap_measure(case) | {"step": choices(case).step}


@pytest.mark.parametrize("height", [0.004, 0.025, 0.05])
def test_a_constraint_that_looks_ahead_presses_before_the_touch(height: float) -> None:
    """Its contact begins with the step in which it touches; the default's within a hundredth of a step of the touch."""
    early = fallen(dict(bars.GAP_WAYS[0]), height)
    touch = (math.sqrt(1.0 + 0.2 * height) - 1.0) / early["step"]  # 10 t + 5 t^2 = height
    assert early["touch"] == pytest.approx(-(touch % 1.0), abs=0.02)
    found = fallen(dict(DEFAULT), height)
    assert abs(found["touch"]) < 0.01
    assert abs(found["duration_steps"]) < 1.0


def test_a_gap_of_rounding_is_none() -> None:
    closed = fallen(dict(DEFAULT), 0.0)
    for height in (1e-15, 1e-12):
        found = fallen(dict(DEFAULT), height)
        assert found["contacts"] == closed["contacts"] == 1
        for name in ("touch", "duration_steps", "impulse", "gain"):
            assert found[name] == pytest.approx(closed[name], abs=1e-8), name


# far radius


@pytest.mark.tenth
def test_an_echo_within_the_contact_changes_what_is_lost() -> None:
    """A far end at a tenth of the travel, with dashpots or without; the plan's place needs no dashpot."""
    near, bare = (impacts.far_radius_measure({"dashpots": d, "share": 0.1})["loss"] for d in (True, False))
    assert abs(near) > 0.1
    assert abs(bare) > 0.3
    for dashpots in (True, False):
        held = impacts.far_radius_measure({"dashpots": dashpots, "share": TRAVEL})
        assert abs(held["loss"]) < 0.01
        assert abs(held["force"]) < 1e-3


def test_what_is_lost_is_what_a_point_force_radiates() -> None:
    """A Hertz pulse of the same peak and duration on the half-space of Miller and Pursey, to first order."""
    scene, _ = impacts.settled()
    found, material = impacts.impact(impacts.FAR, True), scene.geometry.material
    (start, end), peak = found.contacts[0], float(found.force.max())
    speed = shear_speed(material)
    assert speed is not None
    radiated = pulse_energy(material.nu, material.density or 0.0, speed, peak, end - start)
    assert impacts.lost(found) == pytest.approx(radiated / (0.5 * scene.mass * scene.velocity**2), rel=0.03)
