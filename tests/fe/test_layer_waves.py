"""A layer with waves: at rest without density, a half-space until its base answers, and confined columns when thin."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.curve import Curve
from fe_contact.dynamics.march import Motion
from fe_contact.forms import Array
from fe_contact.march import March
from fe_contact.methods import simulate
from fe_contact.numerics import WAVES
from fe_contact.reference import strike_of
from fe_contact.waves import half_space_body, layer_body
from fe_contact.waves.impact import motion, record
from fe_contact.waves.targets import layer
from lumped import BadInput, Scene, laws
from lumped.members import get
from lumped.targets.layer import Layer

RULED = ("peak_force", "duration", "restitution", "peak_depth", "impulse")
MOVING = {"half_space": half_space_body.moving, "layer": layer_body.moving}


def marched(scene: Scene, **given: Any) -> tuple[March, Curve, Motion]:
    numerics = get(WAVES, scene.target.name).plan(scene, given).numerics
    body = MOVING[scene.target.name](scene, numerics)
    moved = motion(body, scene, numerics)
    found = record(body, moved, scene)
    return found, Curve.of(found, strike_of(scene)), moved


@pytest.mark.parametrize("base", ["bonded", "sliding"])
@pytest.mark.parametrize("thickness", [0.001, 0.02])
def test_without_density_it_is_the_impact_without_inertia(base: str, thickness: float) -> None:
    changes = {"target.base": base, "target.thickness": thickness, "target.material.density": 1e-3}
    scene = Scene.load("polymer-layer-waves", {**changes, "striker.velocity": 0.01})
    march, curve, _ = marched(scene, elements_per_contact=8.0)
    truth = laws.get("ting").of(scene).simulate(scene, 1e-6).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(truth[key].value, rel=1e-3), key
    assert 0.0 <= march.energy["radiated"] < 1e-6 * march.energy["in"]


def test_without_density_a_line_contact_is_the_one_without_inertia() -> None:
    scene = Scene.load("polymer-layer-line", {"target.material.density": 1e-3, "model.inertia": True})
    curve = marched(scene, elements_per_contact=8.0)[1]
    truth = laws.get("ting").of(scene).simulate(scene, 1e-6).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(truth[key].value, rel=1e-3), key


def test_without_density_volume_and_shape_relax_apart_as_without_inertia() -> None:
    changes = {"target.material.density": 1e-3, "model.inertia": True}
    curve = marched(Scene.load("rubber-layer-bulk", changes))[1]
    still = simulate(Scene.load("rubber-layer-bulk"), "fe", {}).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(still[key].value, rel=1e-3), key


@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_before_its_base_echoes_a_thick_layer_is_the_half_space(base: str) -> None:
    material = {"law": "elastic", "E": 2.06e11, "nu": 0.1, "density": 7850.0}
    endless = Scene.load("steel-ball-waves", {"target.material": material})
    curve = marched(endless)[1]
    speed, share = math.sqrt(endless.geometry.material.confined_modulus().glassy / 7850.0), 0.4
    table = {"shape": "layer", "thickness": 0.5 * share * curve.duration * speed, "base": base, "material": material}
    echoed = marched(Scene.load("steel-ball-waves", {"target": table}))[1]
    peak = curve.quantities["peak_force"] or 0.0
    before, after = np.linspace(0.0, share, 200), np.linspace(share, 1.0, 200)
    apart = [
        np.abs(echoed.force(t) - curve.force(t)).max() / peak for t in (before * curve.duration, after * curve.duration)
    ]
    assert apart[0] < 5e-4
    assert apart[1] > 3e-3  # what it sends back comes from 130 contact radii below


def broad_on_thin(ratio: float, exponent: float) -> Scene:
    """A nearly flat striker, ``ratio`` times as wide as the layer is thick and four times as heavy as what it presses.

    With nu = 0 nothing pushes sideways: every column of the layer is a bar of its own.
    """
    young, density, radius, velocity = 1e6, 1000.0, 0.01, 0.02
    mass = 4.0 * density * math.pi * radius**3 / ratio
    depth = velocity * math.sqrt(mass / (ratio * math.pi * radius * young))
    striker = {"shape": "power", "coefficient": depth / radius**exponent, "exponent": exponent}
    material = {"law": "elastic", "E": young, "nu": 0.0, "density": density}
    target = {"shape": "layer", "thickness": radius / ratio, "base": "bonded", "material": material}
    striker |= {"mass": mass, "velocity": velocity}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"inertia": True}})


def columns(scene: Scene, until: float, steps: int = 4000) -> tuple[float, Array, Array, Array]:
    """Echo time 2 h/c, times, velocity and force of the striker while it moves in, by the waves in every column.

    What moves in with v sends rho c v down, which the base returns: p = rho c [v(t) + 2 sum_k v(t - 2 k h/c)].
    """
    material, profile, target = scene.geometry.material, scene.profile, scene.target
    assert isinstance(target, Layer)
    density = material.density or 0.0
    speed = math.sqrt(material.confined_modulus().glassy / density)
    echo = 2.0 * target.thickness / speed
    late = round(steps * echo / until)
    step, sent = echo / late, np.zeros(steps + 1)

    def force(number: int, depth: float, velocity: float) -> float:
        radius = (max(depth, 0.0) / profile.coefficient) ** (1.0 / profile.exponent)
        sent[number] = density * speed * math.pi * radius**2 * velocity
        return float(sent[number] + 2.0 * sent[number - late :: -late].sum() * (number >= late))

    depth, velocity, forces = 0.0, [scene.velocity], [0.0]
    for number in range(1, steps + 1):  # Heun
        guess = velocity[-1] - step * forces[-1] / scene.mass
        trial = force(number, depth + step * velocity[-1], guess)
        velocity.append(velocity[-1] - 0.5 * step * (forces[-1] + trial) / scene.mass)
        depth += 0.5 * step * (velocity[-1] + velocity[-2])
        forces.append(force(number, depth, velocity[-1]))
    return echo, step * np.arange(steps + 1), np.array(velocity), np.array(forces)


def test_a_thin_layer_under_a_broad_striker_rings_as_the_waves_across_it() -> None:
    """Twelve times as wide as thick; sheared columns at the rim cost the striker a few thousandths of its speed."""
    scene = broad_on_thin(12.0, 12.0)
    _, curve, moved = marched(scene)
    echo, time, velocity, force = columns(scene, 0.6 * curve.duration)
    inwards = time[velocity > 0.0]
    seen = np.interp(inwards, moved.time, [s.velocity[0] for s in moved.samples])
    assert np.abs(seen - velocity[velocity > 0.0]).max() < 4e-3 * scene.velocity
    assert np.sqrt(np.mean((curve.force(inwards) - force[velocity > 0.0]) ** 2)) < 0.06 * force.max()
    near = inwards[(inwards > 0.5 * echo) & (inwards < 1.5 * echo)]
    assert near[np.gradient(curve.force(near), near).argmax()] == pytest.approx(echo, rel=0.02)  # the first echo


def test_the_packaged_layer_is_slow_beside_its_waves_and_keeps_its_energy(
    uncovered: Callable[..., dict[str, float]],
) -> None:
    scene = Scene.load("polymer-layer-waves")
    found = simulate(scene, "fe", {})
    assert found.converged, found.message
    assert abs(found.energy["residual"] or 0.0) < 1e-6 * (found.energy["in"] or 0.0)
    assert (found.energy["radiated"] or -1.0) >= 0.0
    # 830 times a pressure wave crosses it: inertia hides inside the bars
    assert not uncovered(found, laws.get("ting").of(scene).simulate(scene, 1e-6), RULED)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"striker": {"shape": "punch", "radius": 1e-3, "mass": 1e-3, "velocity": 0.01}}, "striker.shape"),
        ({"motion.impacts": 2}, "motion.impacts"),
        ({"striker.velocity": 20.0}, "striker.velocity"),
    ],
)
def test_what_has_no_waves_here_is_refused_with_its_key(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        layer.check(Scene.load("polymer-layer-waves", changes))


def test_its_fields_are_refused_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "polymer-layer-waves", "--fields"]) == 2
    assert "target.shape" in capsys.readouterr().err
