"""The report: what it says follows from what was found, it is made again byte by byte, and a browser can show it."""

from __future__ import annotations

import json
import os
import re
import runpy
from collections.abc import Callable, Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_contact.cli import main, parser
from fe_contact.studies.larger_models import MeasuredEffect
from fe_contact.studies.references import Move
from fe_contact.studies.validate import _chart, _study, larger, scenes
from fe_contact.studies.validate._page import _cell, inlined, written
from fe_contact.studies.validate.base import (
    DIFFERS,
    FAILED,
    HOLDS,
    LARGER,
    NOTHING_MEASURED,
    OPEN,
    VERIFIED,
    Column,
    Made,
    Report,
    ReportPart,
    Request,
    parts,
)
from fe_contact.studies.validate.scenes import SceneAnswer, SceneCurve, answered, thinned
from lumped.errors import NotReached
from lumped.result.result import Quantity

TESTS = Path(__file__).parent
BROWSER = runpy.run_path(str(TESTS / "browser.py"))
WAITS_FOR_NOBODY = BROWSER["program"]() is None and not os.environ.get("CI")


def made_up(name: str, ratio: float, **changed: Any) -> SceneAnswer:
    """Finite elements that differ by so much of their bar from an exact force."""
    time = np.linspace(0.0, 1e-3, 41)
    force = 5.0 * np.sin(np.pi * time / time[-1])
    curve = SceneCurve(time, force, np.full_like(time, 0.05))
    differences = tuple(
        Move(name, quantity, 1.0, 1.0 + 0.01 * share, 0.01, share)
        for quantity, share in (("peak_force", ratio), ("duration", 0.5 * ratio), ("restitution", 0.1))
    )
    quantities = {"peak_force": Quantity(5.0, 0.05, "N"), "duration": Quantity(1e-3, 1e-6, "s")}
    found = SceneAnswer(name, "fe", 1e-3, quantities, "ting", differences)
    return replace(found, curves={"fe": curve, "ting": replace(curve, force=1.01 * force)}, **changed)


ANSWERS = [
    made_up("soft-ball", 0.25),
    made_up("<stiff> & ball", 0.75, larger="finite strain", estimate=0.08, key="model.kinematics"),
    SceneAnswer("lost-ball", failure="no answer"),
]


def broken(asked: Request) -> Made:
    raise NotReached("did not converge <here>")


def two_parts(answers: list[SceneAnswer], asked: list[str]) -> dict[str, ReportPart]:
    """The section of scenes with such answers, which notes that it was made, and one that fails."""

    def make(request: Request) -> Made:
        asked.append("scenes")
        return scenes.of_answers(answers, ["long-waves"])

    failing = ReportPart(99, "Broken", "Does it?", "false", broken)
    return {"scenes": replace(scenes.MEMBER, make=make), "broken": failing}


CHART = '<svg width="518pt" viewBox="0 0 518 200"><path id="a" d="M 0 0 L 518 200"/></svg>'
Make = Callable[..., tuple[Path, int, list[str]]]


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Make:
    """The command, on made-up answers: the report's folder, the exit code, which sections were made."""

    def plot(found: object, where: Path) -> None:
        (where / "scenes.svg").write_text(CHART, encoding="utf-8")

    def made(name: str = "report", answers: list[SceneAnswer] = ANSWERS, *options: str) -> tuple[Path, int, list[str]]:
        asked = list[str]()
        monkeypatch.setattr(_chart, "plot_scenes", plot)
        monkeypatch.setattr(_study, "parts", lambda: two_parts(answers, asked))
        here = ["--jobs", "1", "--quiet"]  # what is patched is patched in this process
        return tmp_path / name, main(["validate", "--out", str(tmp_path / name), *here, *options]), asked

    return made


def content(folder: Path) -> dict[str, bytes]:
    """Every file of a report but the one that tells when and where it was made."""
    found = (path for path in folder.rglob("*") if path.is_file() and path.name != "provenance.json")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in found}


def test_the_first_screen_says_what_was_found(make: Make, capsys: pytest.CaptureFixture[str]) -> None:
    folder, code, _ = make()
    said = json.loads((folder / "validate.json").read_text(encoding="utf-8"))
    words = [line["word"] for line in said["headlines"]]
    assert code == 3, "a part failed"
    assert words == [VERIFIED, LARGER, FAILED]
    first, larger, failed = (line["text"] for line in said["headlines"])
    assert first.startswith("2 of 2 scenes")
    assert "6 numbers with an exact answer is 0.75 of its bar: <stiff> & ball" in first
    assert "1 of 3 scenes need a larger model" in larger
    assert "did not converge" in failed
    page = (folder / "index.html").read_text(encoding="utf-8")
    assert "did not converge &lt;here&gt;" in page
    assert NOTHING_MEASURED.replace("'", "&#39;") in page
    out, err = capsys.readouterr()
    assert first in out
    assert "broken failed" in err


def test_a_scene_short_of_its_tolerance_is_complained_of(make: Make, capsys: pytest.CaptureFixture[str]) -> None:
    make("short", [made_up("soft-ball", 0.5, missed="duration within 2 %"), made_up("ball", 0.5)])
    assert "scenes: soft-ball: duration within 2 %" in capsys.readouterr().err
    assert not scenes.of_answers([made_up("ball", 0.5)]).section.missed
    assert scenes.of_answers([ANSWERS[-1]]).section.missed == "lost-ball: no answer: no answer"


def test_nothing_is_verified_that_lies_beyond_its_bar(make: Make) -> None:
    folder, _, _ = make("apart", [made_up("soft-ball", 1.25), made_up("ball", 0.5)])
    lines = json.loads((folder / "validate.json").read_text(encoding="utf-8"))["headlines"]
    assert lines[0]["word"] == DIFFERS
    assert "1 of 2 scenes" in lines[0]["text"]
    assert "all but soft-ball" in lines[0]["text"]
    assert "1.25 of its bar" in lines[0]["text"]


def test_an_answer_that_only_one_side_has_is_apart(make: Make) -> None:
    one = made_up("ball", 0.5)
    undefined = replace(one.differences[0], moved=None)
    folder, _, _ = make("undefined", [replace(one, differences=(undefined, *one.differences[1:]))])
    lines = json.loads((folder / "validate.json").read_text(encoding="utf-8"))["headlines"]
    assert lines[0]["word"] == DIFFERS
    assert "one side has none: ball, peak force" in lines[0]["text"]
    assert make("undefined", [], "--resume")[2] == [], "and it can be read again"


def test_made_twice_it_is_the_same_and_resumed_it_makes_the_rest_alone(make: Make) -> None:
    folder, _, asked = make("one")
    known = content(folder)
    assert asked == ["scenes"]
    assert content(make("two")[0]) == known
    assert make("one", ANSWERS, "--resume")[2] == [], "it is there"
    assert content(folder) == known
    (folder / "sections" / "scenes" / "section.json").unlink()
    assert make("one", ANSWERS, "--resume")[2] == ["scenes"], "it is not whole"
    assert content(folder) == known
    assert make("one", ANSWERS, "--resume", "--quick")[2] == ["scenes"], "another question"
    assert make("one", ANSWERS)[2] == ["scenes"], "all anew"
    assert content(folder) == known


def test_interrupted_it_leaves_the_older_report_whole(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, _, _ = make()
    known = content(folder)

    def stopped(found: object, where: Path) -> None:
        (where / "scenes.csv").write_text("half", encoding="utf-8")
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(scenes, "write", stopped)
        assert make()[1] == 130
    left = content(folder)
    assert {name: left[name] for name in left if name != "sections/scenes/asked.json"} == {
        name: known[name] for name in known if name != "sections/scenes/asked.json"
    }
    make("report", ANSWERS, "--resume")
    assert content(folder) == known


def test_an_unknown_section_is_bad_input(refused: Callable[..., list[str]]) -> None:
    assert "scenes" in refused("validate", "--sections", "scene")[0]


def test_every_section_asks_and_can_be_made_alone() -> None:
    found = parts()
    assert next(iter(found)) == "scenes"
    assert len({one.rank for one in found.values()}) == len(found)
    for part in found.values():
        assert part.question.endswith("?")
        assert part.command.startswith("fe-contact ")


@pytest.mark.tenth
def test_an_exact_answer_and_a_published_one_are_found_for_a_packaged_scene() -> None:
    """By its own settings: without them this one falls short of the default tolerance."""
    found = answered("bar")
    assert not found.missed
    assert found.exact == "bar_waves"
    assert found.ratio <= 1.0
    assert {"fe", "bar_waves"} <= found.curves.keys()
    assert found.published
    assert all(move.agrees for move in found.published)


@given(st.lists(st.tuples(st.floats(1e-3, 1.0), st.floats(-1.0, 1.0), st.floats(0.0, 0.1)), min_size=1, max_size=5))
def test_an_estimate_holds_where_no_larger_model_certainly_changes_more(rows: list[tuple[float, float, float]]) -> None:
    effects = tuple(MeasuredEffect(f"effect {i}", "key", *row) for i, row in enumerate(rows))
    line = larger.headline({"ball": effects, "rod": (MeasuredEffect("unknown", "key", None, 0.5, 0.1),)})
    beyond = [i for i, (estimate, change, error) in enumerate(rows) if abs(change) - error > estimate]
    assert line.word == (DIFFERS if beyond else HOLDS)
    assert not beyond or f"ball, effect {beyond[0]}" in line.text


def test_an_effect_that_no_model_answers_is_told_with_its_reason() -> None:
    assert larger.headline({}).word == OPEN
    lost = MeasuredEffect("finite strain", "model.kinematics=finite", 0.1, reason="the body folds")
    assert larger.sentences({"ball": (lost,)}) == ["ball: finite strain is not measured: the body folds"]
    assert larger.effects_of("bar") == (), "a bar has no larger model"


PAIRS = st.lists(st.tuples(st.floats(-10.0, 10.0), st.floats(0.0, 2.0)), min_size=2, max_size=60)


@given(PAIRS, st.floats(1e-3, 5.0))
def test_a_thinned_curve_misses_no_row_by_more_than_is_allowed(
    pairs: list[tuple[float, float]], allowed: float
) -> None:
    time, columns = np.arange(len(pairs), dtype=float), np.array(pairs).T
    kept = thinned(time, columns, allowed)
    assert {kept[0], kept[-1]} == {0, len(pairs) - 1}
    for column in columns:
        assert np.abs(np.interp(time, time[kept], column[kept]) - column).max() <= allowed * (1.0 + 1e-12)


@given(st.floats(-1e12, 1e12), st.floats(1e-9, 1.0))
def test_a_number_with_its_bar_reads_back_within_a_tenth_of_it(value: float, share: float) -> None:
    error = share * (abs(value) or 1.0)
    text = written(value, error).replace("−", "-")
    raised = dict(zip("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789", strict=True))
    power = re.search(r"·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)$", text)
    shown, bar = text.partition("·")[0].strip("()").split(" ± ")
    scale = 10.0 ** int("".join(map(raised.__getitem__, power[1]))) if power else 1.0
    assert abs(float(shown) * scale - value) <= max(0.1 * error, 1e-6 * abs(value))
    assert float(bar) * scale == pytest.approx(error, rel=0.5)


def test_a_cell_is_read_by_people() -> None:
    """Numbers that stand together are cut like any other, what has no unit has none, a truth is a word."""
    row = {"recomputed": "0.26130577099633384; 8.655998986248772e-05; 5/32", "unit": "1", "kept": "True"}
    assert [_cell(row, Column(key, key)).text for key in row] == ["0.2613; 8.656·10⁻⁵; 5/32", "", "yes"]


def test_a_quick_figure_names_the_quick_command() -> None:
    known = parts()
    for quick in (True, False):
        report = Report(Path(), quick, ())
        assert report.command_of(known["paper"]) == "fe-contact paper", "there a quick answer is the whole one"
        assert report.command_of(known["stability"]) == f"fe-contact stability{' --quick' if quick else ''}"
    for part in known.values():
        if part.quick:
            program, *arguments = Report(Path(), True, ()).command_of(part).split()
            assert program == "fe-contact"
            assert parser().parse_args(arguments).quick


def test_two_figures_of_one_page_share_no_name() -> None:
    inner = '<path id="a" d="M 0.123456 1"/><use href="#a"/><g clip-path="url(#a)"/>'
    svg = f'<?xml?><svg width="3pt" viewBox="0 0 3 3">{inner}</svg>'
    one, other = (inlined(svg, name, 'what "it" shows') for name in ("one", "two"))
    assert set(re.findall(r'id="([^"]+)"', one)) == {"one-a"}
    assert 'href="#one-a"' in one
    assert "url(#one-a)" in one
    assert "one-a" not in other
    assert 'd="M 0.12 1"' in one
    assert "&quot;it&quot;" in one


class Links(HTMLParser):
    """What a page points at, loads, and names."""

    def __init__(self) -> None:
        super().__init__()
        self.links, self.loaded, self.names = list[str](), list[str](), list[str]()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = dict(attributes)
        if "id" in found:
            self.names.append(found["id"] or "")
        if tag == "a":
            self.links.append(found.get("href") or "")
        self.loaded += [found[key] or "" for key in ("src", "srcset", "data") if key in found]
        self.loaded += [found["href"] or ""] if tag == "link" else []


def test_the_page_needs_nothing_but_itself_and_its_links_lead_somewhere(make: Make) -> None:
    folder, _, _ = make()
    links_lead_somewhere(folder)


def links_lead_somewhere(folder: Path) -> None:
    """To a place of the page, of a name that stands there once, or to a file; nothing is loaded from elsewhere."""
    page = (folder / "index.html").read_text(encoding="utf-8")
    found = Links()
    found.feed(page)
    assert all(one.startswith("data:") for one in found.loaded)
    assert not re.search(r"@import|url\((?!#)", page)
    assert len(found.names) == len(set(found.names)), "a name twice"
    assert found.links
    for link in found.links:
        assert link[1:] in found.names if link.startswith("#") else (folder / link).is_file(), link


# in a browser


needs_a_browser = pytest.mark.skipif(
    WAITS_FOR_NOBODY, reason="no Chromium here; on CI, where CI is set, it has to be there"
)


@pytest.fixture
def browser() -> Iterator[Any]:
    with BROWSER["Browser"]() as one:
        yield one


A4 = 718  # pixels between margins of a centimetre
FIGURES = """
[...document.querySelectorAll(".canvas svg, .chart, .gallery svg")].map(one => {
  const box = one.getBoundingClientRect(); return box.width > 40 && box.height > 15; })
"""
RATIOS = "[...document.querySelectorAll('.listing')][0].querySelectorAll('tbody tr:not([hidden])')"
AXE = """
axe.run(document, { resultTypes: ["violations"] }).then(found => found.violations
  .filter(one => one.impact === "serious" || one.impact === "critical")
  .map(one => one.id + ": " + one.nodes.map(node => node.target + " " + node.failureSummary).join("; ")))
"""


@needs_a_browser
def test_a_browser_shows_it(make: Make, browser: Any) -> None:
    folder, _, _ = make()
    assert shows_all(browser, folder) == 4
    sorts_and_filters(browser)
    switches(browser)
    reads_values_off(browser)
    prints(browser)
    assert browser.said == []


@needs_a_browser
def test_a_browser_shows_sections_as_they_are(tmp_path: Path, browser: Any, request: pytest.FixtureRequest) -> None:
    """Nothing here is made up: a quick report, of its quickest section alone but with --full."""
    some = [] if request.config.getoption("--full") else ["--sections", "damper"]
    folder = tmp_path / "report"
    main(["validate", "--quick", "--quiet", "--out", str(folder), *some])
    links_lead_somewhere(folder)
    assert shows_all(browser, folder) >= 1
    prints(browser)
    assert browser.said == []


def shows_all(browser: Any, folder: Path) -> int:
    """How many figures, at every width, in both colours: none without a size, no page wider than the window."""
    counted = set()
    for scheme in ("light", "dark"):
        browser.prefer(scheme)
        for width in BROWSER["WIDTHS"].values():
            browser.resize(width)
            browser.open(folder / "index.html")
            seen = browser.run(FIGURES)
            assert all(seen), width
            assert browser.run("document.documentElement.scrollWidth <= innerWidth"), f"wider than {width}"
            counted.add(len(seen))
        browser.run((TESTS / "vendor" / "axe.min.js").read_text(encoding="utf-8") + ";0")
        assert browser.run(AXE) == []
    (count,) = counted
    return count


def sorts_and_filters(browser: Any) -> None:
    """By its name a column is sorted, by the keyboard too; words leave the rows that hold them all."""
    names = f"[...{RATIOS}].map(row => row.cells[0].textContent)"
    head = "document.querySelectorAll('.listing th button')[7]"
    browser.run(f"{head}.focus()")
    browser.press("Enter")
    assert browser.run(f"{head}.parentElement.ariaSort") == "ascending"
    assert browser.run(names) == ["soft-ball", "<stiff> & ball", "lost-ball"], "empty cells last"
    browser.press("Enter")
    assert browser.run(names) == ["<stiff> & ball", "soft-ball", "lost-ball"]
    words = "document.querySelector('.listing input').value = '%s';"
    heard = "document.querySelector('.listing input').dispatchEvent(new Event('input'));"
    assert browser.run(words % "ball SOFT" + heard + names) == ["soft-ball"]
    assert browser.run("document.querySelector('.listing output').textContent") == "1 row"
    assert len(browser.run(words % "" + heard + names)) == 3


def switches(browser: Any) -> None:
    """Light and dark, and curves on and off."""
    ground = "getComputedStyle(document.body).backgroundColor"
    before = browser.run(ground)
    browser.run("document.getElementById('theme').focus()")
    browser.press("Enter")
    assert browser.run(ground) != before
    drawn = "document.querySelectorAll('.chart .curve').length"
    assert browser.run(drawn) == 2
    assert browser.run(f"document.querySelectorAll('.curves input')[1].click(), {drawn}") == 1


def reads_values_off(browser: Any) -> None:
    """By arrow keys and by pointing: the straight line between rows; zoomed, the axis is shorter."""
    browser.run("document.querySelector('.zoom button:last-child').click(), document.querySelector('.plot').focus()")
    for _ in range(50):
        browser.press("ArrowRight")
    told = browser.run("document.querySelector('.readout').textContent")
    assert "t = 0.5000 ms" in told
    assert re.search(r"finite elements 5\.0000 ± 0\.050 N", told)
    ticks = "[...document.querySelectorAll('.chart text')].map(one => one.textContent)"
    browser.press("+")
    assert browser.run(ticks)[0] == "250", "half of the time, around the cursor"
    browser.press("Escape")
    chosen = "document.querySelectorAll('.gallery button')[1].click(), document.querySelector('.scene').value"
    assert browser.run(chosen) == "<stiff> & ball"
    links = browser.run("[...document.querySelectorAll('.csv a')].map(one => one.getAttribute('href'))")
    assert links[0].endswith("-fe.csv")


def prints(browser: Any) -> None:
    """On paper there are no buttons to press, nothing is cut off, and no table is wider than a page."""
    browser.prefer("light", "print")
    browser.resize(A4)
    assert browser.run("document.documentElement.scrollWidth") <= A4
    assert browser.run("getComputedStyle(document.querySelector('header')).display") == "none"
    assert browser.run("getComputedStyle(document.querySelector('.scroll')).maxHeight") == "none"
