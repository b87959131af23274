"""Slow indentation by finite elements against exact load curves: force, contact radius, bars that cover, cost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fe_contact import indentation
from fe_contact.bodies.pressing import PressedDepths, in_reach
from fe_contact.errors import BodyTooThin, ContactTooWide, IndentationNotSettled
from fe_contact.indentation import CAUSES, FEWEST, Indenting, _accompanied, expected, indent, press, settings
from fe_contact.settings import Numerics, tolerance_of
from lumped import BadInput, Material, Relaxation
from lumped.indentation import Indentation
from lumped.indentation import indent as by_load_curve
from lumped.scene.indenter import Indenter
from lumped.shapes import SHAPES, Shape, Sphere
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer
from lumped.targets.ring import Ring
from lumped.targets.sphere import SphereTarget
from lumped.targets.washer import Washer

RATIOS = (0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.4999)
DEPTHS = (1, 2, 3, 5, 10)
THICKNESS = 1e-3
EXACT_ROWS: dict[str, tuple[Any, ...]] = {
    "sphere": (1.0,),
    "cone": (20.0,),
    "punch": (0.1,),
    **{f"power-{n:g}": (10.0, n) for n in (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)},
}


@dataclass(frozen=True)
class Case:
    """A shape on a target, nu, and depths in the order asked, m."""

    shape: Shape
    target: Target
    nu: float
    depths: tuple[float, ...]

    @property
    def indenter(self) -> Indenter:
        return Indenter(self.shape, Material(Relaxation(1e6), self.nu), self.target)

    def found(self, **given: Any) -> Indentation:
        return indent(self.indenter, self.depths, {"tolerance": 1e-3, **given})

    def errors(self, found: Indentation) -> tuple[np.ndarray, np.ndarray]:
        """Relative errors of force and contact radius, (n,)."""
        curve = self.target.load_curve(self.shape, self.nu)
        force = found.modulus * self.shape.total * np.asarray(curve.force(found.depth))
        return found.force / force - 1.0, found.contact_radius / np.asarray(curve.contact_radius(found.depth)) - 1.0


def shaped(name: str, *values: float) -> Shape:
    return SHAPES.get(name).kind(*values)


def to_width(shape: Shape, target: Target, nu: float, length: float, rng: np.random.Generator, most: float) -> Case:
    """Depths with contacts from a hundredth of a length to ``most`` of it, mesh and edge anywhere."""
    curve = target.load_curve(shape, nu)
    widest = float(10 ** rng.uniform(-2.0, np.log10(most)))
    ends = widest * np.array([10 ** rng.uniform(-1.5, 0.0), 1.0])
    deepest = [float(curve.depth(end * length)) for end in ends]
    depths = np.geomspace(*deepest, int(rng.choice(DEPTHS)))
    return Case(shape, target, nu, tuple(map(float, rng.permutation(depths))))


def on_layer(rng: np.random.Generator) -> Case:
    """Parabola-like sphere, cone, power or cylinder on a layer, up to ten thicknesses wide, three near nu = 0.5."""
    exponent = float(rng.uniform(1.0, 2.3))
    shape = (
        shaped("sphere", 1.0),
        shaped("cone", 0.1),
        shaped("power", 1e-3 * THICKNESS ** (1.0 - exponent), exponent),
        shaped("cylinder", 1.0, 0.1),
    )[int(rng.integers(4))]
    nu = float(rng.choice(RATIOS))
    target = Layer(THICKNESS, str(rng.choice(["bonded", "sliding"])))
    return to_width(shape, target, nu, THICKNESS, rng, 3.0 if nu > 0.49 else 10.0)


def on_half_plane(rng: np.random.Generator) -> Case:
    """A cylinder on the half-plane, up to 0.8 of the datum's depth wide."""
    return to_width(shaped("cylinder", 0.01, 0.1), HalfSpace(0.005), float(rng.choice(RATIOS)), 0.005, rng, 0.8)


def in_ring(rng: np.random.Generator) -> Case:
    """A rod in a ring thin or thick, its clearance wide or closing."""
    inner, thickness = 0.01, float(10 ** rng.uniform(-3.0, -2.0))
    deepest = thickness * 10 ** rng.uniform(-3.0, -0.7)
    depths = np.geomspace(deepest * 10 ** rng.uniform(-2.0, 0.0), deepest, int(rng.choice(DEPTHS)))
    shape = shaped("cylinder", float(rng.uniform(0.3, 0.98)) * inner, 0.1)
    return Case(shape, Ring(inner, thickness), float(rng.choice(RATIOS)), tuple(map(float, depths)))


def cases(number: int) -> list[Case]:
    rng = np.random.default_rng(4)
    kinds = (on_layer, on_layer, on_half_plane, in_ring)
    return [kinds[i % len(kinds)](rng) for i in range(number)]


@pytest.mark.tenth
def test_bodies_with_lengths_against_their_exact_curves(campaign_size: Callable[[int], int]) -> None:
    for case in cases(campaign_size(200)):
        found = case.found()
        force, radius = case.errors(found)
        assert found.converged, case
        assert found.depth.tolist() == list(case.depths), "rows in the order asked"
        assert np.all(np.abs(force) * found.force <= found.force_error), case
        assert np.abs(force).max() <= 5e-4, case
        assert np.abs(radius).max() <= 2e-3, case


@pytest.mark.family
@pytest.mark.parametrize("name", EXACT_ROWS)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
def test_exact_rows_on_the_half_space(name: str, nu: float) -> None:
    shape = shaped(name.split("-")[0], *EXACT_ROWS[name])
    scale = float(shape.load_curve.depth(0.1)) or 1e-3
    case = Case(shape, HalfSpace(), nu, (0.5 * scale, scale, 0.2 * scale))
    found = case.found()
    force, radius = case.errors(found)
    assert np.all(np.abs(force) * found.force <= found.force_error)
    assert np.abs(force).max() <= 1e-4
    assert np.abs(radius).max() <= 2e-3
    exact = np.log(np.asarray(shape.load_curve.force(found.depth)))
    alpha, level = np.polyfit(np.log(found.depth), exact, 1)
    held = np.exp(np.mean(exact - shape.exponent_of_force * np.log(found.depth)))
    for key, wanted, most in (("alpha", alpha, 5e-4), ("D", np.exp(level), 1e-3), ("D_at_alpha", held, 1e-3)):
        quantity = found.quantities[key]
        assert quantity.value is not None
        assert quantity.error is not None
        assert abs(quantity.value - wanted) <= quantity.error
        assert abs(quantity.value / wanted - 1.0) <= most


@pytest.mark.family
@pytest.mark.parametrize("base", ["bonded", "sliding"])
@pytest.mark.parametrize(("ratio", "nu"), [(0.01, 0.3), (1.0, 0.0), (1.0, 0.49), (3.0, 0.4999), (10.0, 0.3)])
def test_flat_end_on_a_layer(base: str, ratio: float, nu: float) -> None:
    case = Case(shaped("punch", ratio * THICKNESS), Layer(THICKNESS, base), nu, (1e-5,))
    found = case.found()
    force, radius = case.errors(found)
    assert np.all(np.abs(force) * found.force <= found.force_error)
    assert np.abs(force).max() <= 1e-4
    assert np.all(radius == 0.0)


LAYERED = Case(Sphere(0.01), Layer(2e-3, "bonded"), 0.3, (1e-5, 5e-5, 2e-4))
SPREAD = Case(Sphere(0.01), HalfSpace(), 0.3, (1e-5, 5e-5, 2e-4))
COARSER = {"mesh": "elements_per_contact", "penalty": "penalty", "far_field": "far_radius"}


@pytest.mark.parametrize("nu", [0.0, 0.3])
@pytest.mark.parametrize("shape", [Punch(1.0), Sphere(1.0)])
@pytest.mark.parametrize("target", [HalfSpace(), Layer(1.0, "sliding")], ids=["half-space", "layer"])
def test_no_gap_beyond_a_rim_presses_where_none_may_overlap(shape: Shape, target: Target, nu: float) -> None:
    """Exact enforcement takes means over facets: those past the rim or the equator had forces a hundred times too large
    and their bars with them.
    """
    indenter = Indenter(shape, Material(Relaxation(1.0), nu), target)
    exact = indent(indenter, (0.01, 0.1), {"tolerance": 0.1, "enforcement": "exact", "elements_per_contact": 2.0})
    by_penalty = indent(indenter, (0.01, 0.1), {"tolerance": 1e-3})
    assert np.all(np.abs(exact.force - by_penalty.force) <= exact.force_error + by_penalty.force_error)
    assert np.all(exact.force_error <= 0.1 * exact.force)


def test_a_gap_everywhere_stays_one() -> None:
    """Of a contact that lies between the points of a mesh: nothing may press there."""
    assert in_reach(np.array([-1.0, -2.0, -100.0])).tolist() == [-1.0, -2.0, -30.0]


def test_updates_that_do_not_settle_ask_for_the_stiffer_penalty_that_does() -> None:
    indenter = Indenter(Punch(1.0), Material(Relaxation(1.0), 0.3))
    given = {"tolerance": 0.1, "enforcement": "augmented"}
    with pytest.raises(IndentationNotSettled, match=r"a higher numerics\.penalty"):
        indent(indenter, (0.1,), {**given, "penalty": 100.0})
    assert np.all(indent(indenter, (0.1,), {**given, "penalty": 3e4}).force > 0.0)


@pytest.mark.family
@pytest.mark.parametrize("case", [LAYERED, SPREAD], ids=["layer", "half-space"])
@pytest.mark.parametrize("cause", COARSER)
def test_a_setting_fourfold_coarser_shows_in_its_entry_and_is_covered(case: Case, cause: str) -> None:
    usual = {"elements_per_contact": 4.0, "penalty": 1000.0, "far_radius": 20.0}
    fine, coarse = case.found(**usual), case.found(**{**usual, COARSER[cause]: usual[COARSER[cause]] / 4.0})
    assert coarse.budget[cause].max() > 1.2 * fine.budget[cause].max()
    force, _ = case.errors(coarse)
    assert np.all(np.abs(force) * coarse.force <= coarse.force_error)


def test_the_exact_curves_enter_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    before = LAYERED.found()

    def refused(*_: Any) -> Any:
        raise AssertionError("an exact curve was asked")

    monkeypatch.setattr(Layer, "load_curve", refused)
    monkeypatch.setattr(Sphere, "load_curve", property(refused))
    after = LAYERED.found()
    assert np.array_equal(after.force, before.force)
    assert np.array_equal(after.force_error, before.force_error)


def test_a_lone_depth_is_judged_like_one_of_many() -> None:
    lone = Case(LAYERED.shape, LAYERED.target, LAYERED.nu, (5e-5,)).found()
    many = LAYERED.found()
    assert lone.force_error[0] == pytest.approx(many.force_error[1], rel=1.0)
    assert lone.force[0] == pytest.approx(many.force[1], rel=5e-4)
    assert lone.quantities == {}


def test_where_depths_are_cheap_a_lone_one_is_pressed_beside_a_dozen_and_many_alone() -> None:
    """Two contact problems each; the others are in the work, not in the answer."""
    for depths, pressed in (((1e-4,), 1 + FEWEST), (tuple(np.linspace(1e-4, 2e-4, FEWEST).tolist()), FEWEST)):
        found = Case(Sphere(1.0), HalfSpace(), 0.3, depths).found(tolerance=0.05)
        assert found.work["contact_problems"] == 2 * pressed
        assert found.depth.tolist() == list(depths)
        assert found.force.size == found.contact_radius.size == found.force_error.size == len(depths)


def test_twenty_depths_cost_two_contact_problems_each_and_few_iterations() -> None:
    depths = tuple(map(float, np.geomspace(1e-5, 4e-4, 20)))
    for target in (Layer(2e-3, "bonded"), HalfSpace()):
        work = Case(Sphere(0.01), target, 0.3, depths).found().work
        assert work["contact_problems"] <= 50
        assert work["iterations"] <= 120
        assert work["degrees_of_freedom"] <= 6000


def test_a_contact_beyond_the_fine_mesh_is_named() -> None:
    numerics = settings({"tolerance": 1e-3}, LAYERED.shape)
    with pytest.raises(ContactTooWide, match=r"2e-04|0\.0002"):
        press(LAYERED.indenter, np.array([2e-4]), np.array([5e-4]), numerics)


@pytest.mark.parametrize(
    ("case", "reason"),
    [
        (Case(Sphere(0.01), Layer(2e-3, "bonded"), 0.3, (2e-3,)), "below the layer's thickness"),
        (Case(Sphere(0.01), HalfSpace(), 0.3, (1e-5, 0.01)), "below the striker's radius"),
        (Case(shaped("cylinder", 6e-3, 0.1), Ring(0.01, 3e-3), 0.3, (3e-3,)), "below the ring's thickness"),
        (Case(shaped("cylinder", 1e-4, 0.1), Ring(0.01, 3e-3), 0.3, (1e-5, 2e-3)), "below the striker's radius"),
    ],
)
def test_impossible_depths_are_refused(case: Case, reason: str) -> None:
    with pytest.raises(BadInput, match=reason):
        case.found()


@pytest.mark.parametrize(
    "case",
    [
        Case(shaped("cone", 0.02), Layer(1e-3, "bonded"), 0.3, (1e-4,)),
        Case(shaped("punch", 1.0), Layer(1e-3, "sliding"), 0.3, (1e-4,)),
        Case(shaped("cylinder", 9.9e-3, 0.1), Ring(0.01, 1e-5), 0.3, (1e-6,)),
        Case(shaped("punch", 0.03), Washer(0.01, 0.02, 1e-5, "bonded"), 0.4999, (1e-6,)),
    ],
)
def test_contacts_hundreds_of_thicknesses_wide_are_refused_by_name_and_at_once(case: Case) -> None:
    with pytest.raises(BodyTooThin, match=r"1e-0\d m thick|0\.001 m thick"):
        case.found()


@pytest.mark.parametrize("angle", [0.0, 90.0])
def test_a_cone_flat_or_upright_is_refused(angle: float) -> None:
    with pytest.raises(BadInput, match="angle"):
        shaped("cone", angle)


def test_a_rod_larger_than_its_ring_is_refused() -> None:
    with pytest.raises(BadInput, match="inner radius"):
        assert Case(shaped("cylinder", 0.01, 0.1), Ring(0.01, 3e-3), 0.3, (1e-5,)).indenter


def indenting(depth: list[float], finite: bool) -> Indenting:
    elastic: Any = SimpleNamespace(model=SimpleNamespace(finite=finite))
    return Indenting(elastic, np.array(depth), np.array(depth), frozenset(), lambda *word, **_: None)


def test_a_setting_is_told_by_depths_from_the_smallest_to_the_largest() -> None:
    """By all of them where strains are small; places in the row as it was asked for."""
    depth = np.random.default_rng(3).uniform(1.0, 2.0, 12)
    few = indenting(depth.tolist(), True)._telling(4)
    assert few.size == 4
    assert np.all(np.diff(few) > 0)
    assert {int(depth.argmin()), int(depth.argmax())} < set(few.tolist())
    rank = np.sort(np.argsort(np.argsort(depth))[few])
    assert np.diff(rank) == pytest.approx(11.0 / 3.0, abs=1.0), "evenly between"
    for all_of in (indenting(depth.tolist(), False)._telling(4), indenting(depth.tolist(), True)._telling(12)):
        assert np.array_equal(all_of, np.arange(12))


@pytest.mark.parametrize("tolerance", np.geomspace(1e-6, 0.1, 11).tolist())
def test_a_tolerance_asks_for_as_many_elements_as_the_order_of_the_mesh_needs(tolerance: float) -> None:
    """Of order four: twice as many for a sixteenth. Large strains take fewer where it is loose, for none is cheap."""

    def elements(tolerance: float, large: bool) -> float:
        return settings({"tolerance": tolerance}, Sphere(1.0), large).elements_per_contact

    small, large = (elements(tolerance, one) for one in (False, True))
    assert 2.0 <= large <= small <= 32.0
    if tolerance < 1e-4:
        assert small == pytest.approx(elements(1e-4, False) * (1e-4 / tolerance) ** 0.25)
    else:
        assert small == elements(1e-4, False)
    if tolerance > 1e-3:
        assert large == pytest.approx(max(2.0, small * (1e-3 / tolerance) ** 0.5))
    else:
        assert large == small


@pytest.mark.parametrize(("shape", "stiffer"), [(Sphere(1.0), 1.0), (Punch(1.0), 16.0)])
def test_a_pressure_that_is_infinite_at_a_rim_wants_a_stiffer_penalty(shape: Shape, stiffer: float) -> None:
    assert settings({}, shape).penalty == stiffer * settings({}, Sphere(1.0)).penalty
    assert settings({"penalty": 7.0}, shape).penalty == 7.0


def test_contacts_of_depths_a_hundred_thousand_apart_are_foreseen_together() -> None:
    """The least as under a cone on a half-space, 2/pi of where the surfaces overlap, the widest as on the layer."""
    depths = np.array([1e-6, 0.1])
    on_layer, deep = (Indenter(shaped("cone", 30.0), Material(Relaxation(1.0), 0.3), target)
                      for target in (Layer(1.0, "bonded"), HalfSpace()))  # fmt: skip
    numerics = settings({}, on_layer.shape, False)
    least, widest = expected(on_layer, depths, numerics)
    assert least == pytest.approx(expected(deep, depths, numerics)[0], rel=0.1)
    assert widest == pytest.approx(
        float(on_layer.target.load_curve(on_layer.profile, 0.3).contact_radius(0.1)), rel=0.1
    )


@pytest.mark.parametrize("target", [Layer(1.0, "bonded"), SphereTarget(1e3, "held")], ids=["layer", "ball"])
def test_a_penalty_softens_contacts_of_every_width_alike(target: Target) -> None:
    """By springs of p E*/a under Hertz's pressure, 3/(2 pi p) of the force to first order: what a flat end of radius a
    would feel of them. On a body so large that it is a half-space, on one mesh for both depths.
    """
    case = Case(Sphere(1.0), target, 0.3, (1e-4, 4e-4))
    radii, penalties = np.array([0.01, 0.02]), (100.0, 400.0)
    soft, stiff = (
        press(
            case.indenter,
            np.array(case.depths),
            radii,
            settings({"penalty": one, "enforcement": "penalty"}, case.shape),
        )
        for one in penalties
    )
    expected = 1.5 / np.pi * (1.0 / penalties[0] - 1.0 / penalties[1])
    assert 1.0 - soft.force / stiff.force == pytest.approx([expected] * 2, rel=0.05)


@pytest.mark.parametrize("asked", [[2e-3], [2e-3, 1.9e-3], [1e-3, 2e-3]])
def test_few_depths_are_accompanied_by_others_down_to_where_an_edge_lies_elsewhere(asked: list[float]) -> None:
    """A contact radius, root of the depth, by a sixth to a half; those asked for come first; enough are alone."""
    found = _accompanied(np.array(asked), FEWEST)
    assert found[: len(asked)].tolist() == asked
    assert found.size == len(asked) + FEWEST
    assert found.max() == pytest.approx(2e-3)
    assert found[len(asked) :].min() == pytest.approx(found.min()), "as far down as those"
    assert found[len(asked) :].max() == pytest.approx(found.max()), "and up"
    assert 0.5 < np.sqrt(found.min() / 2e-3) < 5.0 / 6.0
    assert found.min() >= min(*asked, 0.5 * 2e-3), "no farther down than those asked for where they lie so far apart"
    many = np.linspace(1.0, 2.0, FEWEST)
    assert _accompanied(many, FEWEST) is many


@pytest.mark.parametrize(("bar", "said"), [(1e-3, ""), (4e-3, "tolerance 0.001 not reached: force to 0.004")])
def test_what_a_force_misses_is_said_by_its_worst_depth_and_nothing_where_it_misses_none(bar: float, said: str) -> None:
    depth, force = np.array([1e-4, 2e-4]), np.array([3.0, 8.0])
    found = Indentation(SPREAD.indenter, "fe", 1e6, 1e-3, depth, force, np.sqrt(depth), force * np.array([1e-4, bar]))
    assert found.converged == (not said)
    assert found.message == said


@pytest.mark.parametrize("finite", [False, True])
@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("coarse", [False, True])
def test_an_entry_of_a_force_is_what_its_setting_changes_at_the_worst_depth_by_the_order_of_its_cause(
    monkeypatch: pytest.MonkeyPatch, finite: bool, ends: bool, coarse: bool
) -> None:
    """Mesh of order 3/2, penalty of one, far field of two; a setting that is doubled errs by as much more than it.

    The far field is varied on the other mesh, unless the body ends; what large strains have told of the penalty already
    is not pressed again.
    """
    depth = np.array([4.0, 1.0, 2.0, 3.0])
    given = {"elements_per_contact": 1.0, "penalty": 100.0, "far_radius": 4.0} if coarse else {"far_radius": 40.0}
    numerics, pressed = settings(given, Sphere(1.0)), list[Numerics]()

    def answer(depth: np.ndarray, one: Numerics) -> PressedDepths:
        wrong = one.elements_per_contact**-1.5 + 7.0 / one.penalty + 0.1 / one.far_radius**2
        force = depth**1.5 * (1.0 + 1e-3 * wrong * depth / 4.0)
        return PressedDepths(force, depth**0.5, {}, 1.5, ends, newton=1e-9)

    def press(elastic: Any, depth: np.ndarray, radii: np.ndarray, one: Numerics, **_: Any) -> PressedDepths:
        assert np.array_equal(depth, radii)
        pressed.append(one)
        return answer(depth, one)

    monkeypatch.setattr(indentation, "press", press)
    way, times = indenting(depth.tolist(), finite), 2.0 if coarse else 0.5
    soft = numerics.varied(penalty=times * numerics.penalty)
    base = answer(depth, numerics)
    if finite:
        base = replace(base, softer=answer(depth, soft))
    found = way._budget(base, numerics, lambda done: None)
    parts = {"mesh": 1.0, "penalty": 7.0 / numerics.penalty, "far_field": 0.1 / numerics.far_radius**2}
    if not coarse:
        parts["mesh"] = numerics.elements_per_contact**-1.5
    for cause, part in parts.items():
        expected = 1.25e-3 * part * (0.0 if cause == "far_field" and ends else 1.0)
        assert found[cause] == pytest.approx(expected, rel=0.02), cause
    assert found["newton"] == 1e-9
    other = numerics.varied(elements_per_contact=times * numerics.elements_per_contact)
    asked = [] if finite else [soft]
    far = [] if ends else [other.varied(far_radius=times * other.far_radius)]
    assert pressed == [*asked, other, *far]


def test_forces_are_pressed_finer_until_all_bars_together_meet_the_tolerance() -> None:
    """Each alone would."""
    way, numerics = indenting([1.0, 2.0], False), settings({"tolerance": 1e-2}, Sphere(1.0))
    for share, met in ((0.45, True), (0.55, False)):
        budget = {name: np.array([0.0, share * 1e-2 * (name in ("mesh", "penalty"))]) for name in CAUSES}
        found: Any = SimpleNamespace(budget=budget, numerics=numerics, base=SimpleNamespace(mesh_order=np.inf))
        finer = way.finer(found).settings
        assert (finer is None) is met
        if finer is not None:
            assert finer.elements_per_contact > numerics.elements_per_contact
            assert finer.penalty > numerics.penalty
            assert finer.far_radius == numerics.far_radius


def test_every_method_is_asked_for_the_same_where_nothing_is_asked() -> None:
    """A tolerance of 1e-3, by finite elements as by a load curve, which meets it."""
    indenter = Indenter(Sphere(0.01), Material(Relaxation(1e6), 0.3))
    exact = by_load_curve(indenter, (1e-5,), "mdr")
    assert exact.tolerance == tolerance_of({}) == 1e-3
    assert exact.converged
