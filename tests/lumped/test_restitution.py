"""Damping against restitution: inverse pairs, direct integration of every law, published numbers, limits, faults."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from lumped import restitution
from lumped.errors import BadInput
from lumped.laws import kuwabara_kono as taylor

EXITS = ("force", "depth")
BOTH = [(name, exit) for name in restitution.available() for exit in EXITS]
hunt_crossley, jankowski, kelvin, kuwabara_kono, mahmoud, tsuji = map(
    restitution.get, ("hunt_crossley", "jankowski", "kelvin", "kuwabara_kono", "mahmoud", "tsuji")
)
ONE_EXIT = ("hunt_crossley", "jankowski", "khatiwada", "mahmoud")


@dataclass(frozen=True)
class Impact:
    """A law's force over depth, rate and "still approaching", and a smooth function with the sign of the force."""

    force: Callable[[float, float, bool], float]
    sign: Callable[[float, float], float]


@dataclass(frozen=True)
class Body:
    """Reduced mass kg, stiffness N/m^n, velocity at touch m/s, exponent where the law leaves it free."""

    m: float
    k: float
    v: float
    n: float


def kelvin_impact(b: Body, xi: float) -> Impact:
    c = 2.0 * xi * math.sqrt(b.k * b.m)
    return Impact(lambda d, r, _: b.k * d + c * r, lambda d, r: b.k * d + c * r)


def mahmoud_impact(b: Body, xi: float) -> Impact:
    c = 2.0 * xi * math.sqrt(b.k * b.m)
    return Impact(lambda d, r, inward: b.k * d + c * r * inward, lambda d, r: d)


def jankowski_impact(b: Body, xi: float) -> Impact:
    def force(d: float, r: float, inward: bool) -> float:
        d = max(d, 0.0)
        return b.k * d**1.5 + 2.0 * xi * math.sqrt(b.k * math.sqrt(d) * b.m) * r * inward

    return Impact(force, lambda d, r: d)


def hunt_crossley_impact(b: Body, damping: float) -> Impact:
    return Impact(lambda d, r, _: b.k * max(d, 0.0) ** b.n * (1.0 + damping / b.v * r), lambda d, r: d)


def tsuji_impact(b: Body, alpha: float) -> Impact:
    c = alpha * math.sqrt(b.m * b.k)

    def force(d: float, r: float, _: bool) -> float:
        d = max(d, 0.0)
        return b.k * d**1.5 + c * d**0.25 * r

    return Impact(force, lambda d, r: b.k * math.copysign(abs(d) ** 1.25, d) + c * r)


def kuwabara_kono_impact(b: Body, x: float) -> Impact:
    a = x / (1.5 * (b.k / b.m) ** 0.4 * b.v**0.2)

    def force(d: float, r: float, _: bool) -> float:
        d = max(d, 0.0)
        return b.k * (d**1.5 + 1.5 * a * math.sqrt(d) * r)

    return Impact(force, lambda d, r: d + 1.5 * a * r)


IMPACTS: dict[str, Callable[[Body, float], Impact]] = {
    "hunt_crossley": hunt_crossley_impact,
    "jankowski": jankowski_impact,
    "kelvin": kelvin_impact,
    "khatiwada": hunt_crossley_impact,
    "kuwabara_kono": kuwabara_kono_impact,
    "mahmoud": mahmoud_impact,
    "tsuji": tsuji_impact,
}


def integrated(body: Body, impact: Impact, exit: str) -> float:
    """e by direct integration: to the turn, then to the exit."""

    def leg(inward: bool, state: Any, event: Callable[[float, Any], float]) -> Any:
        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        scale = max(state)
        found = solve_ivp(
            lambda _, y: (y[1], -impact.force(y[0], y[1], inward) / body.m),
            (0.0, math.inf),
            state,
            method="DOP853",
            events=event,
            rtol=1e-12,
            atol=1e-14 * scale,
            first_step=1e-6 * body.v,
        )
        return found.y_events[0][0]

    turn = leg(True, (0.0, body.v), lambda _, y: y[1])
    end = leg(False, turn, lambda _, y: y[0] if exit == "depth" else impact.sign(y[0], y[1]))
    return float(-end[1] / body.v)


def test_every_family_has_a_witness() -> None:
    assert set(IMPACTS) == set(restitution.available())


@pytest.mark.family
@pytest.mark.parametrize(("name", "exit"), BOTH)
def test_direct_integration_gives_the_same_restitution(
    name: str, exit: str, campaign_size: Callable[[int], int]
) -> None:
    random = np.random.default_rng(20146)
    for _ in range(campaign_size(200)):
        m, k, v = 10.0 ** random.uniform(-0.5, 0.5, 3)
        body = Body(float(m), float(k), float(v), float(random.uniform(1.0, 3.0)))
        damping = float(10.0 ** random.uniform(-3.0, -0.05 if exit == "depth" else 0.7))
        e = integrated(body, IMPACTS[name](body, damping), exit)
        assert restitution.get(name).restitution(damping, exit) == pytest.approx(e, abs=1e-8)


@pytest.mark.family
@pytest.mark.parametrize(("name", "exit"), BOTH)
@given(e=st.floats(0.001, 0.999999))
def test_restitution_asked_for_is_obtained(name: str, exit: str, e: float) -> None:
    family = restitution.get(name)
    assert family.restitution(family.damping(e, exit), exit) == pytest.approx(e, rel=1e-13)


@pytest.mark.parametrize(("name", "exit"), BOTH)
@pytest.mark.parametrize("e", [1e-6, 1e-4, 0.5, 1.0 - 1e-9, 1.0])
def test_ends_of_the_range(name: str, exit: str, e: float) -> None:
    family = restitution.get(name)
    assert family.restitution(family.damping(e, exit), exit) == pytest.approx(e, rel=1e-13)


@pytest.mark.parametrize(("name", "exit"), BOTH)
def test_restitution_falls_as_damping_grows(name: str, exit: str) -> None:
    family = restitution.get(name)
    assert family.restitution(0.0, exit) == 1.0
    values = [family.restitution(damping, exit) for damping in np.linspace(0.0, 0.99, 100)]
    assert all(np.diff(values) < 0.0)


@pytest.mark.parametrize("name", ONE_EXIT)
def test_exits_that_coincide(name: str) -> None:
    family = restitution.get(name)
    assert family.restitution(0.3, "force") == family.restitution(0.3, "depth")
    assert family.damping(0.3, "force") == family.damping(0.3, "depth")


@pytest.mark.parametrize("critical", [1.0 - 1e-12, 1.0, 1.0 + 1e-12])
def test_kelvin_is_smooth_at_critical_damping(critical: float) -> None:
    # x = t exp(-t): the force vanishes at t = 2
    assert kelvin.restitution(critical) == pytest.approx(math.exp(-2.0), rel=1e-11)
    assert mahmoud.restitution(critical) == pytest.approx(math.exp(-1.0), rel=1e-11)


@given(st.floats(1e-6, 1.0 - 1e-9))
def test_hunt_crossley_solves_its_equation_to_twelve_digits(e: float) -> None:
    with localcontext(prec=60):
        d, asked = Decimal(hunt_crossley.damping(e)), Decimal(e)

        def left(d: Decimal) -> Decimal:
            return 1 - asked * d - (1 + d) * (-d * (1 + asked)).exp()

        assert left(d * (1 - Decimal("1e-12"))) > 0 > left(d * (1 + Decimal("1e-12")))


LINEAR = {
    "kelvin": 1.0 / math.pi,
    "mahmoud": 2.0 / math.pi,
    "jankowski": math.sqrt(5.0) / math.pi,
    "hunt_crossley": 1.5,
    "khatiwada": 1.5,
    "tsuji": math.sqrt(5.0) / math.pi,
    "kuwabara_kono": 1.0 / 1.15344,
}


@pytest.mark.parametrize(("name", "exit"), BOTH)
def test_small_losses_are_linear_in_the_damping(name: str, exit: str) -> None:
    assert restitution.get(name).damping(1.0 - 1e-7, exit) / 1e-7 == pytest.approx(LINEAR[name], rel=1e-5)


@pytest.mark.parametrize("e", [1e-4, 1e-5, 1e-6])
def test_large_losses_follow_their_power(e: float) -> None:
    assert kelvin.damping(e) == pytest.approx(0.5 / math.sqrt(e), rel=20.0 * e)
    assert mahmoud.damping(e) == pytest.approx(0.5 / e, rel=1e-6)
    assert jankowski.damping(e) == pytest.approx(math.sqrt(5.0) / (4.0 * e), rel=1e-6)
    assert hunt_crossley.damping(e) == pytest.approx(1.0 / e, rel=1e-12)


def test_kuwabara_kono_turns_and_then_flows_back() -> None:
    # overdamped it stops at depth^(3/2) = 1.5/x, then leaves with the rate -depth/x of no inertia
    assert kuwabara_kono.restitution(1e4) == pytest.approx(1.5 ** (2.0 / 3.0) * 1e4 ** (-5.0 / 3.0), rel=1e-3)


def test_kuwabara_kono_inverts_in_few_impacts(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def counted(x: float, exit: str) -> float:
        calls.append(x)
        return single(x, exit)

    single = taylor.log_restitution
    monkeypatch.setattr(taylor, "log_restitution", counted)
    for e in np.linspace(1e-3, 0.999, 50):
        calls.clear()
        kuwabara_kono.damping(float(e))
        assert len(calls) <= 7


# literature, section 3.7: e asked for -> exact d, then e obtained by the published formulas
PUBLISHED = (
    "hunt_crossley",
    "lankarani_nikravesh",
    "herbert_mcwhannell",
    "zhiying_qishao",
    "ye",
    "gonthier",
    "hu_guo",
)
OBTAINED = [
    (0.2, 4.91917, 0.547, 0.672, 0.501, 0.266, 0.156, 0.205, 0.166),
    (0.4, 2.08250, 0.620, 0.702, 0.550, 0.399, 0.363, 0.398, 0.380),
    (0.5, 1.43275, 0.663, 0.725, 0.594, 0.483, 0.470, 0.488, 0.488),
    (0.6, 0.97487, 0.712, 0.756, 0.651, 0.577, 0.577, 0.577, 0.594),
    (0.7, 0.63483, 0.768, 0.796, 0.723, 0.680, 0.683, 0.670, 0.697),
    (0.8, 0.37315, 0.833, 0.847, 0.807, 0.787, 0.789, 0.768, 0.799),
    (0.9, 0.16648, 0.909, 0.913, 0.901, 0.896, 0.894, 0.876, 0.900),
]


@pytest.mark.parametrize(("e", "exact", "obtained"), [(row[0], row[1], row[2:]) for row in OBTAINED])
def test_hunt_crossley_dampings_of_the_literature(e: float, exact: float, obtained: tuple[float, ...]) -> None:
    assert hunt_crossley.damping(e) == pytest.approx(exact, abs=5.1e-6)
    for name, value in zip(PUBLISHED, obtained, strict=True):
        damping = restitution.damping(hunt_crossley, e, formula=name)
        assert hunt_crossley.restitution(damping) == pytest.approx(value, abs=5.1e-4), name


def test_one_formula_under_two_names() -> None:
    published = hunt_crossley.published
    assert published["flores"](0.3) == published["ye"](0.3)
    assert published["muthukumar"](0.3) == published["lankarani_nikravesh"](0.3)


# audit, table 3a: e -> xi (7), e clipped; xi (10), e of it; xi 2006, e of it; exact Jankowski; exact Kelvin clipped
AUDIT = [
    (0.1, 0.59116, 0.2527, 3.5232, 0.1475, 5.7825, 0.0933, 5.3743, 1.2432),
    (0.2, 0.45595, 0.3249, 1.7082, 0.2711, 2.6172, 0.1915, 2.4865, 0.7313),
    (0.3, 0.35786, 0.3971, 1.0795, 0.3765, 1.5508, 0.2918, 1.4937, 0.4972),
    (0.4, 0.28000, 0.4720, 0.7474, 0.4706, 1.0106, 0.3930, 0.9828, 0.3545),
    (0.5, 0.21545, 0.5503, 0.5338, 0.5582, 0.6818, 0.4946, 0.6679, 0.2553),
    (0.65, 0.13585, 0.6748, 0.3162, 0.6848, 0.3728, 0.6470, 0.3682, 0.1499),
    (0.8, 0.07085, 0.8081, 0.1602, 0.8134, 0.1754, 0.7989, 0.1742, 0.0744),
    (0.95, 0.01632, 0.9505, 0.0365, 0.9510, 0.0373, 0.9499, 0.0373, 0.0165),
]


@pytest.mark.parametrize("row", AUDIT)
def test_audit_of_kelvin_and_jankowski(row: tuple[float, ...]) -> None:
    e = row[0]
    seven = kelvin.published["anagnostopoulos"](e)
    ten, later = (jankowski.published[name](e) for name in ("equation_10", "jankowski_2006"))
    # some of the audit's numbers are rounded twice, to five digits and then to four
    digits = pytest.approx(row[1:], abs=5.6e-5)
    assert (
        seven,
        kelvin.restitution(seven),
        ten,
        jankowski.restitution(ten),
        later,
        jankowski.restitution(later),
        jankowski.damping(e),
        kelvin.damping(e),
    ) == digits
    assert kelvin.restitution(seven, "depth") == pytest.approx(e, rel=1e-14)


# literature, section 3.7: xi -> e at exit depth, e at exit force
@pytest.mark.parametrize(
    ("xi", "depth", "force"),
    [(0.05, 0.85447, 0.85876), (0.2, 0.52662, 0.57174), (0.5, 0.16303, 0.29844), (0.7, 0.04599, 0.21028)],
)
def test_kelvin_of_the_literature(xi: float, depth: float, force: float) -> None:
    assert kelvin.restitution(xi, "depth") == pytest.approx(depth, abs=5.1e-6)
    assert kelvin.restitution(xi, "force") == pytest.approx(force, abs=5.1e-6)


@pytest.mark.parametrize(
    ("e", "force"), [(0.2, 0.325), (0.4, 0.472), (0.5, 0.550), (0.6, 0.632), (0.8, 0.808), (0.9, 0.902)]
)
def test_tsuji_of_the_literature(e: float, force: float) -> None:
    alpha = tsuji.published["antypov_elliott"](e)
    assert tsuji.restitution(alpha, "depth") == pytest.approx(e, rel=1e-14)
    assert tsuji.restitution(alpha, "force") == pytest.approx(force, abs=5.1e-4)


def test_tsuji_polynomial_needs_its_root_of_two() -> None:
    alpha = tsuji.published["tsuji_polynomial"](0.5)
    assert tsuji.restitution(alpha, "depth") == pytest.approx(0.4999, abs=5.1e-5)
    assert tsuji.restitution(alpha / math.sqrt(2.0), "depth") == pytest.approx(0.616, abs=5.1e-4)


def test_mahmoud_formula_is_right_for_small_losses_and_near_for_large() -> None:
    def error(e: float) -> float:
        return mahmoud.restitution(mahmoud.published["mahmoud_jankowski"](e)) - e

    assert error(1.0 - 1e-6) == pytest.approx(0.0, abs=1e-12)
    assert max(abs(error(float(e))) for e in np.linspace(0.2, 1.0, 81)) < 0.0075


# literature, section 3.6
@pytest.mark.parametrize(
    ("x", "e"),
    [(0.05, 0.94440), (0.1, 0.89286), (0.2, 0.80097), (0.4, 0.65411), (0.8, 0.45974), (1.6, 0.26462)],
)
def test_kuwabara_kono_of_the_literature(x: float, e: float) -> None:
    assert kuwabara_kono.restitution(x) == pytest.approx(e, abs=5.1e-6)


def test_kuwabara_kono_series_is_of_second_order() -> None:
    assert pytest.approx(1.15344, abs=1e-5) == taylor.C1
    series = kuwabara_kono.published["series"]
    for e in (0.6, 0.8, 0.99):
        x = series(e)
        assert 1.0 - 1.15344 * x + 0.79826 * x**2 == pytest.approx(e, abs=1e-5)
    # the first term which it leaves out is of the order 5/2 in the loss, and wants the force to end the contact
    for exit, order in (("force", 2.5), ("depth", 3.0)):
        errors = [abs(kuwabara_kono.restitution(series(e), exit) - e) for e in (0.999, 0.9999)]
        assert math.log10(errors[0] / errors[1]) == pytest.approx(order, abs=0.05)


@pytest.mark.parametrize("name", restitution.available())
@pytest.mark.parametrize("e", [0.0, -0.5, 1.0 + 1e-12, 1e-7, math.nan, math.inf, True, "0.5", None])
def test_restitution_out_of_range_is_named(name: str, e: Any) -> None:
    family = restitution.get(name)
    for formula in (family.damping, *family.published.values()):
        with pytest.raises(BadInput, match="accepted: a number from 1e-06 to 1; for a plastic impact") as caught:
            formula(e)
        assert caught.value.faults[0].key == "e"


@pytest.mark.parametrize(("name", "exit"), BOTH)
@pytest.mark.parametrize("value", [-1e-300, math.nan, math.inf, 1e13, "1", None])
def test_damping_out_of_range_is_named(name: str, exit: str, value: Any) -> None:
    with pytest.raises(BadInput, match="accepted: a number from 0 to") as caught:
        restitution.get(name).restitution(value, exit)
    assert caught.value.faults[0].key == "damping"


@pytest.mark.parametrize("name", restitution.available())
def test_unknown_exit_is_refused(name: str) -> None:
    family = restitution.get(name)
    for call in (family.damping, family.restitution):
        with pytest.raises(BadInput, match="accepted: one of force, depth"):
            call(0.5, "time")


@pytest.mark.parametrize(("name", "critical"), [("kelvin", 1.0), ("tsuji", math.sqrt(5.0))])
def test_critical_damping_has_no_return_of_depth(name: str, critical: float) -> None:
    family = restitution.get(name)
    with pytest.raises(BadInput, match='ask for exit = "force"'):
        family.restitution(critical, "depth")
    assert family.restitution(critical, "force") == pytest.approx(math.exp(-2.0), rel=1e-12)


def test_series_has_no_damping_below_its_minimum() -> None:
    with pytest.raises(BadInput, match=r"0\.583333 to 1"):
        kuwabara_kono.published["series"](0.58)
    assert kuwabara_kono.published["series"](7.0 / 12.0) > 0.0


def test_unknown_names_are_met_with_the_nearest() -> None:
    with pytest.raises(BadInput, match="did you mean kuwabara_kono"):
        restitution.get("kuwabara")
    with pytest.raises(BadInput, match="did you mean gonthier"):
        restitution.damping(hunt_crossley, 0.5, formula="gontier")
    assert restitution.damping(kelvin, 0.5, "depth") == kelvin.damping(0.5, "depth")
