"""How far finite spheres are from Hertz: a slope and three terms, against finer meshes and other units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fe_contact.indentation import indent, press, settings
from lumped import Material, Relaxation, Sphere
from lumped.indentation import FiniteSize, finite_size
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Model
from lumped.targets.sphere import SphereTarget as Ball


def balls(nu: float, length: float = 1.0, modulus: float = 1e6, support: str | None = "free") -> Indenter:
    material = Material(Relaxation(modulus), nu)
    return Indenter(Sphere(0.01 * length), material, Ball(0.02 * length, support), striker_material=material)


def depths(number: int, seed: int) -> np.ndarray:
    """m, of contact radii between 0.7 and 7 % of the larger radius."""
    share = np.exp(np.random.default_rng(seed).uniform(np.log(0.007), np.log(0.07), number))
    return (0.02 * share) ** 2 * (1.0 / 0.01 + 1.0 / 0.02)


def deviation(scene: Indenter, depth: np.ndarray) -> FiniteSize:
    found = indent(scene, tuple(depth), {"tolerance": 1e-4}).finite_size
    assert found is not None
    return found


def value(quantity: Quantity) -> float:
    assert quantity.value is not None
    return quantity.value


def bar(quantity: Quantity) -> float:
    assert quantity.error is not None
    return quantity.error


@pytest.mark.tenth
def test_the_slope_and_the_terms_hold_what_a_finer_mesh_finds_at_other_depths() -> None:
    """Parabolas, for which Hertz is exact by hand: F = 4/3 E* sqrt(Rg) depth^3/2, a = sqrt(Rg depth)."""
    scene, asked, other = replace(balls(0.2), model=Model(profile="parabola")), depths(6, 1), depths(8, 2)
    other = other[(other > asked.min()) & (other < asked.max())]
    found, gap = deviation(scene, asked), 1.0 / (1.0 / 0.01 + 1.0 / 0.02)
    share = np.sqrt(gap * other) / 0.02
    fine = settings({}, scene.shape).varied(elements_per_contact=8.0, penalty=1e4)
    forces = press(scene, other, 0.02 * share, fine).force
    slope = (forces / (4.0 / 3.0 * np.sqrt(gap) * other**1.5) - 1.0) / share
    assert other.size >= 3
    assert np.all(np.abs(slope - value(found.slope)) <= bar(found.slope))
    c, k, d = (value(term) for term in found.terms.values())
    assert np.all(np.abs(c + k * np.log(share) + d * share - slope) <= found.error.max() / share + 5e-3)


@pytest.mark.tenth
def test_the_logarithm_is_there_unless_the_spheres_are_incompressible() -> None:
    loose, tight = (deviation(balls(nu), depths(6, 3)).terms["k"] for nu in (0.2, 0.49))
    assert value(loose) > bar(loose)
    assert abs(value(tight)) <= bar(tight)


@pytest.mark.tenth
def test_the_deviation_knows_no_units() -> None:
    rng, depth = np.random.default_rng(5), depths(4, 4)
    length, modulus = 10.0 ** rng.uniform(-2.0, 2.0), 1e6 * 10.0 ** rng.uniform(-2.0, 2.0)
    one, other = deviation(balls(0.3), depth), deviation(balls(0.3, length, modulus), length * depth)
    for first, second in zip((one.slope, *one.terms.values()), (other.slope, *other.terms.values()), strict=True):
        assert value(second) == pytest.approx(value(first), rel=1e-6)


def test_a_deviation_is_what_a_force_has_more_than_hertz() -> None:
    """Two per cent of F/E* = 4/3 sqrt(Rg) depth^3/2, to half a per cent."""
    scene, depth, gap = (
        replace(balls(0.2), model=Model(profile="parabola")),
        depths(3, 2),
        1.0 / (1.0 / 0.01 + 1.0 / 0.02),
    )
    hertz = 4.0 / 3.0 * np.sqrt(gap) * depth**1.5
    found = finite_size(scene, depth, 1.02 * hertz, 0.005 * hertz)
    assert found is not None
    assert found.deviation == pytest.approx(0.02)
    assert found.error == pytest.approx(0.005)
    assert found.share == pytest.approx(np.sqrt(gap * depth) / 0.02)


def test_half_spaces_and_two_depths_tell_no_deviation() -> None:
    assert indent(balls(0.3, support=None), tuple(depths(3, 6)), {}).to_json()["deviation"] is None
    assert indent(balls(0.3), tuple(depths(2, 6)), {}).to_json()["deviation"] is None
