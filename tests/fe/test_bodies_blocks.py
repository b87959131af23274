"""Blocks on a plane and washers: uniform strain exactly, shape factors between their limits, bars that cover."""

from __future__ import annotations

import math

import numpy as np
import pytest

import meshes
from fe_contact import run
from fe_contact.indentation import indent, press, settings
from lumped import BadInput, Material, Relaxation, Scene
from lumped.load_curves.layer import LayerPunch, PointLayer
from lumped.scene.indenter import Indenter
from lumped.shapes.plate import Plate
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets.plane import Plane
from lumped.targets.washer import Washer

YOUNG = 1e6
RADIUS = 0.01
AREA = math.pi * RADIUS**2
DEPTH = 1e-4


def polymer(nu: float = 0.3) -> Material:
    return Material(Relaxation(YOUNG), nu)


def block(height: float, sides: str, faces: str, nu: float = 0.3) -> Indenter:
    return Indenter(Prism(AREA, height, sides, faces), polymer(nu), Plane())


def washer(radius: float, base: str, nu: float = 0.3, height: float = 0.01) -> Indenter:
    return Indenter(Punch(radius), polymer(nu), Washer(0.005, 0.01, height, base))


def confined(nu: float) -> float:
    return YOUNG * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


@pytest.mark.parametrize("height", [0.002, 0.05])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
def test_uniform_strain_is_exact(height: float, nu: float) -> None:
    for sides, faces, modulus in (
        ("free", "sliding", YOUNG),
        ("confined", "sliding", confined(nu)),
        ("confined", "bonded", confined(nu)),
    ):
        found = indent(block(height, sides, faces, nu), (DEPTH,), {})
        exact = modulus * AREA * DEPTH / height
        assert found.converged
        assert found.force[0] == pytest.approx(exact, rel=1e-9)
        assert abs(found.force[0] - exact) <= found.force_error[0]


def test_a_plate_is_confined_unless_it_says_else() -> None:
    found = indent(Indenter(Plate(AREA, 0.002), polymer(), Plane()), (DEPTH,), {})
    assert found.force[0] == pytest.approx(confined(0.3) * AREA * DEPTH / 0.002, rel=1e-9)
    assert found.modulus == pytest.approx(confined(0.3))


def apparent(height: float, nu: float) -> float:
    """Modulus which a bonded block with free sides seems to have, Pa."""
    force = indent(block(height, "free", "bonded", nu), (DEPTH,), {}).force[0]
    return float(force * height / (AREA * DEPTH))


@pytest.mark.family
@pytest.mark.parametrize("nu", [0.3, 0.45])
def test_bonded_faces_lead_from_youngs_to_the_confined_modulus_as_their_ends_fade(nu: float) -> None:
    """What the bonded ends add is their own: half as much in twice the length; likewise what the sides take."""
    tall = [apparent(height, nu) / YOUNG - 1.0 for height in (0.2, 0.4)]
    flat = [1.0 - apparent(height, nu) / confined(nu) for height in (0.0004, 0.0002)]
    assert tall[0] > 0.0
    assert flat[0] > 0.0
    assert tall[0] / tall[1] == pytest.approx(2.0, abs=0.03)
    assert flat[0] / flat[1] == pytest.approx(2.0, abs=0.05)
    middle = [apparent(height, nu) for height in (0.05, 0.01, 0.002)]
    assert YOUNG < middle[0] < middle[1] < middle[2] < confined(nu)


def test_a_thin_nearly_incompressible_disc_is_a_film_of_fluid() -> None:
    """Squeezed, it presses with (E/2) (a/h)^2: what else there is falls with a/h, and K is 1667 E."""
    ratios = [apparent(RADIUS / shape, 0.4999) / (0.5 * YOUNG * shape**2) for shape in (4.0, 8.0)]
    assert ratios[1] == pytest.approx(1.0, abs=0.06)
    assert abs(ratios[1] - 1.0) < abs(ratios[0] - 1.0)


@pytest.mark.family
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("height", [0.1, 0.01, 0.002])
def test_the_bar_of_a_bonded_block_covers(nu: float, height: float) -> None:
    scene = block(height, "free", "bonded", nu)
    found = indent(scene, (DEPTH,), {"elements_per_contact": 2.0})
    finest = press(
        scene, np.array([DEPTH]), found.contact_radius, settings({}, scene.shape).varied(elements_per_contact=12.0)
    )
    assert abs(found.force[0] - found.modulus * finest.force[0]) <= found.force_error[0]
    assert found.force_error[0] < 1e-4 * found.force[0]


@pytest.mark.parametrize("height", [0.001, 0.01, 0.1])
def test_a_covered_washer_on_a_sliding_base_is_strained_alike_everywhere(height: float) -> None:
    found = indent(washer(0.02, "sliding", height=height), (1e-5, DEPTH), {})
    exact = YOUNG * math.pi * (0.01**2 - 0.005**2) * found.depth / height
    np.testing.assert_allclose(found.force, exact, rtol=1e-7)
    assert np.all(np.abs(found.force - exact) <= found.force_error)
    np.testing.assert_allclose(found.contact_radius, 0.01)


def test_a_punch_may_cover_a_washer_whatever_digits_its_radius_has() -> None:
    """Gmsh is told ten of them: the rim is the outer radius before and after."""
    for outer in np.random.default_rng(3).uniform(1.0, 3.0, 8):
        mesh = meshes.washer(0.5, 0.9, float(outer), float(outer), bonded=False)
        assert mesh.p[0].max() == pytest.approx(outer, rel=1e-9)


def test_a_bonded_washer_is_stiffer_than_a_sliding_one_and_softer_than_a_confined_one() -> None:
    sliding, bonded = (indent(washer(0.02, base), (DEPTH,), {}).force[0] for base in ("sliding", "bonded"))
    assert sliding < bonded < sliding * confined(0.3) / YOUNG


@pytest.mark.family
@pytest.mark.parametrize(("radius", "nu"), [(0.008, 0.3), (0.0055, 0.3), (0.0099, 0.45), (0.02, 0.4999)])
@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_the_bar_of_a_washer_covers(radius: float, nu: float, base: str) -> None:
    scene = washer(radius, base, nu, 0.004)
    found = indent(scene, (DEPTH,), {})
    finest = press(
        scene,
        np.array([DEPTH]),
        found.contact_radius,
        settings({}, scene.shape).varied(elements_per_contact=6.0, penalty=1e4),
    )
    assert abs(found.force[0] - found.modulus * finest.force[0]) <= found.force_error[0]
    assert found.force_error[0] < 1e-4 * found.force[0]


@pytest.mark.tenth
def test_the_bar_of_a_washer_with_a_narrow_hole_covers() -> None:
    """Displacements go as 1/r about it, over less than what an element elsewhere is long."""
    scene = Indenter(Punch(0.0184), polymer(0.49), Washer(1.2e-4, 0.0211, 0.004, "bonded"))
    given = {"order": 4, "elements_per_contact": 2.6}
    found = indent(scene, (DEPTH,), given)
    finest = press(scene, np.array([DEPTH]), found.contact_radius, settings({"elements_per_contact": 5.0}, scene.shape))
    assert abs(found.force[0] - found.modulus * finest.force[0]) <= found.force_error[0]


@pytest.mark.family
@pytest.mark.parametrize(("base", "outer_radius"), [("bonded", 0.1), ("sliding", 1.0)])
def test_a_wide_washer_with_a_needle_hole_is_the_layer(base: str, outer_radius: float) -> None:
    """What a free rim far away takes falls with its distance squared if the base slides, else like e^-x."""
    wide = Washer(1e-6, outer_radius, 0.01, base)
    found = indent(Indenter(Punch(0.01), polymer(), wide), (DEPTH,), {})
    exact = found.modulus * float(LayerPunch(0.01, PointLayer(0.01, 0.3, base)).force(DEPTH))
    assert found.force[0] == pytest.approx(exact, rel=3e-5)


@pytest.mark.parametrize(
    ("key", "build"),
    [
        ("inner_radius", lambda: Washer(0.01, 0.01, 0.01, "bonded")),
        ("striker.radius", lambda: washer(0.004, "bonded")),
        ("striker.shape", lambda: Indenter(Prism(AREA, 0.1), polymer(), Washer(0.005, 0.01, 0.01, "bonded"))),
        ("striker.shape", lambda: Indenter(Punch(0.01), polymer(), Plane())),
        ("striker.shape", lambda: Indenter(Prism(AREA, 0.1), polymer())),
        ("--depths", lambda: indent(washer(0.02, "bonded"), (0.011,), {})),
        ("--depths", lambda: indent(block(0.01, "free", "bonded"), (0.01,), {})),
    ],
)
def test_impossible_geometry_is_refused_by_name(key: str, build: object) -> None:
    assert callable(build)
    with pytest.raises(BadInput, match=key):
        build()


def test_a_bonded_block_whose_bulk_modulus_stays_is_refused_by_its_key() -> None:
    young = Relaxation(YOUNG, (YOUNG,), (0.02,))
    block, material = Prism(AREA, RADIUS, "free", "bonded"), Material(young, 0.4, constant="bulk")
    with pytest.raises(BadInput, match=r"striker\.material\.constant"):
        run(Scene(block, 0.05, 0.1, material, target=Plane()))
