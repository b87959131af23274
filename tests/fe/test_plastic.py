"""A half-space that yields: elastic before, balance of energy, limits, published laws, bars, refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import restitution_laws as published

import fe_contact
from fe_contact.indentation import indent
from lumped import Result, Scene
from lumped.errors import BadInput
from lumped.indentation import Indentation
from lumped.materials.plasticity import first_yield
from lumped.result.model_ledger import FLOW
from lumped.scene.indenter import Indenter
from lumped.scene.tables import SceneReader
from lumped.schema import Table

YOUNG, STRENGTH, RADIUS, MASS = 2e11, 4e8, 0.005, 4e-3
COARSE = {"elements_per_contact": 3.0, "steps": 12, "tolerance": 0.05}
ROUNDED = {"shape": "rounded_punch", "flat_radius": 0.01, "edge_radius": 0.01}
ABOUT = {"elements_per_contact": 5.0, "steps": 20, "tolerance": 0.01}


def modulus(nu: float) -> float:
    return YOUNG / (1.0 - nu**2)


def yield_depth(nu: float) -> float:
    """Of a sphere, by Hertz, m."""
    return float(RADIUS * (math.pi * first_yield(nu)[0] * STRENGTH / (2.0 * modulus(nu))) ** 2)


def yield_energy(nu: float) -> float:
    """Work up to there, J."""
    return 0.4 * 4.0 / 3.0 * modulus(nu) * math.sqrt(RADIUS) * yield_depth(nu) ** 2.5


def tables(nu: float = 0.3, hardening: float = 0.0, **striker: Any) -> Table:
    material = {"law": "elastic", "E": YOUNG, "nu": nu, "yield_strength": STRENGTH, "hardening_modulus": hardening}
    return {
        "striker": {"shape": "sphere", "radius": RADIUS} | striker if "shape" not in striker else striker,
        "target": {"shape": "half_space", "material": material},
        "model": {"plasticity": True},
    }


def pressed(depths: list[float], numerics: Table, **given: Any) -> Indentation:
    indenter, _ = SceneReader("scene", tables(**given)).indenter(Indenter)
    return indent(indenter, tuple(depths), numerics)


def struck(speed: float, numerics: Table, nu: float = 0.3, hardening: float = 0.0) -> Result:
    """At so many times the velocity of first yield."""
    velocity = speed * math.sqrt(2.0 * yield_energy(nu) / MASS)
    scene = Scene.from_dict(tables(nu, hardening, mass=MASS, velocity=velocity))
    return fe_contact.run(scene, numerics=numerics)


def test_before_it_yields_it_is_elastic() -> None:
    found = pressed([0.3 * yield_depth(0.3), 0.9 * yield_depth(0.3)], COARSE)
    hertz = 4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS) * found.depth**1.5
    assert np.all(np.abs(found.force / hertz - 1.0) < found.force_error / hertz)
    assert np.all(found.force_error < 0.02 * hertz)


@pytest.mark.tenth
def test_an_impact_balances_its_energy_and_leaves_a_dent() -> None:
    found = struck(6.0, ABOUT)
    energy, brought = found.energy, 0.5 * MASS * found.scene.velocity**2
    assert energy["in"] == pytest.approx(brought)
    assert abs(energy["residual"] or 0.0) < 2e-3 * brought
    assert 0.1 * brought < (energy["plastic"] or 0.0) < 0.3 * brought
    assert energy["out"] == pytest.approx((found.quantities["restitution"].value or 0.0) ** 2 * brought, rel=1e-6)
    assert found.recovery is not None
    assert found.recovery.permanent == pytest.approx(found.history.depth[-1])
    assert 0.1 < found.recovery.permanent / (found.quantities["peak_depth"].value or 1.0) < 0.4
    restitution = found.quantities["restitution"].value or 0.0
    assert restitution == pytest.approx(published.jackson_green_marghitu(6.0), abs=0.03)
    assert published.thornton(6.0) < restitution < published.johnson(6.0)


@pytest.mark.tenth
def test_forces_lie_among_the_published_ones_and_where_the_ledger_says() -> None:
    """Sphere on half-space: the published ones flatten spheres; mean pressure rises from 1.08 Y to 2.8 to 3.0 Y."""
    depth = np.array([1.5, 3.0, 6.0, 12.0, 24.0, 60.0])
    found = pressed((depth * yield_depth(0.3)).tolist(), COARSE | {"steps": 20})
    share = found.force / (4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS) * found.depth**1.5)
    for law in (published.jackson_green, published.kogut_etsion):
        assert share == pytest.approx([law(one) for one in depth], rel=0.1)
    lost, estimate = 1.0 - share, FLOW * np.log(depth) ** 2
    assert lost == pytest.approx(estimate / (1.0 + estimate), rel=0.3, abs=5e-3)
    mean = found.force / (np.pi * found.contact_radius**2 * STRENGTH)
    assert np.all(np.diff(mean) > 0.0)
    assert 2.4 < mean[-1] < 3.1


@pytest.mark.tenth
def test_a_cone_is_self_similar() -> None:
    """No length: F ~ depth^2, whatever it flows."""
    found = pressed([1e-6, 3e-6, 1e-5], ABOUT, shape="cone", angle=2.0)
    share = found.force / found.depth**2
    assert np.all(np.abs(share / share[-1] - 1.0) < (found.force_error / found.force) + 5e-3)


def test_what_cannot_yield_here_is_refused_by_name() -> None:
    for change, key in (
        ({"target": {"shape": "layer", "thickness": 1.0, "base": "bonded"}}, "target.shape"),
        ({"model": {"gravity": 9.81}}, "model.gravity"),
        ({"model": {"kinematics": "finite"}}, "model.kinematics"),
        ({"motion": {"impacts": 2}}, "motion.impacts"),
        ({"striker": ROUNDED}, "striker.shape"),
    ):
        table = tables(mass=MASS, velocity=0.1)
        merged = {name: table.get(name, {}) | change.get(name, {}) for name in (*table, *change)}
        if change.get("striker") is ROUNDED:
            del merged["striker"]["radius"]
        with pytest.raises(BadInput, match=key):
            Scene.from_dict(merged)
