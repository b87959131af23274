"""The orders that bars trust: what three runs show of them, what a relaxation takes, and by what a setting is told."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from fe_contact.budget import certify
from fe_contact.budget.certify import LEAST_HALVED_SETTING, other_setting
from fe_contact.budget.variation import SAFETY, Softening, Variation
from fe_contact.settings import Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.steps import Strike
from fe_contact.steppers.struck import Deformable
from lumped.materials import Relaxation


@pytest.fixture
def settings(hertz_strike: Callable[..., Strike], settings_of: Callable[..., Numerics]) -> Numerics:
    return settings_of(hertz_strike())


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("ratio", "gained"),  # of the changes, over two to the power of the scheme's order; orders over its own
    [
        (0.81, 1),
        (1.0, 1),
        (1.34, 1),
        (0.79, 0),
        (1.36, 0),
        (0.61, 0),
        (2.4, 0),
        (0.59, None),
        (2.6, None),
        (-1.0, None),
    ],
)
def test_an_order_is_gained_where_the_velocity_shows_the_schemes_own_and_lost_where_it_does_not(
    monkeypatch: pytest.MonkeyPatch, order: int, sign: float, ratio: float, gained: int | None
) -> None:
    """A scheme of order two has to show 1.7 to 2.4; about that, 1.3 to 3.3, and none is gained; else one is trusted.

    Of opposite signs changes show nothing.
    """
    changes = {("fine", "half"): sign, ("half", "quarter"): sign * ratio * 2.0**order}
    monkeypatch.setattr(
        certify, "Variation", lambda one, other, trusted: SimpleNamespace(signed_velocity=changes[one, other])
    )
    made_up: Any = ("fine", "half", "quarter")
    assert certify._trusted_order(*made_up, order) == (1 if gained is None else order + gained)


def three(name: str, fine: float, half: float, quarter: float) -> Any:
    return [SimpleNamespace(quantities={name: value}) for value in (fine, half, quarter)]


@pytest.mark.parametrize("size", [1.0, 1e-3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_duration_shows_its_order_nearly_or_is_trusted_with_one_and_one_more_where_all_steps_are_short(
    size: float, sign: float
) -> None:
    """By the step of a scheme of order two: changes in a ratio of four, or a fifth less. Short ones err by 1 %."""
    for change, ratio, expected in (
        (1e-3, 4.0, 3),
        (1e-3, 3.25, 3),
        (1e-3, 3.15, 2),
        (1e-3, 40.0, 2),
        (2.45e-3, 4.0, 3),
        (2.55e-3, 4.0, 2),
        (5e-3, 3.1, 1),
        (0.0, 0.0, 3),
    ):
        runs = [size * (1.0 + sign * change * times) for times in (0.0, 1.0, 1.0 + ratio)]
        assert certify._order_of_duration(*three("duration", *runs), 2) == expected, (change, ratio)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_restitution_is_asked_for_its_order_only_where_the_longest_steps_err_by_more_than_a_hundredth(
    sign: float,
) -> None:
    for restitution in (0.9, 0.05):
        for change, ratio, expected in (
            (1e-4, 1.0, 3),
            (9e-3, 1.1, 3),
            (9e-3, 1.15, 1),
            (2.55e-3, 4.0, 2),
            (4e-3, 3.25, 2),
            (4e-3, 3.1, 1),
        ):
            runs = [restitution + sign * change * times for times in (0.0, 1.0, 1.0 + ratio)]
            assert certify._order_of_restitution(*three("restitution", *runs), 2) == expected, (change, ratio)


def test_what_dashpots_and_fast_branches_carry_are_shares_of_all_that_a_contact_presses_with() -> None:
    """Advanced steadily: a dashpot by its viscosity, a fast branch by modulus x time, a spring by modulus x contact."""
    relaxation = Relaxation(4.0, (200.0, 3.0), (1e-3, 5.0), 0.5)
    whole = 200.0 * 1e-3 + 0.5 + (4.0 + 3.0) * 0.1
    curve: Any = SimpleNamespace(strike=SimpleNamespace(relaxation=relaxation), duration=0.1)
    assert certify._shares(curve, np.array([True, False])) == pytest.approx((0.2 / whole, 0.5 / whole))
    slow = 0.5 + 207.0 * 0.1
    assert certify._shares(curve, np.array([False, False])) == pytest.approx((0.0, 0.5 / slow))
    curve.strike.relaxation = Relaxation(4.0, (200.0,), (1e-3,))
    assert certify._shares(curve, np.array([False])) == (0.0, 0.0)
    assert certify._shares(curve, np.array([True])) == pytest.approx((0.2 / 0.6, 0.0))


@pytest.mark.parametrize("time", [1.0, 1e-3])
def test_runs_end_alike_where_all_part_or_none_does_and_none_half_as_late_again_as_another(time: float) -> None:
    def alike(*ends: tuple[float, bool]) -> bool:
        runs: Any = [SimpleNamespace(duration=time * end, separated=parted) for end, parted in ends]
        return certify._end_alike(*runs)

    assert alike((1.0, True), (1.2, True), (1.49, True))
    assert alike((1.49, True), (1.0, True))
    assert not alike((1.0, True), (1.51, True))
    assert not alike((1.51, True), (1.0, True), (1.2, True))
    assert alike((1.0, False), (1.0, False))
    assert not alike((1.0, False), (1.0, True))


@pytest.mark.parametrize("key", LEAST_HALVED_SETTING)
def test_a_setting_is_halved_or_where_that_tells_nothing_raised_until_it_may_be(key: str, settings: Numerics) -> None:
    """At least twice as large: a variation by less would trust a small change with a large factor."""
    least = LEAST_HALVED_SETTING[key]
    for value in (0.3 * least, 0.7 * least, least, 3.0 * least):
        changed, finer = other_setting(settings.varied(**{key: value}), key)
        assert finer == (value < least)
        assert getattr(changed, key) == pytest.approx({0.3: 1.0, 0.7: 1.4, 1.0: 0.5, 3.0: 1.5}[value / least] * least)
        assert changed == settings.varied(**{key: getattr(changed, key)}), "nothing else"
        by_own, raised = other_setting(settings.varied(**{key: value}), key, 10.0 * least)
        assert raised
        assert getattr(by_own, key) == pytest.approx(10.0 * least)


@pytest.mark.parametrize("alone", [True, False])
@pytest.mark.parametrize("follows", [True, False])
@pytest.mark.parametrize("elastic", [True, False])
@pytest.mark.parametrize("far", [8.0, 4.0])
def test_the_far_field_of_an_elastic_contact_takes_no_march_and_any_other_one_on_the_varied_mesh(
    monkeypatch: pytest.MonkeyPatch, settings: Numerics, alone: bool, follows: bool, elastic: bool, far: float
) -> None:
    """One press of either surface tells of a mesh that follows one contact; the order is two. No march on a body that
    ends. A far radius below five is doubled, and the nearer one errs four times as much.
    """
    cheap = settings.varied(far_radius=far)
    mesh, other = cheap.varied(elements_per_contact=2.0), far / 2.0 if far == 8.0 else 8.0
    surfaces: dict[Numerics, Any] = {}

    def surface(one: Numerics) -> Any:
        return surfaces.setdefault(one, Mock(spec=Deformable, follows_contact=follows))

    asked = list[Numerics]()

    def curve(one: Numerics) -> Any:
        asked.append(one)
        return one.far_radius

    monkeypatch.setattr(certify, "compliance_change", lambda *pair: 0.03 if pair == tuple(surfaces.values()) else None)
    relaxation = Relaxation(1.0) if elastic else Relaxation(1.0, (1.0,), (0.3,))
    value, runs = SimpleNamespace(strike=SimpleNamespace(relaxation=relaxation)), SimpleNamespace(surface=surface)
    given: Any = (runs, curve, value, cheap, mesh, alone)
    (found,) = certify._far_field(*given)
    if alone and follows and elastic and far == 8.0:
        assert not asked
        assert isinstance(found, Softening)
        assert found.curve is given[2]
        assert found.share == pytest.approx(SAFETY / 3.0 * 0.03)
        assert set(surfaces) == {cheap, cheap.varied(far_radius=other)}
        return
    assert asked == [mesh, mesh.varied(far_radius=other)]
    assert isinstance(found, Variation)
    assert (found.first, found.second) == (far, other)
    assert found.factor == pytest.approx(SAFETY / 3.0 * (1.0 if far == 8.0 else 4.0))
    surfaces[mesh.varied(far_radius=other)] = surfaces[mesh]
    assert certify._far_field(*given) == ()


@pytest.mark.parametrize("coarse", [False, True])
def test_under_a_flat_end_one_stiffness_tells_of_mesh_penalty_and_far_field_by_their_orders(
    coarse: bool, settings: Numerics
) -> None:
    """Of 3/2, one and two: a quarter more than each errs by. One that is doubled errs by more than that changes."""
    given = {"elements_per_contact": 1.0, "penalty": 100.0, "far_radius": 4.0} if coarse else {}
    numerics = settings.varied(**given)

    def errors(one: Numerics) -> dict[str, float]:
        mesh = (numerics.elements_per_contact / one.elements_per_contact) ** 1.5
        far = (numerics.far_radius / one.far_radius) ** 2
        return {"mesh": 1e-6 * mesh, "penalty": -2e-6 * numerics.penalty / one.penalty, "far_field": 3e-6 * far}

    def surface(one: Numerics) -> FlatEnd:
        return FlatEnd(7.0 * (1.0 + sum(errors(one).values())), 1.0, 10, 1.5)

    value: Any = object()
    runs: Any = SimpleNamespace(surface=surface)
    found = certify._by_stiffness(runs, value, surface(numerics), numerics)
    assert set(found) == {"mesh", "penalty", "far_field"}
    for cause, error in errors(numerics).items():
        (one,) = found[cause]
        assert isinstance(one, Softening)
        assert one.curve is value
        assert one.share == pytest.approx(1.25 * abs(error), rel=1e-2), cause
    alike: Any = SimpleNamespace(surface=lambda one: surface(numerics))
    for (one,) in certify._by_stiffness(alike, value, surface(numerics), numerics).values():
        assert isinstance(one, Softening)
        assert 0.0 < one.share < 1e-8, "by what rounding leaves, where nothing changes it"
