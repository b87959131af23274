"""What finite strains change of a force to first order: in Hertz's field by finite elements, and as it is measured."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP3,
    ElementVector,
    FacetBasis,
    LinearForm,
    condense,
    solve,
)

import meshes
from fe_contact.indentation import expected, press, settings
from lumped.errors import NotReached
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import ENERGIES, energy_of, strained
from lumped.numbers import Array
from lumped.result.model_ledger import Peak, ledger_at_rest
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes import Shape, Sphere
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.plate import Plate
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer
from lumped.targets.o_ring import ORing
from lumped.targets.plane import Plane
from lumped.targets.ring import Ring
from lumped.targets.washer import Washer

RNG = np.random.default_rng(13)


def gradient(u: Any, r: Any) -> Any:
    """Of an axisymmetric displacement, shape (3, 3, ...), the hoop last."""
    found = np.zeros((3, 3, *r.shape))
    found[:2, :2], found[2, 2] = u.grad, u[0] / r
    return found


@BilinearForm
def stiffness(u: Any, v: Any, w: Any) -> Any:
    """Of a body with G = 1."""
    first, second = (gradient(one, w.x[0]) for one in (u, v))
    traces = np.einsum("ii...", first) * np.einsum("ii...", second)
    strains = 0.5 * (first + np.swapaxes(first, 0, 1))
    return (w.lame * traces + 2.0 * np.einsum("ij...,ij...", strains, second)) * w.x[0]


def pressure(r: Any) -> Any:
    """Hertz's, one in the middle of a contact of radius one."""
    return np.sqrt(np.maximum(1.0 - r**2, 0.0))


@LinearForm
def load(v: Any, w: Any) -> Any:
    return -pressure(w.x[0]) * v[1] * w.x[0]


WAYS = np.array([[1, 0, 0], [1, 1, 1], [1, -1, 0.5], [0.3, -0.7, 1], [-0.5, 0.2, 0.9], [1, 1, 0]])
STEP = 2e-3  # of the strain along them


def cubic(name: str, lame: float) -> Array:
    """Coefficients of tr E^3, tr E tr E^2 and tr(E^3) in an energy with G = 1, from odd differences; all of its third
    order, since lambda/2 (tr E)^2 + G E:E is its second.
    """

    def odd(step: float) -> Array:
        stretches = [np.sqrt(1.0 + 2.0 * sign * step * WAYS.T) - 1.0 for sign in (1, -1)]
        none = np.zeros(len(WAYS))
        ends = [np.stack([along[0], none, none, along[1], along[2]]) for along in stretches]
        above, below = (strained(energy_of(name), end, 1.0, lame).energy for end in ends)
        return np.asarray(0.5 * (above - below) / step**3)

    terms = np.stack([WAYS.sum(axis=1) ** 3, WAYS.sum(axis=1) * (WAYS**2).sum(axis=1), (WAYS**3).sum(axis=1)], axis=1)
    third = (4.0 * odd(STEP) - odd(2.0 * STEP)) / 3.0
    found, *_ = np.linalg.lstsq(terms, third)
    assert terms @ found == pytest.approx(third, abs=1e-4 * (1.0 + lame))  # it is isotropic
    return np.asarray(found)


def first_order(nu: float) -> dict[str, float]:
    """c1 of each energy: its cubic terms and the work against the gap, over (4/9) E* d^3, and that of the gap alone.

    E = (H + H^T + H^T H)/2: lambda/2 (tr E)^2 + G E:E, in which all energies begin, has cubic terms in H.
    """
    mesh, element, lame = meshes.half_space(8.0, 400.0), ElementVector(ElementTriP3()), 2.0 * nu / (1.0 - 2.0 * nu)
    body = Basis(mesh, element, intorder=7)
    surface = FacetBasis(mesh, element, facets=mesh.boundaries["surface"], intorder=12)
    held = np.concatenate([body.get_dofs("far").all(), body.get_dofs("axis").all(["u^1"])])
    u = solve(*condense(stiffness.assemble(body, lame=lame), load.assemble(surface), D=np.unique(held)))
    r = np.asarray(body.global_coordinates())[0]
    rise, volume = gradient(body.interpolate(u), r), body.dx * r
    strain = 0.5 * (rise + np.swapaxes(rise, 0, 1))
    turned = np.einsum("ki...,kj...->ij...", rise, rise)
    trace, square = np.einsum("ii...", strain), np.einsum("ij...,jk...->ik...", strain, strain)
    powers = trace**3, trace * np.einsum("ii...", square), np.einsum("ij...,ji...", square, strain)
    cubes = np.array([np.sum(power * volume) for power in powers])
    kirchhoff = 0.5 * lame * np.sum(trace * np.einsum("ii...", turned) * volume)
    kirchhoff += np.sum(np.einsum("ij...,ij...", strain, turned) * volume)
    at = np.asarray(surface.global_coordinates())[0]
    modulus = 2.0 / (1.0 - nu)
    depth = 0.5 * math.pi / modulus  # a^2/R with a = 1 where Hertz's pressure is one
    gap = -np.sum(pressure(at) * np.asarray(surface.interpolate(u))[0] * at * depth * surface.dx * at)
    works = {"gap": gap}
    for name in ENERGIES.names:
        works[name] = gap + kirchhoff + cubic(name, lame) @ cubes
    return {name: float(2.0 * math.pi * work / (4.0 / 9.0 * modulus * depth**3)) for name, work in works.items()}


def told(pressed: Indenter, name: str | None, depth: float, force: float, radius: float) -> tuple[float, float]:
    """What the ledger says of large strains with an energy: least and most."""
    alike = replace(pressed, material=replace(pressed.material, hyperelastic=name))
    (found, *_) = ledger_at_rest(alike, Peak(force, depth, radius, math.inf))
    assert found.effect == "finite strain"
    return found.spread or (found.size, found.size)


@pytest.mark.family
@pytest.mark.parametrize("nu", [-0.6, 0.0, 0.3, 0.49, *RNG.uniform(-0.5, 0.48, 2)])
def test_the_ledger_has_a_spheres_first_order_as_finite_elements_find_it(nu: float) -> None:
    """Of every energy. Gap alone: (1-2nu)/((1-nu) pi) by Johnson's (3.41b), ISBN 978-0-521-34796-9."""
    found, ball = first_order(nu), Indenter(Sphere(1.0), Material(Relaxation(1.0), nu))
    assert found.pop("gap") == pytest.approx((1.0 - 2.0 * nu) / (1.0 - nu) / math.pi, abs=2e-4)
    strains = ball.target.strains(ball.shape, nu, 1e-6, 1e-3)
    for name, change in found.items():
        assert 1e3 * strains.change(energy_of(name)) == pytest.approx(change, abs=2e-3), name
        assert strains.change(energy_of(name), struck=True) == pytest.approx(
            0.5 * strains.change(energy_of(name)), rel=5e-3
        )


@pytest.mark.parametrize(("nu", "told_at_all"), [(-0.78, False), (-0.3, True)])
def test_an_o_ring_that_loses_its_bulk_modulus_has_no_first_order(nu: float, told_at_all: bool) -> None:
    """Neo-Hooke has hardly any below nu = -0.5, and loses it at a twentieth of its height: unknown, not less."""
    ring = Indenter(Punch(2.0), Material(Relaxation(1.0), nu, hyperelastic="neo_hooke"), ORing(1.0, 0.125))
    depth = 0.0125
    force, radius = measured(ring, depth)
    change = measured(replace(ring, model=Model(kinematics="finite")), depth)[0] / force - 1.0
    first = abs(ring.target.strains(ring.shape, nu, depth, radius).change(energy_of("neo_hooke")))
    assert (first < abs(change) < FACTOR * first) is told_at_all
    for named in (ring, replace(ring, material=replace(ring.material, hyperelastic=None))):
        (found, *_) = ledger_at_rest(named, Peak(force, depth, radius, math.inf))
        assert found.known is told_at_all
        assert ("neo-Hooke loses its bulk modulus" in found.verdict(0.01)) is not told_at_all


SCENES = 40  # of a geometry
FACTOR = 3.0
CANCELLED = 0.1  # of the largest change by any energy, where cubic terms and gap cancel


def drawn(random: np.random.Generator, name: str) -> tuple[Shape, Target, float]:
    """Striker, target and depth of a geometry; a length of it is one."""

    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    striker, _, base = name.partition(" ")
    if base == "datum":
        depth = between(0.002, 0.1)
        return Cylinder(1.0, 1.0), HalfSpace(max(between(0.3, 100.0), 4.0 * math.sqrt(depth))), depth
    if base in ("bonded", "sliding"):
        depth, width = between(0.004, 0.1), between(0.1, 6.0)
        shape: Shape = {"sphere": Sphere(1.0), "line": Cylinder(1.0, 1.0), "cone": Cone(between(1.0, 12.0))}[striker]
        a = float(shape.load_curve.contact_radius(depth)) if striker == "cone" else math.sqrt(depth)
        return shape, Layer(max(a / width, depth / 0.25), base), depth
    if striker == "ring":
        thickness = between(0.05, 2.0)
        return Cylinder(1.0 - between(0.005, 0.3), 1.0), Ring(1.0, thickness), thickness * between(0.01, 0.25)
    if striker == "washer":
        inner = between(0.2, 2.0)
        washer = Washer(inner, inner + between(0.5, 4.0), 1.0, str(random.choice(["bonded", "sliding"])))
        return Punch(9.0), washer, between(0.01, 0.25)
    if striker == "o_ring":
        section = between(0.1, 0.8)
        return Punch(2.0), ORing(1.0, section), section * between(0.02, 0.5)
    if striker == "block":
        return (
            [Prism(1.0, 1.0, "free", "sliding"), Plate(1.0, 1.0)][int(random.integers(2))],
            Plane(),
            between(0.01, 0.25),
        )
    return (Sphere(1.0) if striker == "sphere" else Cone(between(1.0, 12.0))), HalfSpace(), between(0.004, 0.2)


def measured(pressed: Indenter, depth: float) -> tuple[float, float]:
    """Force over E* and contact radius at one depth, with settings to about 1e-3."""
    numerics = settings({"tolerance": 1e-3}, pressed.shape, pressed.model.finite)
    depths = np.array([depth])
    found = press(pressed, depths, expected(pressed, depths, numerics), numerics)
    return float(found.force[0]), float(found.contact_radius[0])


@pytest.mark.family
@pytest.mark.parametrize(
    "name",
    ["sphere bonded", "sphere", "cone", "block", "ring", "o_ring", "washer", "sphere sliding", "line bonded",
     "line sliding", "cone bonded", "cone sliding", "line datum"],
)  # fmt: skip
def test_what_the_ledger_says_of_large_strains_is_within_a_factor_of_three(
    name: str, campaign_size: Callable[..., int]
) -> None:
    """Of random scenes, energies and Poisson's ratios, each pressed with large strains and with small ones.

    All scenes with --full, else the first of a geometry.
    """
    random, wrong = np.random.default_rng(31), list[str]()
    for _ in range(SCENES if campaign_size(SCENES) == SCENES else 1):
        (shape, target, depth), nu = drawn(random, name), float(random.uniform(0.0, 0.49))
        energy = str(random.choice(ENERGIES.names))
        small = Indenter(shape, Material(Relaxation(1.0), nu, hyperelastic=energy), target)
        try:
            larger = measured(replace(small, model=Model(kinematics="finite")), depth)[0]
        except NotReached:
            continue  # St Venant and Kirchhoff's law loses its ellipticity
        force, radius = measured(small, depth)
        change = larger / force - 1.0
        (estimate, _), spread = (told(small, one, depth, force, radius) for one in (energy, None))
        unsure = CANCELLED * max(map(abs, spread))
        if not (1.0 / FACTOR < abs(change) / estimate < FACTOR or max(abs(change), estimate) < unsure):
            wrong.append(f"{energy} {nu:.3f} {shape} {target} {depth:.3g}: {change:.4f}, told {estimate:.4f}")
        if not FACTOR * min(spread[0], 0.0) - unsure < change < FACTOR * max(spread[1], 0.0) + unsure:
            wrong.append(f"{energy} {nu:.3f} {shape} {target} {depth:.3g}: {change:.4f}, told {spread}")
    assert not wrong
