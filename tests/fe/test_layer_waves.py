"""A layer with waves: at rest without density, a half-space until its base answers, and confined columns when thin."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.sparse import linalg

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import moduli
from fe_contact.budget.curve import Curve
from fe_contact.cli import main
from fe_contact.dynamics.march import Motion
from fe_contact.methods import simulate
from fe_contact.steppers.steps import March, Strike
from fe_contact.waves.impact import motion, record
from fe_contact.waves.targets import half_space, layer
from fe_contact.waves.targets.base import WAVES
from lumped import BadInput, Scene, laws
from lumped.laws import mdr
from lumped.load_curves.hertz import hertz_impact
from lumped.targets.layer import Layer, moving_share

RULED = ("peak_force", "duration", "restitution", "peak_depth", "impulse")
MOVING = {"half_space": half_space.moving, "layer": layer.moving}


def marched(scene: Scene, **given: Any) -> tuple[March, Curve, Motion]:
    numerics = WAVES.get(scene.target.name).plan(scene, given).numerics
    body = MOVING[scene.target.name](scene, numerics)
    moved = motion(body, scene, numerics)
    found = record(body, moved, scene)
    return found, Curve.of(found, Strike.of(scene)), moved


@pytest.mark.family
@pytest.mark.parametrize("base", ["bonded", "sliding"])
@pytest.mark.parametrize("thickness", [0.001, 0.02])
def test_without_density_it_is_the_impact_without_inertia(base: str, thickness: float) -> None:
    changes = {"target.base": base, "target.thickness": thickness, "target.material.density": 1e-3}
    scene = Scene.load("polymer-layer-waves", {**changes, "striker.velocity": 0.01})
    march, curve, moved = marched(scene, elements_per_contact=8.0)
    truth = laws.get("ting").of(scene).simulate(scene, 1e-6).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(truth[key].value, rel=1e-3), key
    assert march.work.steps == march.work.contact_problems == len(moved.time) - 1, "all but the touch"
    assert 0.0 <= march.energy["radiated"] < 1e-6 * march.energy["in"]


@pytest.mark.tenth
def test_without_density_a_line_contact_is_the_one_without_inertia() -> None:
    scene = Scene.load("polymer-layer-line", {"target.material.density": 1e-3, "model.inertia": True})
    curve = marched(scene, elements_per_contact=8.0)[1]
    truth = laws.get("ting").of(scene).simulate(scene, 1e-6).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(truth[key].value, rel=1e-3), key


@pytest.mark.tenth
def test_without_density_volume_and_shape_relax_apart_as_without_inertia() -> None:
    changes = {"target.material.density": 1e-3, "model.inertia": True}
    curve = marched(Scene.load("rubber-layer-bulk", changes))[1]
    still = simulate(Scene.load("rubber-layer-bulk"), "fe", {"tolerance": 3e-3}).quantities
    for key in RULED:
        assert curve.quantities[key] == pytest.approx(still[key].value, rel=1e-3), key


def test_volume_and_shape_apart_resist_at_once_as_one_elastic_material_does() -> None:
    given: Any = SimpleNamespace(stiffness=(np.diag([1.0, 2.0]), np.array([[3.0, 1.0], [1.0, 5.0]])))
    bulk = {"law": "sls", "E1": 1e6, "E2": 2e6, "C1": 1e4, "nu": 0.4, "constant": "bulk", "density": 1e3}
    relaxing = Scene.load("polymer-layer", {"target.material": bulk})
    volume, shape = relaxing.geometry.material.bulk, relaxing.geometry.material.shear.glassy
    young, nu = 9.0 * volume * shape / (3.0 * volume + shape), (1.5 * volume - shape) / (3.0 * volume + shape)
    elastic = Scene.load("polymer-layer", {"target.material": {"law": "elastic", "E": young, "nu": nu}})
    apart, whole = (layer._parts(scene, given, 0.3) for scene in (relaxing, elastic))
    assert len(apart) == 2
    summed, once = (sum(part.relaxation.glassy * part.stiffness for part in parts) for parts in (apart, whole))
    assert summed == pytest.approx(once, rel=1e-12)


@pytest.mark.tenth
def test_before_its_base_echoes_a_thick_layer_is_the_half_space() -> None:
    material = {"law": "elastic", "E": 2.06e11, "nu": 0.1, "density": 7850.0}
    endless = Scene.load("steel-ball-waves", {"target.material": material})
    curve = marched(endless)[1]
    speed, share = math.sqrt(endless.geometry.material.confined_modulus().glassy / 7850.0), 0.4
    peak, times = curve.quantities["peak_force"] or 0.0, curve.duration * np.linspace(0.0, 1.0, 400)
    for base in ("bonded", "sliding"):
        table = {
            "shape": "layer",
            "thickness": 0.5 * share * curve.duration * speed,
            "base": base,
            "material": material,
        }
        echoed = marched(Scene.load("steel-ball-waves", {"target": table}))[1]
        apart = np.abs(echoed.force(times) - curve.force(times)) / peak
        assert apart[times < share * curve.duration].max() < 5e-4, base
        assert apart.max() > 3e-3, base  # what it sends back comes from 130 contact radii below


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


@pytest.mark.tenth
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


def test_steps_tell_the_echoes_of_a_thin_layer_or_they_stand_in_the_bar() -> None:
    scene = broad_on_thin(6.0, 8.0)
    planned = layer.plan(scene, {"tolerance": 0.1}).numerics
    assert planned.follows_echoes
    assert planned.steps >= 16 * planned.echoes > 16.0
    few = layer.plan(scene, {"tolerance": 0.1, "steps": 48}).numerics
    assert not few.follows_echoes
    assert few.swing > 0.025
    assert layer.plan(Scene.load("polymer-layer-waves"), {}).numerics.swing < 1e-6, "a ball's 240 come one by one"


def test_a_dashpot_alone_sends_no_echo() -> None:
    material = {"law": "operators", "p": [1.0], "q": [0.0, 3000.0], "nu": 0.3, "density": 1000.0}
    scene = Scene.load("polymer-layer-waves", {"target.material": material, "motion.end_time": 0.01})
    planned = layer.plan(scene, {"tolerance": 0.1}).numerics
    assert (planned.echoes, planned.swing) == (0.0, 0.0)


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("exponent", "heavier", "given", "followed"),
    [(8.0, 15.0, {}, True), (8.0, 15.0, {"steps": 64}, False), (6.0, 50.0, {}, False)],
)
def test_the_band_holds_the_echoes_of_a_thin_layer(
    exponent: float, heavier: float, given: dict[str, int], followed: bool
) -> None:
    """Each is a pulse under a face that is nearly flat, by a fiftieth of the peak force or by a twentieth."""
    scene = broad_on_thin(6.0, exponent)
    coefficient = math.sqrt(heavier) * scene.profile.coefficient
    scene = scene.changed({"striker.mass": heavier * scene.mass, "striker.coefficient": coefficient})
    found = simulate(scene, "fe", {"tolerance": 0.1, **given})
    assert found.converged or given, found.message
    assert (found.numerics["swing"] == 0.0) is followed
    _, time, velocity, force = columns(scene, float(found.history.time[-1]))
    inwards = time[velocity > 0.0]
    apart = np.abs(np.interp(inwards, found.history.time, found.history.force) - force[velocity > 0.0])
    assert (apart <= np.interp(inwards, found.history.time, found.history.force_error)).all()
    assert abs((found.quantities["peak_force"].value or 0.0) - force.max()) < found.quantities["peak_force"].error


@pytest.mark.tenth
def test_a_thin_layer_whose_echoes_are_not_resolved_says_what_limits_it() -> None:
    """The contact ends, so that an earlier end is no cure; a larger tolerance is one."""
    scene = broad_on_thin(6.0, 8.0)
    heavy = {"striker.mass": 15.0 * scene.mass, "striker.coefficient": math.sqrt(15.0) * scene.profile.coefficient}
    found = simulate(scene.changed(heavy), "fe", {"tolerance": 3e-2})
    assert found.separated
    assert found.converged or re.search(
        "the largest cause is the time step; with finer settings .*: accepted up to .*; cure: a larger tolerance$",
        found.message,
    ), found.message
    assert simulate(scene.changed(heavy), "fe", {"tolerance": 0.1}).converged


@pytest.mark.tenth
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


def random_layer(rng: np.random.Generator, law: str) -> Scene:
    """A ball a tenth to ten times as heavy as one of the layer's material; a layer 0.2 to 10 contact radii thick."""
    young, density, radius, nu = 1e6, 1000.0, 0.01, float(rng.uniform(0.0, 0.49))
    steep, depth = 1.0, 1.0
    while steep > 0.5 or depth > 0.5:
        mass = density * 4.0 / 3.0 * math.pi * radius**3 * 10 ** rng.uniform(-1.0, 1.0)
        velocity = 10 ** rng.uniform(-1.5, 0.0)
        local = hertz_impact(radius, young / (1.0 - nu**2), mass, velocity)
        thickness = local.contact_radius * 10 ** rng.uniform(-0.7, 1.0)
        steep, depth = local.contact_radius / radius, local.depth / thickness
    memory = {"law": "prony", "E_inf": young, "E": [young], "tau": [local.duration * 10 ** rng.uniform(-1.0, 1.0)]}
    target = {
        "shape": "layer",
        "thickness": thickness,
        "base": ("bonded", "sliding")[rng.integers(2)],
        "material": (memory if law == "prony" else {"law": law, "E": young}) | {"nu": nu, "density": density},
    }
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"inertia": True}})


@pytest.mark.tenth
def test_the_ledger_knows_what_inertia_takes_from_the_peak(campaign_size: Callable[[int], int]) -> None:
    rng, told = np.random.default_rng(8), list[float]()
    while len(told) < campaign_size(30):
        scene = random_layer(rng, "elastic")
        still = laws.get("ting").of(scene).simulate(scene, 1e-5)
        (inertia,) = [entry for entry in still.model_ledger if entry.effect == "target inertia"]
        if inertia.estimate is None or inertia.estimate < 1e-3:  # less than the march errs by
            continue
        calm = still.quantities["peak_force"].value or 0.0
        lost = 1.0 - (marched(scene)[1].quantities["peak_force"] or 0.0) / calm
        told.append(lost / inertia.estimate)
    assert max(told) < 1.5, told
    assert min(told) > 1.0 / 1.5, told


@pytest.mark.parametrize("plane", [False, True])
def test_what_moves_as_one_meets_the_impedance_of_all_its_side(plane: bool) -> None:
    """density c on every point of a cylinder of height 2, or of two sides of unit length."""
    unit = layer.unit_layer((2.0, 1.0, 2.0, 5.0), 2, False, plane, "consistent")
    area = 2.0 * (2.0 if plane else 2.0 * math.pi * float(unit.basis.doflocs[0].max()))
    for component, dashpots in enumerate(unit.dashpots):
        free = unit.free % 2 == component
        moved = dashpots @ free.astype(float)
        # at the base, which is held across, nothing moves
        assert float(moved[free].sum()) == pytest.approx(area, rel=0.2 if component else 1e-12)
        assert np.abs(moved[~free]).max(initial=0.0) == 0.0


@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_the_moving_mass_is_that_of_the_field_at_rest(base: str) -> None:
    """density int |u|^2 dV under a flat end, as wide as a third of the thickness to ten times."""
    for nu, breadth in ((0.3, 0.3), (0.45, 1.0), (0.49, 3.0), (0.3, 10.0)):
        far = max(1.0 + 8.0 / breadth, 4.0)
        sizes = (4.0, 1.0, 1.0 / breadth, far)
        unit = layer.unit_layer(sizes, 2, base == "bonded", False, "consistent")
        bulk, shear = moduli(nu)
        stiffness = (bulk * unit.stiffness[0] + shear * unit.stiffness[1]).tocsc()
        surface = unit.pushed(unit.zone[2].shape[1]).tocoo().row
        pressed = surface[unit.basis.doflocs[0, unit.free[surface] // 2] <= 1.0 + 1e-9]
        others = np.setdiff1d(np.arange(len(unit.free)), pressed)
        field = np.zeros(len(unit.free))
        field[pressed] = -1.0
        field[others] = linalg.spsolve(stiffness[others][:, others], -(stiffness[others] @ field))
        share = float(field @ (unit.mass @ field)) * breadth / math.pi
        assert 0.5 < share / moving_share(nu, base, breadth, (far - 1.0) * breadth, False) < 2.0, (nu, breadth)


@pytest.mark.tenth
def test_bars_hold_the_answer_of_a_quarter_of_the_tolerance(
    uncovered: Callable[..., dict[str, float]], campaign_size: Callable[[int], int]
) -> None:
    """With --full; else of twice the steps, a stiffer penalty and elements of another order."""
    rng, many = np.random.default_rng(23), campaign_size(10)
    for number in range(many):
        scene = random_layer(rng, ("prony", "elastic")[number % 2])
        found = simulate(scene, "fe", {} if many > 1 else {"tolerance": 1e-2})
        assert found.converged, found.message
        assert (found.energy["radiated"] or 0.0) >= 0.0
        assert abs(found.energy["residual"] or 0.0) < 1e-6 * (found.energy["in"] or 0.0)
        if many > 1:
            assert not uncovered(found, simulate(scene, "fe", {"tolerance": found.tolerance / 4}), RULED), scene
            continue
        finer = {"steps": 2 * found.numerics["steps"], "penalty": 2.0 * found.numerics["penalty"], "order": 4}
        quantities = marched(scene, **finer)[1].quantities
        for name in RULED:
            known = found.quantities[name]
            assert abs((known.value or 0.0) - (quantities[name] or 0.0)) <= (known.error or 0.0), name


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


@pytest.mark.parametrize(("base", "column"), [("bonded", 0.7**2 / 0.4), ("sliding", 1.0)])
def test_a_thin_layer_is_stiffer_than_a_half_space_by_its_column(base: str, column: float) -> None:
    """15 times as wide as thick: pi a^2/h times its confined modulus, or E* where it slides, to a half-space's 2 E* a.

    The confined modulus is (1 - nu)^2/(1 - 2 nu) of E*.
    """
    keys = {"target.base": base, "target.material.nu": 0.3, "target.thickness": 1e-6}
    scene, radius = Scene.load("polymer-layer-waves", keys), 1.5e-5
    size = mdr.ImpactScales(radius, radius**2 / (2.0 * scene.shape.radius), 1.0, 1.0, 2.0, None, None)
    assert layer._stiffness(scene, size) == pytest.approx(0.5 * math.pi * column * radius / 1e-6, rel=0.05)
