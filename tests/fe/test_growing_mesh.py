"""A mesh that grows with the contact carries what its points remember: by closed forms, and by a mesh that stays."""

from __future__ import annotations

import math

import numpy as np
import pytest
from skfem import CellBasis, ElementDG, ElementTriP0, ElementTriP1, ElementTriP2, MeshTri

from fe_contact.assembly.forms import Array
from fe_contact.plastic.course import Course, PlasticLoading, settings
from fe_contact.plastic.ground import Ground
from fe_contact.plastic.growing import upwind
from fe_contact.plastic.path import PlasticZoneWide, Presser, Station
from fe_contact.solids.base import State
from lumped import Scene

YOUNG, STRENGTH, RADIUS = 2e11, 4e8, 0.005
ORDERS = [1, 2, 3, 4]


def course(deepest: float = 2e-6, **material: float) -> Course:
    material = {"E": YOUNG, "nu": 0.3, "yield_strength": STRENGTH} | material
    scene = Scene.from_dict(
        {
            "striker": {"shape": "sphere", "radius": RADIUS, "mass": 4e-3, "velocity": 0.1},
            "target": {"shape": "half_space", "material": {"law": "elastic"} | material},
            "model": {"plasticity": True},
        }
    )
    return Course.of(scene, deepest / 50.0, deepest)


def ground(elements: float, order: int = 3) -> Ground:
    known = course()
    return known.ground(settings({"elements_per_contact": elements, "order": order}, known))


def places(body: Ground) -> Array:
    """Of the points that remember, (2, elements, points)."""
    return np.asarray(body.basis.global_coordinates())[:, body.elements]


def hill(place: Array, growth: float) -> Array:
    """Far from where the mesh ends, carried exactly: as it was at places ``growth`` times as far out."""
    r, z = growth * place
    return np.asarray(np.exp(-3.0 * ((r - 1.1) ** 2 + (z + 0.9) ** 2)))


def remembered(place: Array, growth: float = 1.0) -> State:
    """Strains of several shapes, and an amount."""
    high = hill(place, growth)
    r, z = growth * place
    return np.stack([high, r * high, z * high, r * z * high]), high


@pytest.mark.family
@pytest.mark.parametrize("growth", [1.003, 1.1, 1.6])
def test_what_flows_inward_is_what_was_further_out(growth: float) -> None:
    """The error falls as the third power of the elements."""
    errors = []
    for elements in (9.0, 18.0):
        body = ground(elements)
        place = places(body)
        within = np.hypot(*place) < 2.5
        strain, amount = body.carried(remembered(place), growth)
        true_strain, true_amount = remembered(place, growth)
        off = np.abs(strain - true_strain)[:, within].max(), np.abs(amount - true_amount)[within].max()
        errors.append(max(off))
    assert errors[1] < 1e-3
    assert errors[0] > 6.0 * errors[1]


@pytest.mark.parametrize("order", ORDERS)
def test_what_is_alike_everywhere_stays_so_far_from_where_nothing_flows_in(order: int) -> None:
    body = ground(8.0, order)
    place = places(body)
    strain, amount = body.carried((np.ones((4, *place.shape[1:])), np.ones(place.shape[1:])), 1.2)
    within = np.hypot(*place) < 1.5
    assert strain[:, within] == pytest.approx(1.0, abs=1e-4)
    assert amount[within] == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_rate_of_what_flows_is_its_slope_outwards_but_where_nothing_flows_in(order: int) -> None:
    """x . grad a of polynomials, exactly, on a box that the flow enters by two sides and leaves by the other two."""
    mesh = MeshTri.init_tensor(np.linspace(1.0, 2.0, 4), np.linspace(-2.0, -1.0, 4))
    broken = ElementDG([ElementTriP0, ElementTriP1, ElementTriP2][order - 1]())
    basis = CellBasis(mesh, broken)
    (r, z), corners = basis.doflocs, mesh.p[:, mesh.t]
    entered = np.isclose(corners[0], 2.0).sum(axis=0) + np.isclose(corners[1], -2.0).sum(axis=0) > 1
    assert 0 < np.count_nonzero(entered) < mesh.nelements
    a, slope = {
        1: (np.ones_like(r), np.zeros_like(r)),
        2: (1.0 + 2.0 * r - z, 2.0 * r - z),
        3: (r * z + 3.0 * z**2, 2.0 * r * z + 6.0 * z**2),
    }[order]
    rate = upwind(mesh, broken) @ a
    inside = basis.element_dofs[:, ~entered]
    assert rate[inside] == pytest.approx(slope[inside], abs=1e-10)
    assert not np.allclose(rate, slope), "what flows in is nothing"
    lost = basis.interpolate(upwind(mesh, broken) @ basis.project(1.0))
    total = float(np.sum(np.asarray(lost) * basis.dx))
    assert total == pytest.approx(-4.0, abs=1e-10), "one by each of two sides, and twice the area by shrinking"


def test_two_growths_are_their_product_and_none_is_the_same() -> None:
    body = ground(4.0)
    state = body.carried(remembered(places(body)), 1.05)  # of polynomials
    twice = body.carried(body.carried(state, 1.1), 1.2)
    assert twice[0] == pytest.approx(body.carried(state, 1.32)[0], abs=1e-8)
    assert body.carried(state, 1.0) is state


def test_a_thousand_small_growths_make_nothing_of_their_own() -> None:
    """Neither more nor less than nothing, and as much in all as there is of it so much smaller."""
    body = ground(4.0)
    place, weight = places(body), body.body.cored.core.weight
    state = remembered(place)
    largest = float(state[1].max())
    for _ in range(1000):
        state = body.carried(state, 1.002)
        assert state[1].min() >= 0.0
        assert state[1].max() <= 1.05 * largest
    assert np.vdot(weight, state[1]) == pytest.approx(np.vdot(weight, hill(place, 1.002**1000)), rel=0.2)


class Staying(Presser):
    """On a mesh that is one unit long from the first step on."""

    def _stage(
        self, state: State, like: tuple[Station, Station], here: Station, depth: float, spread: float
    ) -> tuple[Station, State]:
        first, last = like
        share = (depth - here.depth) / (last.depth - first.depth) if last is not first else 0.0
        start = here.displacement + share * (last.displacement - first.displacement)
        radius = here.radius * (depth / here.depth) ** spread
        return self.settled(state, depth, start, here.pressure, radius, 1.0), state

    def first(self, depth: float, radius: float) -> Station:
        body = self.ground.body
        displacement, pressure = np.zeros(body.cored.core.size), np.zeros(body.skin.weights.size)
        return self.settled(self.ground.rest, depth, displacement, pressure, radius, 1.0)


def forces(elements: float, presser: type[Presser]) -> Array:
    """At the deeper half of the depths, over Hertz'."""
    known = course()
    numerics = settings({"elements_per_contact": elements, "steps": 24}, known)
    body = known.ground(numerics)
    loading = PlasticLoading(known, numerics, presser(body, numerics.penalty, known.unit), [])
    loading.to(known.deepest)
    depth = known.deepest * np.linspace(0.5, 1.0, 9)
    hertz = 4.0 / 3.0 * YOUNG / (1.0 - 0.3**2) * math.sqrt(RADIUS) * depth**1.5
    return np.asarray(np.exp(loading.pressed.logarithm(depth)) / hertz)


@pytest.mark.tenth
def test_a_mesh_that_stays_tells_the_same_forces() -> None:
    """Nothing is carried there, and the edge of the contact crosses elements; Hertz' force is a quarter higher."""
    grown, stayed = forces(4.0, Presser), forces(12.0, Staying)
    assert grown.max() < 0.82
    assert grown == pytest.approx(stayed, rel=4e-3)


@pytest.mark.tenth
def test_flow_that_reaches_beyond_what_may_yield_is_named() -> None:
    """So soft, and so much harder where it flows, that it flows far around."""
    known = course(2e-6, yield_strength=3e6, hardening_modulus=0.05 * YOUNG)
    loading = PlasticLoading.of(known, settings({"elements_per_contact": 4.0, "steps": 16}, known))
    with pytest.raises(
        PlasticZoneWide, match=r"flow reaches 3\.2 contact radii, further than is meshed; cure: a lower"
    ):
        loading.to(known.deepest)
