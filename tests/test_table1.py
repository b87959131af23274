"""`fe-contact table1`: what finite elements identify, the verdict's rules, files without NaN, the chart."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from fe_contact.cli import main
from fe_contact.studies.table1 import limits, study
from fe_contact.studies.table1.limits import DEPTH, LIMIT, Block, Place, Reach, curve, within
from fe_contact.studies.table1.study import Trial, bodies, table1
from fe_contact.studies.table1.verdict import (
    HOLDS,
    RANGE,
    UNDECIDED,
    UNTRIED,
    WRONG,
    deviations,
    verdict,
    write_table1,
)
from lumped.load_curves import Hertz, SneddonSphere
from lumped.paper.table1 import ROWS, Elastic, TableRow
from lumped.result.result import Quantity

COLUMNS = (
    "number", "row", "case", "D_printed_formula", "D_printed", "D", "D_error", "D_deviation", "alpha_printed", "alpha",
    "alpha_error", "E_printed_formula", "E_corrected_formula", "nu", "E_printed_Pa", "E_Pa", "E_error_Pa",
    "E_deviation", "depth_tried_from", "depth_tried_to", "holds_to_1_percent_up_to", "holds_up_to_error", "verdict",
    "statement", "validity", "correction", "D_impact", "D_impact_error", "alpha_impact", "alpha_impact_error",
    "E_impact_Pa", "E_impact_error_Pa",
)  # fmt: skip
ROUNDING = 1e-9
RATIOS = (0.0, 0.45)


@pytest.fixture(scope="module")
def trials(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Trial]]:
    """Every row at two of three Poisson's ratios, line contact at few places."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "RATIOS", RATIOS)
        patch.setattr(limits, "CHECKED", {"datum": (3.0,), "bonded layer": (0.3,)})
        patch.setattr(limits, "HELD", {"free": (2.0, 20.0), "held": (2.0,)})
        yield {one.row.name: one for one in table1(tmp_path_factory.mktemp("table1"), jobs=1)}


def value(quantity: Quantity | None) -> float:
    assert quantity is not None
    assert quantity.value is not None
    return quantity.value


def covers(quantity: Quantity, exact: float) -> bool:
    return abs(value(quantity) - exact) <= (quantity.error or 0.0) + ROUNDING * abs(exact)


@pytest.mark.tenth
@pytest.mark.parametrize("name", ["prism", "plate", "punch", "cone", "sphere", "two_spheres"])
def test_exact_rows_are_identified(trials: Mapping[str, Trial], name: str) -> None:
    found = trials[name]
    assert value(found.alpha) == pytest.approx(found.row.alpha, abs=5e-4)
    assert value(found.factor) == pytest.approx(found.row.factor, rel=1e-3)


@pytest.mark.tenth
@pytest.mark.parametrize("name", ["prism", "plate", "punch", "cone"])
def test_the_bars_of_power_laws_cover_them(trials: Mapping[str, Trial], name: str) -> None:
    """Spheres are no power laws: their truth is tested below."""
    found = trials[name]
    assert found.alpha is not None
    assert found.factor is not None
    assert covers(found.alpha, found.row.alpha)
    assert covers(found.factor, found.row.factor)


@pytest.mark.tenth
@pytest.mark.parametrize("name", [row.name for row in ROWS.values()])
def test_poissons_ratio_moves_the_modulus_as_the_corrected_row_says(trials: Mapping[str, Trial], name: str) -> None:
    found = trials[name]
    assert tuple(found.moduli) == RATIOS
    for nu, modulus in found.moduli.items():
        exact = found.row.modulus(*bodies(found.row, nu))
        assert value(modulus) == pytest.approx(exact, rel=2e-4)
        assert covers(modulus, exact)


@pytest.mark.tenth
@pytest.mark.parametrize("name", [row.name for row in ROWS.values()])
def test_impacts_identify_what_slow_indentation_does(trials: Mapping[str, Trial], name: str) -> None:
    """E* as corrected; alpha and D within what both bars and the profile of a true sphere leave open."""
    found, struck = trials[name], trials[name].impact
    assert struck is not None
    assert tuple(sorted(struck.moduli)) == RATIOS
    for nu, modulus in struck.moduli.items():
        assert covers(modulus, found.row.modulus(*bodies(found.row, nu)))
        assert (modulus.error or 0.0) < (5e-3 if found.row.single else 0.1) * value(modulus)
    for ours, theirs in ((struck.alpha, found.alpha), (struck.factor, found.factor)):
        assert (ours is None) == (theirs is None)
        if ours is not None and theirs is not None:
            assert abs(value(ours) / value(theirs) - 1.0) * value(theirs) <= (ours.error or 0.0) + (theirs.error or 0.0)
            assert (ours.error or 0.0) < 2e-3 * value(ours)


@pytest.mark.tenth
def test_line_contact_from_impact_lies_on_the_exact_curve(trials: Mapping[str, Trial]) -> None:
    (place,) = (place for place in trials["cylinder"].datum if place.method == "impact")
    line = curve(place.support, place.length, RATIOS[1])
    assert covers(place.factor, float(line.force(DEPTH)) / DEPTH)
    held = [place for place in trials["two_cylinders"].datum if place.support == "held"]
    assert {place.method for place in held} == {"fe", "impact"}


@pytest.mark.tenth
def test_the_sphere_leaves_its_row_where_the_exact_sphere_does(trials: Mapping[str, Trial]) -> None:
    reach = trials["sphere"].reach
    assert reach is not None
    true, parabola = SneddonSphere(1.0), Hertz(1.0)
    exact = brentq(lambda d: float(true.force(d) / parabola.force(d)) - 1.0 + LIMIT, 1e-3, 0.5, xtol=1e-12)
    assert covers(reach.held, exact)
    assert value(reach.held) == pytest.approx(exact, rel=5e-3)
    found = trials["sphere"]
    shallow = found.row.length * 1e-4
    ratio = float(true.force(1e-4) / parabola.force(1e-4))
    assert shallow > 0.0
    assert value(found.factor) / found.row.factor == pytest.approx(ratio, abs=2e-5)


@pytest.mark.tenth
def test_whole_spheres_leave_their_row_far_earlier(trials: Mapping[str, Trial]) -> None:
    """Two spheres of their true size depart rather as a/R, depth^(1/2), than as (a/R)^2 like the profile alone."""
    reach = trials["two_spheres"].reach
    assert reach is not None
    assert 0.0 < value(reach.held) < 0.01
    slope = np.diff(np.log(reach.departure[:3])) / np.diff(np.log(reach.depth[:3]))
    assert np.all((slope > 0.45) & (slope < 0.75))


@pytest.mark.tenth
def test_line_contact_covers_the_exact_curves(trials: Mapping[str, Trial]) -> None:
    checked = [place for place in trials["cylinder"].datum if place.method == "fe"]
    assert {place.support for place in checked} == {"datum", "bonded layer"}
    for place in checked:
        line = curve(place.support, place.length, RATIOS[1])
        near = np.array([DEPTH / 1.1, DEPTH * 1.1])
        force = np.asarray(line.force(near))
        chord = float(np.diff(np.log(force))[0] / np.diff(np.log(near))[0])
        assert covers(place.factor, float(line.force(DEPTH)) / DEPTH)
        assert value(place.alpha) == pytest.approx(chord, abs=(place.alpha.error or 0.0) + 1e-5)


def test_the_printed_d_of_line_contact_is_met_at_one_depth() -> None:
    """Against 4d of the audit: a bonded layer, nu = 0.3 and 0.45, meets pi/4 at R depth/h^2 = 0.075 and 0.042."""
    for nu, number in ((0.3, 0.075), (0.45, 0.042)):
        line = curve("bonded layer", 1e-2, nu)
        once = limits._once(line)
        assert once is not None
        assert once / 1e-4 == pytest.approx(number, abs=0.001)


@pytest.mark.tenth
def test_held_cylinders_are_stiffer_to_approach_differently(trials: Mapping[str, Trial]) -> None:
    """No two ways of holding agree, nor two sizes: there is no D."""
    pressed = [place for place in trials["two_cylinders"].datum if place.method == "fe"]
    factors = [value(place.factor) for place in pressed]
    assert len(factors) == 3
    assert min(abs(a - b) for i, a in enumerate(factors) for b in factors[:i]) > 0.005
    assert all(1.05 < value(place.alpha) < 1.25 for place in pressed)


@pytest.mark.tenth
def test_bonded_blocks_go_from_young_to_confined(trials: Mapping[str, Trial]) -> None:
    assert trials["prism"].bonded == trials["plate"].bonded
    for nu in RATIOS[1:]:
        own = [block for block in trials["plate"].bonded if block.body.nu == nu]
        moduli = [value(block.modulus) for block in own]
        young, confined = own[0].body.young, trials["plate"].row.modulus(own[0].body)
        assert young < moduli[0] < 1.01 * young
        assert 0.97 * confined < moduli[-1] < confined
        assert moduli == sorted(moduli)


def test_a_bonded_block_of_rubber_stiffens_with_its_shape_factor_squared() -> None:
    """Thin, nu -> 1/2: E (1 + 2 S^2), S = radius/(2 thickness), within some per cent (Gent and Lindley 1959)."""
    body = Elastic(1.0, 0.4999)
    block = limits._block(body, 5.0)
    assert value(block.modulus) == pytest.approx(1.0 + 2.0 * 2.5**2, rel=0.08)


def test_widths_within_a_limit() -> None:
    """Moduli made up as E (1 + 0.1 width): row 1 holds to 1 % up to 0.1, row 2 at nu = 0 alike."""
    body = Elastic(1.0, 0.0)
    made = [Block(body, width, Quantity(1.0 + 0.1 * width, 0.0, "Pa")) for width in (0.01, 0.05, 0.2, 1.0)]
    found = within(ROWS["prism"], made, LIMIT)
    assert found is not None
    assert found[0] == 0.0
    assert found[1] == pytest.approx(0.1, rel=1e-9)
    assert within(ROWS["prism"], made[2:], LIMIT) is None
    assert within(ROWS["prism"], made[:2], LIMIT) == (0.0, math.inf)


@pytest.mark.tenth
def test_verdicts(trials: Mapping[str, Trial]) -> None:
    words = {name: verdict(found).word for name, found in trials.items()}
    assert words == {
        "prism": HOLDS, "plate": HOLDS, "punch": HOLDS, "sphere": RANGE,
        "cylinder": WRONG, "cone": WRONG, "two_spheres": RANGE, "two_cylinders": WRONG,
    }  # fmt: skip
    assert "1/(1-nu^2)" in verdict(trials["cone"]).sentence
    for name in ("cylinder", "two_cylinders"):
        assert trials[name].alpha is None
        assert trials[name].factor is None
        assert verdict(trials[name]).sentence.startswith("no half-space answer; D depends on the datum")


def made_up(row: TableRow, alpha: float = 0.0, factor: float = 1.0, bar: float = 1e-5, held: float = 0.5) -> Trial:
    """A trial that differs from the corrected row by so much."""
    share = np.array([1e-3, 0.5])
    moduli = {nu: row.modulus(*bodies(row, nu)) for nu in RATIOS}
    return Trial(
        row,
        Quantity(row.alpha + alpha, bar, "1"),
        Quantity(row.factor * factor, bar * row.factor, "m"),
        {nu: Quantity(one, bar * one, "Pa") for nu, one in moduli.items()},
        Reach(1e-3, 0.5, Quantity(held, 0.0, "1"), share, np.zeros(2)),
    )


def test_a_trial_says_its_numbers_in_a_line() -> None:
    said = repr(made_up(ROWS["sphere"]))
    assert said.startswith("Trial of row 4, rigid sphere to elastic plane: alpha 1.5 +- ")
    assert all(f"E* at nu = {nu:g} " in said for nu in RATIOS)
    assert "array" not in said


def test_the_rule_of_the_verdict() -> None:
    row = ROWS["punch"]
    assert verdict(made_up(row)).word == HOLDS
    assert verdict(made_up(row, held=0.1)).word == RANGE
    assert verdict(made_up(row, factor=1.0008)).word == HOLDS
    assert verdict(made_up(ROWS["cone"])).word == WRONG
    assert verdict(Trial(row, failure="no contact")) == type(verdict(made_up(row)))(UNTRIED, "no contact")


def test_what_neither_printed_nor_corrected_row_explains_is_undecided() -> None:
    assert verdict(made_up(ROWS["punch"], factor=1.01)).word == UNDECIDED
    assert verdict(made_up(ROWS["punch"], alpha=0.01)).word == UNDECIDED


def test_a_wide_bar_decides_nothing() -> None:
    assert verdict(made_up(ROWS["punch"], bar=5e-3)).word == UNDECIDED
    assert not any(one.differs for one in deviations(made_up(ROWS["punch"], factor=1.004, bar=5e-3)).values())


def test_one_d_for_every_datum_would_not_be_called_wrong() -> None:
    same = tuple(Place("datum", length, "exact", Quantity(0.5, 0.0, "1"), Quantity(1.0, 0.0, "1")) for length in (1, 9))
    moduli = made_up(ROWS["cylinder"]).moduli
    assert verdict(Trial(ROWS["cylinder"], moduli=moduli, datum=same)).word == UNDECIDED
    other = (same[0], replace(same[1], factor=Quantity(0.6, 0.0, "1")))
    assert verdict(Trial(ROWS["cylinder"], moduli=moduli, datum=other)).word == WRONG


@pytest.mark.tenth
def test_files(tmp_path: Path, trials: Mapping[str, Trial]) -> None:
    content = write_table1(list(trials.values()), tmp_path)
    with (tmp_path / "table1.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(COLUMNS)
    assert [int(row["number"]) for row in rows] == list(range(1, 9))
    assert (
        [row["D"] == "" for row in rows]
        == [row["alpha"] == "" for row in rows]
        == [not one.single for one in ROWS.values()]
    )
    for row in rows:
        assert all(math.isfinite(float(row[name])) for name in COLUMNS if name.endswith("_Pa"))
    with (tmp_path / "table1-datum.csv").open(newline="", encoding="utf-8") as file:
        places = list(csv.DictReader(file))
    assert {place["row"] for place in places} == {"cylinder", "two_cylinders"}
    assert len(places) == sum(len(found.datum) for found in trials.values())
    assert json.loads((tmp_path / "table1.json").read_text(encoding="utf-8")) == content
    assert [row["verdict"]["word"] for row in content["rows"]] == [verdict(found).word for found in trials.values()]


@pytest.mark.tenth
@pytest.mark.parametrize(("factor", "code"), [(1.0, 0), (1.01, 3)], ids=["decided", "undecided"])
def test_the_command(
    tmp_path: Path,
    trials: Mapping[str, Trial],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    factor: float,
    code: int,
) -> None:
    tried = (made_up(ROWS["sphere"], factor=factor), trials["cone"], trials["two_cylinders"])
    monkeypatch.setattr("fe_contact.studies.table1.study.table1", lambda where, progress: tried)
    assert main(["table1", "--out", str(tmp_path / "out"), "--quiet"]) == code
    said = capsys.readouterr()
    assert [line[0] for line in said.out.splitlines() if line[0].isdigit()] == ["4", "6", "8"]
    assert ("undecided: sphere" in said.err) == (code == 3)
    written = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert written.keys() == {
        "table1.csv", "table1-bonded.csv", "table1-datum.csv", "table1.json", "table1.svg", "table1.png"
    }  # fmt: skip
    assert main(["table1", "--out", str(tmp_path / "out"), "--json"]) == code
    assert json.loads(capsys.readouterr().out)["schema"] == "fe-contact/table1/1"
    again = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert again == written, "tables and charts, byte by byte"


def test_two_cylinders_vary_both_materials() -> None:
    first, second = bodies(ROWS["two_cylinders"], RATIOS[-1])
    assert first.young != second.young
    assert first.nu != second.nu


@pytest.mark.parametrize("off", [-0.005, 0.002, 0.03])
@pytest.mark.parametrize("row", [ROWS["punch"], ROWS["sphere"], ROWS["prism"]], ids=lambda row: row.name)
def test_a_modulus_that_is_not_the_rows_is_never_said_to_hold(row: TableRow, off: float) -> None:
    """E* by finite elements that no row explains, at one Poisson's ratio of several."""
    found = made_up(row)
    nu = RATIOS[1]
    odd = Quantity((1.0 + off) * value(found.moduli[nu]), 1e-5 * value(found.moduli[nu]), "Pa")
    assert verdict(found).word == HOLDS
    assert verdict(replace(found, moduli={**found.moduli, nu: odd})).word == UNDECIDED
    assert deviations(replace(found, moduli={**found.moduli, nu: odd}))["E*"].differs
