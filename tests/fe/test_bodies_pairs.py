"""Two deformable bodies: half-spaces under the gap of two spheres, finite spheres and cylinders."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fe_contact.indentation import indent, press, settings
from lumped import BadInput, Material, Relaxation, Sphere
from lumped.indentation import indent as closed_form
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes.cylinder import Cylinder as Roller
from lumped.shapes.punch import Punch
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.sphere import SphereTarget as Ball

SOFT = Material(Relaxation(1e6), 0.3)
STIFF = Material(Relaxation(3e6), 0.45)
SLS = Material(Relaxation(6e5, (1.2e6,), (0.01,)), 0.4)
FLUID_AT_ONCE = Material(Relaxation(4e5, (8e5,), (0.02,)), 0.3, constant="bulk")
DEPTHS = (1e-6, 3.7e-5, 1e-3)


def balls(striker: Material | None, target: Material = SOFT, support: str | None = None, **more: object) -> Indenter:
    return Indenter(Sphere(0.01), target, Ball(0.02, support), striker_material=striker, **more)  # type: ignore[arg-type]


def rollers(striker: Material | None, support: str = "free") -> Indenter:
    return Indenter(Roller(0.01, 0.05), SOFT, CylinderTarget(0.02, support), striker_material=striker)


@pytest.mark.parametrize("instant", [False, True])
@pytest.mark.parametrize("pair", [(None, SOFT), (SOFT, SOFT), (STIFF, SOFT), (SLS, SOFT), (FLUID_AT_ONCE, SLS)])
def test_two_half_spaces_are_the_exact_law(pair: tuple[Material | None, Material], instant: bool) -> None:
    scene = balls(*pair)
    found, exact = indent(scene, DEPTHS, {}, instant), closed_form(scene, DEPTHS, "mdr", instant)
    assert np.all(np.abs(found.force - exact.force) <= found.force_error)
    np.testing.assert_allclose(found.force, exact.force, rtol=1e-4)
    np.testing.assert_allclose(found.contact_radius, exact.contact_radius, rtol=2e-3)


def test_parabolas_are_hertz_with_both_curvatures_and_both_moduli() -> None:
    scene = balls(STIFF, model=Model(profile="parabola"))
    found, depth = indent(scene, DEPTHS, {}), np.array(DEPTHS)
    modulus = 1.0 / ((1.0 - 0.3**2) / 1e6 + (1.0 - 0.45**2) / 3e6)
    radius = 1.0 / (1.0 / 0.01 + 1.0 / 0.02)
    hertz = 4.0 / 3.0 * modulus * np.sqrt(radius) * depth**1.5
    assert np.all(np.abs(found.force - hertz) <= found.force_error)
    np.testing.assert_allclose(found.contact_radius, np.sqrt(radius * depth), rtol=2e-3)


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("striker", "support"),
    [
        (None, "held"),
        (STIFF, "free"),
        pytest.param(None, "free", marks=pytest.mark.full),
        pytest.param(STIFF, "held", marks=pytest.mark.full),
    ],
)
def test_finite_spheres_leave_hertz_like_a_over_r(striker: Material | None, support: str) -> None:
    """Twice the radius of contact, twice the deviation; the bar covers what a finer mesh finds."""
    depths = np.array([2.5e-6, 1e-5, 4e-5])  # contact radii in the ratio 1 : 2 : 4
    scene = balls(striker, support=support)
    found, half_spaces = indent(scene, tuple(depths), {}), closed_form(balls(striker), tuple(depths), "mdr")
    finest = press(
        scene, depths, found.contact_radius, settings({}, scene.shape).varied(elements_per_contact=10.0, penalty=1e4)
    )
    slope = (found.force / half_spaces.force - 1.0) * 0.02 / half_spaces.contact_radius
    bar = found.force_error / found.force * 0.02 / half_spaces.contact_radius
    assert np.all(np.abs(found.force - found.modulus * finest.force) <= found.force_error)
    assert np.all(found.force_error < 3e-4 * found.force)
    np.testing.assert_allclose(found.contact_radius, finest.contact_radius, rtol=2e-3)
    assert np.all(slope > 0.0)
    assert np.all(np.abs(np.diff(slope) / slope[:-1]) < 0.15 + bar[1:] / slope[1:] + bar[:-1] / slope[:-1])


def terms_of_a_over_r(nu: float) -> tuple[np.ndarray, float]:
    """Coefficients of F/Hertz - 1 on a/R, (a/R) ln(a/R) and (a/R)^2, and the largest relative residual."""
    share = np.geomspace(0.005, 0.1, 8)
    depths, material = (0.02 * share) ** 2 * (1.0 / 0.01 + 1.0 / 0.02), Material(Relaxation(1e6), nu)
    scene, exact = balls(None, material, "free"), closed_form(balls(None, material), tuple(depths), "mdr")
    fine = settings({}, scene.shape).varied(elements_per_contact=6.0, penalty=1e4)
    deviation = exact.modulus * press(scene, depths, exact.contact_radius, fine).force / exact.force - 1.0
    x = exact.contact_radius / 0.02
    columns = np.stack([x, x * np.log(x), x**2], axis=1) / deviation[:, None]
    found, *_ = np.linalg.lstsq(columns, np.ones_like(x), rcond=None)
    return found, float(np.abs(columns @ found - 1.0).max())


@pytest.mark.tenth
def test_what_finite_spheres_add_to_hertz_holds_a_logarithm_if_they_are_compressible() -> None:
    """Why the deviation is no plain a/R: a sphere's point load adds a logarithm that falls like (1 - 2 nu)^2."""
    loose, left = terms_of_a_over_r(0.2)
    tight, rest = terms_of_a_over_r(0.49)
    assert max(left, rest) < 1e-2
    assert loose[1] > 0.1
    assert abs(tight[1]) < 0.01 * tight[0]
    assert min(loose[0], tight[0]) > 0.5


def approach(line_force: np.ndarray, half_width: np.ndarray, radius: float, material: Material) -> np.ndarray:
    """Of a contact to the centre of mass of a free cylinder, whose acceleration balances the line force, N/m.

    Flamant's field, the uniform tension P/(2 pi R) and the linear field of the inertia leave the circle without
    traction. Integrated over the axis, and relative to the mean displacement,
    (P/(pi E*)) (2 ln(2R/a) - 1/(4 (1 - nu))), up to (a/R)^2.
    """
    bracket = 2.0 * np.log(2.0 * radius / half_width) - 0.25 / (1.0 - material.nu)
    return np.asarray(line_force * bracket / (math.pi * material.contact_modulus().relaxed))


@pytest.mark.parametrize("striker", [None, SOFT, STIFF])
def test_free_cylinders_are_the_disc_that_its_inertia_balances(striker: Material | None) -> None:
    found = indent(rollers(striker), (1e-6, 3e-6, 1e-5), {})
    line_force = found.force / 0.05
    radius = 1.0 / (1.0 / 0.01 + 1.0 / 0.02)
    half_width = 2.0 * np.sqrt(line_force * radius / (math.pi * found.modulus))
    depth = approach(line_force, half_width, 0.02, SOFT)
    if striker is not None:
        depth = depth + approach(line_force, half_width, 0.01, striker)
    np.testing.assert_allclose(depth, found.depth, rtol=5e-5)
    np.testing.assert_allclose(found.contact_radius, half_width, rtol=2e-3)


@pytest.mark.family
@pytest.mark.parametrize("support", ["free", "held"])
def test_the_bar_of_cylinders_covers(support: str) -> None:
    scene, depths = rollers(STIFF, support), (1e-5, 3.7e-5, 2.3e-4)
    found = indent(scene, depths, {})
    finest = press(
        scene,
        np.array(depths),
        found.contact_radius,
        settings({}, scene.shape).varied(elements_per_contact=8.0, penalty=1e4),
    )
    force = found.modulus * 0.05 * finest.force
    assert np.all(np.abs(found.force - force) <= found.force_error)
    assert np.all(found.force_error < 1e-4 * found.force)
    np.testing.assert_allclose(found.contact_radius, finest.contact_radius, rtol=2e-3)


@pytest.mark.tenth
def test_a_much_stiffer_striker_is_a_rigid_one() -> None:
    hard = Material(Relaxation(1e12), 0.3)
    for pair in (balls, lambda striker: balls(striker, support="held"), rollers):
        stiff, rigid = (indent(pair(striker), (1e-5, 1e-4), {}) for striker in (hard, None))
        assert np.all(np.abs(stiff.force - rigid.force) <= stiff.force_error + rigid.force_error)
        np.testing.assert_allclose(stiff.force, rigid.force, rtol=1e-4)


def test_bodies_that_trade_places_answer_alike() -> None:
    """The smaller one struck by the larger, both free: action is reaction."""
    there = balls(STIFF, SOFT, "free")
    back = Indenter(Sphere(0.02), STIFF, Ball(0.01, "free"), striker_material=SOFT)
    first, second = indent(there, (1e-5, 1e-4), {}), indent(back, (1e-5, 1e-4), {})
    assert np.all(np.abs(first.force - second.force) <= first.force_error + second.force_error)


@pytest.mark.parametrize(
    ("key", "build"),
    [
        ("striker.shape", lambda: Indenter(Punch(0.01), SOFT, Ball(0.02, "free"))),
        ("striker.shape", lambda: Indenter(Roller(0.01, 0.05), SOFT, Ball(0.02, None))),
        ("striker.shape", lambda: Indenter(Sphere(0.01), SOFT, CylinderTarget(0.02, "free"))),
        ("support", lambda: Ball(0.02, "glued")),
        ("striker.material", lambda: Indenter(Sphere(0.01), SOFT, striker_material=STIFF)),
        ("--depths", lambda: indent(balls(STIFF), (0.01,), {})),
    ],
)
def test_impossible_pairs_are_refused_by_name(key: str, build: object) -> None:
    assert callable(build)
    with pytest.raises(BadInput, match=key):
        build()
