"""A half-space that yields: elastic before, balance of energy, limits, published laws, bars, refusals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import restitution_laws as published
from first_yield import first_yield
from scipy.integrate import solve_ivp
from scipy.special import beta
from skfem import MeshTri

import fe_contact
from fe_contact.assembly.forms import Array
from fe_contact.errors import BodyTooFine, MemoryTooSmall
from fe_contact.indentation import indent
from fe_contact.plastic import ground
from fe_contact.plastic.course import (
    BEYOND,
    MESH_ORDER,
    Course,
    Forces,
    PlasticLoading,
    Varied,
    _depth_of,
    settings,
    smooth,
    within_core,
)
from fe_contact.plastic.fields import STRESS, PressedAgain
from fe_contact.plastic.impact import SPRUNG, Answered, HeldDown, Rebound, Runner, _at_most, _release, pilot, plan
from fe_contact.plastic.indent import YieldingWay, _onwards
from fe_contact.plastic.path import FIRST_RELEASED, RELEASED, PlasticFlowSlow, PlasticZoneWide, Presser, Station
from fe_contact.plastic.settling import GUESSES, RENEWED
from fe_contact.progress import silent
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import Work
from fe_contact.studies.compare.study import compare
from lumped import Result, Scene, simulate
from lumped.errors import BadInput
from lumped.indentation import Indentation
from lumped.laws import ting
from lumped.result.model_ledger import FLOW
from lumped.scene.indenter import Indenter
from lumped.scene.tables import SceneReader
from lumped.schema import Table
from lumped.shapes import Sphere
from lumped.shapes.cone import Cone

YOUNG, STRENGTH, RADIUS, MASS = 2e11, 4e8, 0.005, 4e-3
COARSE = {"elements_per_contact": 7.0, "steps": 12, "tolerance": 0.05}
COARSEST = {"elements_per_contact": 5.0, "steps": 12, "tolerance": 0.1}
CAMPAIGN = {3e-2: 20, 1e-2: 10, 1e-3: 4}  # impacts by tolerance
WHOLE = sum(CAMPAIGN.values())
QUARTER = 1.75  # times as many elements and steps, for a quarter of the tolerance
SCATTER = 0.05  # of Johnson's restitution, an asymptote of what hardly springs back
ROUNDED = {"shape": "rounded_punch", "flat_radius": 0.01, "edge_radius": 0.01}
COURSE = Course(Sphere(1.0), 0.3, 1.0, 1e-3, 0.0, first=0.01, firm=0.02, deepest=0.8)
ABOUT = {"elements_per_contact": 8.0, "steps": 16, "tolerance": 0.01}


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


@pytest.mark.tenth
def test_before_it_yields_it_is_elastic() -> None:
    found = pressed([0.3 * yield_depth(0.3), 0.9 * yield_depth(0.3)], COARSE)
    hertz = 4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS) * found.depth**1.5
    assert np.all(np.abs(found.force / hertz - 1.0) < found.force_error / hertz)
    assert np.all(found.force_error < 0.02 * hertz)


@pytest.mark.tenth
def test_a_weight_on_what_never_yields_moves_as_by_ting(uncovered: Callable[..., dict[str, float]]) -> None:
    table = tables(mass=MASS, velocity=0.02)
    elastic = Scene.from_dict(table | {"model": {"gravity": 2000.0}})
    strong = replace(elastic.material, yield_strength=1e3 * STRENGTH)
    scene = replace(elastic, material=strong, model=replace(elastic.model, plasticity=True))
    assert uncovered(fe_contact.run(scene, numerics=COARSEST), simulate(ting.of(elastic), elastic, 1e-7)) == {}


def test_it_yields_first_under_the_axis() -> None:
    """At p0 = 1.60 Y and 0.48 a deep, nu = 0.3: Johnson, Contact Mechanics (1985), 6.2; by a loading still elastic."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    depth = 0.95 * yield_depth(0.3)
    course = Course.of(indenter, depth, depth)
    ground = course.ground(settings({"elements_per_contact": 16.0}, course))
    presser = Presser(ground, 4000.0, course.unit)
    here = presser.first(depth / course.unit, math.sqrt(RADIUS * depth) / course.unit)
    assert not np.any(here.state[1])
    stored = here.scale**3 * ground.stored(here.displacement, here.state)
    assert stored == pytest.approx(0.4 * here.force * here.depth, rel=0.02)
    assert ground.worked(here.state) == 0.0
    core = ground.body.cored.core
    stress = ground.yielding.flowed(core.gradient(here.displacement), *here.state).stress
    mean = stress[[0, 3, 4]].mean(axis=0)
    mises = np.sqrt(1.5 * ((stress[[0, 3, 4]] - mean) ** 2).sum(axis=0) + 3.0 * stress[1] ** 2)
    places = np.asarray(ground.basis.global_coordinates())[:, ground.elements] * (here.scale / here.radius)
    near = (places[0] < 0.15) & (np.abs(places[1] + 0.5) < 0.25)
    radius, below, high = places[0][near], -places[1][near], mises[near]
    terms = np.column_stack([radius**2, *(below**k for k in range(5))])
    axis = np.polynomial.Polynomial(np.linalg.lstsq(terms, high, rcond=None)[0][1:])
    deepest = min(axis.deriv().roots().real, key=lambda root: abs(root - 0.5))
    pressure = 1.5 * here.force / (np.pi * here.radius**2)
    assert pressure / axis(deepest) == pytest.approx(first_yield(0.3)[0], rel=0.01)
    assert first_yield(0.3)[0] == pytest.approx(1.60, rel=0.01)
    assert deepest == pytest.approx(0.48, abs=0.01)


@pytest.mark.parametrize(("share", "known"), [(1.0, 1e-3), (0.3, 1e-3), (0.3, 0.05)])
def test_a_striker_on_a_spring_that_gives_back_a_share_of_its_depth_moves_as_known(share: float, known: float) -> None:
    """k d^(3/2) on the way in, and as round a release: its duration and restitution by the root of that share.

    Below the first depth ``known``, over the greatest, goes on what a sphere on an elastic body does.
    """
    k, mass, velocity, power = 3e9, 0.2, 1.5, 1.5
    energy = 0.5 * mass * velocity**2
    deepest = (2.5 * energy / k) ** 0.4
    depth = deepest * np.geomspace(known, 1.2, 300)
    lost = (1.0 - share) * energy
    given = Answered(
        depth, np.log(k * depth**1.5), np.sqrt(depth), share, SPRUNG, np.sqrt(SPRUNG), 0.0, lost, 0.0 * depth
    )
    rebound = Rebound(given, mass, energy, power, power)
    shallow = deepest * np.geomspace(1e-6, 1.0, 9)
    assert rebound.force(shallow) == pytest.approx(k * shallow**1.5, rel=1e-6)
    found = rebound.march(Work())
    half = deepest / velocity * beta(0.4, 0.5) / 2.5
    back = math.sqrt(share)
    assert found.depth.max() == pytest.approx(deepest, rel=1e-6)
    assert found.time[-1] == pytest.approx(half * (1.0 + back), rel=1e-5)
    assert found.time[found.depth.argmax()] == pytest.approx(half, rel=1e-5)
    assert found.impulse[-1] == pytest.approx(mass * velocity * (1.0 + back), rel=1e-5)
    assert found.depth[-1] == pytest.approx((1.0 - share) * deepest, abs=1e-9 * deepest)
    assert abs(found.energy["residual"]) < 1e-5 * energy
    coming = found.depth[: found.depth.argmax() + 1]
    speed = velocity - found.impulse[: coming.size] / mass
    assert 0.5 * mass * speed**2 + 0.4 * k * coming**2.5 == pytest.approx(energy, rel=1e-5)
    assert found.radius[: coming.size - 1] ** 2 == pytest.approx(coming[1:], rel=1e-3)


def test_a_weight_goes_deeper_and_leaves_slower_or_is_held() -> None:
    """A spring k d^(3/2) that gives back a third of its depth, integrated beside it.

    A weight set down on k d is pressed with twice its own, which as round a release uses up within 4/5 of its way.
    """
    k, mass, velocity, share = 3e9, 0.2, 0.05, 1.0 / 3.0
    depth = np.geomspace(1e-8, 1e-3, 2000)
    given = Answered(
        depth, np.log(k * depth**1.5), np.sqrt(depth), share, SPRUNG, np.sqrt(SPRUNG), 0.0, 0.0, 0.0 * depth
    )
    weight = 0.3 * k * (1.25 * mass * velocity**2 / k) ** 0.6
    found = Rebound(given, mass, 0.5 * mass * velocity**2, 1.5, 1.5, weight).march(Work())

    def fallen(start: list[float], push: Callable[[float], float], end: Callable[[Any, Any], float]) -> Any:
        end.terminal = True  # type: ignore[attr-defined]  # how scipy is told
        return solve_ivp(
            lambda t, y: [y[1], (weight - push(y[0])) / mass],
            (0.0, 1e-2),
            start,
            "DOP853",
            events=end,
            rtol=1e-10,
            atol=1e-16,
        )

    there = fallen([0.0, velocity], lambda d: k * max(d, 0.0) ** 1.5, lambda t, y: y[1])
    deepest = float(there.y[0, -1])
    left = (1.0 - share) * deepest
    back = fallen(
        [deepest, 0.0],
        lambda d: k * deepest**1.5 * (max(d - left, 0.0) / (deepest - left)) ** 1.5,
        lambda t, y: y[0] - left,
    )
    lasts, speed = there.t[-1] + back.t[-1], -float(back.y[1, -1])
    assert found.depth.max() == pytest.approx(deepest, rel=1e-6)
    assert found.time[-1] == pytest.approx(lasts, rel=1e-5)
    assert found.impulse[-1] == pytest.approx(mass * (velocity + speed) + weight * lasts, rel=1e-5)
    assert found.energy["in"] == pytest.approx(0.5 * mass * velocity**2 + weight * left, rel=1e-6)
    assert found.energy["out"] == pytest.approx(0.5 * mass * speed**2, rel=1e-4)
    cored = replace(given, logarithm=np.log(1e6 * depth))
    with pytest.raises(HeldDown):
        Rebound(cored, mass, 1e-6, 1.5, 1.0, 100.0).march(Work())


@pytest.mark.parametrize("gravity", [0.0, 1e5])
def test_no_impact_goes_much_deeper_than_where_its_energy_is_spent_at_the_least_pressure(gravity: float) -> None:
    """Three quarters of the strength on what overlaps, pi (2 R d - d^2), less the weight: from there on to 1.15 times
    as deep.
    """
    scene = Scene.from_dict(tables(mass=MASS, velocity=3.0) | {"model": {"plasticity": True, "gravity": gravity}})
    energy = 0.5 * MASS * scene.velocity**2
    depth = np.array([1.0, 1.0 / 1.15]) * _at_most(scene, energy)
    spent = 0.75 * STRENGTH * math.pi * (RADIUS * depth**2 - depth**3 / 3.0) - MASS * gravity * depth
    most, before = spent
    assert before < 1.001 * energy <= 1.002 * most


@pytest.fixture(scope="module")
def impact() -> Result:
    return struck(6.0, ABOUT)


@pytest.mark.tenth
def test_an_impact_balances_its_energy_and_leaves_a_dent(impact: Result) -> None:
    energy, brought = impact.energy, 0.5 * MASS * impact.scene.velocity**2
    assert energy["in"] == pytest.approx(brought)
    assert abs(energy["residual"] or 0.0) < 2e-3 * brought
    assert 0.1 * brought < (energy["plastic"] or 0.0) < 0.3 * brought
    assert energy["out"] == pytest.approx((impact.quantities["restitution"].value or 0.0) ** 2 * brought, rel=1e-6)
    assert impact.recovery is not None
    assert impact.recovery.permanent == pytest.approx(impact.history.depth[-1])
    assert 0.1 < impact.recovery.permanent / (impact.quantities["peak_depth"].value or 1.0) < 0.4


@pytest.mark.tenth
def test_fields_fit_the_striker_and_show_the_dent(impact: Result) -> None:
    """Pressure and force, surface and profile, plastic strain where theory begins it, and what is left on the axis."""
    again = PressedAgain.of(impact.scene, impact)
    fields, amount = again.fields(0.0)
    r, z = fields.points.T
    order = np.argsort(r[z == 0.0])
    radius, pressure = r[z == 0.0][order], fields.pressure[z == 0.0][order]
    force = np.trapezoid(2.0 * np.pi * radius * pressure, radius)
    assert force == pytest.approx(impact.quantities["peak_force"].value, rel=0.02)
    inside = (z == 0.0) & (r < 0.9 * fields.contact_radius)
    overlap = fields.depth - impact.scene.profile.height(r[inside])
    assert -fields.displacement[inside, 1] == pytest.approx(overlap, abs=2e-3 * fields.depth)
    deepest = int(amount.argmax())
    assert r[deepest] < 0.7 * fields.contact_radius
    assert 0.2 < -z[deepest] / fields.contact_radius < 0.6
    assert not amount[np.hypot(r, z) > 3.0 * fields.contact_radius].any()
    dent = again.dent
    assert impact.recovery is not None
    assert -dent.left[0] == pytest.approx(impact.recovery.permanent, rel=0.05)
    assert dent.left[-1] == pytest.approx(0.0, abs=0.02 * fields.depth)
    assert dent.left.max() > 0.0, "what flowed piles up"


@pytest.mark.tenth
def test_elastic_laws_are_judged_by_what_they_leave_out(impact: Result) -> None:
    found = compare(None, impact, ("hertz", "kelvin"))
    for judgement in found.judgements:
        assert judgement.exceeds("restitution")
        assert judgement.errors["restitution"] == pytest.approx(1.0 - (impact.quantities["restitution"].value or 0.0))
        assert (judgement.errors["peak_force"] or 0.0) > 0.0


@pytest.mark.tenth
def test_restitution_falls_among_the_published_ones(impact: Result, campaign_size: Callable[..., int]) -> None:
    """Over V*: Thornton's cut-off pressure is too soft, Johnson's of full plasticity too firm until V* = 100.

    Two fits to others' finite elements, of restitution itself and of what flattens and springs back, part as V* grows:
    by 0.06 at 20, by 0.11 at 60, where the first one's range ends. Beyond, the second falls as V*^(-0.17), for the mean
    pressure still grows; the asymptote of a constant one, V*^(-1/4), comes later.
    """
    speeds = [6.0, 3.0, 20.0, 60.0, 240.0][: campaign_size(5)]
    found = {speed: impact if speed == 6.0 else struck(speed, {"tolerance": 0.01}) for speed in speeds}
    restitution = {speed: result.quantities["restitution"].value or 0.0 for speed, result in found.items()}
    for speed, value in restitution.items():
        assert published.thornton(speed) < value < published.johnson(speed) * (1.0 + SCATTER)
        if speed <= 20.0:
            assert value == pytest.approx(published.jackson_green_marghitu(speed), abs=0.03)
        if speed <= 60.0:
            assert published.jackson_green_marghitu(speed) - 0.01 < value < published.sprung_back(speed)
    if 240.0 in restitution:
        slope = math.log(restitution[240.0] / restitution[60.0]) / math.log(4.0)
        fit = math.log(published.sprung_back(240.0) / published.sprung_back(60.0)) / math.log(4.0)
        assert -0.25 < slope == pytest.approx(fit, abs=0.02)


@pytest.mark.tenth
def test_bars_hold_against_finer_runs(
    impact: Result, uncovered: Callable[..., dict[str, float]], campaign_size: Callable[..., int]
) -> None:
    """Random nu, hardening in two of three, depths to 30 times that of first yield: all runs that are as much finer as
    a quarter of the tolerance asks for lie within the sum of both bars, and nineteen of twenty converge. A part of the
    campaign is one impact, coarsely.
    """
    if campaign_size(WHOLE) < WHOLE:
        assert uncovered(struck(6.0, COARSEST), impact) == {}
        return
    converged = []
    for tolerance, count in CAMPAIGN.items():
        random = np.random.default_rng(7)
        for _ in range(count):
            nu, hardening = float(random.uniform(0.2, 0.49)), float(random.uniform(0.0, 0.1)) * YOUNG
            hardening *= float(random.random() < 0.7)
            speed = float(np.exp(random.uniform(0.0, math.log(30.0)))) ** 1.25
            one = struck(speed, {"tolerance": tolerance}, nu, hardening)
            own = {key: QUARTER * one.numerics[key] for key in ("elements_per_contact", "steps")}
            own |= {"tolerance": tolerance / 4.0, "steps": round(own["steps"])}
            finer = struck(speed, own, nu, hardening)
            assert uncovered(one, finer) == {}, (tolerance, nu, hardening, speed)
            converged.append(one.converged)
    assert np.mean(converged) >= 0.95


LASTING, DEEPEST = 0.37, 0.5


def let_go(left: Array, force: Array) -> list[Station]:
    """Places of a release from DEEPEST that leaves LASTING, by what is left of the rest, 1 first; round contacts."""
    depth, none = LASTING + (DEEPEST - LASTING) * left, np.zeros(1)
    rows = zip(depth, force, left**0.5, strict=True)
    return [Station(float(deep), none, (), float(push), none, float(radius)) for deep, push, radius in rows]


@pytest.mark.parametrize(("count", "terms"), [(9, (1.0, 0.1, -0.05, 0.04, 0.03)), (5, (1.0, 0.1, -0.05))])
def test_a_release_whose_force_is_known_ends_where_it_is_none(count: int, terms: tuple[float, ...]) -> None:
    """Its power 2/3 of the fifth degree in what is left, of the third by five places; the radius a root of it."""
    root, left = np.polynomial.Polynomial((0.0, *terms)), np.linspace(1.0, 0.1, count)
    springs, roots, shrunk = _release(let_go(left, root(left) ** 1.5), 1.5)
    assert springs == pytest.approx((DEEPEST - LASTING) / DEEPEST)
    assert roots == pytest.approx(root(SPRUNG) / sum(terms), abs=1e-9)
    assert shrunk[SPRUNG >= 0.1] == pytest.approx(SPRUNG[SPRUNG >= 0.1] ** 0.5, rel=0.02 if count > 5 else 0.05)
    assert shrunk[0] == 0.0
    assert np.all(np.diff(shrunk) > 0.0)


@pytest.mark.parametrize("seed", range(5))
def test_forces_that_err_by_chance_change_a_release_by_no_more(seed: int) -> None:
    """The edge of a contact crosses elements: many places with noise, of which each says little."""
    noise = 1e-3 * np.random.default_rng([20261128, seed]).uniform(-1.0, 1.0, 22)
    left = np.linspace(1.0, RELEASED, noise.size)
    springs, roots, _ = _release(let_go(left, left**1.5 * (1.0 + noise)), 1.5)
    assert springs == pytest.approx((DEEPEST - LASTING) / DEEPEST, rel=1e-3)
    assert roots == pytest.approx(SPRUNG, abs=1e-3)


def test_two_meshes_that_agree_by_chance_do_not_close_the_bar() -> None:
    """A third one tells; where errors fall with order one, all three tell the finest mesh's own error."""

    def onwards(one: float, better: float, worse: float, weight: float) -> float:
        return one + weight * (better - worse)

    def bar(fine: float, middle: float, coarse: float) -> float:
        pairs = Varied(fine, middle, coarse, coarse, coarse, coarse, coarse).pairs(onwards, math.sqrt(2.0))["mesh"]
        return sum(pair.factor * abs(pair.first - pair.second) for pair in pairs)

    assert bar(1.0, 1.0, 1.1) > 0.1
    assert bar(1.01, 1.01 + 0.01 * (math.sqrt(2.0) - 1.0), 1.02) == pytest.approx(1.25 * 0.01)


@pytest.mark.parametrize("steps", [12, 48])
@pytest.mark.parametrize("cause", ["mesh", "penalty", "time_step", "far_field"])
def test_an_entry_covers_what_its_own_setting_leaves_and_the_square_of_the_steps_counts_out(
    cause: str, steps: int, hertz_strike: Callable[..., Any], settings_of: Callable[..., Numerics]
) -> None:
    """Errors of order one, and of two by how far away the body ends, which is half as far where it is cut.

    So from the fewest steps of which half still tell anything on.
    """
    numerics = settings_of(hertz_strike(), steps=steps)

    def run(given: Numerics, cut: bool) -> Array:
        off = {"mesh": 1.0 / given.elements_per_contact, "penalty": 1.0 / given.penalty}
        off |= {"time_step": 1.0 / given.steps, "far_field": 4e-2 if cut else 1e-2}
        return np.array([1.0 + off[cause] + 1.0 / given.steps**2])

    told = Varied.of(run, numerics, 0.5 * numerics.elements_per_contact)
    error = float(abs(told.mended(_onwards) - 1.0)[0])
    bars = {of: sum(one.factor * float(abs(one.first - one.second)[0]) for one in pairs)
            for of, pairs in told.pairs(_onwards, math.sqrt(2.0)).items()}  # fmt: skip
    assert 0.0 < error <= bars.pop(cause) < 1.3 * error
    assert max(bars.values()) < 1e-9


@pytest.mark.full
@pytest.mark.parametrize(("nu", "hardening", "speed"), [(0.4, 0.06, 9.0), (0.3, 0.0, 40.0), (0.45, 0.01, 20.0)])
def test_forces_converge_with_the_order_that_the_bars_of_the_mesh_trust(
    nu: float, hardening: float, speed: float
) -> None:
    """From the coarsest mesh on, until what is left is noise."""
    velocity = speed * math.sqrt(2.0 * yield_energy(nu) / MASS)
    course = pilot(Scene.from_dict(tables(nu, hardening * YOUNG, mass=MASS, velocity=velocity))).course
    depth, told = np.geomspace(max(1.5 * course.firm, 0.02 * course.deepest), course.deepest, 8), []
    for elements in (3.0, 4.5, 10.5):
        numerics = settings({"tolerance": 5e-3}, course).varied(elements_per_contact=elements, steps=32)
        loading = PlasticLoading.of(course, numerics)
        loading.to(BEYOND * course.deepest)
        told.append(loading.pressed.logarithm(depth))
    coarse, middle = (float(np.linalg.norm(one - told[-1])) for one in told[:-1])
    assert middle < coarse / 1.5**MESH_ORDER


@pytest.mark.parametrize("rim", [False, True])
def test_a_body_that_is_cut_ends_half_as_far_away(rim: bool) -> None:
    """In a quarter disc, but for the elements that the cut goes through."""
    far = 12.0
    mesh = ground._mesh(ground.Sizes(elements=2.0, order=2, far_radius=far, rim=rim, cut=True))
    (ar, az), (br, bz), (cr, cz) = (mesh.p[:, corner] for corner in mesh.t)
    area = 0.5 * np.abs((br - ar) * (cz - az) - (cr - ar) * (bz - az)).sum()
    assert area == pytest.approx(0.25 * np.pi * (0.5 * far) ** 2, rel=0.2)
    assert 0.45 * far < np.hypot(*mesh.p).max() < 0.75 * far


@pytest.mark.parametrize(
    ("share", "found"), [(1e-10, 0.0), (2e-9, 2e-9), (1e-3, 1e-3), (0.7, 0.7), (9.0, 9.0), (17.0, 16.0)]
)
def test_a_depth_at_which_the_pressure_is_so_high_is_found_between_the_touch_and_far_beyond_the_deepest(
    share: float, found: float
) -> None:
    """Under a sphere 4 a/(3 pi R) of E*, a^2 = R depth; a cone presses as hard at any depth."""
    radius, deepest = 0.02, 3e-9
    pressure = 4.0 / (3.0 * math.pi) * math.sqrt(share * deepest / radius)
    assert _depth_of(Sphere(radius), pressure, deepest) / deepest == pytest.approx(found, rel=1e-6)
    cone = Cone(10.0)
    mean = 0.5 * math.tan(math.radians(10.0))
    assert _depth_of(cone, 0.99 * mean, deepest) == 0.0
    assert _depth_of(cone, 1.01 * mean, deepest) == 16.0 * deepest


def test_a_first_step_that_reaches_no_point_of_the_mesh_is_no_force() -> None:
    """A stiff body that yields at once: forces begin where one is."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    course, none = Course.of(indenter, 1e-5, 4e-5), np.zeros(1)
    depths, forces = np.geomspace(1e-3, 1.0, 9), np.geomspace(1e-6, 1e-2, 9)
    forces[0] = 0.0
    flows = (none, np.ones(1))
    places = [
        Station(float(d), none, flows, float(f), none, float(d**0.5)) for d, f in zip(depths, forces, strict=True)
    ]
    rest = Presser(course.ground(settings(COARSE, course)), 1.0, course.unit)
    found = PlasticLoading(course, settings(COARSE, course), rest, places).pressed
    assert found.depth == pytest.approx(course.unit * depths[1:])
    assert np.all(np.isfinite(found.logarithm(np.array([0.0, course.unit * depths[0], found.depth[3]]))))


@pytest.mark.parametrize("edge", [0.501, 0.53, 0.549])
@pytest.mark.parametrize("bent", [0.0, 0.2])
def test_a_contact_ends_where_its_gap_closes(edge: float, bent: float) -> None:
    """Amid two points of the surface, by gaps as of Hertz but for a bend; what presses overlaps by next to nothing."""
    points = np.linspace(0.0, 1.0, 21)
    gap = 0.1 * np.maximum(points - edge, 0.0) ** 1.5 * (1.0 + bent * (points - edge))
    within = np.where(points < edge, 1e-9, -gap)
    presser: Any = SimpleNamespace(ground=SimpleNamespace(rim=False, points=points))
    assert Presser._edge(presser, within) == pytest.approx(edge, abs=1e-9 if bent == 0.0 else 1e-3)
    assert Presser._edge(presser, np.where(points < 0.99, 1e-9, -gap)) == np.inf


@pytest.mark.parametrize("steps", [20, 60])
@pytest.mark.parametrize("begins", [0.75, 1.0, 3.0])
def test_a_force_is_elastic_up_to_where_it_yields_and_bends_from_there_on(begins: float, steps: int) -> None:
    """Where its loss begins as a square, and nothing yields at the last depth before; noise as of a mesh counts out."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    course, none = Course.of(indenter, 0.3 * yield_depth(0.3), 12.0 * yield_depth(0.3)), np.zeros(1)
    depth, onset = course.depths(steps, course.deepest), begins * yield_depth(0.3)
    elastic = indenter.profile.load_curve.force
    noise = 1e-5 * np.random.default_rng([20261129, steps]).uniform(-1.0, 1.0, depth.size)

    def loss(depth: Array) -> Array:
        later = np.log(np.maximum(depth / onset, 1.0))
        return np.asarray(np.log1p(0.047 * later**2) + 1e-3)

    force = np.asarray(elastic(depth)) / course.unit**2 * np.exp(noise - loss(depth))
    places = [
        Station(d / course.unit, none, (none, np.array([float(d > onset)])), f, none, 1.0)
        for d, f in zip(depth.tolist(), force.tolist(), strict=True)
    ]
    rest = Presser(course.ground(settings(COARSE, course)), 1.0, course.unit)
    found = PlasticLoading(course, settings(COARSE, course), rest, places).pressed
    asked = np.geomspace(depth[0], depth[-1], 300)
    wrong = found.logarithm(asked) - np.log(course.modulus * np.asarray(elastic(asked))) + loss(asked)
    assert np.abs(wrong[asked < onset]).max() < 3e-5
    assert np.abs(wrong).max() < (6e-5 if steps == 60 else 2e-4)
    assert np.abs(found.misfit(asked)).max() < 2e-4


@pytest.mark.parametrize("elastic", [4, 9])
@pytest.mark.parametrize("share", [0.0, 0.02])
def test_a_profile_that_is_no_power_is_followed_or_told(share: float, elastic: int) -> None:
    """Its force parts from the power in proportion to the depth; what is missed before yielding is in the misfit."""
    depth = 1e-3 * 1.5 ** np.arange(elastic + 1.0)
    force = depth**1.5 * np.exp(share * depth / depth[-1])
    found = Forces(depth, force, np.sqrt(depth), 1.5, 0.35, elastic)
    asked = np.geomspace(depth[0], depth[elastic - 1], 50)
    wrong = np.abs(found.logarithm(asked) - np.log(asked**1.5) - share * asked / depth[-1]).max()
    assert wrong <= 1.2 * np.abs(found.misfit(asked)).max() + 1e-12
    assert wrong <= 0.1 * share + 1e-12


def test_no_exact_law_enters_what_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hertz' force chooses where the loading begins, and nothing more."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    asked = np.array([0.5, 3.0]) * yield_depth(0.3)
    course = Course.of(indenter, float(asked[0]), float(asked[-1]))
    way = YieldingWay(course, asked, frozenset(), silent)
    honest = way.certified(settings(COARSEST, course))
    monkeypatch.setattr(Sphere, "load_curve", property(lambda self: pytest.fail("an exact law was asked")))
    blind = way.certified(settings(COARSEST, course))
    np.testing.assert_array_equal(blind.logarithm, honest.logarithm)
    assert {cause: list(error) for cause, error in blind.budget.items()} == {
        cause: list(error) for cause, error in honest.budget.items()
    }


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_few_samples_make_a_smooth_curve_of_less_degree(count: int) -> None:
    """From zero on with no slope: a power of its place that so many tell."""
    place = np.linspace(0.2, 0.5, count) if count > 1 else np.array([0.4])
    power = min(count + 1, 3)
    found = smooth(place, place**power, 0.5, rising=True)
    asked = np.linspace(0.0, place[-1], 9)
    assert found(asked) == pytest.approx(asked**power, abs=1e-12)


@pytest.mark.tenth
def test_a_ball_on_what_flows_from_the_touch_on_is_planned_as_by_a_constant_pressure() -> None:
    """Rigid but for plastic flow: energy = p pi a^4/(4 R c^2), p 2.6 to 3 yield strengths, c^2 1 to 1.5 by what piles
    up (Johnson, Contact Mechanics, 6.3).
    """
    scene = Scene.load("paper-concrete-plastic", {"target.material.E": 8.87e11})
    material, radius = scene.geometry.material, scene.profile.radius
    share = 4.0 * radius * (0.5 * scene.reduced_mass * scene.velocity**2) / (math.pi * material.yield_strength)
    assert (share / 3.0) ** 0.25 < plan(scene, {}).numerics.contact_radius < (1.5 * share / 2.6) ** 0.25


def test_a_loading_ends_by_name_where_its_iterations_are_spent_and_tells_its_problems() -> None:
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    course, told = Course.of(indenter, 1e-5, 4e-5), list[float]()
    loading = PlasticLoading.of(course, settings(COARSE, course), most=20, counted=told.append)
    with pytest.raises(PlasticFlowSlow, match=r"more than 20 guesses up to depth .* m; cure: a lower striker"):
        loading.to(4e-5)
    assert told == [1.0] * loading.presser.counts.problems
    assert 20 < loading.presser.counts.iterations <= 20 + GUESSES * RENEWED


@pytest.mark.tenth
def test_a_punch_yields_with_the_coarsest_settings_and_fewer_elements_are_refused() -> None:
    """The work of a rim's elastic contact, F = 2 E* a depth, where nothing but its very rim yields."""
    depth, punch = [4e-6], {"shape": "punch", "radius": RADIUS}
    found = pressed(depth, {"tolerance": 0.05}, **punch)
    elastic = 2.0 * modulus(0.3) * RADIUS * found.depth
    assert np.all(np.abs(found.force / elastic - 1.0) < 1e-2)
    assert np.all(found.force < elastic * 1.001)
    for few, accepted, striker in ((1.9, "from 2 to 32", punch), (3.9, "from 4 to 32", {})):
        with pytest.raises(BadInput, match=rf"elements_per_contact: {few}.*{accepted}"):
            pressed(depth, {"elements_per_contact": few}, **striker)


@pytest.mark.tenth
def test_forces_lie_among_the_published_ones_and_where_the_ledger_says() -> None:
    """Sphere on half-space: the published ones flatten spheres, whose mean pressures differ by 4 %."""
    depth = np.array([1.5, 3.0, 6.0, 12.0, 24.0, 60.0])
    found = pressed((depth * yield_depth(0.3)).tolist(), {"tolerance": 0.01})
    share = found.force / (4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS) * found.depth**1.5)
    for law in (published.jackson_green, published.kogut_etsion):
        assert share == pytest.approx([law(one) for one in depth], rel=0.1)
    lost, estimate = 1.0 - share, FLOW * np.log(depth) ** 2
    assert lost == pytest.approx(estimate / (1.0 + estimate), rel=0.3, abs=5e-3)
    mean = found.force / (np.pi * found.contact_radius**2 * STRENGTH)
    assert np.all(np.diff(mean) > 0.0)
    assert mean == pytest.approx([published.kogut_etsion_pressure(one) for one in depth], rel=0.04)


@pytest.mark.tenth
@pytest.mark.parametrize(("nu", "strength"), [(-0.74, 0.7), (0.0, 0.4)])
def test_a_peak_loses_what_the_ledger_says_whatever_the_ratio_of_poisson(nu: float, strength: float) -> None:
    """To a factor of two, twice as hard pressed as where it first yields or so: sooner where nu is negative."""
    material = {"law": "elastic", "E": 1e9, "nu": nu, "yield_strength": 1e12}
    striker = {"shape": "sphere", "radius": 0.01, "mass": 0.05, "velocity": 0.2}
    scene = Scene.from_dict({"striker": striker, "target": {"shape": "half_space", "material": material}})
    hertz = scene.profile.hertz_impact(scene.contact_modulus.spring, scene.mass, scene.velocity)
    pressure = 1.5 * hertz.force / (math.pi * hertz.contact_radius**2)
    own = scene.changed({"target.material.yield_strength": strength * pressure})
    still, flows = (fe_contact.run(one, tolerance=1e-2) for one in (own, own.changed({"model.plasticity": True})))
    peaks = [one.quantities["peak_force"].value or math.nan for one in (still, flows)]
    (entry,) = [one for one in still.model_ledger if one.effect == "plasticity"]
    assert 0.5 < (entry.estimate or 0.0) / (1.0 - peaks[1] / peaks[0]) < 2.0


@pytest.mark.tenth
def test_a_cone_is_self_similar() -> None:
    """No length: F ~ depth^2, whatever it flows."""
    found = pressed([1e-6, 4e-6], COARSEST, shape="cone", angle=2.0)
    share, bar = found.force / found.depth**2, found.force_error / found.force
    assert abs(share[0] / share[1] - 1.0) < bar.sum() < 0.1


@pytest.mark.parametrize("reach", [8.0, 16.0, 32.0])
def test_a_core_is_as_wide_as_the_flow_needs_and_no_wider_than_is_meshed(reach: float) -> None:
    tried = []

    def told(course: Course) -> float:
        tried.append(course.core)
        if course.core < reach:
            raise PlasticZoneWide("depth 1e-3 m", course.core)
        return course.core

    with pytest.raises(PlasticZoneWide, match="13 contact radii") if reach > ground.WIDEST else nullcontext():
        assert within_core(COURSE, told) == reach
    assert tried == [core for core in (4.0, 8.0, 16.0) if core <= reach]


def test_a_pressure_given_overlaps_by_as_much_as_the_penalty_needs_for_it() -> None:
    known = COURSE.ground(settings(COARSEST, COURSE))
    given = np.linspace(0.2, 0.1, known.points.size)
    height = np.asarray(known.profile.height(0.5 * known.unit * known.points)) / (0.5 * known.unit)
    springs = known.springs(0.5, 0.1, 40.0, given)
    assert springs.pressed(height - 0.1) == pytest.approx(given * known.body.skin.weights.ravel())
    assert springs.within(height) == pytest.approx(0.1 + given / 40.0)
    assert springs.energy(height) == pytest.approx(0.5 * springs.pressed(height) @ springs.within(height))
    assert springs.pressed(height - 1.0) == pytest.approx(0.0)


@pytest.mark.parametrize(("core", "enough"), [(0.5 * ground.WIDEST, False), (ground.WIDEST, True)])
def test_flow_seven_contact_radii_away_is_within_the_wider_core_alone(core: float, enough: bool) -> None:
    known = replace(COURSE, core=core).ground(settings(COARSEST, COURSE))
    middles = known.basis.mesh.p[:, known.basis.mesh.t[:, known.elements]].mean(axis=1)
    distance = np.hypot(*middles)
    assert 0.8 * core < distance.max() < core
    strain, amount = known.rest
    amount[np.abs(distance - 7.0) < 0.6] = 1e-6
    assert known.contained((strain, amount)) is enough


def test_what_cannot_yield_here_is_refused_by_name() -> None:
    for change, key in (
        ({"target": {"shape": "layer", "thickness": 1.0, "base": "bonded"}}, "target.shape"),
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


@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_body_is_too_fine_by_its_own_number_of_unknowns(order: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Known before they are made, to a tenth."""
    mesh = MeshTri().refined(5)
    unknowns = 2 * ground.yielding_basis(mesh, order).N
    monkeypatch.setattr(ground, "MOST_UNKNOWNS", int(1.1 * unknowns))
    ground.yielding_basis(mesh, order)
    monkeypatch.setattr(ground, "MOST_UNKNOWNS", int(0.9 * unknowns))
    with pytest.raises(BodyTooFine, match="accepted up to"):
        ground.yielding_basis(mesh, order)


@pytest.mark.parametrize("order", [2, 3])
def test_a_body_that_yields_has_no_more_points_than_its_degree_asks_for(order: int) -> None:
    """Exact up to the power 2 order - 1, and not beyond: more points would resist flow that keeps the volume."""
    basis = ground.yielding_basis(
        MeshTri(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), np.array([[0], [1], [2]])), order
    )
    (x, _), powers = np.asarray(basis.global_coordinates()), range(2 * order + 1)
    errors = [abs(float(np.vdot(basis.dx, x**power)) * (power + 1.0) * (power + 2.0) - 1.0) for power in powers]
    assert max(errors[:-1]) < 1e-13
    assert errors[-1] > 1e-6


@pytest.mark.parametrize(
    ("first", "firm", "end", "steps", "coarse", "fine"),
    [
        (1.0, 1.0, 1.5**8, 12, 0, 8), (1.0, 1.5**3, 1.5**9, 12, 3, 6), (0.2, 0.9, 0.9 * 1.2**7, 30, 4, 7),
        (1.0, 1.5**9, 1.5**8, 12, 8, 0), (1.0, 1.01, 1.01 * 1.1**20, 60, 1, 20),
    ],
)  # fmt: skip
def test_depths_of_a_loading_are_counted_by_hand(
    first: float, firm: float, end: float, steps: int, coarse: int, fine: int
) -> None:
    """Half as deep again where nothing yields, by 6/steps from there on; as few as are needed, even of each kind."""
    depths = replace(COURSE, first=first, firm=firm).depths(steps, end)
    assert depths.size == coarse + fine + 1
    assert depths[[0, coarse, -1]] == pytest.approx([first, min(max(firm, first), end), end], rel=1e-12)
    for some, most in ((depths[: coarse + 1], 1.5), (depths[coarse:], 1.0 + 6.0 / steps)):
        ratios = some[1:] / some[:-1]
        assert ratios == pytest.approx(ratios[:1].repeat(ratios.size), rel=1e-9)
        assert ratios.max(initial=1.0) <= most * (1.0 + 1e-8)


def test_a_short_loading_has_a_depth_more_than_forces_of_a_smooth_curve() -> None:
    """Seven of them, in even steps: its first may reach no point of the mesh."""
    depths = replace(COURSE, first=1.0, firm=1.3).depths(12, 1.6)
    assert depths == pytest.approx(1.6 ** (np.arange(7) / 6.0), rel=1e-12)


def test_an_answer_is_in_units_of_its_course_whatever_was_expected() -> None:
    """Settings of what yields have no length or time of their own: contacts that outgrow them do so by a factor."""
    chosen = settings({}, COURSE)
    assert (chosen.contact_radius, chosen.contact_time, chosen.peak_share) == (1.0, 1.0, 0.5)
    assert COURSE.outgrown(3.0) == replace(COURSE, deepest=9.0 * COURSE.deepest)


@dataclass(eq=False)
class Known(Presser):
    """A body whose answer is known, in units of E* and ``unit``: k depth^power, and round a release that gives back a
    ``SHARE`` of the depth; what its points remember is the greatest depth, and how long their mesh is.
    """

    def settled(
        self, state: Any, depth: float, displacement: Array, pressure: Array, radius: float, scale: float
    ) -> Station:
        body: Any = self.ground
        top = max(float(state[1][0]), depth)
        left = 1.0 - (top - depth) / (SHARE * top)
        force = body.stiffness * top**body.power * max(left, 0.0) ** body.power
        reached = 1.0 if body.rim else math.sqrt(body.radius * top * max(left, 0.0))
        self.counts += (1, 1)
        moved = np.full(2, -depth / scale)
        return Station(depth, moved, (np.zeros(1), np.array([top, scale])), force, pressure, reached, scale)


SHARE = 0.6
SLOW = 2.0 * math.sqrt(2.0 * yield_energy(0.3) / MASS)
PUNCH = {"shape": "punch", "radius": RADIUS}


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., None]]:
    """Puts a body in place of what flows whose force errs by a share that depends on the settings."""

    def put(off: Callable[[Numerics, bool], float] = lambda numerics, cut: 0.0) -> None:
        def body(course: Course, numerics: Numerics, cut: bool = False) -> Any:
            power, radius = 1.0 if course.rim else 1.5, RADIUS / course.unit
            stiffness = (2.0 if course.rim else 4.0 / 3.0 * math.sqrt(radius)) * (1.0 + off(numerics, cut))
            core, weights = SimpleNamespace(size=2), np.zeros((1, 2))
            whole = SimpleNamespace(cored=SimpleNamespace(core=core), skin=SimpleNamespace(weights=weights))
            spent = (1.0 - SHARE) * stiffness / (power + 1.0)
            return SimpleNamespace(
                body=whole,
                rest=(np.zeros(1), np.array([0.0, 1.0])),
                carried=lambda state, growth: (state[0], state[1] * [1.0, growth]),
                points=np.array([0.3, 0.9]),
                rim=course.rim,
                unknowns=2,
                stored=lambda displacement, state: 0.0,
                worked=lambda state: spent * float(state[1][0]) ** (power + 1.0) / float(state[1][1]) ** 3,
                power=power,
                stiffness=stiffness,
                radius=radius,
            )

        monkeypatch.setattr(Course, "ground", body)
        monkeypatch.setattr("fe_contact.plastic.course.Presser", Known)
        pilot.cache_clear()

    yield put
    pilot.cache_clear()


def moves_as(striker: Table, scene: Scene) -> dict[str, float]:
    """The impact on that body, by energy and by the beta function."""
    power = 1.0 if striker is PUNCH else 1.5
    k = modulus(0.3) * (2.0 * RADIUS if striker is PUNCH else 4.0 / 3.0 * math.sqrt(RADIUS))
    deepest = ((power + 1.0) * 0.5 * MASS * scene.velocity**2 / k) ** (1.0 / (power + 1.0))
    half = deepest / scene.velocity * beta(1.0 / (power + 1.0), 0.5) / (power + 1.0)
    back = math.sqrt(SHARE)
    return {
        "peak_force": k * deepest**power,
        "peak_depth": deepest,
        "peak_time": half,
        "duration": half * (1.0 + back),
        "restitution": back,
        "impulse": MASS * scene.velocity * (1.0 + back),
    }


@pytest.mark.parametrize("striker", [{}, PUNCH], ids=["sphere", "punch"])
def test_an_impact_on_a_body_that_answers_as_known_is_known(striker: Table, known: Callable[..., None]) -> None:
    """Planned, struck, recorded, and pressed again for its fields; what it leaves is what does not spring back."""
    known()
    scene = Scene.from_dict(tables(mass=MASS, velocity=SLOW, **striker))
    true, energy = moves_as(striker, scene), 0.5 * MASS * scene.velocity**2
    expected = plan(scene, {"tolerance": 1e-3}).numerics
    radius = RADIUS if striker is PUNCH else math.sqrt(RADIUS * true["peak_depth"])
    assert expected.contact_radius == pytest.approx(radius, rel=0.02)
    # the plan does not know the release: as far out as in
    assert expected.contact_time == pytest.approx(2.0 * true["peak_time"], rel=1e-3)
    assert expected.peak_share == pytest.approx(0.5, rel=1e-3)
    found = fe_contact.run(scene, tolerance=1e-3)
    assert found.converged
    for name, value in true.items():
        assert found.quantities[name].value == pytest.approx(value, rel=3e-5), name
    assert found.quantities["history_l2"].value == 0.0
    assert found.history.force[0] == 0.0
    left = (1.0 - SHARE) * true["peak_depth"]
    assert found.recovery is not None
    assert found.recovery.permanent == pytest.approx(left, rel=1e-4)
    assert found.energy["in"] == pytest.approx(energy)
    assert found.energy["plastic"] == pytest.approx((1.0 - SHARE) * energy, rel=1e-4)
    assert abs(found.energy["residual"] or 0.0) < 1e-4 * energy
    again = PressedAgain.of(scene, found)
    assert again.course.deepest == pytest.approx(true["peak_depth"], rel=0.02)
    assert again.course.unit * again.peak.depth == pytest.approx(true["peak_depth"], rel=1e-4)
    assert again.course.unit * again.peak.scale * again.left == pytest.approx(-left, rel=1e-3)


@pytest.mark.parametrize("cause", ["mesh", "penalty", "time_step", "far_field"])
def test_bars_of_an_impact_hold_what_its_settings_err_by_which_are_refined(
    cause: str, known: Callable[..., None]
) -> None:
    """A force that errs by a share everywhere, with the order of its cause; all but steps, extrapolated, by no more."""

    def off(numerics: Numerics, cut: bool) -> float:
        errors = {"mesh": 0.8 / numerics.elements_per_contact**2, "penalty": 640.0 / numerics.penalty}
        errors |= {"time_step": 80.0 / numerics.steps**2, "far_field": (18.0 if cut else 4.5) / numerics.far_radius**2}
        return errors[cause]

    known(off)
    scene = Scene.from_dict(tables(mass=MASS, velocity=SLOW))
    true, first = moves_as({}, scene), plan(scene, {"tolerance": 1e-3}).numerics
    found = fe_contact.run(scene, tolerance=1e-3)
    for name in ("peak_force", "peak_time", "peak_depth", "duration"):
        quantity, most = found.quantities[name], 3.0 if name == "peak_time" else 2.0  # the slope of a change may ripple
        wrong, bar = abs((quantity.value or 0.0) - true[name]), quantity.error or 0.0
        assert wrong <= bar + 2e-5 * true[name], name
        assert cause == "time_step" or bar <= most * wrong, name
    for name in ("restitution", "impulse"):
        assert found.quantities[name].value == pytest.approx(true[name], rel=1e-6)
    assert found.recovery is not None
    left = (1.0 - SHARE) * true["peak_depth"]
    wrong, bar = abs(found.recovery.permanent - left), found.recovery.error[0]
    assert wrong <= bar + 1e-5 * left
    assert cause == "time_step" or bar <= 2.0 * wrong
    changed = {name for name, value in found.numerics.items() if value != first.as_dict()[name]}
    setting = {"mesh": "elements_per_contact", "time_step": "steps", "far_field": "far_radius"}.get(cause, cause)
    assert {setting} <= changed <= {setting, "steps"}


@pytest.mark.parametrize("cause", ["mesh", "penalty", "far_field"])
def test_bars_of_an_indentation_hold_what_its_settings_err_by(cause: str, known: Callable[..., None]) -> None:
    """A force that errs by a share everywhere, and by no more of the other causes."""

    def off(numerics: Numerics, cut: bool) -> float:
        errors = {"mesh": 0.8 / numerics.elements_per_contact**2, "penalty": 640.0 / numerics.penalty}
        return (errors | {"far_field": (8.0 if cut else 2.0) / numerics.far_radius**2})[cause]

    known(off)
    found = pressed([2.0 * yield_depth(0.3), 5.0 * yield_depth(0.3)], COARSE)
    wrong = np.abs(found.force - 4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS) * found.depth**1.5)
    assert np.all(wrong <= found.force_error)
    assert np.all(found.force_error <= 2.0 * wrong)
    assert found.budget[cause] * found.force == pytest.approx(found.force_error, rel=1e-6)


def test_a_change_that_vanishes_where_a_force_is_asked_for_errs_there_as_it_does_nearby(
    known: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """By an error of the mesh whose sign turns at both of the depths, however few they are."""
    first = 2.0 * yield_depth(0.3)
    plain, fine = 4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS), COARSE | {"steps": 48}

    class Rippled(Known):
        def settled(self, state: Any, depth: float, *rest: Any) -> Station:
            found, body = super().settled(state, depth, *rest), cast(Any, self.ground)
            share = body.stiffness / (4.0 / 3.0 * math.sqrt(body.radius)) - 1.0
            waved = 1.0 + share * math.sin(math.pi * math.log(self.unit * depth / first))
            return found._replace(force=found.force * waved / (1.0 + share))

    known(lambda numerics, cut: 0.8 / numerics.elements_per_contact**2)
    monkeypatch.setattr("fe_contact.plastic.course.Presser", Rippled)
    found = pressed([first, math.e * first], fine)
    between = pressed([first, math.exp(0.5) * first, math.e * first], fine)
    wrong = np.abs(between.force / (plain * between.depth**1.5) - 1.0)
    assert wrong[[0, -1]].max() < 0.2 * wrong[1], "it vanishes there"
    shares = found.force_error / found.force
    assert np.all((wrong[1] < shares) & (shares < 3.0 * wrong[1]))


def test_bars_hold_what_no_run_tells_between_its_knots(
    known: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A force that ripples faster than its smooth curve may: in all runs alike, slowly pressed and struck."""
    wave = 0.8

    class Rippled(Known):
        def settled(self, state: Any, depth: float, *rest: Any) -> Station:
            found = super().settled(state, depth, *rest)
            return found._replace(force=found.force * math.exp(ripple(self.unit * depth)))

    def ripple(depth: float) -> float:
        return 0.01 * math.sin(2.0 * math.pi / wave * math.log(depth / yield_depth(0.3)))

    known()
    monkeypatch.setattr("fe_contact.plastic.course.Presser", Rippled)
    depth, plain = np.geomspace(2.0, 9.0, 12) * yield_depth(0.3), 4.0 / 3.0 * modulus(0.3) * math.sqrt(RADIUS)
    found = pressed(depth.tolist(), COARSE | {"steps": 80})
    wrong = np.abs(np.log(found.force / (plain * depth**1.5)) - [ripple(one) for one in depth])
    bars = found.force_error / found.force
    assert wrong.max() > 5e-4
    assert np.all(wrong < bars)
    assert found.budget["time_step"].max() < 10.0 * wrong.max()

    def peaks(steps: int) -> Array:
        """Values and bars of forces that peak a quarter of a wave apart."""
        scenes = [Scene.from_dict(tables(mass=MASS, velocity=math.exp(0.25 * k) * SLOW)) for k in range(4)]
        runs = [fe_contact.run(one, numerics={"tolerance": 1e-2, "steps": steps}) for one in scenes]
        return np.array([(one.quantities["peak_force"].value, one.quantities["peak_force"].error) for one in runs]).T

    smoothly, errors = peaks(80)
    monkeypatch.setattr("fe_contact.plastic.course.KNOTS", 0.1)
    finely, _ = peaks(160)
    missed = np.abs(smoothly - finely)
    assert (missed / finely).max() > 3e-4
    assert np.all(missed < errors)


def test_what_a_smooth_curve_misses_is_an_error_of_the_impact(
    known: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A share of the stiffness: two fifths of it in the largest force, the greatest depth and the duration."""
    known()
    share = 1e-3
    monkeypatch.setattr("fe_contact.plastic.course.Forces.misfit", lambda self, depth: np.full(depth.shape, share))
    quantities = fe_contact.run(Scene.from_dict(tables(mass=MASS, velocity=SLOW)), tolerance=1e-2).quantities
    for name in ("peak_force", "peak_depth", "duration"):
        value, error = quantities[name].value or 0.0, quantities[name].error or 0.0
        assert 1.2 * 0.4 * share * value < error < 4.0 * share * value, name


def test_a_motion_that_ends_amid_the_contact_is_refused(known: Callable[..., None]) -> None:
    known()
    scene = Scene.from_dict(tables(mass=MASS, velocity=SLOW))
    for share, refused in ((0.99, True), (1.01, False)):
        ended = replace(scene, motion=replace(scene.motion, end_time=share * moves_as({}, scene)["duration"]))
        with pytest.raises(BadInput, match=r"motion\.end_time.*the contact lasts") if refused else nullcontext():
            fe_contact.run(ended, tolerance=1e-3)


def test_an_impact_may_go_deeper_than_expected_and_ends_by_name_where_it_is_by_too_much(
    known: Callable[..., None],
) -> None:
    """A sixth deeper its greatest depth lies amid forces still."""
    known()
    scene = Scene.from_dict(tables(mass=MASS, velocity=SLOW))
    deepest = moves_as({}, scene)["peak_depth"]

    def pressed_up_to(expected: float) -> float:
        course = Course.of(scene, expected, expected)
        runner = Runner(scene, course, silent)
        return runner.motion(runner.pressed(settings(COARSE, course), False)[1]).deepest

    assert pressed_up_to(deepest / 1.15) == pytest.approx(deepest, rel=1e-4)
    with pytest.raises(MemoryTooSmall):
        pressed_up_to(deepest / 1.3)


def releases(power: float, steps: int, unit: float) -> tuple[Array, Array, float]:
    """Depths and forces of a release, and the depth where it ends, of a contact whose end is known."""
    end, radius = 0.7 * unit, 0.2
    stiff = 2.0 * radius * 0.3 * unit / (power * (0.3 * unit) ** power)  # 2 a per depth where it begins, E* = 1

    def at(before: Any, here: Any, depth: float) -> Any:
        return SimpleNamespace(depth=depth, force=stiff * max(depth - end, 0.0) ** power, radius=radius)

    pressed: Any = SimpleNamespace(_released=at, _let_go=lambda *step: [at(*step)])
    found = Presser.released(pressed, at(None, None, unit), steps, power)
    return np.array([one.depth for one in found]), np.array([one.force for one in found]), end


@pytest.mark.parametrize("unit", [1e-3, 1.0])
@pytest.mark.parametrize("power", [1.0, 1.5])
@pytest.mark.parametrize("steps", [6, 12, 40])
def test_a_release_is_followed_until_hardly_anything_is_left_to_spring_back(
    steps: int, power: float, unit: float
) -> None:
    """First by so little that the contact is as stiff as it began, then evenly in the power 2/3 of what is left."""
    depth, force, end = releases(power, steps, unit)
    assert force[1] / force[0] == pytest.approx(1.0 - FIRST_RELEASED, abs=0.3 * FIRST_RELEASED)
    left = (depth - end) / (depth[0] - end)
    assert np.all(np.diff(left) < 0.0)
    assert 0.5 * RELEASED <= left[-1] <= max(RELEASED, 1.01 * (steps + 1.0) ** -1.5)
    assert steps // 2 < left.size <= steps + 2
    even = -np.diff(np.delete(left[:-1], 1) ** (2.0 / 3.0)) * (steps + 1.0)
    assert even == pytest.approx(1.0, rel=0.01), "the first step reaches beyond that little"


def test_stresses_of_a_field_stand_by_their_names() -> None:
    """Hooke's law of strains rr, zz and hoop and of a slide, far below the strength; E* = 1."""
    nu, strains, slide = 0.3, np.array([1e-3, -2e-3, 3e-3]), 4e-3
    gradient = np.array([strains[0], slide, 0.0, strains[1], strains[2]])[:, None]
    shear = 0.5 * (1.0 - nu)
    hooke = 2.0 * shear * (strains + nu / (1.0 - 2.0 * nu) * strains.sum())
    stress = ground.yielding_of(nu, 1.0, 0.0).flowed(gradient, *ground.at_rest((1,))).stress[STRESS]
    assert stress[:, 0] == pytest.approx([*hooke, shear * slide])


def test_fields_of_a_body_strained_alike_everywhere_are_that_strain() -> None:
    """Displacement in proportion to the place but for a shift, Hooke's stress, the pressure given, in SI units."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    deepest = 3.0 * yield_depth(0.3)
    course = Course.of(indenter, deepest, deepest)
    body = course.ground(settings(COARSEST, course))
    wide, deep, shift, radius = 2e-6, -3e-6, -5e-6, 0.6
    place = body.basis.doflocs
    moved = np.stack([wide * place[0], deep * place[1] + shift], axis=1).ravel()
    pressure = 1e-3 * (1.0 + body.points)
    peak = Station(4e-6, moved, body.rest, 0.0, pressure, radius)
    again = PressedAgain(course, body, peak, 0.5 * moved)
    fields, amount = again.fields(0.25)
    assert not amount.any()
    assert (fields.time, fields.depth, fields.contact_radius) == (0.25, 4e-6 * course.unit, radius * course.unit)
    r, z = fields.points.T
    expected = np.stack([wide * r, deep * z + shift * course.unit], axis=1)
    np.testing.assert_allclose(fields.displacement, expected, atol=1e-12 * course.unit)
    assert r.max() == pytest.approx(ground.CORE * course.unit, rel=0.2)
    mean, shear = (2.0 * wide + deep) / 3.0, course.modulus * 0.5 * (1.0 - 0.3)
    bulk = 2.0 * shear * 1.3 / (3.0 * (1.0 - 0.6))
    hooke = 2.0 * shear * (np.array([wide, deep, wide]) - mean) + 3.0 * bulk * mean
    np.testing.assert_allclose(fields.stress, np.broadcast_to([*hooke, 0.0], (r.size, 4)), rtol=1e-6, atol=1e-3)
    top = (z == 0.0) & (r <= radius * course.unit)
    assert np.array_equal(fields.contact == 1, top)
    within = top & (r > body.points[0] * course.unit)
    assert fields.pressure[within] == pytest.approx(1e-3 * course.modulus * (1.0 + r[within] / course.unit))
    assert not fields.pressure[~top].any()
    dent = again.dent
    assert dent.pressed == pytest.approx(shift * course.unit)
    assert dent.left == pytest.approx(0.5 * shift * course.unit)
    assert np.all(np.diff(dent.radius) > 0.0)
    mesh = body.basis.mesh
    elements = mesh.p.T[mesh.t[:, body.elements]]
    assert area(*fields.points[fields.triangles.T]) == pytest.approx(course.unit**2 * area(*elements), rel=0.01)


@pytest.mark.parametrize("steps", [8, 16, 64])
def test_steps_of_a_loading_are_as_long_as_the_settings_ask_once_it_flows(steps: int) -> None:
    """In proportion to the depth, from the first one to the end; some more lie before anything yields."""
    indenter, _ = SceneReader("scene", tables()).indenter(Indenter)
    course = Course.of(indenter, 0.5 * yield_depth(0.3), 50.0 * yield_depth(0.3))
    depths = course.depths(steps, course.deepest)
    assert (depths[0], depths[-1]) == pytest.approx((course.first, course.deepest))
    ratios = depths[1:] / depths[:-1]
    flows = depths[1:] > course.firm * (1.0 + 1e-9)
    assert 4.5 < steps * (ratios[flows].max() - 1.0) < 6.0
    assert ratios[flows] == pytest.approx(ratios[-1])
    assert ratios[~flows].max(initial=1.0) < 2.0


def area(one: Array, two: Array, three: Array) -> float:
    """Of triangles by their corners (n, 2), taken together."""
    (x, y), (v, w) = (two - one).T, (three - one).T
    return 0.5 * float(np.abs(x * w - y * v).sum())
