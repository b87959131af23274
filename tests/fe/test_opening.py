"""The gap behind a receding edge: what relaxes with the modulus has the edge's power, the gap itself has not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from fe_contact.bodies.memory import step_law
from fe_contact.bodies.pressing import BEYOND, contact_end
from fe_contact.contact.problem import PressedSurface
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.schemes.base import SCHEMES
from fe_contact.steppers.struck import FixedContact, FixedStepper, _median, just_open, opened
from lumped.materials import Relaxation

galerkin = SCHEMES.get("galerkin")

SOLID = Relaxation(1.0, (2.0, 0.7), (0.05, 0.6))
PLACES = np.linspace(0.5, 1.2, 141)
END = 0.4


def edge(time: float) -> float:
    """Of a contact that turns at time zero, at one."""
    return 1.0 - 1.5 * time**2


def stress(time: float) -> np.ndarray:
    """Gap times modulus, as behind a smooth pressure with this edge."""
    return np.maximum(PLACES - edge(time), 0.0) ** 1.5


def gap(time: float) -> np.ndarray:
    """By the creep compliance, within where it was touched: J(0) stress + int J'(t - s) stress(s) ds."""
    creep = SOLID.creep()

    def lag(s: float, place: float) -> float:
        rates = np.array(creep.compliances) / creep.times * np.exp(-(time - s) / np.array(creep.times))
        return float(rates.sum()) * max(place - edge(s), 0.0) ** 1.5

    def late(place: float) -> float:
        start = np.sqrt(min(max((1.0 - place) / 1.5, 0.0), time**2))
        return quad(lag, start, time, args=(place,), epsabs=1e-12)[0]

    return creep.instantaneous * stress(time) + np.array([late(place) for place in PLACES])


def followed(steps: int) -> np.ndarray:
    """The stress in the last step, half of it before the end."""
    times = np.linspace(0.0, END, steps + 1)
    law = step_law(SOLID, galerkin, END / steps)
    memory = just_open(gap(0.0), len(SOLID.times))
    for time in times[1:]:
        memory, found = opened(memory, law, gap(float(time)))
    return found


@pytest.mark.tenth
def test_the_relaxed_gap_is_the_stress_that_would_close_it() -> None:
    """Where the surface was touched and the edge has left; of order two in the step."""
    left = edge(END) + 0.05
    touched = (left < PLACES) & (PLACES <= 1.0)
    errors = []
    for steps in (16, 32):
        exact = stress(END - 0.5 * END / steps)
        errors.append(np.abs(followed(steps) - exact)[touched].max() / exact[touched].max())
    assert errors[1] < 1.5e-3
    assert errors[0] > 3.5 * errors[1]


def test_it_tells_the_edge_where_the_gap_does_not() -> None:
    steps = 32
    middle = END - 0.5 * END / steps
    rough = edge(middle) - 0.01  # what the pressure tells
    found = contact_end(PLACES, rough, followed(steps), PLACES**2, touched=1.0)
    plain = contact_end(PLACES, rough, gap(middle), PLACES**2, touched=1.0)
    assert found == pytest.approx(edge(middle), abs=5e-4)
    assert abs(plain - edge(middle)) > 3.0 * abs(found - edge(middle))


def test_an_elastic_gap_is_its_own_mean() -> None:
    """Times the modulus: two springs in parallel, whose branch never relaxes within the step."""
    before, after = stress(0.1), stress(0.2)
    for modulus in (Relaxation(3.0), Relaxation(1.0, (2.0,), (1e9,))):
        memory = just_open(before, len(modulus.times))
        _, found = opened(memory, step_law(modulus, galerkin, 0.1), after)
        np.testing.assert_allclose(found, 1.5 * (before + after), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 7, 8])
def test_the_gap_is_counted_from_the_middle_one_of_those_that_touch(count: int) -> None:
    values = np.random.default_rng(count).normal(size=count)
    assert _median(values) == pytest.approx(float(np.median(values)), rel=1e-15)


def test_where_surfaces_touch_there_is_no_gap_and_elsewhere_what_lies_beyond_the_middle_of_those() -> None:
    """Of a datum that moves: whatever it lifts all places by."""
    overlap, sunk = np.array([0.5, 0.4, 0.2, -0.3, -0.9]), np.array([0.52, 0.43, 0.25, 0.1, 0.0])
    solution: Any = SimpleNamespace(signed_pressure=np.array([3.0, 2.0, 1.0, -1.0, -2.0]))
    for lifted in (0.0, 7.0):
        stepper: Any = SimpleNamespace(
            body=SimpleNamespace(displacement=lambda memory, lifted=lifted: memory + lifted),
            contact=SimpleNamespace(overlap=lambda depth: depth + overlap),
        )
        state: Any = SimpleNamespace(memory=SimpleNamespace(body=sunk), depth=0.01)
        gap = FixedStepper._gap(stepper, state, solution)
        assert gap == pytest.approx([0.0, 0.0, 0.0, 0.4 - 0.03, 0.9 - 0.03])


def test_a_step_is_photographed_where_its_scheme_reads_it() -> None:
    stepper: Any = SimpleNamespace(scheme=SimpleNamespace(sample=0.75), places=np.array([0.1, 0.2]), scale=0.5)
    step: Any = SimpleNamespace(
        state=SimpleNamespace(time=3.0), length=0.4, force=5.0, radius=0.3,
        solution=SimpleNamespace(pressure=np.array([2.0, 1.0])),
    )  # fmt: skip
    (seen,) = FixedStepper.snapshots(stepper, [step])
    assert (seen.time, seen.force, seen.contact_radius) == (pytest.approx(2.9), 5.0, 0.3)
    assert seen.pressure == pytest.approx([4.0, 2.0])
    assert seen.radii is stepper.places


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_the_striker_does_on_a_gap_or_a_penalty_it_does_not_do_on_the_body(dimension: int) -> None:
    """Force times way less pressure times dent: on a mesh of unit length a half, of a line or of an axis."""
    operator = SimpleNamespace(dimension=dimension, weights=np.array([1.0, 3.0]))
    stepper: Any = SimpleNamespace(
        body=SimpleNamespace(displacement=lambda memory: memory), surface=SimpleNamespace(operator=operator), scale=0.5
    )
    before: Any = SimpleNamespace(depth=0.1, memory=SimpleNamespace(body=np.array([0.1, 0.0])))
    later = SimpleNamespace(depth=0.3, memory=SimpleNamespace(body=np.array([0.2, 0.05])))
    step: Any = SimpleNamespace(force=6.0, state=later, solution=SimpleNamespace(pressure=np.array([4.0, 2.0])))
    on_body = 0.5 ** (dimension - 2) * (4.0 * 0.1 + 3.0 * 2.0 * 0.05)
    assert FixedStepper.between(stepper, before, step) == pytest.approx(6.0 * 0.2 - on_body)


@pytest.mark.parametrize("growing", [True, False])
@pytest.mark.parametrize("rim", [None, 0.25])
def test_a_contact_has_its_radius_at_the_end_of_a_step_or_where_that_is_read_as_it_recedes(
    growing: bool, rim: float | None
) -> None:
    """The half width of pressures and gaps that change sign at 0.25; under a rim always the same."""
    places = np.array([0.05, 0.15, 0.2, 0.3, 0.35, 0.45])
    solution: Any = SimpleNamespace(signed_pressure=(0.25 - places) * 8.0)
    stepper: Any = SimpleNamespace(
        scheme=SimpleNamespace(sample=0.25), surface=SimpleNamespace(rim=rim), places=places, heights=places**2,
        _gap=lambda state, found: np.maximum(places - 0.25, 0.0),
    )  # fmt: skip
    receded = object()
    stepper._receded = lambda *of: (0.24, receded)
    before: Any = SimpleNamespace(time=1.0)
    after: Any = SimpleNamespace(time=1.4, velocity=0.1 if growing else -0.1)
    radius, time, ended = FixedStepper._ended(stepper, before, after, [], solution, 0.4)
    assert time == (1.4 if growing and rim is None else pytest.approx(1.1))
    assert ended is (receded if not growing and rim is None else after)
    assert radius == (0.24 if ended is receded else pytest.approx(0.25, abs=0.02))


def test_a_striker_that_bends_over_a_surface_overlaps_it_by_its_own_law_and_nowhere_by_less_than_nothing_matters() -> (
    None
):
    contact: Any = SimpleNamespace(
        strike=SimpleNamespace(overlap=None), heights=np.array([0.0, 0.3]), places=np.array([0.1, 0.2]), scale=0.5
    )
    assert FixedContact.overlap(contact, 0.2) == pytest.approx([0.2, -0.1])
    contact.strike.overlap = lambda places, depth: depth - places * np.array([1.0, 1e9])
    assert FixedContact.overlap(contact, 0.2) == pytest.approx([0.1, -BEYOND * 0.5])


@pytest.mark.parametrize("pressed", [True, False])
def test_a_penalty_is_that_of_the_last_contact_and_what_the_mesh_does_not_hold_is_named(pressed: bool) -> None:
    """In units of the modulus over the contact's radius; of a first one over a tenth of the mesh's unit."""
    given = list[Any]()

    def enforce(problem: Any, *guesses: Any) -> Any:
        given.append((problem.penalty, guesses))
        return outcome

    contact: Any = SimpleNamespace(
        scale=0.5, places=np.array([0.1]), numerics=SimpleNamespace(penalty=12.0),
        enforcement=SimpleNamespace(enforce=enforce, settling="another"),
        surface=SimpleNamespace(rim=None, operator=SimpleNamespace(watched=None)),
    )  # fmt: skip
    surface = PressedSurface(np.eye(1), np.eye(1), np.ones(1))
    steps: Any = [SimpleNamespace(radius=0.2)] if pressed else []

    def solved() -> Any:
        offer: Any = SimpleNamespace(surface=surface)
        return FixedContact._solved(contact, offer, np.zeros(1), 0.0, steps, (np.array([True]),), 3.0)

    outcome = SimpleNamespace(converged=True, edge=lambda places: 0.07)
    assert solved() is outcome
    assert given[0][0] == pytest.approx(12.0 / (0.2 / 0.5 if pressed else 0.1))
    assert given[0][1][0].all()
    for edge, failure in ((0.0, ContactLost), (np.inf, MemoryTooSmall)):
        outcome = SimpleNamespace(converged=True, edge=lambda places, edge=edge: edge)
        with pytest.raises(failure):
            solved()
    contact.surface.rim = 0.3
    assert solved() is outcome, "under a rim all may touch"
    outcome = SimpleNamespace(converged=False)
    with pytest.raises(ContactNotSettled):
        solved()
