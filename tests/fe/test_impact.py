"""One march: Hertz's closed forms, scaling, ends, energies, limits, truths of shape, and the uncondensed route."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

import fe_contact
import lumped
from fe_contact.assembly.operators import system_matrix
from fe_contact.budget.certify import certify
from fe_contact.budget.plan import plan
from fe_contact.contact import problem as contact
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactSolution
from fe_contact.errors import ContactNotSettled, MemoryTooSmall, TooManySteps
from fe_contact.march import impact
from fe_contact.march.impact import march
from fe_contact.methods import simulate
from fe_contact.reference import solve
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import Numerics
from fe_contact.steppers import scaled_surface
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.steppers.steps import Inertia, March, State, Step, Strike
from fe_contact.targets import half_space
from lumped import BadInput
from lumped.laws import mdr
from lumped.materials import Relaxation
from lumped.scene.scene import Scene
from lumped.shapes import Parabola

corrected = ENFORCEMENTS.get("corrected")

Strikes = Callable[..., Strike]
Settings = Callable[..., Numerics]
Scenes = Callable[..., lumped.Scene]

RNG = np.random.default_rng(17)
HERTZ_TIME, HERTZ_FORCE = 2.943275, 1.282689
SLS = Relaxation(1.0, (1.5,), (1.2,))


def marched(strike: Strike, numerics: Numerics, nu: float = 0.3) -> March:
    return march(strike, half_space.surface(nu, numerics), numerics)


def viscoelastic(contact_time: float, share: float = 0.3, ratio: float = 2.5) -> Relaxation:
    """Three-parameter solid with relaxation time in units of the Hertz contact time."""
    return Relaxation(1.0, (ratio - 1,), (share * contact_time,))


# Hertz


@pytest.mark.family
@pytest.mark.parametrize("case", range(4))
def test_an_elastic_impact_is_hertzs(case: int, scene_of: Scenes) -> None:
    nu, young = float(RNG.uniform(0, 0.4999)), float(10 ** RNG.uniform(4, 11))
    radius = float(10 ** RNG.uniform(-4, 1))
    mass = float(10 ** RNG.uniform(2, 5)) * radius**3
    modulus, depth = young / (1 - nu**2), radius * 0.01
    velocity = (16 / 15 * modulus * radius**0.5 * depth**2.5 / mass) ** 0.5
    scene = scene_of(
        {"law": "elastic", "E": young, "nu": nu},
        striker={"radius": radius, "mass": mass, "velocity": velocity},
        model={"profile": "parabola"},
    )
    exact = {
        "duration": HERTZ_TIME * depth / velocity,
        "peak_time": HERTZ_TIME * depth / velocity / 2,
        "peak_depth": depth,
        "peak_force": HERTZ_FORCE * (modulus**2 * radius * mass**3 * velocity**6) ** 0.2,
        "restitution": 1.0,
        "impulse": 2 * mass * velocity,
    }
    result = fe_contact.run(scene, 1e-4)
    for name, value in exact.items():
        found = result.quantities[name]
        assert abs(found.value - value) <= found.error + 5e-7 * value, f"{name} is not covered"
        assert found.value == pytest.approx(value, rel=1e-4 if name != "peak_time" else 1e-3)
    assert abs(result.history.force[0]) < 1e-9 * exact["peak_force"], "nothing presses at touch"


@pytest.mark.parametrize("name", SCHEMES.names)
def test_duration_and_restitution_converge_in_the_order_of_the_scheme(
    name: str, hertz_strike: Strikes, settings_of: Settings
) -> None:
    strike, order = hertz_strike(), SCHEMES.get(name).order
    exact = HERTZ_TIME * 0.01 / strike.velocity
    runs = [marched(strike, settings_of(strike, steps=n, scheme=name)) for n in (16, 32, 64)]
    late = [abs(run.time[-1] / exact - 1) for run in runs]
    lost = [abs(run.impulse[-1] / (2 * strike.mass * strike.velocity) - 1) for run in runs]
    for errors in (late, lost):
        rates = np.log2(np.divide(errors[:-1], errors[1:]))
        assert np.mean(rates) > order - 0.35, errors


# invariance


@pytest.mark.parametrize("case", range(3))
def test_scales_of_length_mass_and_modulus_change_nothing(
    case: int, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """A march knows no unit: powers of ten up to eight, every dimensionless history the same."""
    base = hertz_strike(viscoelastic(10.0))
    length, mass, modulus = 10.0 ** RNG.uniform(-8, 8, 3)
    time = (mass / (modulus * length)) ** 0.5
    spectrum = base.relaxation
    scaled = Strike(
        height=lambda r: length * base.height(r / length),
        mass=mass * base.mass,
        velocity=length / time * base.velocity,
        gravity=0.0,
        relaxation=Relaxation(
            modulus * spectrum.equilibrium,
            tuple(modulus * m for m in spectrum.moduli),
            tuple(time * tau for tau in spectrum.times),
        ),
        end_time=time * base.end_time,
    )
    numerics = settings_of(base, steps=24)
    placed = numerics.varied(contact_radius=length * numerics.contact_radius, contact_time=time * numerics.contact_time)
    plain, large = marched(base, numerics), marched(scaled, placed)
    assert len(plain.time) == len(large.time)
    for found, unit, reference in (
        (large.time, time, plain.time),
        (large.depth, length, plain.depth),
        (large.radius, length, plain.radius),
        (large.impulse, mass * length / time, plain.impulse),
    ):
        np.testing.assert_allclose(found / unit, reference, atol=1e-9 * np.abs(reference).max())


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_a_scene_in_other_units_has_the_same_numbers_and_bars(gravity: float, scene_of: Scenes) -> None:
    """Millimetres, grams, milliseconds and megapascals form a system of units of their own; weight ends no contact."""
    table = {"law": "prony", "E_inf": 1e6, "E": [2e6], "tau": [3e-4], "nu": 0.4}
    length, mass, modulus = 1e3, 1e3, 1e-6
    time = (mass / (modulus * length)) ** 0.5
    other = {"law": "prony", "E_inf": 1.0, "E": [2.0], "tau": [3e-4 * time], "nu": 0.4}
    speed, end = (1e-3, 0.02) if gravity else (0.5, 1.0)
    first, second = (
        fe_contact.run(
            scene_of(
                made,
                striker={"radius": 0.01 * m, "mass": 0.02 * kg, "velocity": speed * m / s},
                model={"gravity": gravity * m / s**2},
                motion={"end_time": end * s},
            ),
            1e-2 if gravity else 1e-3,
        )
        for made, m, kg, s in ((table, 1.0, 1.0, 1.0), (other, length, mass, time))
    )
    assert first.separated == (not gravity)
    units = {
        "peak_force": modulus * length**2,
        "peak_time": time,
        "peak_depth": length,
        "duration": time,
        "restitution": 1.0,
        "impulse": mass * length / time,
        "history_l2": 1.0,
    }
    for name, unit in units.items():
        if first.quantities[name].value is None:
            continue
        assert second.quantities[name].value == pytest.approx(unit * first.quantities[name].value, rel=1e-9)
        assert second.quantities[name].error == pytest.approx(unit * first.quantities[name].error, rel=1e-3)
    share = np.linspace(0.0, 1.0, 50)
    one, other = (np.interp(share, h.time / h.time[-1], h.force_error) for h in (first.history, second.history))
    np.testing.assert_allclose(other, units["peak_force"] * one, rtol=0.02)


# ends


def test_a_fluid_that_is_watched_for_a_short_time_ends_there(scene_of: Scenes) -> None:
    """A Maxwell fluid lets the striker sink: no separation, nothing undefined is given a number."""
    scene = scene_of({"law": "maxwell", "E": 1e6, "eta": 50.0}, motion={"end_time": 0.004})
    result = fe_contact.run(scene, 1e-3)
    assert not result.separated
    assert result.history.time[-1] == pytest.approx(0.004, rel=1e-12)
    assert result.quantities["duration"].value is None
    assert result.quantities["restitution"].value is None
    assert result.history.force[-1] > 0
    assert result.quantities["impulse"].value == pytest.approx(0.02 * (0.5 - result.history.velocity[-1]), rel=1e-6)


@pytest.mark.tenth
def test_a_fluid_creeps_and_is_never_said_to_separate(scene_of: Scenes) -> None:
    """An overdamped Maxwell fluid comes to rest at depth; a march that lets go of it invents a rebound.

    The row of springs, which is exact, says the same: not separated.
    """
    scene = scene_of({"law": "maxwell", "E": 1e6, "eta": 200.0})
    assert mdr.estimate(scene, 70).duration is None
    chosen = plan(scene, {"tolerance": 1e-3}).numerics
    certified = certify(Strike.of(scene), scene.geometry, chosen)
    assert not certified.curve.separated
    assert certified.curve.duration == pytest.approx(scene.end_time)


@pytest.mark.parametrize("share", [0.2, 0.7])
def test_an_end_time_before_separation_is_met_exactly(
    share: float, hertz_strike: Strikes, settings_of: Settings
) -> None:
    numerics = settings_of(hertz_strike())
    strike = hertz_strike(end_time=share * numerics.contact_time)
    whole, cut = marched(hertz_strike(), numerics), marched(strike, numerics)
    assert not cut.separated
    assert cut.time[-1] == pytest.approx(strike.end_time, rel=1e-12)
    same = cut.time < strike.end_time * (1 - 1e-9)
    np.testing.assert_array_equal(cut.depth[same], whole.depth[: same.sum()])


def test_no_rounding_lies_between_the_last_step_and_the_end_time(hertz_strike: Strikes) -> None:
    """Past its last row a history has no force."""
    for time, end in np.sort(RNG.uniform(size=(100, 2)) ** 2):
        strike = hertz_strike(end_time=end)
        state = State(time, 0.0, 0.0, 0.0, np.zeros(1))
        assert Inertia(strike, state, end - time, 0.5).moved(0.0, state.memory).time == end


def test_what_does_not_converge_raises_and_returns_nothing(
    monkeypatch: pytest.MonkeyPatch, hertz_strike: Strikes, settings_of: Settings
) -> None:
    strike = hertz_strike(SLS)
    monkeypatch.setattr(contact, "MAX_ITERATIONS", 1)
    with pytest.raises(ContactNotSettled, match="cure"):
        marched(strike, settings_of(strike))


@pytest.mark.parametrize("failure", [ContactNotSettled(0.0, "a lower numerics.penalty"), MemoryTooSmall(1.0)])
def test_a_contact_too_faint_to_be_found_ends_within_its_bar(
    failure: Exception, monkeypatch: pytest.MonkeyPatch, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """As soon as steps fail below the share of the peak where they may; without that the end is found."""
    strike = hertz_strike(SLS)
    numerics = settings_of(strike)
    stepper = half_space.surface(0.3, numerics).stepper(strike, numerics, ())
    monkeypatch.setattr(impact, "NOISE", 0.05)
    whole, stepped = impact.marched(stepper), stepper.step
    mean = whole.impulse[-1] / whole.time[-1]

    def failing(state: State, steps: Sequence[Step], length: float) -> Step:
        if state.velocity < 0.0 and steps[-1].force < 0.05 * mean:  # no more than that of its peak
            raise failure
        return stepped(state, steps, length)

    monkeypatch.setattr(type(stepper), "step", lambda _, *args: failing(*args))
    cut = impact.marched(stepper)
    assert cut.separated
    assert len(cut.time) < len(whole.time)
    assert 0.0 < abs(cut.time[-1] - whole.time[-1]) < cut.end_spread


def test_too_small_a_memory_and_too_few_steps_are_named(
    monkeypatch: pytest.MonkeyPatch, hertz_strike: Strikes, settings_of: Settings
) -> None:
    strike = hertz_strike()
    small = settings_of(strike).varied(contact_radius=0.05)
    with pytest.raises(MemoryTooSmall, match="exceeds the planned one"):
        marched(strike, small)
    monkeypatch.setattr(impact, "STEPS_ALLOWED", 0.5)
    with pytest.raises(TooManySteps, match="cure"):
        marched(strike, settings_of(strike))


def test_a_memory_larger_than_needed_changes_no_digit_that_counts(hertz_strike: Strikes, settings_of: Settings) -> None:
    strike = hertz_strike(viscoelastic(10.0))
    runs = [marched(strike, settings_of(strike, contact_radius=a)) for a in (0.11, 0.13, 0.17)]
    for run in runs[1:]:
        assert run.impulse[-1] == pytest.approx(runs[0].impulse[-1], rel=3e-5)


# shape of the motion


@pytest.mark.parametrize("share", [0.03, 0.3, 3.0])
def test_the_approach_is_monotone_and_its_radius_is_that_of_the_depth(
    share: float, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """Lee and Radok: while contact grows, its radius is the elastic one at that depth, whatever the memory."""
    strike = hertz_strike(viscoelastic(10.0, share))
    run = marched(strike, settings_of(strike, steps=64))
    turn = int(np.argmax(run.depth))
    assert np.all(np.diff(run.depth[: turn + 1]) > 0)
    assert np.all(np.diff(run.depth[turn:]) < 0)
    growing = run.radius_time < run.time[turn] * (1 - 1e-9)
    radius, depth = run.radius[growing], np.interp(run.radius_time[growing], run.time, run.depth)
    assert np.all(np.diff(radius) > 0)
    np.testing.assert_allclose(radius, np.sqrt(depth), rtol=5e-3)
    assert run.radius.max() <= np.sqrt(run.depth.max()) * 1.005
    shrinking = run.radius_time > run.time[turn]
    assert np.all(np.diff(run.radius[shrinking]) < 0)
    elastic = np.sqrt(np.maximum(np.interp(run.radius_time[shrinking], run.time, run.depth), 0))
    assert np.all(run.radius[shrinking] <= elastic * 1.005 + 1e-4), "in the rebound memory holds the surface down"


# energy


@pytest.mark.parametrize("relaxation", [Relaxation(1.0), viscoelastic(10.0), Relaxation(1.0, viscosity=0.5)])
def test_what_the_energy_account_cannot_place_shrinks_with_the_steps(
    relaxation: Relaxation, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """Each term computed on its own: nothing is left over, and what reaches neither body nor striker falls."""
    strike = hertz_strike(relaxation)
    left = []
    for steps in (16, 64):
        run = marched(strike, settings_of(strike, steps=steps))
        terms = run.energy
        assert terms["in"] == pytest.approx(0.5 * strike.mass * strike.velocity**2, rel=1e-14)
        speed = strike.velocity - run.impulse[-1] / strike.mass
        assert terms["out"] == pytest.approx(0.5 * strike.mass * speed**2, rel=1e-9)
        assert (terms["viscous"] > 0) != relaxation.is_elastic
        assert abs(terms["residual"]) < 1e-9 * terms["in"]
        left.append(abs(terms["contact"] + terms["numerical"]) / terms["in"])
    assert left[1] < 4e-3, left
    assert left[1] < left[0] / 4, f"four times the steps, {left} of the energy"


def test_energies_belong_to_the_answer(scene_of: Scenes) -> None:
    result = fe_contact.run(scene_of({"law": "sls", "E1": 2e6, "E2": 1e6, "C1": 900.0}), 1e-4)
    energy, e = result.energy, result.quantities["restitution"].value
    assert energy["out"] / energy["in"] == pytest.approx(e**2, rel=1e-9)
    assert energy["viscous"] + energy["stored"] == pytest.approx(energy["in"] * (1 - e**2), rel=1e-3)


# gravity


def test_gravity_is_in_the_balance_of_momentum_and_energy(hertz_strike: Strikes, settings_of: Settings) -> None:
    strike = hertz_strike(gravity=0.3 * hertz_strike().velocity / 10)
    run = marched(strike, settings_of(strike, steps=64))
    speed = strike.velocity + strike.gravity * run.time[-1] - run.impulse[-1] / strike.mass
    assert speed == pytest.approx(-strike.velocity, rel=1e-3), "an elastic body gives back what it got"
    assert abs(run.energy["residual"]) < 1e-9 * run.energy["in"]
    without = marched(hertz_strike(), settings_of(hertz_strike(), steps=64))
    assert run.depth.max() > without.depth.max()


def test_a_striker_put_down_softly_on_a_dashpot_and_spring_comes_to_rest_under_its_weight(scene_of: Scenes) -> None:
    """Force m g, depth that of Hertz under it: a limit no part of the march knows of."""
    radius, mass, weight, young = 0.01, 0.02, 0.02 * 9.81, 1e6
    depth = (weight / (4 / 3 * young / 0.91 * radius**0.5)) ** (2 / 3)
    scene = scene_of(
        {"law": "kelvin_voigt", "E": young, "eta": 4e4},
        striker={"velocity": 1e-3},
        model={"gravity": 9.81, "profile": "parabola"},
        motion={"end_time": 0.6},
    )
    result = fe_contact.run(scene, 1e-3, numerics={})
    assert not result.separated
    assert result.history.force[-1] == pytest.approx(weight, rel=1e-3)
    assert result.history.depth[-1] == pytest.approx(depth, rel=1e-3)
    assert mass * 9.81 == weight


# truths of shape


def run_sls(scene_of: Scenes, tau: float, nu: float = 0.3, tolerance: float = 1e-3, **striker: float) -> lumped.Result:
    table = {"law": "prony", "E_inf": 1e6, "E": [1e6], "tau": [tau], "nu": nu}
    return fe_contact.run(scene_of(table, striker=striker), tolerance)


def test_restitution_has_one_minimum_over_the_relaxation_time(scene_of: Scenes) -> None:
    """Far faster or far slower than the impact, the solid is elastic; in between it loses most."""
    time = scene_of({"law": "elastic", "E": 1e6}).elastic_contact_time
    taus = time * 10.0 ** np.linspace(-3, 3, 9)
    e = np.array([run_sls(scene_of, float(tau)).quantities["restitution"].value for tau in taus])
    lowest = int(np.argmin(e))
    assert 0 < lowest < len(e) - 1
    assert np.all(np.diff(e[: lowest + 1]) < 0)
    assert np.all(np.diff(e[lowest:]) > 0)
    assert min(e[0], e[-1]) > 0.99
    assert e[lowest] < 0.8


@pytest.mark.parametrize("share", [0.05, 0.3, 2.0])
def test_peak_force_precedes_peak_depth(share: float, scene_of: Scenes) -> None:
    time = scene_of({"law": "elastic", "E": 1e6}).elastic_contact_time
    result = run_sls(scene_of, share * time)
    deepest = result.history.time[np.argmax(result.history.depth)]
    assert result.quantities["peak_time"].value < deepest


def test_the_loss_is_linear_in_a_small_viscosity(scene_of: Scenes) -> None:
    time = scene_of({"law": "elastic", "E": 1e6}).elastic_contact_time
    etas = 1e6 * time * np.array([0.01, 0.02, 0.04])
    runs = [fe_contact.run(scene_of({"law": "kelvin_voigt", "E": 1e6, "eta": eta}), 1e-4) for eta in etas]
    loss = np.array([1 - run.quantities["restitution"].value for run in runs])
    slopes = loss / etas
    assert np.all(loss > 0)
    away = np.abs(slopes / (2 * slopes[0] - slopes[1]) - 1)  # from the slope extrapolated to no viscosity
    assert away[0] < 0.05
    np.testing.assert_allclose(away[1:] / away[:-1], 2, rtol=0.2, err_msg="the rest is not quadratic in the viscosity")


def test_a_nearly_incompressible_body_loses_no_digit(scene_of: Scenes) -> None:
    """The surface of a half-space knows only E*: with E* kept, Poisson's ratio must not be seen at all."""
    modulus, results = 1.3e6, []
    for nu in (0.0, 0.3, 0.4999):
        table = {"law": "prony", "E_inf": modulus * (1 - nu**2), "E": [modulus * (1 - nu**2)], "tau": [2e-3], "nu": nu}
        results.append(fe_contact.run(scene_of(table), 1e-4))
    for name in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        found = [r.quantities[name].value for r in results]
        assert found[1:] == pytest.approx([found[0]] * 2, rel=2e-5), name
        bars = [r.quantities[name].error for r in results]
        assert max(bars) < 3 * min(bars), "nor does it cost certainty"


def test_lee_and_radoks_law_has_the_exact_peak(scene_of: Scenes) -> None:
    """Until the depth is greatest the correspondence law is exact; its duration is not."""
    scene = scene_of({"law": "sls", "E1": 2e6, "E2": 1e6, "C1": 3000.0})
    reference = fe_contact.run(scene, 1e-4)
    law = lumped.simulate(lumped.laws.get("correspondence").of(scene), scene, tolerance=1e-6)
    for name in ("peak_force", "peak_depth"):
        bar = reference.quantities[name]
        assert abs(law.quantities[name].value - bar.value) <= bar.error
    bar = reference.quantities["restitution"]
    assert abs(law.quantities["restitution"].value - bar.value) > 10 * bar.error


# the uncondensed route


class WholeSurface(NamedTuple):
    """A body with all degrees of freedom of its mesh: nothing condensed, nothing inverted beforehand."""

    matrix: sparse.csc_matrix
    trace: sparse.csr_matrix
    weights: np.ndarray


def solve_whole(problem: Any, touching: np.ndarray) -> ContactSolution:
    """Plain active sets of body and striker, the sparse matrix factorised anew in every iteration."""
    body, striker = problem.surface, sparse.csc_matrix([[1 / problem.yielding]])
    matrix = sparse.block_diag([body.matrix, striker]).tocsc()
    trace = sparse.hstack([body.trace, sparse.csr_matrix(np.ones((len(problem.overlap), 1)))]).tocsr()
    for iteration in range(1, 60):
        springs = sparse.diags(problem.penalty * body.weights * touching)
        system = matrix + trace.T @ springs @ trace
        motion = spsolve(system.tocsc(), trace.T @ (springs @ problem.overlap))
        left = problem.overlap - trace @ motion
        if np.array_equal(left > 0, touching):
            return ContactSolution(problem.penalty * left, iteration, True, (touching,))
        touching = left > 0
    raise AssertionError("the uncondensed route did not converge")


@dataclass(frozen=True)
class Uncondensed(ScaledSurface):
    """The same mesh, but every question to the surface is put to the whole sparse system."""

    basis: Any = None

    def _system(self) -> tuple[sparse.csc_matrix, sparse.csr_matrix, np.ndarray]:
        basis = self.basis
        free = np.setdiff1d(np.arange(2 * basis.N), 2 * basis.get_dofs("axis").flatten())
        at_points = basis.probes(np.stack([self.operator.points, 0 * self.operator.points])).tocoo()
        places, shape = (at_points.row, 2 * at_points.col + 1), (len(self.operator.points), 2 * basis.N)
        axial = sparse.coo_matrix((-at_points.data, places), shape)  # pressing is downwards
        return system_matrix(basis, self.operator.poisson)[free][:, free].tocsc(), axial.tocsr()[:, free], free

    @property
    def pressed(self) -> Any:
        matrix, trace, _ = self._system()
        return WholeSurface(matrix, trace, self.operator.weights)

    def response(self, pressure: np.ndarray) -> np.ndarray:
        matrix, trace, free = self._system()
        motion = np.zeros(2 * self.basis.N)
        motion[free] = spsolve(matrix, trace.T @ (self.operator.weights * pressure))
        surface = self.basis.get_dofs("surface").flatten()
        in_order = surface[np.argsort(self.basis.doflocs[0, surface])]
        return -motion[2 * in_order + 1]


def test_condensing_to_the_surface_changes_nothing(
    monkeypatch: pytest.MonkeyPatch, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """A whole viscoelastic march, memory and rescaling included, against all unknowns refactored each iteration."""
    strike = hertz_strike(viscoelastic(10.0), end_time=7.0)
    numerics = settings_of(strike, steps=12, order=3, elements_per_contact=1.0)
    condensed = half_space.surface(0.3, numerics)
    whole = half_space._whole(0.3, numerics.elements_per_contact, numerics.order, numerics.far_radius)
    expected = march(strike, condensed, numerics)
    seen = expected.snapshots  # made by marching once more, as the march was
    monkeypatch.setattr("fe_contact.contact.enforcement.corrected.solve", solve_whole)
    found = march(strike, Uncondensed(whole.operator, basis=whole.basis), numerics)
    assert found.work.steps == expected.work.steps >= 8
    for name in ("time", "depth", "impulse", "radius"):
        reference = getattr(expected, name)
        np.testing.assert_allclose(getattr(found, name), reference, rtol=0, atol=1e-10 * np.abs(reference).max())
    for whole, small in zip(found.snapshots, seen, strict=True):
        # steep at the edge, where rounding moves the points
        np.testing.assert_allclose(whole.pressure, small.pressure, rtol=0, atol=1e-7 * small.pressure.max())


def test_the_paraboloid_of_these_tests_is_the_one_of_the_suite(hertz_strike: Strikes) -> None:
    radii = np.linspace(0, 1, 5)
    np.testing.assert_array_equal(hertz_strike().height(radii), Parabola(1.0).height(radii))


@pytest.mark.tenth
@pytest.mark.parametrize("name", ["steel-ball", "polymer-sphere", "polymer-layer", "two-finite-spheres"])
def test_every_enforcement_that_is_exact_in_the_limit_tells_the_same_impact(name: str) -> None:
    """The penalty with its bias removed and the augmented Lagrangian: one history within both bars."""
    one, other = (simulate(Scene.load(name), "fe", {"enforcement": e}) for e in ("corrected", "augmented"))
    assert other.converged
    for key in ("peak_force", "peak_depth", "duration", "restitution"):
        first, second = one.quantities[key], other.quantities[key]
        assert abs((first.value or 0.0) - (second.value or 0.0)) < (first.error or 0.0) + (second.error or 0.0), key


@pytest.mark.parametrize("viscosity", [0.0, 0.5, 5.0])
def test_an_end_read_early_lies_within_its_spread_of_the_end_read_late(
    viscosity: float, hertz_strike: Strikes, settings_of: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same steps, followed to where contact has all but ended, and to where it is still seen to end."""
    strike = hertz_strike(Relaxation(1.0, viscosity=viscosity))
    numerics = settings_of(strike, steps=60)

    def end(shortest: float) -> tuple[float, float]:
        monkeypatch.setattr(scaled_surface.Stepper, "shortest", shortest)
        found = marched(strike, numerics)
        return float(found.time[-1]), found.end_spread

    late, _ = end(1e-5)
    for shortest in (3e-4, 1e-3, 2.5e-3):
        early, spread = end(shortest)
        assert abs(early - late) <= spread
        assert spread < 1e-3 * late


def test_without_waves_a_scene_that_asks_for_them_is_refused() -> None:
    with pytest.raises(BadInput, match=r"model\.inertia: true: this command is without waves"):
        solve(Scene.load("steel-ball-waves"), {})


@pytest.mark.parametrize(
    ("own", "freed"),
    [({"order": 1, "elements_per_contact": 2.0}, ("order", "elements_per_contact")), ({"penalty": 1.0}, ("penalty",))],
)
def test_the_cure_that_is_named_helps(own: dict[str, Any], freed: tuple[str, ...]) -> None:
    scene = lumped.Scene.load("polymer-washer")
    found = simulate(scene, "fe", {"tolerance": 1e-2, **own})
    assert not found.converged
    cure = found.message.partition("cure: ")[2]
    assert cure == ", or ".join(f"a higher numerics.{key}" for key in sorted(freed))
    assert simulate(scene, "fe", {"tolerance": 1e-2}).converged


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("edge", "elastic"), [(1e-5, False), (3e-5, True), (3e-5, False), (1e-4, True), (1e-4, False), (3e-3, True)]
)
def test_nodes_that_press_one_by_one_tell_of_a_narrow_edge(
    edge: float, elastic: bool, uncovered: Callable[..., dict[str, float]]
) -> None:
    """A flat end of 1 mm whose edge is rounded by a hundredth of that to thrice as much, by the exact law's history."""
    material = {"target.material": {"law": "elastic", "E": 1.8e6, "nu": 0.3}} if elastic else {}
    scene = lumped.Scene.load("polymer-rounded-punch", {"striker.edge_radius": edge, **material})
    truth = lumped.laws.get("ting").of(scene).simulate(scene, 1e-6)
    found = simulate(scene, "fe", {"tolerance": 1e-2, "enforcement": "exact"})
    assert found.converged, found.message
    assert not uncovered(found, truth, ("peak_force", "duration", "restitution", "peak_depth", "impulse"))
    rows = found.history.time[:-1]
    apart = np.abs(np.interp(rows, truth.history.time, truth.history.force) - found.history.force[:-1])
    assert (apart <= found.history.force_error[:-1] + 1e-5 * truth.history.force.max()).all()
