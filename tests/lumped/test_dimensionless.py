"""Groups without units: alike for impacts that are alike, whatever their size, and those of exact impacts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lumped import Material, Model, Relaxation, Scene, Sphere, laws, simulate
from lumped.indentation import indent as closed_form
from lumped.scene.indenter import Indenter
from lumped.shapes.cone import Cone
from lumped.targets.layer import Layer

YOUNG = Relaxation(1e6, (0.7e6,), (3e-3,))


def told(scene: Scene, law: str = "ting") -> dict[str, Any]:
    """What result.json says."""
    found: dict[str, Any] = simulate(laws.get(law).of(scene), scene, 1e-6).to_json()["dimensionless"]
    return found


def on_layer(length: float, time: float, force: float) -> Scene:
    """One impact, its units of length, time and force multiplied."""
    modulus, tau = force / length**2, time
    young = Relaxation(1e6 * modulus, (0.7e6 * modulus,), (3e-3 * tau,))
    mass, velocity = 0.02 * force * time**2 / length, 0.05 * length / time
    return Scene(Sphere(0.01 * length), mass, velocity, Material(young, 0.3), target=Layer(0.002 * length, "bonded"))


def test_the_groups_do_not_know_the_units() -> None:
    rng = np.random.default_rng(7)
    first = told(on_layer(1.0, 1.0, 1.0))
    for _ in range(3):
        other = told(on_layer(*10.0 ** rng.uniform(-2.0, 2.0, 3)))
        for name in set(first) - {"F0", "T0"}:
            assert other[name] == pytest.approx(first[name], rel=1e-5), name


def test_an_elastic_impact_is_its_own_unit() -> None:
    scene = Scene(Cone(10.0), 0.02, 0.05, Material(Relaxation(1e6), 0.3))
    found = told(scene)
    assert (found["F/F0"], found["T/T0"], found["t/T0"]) == pytest.approx((1.0, 1.0, 0.5), rel=1e-4)
    assert (found["E_i/E_inf"], found["tau/T"], found["a/R"], found["h/a"]) == (1.0, [], None, None)


def test_the_groups_are_those_of_the_scene() -> None:
    scene = on_layer(1.0, 1.0, 1.0)
    result = simulate(laws.ting.of(scene), scene, 1e-6)
    found, largest = told(scene), result.history.contact_radius.max()
    assert found["E_i/E_inf"] == pytest.approx(1.7)
    assert found["tau/T"] == pytest.approx([3e-3 / (result.quantities["duration"].value or 0.0)], rel=1e-3)
    assert (found["a/R"], found["h/a"]) == pytest.approx((largest / 0.01, 0.002 / largest), rel=1e-3)
    assert found["nu"] == 0.3


def test_what_is_not_defined_is_null() -> None:
    dashpot = Material(replace(YOUNG, viscosity=1e3), 0.3)
    assert told(Scene(Sphere(0.01), 0.02, 0.05, dashpot), "mdr")["E_i/E_inf"] is None
    assert told(Scene.load("paper-steel-hertz"), "hertz") == {}


def test_a_dashpot_alone_has_the_groups_that_are_defined() -> None:
    """It stops a ball of m v = (4/3) sqrt(R) eta* depth^(3/2), and its groups do not know how viscous it is."""
    viscosities = (1e4, 3e5)
    dashpots = [Material(Relaxation(0.0, (), (), eta), 0.3) for eta in viscosities]
    scenes = [Scene(Sphere(0.006), 0.05, 0.02, one, model=Model(profile="parabola")) for one in dashpots]
    for scene, eta in zip(scenes, viscosities, strict=True):
        deepest = (0.05 * 0.02 * 0.75 * (1.0 - 0.3**2) / (eta * 0.006**0.5)) ** (2.0 / 3.0)
        assert simulate(laws.ting.of(scene), scene, 1e-6).history.depth[-1] == pytest.approx(deepest, rel=1e-4)
    first, second = map(told, scenes)
    assert first["E_i/E_inf"] is first["T/T0"] is None
    assert (second["F/F0"], second["t/T0"]) == pytest.approx((first["F/F0"], first["t/T0"]), rel=1e-4)


def test_a_slow_indentation_has_the_groups_that_know_no_time() -> None:
    scene = on_layer(1.0, 1.0, 1.0)
    pressed = Indenter(scene.geometry.shape, scene.geometry.material, scene.target)
    slow = closed_form(pressed, (1e-5, 1e-4, 2e-5), "ting")
    found, largest = slow.to_json()["dimensionless"], slow.contact_radius[1]
    assert found == pytest.approx({"E_i/E_inf": 1.7, "nu": 0.3, "a/R": largest / 0.01, "h/a": 0.002 / largest})
