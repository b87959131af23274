"""Contacts under profiles that rise steeply at their edge, on a layer, against the layer's integral equation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fe_contact
from fe_contact.indentation import indent
from lumped import Material, Relaxation, Scene, Sphere, simulate
from lumped.laws import ting
from lumped.scene.indenter import Indenter
from lumped.shapes import Shape
from lumped.shapes.power import PowerProfile
from lumped.targets.layer import Layer

THICKNESS = 1e-3
WIDEST = 0.61 * THICKNESS
STEEP = {
    "sphere up to half its radius": Sphere(WIDEST / 0.5),
    "sphere up to four fifths of its radius": Sphere(WIDEST / 0.8),
    **{f"r^{n:g}": PowerProfile(1e-2 * WIDEST ** (1.0 - n), n) for n in (4.0, 7.3, 12.0, 20.0)},
}


@pytest.mark.family
@pytest.mark.parametrize("shape", STEEP.values(), ids=STEEP.keys())
def test_force_and_contact_radius_under_steep_profiles(shape: Shape) -> None:
    layer, nu = Layer(THICKNESS, "bonded"), 0.37
    curve = layer.load_curve(shape, nu)
    radius = WIDEST * np.array([1.0, 0.83, 0.47])
    depths = tuple(float(curve.depth(a)) for a in radius)
    found = indent(Indenter(shape, Material(Relaxation(1e6), nu), layer), depths, {})
    force = found.modulus * np.asarray(curve.force(found.depth))
    assert np.all(np.abs(found.force - force) <= found.force_error)
    np.testing.assert_allclose(found.force, force, rtol=5e-4)
    np.testing.assert_allclose(found.contact_radius, radius, rtol=2e-3)


@pytest.mark.tenth
def test_contact_radius_of_an_impact_under_a_steep_profile() -> None:
    """Against Ting on the layer's load curve, from shortly after touch, where r^8 opens like t^(1/8), to the end."""
    scene = Scene.load("polymer-layer", {"striker.velocity": 0.05})
    blunt = PowerProfile(1e-4 * 1e-3**-8.0, 8.0)
    scene = replace(scene, shape=blunt)
    found, exact = fe_contact.run(scene, tolerance=5e-3).history, simulate(ting.of(scene), scene, 1e-6).history
    share = np.linspace(0.03, 0.97, 200)
    ours = np.interp(share * found.time[-1], found.time, found.contact_radius)
    theirs = np.interp(share * exact.time[-1], exact.time, exact.contact_radius)
    assert np.abs(ours - theirs).max() <= 5e-3 * theirs.max()
