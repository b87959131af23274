"""Impacts on layers of constant bulk modulus: a flat end against the layer's integral equation, and honest bars."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

import fe_contact
from fe_contact.budget.budget import CAUSES, SETTING
from fe_contact.budget.certify import Certified, certify
from fe_contact.budget.plan import plan
from fe_contact.steppers.steps import Strike
from lumped import Material, Relaxation, Result, Scene, laws, simulate
from lumped.shapes.punch import Punch
from lumped.targets.layer import Layer

DEPTH, TOLERANCE = 1e-6, 3e-3
QUICK = {"elements_per_contact": 2.0, "penalty": 2000.0}
FINE = {"mesh": 2.0, "penalty": 200.0, "time_step": 64, "far_field": 20.0}
FLAT_ENDS = ((0.45, (3e-3,)), (0.2, (3e-4, 5e-3)), (0.49, (1e-3, 1e-2)))
RULED = ("peak_force", "peak_depth", "duration", "restitution", "impulse")


def flat_end(nu: float, times: tuple[float, ...]) -> Scene:
    young = Relaxation(1e6, tuple(1e6 for _ in times), times)
    return Scene(Punch(0.003), 0.05, 0.02, Material(young, nu, constant="bulk"), target=Layer(0.002, "bonded"))


def stiffness(scene: Scene, bulk: float, shear: float) -> float:
    """Force per depth of an elastic layer, N/m: Hankel transforms, no element."""
    poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    modulus = 4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
    return modulus * float(scene.target.load_curve(scene.profile, poisson).force(DEPTH)) / DEPTH


def exact(scene: Scene) -> Result:
    """While the whole end touches, force and depth obey one relaxation modulus, stiffness(K, G(s)).

    In G it is a sum of G, 1 and G/(p K + G) with weights above zero, each of them a network of its own; Ting's law
    takes the sum on a layer whose Poisson's ratio stays.
    """
    material = scene.geometry.material
    bulk, shear = material.bulk, material.shear
    ratios = np.geomspace(shear.relaxed / bulk, shear.glassy / bulk, 15)
    answers = np.array([stiffness(scene, 1.0, ratio) for ratio in ratios])
    poles = np.geomspace(1e-2 * ratios[0], 1e3 * ratios[-1], 60)
    terms = np.column_stack([ratios, np.ones_like(ratios), ratios[:, None] / (poles + ratios[:, None])])
    weights, misfit = nnls(terms / answers[:, None], np.ones_like(answers), maxiter=10_000)
    assert misfit < 1e-7
    equilibrium = weights[0] * shear.equilibrium + weights[1] * bulk
    moduli, times = [weights[0] * modulus for modulus in shear.moduli], list(shear.times)
    for weight, pole in zip(weights[2:] * bulk, poles * bulk, strict=True):
        creep = replace(shear, equilibrium=shear.equilibrium + pole).creep()  # G/(pK + G) = 1 - pK/(pK + G)
        equilibrium += weight * (1.0 - pole * (creep.instantaneous + sum(creep.compliances)))
        moduli += [weight * pole * compliance for compliance in creep.compliances]
        times += creep.times
    unit = stiffness(scene, *(1.0 / (3.0 * (1.0 - 2.0 * material.nu)), 0.5 / (1.0 + material.nu)))
    alike = Material(Relaxation(equilibrium, tuple(moduli), tuple(times)).scaled(1.0 / unit), material.nu)
    return simulate(laws.ting.of(replace(scene, material=alike)), replace(scene, material=alike), 1e-6)


@pytest.mark.tenth
def test_a_flat_end_obeys_the_layers_integral_equation(campaign_size: Callable[[int], int]) -> None:
    """Until its rim, where the pressure's share changes as nu does, lets go: a little before the force is zero."""
    for nu, times in FLAT_ENDS[: campaign_size(len(FLAT_ENDS))]:
        agree(flat_end(nu, times))


def agree(scene: Scene) -> None:
    """One impact: converged, within its bars of the law until the end is near."""
    found, truth = fe_contact.run(scene, TOLERANCE, numerics=QUICK), exact(scene)
    assert found.converged
    for name in ("peak_force", "peak_depth", "restitution", "impulse"):
        value, true = found.quantities[name], truth.quantities[name]
        assert abs(value.value - true.value) <= value.error + true.error, name
        assert value.error <= TOLERANCE * (1.0 if name == "restitution" else true.value)
    assert found.quantities["duration"].value > truth.quantities["duration"].value
    late = 0.9 * truth.quantities["duration"].value
    rows = found.history.time < late
    force = np.interp(found.history.time[rows], truth.history.time, truth.history.force)
    errors = np.abs(found.history.force[rows] - force)
    assert np.all(errors <= found.history.force_error[rows] + 2e-4 * force.max())  # what two rows' line leaves


@pytest.mark.tenth
def test_constant_nu_would_err_by_less_than_the_ledger_says(campaign_size: Callable[[int], int]) -> None:
    for name in ("rubber-layer-bulk", "rod-in-ring-bulk")[: campaign_size(2)]:
        scene = Scene.load(name)
        bulk = fe_contact.run(scene, 1e-3)
        alike = fe_contact.run(replace(scene, material=replace(scene.geometry.material, constant="poisson")), 1e-3)
        peaks = [result.quantities["peak_force"].value for result in (bulk, alike)]
        chosen, told = (
            next(entry for entry in result.model_ledger if entry.effect == "constant nu against constant bulk modulus")
            for result in (bulk, alike)
        )
        assert chosen.estimate == 0.0
        assert 5e-3 < abs(peaks[1] / peaks[0] - 1.0) < 1.05 * (told.estimate or 0.0)


def certified(**changes: float) -> Certified:
    scene = Scene.load("polymer-layer", {"target.material.constant": "bulk"})
    numerics = plan(scene, {}).numerics.varied(**{SETTING[cause]: FINE[cause] for cause in CAUSES})
    return certify(Strike.of(scene), scene.geometry, numerics.varied(**changes))


@pytest.fixture(scope="module")
def fine() -> Certified:
    return certified()


@pytest.mark.family
@pytest.mark.parametrize("cause", CAUSES)
def test_coarsening_a_setting_fourfold_grows_its_entry_and_the_bar_covers(fine: Certified, cause: str) -> None:
    value = FINE[cause] / 4
    coarse = certified(**{SETTING[cause]: int(value) if cause == "time_step" else value})
    assert coarse.error("history_l2", cause) > 1.3 * fine.error("history_l2", cause)
    for name in RULED:
        moved = abs((coarse.curve.quantities[name] or 0.0) - (fine.curve.quantities[name] or 0.0))
        assert moved <= coarse.total(name) + 0.2 * fine.total(name), name
