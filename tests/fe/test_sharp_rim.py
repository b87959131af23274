"""Flat ends with a sharp rim and large strains: exact limits of their edges, finer runs, narrower edges, named ends."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from finer_runs import compare_forces_with_finer

from fe_contact import run
from fe_contact.indentation import indent
from fe_contact.large_strains import depth_reached
from fe_contact.solids import sharp_rim
from fe_contact.solids.newton import EquilibriumLost
from fe_contact.solids.sharp_rim import EDGES, FEWEST, narrowed, rounded
from lumped import BadInput, Scene
from lumped.indentation import Indentation
from lumped.indentation import indent as exact
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import energy_of
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer

SCENES = 20
LARGE = Model(kinematics="finite")
# Of those that do not soften under compression: a rim strains without bound.
ENERGIES = ("neo_hooke", "neo_hooke_split", "mooney_rivlin", "yeoh", "ogden", "hencky")


def punch(target: Target | None = None, energy: str = "neo_hooke", nu: float = 0.4) -> Indenter:
    """Of radius one."""
    return Indenter(Punch(1.0), Material(Relaxation(1e6), nu, hyperelastic=energy), target or HalfSpace(), model=LARGE)


def drawn(random: np.random.Generator) -> tuple[Indenter, tuple[float, float]]:
    """A punch, and depths to 0.3 of its radius, or to a tenth of a layer."""
    energy, nu = str(random.choice(ENERGIES)), float(random.uniform(0.0, 0.49))
    deepest, target = float(random.uniform(0.02, 0.3)), HalfSpace()
    if random.uniform() < 0.4:
        layer = Layer(10.0 ** float(random.uniform(-0.7, 0.7)), str(random.choice(["bonded", "sliding"])))
        return punch(layer, energy, nu), (0.02 * layer.thickness, 0.1 * layer.thickness * float(random.uniform(0.5, 1)))
    return punch(target, energy, nu), (0.4 * deepest, deepest)


@pytest.mark.parametrize("target", [HalfSpace(), Layer(2.0, "bonded"), Layer(0.7, "sliding")])
def test_exact_forces_of_edges_have_the_sharp_rims_for_a_limit(target: Target) -> None:
    """By closed forms and integral equations, of edges and of none, at small strain: within what edges leave."""
    depths = (1e-3, 0.01, 0.06)
    asked = list[float]()

    def press(one: Indenter, tolerance: float) -> Indentation:
        asked.append(tolerance)
        found = exact(one, depths, "ting", tolerance=tolerance)
        return replace(found, budget={"mesh": found.force_error / found.force}, work={"contact_problems": 1})

    for tolerance in (1e-2, 1e-3):
        found, sharp = narrowed(punch(target), tolerance, press), exact(punch(target), depths, "ting")
        apart = np.abs(found.force - sharp.force)
        assert np.all(apart < found.force_error)
        assert np.all(found.force_error < 10.0 * apart + 1e-3 * sharp.force)
        assert found.force_error == pytest.approx(np.sum(list(found.budget.values()), axis=0) * found.force)
        np.testing.assert_array_equal(found.contact_radius, 1.0)
    assert max(asked) < 1e-2


def test_exact_forces_show_the_power_of_small_strains() -> None:
    depths = (1e-3, 0.1)
    edges = [exact(rounded(punch(), place), depths, "ting") for place in range(3, 6)]
    np.testing.assert_allclose(sharp_rim._power(edges), 2.0 / 3.0, atol=0.02)


def test_a_slight_depth_is_that_of_small_strains() -> None:
    """What large strains change goes as the depth over the radius, and is no more than it."""
    for target in (HalfSpace(), Layer(1.0, "bonded")):
        found, small = indent(punch(target), (2e-3,), {"tolerance": 2e-2}), exact(punch(target), (2e-3,), "ting")
        assert found.converged
        assert abs(found.force[0] - small.force[0]) < found.force_error[0] + 2e-3 * small.force[0]


@pytest.mark.tenth
def test_finer_runs_lie_within_both_bars(campaign_size: Callable[..., int]) -> None:
    count, random = campaign_size(SCENES), np.random.default_rng(31)
    converged, wrong = list[bool](), list[str]()
    for _ in range(count):
        compare_forces_with_finer(*drawn(random), 2e-2, converged, wrong)
    assert not wrong
    assert np.mean(converged) >= 0.95


@pytest.mark.parametrize("energy", ["neo_hooke", pytest.param("yeoh", marks=pytest.mark.tenth)])
def test_edges_four_times_as_wide_widen_the_bar_which_holds(energy: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pressed, depths = punch(energy=energy), (0.04, 0.12)
    found = indent(pressed, depths, {"tolerance": 2e-2})
    monkeypatch.setattr(sharp_rim, "EDGES", tuple(4.0 * edge for edge in EDGES[:FEWEST]))
    wide = indent(pressed, depths, {"tolerance": 2e-2})
    assert np.all(wide.budget["edge"] > [1.0, 2.0] * found.budget["edge"])
    assert np.all(np.abs(wide.force - found.force) < wide.force_error + found.force_error)


@pytest.mark.parametrize(
    ("target", "nu", "energy"),
    [
        (HalfSpace(), 0.0, "hencky"),
        pytest.param(HalfSpace(), -0.5, "neo_hooke", marks=pytest.mark.tenth),
        pytest.param(HalfSpace(), 0.3, "neo_hooke", marks=pytest.mark.tenth),
        pytest.param(Layer(1.0, "sliding"), 0.0, "neo_hooke", marks=pytest.mark.tenth),
        pytest.param(Layer(3.0, "bonded"), 0.1, "hencky", marks=pytest.mark.tenth),
    ],
)
def test_the_first_order_in_strain_counts_that_the_surface_moves_in_under_the_rim(
    target: Target, nu: float, energy: str
) -> None:
    """What the ledger says: without it the force would change by a third of this, or the other way."""
    pressed, depth = punch(target, energy, nu), 0.03
    found, small = indent(pressed, (depth,), {"tolerance": 5e-3}), exact(pressed, (depth,), "ting")
    change, unsure = found.force[0] / small.force[0] - 1.0, found.force_error[0] / small.force[0]
    told = target.strains(pressed.shape, nu, depth, 1.0).change(energy_of(energy))
    assert change == pytest.approx(told, rel=0.2, abs=unsure)


def test_forces_that_close_in_on_nothing_are_named() -> None:
    """A body that folds under the narrowest edge presses back as hard as under the one before."""
    depths = (0.1,)
    pressed = [exact(rounded(punch(), place), depths, "ting") for place in range(FEWEST + 1)]
    pressed = [replace(one, budget={"mesh": one.force_error / one.force}, work={"iterations": 1}) for one in pressed]
    folded = replace(pressed[2], force=pressed[1].force * 1.001)
    told = iter([*pressed[:2], folded])
    with pytest.raises(EquilibriumLost, match="no limit; cure: smaller depths"):
        narrowed(punch(), 1e-6, lambda one, tolerance: next(told))
    told = iter([*pressed[:3], folded])
    found = narrowed(punch(), 1e-6, lambda one, tolerance: next(told))
    assert not found.converged
    assert found.numerics["edge_radius"] == EDGES[2]


@pytest.mark.tenth
def test_an_impact_by_a_punch() -> None:
    """It gives back all that it takes, and goes as deep as slow pressing says that its energy reaches."""
    scene = Scene(Punch(1.0), 1.0, 300.0, punch().material, target=HalfSpace(), model=LARGE)
    found = run(scene, tolerance=3e-2)
    assert found.converged
    assert found.quantities["restitution"].value == pytest.approx(1.0, abs=1e-6)
    depth = found.quantities["peak_depth"].value or 0.0
    assert depth_reached(scene) == pytest.approx(depth, rel=0.02)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    pressed = indent(punch(), tuple((0.5 * depth * (1.0 + nodes)).tolist()), {"tolerance": 1e-2})
    work = 0.5 * depth * float(weights @ pressed.force)
    assert work == pytest.approx(0.5 * 300.0**2, rel=2.0 * 3e-2)


def test_a_tiny_punch_has_fewer_edges() -> None:
    """As many as are a nanometre wide; a tight tolerance is missed then, no more."""
    pressed = replace(punch(), shape=Punch(5e-8))
    places = list[float]()

    def press(one: Indenter, tolerance: float) -> Indentation:
        places.append(float(one.shape.edge_radius))  # type: ignore[attr-defined]  # it is a RoundedPunch
        found = exact(one, (1e-8,), "ting", tolerance=tolerance)
        return replace(found, budget={"mesh": found.force_error / found.force}, work={"contact_problems": 1})

    found = narrowed(pressed, 1e-6, press)
    assert not found.converged
    assert min(places) >= 1e-9
    assert len(places) == FEWEST


def test_what_is_not_built_is_refused_with_what_is() -> None:
    with pytest.raises(BadInput, match=r"radius: 2e-09: too small for large strains; accepted from 3.2e-08 m on"):
        indent(replace(punch(), shape=Punch(2e-9)), (1e-10,), {"tolerance": 1e-2})
    with pytest.raises(BadInput, match=r"striker.shape: .*accepted: a radius below 0.4 m, 20 thicknesses"):
        indent(punch(Layer(0.02, "bonded")), (1e-3,), {"tolerance": 1e-2})
