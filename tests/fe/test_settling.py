"""A body that yields settles under a striker: by Newton's method on all of it at once, and whatever it begins with."""

from __future__ import annotations

import math

import numpy as np
import pytest
from on_undeformed import OnUndeformed

from fe_contact.assembly.forms import Array
from fe_contact.indentation import Indentation, indent
from fe_contact.plastic import settling
from fe_contact.plastic.course import Course, PlasticLoading, settings
from fe_contact.plastic.ground import Ground
from fe_contact.plastic.path import PlasticFlowLost, Presser
from fe_contact.plastic.settling import FAR, SETTLED, FlowEquilibrium, FlowUnsettled, Stiffness, YieldingBody, slow
from fe_contact.solids.base import State
from fe_contact.solids.newton import Encounter, Equilibrium, balanced
from lumped.scene.indenter import Indenter
from lumped.shapes import Sphere
from lumped.shapes.base import Shape
from lumped.shapes.cone import Cone
from lumped.shapes.punch import Punch

STIFF = 4000.0
SPHERE, CONE, PUNCH = Sphere(1.0), Cone(20.0), Punch(0.05)


def course(profile: Shape, strength: float = 2e-3, hardening: float = 1e-3) -> Course:
    return Course(profile, 0.3, 1.0, strength, hardening, first=1e-4, firm=2e-4, deepest=4e-3)


def ground(profile: Shape, **material: float) -> Ground:
    known = course(profile, **material)
    return known.ground(settings({"elements_per_contact": 4.0}, known))


def settled(
    body: Ground, depth: float, state: State, start: Array, stiffness: Stiffness | None = None
) -> FlowEquilibrium:
    """As deep in units of a mesh one unit long."""
    none = np.zeros_like(body.points)
    return body.body.settled(start, body.springs(1.0, depth, STIFF, none), state, body.points < 0.9, stiffness)


def at_once(body: Ground, depth: float, state: State, start: Array) -> Equilibrium:
    """By Newton's method on body and contact together, each step with a tangent of its own."""
    whole = body.body
    encounter = Encounter.of(whole.cored, whole.skin, OnUndeformed(body.profile, body.unit))
    touching = (body.points < 0.9).reshape(whole.skin.weights.shape)
    return balanced(encounter, start, depth, STIFF, state, touching, 1e-12)


@pytest.mark.parametrize("profile", [SPHERE, CONE, PUNCH])
@pytest.mark.parametrize("hardening", [0.01, 0.1])
def test_what_settles_is_in_balance_as_newtons_method_finds_it(profile: Shape, hardening: float) -> None:
    """Twice, the second time from what flowed before; force, displacement and plastic work."""
    body = ground(profile, hardening=hardening)
    state, start, stiffness = body.rest, np.zeros(body.body.cored.core.size), None
    deep = 0.5 * float(profile.height(0.9 * body.unit)) / body.unit if profile is not PUNCH else 4e-3
    for depth in (deep, 1.15 * deep):
        found, whole = settled(body, depth, state, start, stiffness), at_once(body, depth, state, start).balance
        springs = body.springs(1.0, depth, STIFF, np.zeros_like(body.points))
        assert found.at.flowed.amount.max() > 1e-4
        assert springs.pressed(found.at.rise).sum() == pytest.approx(whole.force, rel=1e-5)
        moved = np.abs(whole.displacement).max()
        assert found.at.displacement == pytest.approx(whole.displacement, abs=1e-5 * moved)
        after = found.at.flowed.strain, found.at.flowed.amount
        assert body.worked(after) == pytest.approx(body.worked(whole.loaded.answer.state), rel=1e-5)
        assert found.at.energy == pytest.approx(whole.energy, rel=1e-9)
        state, start, stiffness = after, found.at.displacement, found.stiffness


@pytest.mark.family
@pytest.mark.parametrize("seed", range(6))
def test_what_settles_is_the_same_whatever_it_begins_with(seed: int) -> None:
    """Another stiffness, that of no flow or of a deeper one, and a displacement that is far off."""
    rng = np.random.default_rng([20261129, seed])
    body = ground(SPHERE, strength=float(10.0 ** rng.uniform(-3.5, -2.0)), hardening=float(rng.choice([0.0, 0.03])))
    depth = 0.5 * body.unit * float(rng.uniform(0.3, 0.9))
    start = np.zeros(body.body.cored.core.size)
    plain = settled(body, depth, body.rest, start)
    springs = body.springs(1.0, depth, STIFF, np.zeros_like(body.points))
    elastic = body.body.stiffness(body.body.displaced(start, springs, body.rest))
    deeper = settled(body, 1.3 * depth, body.rest, start)
    off = plain.at.displacement * (1.0 + 0.3 * rng.standard_normal(start.size))
    force = springs.pressed(plain.at.rise).sum()
    for begin, stiffness in ((start, elastic), (deeper.at.displacement, deeper.stiffness), (off, None)):
        found = settled(body, depth, body.rest, begin, stiffness)
        assert springs.pressed(found.at.rise).sum() == pytest.approx(force, rel=3.0 * SETTLED)
        assert found.at.energy <= plain.at.energy + 1e-8 * abs(plain.at.energy)


def test_a_stiffness_serves_several_depths(monkeypatch: pytest.MonkeyPatch) -> None:
    """One for all of them where nothing flows; where a body begins to yield fewer than contact problems, each of which
    is guessed so well from the ones before that it takes few guesses more.
    """
    made, made_anew = list[float](), YieldingBody.stiffness

    def counted(body: YieldingBody, here: settling.Deformation) -> Stiffness:
        made.append(here.energy)
        return made_anew(body, here)

    monkeypatch.setattr(YieldingBody, "stiffness", counted)
    for strength, share, guesses in ((1.0, 0.0, 1.0), (1e-2, 0.6, 4.2)):
        made.clear()
        known = course(SPHERE, strength)
        loading = PlasticLoading.of(known, settings({"elements_per_contact": 6.0, "steps": 64}, known))
        loading.to(known.deepest)
        counts = loading.presser.counts
        assert len(made) <= 1 + share * counts.problems
        assert counts.iterations <= guesses * counts.problems


def test_flow_that_does_not_settle_is_lost_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    body = ground(SPHERE)
    monkeypatch.setattr(settling, "RENEWED", 1)
    with pytest.raises(FlowUnsettled):
        settled(body, 0.2 * body.unit, body.rest, np.zeros(body.body.cored.core.size))
    with pytest.raises(PlasticFlowLost, match=r"plastic flow at depth 0.02 m did not settle; cure: raise"):
        Presser(body, STIFF, 1.0).first(0.02, 0.1)


def test_a_contact_that_does_not_close_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(settling, "MOST_CLOSINGS", 1)
    body = ground(SPHERE)
    with pytest.raises(FlowUnsettled):
        settled(body, 0.02 * body.unit, body.rest, np.zeros(body.body.cored.core.size))


@pytest.mark.parametrize(
    ("missed", "slowly"),
    [
        ([1.1 * FAR], True),
        ([0.9 * FAR], False),
        ([0.1, 0.1], True),
        ([0.1, 0.01], False),
        ([0.1, 0.09], True),
        ([0.1, 0.01, 0.0099], False),
        ([0.1, 0.09, 0.01], False),
        ([2.0 * SETTLED, 1.9 * SETTLED], True),
        ([2.0 * SETTLED, 1.7 * SETTLED], False),
    ],
)
def test_guesses_are_slow_where_they_are_far_off_or_would_be_more_than_a_stiffness_is_worth(
    missed: list[float], slowly: bool
) -> None:
    """At the rate of the last two changes: ln(1/2)/ln(1.7/2) = 4.3 more, or 13."""
    assert slow(missed) is slowly
    assert math.log(0.5) / math.log(0.85) < settling.WORTH < math.log(0.5) / math.log(0.95)


@pytest.mark.tenth
def test_a_flat_end_on_what_does_not_harden_settles_as_on_what_hardens_little() -> None:
    """Its tangents lead nowhere in places; hardening only adds to the force, here to a percent."""
    steel = {"law": "elastic", "E": 2e11, "nu": 0.149, "yield_strength": 2.72e8}

    def pressed(hardening: float) -> Indentation:
        table = {"target.material": {**steel, "hardening_modulus": hardening}, "model.plasticity": True}
        punch = Indenter.load("polymer-punch", {**table, "striker.radius": 1e-3})
        return indent(punch, (3.2e-6,), {"tolerance": 0.05})

    ideal, firm = pressed(0.0), pressed(2e9)
    assert ideal.converged
    bars = float(ideal.force_error[0] + firm.force_error[0])
    assert -bars < float(firm.force[0] - ideal.force[0]) < 0.01 * float(firm.force[0]) + bars
