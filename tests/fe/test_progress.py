"""What long work tells: one line in place, a log with times, steps counted of those expected."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fe_contact import cli
from fe_contact.cli import main
from fe_contact.commands import base
from fe_contact.methods import simulate
from fe_contact.plastic.impact import PILOT
from fe_contact.progress import OFTEN, Count, Log, ProgressLine, clear
from fe_contact.reference import solve
from lumped import Scene
from lumped.pounding import study as pounding
from lumped.pounding.case_file import load as load_pounding
from lumped.ptmd import study as ptmd
from lumped.ptmd.case_file import load as load_ptmd


class Clock:
    """A time that goes on when it is told to."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def screen(written: str) -> str:
    """What a terminal shows in its line after all that was written."""
    shown = ""
    for part in written.split("\r"):
        shown = part + shown[len(part) :]
    return shown


def test_a_terminal_shows_one_line_never_wider_than_itself() -> None:
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(stream, clock, lambda: 30)
    for done in range(5):
        clock.now += 1.0
        line("a message that is longer than the terminal is wide" if done % 2 else "short", done, 4)
        shown = stream.getvalue()
        assert "\n" not in shown
        assert all(len(part) < 30 for part in shown.split("\r"))
    assert screen(stream.getvalue()).rstrip() == "fe-contact: 4 of 4, short ..."
    clear()
    assert not screen(stream.getvalue()).strip(), "nothing is left of it"
    length = len(stream.getvalue())
    clear()
    assert len(stream.getvalue()) == length, "nothing more to clear"


def test_the_time_left_is_that_of_the_rest_at_the_same_pace() -> None:
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(stream, clock, lambda: 80)
    line("steps", 0, 10)
    clock.now += 6.0
    line("steps", 2, 10)
    assert "2 of 10, about 24 s left, steps" in screen(stream.getvalue())
    line("another part", 0, 3)
    clock.now += 600.0
    line("another part", 1, 3)
    assert "1 of 3, about 20 min left" in screen(stream.getvalue()), "counted from its own begin"


@pytest.mark.parametrize("expected", [5_000, 10_000])
def test_ten_thousand_steps_write_a_few_words(expected: int) -> None:
    """Told at every step, at a rate that costs nothing: five words a second, and the end, wherever it was expected."""
    stream, clock = io.StringIO(), Clock()
    count = Count(ProgressLine(stream, clock, lambda: 80), "steps", expected)
    for _ in range(10_000):
        clock.now += 1e-3
        count()
    assert stream.getvalue().count("\r") <= 10.0 / OFTEN + 2
    assert "10000 of 10000" in screen(stream.getvalue()) or expected < 10_000


def test_more_steps_than_expected_are_no_more_than_all() -> None:
    stream, clock = io.StringIO(), Clock()
    count = Count(ProgressLine(stream, clock, lambda: 80), "steps", 2)
    for _ in range(3):
        clock.now += 1.0
        count()
    assert "3 of 3" in screen(stream.getvalue())


def test_a_log_has_a_line_a_word_with_times_and_shares() -> None:
    stream, clock = io.StringIO(), Clock()
    log = Log(stream.write, clock)
    log("begun")
    clock.now += 2.0
    log("rows", 1, 4)
    clock.now += 3.0
    log("rows", 2, 4)
    log("rows", 3, 4)
    log("impacts", 12)
    first, second, third, fourth = stream.getvalue().splitlines()
    assert first.endswith("Z, 0.0 s, begun")
    assert second.endswith("Z, 2.0 s, rows, 1 of 4")
    assert third.endswith("Z, 5.0 s, rows, 2 of 4, about 3 s left")
    assert fourth.endswith("Z, 5.0 s, impacts, 12"), "nobody knows of how many"


@pytest.mark.parametrize("name", ["polymer-sphere", "ball-bouncing"])
def test_an_impact_tells_the_steps_of_all_its_marches(name: str) -> None:
    told = list[tuple[str, float, float]]()
    solved = solve(Scene.load(name), {}, lambda *word, **_: told.append((*word, 0.0, 0.0)[:3]))
    assert told[0][0] == "what to expect of the contact"
    marches = [word for word in told if word[0] != told[0][0]]
    first = [(done, total) for message, done, total in marches if message == marches[0][0] and done > 0.0]
    steps = list(dict.fromkeys(done for done, _ in first))
    assert steps == list(range(1, len(steps) + 1)), "every step"
    assert 0.3 < steps[-1] / first[0][1] < 3.0, "as many as were expected"
    assert len(told) > solved.certified.work.steps


def test_a_plan_tells_the_steps_of_its_coarse_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what yields, which takes seconds, and many where it yields far."""
    told = list[tuple[str, float, float]]()
    monkeypatch.setattr(base, "progress_of", lambda _: lambda *word, **_: told.append((*word, 0.0, 0.0)[:3]))
    assert main(["plan", "steel-ball-plastic", "--set", "striker.velocity=0.05", "--quiet"]) == 0
    steps = [done for message, done, _ in told if message == "what to expect of the contact"]
    assert steps == list(range(len(steps)))
    assert len(steps) > PILOT["steps"]


def test_waves_tell_their_cost_and_their_steps() -> None:
    told = list[tuple[str, float, float]]()
    given = {"tolerance": 0.03, "elements_per_contact": 3.0, "steps": 64}
    scene = Scene.load("polymer-sphere-waves")
    simulate(scene, "fe", given, progress=lambda *word, **_: told.append((*word, 0.0, 0.0)[:3]))
    assert "GB" in next(message for message, *_ in told if message != told[0][0])
    done, total = told[-1][1:]
    assert 0.5 < done / total <= 1.0


@pytest.mark.parametrize("name", ["rod", "bar-impact"])
def test_waves_along_a_line_tell_every_step(name: str) -> None:
    """A heavy striker's contact may take minutes of them; nobody knows how many there will be."""
    told = list[tuple[str, float, float]]()
    found = simulate(Scene.load(name), "fe", {}, progress=lambda *word, **_: told.append((*word, 0.0, 0.0)[:3]))
    message = f"steps of waves along a line (numerics.steps = {found.numerics['steps']})"
    steps = [(done, total) for what, done, total in told if what == message and done > 0.0]
    assert steps == [(number, 0.0) for number in range(1, len(steps) + 1)]
    assert len(steps) >= found.numerics["steps"] // 2


LASTING = {
    "correspondence": ("polymer-sphere", {"model.gravity": 9.81, "motion.impacts": 3}),
    "tsuji": ("polymer-sphere", {"model.gravity": -1e3}),  # asks mdr for its restitution
    "hertz": ("polymer-sphere", {}),
    "ting": ("polymer-sphere", {}),
    "mdr": ("polymer-sphere", {}),
    "rod_waves": ("rod", {}),
    "bar_waves": ("bar", {}),
}


@pytest.mark.parametrize("law", LASTING)
def test_a_law_tells_every_step_that_it_tries(law: str) -> None:
    """Contacts that settle, and rows of many springs, may take a minute of them."""
    told = list[tuple[str, float, float]]()
    name, overrides = LASTING[law]
    found = simulate(
        Scene.load(name, overrides), law, {}, progress=lambda *word, **_: told.append((*word, 0.0, 0.0)[:3])
    )
    assert told[0] == (f"time steps of {law}", 0.0, 0.0)
    assert told[1:] == [(f"time steps of {law}", number, 0.0) for number in range(1, len(told))]
    assert len(told) > found.work.get("steps", 1), "a word a step, or more"


@pytest.mark.parametrize("place", ["missing/log", "."])
def test_a_log_that_cannot_be_written_is_refused_before_the_work(
    place: str, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["run", "steel-ball", "--log", place]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"--log: {place}: ")
    assert said.endswith("; accepted: a file that can be written\n")
    assert "Errno" not in said
    assert not list(empty.iterdir())


def test_a_log_is_written_where_nobody_watches(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["run", "steel-ball", "--log", "log.txt", "--quiet"]) == 0
    lines = Path("log.txt").read_text(encoding="utf-8").splitlines()
    assert "what to expect" in lines[0]
    assert " steps, " in lines[1]
    assert not [line for line in capsys.readouterr().err.splitlines() if "..." in line]


def test_a_log_on_a_full_disk_says_so_once_and_costs_no_result(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["run", "steel-ball", "--log", "/dev/full", "--out", "results"]) == 0
    said = [line for line in capsys.readouterr().err.splitlines() if line.startswith("--log")]
    assert len(said) == 1
    assert said[0].startswith("--log: /dev/full: No space left on device; ")
    assert Path("results/result.json").exists()


@pytest.mark.parametrize(
    ("study", "case", "marches"),
    [
        (pounding.study, load_pounding("published-release"), ("linear_spring", "no contact")),
        (
            ptmd.study,
            replace(load_ptmd("paper"), end_time=1.0, window=0.5),
            (ptmd.FULL, ptmd.PLAIN, ptmd.BARE, "finer steps"),
        ),
    ],
)
def test_a_motion_tells_how_far_it_is(study: Any, case: Any, marches: tuple[str, ...]) -> None:
    """Every march from its start towards its end, never back."""
    told = dict[str, list[tuple[float, float]]]()
    study(case, progress=lambda message, done, total: told.setdefault(message, []).append((done, total)))
    assert tuple(told) == marches
    for words in told.values():
        done, totals = zip(*words, strict=True)
        assert len(set(totals)) == 1
        assert done[0] == 0.0
        assert list(done) == sorted(done)
        assert 0.5 * totals[0] < done[-1] < totals[0]
