"""The O-ring: a wide one is a cylinder between planes that is free to stretch; bars that cover; refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fe_contact.errors import ContactTooWide
from fe_contact.indentation import indent, press, settings
from lumped import BadInput, Material, Relaxation
from lumped.scene.indenter import Indenter
from lumped.shapes.punch import Punch
from lumped.shapes.sphere import Sphere
from lumped.targets.o_ring import ORing

SECTION = 0.005


def pressed(mean_radius: float, nu: float = 0.3) -> Indenter:
    material = Material(Relaxation(1e6), nu)
    return Indenter(Punch(2.0 * mean_radius), material, ORing(mean_radius, SECTION))


def approach(line_force: np.ndarray, nu: float) -> tuple[np.ndarray, np.ndarray]:
    """Of two planes on a long cylinder, and the half-width of its contacts; the force per length over E*.

    Johnson 1985, ISBN 978-0-521-34796-9, (5.57) holds the length; a ring may grow along its own, which takes the
    mean of the stress along it away: by Poisson's ratio 2 nu^2/(1 - nu^2) more in the bracket.
    """
    half_width = 2.0 * np.sqrt(line_force * SECTION / math.pi)
    bracket = 2.0 * np.log(4.0 * SECTION / half_width) - 1.0 + 2.0 * nu**2 / (1.0 - nu**2)
    return 2.0 / math.pi * line_force * bracket, half_width


@pytest.mark.family
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
def test_a_wide_ring_is_a_cylinder_between_planes(nu: float) -> None:
    mean_radius = 1e4 * SECTION
    found = indent(pressed(mean_radius, nu), (1e-6, 3e-6, 1e-5), {})
    depth, half_width = approach(found.force / (2.0 * math.pi * mean_radius * found.modulus), nu)
    np.testing.assert_allclose(depth, found.depth, rtol=5e-5)
    np.testing.assert_allclose(found.contact_radius, half_width, rtol=2e-3)


def test_the_cylinder_is_the_limit_of_slender_rings() -> None:
    """Held by its own hoop, a stouter ring is stiffer; what the hoop does falls with the square of the slenderness."""

    def excess(slenderness: float) -> float:
        mean_radius = slenderness * SECTION
        found = indent(pressed(mean_radius), (1e-5,), {})
        depth, _ = approach(found.force / (2.0 * math.pi * mean_radius * found.modulus), 0.3)
        return float(depth[0] / found.depth[0] - 1.0)

    limit = excess(1e4)
    near, far = excess(4.0) - limit, excess(8.0) - limit
    assert near / far == pytest.approx(4.0, rel=0.15)


@pytest.mark.family
@pytest.mark.parametrize(("slenderness", "nu"), [(2.0, 0.3), (8.0, 0.49)])
def test_the_bar_covers_wherever_the_edges_lie(slenderness: float, nu: float) -> None:
    scene, depths = pressed(slenderness * SECTION, nu), (1e-5, 3.7e-5, 2.3e-4)
    found = indent(scene, depths, {})
    finest = press(
        scene,
        np.array(depths),
        found.contact_radius,
        settings({}, scene.shape).varied(elements_per_contact=8.0, penalty=1e4),
    )
    assert np.all(np.abs(found.force - found.modulus * finest.force) <= found.force_error)
    assert np.all(found.force_error < 1e-4 * found.force)
    np.testing.assert_allclose(found.contact_radius, finest.contact_radius, rtol=2e-3)


@pytest.mark.parametrize(
    ("key", "build"),
    [
        ("section_radius", lambda: ORing(0.005, 0.005)),
        ("striker.radius", lambda: Indenter(Punch(0.054), Material(Relaxation(1e6), 0.3), ORing(0.05, 0.005))),
        ("striker.shape", lambda: Indenter(Sphere(1.0), Material(Relaxation(1e6), 0.3), ORing(0.05, 0.005))),
        ("--depths", lambda: indent(pressed(0.05), (0.01,), {})),
    ],
)
def test_impossible_geometry_is_refused_by_name(key: str, build: object) -> None:
    assert callable(build)
    with pytest.raises(BadInput, match=key):
        build()


def test_a_contact_that_leaves_the_fine_mesh_is_no_number() -> None:
    with pytest.raises(ContactTooWide):
        indent(pressed(0.05), (0.0095,), {})


@pytest.mark.parametrize("depth", [2e-3, 5e-3, 8e-3])
def test_deep_contacts_stop_short_of_the_middle_plane(depth: float) -> None:
    """Its nodes are held: no pressure may count on them, however coarse the mesh around."""
    found = indent(pressed(0.05), (depth,), {"tolerance": 1e-2})
    assert found.converged
