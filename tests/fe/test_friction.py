"""What friction adds to a normal contact, by finite elements whose surface is held or sheared."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
import scipy.integrate

import meshes
from fe_contact.assembly.forms import Array, Basis, Matrix
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.operators import basis_on, made, system_matrix
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import held
from fe_contact.indentation import indenter_of
from lumped import Scene
from lumped.materials import Material, Relaxation
from lumped.materials.friction import mismatch, slipping, stuck
from lumped.result.model_ledger import Peak, ledger_at_rest, model_ledger

ELEMENTS, FAR, FINER = 8.0, 60.0, 16.0


def beta(poisson: float) -> float:
    """Of a half-space under a rigid striker."""
    return (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson))


class Half(NamedTuple):
    """A half-space of E* = 1 with a punch of radius one on its surface nodes, (n,), at the places (n,)."""

    basis: Basis
    matrix: Matrix
    nodes: Array
    places: Array

    @classmethod
    def of(cls, poisson: float) -> Half:
        basis = basis_on(made(meshes.half_space, ELEMENTS, FAR, FINER, 2.0), 3)
        surface = flat(basis)
        return cls(basis, system_matrix(basis, poisson), surface.dofs, surface.coordinate)

    def pressed(self, sticks: bool, traction: float = 0.0, sunk: float = 1.0) -> tuple[float, Array]:
        """Force of a punch that is ``sunk`` so deep, and how deep the surface is then; nodes under it are held across
        where it ``sticks``, or sheared outwards by a ``traction`` there.
        """
        under = self.places <= 1.0 + 1e-12
        size = 2 * self.basis.N
        given = np.zeros(size)
        given[2 * self.nodes[under] + 1] = -sunk
        fixed = [held(self.basis, along=("axis",), across=()), 2 * self.nodes[under] + 1]
        fixed += [2 * self.nodes[under]] if sticks else []
        kept = np.unique(np.concatenate(fixed))
        free = np.setdiff1d(np.arange(size), kept)
        load = np.zeros(size)
        load[2 * self.nodes[under]] = traction * self._areas(under)
        stiffness = self.matrix.tocsc()
        found = given.copy()
        found[free] = factorized(stiffness[free][:, free])((load - stiffness @ given)[free])
        reaction = (stiffness @ found - load)[2 * self.nodes[under] + 1]
        return -float(reaction.sum()), -found[2 * self.nodes + 1]

    def _areas(self, under: Array) -> Array:
        """int N 2 pi r dr of every node, by the shape functions of the facets under the punch."""
        points, areas, trace = flat(self.basis).quadrature(3)
        inside = points < 1.0
        return np.asarray((areas[inside] @ trace[inside])[: under.sum()])


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
def test_a_contact_that_sticks_is_as_much_firmer_as_its_formula_says(poisson: float) -> None:
    """A flat punch by its force; a ball and a cone by how far such punches sink the surface beside them."""
    half = Half.of(poisson)
    (firm, beside), (soft, _) = half.pressed(True), half.pressed(False)
    assert firm / soft == pytest.approx(stuck(beta(poisson), math.inf), abs=2e-4)
    outside = half.places > 1.0
    inverse = 1.0 / half.places[outside][::-1]
    depth = np.interp(np.linspace(0.0, 1.0, 4001), np.append([0.0], inverse), np.append([0.0], beside[outside][::-1]))
    s = np.linspace(0.0, 1.0, 4001)
    for power in (1.0, 2.0):
        left = scipy.integrate.simpson((1.0 - depth) * s ** (power - 1.0), x=s)
        sinking = 1.0 / (power * left)
        still = 0.5 * math.pi if power == 1.0 else 2.0  # of a frictionless cone and ball
        told = firm / soft * (sinking / still) ** (-1.0 / power)
        assert told - 1.0 == pytest.approx(stuck(beta(poisson), power) - 1.0, abs=7e-4)


def test_shear_under_a_punch_that_slips_bears_as_much_as_reciprocity_says() -> None:
    """A uniform traction f outwards: 4 beta f int_0^1 (1 - sqrt(1 - s^2)) ds = 4 beta f (1 - pi/4)."""
    poisson = 0.2
    force, _ = Half.of(poisson).pressed(False, traction=1.0, sunk=0.0)
    assert force == pytest.approx(4.0 * beta(poisson) * (1.0 - math.pi / 4.0), rel=2e-3)


@pytest.mark.parametrize("power", [1.0, 2.0, 3.5])
def test_the_share_of_what_slips_is_that_integral_of_its_pressure(power: float) -> None:
    """Pressure under r^n by Abel's transform, p(s) ~ int_s^1 t^(n - 1)/sqrt(t^2 - s^2) dt."""

    def pressure(s: float) -> float:
        whole = math.sqrt(1.0 - s**2)
        return float(scipy.integrate.quad(lambda u: (s**2 + u**2) ** (0.5 * power - 1.0), 0.0, whole)[0])

    bears = scipy.integrate.quad(lambda s: pressure(s) * (1.0 - math.sqrt(1.0 - s**2)), 0.0, 1.0)[0]
    force = scipy.integrate.quad(lambda s: 2.0 * math.pi * s * pressure(s), 0.0, 1.0)[0]
    assert slipping(power) == pytest.approx(4.0 * bears / force, rel=1e-4)


def test_like_bodies_and_incompressible_ones_know_no_friction() -> None:
    steel, rubber = (Material(Relaxation(young), nu) for young, nu in ((2e11, 0.3), (1e6, 0.5)))
    assert mismatch(steel, steel) == 0.0
    assert mismatch(rubber, None) == 0.0
    assert mismatch(steel, rubber) < 1e-5
    assert mismatch(steel, None) == pytest.approx(beta(0.3))
    dashpot = Material(Relaxation(0.0, viscosity=1e3), 0.2)
    assert mismatch(dashpot, None) == mismatch(dashpot, steel) == pytest.approx(beta(0.2))
    other = Material(Relaxation(1e11), 0.2)
    apart = 0.4 / steel.shear.glassy - 0.6 / other.shear.glassy
    both = 0.7 / steel.shear.glassy + 0.8 / other.shear.glassy
    assert mismatch(steel, other) == pytest.approx(abs(apart) / (2.0 * both))
    assert stuck(0.0, 2.0) == 1.0
    assert stuck(0.5, math.inf) == pytest.approx(math.log(3.0))


def test_a_ledger_bounds_friction_until_its_coefficient_is_given() -> None:
    """Of a peak force at the same energy: F ~ depth^(3/2) firmer by x is x^(2/5) higher."""

    def entry(coefficient: float | None = None, **keys: float | str) -> tuple[float | None, tuple[float, float] | None]:
        own = {} if coefficient is None else {"target.material.friction": coefficient}
        scene = Scene.load("steel-ball", {"target.material.nu": 0.3, **own, **keys})
        found = {one.effect: one for one in model_ledger(scene, Peak(60.0, 5e-6, 1e-4, 1e-5))}["friction"]
        assert (found.treated, found.key) == ("frictionless", "")
        return found.estimate, found.spread

    most = stuck(beta(0.3), 2.0) ** 0.4 - 1.0
    estimate, spread = entry()
    assert estimate is None
    assert spread == pytest.approx((0.0, most), rel=1e-3)
    assert entry(0.0) == (0.0, None)
    assert entry(0.1)[0] == pytest.approx((1.0 + 0.1 * slipping(2.0) * beta(0.3)) ** 0.4 - 1.0, rel=1e-3)
    assert entry(2.0)[0] == pytest.approx(most, rel=1e-3)
    assert entry(**{"target.material.nu": 0.5}) == (0.0, None)
    two = Scene.load("two-spheres", {"striker.material.friction": 0.0})
    assert two.geometry.of_pair("friction") == 0.0


def test_no_elastic_bound_is_told_of_what_yields() -> None:
    """Where a body flows, what sticks bears more even at nu = 1/2, of which elastic bodies know nothing."""
    strong = {"target.material.yield_strength": 3e8, "model.direction": "down"}
    scene = Scene.load("steel-ball", {**strong, "model.plasticity": True, "target.material.nu": 0.49})
    peak = Peak(60.0, 5e-6, 1e-4, 1e-5)
    at_rest = indenter_of(scene)
    for ledger in (model_ledger(scene, peak), ledger_at_rest(at_rest, peak)):
        found = {one.effect: one for one in ledger}["friction"]
        assert (found.estimate, found.spread) == (None, None)
        assert found.note == "no formula for a body that yields"
    elastic = model_ledger(scene, peak, replace(scene.model, plasticity=False))
    assert {one.effect: one for one in elastic}["friction"].spread is not None
    slippery = scene.changed({"target.material.friction": 0.0})
    assert {one.effect: one for one in model_ledger(slippery, peak)}["friction"].estimate == 0.0


@pytest.mark.parametrize("poisson", [-0.9, -0.3, 0.3])
def test_profiles_ever_flatter_come_to_a_punch(poisson: float) -> None:
    """Firmer from power to power, and never more than under a flat end."""
    powers = np.geomspace(1.0, 1e6, 60)
    firmer = np.array([stuck(beta(poisson), float(power)) for power in powers])
    slips = np.array([slipping(float(power)) for power in powers])
    assert np.all(np.diff(firmer) >= 0.0)
    assert np.all(np.diff(slips) >= 0.0)
    assert firmer[-1] == stuck(beta(poisson), math.inf)
    assert slips[-1] == slipping(math.inf)


def test_a_rounded_punch_that_hardly_sinks_in_has_a_ledger_whatever_the_ratio_of_poisson() -> None:
    """Its force is nearly in proportion to the depth: a very high power, of a body that hardly narrows."""
    striker = {"shape": "rounded_punch", "flat_radius": 0.01, "edge_radius": 0.01, "mass": 1e-3, "velocity": 1e-4}
    for poisson in (-0.9, -0.5, 0.3):
        material = {"law": "elastic", "E": 1e9, "nu": poisson}
        scene = Scene.from_dict({"striker": striker, "target": {"shape": "half_space", "material": material}})
        (entry,) = [one for one in model_ledger(scene, Peak(1.0, 1e-6, 1e-2, 1e-5)) if one.effect == "friction"]
        assert 0.0 < entry.size < 0.2
