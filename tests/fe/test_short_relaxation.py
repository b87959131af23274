"""Relaxation times about as long as a time step, where extrapolation over the steps promises little: the bars know."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

import fe_contact
from lumped import Result, Scene, laws, simulate

IMPACTS = 100


def impact(seed: int) -> Scene:
    """Shortest relaxation time 0.003 to 0.1 contact times; glassy over relaxed modulus to 12."""
    rng = np.random.default_rng([20261122, seed])
    young, nu, radius, mass = (
        10 ** rng.uniform(5, 8),
        float(rng.uniform(0, 0.49)),
        0.01,
        float(10 ** rng.uniform(-3, 0)),
    )
    depth = radius * 10 ** (2 * rng.uniform(-2, np.log10(0.3)))
    velocity = float(np.sqrt(16 / 15 * young / (1 - nu**2) * np.sqrt(radius) * depth**2.5 / mass))
    terms = int(rng.choice([1, 3]))
    times = 2.943275 * depth / velocity * 10 ** rng.uniform(-2.5, -1) * np.sort(10 ** rng.uniform(0, 1, terms))
    moduli = young * rng.uniform(1, 11) * rng.dirichlet(np.ones(terms))
    material = {"law": "prony", "E_inf": young, "E": moduli.tolist(), "tau": times.tolist(), "nu": nu}
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    return Scene.from_dict(
        {"name": "short", "striker": striker, "target": {"shape": "half_space", "material": material}}
    )


@cache
def exact(seed: int) -> Result:
    """One for both tolerances."""
    scene = impact(seed)
    return simulate(laws.mdr.of(scene), scene, 1e-7)


@pytest.mark.tenth
@pytest.mark.parametrize("tolerance", [1e-3, 1e-4])
def test_every_bar_covers(
    tolerance: float, campaign_size: Callable[[int], int], uncovered: Callable[..., dict[str, float]]
) -> None:
    for seed in range(campaign_size(IMPACTS)):
        found = fe_contact.run(impact(seed), tolerance)
        assert found.converged
        assert not uncovered(found, exact(seed)), seed


@pytest.mark.tenth
def test_two_meshes_that_agree_by_chance_where_the_path_turns_are_not_believed(
    uncovered: Callable[..., dict[str, float]],
) -> None:
    """Met in a random ring: its mesh stays, and the contact's edge lies alike in both just then, and only then."""
    material = {
        "law": "prony",
        "E_inf": 6e5,
        "E": [4875885.629412529, 491365.8112641897, 17871929.819718085],
        "tau": [0.0020756135801780332, 638.6671733837, 2.1389954488725405e-08],
        "nu": 0.22287745290490546,
    }
    striker = {"shape": "cylinder", "radius": 0.006, "length": 0.03, "mass": 0.05, "velocity": 0.04634558232397682}
    ring = {"shape": "ring", "inner_radius": 0.0077783553263812725, "thickness": 0.002635512347519187}
    scene = Scene.from_dict({"name": "by-chance", "striker": striker, "target": ring | {"material": material}})
    assert not uncovered(fe_contact.run(scene, 1e-2), simulate(laws.ting.of(scene), scene, 1e-6))


def test_what_a_branch_as_long_as_the_steps_leaves_lies_within_bars_that_are_tight() -> None:
    """Twelve times as stiff as what lasts, met in a sweep: three lengths of step agree too well in what adds up."""
    striker = {"shape": "sphere", "radius": 0.01, "mass": 0.02, "velocity": 0.1}
    material = {"law": "prony", "E_inf": 1e6, "E": [1.24e7], "tau": [2.86e-5], "nu": 0.3}
    target = {"shape": "half_space", "material": material}
    scene = Scene.from_dict({"name": "as-long", "striker": striker, "target": target})
    found = fe_contact.run(scene, 0.1, numerics={"steps": 64}).quantities
    exact = simulate(laws.ting.of(scene), scene, 1e-8).quantities
    for name, widest in {"peak_depth": 4.0, "impulse": 4.0, "restitution": 4.0, "duration": 60.0}.items():
        off = abs(found[name].value - exact[name].value)
        assert off <= found[name].error < widest * off, name


@pytest.mark.parametrize(("velocity", "young", "time"), [(0.0135, 5.48e6, 1.27e-3), (0.011, 4.24e6, 1.39e-3)])
def test_a_duration_that_shows_less_than_the_order_of_the_force_is_trusted_less(
    velocity: float, young: float, time: float
) -> None:
    """A branch that relaxes in six steps: its 40, 20 and 10 steps show an order of 1.4 of the duration alone."""
    striker = {"shape": "sphere", "radius": 0.01, "mass": 0.02, "velocity": velocity}
    material = {"law": "prony", "E_inf": 1e6, "E": [young], "tau": [time], "nu": 0.3}
    target = {"shape": "half_space", "material": material}
    scene = Scene.from_dict({"name": "six-steps", "striker": striker, "target": target})
    found = fe_contact.run(scene, 1e-2).quantities["duration"]
    off = abs(found.value - simulate(laws.ting.of(scene), scene, 1e-8).quantities["duration"].value)
    assert off <= found.error < 3.0 * off
