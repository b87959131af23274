"""Punches with large strains on what relaxes: exact limits of their edges, finer runs, small and elastic impacts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from finer_runs import answered

from fe_contact import reference, relaxing_punch, run
from fe_contact.budget.budget import CAUSES, Budget, TotalWork
from fe_contact.budget.curve import Curve
from fe_contact.budget.variation import Variation
from fe_contact.progress import silent
from fe_contact.relaxing_impact import RelaxingStrikes
from fe_contact.relaxing_punch import PUNCHED, PunchStrikes, edged, limit, plan
from fe_contact.settings import EdgedNumerics, Numerics
from fe_contact.solids.newton import EquilibriumLost
from fe_contact.solids.sharp_rim import EDGES, FEWEST, ONWARDS, ORDERS, STEP, edges_of
from fe_contact.steppers.steps import March, Strike, Work
from lumped import BadInput, Result, Scene
from lumped.laws import ting
from lumped.materials import Material, Relaxation
from lumped.scene.tables import Model
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer

SCENES, TOLERANCE = 20, 2e-2
FINER = {"elements_per_contact": 3.0, "penalty": 2000.0}  # of the quarter: loose tolerances share the coarsest mesh
LEAST = 0.95  # share of scenes that converge
COARSE = {"elements_per_contact": 2.0, "order": 3, "steps": 32, "far_radius": 10.0}
LARGE = Model(kinematics="finite")
# Of those that do not soften under compression: a rim strains without bound.
ENERGIES = ("neo_hooke", "neo_hooke_split", "mooney_rivlin", "yeoh", "ogden", "hencky")
EXACT = 1e-4  # of closed impacts


def struck(
    depth: float, young: Relaxation, target: Target | None = None, energy: str = "neo_hooke", nu: float = 0.4
) -> Scene:
    """A punch of radius 1 m and mass 1 kg, as fast as a sudden body needs to be pressed to a depth, m.

    Times of the material's branches are given over the contact time.
    """
    body = target or HalfSpace()
    stiffness = Material(young, nu).contact_modulus().glassy * float(body.load_curve(Punch(1.0), nu).force(1.0))
    lasts = math.pi / math.sqrt(stiffness)
    relaxing = replace(young, times=tuple(lasts * time for time in young.times))
    material = Material(relaxing, nu, hyperelastic=energy)
    return Scene(Punch(1.0), 1.0, depth * math.sqrt(stiffness), material, target=body, model=LARGE)


def sls(share: float = 0.5, time: float = 0.5) -> Relaxation:
    """Of 1 MPa at once, of which a share relaxes, by default in half of the contact time."""
    return Relaxation((1.0 - share) * 1e6, (share * 1e6,), (time,))


def drawn(random: np.random.Generator, energy: str) -> Scene:
    """One branch or two, to a depth of 0.2 radii, or of a tenth of a layer."""
    branches, share = int(random.integers(1, 3)), float(random.uniform(0.1, 0.7))
    shares = share * random.dirichlet(np.ones(branches))
    times = np.sort(10.0 ** random.uniform(-1.0, 1.0, branches))
    young = Relaxation((1.0 - share) * 1e6, tuple((1e6 * shares).tolist()), tuple(times.tolist()))
    nu, depth, target = float(random.uniform(0.0, 0.49)), float(random.uniform(0.02, 0.2)), HalfSpace()
    if random.uniform() < 0.4:
        layer = Layer(10.0 ** float(random.uniform(-0.7, 0.7)), str(random.choice(["bonded", "sliding"])))
        return struck(0.5 * depth * min(layer.thickness, 1.0), young, layer, energy, nu)
    return struck(depth, young, target, energy, nu)


def by_closed_forms(scene: Scene) -> Curve:
    """Of small strains, to ``EXACT``."""
    found = ting.MEMBER.of(scene).simulate(scene, 0.1 * EXACT)
    rows = found.history
    march = March(
        time=rows.time,
        depth=rows.depth,
        impulse=scene.mass * (scene.velocity - rows.velocity),
        radius_time=rows.time[1:-1],
        radius=rows.contact_radius[1:-1],
        separated=found.separated,
        photograph=tuple,
        energy=dict.fromkeys(("in", "out", "stored", "viscous", "contact", "numerical", "residual"), 0.0),
        first_force=0.0,
        end_spread=0.0,
        work=Work(),
    )
    return Curve.of(march, Strike.of(scene))


def known(curve: Curve, shares: float = 0.0) -> Budget:
    """A curve every cause of which changes all forces by these ``shares``."""
    off = replace(curve, mean_force=(1.0 + shares) * curve.mean_force)
    changes = {cause: (Variation(curve, off, 1.0),) for cause in CAUSES}
    nothing: Any = None
    return Budget(curve, nothing, changes, TotalWork(1, 1, 1, 1, 1, 1, 1), nothing)


@pytest.fixture
def numerics() -> EdgedNumerics:
    return EdgedNumerics(1e-2, 2.0, 4, 1e3, "corrected", "galerkin", 40, 20.0, 1.0, 1.0, 0.5, EDGES[2])


@pytest.mark.parametrize("target", [HalfSpace(), Layer(0.7, "bonded")])
@pytest.mark.parametrize("narrowest", [2, 4])
def test_exact_impacts_by_edges_have_the_sharp_rims_for_a_limit(
    target: Target, narrowest: int, numerics: EdgedNumerics
) -> None:
    """At small strain, of what relaxes in half of the contact: within what edges leave, which is not much more."""
    scene = replace(struck(0.06, sls(), target), model=Model())
    edges = [known(by_closed_forms(one)) for one in edged(scene)[narrowest + 1 - FEWEST : narrowest + 1]]
    found, sharp = limit(edges, numerics, 1.0), ting.MEMBER.of(scene).simulate(scene, 0.1 * EXACT)
    for name, quantity in found.quantities.items():
        exact, error = sharp.quantities[name].value, quantity.error or 0.0
        if name == "history_l2" or quantity.value is None or exact is None:
            continue
        apart = abs(quantity.value - exact)
        assert apart < error + EXACT * exact, name
        assert error < 10.0 * apart + 20.0 * EXACT * exact, name
    rows = found.history()
    assert np.all(np.abs(rows.force - sharp.history.force_at(rows.time)) < rows.force_error + EXACT * rows.force.max())
    np.testing.assert_array_equal(rows.contact_radius, 1.0)


def test_exact_impacts_by_edges_show_the_power_of_small_strains() -> None:
    scene = replace(struck(0.06, sls()), model=Model())
    peaks = [by_closed_forms(one).quantities["peak_force"] or 0.0 for one in edged(scene)[3:]]
    assert math.log((peaks[0] - peaks[1]) / (peaks[1] - peaks[2])) / math.log(STEP) == pytest.approx(2.0 / 3.0, abs=0.1)


def test_errors_of_edges_add_up_on_the_way_onwards(numerics: EdgedNumerics) -> None:
    """Those of the narrowest edge count with what the way begins from, those of the widest with the way alone."""
    curves = [by_closed_forms(one) for one in edged(replace(struck(0.06, sls()), model=Model()))[:FEWEST]]
    wide, middle, narrow = (known(curve, shares) for curve, shares in zip(curves, (1e-3, 0.0, 3e-3), strict=True))
    found = limit([wide, middle, narrow], numerics, 1.0)
    for name in ("peak_force", "peak_depth", "impulse", "restitution", "history_l2"):
        for cause in ("mesh", "penalty", "far_field"):
            told = (1.0 + ONWARDS) * narrow.error(name, cause) + ONWARDS * wide.error(name, cause)
            assert found.error(name, cause) == pytest.approx(told), (name, cause)
    assert found.causes == (*CAUSES, "edge")
    assert found.total("peak_force") == pytest.approx(sum(found.error("peak_force", cause) for cause in found.causes))
    assert found.counted["marches"] == 3
    assert min(found.energy_error(name) for name in ("stored", "viscous")) >= found.energy_error("out") > 0.0


def test_edges_of_which_some_impacts_are_over_and_others_not_tell_nothing(numerics: EdgedNumerics) -> None:
    curves = [by_closed_forms(one) for one in edged(replace(struck(0.06, sls()), model=Model()))[:FEWEST]]
    wide, middle, narrow = (known(curve) for curve in curves)
    lasting = replace(narrow, curve=replace(narrow.curve, separated=False))
    assert limit([wide, middle, lasting], numerics, 1.0).total("peak_force") == math.inf


def test_edges_that_close_in_on_nothing_are_named(numerics: EdgedNumerics) -> None:
    """A body that folds under the narrowest edge presses back as hard as under the one before."""
    wide, middle, _ = (known(by_closed_forms(one)) for one in edged(replace(struck(0.06, sls()), model=Model()))[:3])
    with pytest.raises(EquilibriumLost, match="no limit; cure: smaller depths"):
        limit([wide, middle, middle], numerics, 1.0)


@pytest.mark.parametrize("kept", [FEWEST, FEWEST + 1])
def test_edges_under_which_the_body_folds_are_left_out(kept: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What wider ones tell is told; where the widest are not met either, that is named."""
    scene, asked = struck(0.05, sls()), list[float]()

    def certified(self: RelaxingStrikes, numerics: Numerics) -> Budget:
        edge = self.scene.geometry.shape.edge_radius  # type: ignore[attr-defined]  # it is a RoundedPunch
        asked.append(edge)
        if edge < edges[kept - 1]:
            raise EquilibriumLost("folded")
        return replace(known(by_closed_forms(replace(self.scene, model=Model()))), numerics=numerics)

    monkeypatch.setattr(RelaxingStrikes, "certified", certified)
    edges = edges_of(scene.geometry)
    assert plan(scene, {"tolerance": 1e-4}).numerics.edge_radius < edges[kept]  # type: ignore[attr-defined]
    found = run(scene, tolerance=1e-4)
    assert found.numerics["edge_radius"] == edges[kept - 1]
    assert not found.converged
    assert "the largest cause is the edge" in found.message
    kept = 2
    with pytest.raises(EquilibriumLost, match="folded"):
        run(scene, tolerance=1e-4)


def test_what_stands_in_the_way_is_refined_and_edges_are_narrowed(numerics: EdgedNumerics) -> None:
    """Each where it takes more than its part of the tolerance; none where the bars meet it, or nothing is left."""
    scene = struck(0.05, sls())
    edges, way = edges_of(scene.geometry), PunchStrikes(scene, plan(scene, {"tolerance": 1e-2}), silent)

    def finer(edge: float, mesh: float, narrowest: int = 2) -> Numerics | None:
        found: Any = SimpleNamespace(
            numerics=numerics.varied(edge_radius=edges[narrowest]),
            quantities=quantities(edge + mesh),
            causes=(*CAUSES, "edge"),
            error=lambda name, cause: {"edge": edge, "mesh": mesh}.get(cause, 0.0),
        )
        return way.finer(found).settings

    def quantities(error: float) -> dict[str, Any]:
        """Of size one."""
        names = ("peak_force", "peak_time", "peak_depth", "duration", "impulse", "restitution", "history_l2")
        return {name: SimpleNamespace(value=1.0, error=error) for name in names}

    assert finer(0.004, 0.005) is None
    narrower = finer(0.02, 0.003)
    assert isinstance(narrower, EdgedNumerics)
    assert narrower.edge_radius == edges[3]
    assert narrower.contact_radius == pytest.approx(way.radii[3] / way.radii[2])
    assert narrower.elements_per_contact == numerics.elements_per_contact
    meshed = finer(0.003, 0.02)
    assert isinstance(meshed, EdgedNumerics)
    assert meshed.edge_radius == edges[2]
    assert meshed.elements_per_contact > numerics.elements_per_contact
    assert finer(0.02, 0.003, narrowest=len(edges) - 1) is None


def test_a_tight_tolerance_asks_for_narrow_edges_and_a_thin_layer_for_its_own() -> None:
    scene = struck(0.05, sls())
    chosen = [plan(scene, {"tolerance": tolerance}).numerics for tolerance in (3e-2, 1e-3)]
    assert chosen[0].edge_radius == EDGES[2]  # type: ignore[attr-defined]
    assert chosen[1].edge_radius < EDGES[2]  # type: ignore[attr-defined]
    thin = plan(struck(0.005, sls(), Layer(0.1, "bonded")), {"tolerance": 3e-2}).numerics
    assert thin.edge_radius <= 0.1 * EDGES[2]  # type: ignore[attr-defined]
    assert max(ORDERS) == 2.0 / 3.0


def is_within(found: Result, other: Result, more: float = 0.0) -> None:
    """The sum of both bars, and a share of what the other says."""
    for name, quantity in found.quantities.items():
        told = other.quantities[name]
        if name != "history_l2" and quantity.value is not None and told.value is not None:
            allowed = (quantity.error or 0.0) + (told.error or 0.0) + more * abs(told.value)
            assert abs(quantity.value - told.value) < allowed, name


@pytest.mark.tenth
@pytest.mark.parametrize("target", [HalfSpace(), Layer(0.7, "bonded"), Layer(0.7, "sliding")])
def test_a_slight_impact_is_that_of_small_strains(target: Target) -> None:
    """What large strains change goes as the depth over the radius, and is no more than it."""
    scene = struck(2e-3, sls(), target)
    found = run(scene, tolerance=3e-2, numerics=COARSE)
    is_within(found, run(replace(scene, model=Model()), tolerance=1e-3), 2e-3)
    assert found.converged
    assert list(found.error_budget) == [*CAUSES, "edge"]
    assert found.energy["residual"] == pytest.approx(0.0, abs=3e-2 * found.energy["in"])


@pytest.mark.tenth
@pytest.mark.parametrize("young", [sls(1e-4), sls(0.5, 1e4)], ids=["hardly", "slowly"])
def test_what_relaxes_hardly_or_slowly_is_elastic(young: Relaxation) -> None:
    """Marched in time, or by the load curve of slow pressing."""
    scene = struck(0.1, young)
    elastic = replace(scene, material=replace(scene.geometry.material, young=Relaxation(1e6)))
    is_within(run(scene, tolerance=TOLERANCE), run(elastic, tolerance=TOLERANCE), 1e-4)


@pytest.mark.tenth
def test_finer_runs_lie_within_both_bars(
    campaign_size: Callable[..., int], uncovered: Callable[..., dict[str, float]]
) -> None:
    """All with --full, else the first: each takes a minute."""
    random, wrong, converged = np.random.default_rng(37), list[str](), list[bool]()
    for number in range(SCENES if campaign_size(SCENES) == SCENES else 1):
        scene = drawn(random, ENERGIES[number % len(ENERGIES)])
        loose = answered(partial(run, scene, tolerance=TOLERANCE), converged)
        tight = loose and answered(partial(run, scene, tolerance=0.25 * TOLERANCE, numerics=FINER), [])
        over = {} if loose is None or tight is None else uncovered(loose, tight)
        if over:
            wrong.append(f"{scene.material} {scene.target} {scene.velocity:g}: {over}")
    assert not wrong
    assert np.mean(converged) >= LEAST


def test_it_is_answered_by_edges_and_the_ledger_knows_it() -> None:
    scene = struck(0.05, sls())
    assert reference.model_of(scene) is PUNCHED
    tolerance, seconds = reference.expected(scene, {"tolerance": 1e-2})
    assert (tolerance, seconds) == (1e-2, FEWEST * relaxing_punch.SECONDS)
    small = replace(scene, model=Model())
    (entry,) = (one for one in reference.plan(small, {}).ledger if one.effect == "finite strain")
    assert (entry.key, entry.value) == ("model.kinematics", "finite")


@pytest.mark.parametrize(
    ("key", "changes"),
    [
        ("target.material.law", {"young": Relaxation(1e6, (), (), 1e3)}),
        ("target.material.constant", {"constant": "bulk"}),
    ],
)
def test_what_does_not_relax_so_is_refused_by_its_key(key: str, changes: dict[str, Any]) -> None:
    scene = struck(0.05, sls())
    with pytest.raises(BadInput, match=key):
        run(replace(scene, material=replace(scene.geometry.material, **changes)), tolerance=3e-2)
    with pytest.raises(BadInput, match=r"radius: 2e-09: too small for large strains; accepted from 3.2e-08 m on"):
        run(replace(scene, shape=Punch(2e-9)), tolerance=3e-2)
