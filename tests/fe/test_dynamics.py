"""The dynamic core: orders, limits, two routes, and a ledger that closes, on bodies without any geometry."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sparse
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh, expm

from fe_contact.assembly.interior import factorized
from fe_contact.bodies.bar import Bar, falling, line_elements
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics import stepping
from fe_contact.dynamics.body import BodyState, BodyWithMass, Part, Pressing, state_of, undeformed
from fe_contact.dynamics.march import (
    Choices,
    Moment,
    Motion,
    Steppers,
    account_after,
    account_at_start,
    march,
    onwards,
    safe_step,
)
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced
from fe_contact.errors import MotionUnbounded
from lumped.errors import BadInput
from lumped.materials import Relaxation

augmented, corrected, exact, penalty = (
    ENFORCEMENTS.get(name) for name in ("augmented", "corrected", "exact", "penalty")
)

SEEDS = st.integers(0, 2**32 - 1)
ORDER = dict.fromkeys(WAVE_SCHEMES.names, 2) | {"fully_implicit": 1}
IMPLICIT = [name for name in WAVE_SCHEMES.names if not WAVE_SCHEMES.get(name).of(0.8).explicit]
AWAY = -1e9  # clearance of a body that never touches


def oscillator(relaxation: Relaxation, clearance: float = AWAY, dashpot: float = 0.0) -> BodyWithMass:
    """A mass of one on a spring."""
    one = sparse.csc_matrix([[1.0]])
    pressing = Pressing(one, np.ones((1, 1)), np.ones(1), np.array([clearance]))
    return BodyWithMass(one, np.zeros(1), (Part(one, relaxation),), dashpot * one, np.zeros(1), pressing)


def moved(body: BodyWithMass, scheme: str, step: float, end: float, rho: float = 0.8, hard: float = 1.0) -> Motion:
    choices = Choices(WAVE_SCHEMES.get(scheme).of(rho), Enforced(penalty, hard), step)
    return march(body, np.ones(body.size), choices, end, np.eye(body.size))


# schemes


@pytest.mark.family
@pytest.mark.parametrize("name", WAVE_SCHEMES.names)
def test_the_order_of_a_scheme(name: str) -> None:
    """A damped oscillator against its matrix exponential, displacement and velocity."""
    body, end = oscillator(Relaxation(2.0), dashpot=0.3), 4.0
    wanted = expm(end * np.array([[0.0, 1.0], [-2.0, -0.3]])) @ [0.0, 1.0]
    errors = []
    for steps in (40, 80, 160, 320):
        last = moved(body, name, end / steps, end).samples[-1]
        errors.append(np.abs([last.displacement[0] - wanted[0], last.velocity[0] - wanted[1]]).max())
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(rates, ORDER[name], atol=0.2, err_msg=str(errors))


@pytest.mark.family
@pytest.mark.parametrize("name", IMPLICIT)
@pytest.mark.parametrize("tau", [1e-4, 0.03, 0.5])
def test_the_order_does_not_depend_on_how_long_a_branch_remembers(name: str, tau: float) -> None:
    """A spring, a branch far shorter than a step, about as long or longer, against the matrix exponential."""
    body, end, modulus = oscillator(Relaxation(2.0, (0.3 / tau,), (tau,))), 4.0, 0.3 / tau
    rates = [[0.0, 1.0, 0.0], [-2.0, 0.0, -modulus], [0.0, 1.0, -1.0 / tau]]
    wanted = (expm(end * np.array(rates)) @ [0.0, 1.0, 0.0])[:2]
    errors = []
    for steps in (40, 80, 160, 320):
        last = moved(body, name, end / steps, end).samples[-1]
        errors.append(np.abs([last.displacement[0] - wanted[0], last.velocity[0] - wanted[1]]).max())
        assert abs(last.energies.residual) < 1e-12
    found = np.log2(np.divide(errors[:-1], errors[1:]))
    assert found[-1] > ORDER[name] - 0.2


@pytest.mark.family
@pytest.mark.parametrize("name", IMPLICIT)
def test_the_order_is_kept_where_steps_are_doubled(name: str) -> None:
    body, end = oscillator(Relaxation(2.0), dashpot=0.3), 4.0
    errors = []
    for steps in (40, 80, 160, 320):
        enforced, doubled = Enforced(penalty, 1.0), (0.3 * end, 0.6 * end)
        choices = Choices(WAVE_SCHEMES.get(name).of(0.8), enforced, end / steps / 2.0, doubled)
        found = march(body, np.ones(1), choices, end, np.eye(1))
        lengths = np.diff(found.time)
        assert lengths.max() == pytest.approx(4.0 * lengths.min())
        last = found.samples[-1]
        at = last.time * np.array([[0.0, 1.0], [-2.0, -0.3]])
        wanted = expm(at) @ [0.0, 1.0]
        errors.append(np.abs([last.displacement[0] - wanted[0], last.velocity[0] - wanted[1]]).max())
        assert abs(last.energies.residual) < 1e-12
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert rates[-1] == pytest.approx(ORDER[name], abs=0.15)


@pytest.mark.parametrize("name", WAVE_SCHEMES.names)
def test_a_bulk_with_memory_keeps_the_order(name: str) -> None:
    """A mass on a standard linear solid: u'' = -(u + 0.7 z), z' = u' - z/0.4, solved by its exponential."""
    body, end = oscillator(Relaxation(1.0, (0.7,), (0.4,))), 4.0
    rates_of = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, -0.7], [0.0, 1.0, -1 / 0.4]])
    wanted = expm(end * rates_of) @ [0.0, 1.0, 0.0]
    errors = [abs(moved(body, name, end / n, end).samples[-1].displacement[0] - wanted[0]) for n in (40, 80, 160)]
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(rates, ORDER[name], atol=0.2, err_msg=str(errors))


FASTEST: dict[str, Callable[[float], float]] = {
    "generalised_alpha": lambda rho: rho,
    "hht": lambda rho: max(rho, 0.5),
    "trapezoidal": lambda rho: 1.0,
    "fully_implicit": lambda rho: math.sqrt(0.5),  # x^2 - x/2 + 1/2 of Newmark's beta = gamma = 1
}


@pytest.mark.parametrize("name", FASTEST)
@given(rho=st.floats(0.0, 1.0))
def test_an_implicit_scheme_damps_the_fastest_oscillations_by_rho_as_far_as_it_leaves_a_choice(
    name: str, rho: float
) -> None:
    """One step of an oscillator a million times faster than the step: its amplification matrix's eigenvalues."""
    dt, stiff = 1.0, 1e12
    alpha_m, alpha_f, beta, gamma, _ = WAVE_SCHEMES.get(name).of(rho)
    # rows: Newmark's displacement, its velocity, the balance; columns u, v, a
    new = np.array([[1, 0, -beta * dt**2], [0, 1, -gamma * dt], [(1 - alpha_f) * stiff, 0, 1 - alpha_m]])
    old = np.array([[1, dt, (0.5 - beta) * dt**2], [0, 1, (1 - gamma) * dt], [-alpha_f * stiff, 0, -alpha_m]])
    radius = np.abs(np.linalg.eigvals(np.linalg.solve(new, old))).max()
    # a triple eigenvalue splits by the cube root of rounding
    assert radius == pytest.approx(FASTEST[name](rho), abs=2e-4)
    assert ORDER[name] == 1 or gamma == pytest.approx(0.5 - alpha_m + alpha_f), "order two"


def test_central_difference_is_stable_up_to_two_over_omega() -> None:
    """The linear limit, from either side; beyond it the motion is refused, not returned."""
    body = oscillator(Relaxation(1.0))
    below = moved(body, "central_difference", 1.999, 2000.0)
    assert max(abs(sample.displacement[0]) for sample in below.samples) < 100.0
    with pytest.raises(MotionUnbounded, match="cure"):
        moved(body, "central_difference", 2.01, 2000.0)


@pytest.mark.parametrize("name", MASSES.names)
@given(SEEDS)
def test_a_stage_keeps_the_limit_of_every_chain(name: str, seed: int) -> None:
    """The bound without an eigenvalue against 2/omega_max with the contact closed: never above, rarely far below."""
    body, _ = chain(seed, name, viscous=False)
    stiffness = sum(part.relaxation.glassy * part.stiffness.toarray() for part in body.parts)
    stiffness[0, 0] += 50.0
    heavy = body.massive
    fastest = eigh(stiffness[np.ix_(heavy, heavy)], body.inertia.toarray()[np.ix_(heavy, heavy)], eigvals_only=True)[-1]
    assert 0.5 < safe_step(body, Enforced(penalty, 50.0)) / (2 / np.sqrt(fastest)) <= 1.0 + 1e-12


def test_stages_need_a_mass_that_hardly_couples_its_nodes() -> None:
    body = replace(oscillator(Relaxation(1.0)), mass=sparse.csc_matrix([[1.0, 0.9], [0.9, 0.8]]), rigid=np.zeros(2))
    pressing = Pressing(sparse.csc_matrix([[1.0], [0.0]]), np.ones((1, 1)), np.ones(1), np.array([AWAY]))
    parts = (Part(sparse.eye(2).tocsc(), Relaxation(1.0)),)
    with pytest.raises(BadInput, match="lumped"):
        safe_step(replace(body, parts=parts, pressing=pressing), Enforced(penalty, 1.0))


def test_a_parallel_viscosity_asks_for_an_implicit_scheme() -> None:
    with pytest.raises(BadInput, match="implicit"):
        moved(oscillator(Relaxation(1.0, viscosity=0.1)), "central_difference", 0.1, 1.0)


@pytest.mark.parametrize("name", IMPLICIT)
def test_a_parallel_viscosity_is_a_dashpot_by_the_stiffness(name: str) -> None:
    """And one dashpot among others adds up with it."""
    stiff = (Part(sparse.csc_matrix([[4.0]]), Relaxation(0.5, viscosity=0.05)),)
    viscous = moved(replace(oscillator(Relaxation(1.0), dashpot=0.1), parts=stiff), name, 0.1, 4.0)
    damped = moved(oscillator(Relaxation(2.0), dashpot=0.3), name, 0.1, 4.0)
    for one, other in zip(viscous.samples, damped.samples, strict=True):
        assert one.displacement == pytest.approx(other.displacement, rel=1e-12, abs=1e-12)
        assert one.velocity == pytest.approx(other.velocity, rel=1e-12, abs=1e-12)


# mass


def elements(seed: int) -> tuple[np.ndarray, np.ndarray, int]:
    """A chain of elements of three nodes and random lengths: local masses, nodes, their number."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 8))
    quadratic = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 30
    local = rng.uniform(0.5, 2.0, count)[:, None, None] * quadratic
    return local, 2 * np.arange(count)[:, None] + np.arange(3), 2 * count + 1


@pytest.mark.parametrize("name", MASSES.names)
@given(SEEDS)
def test_every_mass_matrix_keeps_the_mass(name: str, seed: int) -> None:
    local, dofs, size = elements(seed)
    matrix = MASSES.get(name).of(local, dofs, size, np.array([0])).toarray()
    assert matrix.sum() == pytest.approx(local.sum(), rel=1e-12)
    least = np.linalg.eigvalsh(matrix)[0]
    assert least >= (0.0 if name in ("redistributed", "spread") else 1e-6)


@pytest.mark.parametrize("name", ["redistributed", "spread"])
@given(SEEDS)
def test_only_the_contact_is_without_mass(name: str, seed: int) -> None:
    local, dofs, size = elements(seed)
    contact = np.array([0, size - 1])
    diagonal = MASSES.get(name).of(local, dofs, size, contact).diagonal()
    assert set(np.flatnonzero(diagonal == 0.0)) == set(contact)


# the ledger


def chain(seed: int, name: str, viscous: bool) -> tuple[BodyWithMass, np.ndarray]:
    """A random elastic chain with memory, dashpots, gravity and a rigid mass, about to touch; its velocity."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 9))
    bar = Bar(1.0, 1.0, 1.0, Relaxation(1.0, tuple(rng.uniform(0.2, 1, 2)), (0.02, 0.4)), end_mass=rng.uniform(0, 1))
    body = falling(bar, count, MASSES.get(name), gravity=rng.uniform(0, 1), gap=rng.uniform(0, 0.1))
    dashpots = sparse.diags(np.append(rng.uniform(0, 0.2, count), 0.0)[::-1]).tocsc()
    relaxation = Relaxation(1.0, (0.3,), (0.2,), viscosity=0.01 if viscous else 0.0)
    parts = (*body.parts, Part(body.parts[0].stiffness, relaxation))
    whole = BodyWithMass(body.mass, body.rigid, parts, dashpots, body.gravity, body.pressing)
    return whole, -rng.uniform(0.1, 1, whole.size)


@pytest.mark.family
@pytest.mark.parametrize("scheme", WAVE_SCHEMES.names)
@pytest.mark.parametrize("mass_name", MASSES.names)
def test_the_ledger_closes_in_every_step(scheme: str, mass_name: str, campaign_size: Callable[[int], int]) -> None:
    """Every term is computed on its own, the scheme's loss by its numbers: nothing may be left over."""
    for seed in range(campaign_size(100)):
        ledger_closes(scheme, mass_name, seed)


def ledger_closes(scheme: str, mass_name: str, seed: int) -> None:
    body, velocity = chain(seed, mass_name, viscous=scheme in IMPLICIT)
    enforcement = (penalty, corrected, augmented, exact)[seed % 4]
    choices = Choices(WAVE_SCHEMES.get(scheme).of(0.7), Enforced(enforcement, 50.0), 0.02)
    motion = march(body, velocity, choices, 0.6, np.eye(body.size))
    ledgers = [sample.energies for sample in motion.samples]
    size = max(e.work + abs(e.numerical) for e in ledgers)
    assert max(abs(e.residual) for e in ledgers) < 1e-10 * size
    for lost in ("viscous", "radiated"):
        assert np.all(np.diff([getattr(e, lost) for e in ledgers]) >= 0.0)
    assert ledgers[-1].viscous > 0.0
    assert all(min(e.rigid, e.deformable, e.strain, e.contact) >= 0.0 for e in ledgers)
    goes_on_with_what_the_matrices_make_of_it(body, motion.final)


def goes_on_with_what_the_matrices_make_of_it(body: BodyWithMass, state: BodyState) -> None:
    """Step after step only increments are multiplied, whose sum is what the whole would make."""
    whole = state_of(body, state.time, state.motions[0], state.branches, state.signed_pressure)
    for ours, known in zip((*state.motions, *state.pulls), (*whole.motions, *whole.pulls), strict=True):
        np.testing.assert_allclose(ours, known, rtol=1e-10, atol=1e-11 * np.abs(known).max())


@pytest.mark.parametrize("scheme", WAVE_SCHEMES.names)
def test_the_account_of_a_step_multiplies_by_no_matrix(scheme: str) -> None:
    body, velocity = chain(3, "consistent" if scheme in IMPLICIT else "lumped", viscous=scheme in IMPLICIT)
    steppers, numbers = Steppers(body, Enforced(penalty, 50.0)), WAVE_SCHEMES.get(scheme).of(0.7)
    before = undeformed(body, velocity)
    stepper = steppers.of(numbers, 0.02)
    after, _ = stepper.advance(before)
    known = account_after(account_at_start(body, before), stepper, before, after)
    bare = replace(body, mass=None, parts=tuple(replace(part, stiffness=None) for part in body.parts))
    vars(bare).update(weight=body.weight, damping=body.damping)
    stepper.body = bare
    assert account_after(account_at_start(bare, before), stepper, before, after) == known


@pytest.mark.parametrize("rho", [0.0, 1.0])
@pytest.mark.parametrize("name", IMPLICIT)
def test_no_step_is_too_long_for_an_implicit_scheme(name: str, rho: float) -> None:
    """Whatever spectral radius is asked for: a free oscillator, in steps of half a period and of many."""
    for step in (3.0, 1e3):
        found = moved(oscillator(Relaxation(1.0)), name, step, 100.0 * step, rho).final
        assert np.hypot(found.displacement, found.velocity) < 2.0


def test_the_trapezoidal_rule_loses_nothing_and_a_damped_scheme_only_what_oscillates_fast() -> None:
    """Free vibration of a bar: 0, a little, much, by the scheme's own formula and by what is left in the bar."""
    bar = Bar(1.0, 1.0, 1.0, Relaxation(1.0))
    body = falling(bar, 20, MASSES.get("consistent"), gravity=0.0, gap=1e9)
    velocity = np.cos(np.pi * np.linspace(0, 1, 21))
    lost = {}
    for name in IMPLICIT:
        energies = (
            march(
                body, velocity, Choices(WAVE_SCHEMES.get(name).of(0.8), Enforced(penalty, 1.0), 0.02), 4.0, np.eye(21)
            )
            .samples[-1]
            .energies
        )
        lost[name] = energies.numerical / energies.work
        assert energies.total / energies.work == pytest.approx(1 - lost[name], abs=1e-12)
    assert abs(lost["trapezoidal"]) < 1e-12
    assert 0.0 < lost["generalised_alpha"] < lost["hht"] < 1e-3
    assert lost["fully_implicit"] > 0.05


# contact


@pytest.mark.family
@pytest.mark.parametrize("name", WAVE_SCHEMES.names)
def test_a_mass_on_its_penalty_spring_bounces_by_half_a_sine(name: str) -> None:
    """Duration pi sqrt(m/k), restitution one: touch and separation lie within the steps, not at their ends."""
    hard, errors = 40.0, []
    for step in (0.02, 0.01, 0.005, 0.0025):
        body = oscillator(Relaxation(1e-12), clearance=-0.1037)
        choices = Choices(WAVE_SCHEMES.get(name).of(0.8), Enforced(penalty, hard), step)
        motion = march(body, -np.ones(1), choices, 1.0, np.ones((1, 1)))
        ((start, end),) = motion.contacts
        assert start == pytest.approx(0.1037, abs=1e-9)
        errors.append(abs(end - start - math.pi / math.sqrt(hard)) / step)
    rate = np.log2(errors[0] * 8 / errors[-1]) / 3  # in shares of a step, which halves too
    assert max(errors) < 1.0 if name == "fully_implicit" else max(errors) < 0.3
    assert rate > 0.8 * ORDER[name]


@pytest.mark.parametrize(("enforcement", "share"), [(corrected, 0.5), (augmented, 1e-6), (exact, 1e-6)])
def test_every_enforcement_is_nearer_to_rigid_contact_than_the_raw_penalty(enforcement: object, share: float) -> None:
    """A bar without gravity pressed by its rigid mass: the deepest overlap, of a soft penalty and of the others."""
    bar = Bar(1.0, 1.0, 1.0, Relaxation(1.0), end_mass=3.0)
    deepest = {}
    for member in (penalty, enforcement):
        body = falling(bar, 20, MASSES.get("redistributed"), gravity=0.0)
        choices = Choices(WAVE_SCHEMES.get("generalised_alpha").of(0.6), Enforced(member, 20.0), 0.025)
        motion = march(body, -np.ones(21), choices, 2.0, np.eye(21))
        deepest[member] = max(sample.overlap.max() for sample in motion.samples)
    assert deepest[enforcement] < share * deepest[penalty]


@pytest.mark.tenth
def test_a_light_bar_under_a_rigid_mass_is_a_spring() -> None:
    """Density to zero: half a sine of the mass on E A/L, contact for pi sqrt(m L/(E A)), by every mass matrix."""
    duration = math.pi * math.sqrt(2.0)
    for name in MASSES.names:
        bar = Bar(1.0, 1.0, 1e-8, Relaxation(1.0), end_mass=2.0)
        body = falling(bar, 10, MASSES.get(name), gravity=0.0)
        choices = Choices(WAVE_SCHEMES.get("generalised_alpha").of(0.0), Enforced(corrected, 1e3), duration / 400)
        motion = march(body, -np.ones(11), choices, 1.2 * duration, np.eye(11))
        start, end = motion.contacts[0]
        assert end - start == pytest.approx(duration, rel=1e-4)
        assert motion.force.max() == pytest.approx(math.sqrt(2.0), rel=1e-4)
        assert motion.samples[-1].velocity[-1] == pytest.approx(1.0, rel=1e-4)


def test_a_striker_is_one_more_degree_of_freedom() -> None:
    """A rigid mass that strikes a bar, by its own depth, and the same bar striking a plane with the mass at rest."""
    size, line = 11, falling(Bar(1.0, 1.0, 1.0, Relaxation(1.0)), 10, MASSES.get("consistent"), gravity=0.0)
    push = sparse.lil_matrix((size + 1, 2))
    push[0, 0], push[size, 1] = 1.0, -1.0
    whole = BodyWithMass(
        mass=sparse.block_diag([line.mass, sparse.csc_matrix((1, 1))]).tocsc(),
        rigid=np.append(np.zeros(size), 1e9),
        parts=(Part(sparse.block_diag([line.parts[0].stiffness, sparse.csc_matrix((1, 1))]).tocsc(), Relaxation(1.0)),),
        dashpots=None,
        gravity=np.zeros(size + 1),
        pressing=Pressing(push.tocsc(), np.ones((1, 2)), np.ones(1), np.zeros(1)),
    )
    choices = Choices(WAVE_SCHEMES.get("generalised_alpha").of(0.6), Enforced(corrected, 30.0), 0.05)
    struck = march(whole, np.append(np.zeros(size), 1.0), choices, 1.5, np.eye(size + 1))
    striking = march(line, -np.ones(size), choices, 1.5, np.eye(size))
    np.testing.assert_allclose(struck.force, striking.force, atol=1e-7)


@pytest.mark.parametrize("own_node", [True, False])
def test_a_step_of_bodies_that_do_not_feel_each_other_is_that_of_their_matrices(own_node: bool) -> None:
    """Two bars and a mass, pressed at three, at two and at one node; or the mass where the first bar is."""
    bar = Bar(1.0, 1.0, 1.0, Relaxation(1.0))
    lines = [falling(bar, elements, MASSES.get("consistent"), gravity=0.0) for elements in (5, 2)]
    size, pressed = 10, [0, 1, 2, 6, 7]
    push = np.zeros((size, 6 if own_node else 5))
    push[pressed, range(5)], push[-1, -1 if own_node else 0] = 1.0, -1.0
    nodes, stiffness = push.shape[1], sparse.block_diag([*(line.parts[0].stiffness for line in lines), [[0.0]]])
    body = BodyWithMass(
        mass=sparse.block_diag([*(line.mass for line in lines), [[0.0]]]).tocsc(),
        rigid=np.append(np.zeros(size - 1), 2.0),
        parts=(Part(stiffness.tocsc(), Relaxation(1.0)),),
        dashpots=None,
        gravity=np.zeros(size),
        pressing=Pressing(sparse.csc_matrix(push), np.eye(nodes), np.ones(nodes), np.full(nodes, 0.1)),
    )
    scheme = WAVE_SCHEMES.get("generalised_alpha").of(0.6)
    stepper = stepping.ImplicitStepper(body, scheme, Enforced(penalty, 30.0), 0.5)
    effective = (1 - scheme.alpha_m) / (scheme.beta * 0.25) * body.inertia + (1 - scheme.alpha_f) * stiffness
    known = (1 - scheme.alpha_f) * np.linalg.solve(effective.toarray(), push)
    after, found = stepper.advance(undeformed(body, np.zeros(size)))
    np.testing.assert_allclose(
        np.linalg.inv(stepper.effective.surface.stiffness), push.T @ known, rtol=1e-9, atol=1e-12
    )
    np.testing.assert_allclose(after.displacement, known @ found.pressure, rtol=1e-9, atol=1e-12)


def test_one_factorisation_serves_a_whole_march(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    monkeypatch.setattr(stepping, "factorized", lambda matrix: calls.append(matrix.shape) or factorized(matrix))
    body = falling(Bar(1.0, 1.0, 1.0, Relaxation(1.0)), 10, MASSES.get("redistributed"), gravity=0.0)
    for name, wanted in (("trapezoidal", [(11, 11)]), ("central_difference", [(10, 10), (1, 1)])):
        calls.clear()
        choices = Choices(WAVE_SCHEMES.get(name).of(1.0), Enforced(exact, 1.0), 0.05)
        march(body, -np.ones(11), choices, 5.0, np.eye(11))
        assert calls == wanted


def test_a_march_goes_on_with_the_factors_that_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contact after contact, and a flight in steps of the same length."""
    calls = []
    monkeypatch.setattr(stepping, "factorized", lambda matrix: calls.append(matrix.shape) or factorized(matrix))
    body = falling(Bar(1.0, 1.0, 1.0, Relaxation(1.0)), 10, MASSES.get("consistent"), gravity=0.0)
    choices = Choices(WAVE_SCHEMES.get("generalised_alpha").of(0.5), Enforced(exact, 1.0), 0.05)
    steppers, state = Steppers(body, choices.enforced), undeformed(body, -np.ones(11))
    moment = Moment(state, account_at_start(body, state))
    for _ in range(3):
        motion = onwards(steppers, moment, choices, 1.0, np.eye(11), lambda sample: False)
        moment = Moment(motion.final, motion.samples[-1].energies)
    assert calls == [(11, 11)]
    assert steppers.made == 1


def test_a_constraint_on_a_surface_with_mass_acts_from_the_first_instant() -> None:
    """A lumped bar at its own limit step carries a jump without error: density c v from t = 0 for two transits."""
    body = falling(Bar(1.0, 1.0, 1.0, Relaxation(1.0)), 50, MASSES.get("lumped"), gravity=0.0)
    choices = Choices(WAVE_SCHEMES.get("central_difference").of(1.0), Enforced(exact, 1.0), 0.02)
    motion = march(body, -np.ones(51), choices, 1.98, np.eye(51))
    np.testing.assert_allclose(motion.force, 1.0, atol=1e-9)


def test_what_makes_up_for_the_lag_of_a_step_is_exact_but_for_rounding() -> None:
    """(1/(1 - exp(-x)) - 1/2 - 1/x) per modulus, x the step over the relaxation time; by a longer mantissa."""
    ratios = np.geomspace(1e-5, 10.0, 61)
    long = ratios.astype(np.longdouble)
    exact = -1.0 / np.expm1(-long) - 0.5 - 1.0 / long
    part = Part(sparse.csc_matrix(np.eye(1)), Relaxation(0.0, (1.0,) * ratios.size, tuple(1.0 / ratios)))
    assert part.law(1.0).late == pytest.approx(exact.astype(float), abs=1e-9 * ratios.max(), rel=1e-6)
    assert np.all(np.abs(part.law(1.0).late - exact) <= 1e-9 * ratios)


@pytest.mark.parametrize("tip", [1.0, 0.25])
def test_a_bar_cut_into_elements_has_its_mass_where_it_is_and_its_stiffness(tip: float) -> None:
    """Linear motions are exact: kinetic energy of a bar that turns about its end, elastic energy of one stretched."""
    bar = Bar(length=0.7, area=0.02, density=800.0, relaxation=Relaxation(3.0))
    line = line_elements(bar, 5, tip)
    place = np.concatenate([[0.0], np.cumsum(0.7 / (4.0 + tip) * np.array([tip, 1.0, 1.0, 1.0, 1.0]))])
    for motion, inertia in ((np.ones(6), 0.7), (place, 0.7**3 / 3.0)):
        held = np.einsum("ei,eij,ej", motion[line.dofs], line.mass, motion[line.dofs])
        assert held == pytest.approx(800.0 * 0.02 * inertia)
    assert line.stiffness @ place == pytest.approx(0.02 * np.array([-1.0, 0.0, 0.0, 0.0, 0.0, 1.0]), abs=1e-12)
