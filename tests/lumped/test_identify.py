"""Identification: intervals that cover, the wrong law called wrong, coloured noise, what no curve tells.

The truth is made by the row of springs, which shares no integrator with Ting's law, on the half-space.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, least_squares, minimize_scalar
from scipy.signal import butter, lfilter
from scipy.special import stdtrit

from lumped import BadInput, Scene, identify, laws, simulate
from lumped.identify import keys as free_keys
from lumped.identify.certainty import Linearized, draws_of
from lumped.identify.histories import Impact
from lumped.identify.keys import SceneFile
from lumped.numbers import Array
from lumped.result.history import History
from lumped.result.noise import colour_of, likely_colours, memory, whitened, whiteness
from lumped.result.score import Curve

SEED = 20261125
ROWS = 300
SPEEDS = (1.0, 3.0, 0.3)  # of the histories of one case, over the first
WEIGHT = {"mass": 0.05, "velocity": 0.05}
STRIKERS = ({"shape": "sphere", "radius": 0.006, **WEIGHT}, {"shape": "cone", "angle": 20.0, **WEIGHT})
POWER: dict[str, Any] = {"shape": "power", "coefficient": 80.0, "exponent": 2.0, **WEIGHT}
SLS, PRONY = ("E0", "R1", "R2"), ("E_inf", "E")


@dataclass(frozen=True)
class Truth:
    """A scene, its free keys, and the curves with noise, by name, with what each has of its own."""

    table: dict[str, Any]
    free: tuple[str, ...]
    curves: dict[str, Curve]
    own: dict[str, dict[str, object]]

    def value(self, name: str) -> float:
        """What is true of a key of the material."""
        key, _, place = name.rpartition(".")[2].partition("[")
        value = self.table["target"]["material"][key]
        return float(value[int(place[:-1])] if place else value)


def scene(striker: dict[str, Any], material: dict[str, Any]) -> dict[str, Any]:
    return {"striker": dict(striker), "target": {"shape": "half_space", "material": {"nu": 0.4, **material}}}


def history_by_springs(table: dict[str, Any], own: dict[str, object]) -> tuple[Array, Array]:
    """Rows of an impact by the row of springs, between them cubic."""
    made = copy.deepcopy(table)
    for key, value in own.items():
        part, name = key.split(".")
        made[part][name] = value
    built = Scene.from_dict(made)
    history = simulate(laws.get("mdr").of(built), built, 1e-4).history
    return history.time, history.force


def curve_of(rng: np.random.Generator, time: Array, force: Array, noise: Array) -> Curve:
    """A record of equal steps from somewhere before touch to after the end, its clock anywhere."""
    last = float(time[-1])
    rows = np.linspace(-0.5 * last, 1.5 * last, noise.size) + last / noise.size * rng.random()
    found = np.interp(rows, time, force, 0.0, 0.0) + noise * force.max()
    return Curve(rows + rng.normal() * last, found)


def truths(rng: np.random.Generator, material: str = "", most: float = 0.05) -> Iterator[Truth]:
    """Random 3-parameter solids and solids of two branches, one to three histories, noise of 0.5 % to `most`."""
    while True:
        striker = STRIKERS[int(rng.integers(2))]
        lasting, ratio = 10.0 ** rng.uniform(5.0, 8.0), rng.uniform(0.2, 3.0)
        elastic = scene(striker, {"law": "elastic", "E": lasting * (1.0 + 0.5 * ratio)})
        contact = Scene.from_dict(elastic).elastic_contact_time
        if (material or rng.choice(("sls", "prony"))) == "sls":
            time = contact * 10.0 ** rng.uniform(-1.0, 0.5)
            names = SLS
            own = {"law": "sls", "E0": lasting, "R1": ratio, "R2": time * (1.0 + ratio)}
        else:
            times = (contact * 10.0 ** rng.uniform(-1.3, -0.5), contact * 10.0 ** rng.uniform(-0.3, 0.6))
            names = PRONY
            moduli = [0.6 * lasting * ratio, 0.4 * lasting * ratio]
            own = {"law": "prony", "E_inf": lasting, "E": moduli, "tau": list(times)}
        table, noise = scene(striker, own), 10.0 ** rng.uniform(np.log10(0.005), np.log10(most))
        speeds = {f"curve {i}": speed * 0.05 for i, speed in enumerate(SPEEDS[: int(rng.integers(1, 4))])}
        keys: dict[str, dict[str, object]] = {name: {"striker.velocity": speed} for name, speed in speeds.items()}
        curves = {
            name: curve_of(rng, *history_by_springs(table, one), noise * rng.normal(size=ROWS))
            for name, one in keys.items()
        }
        yield Truth(table, tuple(f"target.material.{name}" for name in names), curves, keys)


def guessed(rng: np.random.Generator, table: dict[str, Any], free: tuple[str, ...]) -> dict[str, Any]:
    """The scene with other values of what is sought, off by about e."""
    found = copy.deepcopy(table)
    material = found["target"]["material"]
    for key in (name.rpartition(".")[2] for name in free):
        value = material[key]
        scaled = np.atleast_1d(value) * np.exp(rng.normal(size=np.size(value)))
        material[key] = scaled.tolist() if isinstance(value, list) else float(scaled[0])
    return found


@pytest.mark.full
def test_intervals_cover_as_often_as_they_say() -> None:
    """Of 200 cases 85 to 95 % of the 90 % intervals hold the truth, off by less than a tenth of one in the middle.

    How far the truth is from the value, over the interval's half on its side, tells more than how often it is within:
    over the normal quantile, the mean of its squares is one, its mean none, but for chance.
    """
    rng, cases = np.random.default_rng(SEED), 200
    every, inside, off, away, adequate = truths(rng), list[bool](), list[float](), list[float](), 0
    for _ in range(cases):
        truth = next(every)
        found = identify(truth.curves, guessed(rng, truth.table, truth.free), truth.free, truth.own)
        adequate += found.adequate
        for name, one in found.parameters.items():
            true, low, high = truth.value(name), one.low or 0.0, one.high or np.inf
            inside.append(low <= true <= high)
            if one.low and one.high:
                off.append(np.log(one.value / true) / np.log(one.high / one.low))
                end = low if true < one.value else high
                away.append(1.645 * np.log(one.value / true) / abs(np.log(one.value / end)))
    assert 0.85 <= np.mean(inside) <= 0.95
    assert abs(np.median(off)) < 0.1
    chance = 3.0 / np.sqrt(cases)
    assert np.mean(np.square(away)) == pytest.approx(1.0, abs=np.sqrt(2.0) * chance)
    assert abs(np.mean(away)) < chance
    assert adequate >= 0.97 * cases - 3.0 * np.sqrt(0.03 * cases)


WRONG = {
    "elastic": ({"law": "elastic", "E": 1e6}, ("E",)),
    "kelvin_voigt": ({"law": "kelvin_voigt", "E": 1e6, "eta": 1e3}, ("E", "eta")),
}


@pytest.mark.family
@pytest.mark.parametrize("law", WRONG)
def test_a_wrong_law_is_called_wrong(law: str, request: pytest.FixtureRequest) -> None:
    """Wherever the law's own error exceeds the noise twice."""
    cases, most = (40, 0.05) if request.config.getoption("--full") else (2, 0.006)  # little noise is soon exceeded
    rng, called = np.random.default_rng(SEED), list[bool]()
    every = truths(rng, "sls", most)
    own, names = WRONG[law]
    while len(called) < cases:
        truth = next(every)
        table = scene(truth.table["striker"], own)
        found = identify(truth.curves, table, [f"target.material.{name}" for name in names], truth.own)
        noise = [np.std(np.diff(curve.force, 2)) / np.sqrt(6.0) for curve in truth.curves.values()]
        left = [float(np.mean((curve.force - curve.fitted) ** 2)) for curve in found.curves]
        if any(power > 5.0 * own**2 for power, own in zip(left, noise, strict=True)):  # 2^2 the law's, 1 the noise's
            called.append(not found.adequate)
            assert any("not to be trusted" in one for one in found.warnings) == (not found.adequate)
    assert np.mean(called) >= 0.95


def test_a_curve_of_the_law_itself_leaves_nothing_to_be_judged() -> None:
    """What is left is the rounding of two integrations; ten times what they may err by is judged, and called wrong."""
    table = scene(STRIKERS[0], {"law": "sls", "E0": 1e6, "R1": 2.0, "R2": 0.02})
    built = Scene.from_dict(table)
    history = simulate(laws.ting.of(built), built, 1e-9).history
    curve = Curve(history.time, history.force)
    found = identify({"curve": curve}, table, ["target.material.R1"])
    assert found.adequate
    assert found.verdict.startswith("nothing speaks against the law: too little is left of the curves")
    assert not [one for one in found.warnings if "not to be trusted" in one]
    assert found.parameters["target.material.R1"].value == pytest.approx(2.0, rel=1e-5)
    wave = 1e-5 * curve.force.max() * np.sin(40.0 * curve.time / curve.time[-1])
    assert not identify({"curve": replace(curve, force=curve.force + wave)}, table, ["target.material.R1"]).adequate


def test_a_curve_of_few_rows_is_not_called_explained() -> None:
    """Of six rows no test says anything, however far from them the law is."""
    table = scene(STRIKERS[0], {"law": "sls", "E0": 1e6, "R1": 2.0, "R2": 0.02})
    built = Scene.from_dict(table)
    history = simulate(laws.ting.of(built), built, 1e-6).history
    time = np.linspace(0.0, history.time[-1], 6)
    force = history.force_at(time) * (1.0 + 0.3 * np.sin(9.0 * time / time[-1]))
    found = identify({"curve": Curve(time, force)}, table, ["target.material.E0"])
    (curve,) = found.curves
    assert np.abs(curve.force - curve.fitted).max() > 0.05 * force.max()
    assert "explain" not in found.verdict
    assert "too few rows" in found.verdict


def test_an_interval_is_that_of_the_whole_profile() -> None:
    """Of one modulus, against the sum of squares itself, the touch sought anew at every modulus."""
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    curve = curve_of(rng, *history_by_springs(table, {}), 0.03 * rng.normal(size=ROWS))
    found = identify({"curve": curve}, table, ["target.material.E"]).parameters["target.material.E"]

    def least(young: float) -> float:
        impact = Impact.of(Scene.from_dict(scene(STRIKERS[0], {"law": "elastic", "E": young})))

        def squares(touch: float) -> float:
            return float(np.sum((curve.force - impact.force(curve.time - touch)) ** 2))

        begin = float(curve.time[0]) + 0.25 * float(np.ptp(curve.time))
        around = 0.05 * float(np.ptp(curve.time))
        return float(
            minimize_scalar(
                squares, bounds=(begin - around, begin + around), method="bounded", options={"xatol": 1e-9}
            ).fun
        )

    best = least(found.value)
    most = best * (1.0 + stdtrit(ROWS - 2, 0.95) ** 2 / (ROWS - 2))
    assert found.low is not None
    assert found.high is not None
    for end, side in ((found.low, 0.9), (found.high, 1.1)):
        other = brentq(lambda young: least(young) - most, found.value, side * found.value, rtol=1e-6)
        assert abs(end - other) < 0.02 * (found.high - found.low)


@pytest.mark.tenth
def test_at_an_end_all_others_are_chosen_anew() -> None:
    """Of the 3-parameter solid: with the ratio held there, least squares in all the rest grow by the quantile."""
    rng = np.random.default_rng(SEED)
    true = {"E0": 1e6, "R1": 1.0, "R2": 0.01}
    table = scene(STRIKERS[0], {"law": "sls", **true})
    curve = curve_of(rng, *history_by_springs(table, {}), 0.01 * rng.normal(size=ROWS))
    free = [f"target.material.{name}" for name in true]
    ratio = identify({"curve": curve}, table, free).parameters["target.material.R1"]
    assert ratio.low is not None
    assert ratio.high is not None
    begin = float(curve.time[0]) + 0.25 * float(np.ptp(curve.time))
    width = 0.5 * float(np.ptp(curve.time))
    guess = [np.log(true["E0"]), np.log(true["R2"]), 0.0]

    def least(R1: float | None) -> float:
        def left(x: Array) -> Array:
            material = {"law": "sls", "E0": np.exp(x[0]), "R2": np.exp(x[1]), "R1": R1 or float(np.exp(x[3]))}
            impact = Impact.of(Scene.from_dict(scene(STRIKERS[0], material)))
            return curve.force - impact.force(curve.time - begin - width * x[2])

        start = guess if R1 else [*guess, np.log(true["R1"])]
        return 2.0 * float(least_squares(left, start, diff_step=1e-5, xtol=1e-8).cost)

    best, freedom = least(None), ROWS - 4
    for end in (ratio.low, ratio.high):
        growth = (least(end) / best - 1.0) * freedom
        assert growth == pytest.approx(stdtrit(freedom, 0.95) ** 2, rel=0.1)


@pytest.mark.parametrize(
    ("striker", "material", "free"),
    [
        (STRIKERS[0], {"law": "elastic", "E": 1e6}, ("target.material.E", "target.material.nu")),
        (POWER, {"law": "elastic", "E": 1e6}, ("target.material.E", "striker.coefficient")),
        (STRIKERS[1], {"law": "sls", "E0": 1e6, "R1": 1.0, "R2": 0.01}, ("target.material.E0", "striker.angle")),
    ],
)
def test_what_no_curve_can_tell_apart_is_refused_by_name(
    striker: dict[str, Any], material: dict[str, Any], free: tuple[str, ...]
) -> None:
    """On the half-space modulus and Poisson's ratio are one number, E*, and the factor of the load curve is another."""
    table = scene(striker, material)
    curves = {"curve": curve_of(np.random.default_rng(SEED), *history_by_springs(table, {}), np.zeros(ROWS))}
    others = [f"target.material.{name}" for name in ("R1", "R2") if name in material]
    with pytest.raises(BadInput, match=f"tells only a combination of {free[1]}, {free[0]}|{free[0]}, {free[1]}; "):
        identify(curves, table, [*free, *others])


@pytest.mark.tenth
def test_an_exponent_is_told_beside_its_factor() -> None:
    """F = factor depth^(1 + 1/n): both by their short names, from a first guess far away."""
    rng = np.random.default_rng(SEED + 1)
    table = scene(POWER, {"law": "elastic", "E": 1e6})
    curve = curve_of(rng, *history_by_springs(table, {}), 0.003 * rng.normal(size=ROWS))
    table["striker"]["exponent"] = 3.5
    found = identify({"curve": curve}, table, ["exponent", "coefficient"])
    for name in ("exponent", "coefficient"):
        one = found.parameters[f"striker.{name}"]
        assert (one.low or np.inf) <= POWER[name] <= (one.high or 0.0)
    one = found.parameters["striker.exponent"]
    assert (one.high or np.inf) - (one.low or 0.0) < 0.15
    assert any("are correlated by" in warning for warning in found.warnings)


@pytest.mark.tenth
def test_both_valleys_of_one_history_are_in_the_interval() -> None:
    """A fast relaxation tells it as well as a slow one, and what lies between does not, by least squares of its own."""
    rng = np.random.default_rng(2)
    table = scene(STRIKERS[0], {"law": "sls", "E0": 1e6, "R1": 0.5, "R2": 0.0335})
    first = curve_of(rng, *history_by_springs(table, {}), 0.03 * rng.normal(size=ROWS))
    free = [f"target.material.{name}" for name in SLS]
    found = identify({"first": first}, table, free)
    slow, fast = (valley.parameters["target.material.R2"] for valley in found.valleys)
    whole = found.parameters["target.material.R2"]
    assert slow.value == whole.value
    assert (whole.low, whole.high) == (fast.low, slow.high)
    assert slow.low is not None
    assert fast.high is not None
    assert fast.high < slow.low
    assert any("tell the curves about as well" in warning for warning in found.warnings)

    def least(held: float, ratio: float) -> float:
        values = (found.valleys[1].parameters["target.material.E0"].value, ratio)

        def left(x: Array) -> Array:
            material = {"law": "sls", "E0": np.exp(x[0]), "R1": np.exp(x[1]), "R2": held}
            impact = Impact.of(Scene.from_dict(scene(STRIKERS[0], material)))
            return first.force - impact.force(first.time - found.curves[0].touch - 0.01 * x[2])

        most = [np.log(1e9), np.log(1e8), 1.0]
        start = [*np.log(values), 0.0]
        return 2.0 * float(least_squares(left, start, diff_step=1e-4, xtol=1e-5, bounds=(-np.inf, most)).cost)

    bound, slowly = stdtrit(ROWS - 4, 0.95) ** 2, float(np.sum((first.force - found.curves[0].fitted) ** 2))
    assert 0.0 < found.valleys[1].growth < bound
    ratio = found.valleys[1].parameters["target.material.R1"]
    assert ratio.low is not None
    between = least(float(np.sqrt(fast.high * slow.low)), ratio.value)
    assert between / slowly > 1.0 + bound / (ROWS - 4)
    growth = (least(fast.high, ratio.low) / slowly - 1.0) * (ROWS - 4)
    assert growth == pytest.approx(bound, rel=0.05), "a stiff spring in series gives way before the end"


def test_walkers_draw_from_a_gaussian_of_any_scale() -> None:
    """Mean, covariance and quantiles of a linear-Gaussian truth; and the same walk in any linear coordinates."""
    rng, size = np.random.default_rng(SEED), 3
    root = rng.normal(size=(size, size)) * [[1e-3], [1.0], [1e4]]
    mean, inverse = rng.normal(size=size), np.linalg.inv(root)

    def density(place: Array) -> float:
        return -0.5 * float(np.sum((inverse @ (place - mean)) ** 2))

    def plain(place: Array) -> float:
        return -0.5 * float(np.sum(place**2))

    start = 3.0 * rng.normal(size=(40, size))
    found = draws_of(density, mean + start @ root.T, 200, 60, np.random.default_rng(1))
    unit = (found.rows - mean) @ inverse.T
    error = 1.0 / np.sqrt(found.effective)
    assert 200 < found.effective < 40 * 200 / 4
    assert 0.3 < found.taken < 0.7
    assert np.abs(unit.mean(axis=0)) == pytest.approx(0.0, abs=4.0 * error)
    assert np.cov(unit, rowvar=False) == pytest.approx(np.eye(size), abs=6.0 * error)
    for share, place in ((0.05, -1.6449), (0.95, 1.6449)):
        assert np.quantile(unit, share, axis=0) == pytest.approx(place, abs=8.0 * error)
    same = draws_of(plain, start, 200, 60, np.random.default_rng(1))
    assert np.abs(same.rows - unit)[: 40 * 20].max() < 1e-6, "rounding grows from step to step"


def test_draws_are_of_the_density_wherever_the_linearized_one_lies() -> None:
    """Of Gumbel's skew density beside one too narrow or too wide: mean, deviation, and how many are independent."""
    for width, least in ((0.7, 0.1), (1.0, 0.2), (3.0, 0.1)):
        near = Linearized(np.full((1, 1), 0.3), np.eye(1)[np.newaxis], np.full((1, 1), width))
        found = draws_of(
            lambda x: -float(x[0] + np.exp(-x[0])), np.zeros((20, 1)), 100, 10, np.random.default_rng(3), near
        )
        assert found.effective > least * found.rows.size
        error = 1.0 / np.sqrt(found.effective)
        assert found.rows.mean() == pytest.approx(np.euler_gamma, abs=4.0 * 1.28 * error)
        assert found.rows.std() == pytest.approx(np.pi / np.sqrt(6.0), rel=4.0 * error)


@pytest.mark.tenth
def test_a_sample_says_what_the_profile_says(tmp_path: Path) -> None:
    """Of a modulus, whose likelihood is nearly Gaussian; nine tenths of another record lie in the predicted band."""
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    time, force = history_by_springs(table, {})
    found = identify(
        {"curve": curve_of(rng, time, force, 0.03 * rng.normal(size=ROWS))}, table, ["target.material.E"], sample=400
    )
    (one,), (curve,), drawn = found.parameters.values(), found.curves, found.posterior
    assert drawn is not None
    assert one.low is not None
    assert one.high is not None
    low, high = np.quantile(drawn.values[:, 0], [0.05, 0.95])
    assert (low, high) == pytest.approx((one.low, one.high), abs=0.2 * (one.high - one.low))
    true = np.interp(curve.time - curve.touch, time, force, 0.0, 0.0)
    another = true + 0.03 * force.max() * rng.normal(size=curve.time.size)
    inside = (curve.predicted[0] <= another) & (another <= curve.predicted[1])
    assert np.mean(inside) == pytest.approx(0.9, abs=3.0 * 0.3 / np.sqrt(ROWS))
    found.write_files(tmp_path)
    draws = np.loadtxt(tmp_path / "sample.csv", delimiter=",", skiprows=1)
    assert draws[:, 0] == pytest.approx(drawn.values[:, 0])
    assert draws.shape[1] == 3, "modulus, touch, likelihood"
    assert np.all(curve.predicted[0] <= curve.band[0])
    assert np.all(curve.band[1] <= curve.predicted[1])


@pytest.mark.tenth
def test_a_reference_corrects_the_law_where_it_errs() -> None:
    """The truth knows a gravity that the law of the search does not: with a reference that knows it the search ends at
    the truth, and a reference that errs within its bar moves it by no more than is said.
    """
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    heavy = Scene.from_dict({**table, "model": {"gravity": 1.0}})

    def reference(one: Scene, off: float = 0.0) -> History:
        there = replace(one, model=heavy.model)
        history = simulate(laws.get("ting").of(there), there, 1e-5).history
        bar = np.full(len(history), 0.01 * history.force.max())
        return replace(history, force=history.force + off * bar, force_error=bar)

    curves = {"curve": curve_of(np.random.default_rng(SEED), *_rows(reference(heavy)), np.zeros(ROWS))}
    free = ["target.material.E"]
    alone, corrected, other = (
        identify(curves, table, free, reference=one) for one in (None, reference, partial(reference, off=1.0))
    )
    values = [one.parameters[free[0]].value for one in (alone, corrected, other)]
    assert abs(values[0] / 1e6 - 1.0) > 1e-2
    assert abs(values[1] / 1e6 - 1.0) < 5e-4
    assert corrected.by_reference is not None
    moved = corrected.by_reference.parameters[free[0]]
    assert (moved.by_law, moved.value) == pytest.approx(values[:2])
    assert 0.0 < abs(values[2] - values[1]) < moved.bar


def _rows(history: History) -> tuple[Array, Array]:
    return history.time, history.force


def test_coloured_noise_widens_the_intervals_as_its_memory_asks() -> None:
    """A recursion of the silence's own; taken for white, the residuals would be called the law's."""
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    time, force = history_by_springs(table, {})
    white, rows = rng.normal(size=4 * ROWS), 4 * ROWS
    coloured = white.copy()
    for i in range(1, rows):
        coloured[i] += 0.8 * coloured[i - 1]
    scale = 0.02 / coloured.std()
    of_white = identify({"curve": curve_of(rng, time, force, 0.02 * white)}, table, ["target.material.E"])
    of_coloured = identify({"curve": curve_of(rng, time, force, scale * coloured)}, table, ["target.material.E"])
    assert of_coloured.adequate
    assert of_coloured.curves[0].colour == pytest.approx([0.8], abs=0.1)
    widths = [np.log(one.high / one.low) for found in (of_white, of_coloured) for one in found.parameters.values()]
    assert widths[1] / widths[0] == pytest.approx(3.0, rel=0.3), "sqrt((1 + 0.8)/(1 - 0.8)) for a slow signal"


def noise_of(rng: np.random.Generator, colour: Sequence[float], rows: int) -> Array:
    """Noise of deviation one that has forgotten its start: of so many rows alike, by a recursion's coefficients."""
    recursion, longest = np.append(1.0, -np.array(colour)), 2000
    fading = lfilter([1.0], recursion, np.eye(1, longest)[0])
    found = lfilter([1.0], recursion, rng.normal(size=longest + rows))[longest:]
    return np.asarray(found / np.linalg.norm(fading))


# Rows of a record, of which fewer than half are silent, and the colour of its noise.
COLOURED: list[tuple[int, tuple[float, ...]]] = [
    (100, (0.3,)),
    (100, (0.8,)),
    (300, (0.9,)),
    (300, (0.97,)),
    (1000, (0.97,)),
    (100, (1.6, -0.64)),
    (300, (1.2, -0.5)),
    (300, ()),
]


@pytest.mark.tenth
def test_intervals_hold_the_truth_whatever_the_noise_s_colour() -> None:
    """Of 320 draws nine tenths, no fewer and no more, but for chance of two deviations.

    The silence that tells the colour is a few times as long as the noise's memory, or not even that. Little noise: much
    of a slow one moves the touch farther than the sum of squares is even.
    """
    rng, draws = np.random.default_rng(SEED), 40
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    time, force = history_by_springs(table, {})
    curves = [
        curve_of(rng, time, force, 0.005 * noise_of(rng, colour, rows))
        for rows, colour in COLOURED
        for _ in range(draws)
    ]
    every = [identify({"curve": curve}, table, ["target.material.E"]) for curve in curves]
    inside = [found.parameters["target.material.E"].holds(1e6) for found in every]
    assert np.mean(inside) == pytest.approx(0.9, abs=2.0 * np.sqrt(0.09 / len(inside)))


@pytest.mark.parametrize("colour", [0.6, 0.9])
def test_likely_colours_hold_the_true_one_as_often_as_they_say(colour: float) -> None:
    """Nine tenths, of two silences each, whose rows have nothing to do with each other, by what a slow signal sees."""
    rng, cases, below = np.random.default_rng(SEED), 400, list[float]()
    for _ in range(cases):
        colours = likely_colours([noise_of(rng, (colour,), 50) for _ in range(2)], 100, rng)
        below.append(float(np.mean([one.sum() < colour for one in colours])))
    inside = np.abs(np.array(below) - 0.5) < 0.45
    assert np.mean(inside) == pytest.approx(0.9, abs=2.0 * np.sqrt(0.09 / cases))


@pytest.mark.parametrize("silence", [np.zeros(50), np.append(np.zeros(49), 1.0)])
def test_a_silence_without_noise_is_white(silence: Array) -> None:
    """Of zeros, or of a single row that is not silent: there is a colour to go on with."""
    assert colour_of(silence).size == 0
    assert all(np.isfinite(one).all() for one in likely_colours([silence], 20, np.random.default_rng(SEED)))


def test_the_corner_of_a_low_pass_stands_in_for_the_silence() -> None:
    """A record of the contact alone: RC noise looks like an error of the law until its corner is named."""
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    time, force = history_by_springs(table, {})
    rows = np.linspace(0.0, float(time[-1]), ROWS)
    corner = 0.05 / (rows[1] - rows[0])
    passed, past = np.zeros(ROWS), 0.0
    for i, white in enumerate(rng.normal(size=ROWS)):
        past = passed[i] = np.exp(-2.0 * np.pi * 0.05) * past + white
    noise = 0.01 * force.max() * passed / passed.std()
    curves = {"curve": Curve(rows, np.interp(rows, time, force) + noise)}
    untold, told = (identify(curves, table, ["target.material.E"], corner=one) for one in (None, corner))
    assert (untold.adequate, told.adequate) == (False, True)
    one = told.parameters["target.material.E"]
    assert (one.low or np.inf) < 1e6 < (one.high or 0.0)
    assert told.curves[0].deviation == pytest.approx(0.01 * force.max(), rel=0.15)


# A polymer struck so fast that an instrument is slow beside it; one spring is known, which takes less work.
POLYMER = {"target.material.E1": 2.2e6, "target.material.C1": 1.5e4}
STRUCK = {"striker.velocity": 0.5, "target.material.E2": 1.3e6}
FAST = Scene.load("polymer-sphere", POLYMER | STRUCK)


@pytest.mark.tenth
def test_a_low_pass_that_filtered_the_force_too_is_warned_of() -> None:
    """Of second order, its corner at ten times the contact's rate: a value is off, whatever the residuals say.

    The warning names every interval that does not hold its value; one of them, wide as it is, may hold it by chance.
    """
    history = simulate(laws.get("ting").of(FAST), FAST).history
    time = np.arange(-0.01, 0.04, 5e-5)
    force = history.force_at(time) + 0.001 * history.force.max() * np.random.default_rng(1).normal(size=time.size)
    filtered = lfilter(*butter(2, 1e3, fs=2e4), force)
    for record, warned in ((force, False), (filtered, True)):
        found = identify({"drop": Curve(time, record)}, "polymer-sphere", list(POLYMER), overrides=STRUCK)
        said = (
            f"low pass; if that filtered the force too, the intervals of {', '.join(POLYMER)} do not hold their values"
        )
        assert any(said in one for one in found.warnings) == warned
        assert all(found.parameters[name].holds(value) for name, value in POLYMER.items()) != warned


@pytest.mark.tenth
def test_a_low_pass_that_is_known_leaves_the_values_as_they_were() -> None:
    """Of first order, before the record's clock, as an instrument's: the intervals hold the truth only where it is."""
    history = simulate(laws.get("ting").of(FAST), FAST).history
    often = 40  # steps of the instrument in one of the record
    time = np.arange(-0.01, 0.04, 5e-5 / often)
    shaken = history.force_at(time) + 0.02 * history.force.max() * np.random.default_rng(4).normal(size=time.size)
    fades = np.exp(-2.0 * np.pi * 600.0 * 5e-5 / often)
    record = Curve(time[::often], lfilter([1.0 - fades], [1.0, -fades], shaken)[::often])
    aware, blind = (
        identify({"drop": record}, "polymer-sphere", list(POLYMER), overrides=STRUCK, low_pass=known)
        for known in (600.0, None)
    )
    assert aware.adequate
    assert all(aware.parameters[name].holds(value) for name, value in POLYMER.items())
    assert not any("low pass" in one for one in aware.warnings)
    assert not all(blind.parameters[name].holds(value) for name, value in POLYMER.items())
    assert any("cure: --low-pass HZ" in one for one in blind.warnings)


def test_a_low_pass_beside_a_corner_and_of_uneven_rows_is_refused() -> None:
    curve = Curve(np.linspace(0.0, 1.0, 50), np.sin(np.pi * np.linspace(0.0, 1.0, 50)))
    for wrong in (0.0, -100.0, np.nan, np.inf):
        for name in ("corner", "low_pass"):
            with pytest.raises(BadInput, match=f"{name}: .*accepted a frequency above zero, Hz"):
                identify({"curve": curve}, "polymer-sphere", ["E1"], **{name: wrong})
    with pytest.raises(BadInput, match="beside a corner; accepted: one of them"):
        identify({"curve": curve}, "polymer-sphere", ["E1"], corner=1e3, low_pass=1e3)
    with pytest.raises(BadInput) as refused:
        identify({"curve": curve}, "polymer-sphere", ["E1"], corner=-1.0, low_pass=np.nan)
    assert [fault.source for fault in refused.value.faults] == ["corner", "low_pass", "low_pass"]
    rows = np.linspace(0.0, 1.0, 50) ** 1.3
    with pytest.raises(BadInput, match="not known of rows in uneven steps"):
        identify({"curve": Curve(rows, np.sin(np.pi * rows))}, "polymer-sphere", ["E1"], low_pass=1e3)


def test_a_corner_that_the_record_does_not_have_is_no_noise() -> None:
    """White noise whitened once more: neighbours are opposed, which is no law's error and no noise either."""
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    time, force = history_by_springs(table, {})
    curve = curve_of(rng, time, force, 0.02 * rng.normal(size=4 * ROWS))
    corner = 0.1 / (curve.time[1] - curve.time[0])
    found = identify({"curve": curve}, table, ["target.material.E"], corner=corner)
    assert not found.adequate
    assert not found.whiteness.of_the_law
    assert found.verdict.startswith("the noise is not of the colour it was taken for (Ljung-Box, p = ")
    assert any("opposed" in one and "cure: --corner of the instrument, or none" in one for one in found.warnings)


def test_colour_and_whiteness_of_known_series() -> None:
    rng = np.random.default_rng(SEED)
    white = rng.normal(size=4000)
    coloured = white.copy()
    for i in range(2, white.size):
        coloured[i] += 1.2 * coloured[i - 1] - 0.5 * coloured[i - 2]
    assert colour_of(white).size == 0
    assert colour_of(coloured) == pytest.approx([1.2, -0.5], abs=0.05)
    assert whiteness([white]).noise
    assert not whiteness([coloured]).noise
    assert whiteness([whitened(coloured, np.array([1.2, -0.5]))]).noise
    assert memory(white) == pytest.approx(1.0, abs=0.1)


def test_free_keys_are_those_of_the_scene() -> None:
    table = scene(STRIKERS[0], {"law": "prony", "E_inf": 1e6, "E": [1e6, 2e6], "tau": [0.01, 0.1]})
    curves = {"curve": Curve(np.linspace(0.0, 1.0, 50), np.sin(np.linspace(0.0, np.pi, 50)))}
    with pytest.raises(BadInput, match=r"did you mean target.material.E_inf\?"):
        identify(curves, table, ["target.material.E_in"])
    with pytest.raises(BadInput, match="one of them"):
        identify(curves, table, ["striker.velocity"], {"curve": {"striker.velocity": 1.0}})
    with pytest.raises(BadInput, match="empty"):
        identify(curves, table, [])
    with pytest.raises(BadInput, match="at least one measured history"):
        identify({}, table, ["target.material.E"])


def test_a_solid_is_sought_by_either_set_of_its_names() -> None:
    """E0, R1 and R2 of a scene that has E1, E2 and C1, "(25)"; the scene that comes back has them too."""
    E1, E2, C1 = 1.5e6, 1e6, 1e4
    table = scene(STRIKERS[0], {"law": "sls", "E1": E1, "E2": E2, "C1": C1})
    file = SceneFile.of(table, {}).named_by(["E0", "target.material.R2"])
    material = dict(file.table["target"]["material"])
    assert [material.pop(name) for name in SLS] == pytest.approx([E1 * E2 / (E1 + E2), E2 / E1, C1 / E1])
    assert material == {"law": "sls", "nu": 0.4}
    assert SceneFile.of(table, {}).named_by(["E1", "nu"]).table == table


@pytest.mark.parametrize(("velocity", "named"), [(2e-4, False), (0.5, True)])
def test_an_effect_larger_than_the_intervals_is_named(velocity: float, named: bool) -> None:
    """Waves in a body struck slowly and fast; the law knows none, and the residuals of its own curve show none."""
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6, "density": 1000.0})
    table["striker"]["velocity"] = velocity
    curve = curve_of(np.random.default_rng(SEED), *history_by_springs(table, {}), np.zeros(ROWS))
    shaken = replace(curve, force=curve.force + 0.005 * curve.force.max() * np.random.default_rng(3).normal(size=ROWS))
    found = identify({"curve": shaken}, table, ["target.material.E"])
    assert found.adequate
    ledger = simulate(laws.ting.of(told := Scene.from_dict(found.table)), told).model_ledger
    waves = next(entry.size for entry in ledger if entry.effect == "target inertia")
    half = found.parameters["target.material.E"].share
    assert half is not None
    assert (waves > half) == named
    said = [one for one in found.warnings if one.startswith("left out, up to so much of the peak force: ")]
    assert any("target inertia (" in one for one in said) == named
    assert any(one.endswith("cure for target inertia: --method fe --set model.inertia=true") for one in said) == named


@pytest.mark.tenth
def test_a_spring_that_the_curves_do_not_need_is_named() -> None:
    """A fluid of one branch taken for a solid."""
    rng = np.random.default_rng(SEED)
    fluid = {"law": "maxwell", "E": 1e6, "eta": 1e3}
    time, force = history_by_springs(scene(STRIKERS[0], fluid), {})
    curve = curve_of(rng, time, force, 0.005 * rng.normal(size=ROWS))
    table = scene(STRIKERS[0], {"law": "sls", "E1": 1e5, "E2": 1e6, "C1": 1e3})
    found = identify({"curve": curve}, table, ["target.material.E1"])
    assert found.parameters["target.material.E1"].value < 1e3
    (said,) = (one for one in found.warnings if "ran into the end of its search" in one)
    assert said.startswith("target.material.E1 ")
    assert said.endswith("none: the curves do not need it; cure: a law without it")
    assert (found.beyond, found.unneeded) == ((), ("target.material.E1",))
    assert found.to_json()["unneeded"] == ["target.material.E1"]


@pytest.mark.tenth
def test_a_spring_that_may_be_none_opens_no_other_interval() -> None:
    """Below none there is none: what else is told of a fluid taken for a solid is told to both sides."""
    fluid = {"law": "maxwell", "E": 1e6, "eta": 1e3}
    time, force = history_by_springs(scene(STRIKERS[0], fluid), {})
    curve = curve_of(np.random.default_rng(SEED), time, force, 0.005 * np.random.default_rng(7).normal(size=ROWS))
    table = scene(STRIKERS[0], {"law": "sls", "E1": 1e5, "E2": 1e6, "C1": 1e3})
    found = identify({"curve": curve}, table, [f"target.material.{name}" for name in ("E1", "E2", "C1")]).parameters
    spring = found["target.material.E1"]
    assert spring.low is not None
    assert spring.high is not None
    assert spring.low < 1.0 < spring.high < 1e5
    for name, value in (("E2", fluid["E"]), ("C1", fluid["eta"])):
        one = found[f"target.material.{name}"]
        assert one.low is not None
        assert one.high is not None
        assert one.high - one.low < value
        assert abs(0.5 * (one.low + one.high) - value) < one.high - one.low


def test_a_search_that_ends_before_the_likeliest_value_did_not_converge(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mass guessed farther off than a search looks."""
    monkeypatch.setattr(free_keys, "REACH", 10.0)
    rng = np.random.default_rng(SEED)
    table = scene(STRIKERS[0], {"law": "elastic", "E": 1e6})
    curve = curve_of(rng, *history_by_springs(table, {}), 0.005 * rng.normal(size=ROWS))
    table["striker"]["mass"] *= 0.05
    found = identify({"curve": curve}, table, ["striker.mass"])
    assert found.beyond == ("striker.mass",)
    assert not found.to_json()["converged"]
    said = "striker.mass ran into the upper end of its search, 0.025 kg: it is not found; cure: "
    assert any(one.startswith(said) for one in found.warnings)
