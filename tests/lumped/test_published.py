"""Published and independently computed numbers of impact on a half-space."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from lumped import Scene, laws, simulate
from lumped.laws.mdr import estimate

# literature, section 3.5 [D]: g_inf, De = T0/tau -> e, F/F0, t(F)/T0, duration/T0, depth/depth0 of the parabola,
# index 0 the elastic impact with the instantaneous modulus
SPRING_ROWS = [
    (0.0, 0.1, 0.9566, 0.9806, 0.4975, 0.9965, 1.0050),
    (0.0, 1.0, 0.6464, 0.8330, 0.4790, 0.9767, 1.0525),
    (0.0, 3.0, 0.2630, 0.6179, 0.4523, 0.9967, 1.1785),
    (0.1, 0.3, 0.8889, 0.9495, 0.4937, 0.9917, 1.0136),
    (0.1, 3.0, 0.3625, 0.6567, 0.4620, 1.0353, 1.1503),
    (0.1, 10.0, 0.3016, 0.3965, 0.5007, 2.0387, 1.5366),
    (0.5, 1.0, 0.8336, 0.9168, 0.4912, 0.9980, 1.0242),
    (0.5, 10.0, 0.7437, 0.7050, 0.5362, 1.2360, 1.1686),
]
# steel_grid.csv of the audit (parabola, E0 = 1.05e11 as contact modulus): R1, R2 in s -> Lee-Radok peak N, duration
# in us, e, depth in um; Ting peak N, duration us, e
STEEL = [
    (0.46, 0.02, 77.0680379479, 12.2335711909, 0.9998438961, 4.1534582611, 77.0680379472, 12.2447185375, 0.9998748617),
    (5.0, 2e-5, 101.9921271128, 6.5802118298, 0.5071271827, 2.5753216291, 101.9921257617, 7.0013308059, 0.5224603364),
    (2.0, 2e-6, 58.7397014188, 12.5644376514, 0.6484777299, 4.1115231505, 58.7397012690, 13.3375252925, 0.6713192480),
    (1.0, 2e-7, 64.8301577834, 14.1145535538, 0.9620485656, 4.7593424914, 64.8301576630, 14.1971562808, 0.9627720694),
    (5.0, 5e-6, 64.9816393302, 9.9171316049, 0.3459513264, 3.2351229826, 64.9816367585, 11.4592924463, 0.3784353035),
]


def values(law: str, scene: Scene, tolerance: float = 1e-6) -> dict[str, float]:
    result = simulate(laws.get(law).of(scene), scene, tolerance)
    return {name: quantity.value for name, quantity in result.quantities.items() if quantity.value is not None}


def test_hertz_impact_has_its_closed_form() -> None:
    scene = Scene.load("steel-ball")
    radius, mass, v, modulus = 1.984375e-3, 2.569387e-4, 0.998347, scene.contact_modulus.relaxed
    found = values("hertz", scene, 1e-8)
    depth = (15.0 * mass * v**2 / (16.0 * modulus * radius**0.5)) ** 0.4
    assert found["peak_depth"] == pytest.approx(depth, rel=1e-8)
    assert found["duration"] == pytest.approx(2.943275 * depth / v, rel=2e-7)
    assert found["duration"] == pytest.approx(2.868266 * (mass**2 / (radius * modulus**2 * v)) ** 0.2, rel=2e-7)
    assert found["peak_force"] == pytest.approx(1.282689 * (modulus**2 * radius * mass**3 * v**6) ** 0.2, rel=5e-7)
    assert found["restitution"] == pytest.approx(1.0, abs=1e-8)
    # audit 2.1: 66.246 N, 14.246 us, 4.832 um
    assert found["peak_force"] == pytest.approx(66.246, rel=1e-5)


@pytest.mark.parametrize(("relaxed", "deborah", "e", "force", "peak_time", "duration", "depth"), SPRING_ROWS)
def test_spring_row_gives_the_published_table(
    relaxed: float,
    deborah: float,
    e: float,
    force: float,
    peak_time: float,
    duration: float,
    depth: float,
    impact: Callable[..., Scene],
    unit_time: float,
) -> None:
    scene = impact(relaxed, (1.0 - relaxed,), (1.0 / deborah,), profile="parabola")
    elastic = scene.shape.hertz_impact(1e6, scene.mass, scene.velocity)
    found = values("mdr", scene, 1e-5)
    assert found["restitution"] == pytest.approx(e, abs=6e-5)
    assert found["peak_force"] / elastic.force == pytest.approx(force, abs=6e-5)
    assert found["peak_depth"] / elastic.depth == pytest.approx(depth, abs=6e-5)
    # the table's durations are themselves steps of a row of springs
    assert found["duration"] / unit_time == pytest.approx(duration, abs=2e-4)
    assert found["peak_time"] / unit_time == pytest.approx(peak_time, abs=1e-3)


@pytest.mark.parametrize("row", STEEL, ids=lambda row: f"R1={row[0]}-R2={row[1]}")
def test_steel_grid_of_the_audit(row: tuple[float, ...]) -> None:
    ratio, retardation, lr_force, lr_time, lr_e, depth, force, time, e = row
    changes = {"R1": ratio, "R2": retardation, "E0": 1.05e11 * (1.0 - 0.23**2)}
    overrides = {f"target.material.{key}": value for key, value in changes.items()}
    scene = Scene.load("steel-ball-sls", {**overrides, "model.profile": "parabola"})
    clipped, exact = values("correspondence", scene), values("ting", scene)
    assert clipped["peak_force"] == pytest.approx(lr_force, rel=1e-6)
    assert clipped["duration"] == pytest.approx(lr_time * 1e-6, rel=1e-6)
    assert clipped["restitution"] == pytest.approx(lr_e, abs=1e-6)
    assert clipped["peak_depth"] == pytest.approx(depth * 1e-6, rel=1e-6)
    assert exact["peak_force"] == pytest.approx(force, rel=1e-6)
    assert exact["duration"] == pytest.approx(time * 1e-6, rel=1e-6)
    assert exact["restitution"] == pytest.approx(e, abs=1e-6)


def test_estimate_is_close_and_cheap(impact: Callable[..., Scene]) -> None:
    scene = impact(0.1, (0.9,), (0.3,))
    found, scales = values("mdr", scene), estimate(scene, 70)
    assert scales.peak_force == pytest.approx(found["peak_force"], rel=2e-4)
    assert scales.peak_depth == pytest.approx(found["peak_depth"], rel=2e-4)
    assert scales.duration == pytest.approx(found["duration"], rel=2e-4)
    assert scales.restitution == pytest.approx(found["restitution"], abs=2e-4)
    assert scales.contact_radius == pytest.approx(float(scene.profile.load_curve.contact_radius(scales.peak_depth)))
