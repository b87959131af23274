"""Rows of studies: kept as they come, from processes that end with the study; resumed byte by byte."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Generator, Mapping
from functools import partial
from multiprocessing import active_children
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fe_contact.errors import ContactNotSettled, WorkerLost
from fe_contact.studies import journal
from fe_contact.studies.journal import measured, rows
from fe_contact.studies.sweep.study import Rows
from fe_contact.studies.workers import Processes, _Worker, tell
from lumped.errors import BadInput, CannotWrite, Fault
from lumped.paper.table1 import Elastic, contact_modulus
from meshes.errors import GmshMissing

SMALL = Path(__file__).with_name("small_studies.py")
STUDIES = ("stability", "tradeoff", "table1", "waves", "exponents", "ring")  # the cheapest ones first
SIGNALS = (signal.SIGINT, signal.SIGKILL, signal.SIGTERM)
TIMED = {"waves", "tradeoff"}  # hold processor times: what else they say stands in their table
LONG = 600.0  # s: who waits for it fails
ORPHAN = 30.0  # s: a process that outlives its study by so much stays


def silent(message: str) -> None:
    """Nobody listens."""


# rows in a file


def moduli(*youngs: float) -> dict[str, partial[float]]:
    return {f"E = {young:g}": partial(contact_modulus, Elastic(young, 0.3)) for young in youngs}


@pytest.fixture
def calls_measured(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of what is measured, as it is."""
    names: list[str] = []

    def told(calls: Mapping[str, partial[Any]], jobs: int) -> Generator[tuple[str, Any], None, None]:
        for name, row in measured(calls, jobs):
            names.append(name)
            yield name, row

    monkeypatch.setattr(journal, "measured", told)
    return names


def test_rows_that_cannot_be_kept_name_their_folder(tmp_path: Path) -> None:
    (tmp_path / "rows").write_text("a file")
    with pytest.raises(CannotWrite, match="rows: File exists"):
        rows(tmp_path / "rows" / "moduli.jsonl", moduli(1.0), silent)
    kept = Rows(tmp_path / "none", known=False)
    with pytest.raises(CannotWrite, match="none: No such file"):
        kept.keep({"digest": {}})


def test_what_is_kept_is_not_measured_again(tmp_path: Path, calls_measured: list[str]) -> None:
    file, heard = tmp_path / "made" / "rows.jsonl", list[str]()
    first = rows(file, moduli(1.0, 2.0), silent)
    both = rows(file, moduli(3.0, 2.0, 1.0), heard.append)
    assert calls_measured == ["E = 1", "E = 2", "E = 3"]
    assert heard == ["E = 2", "E = 1", "E = 3"]
    assert list(both) == ["E = 3", "E = 2", "E = 1"]
    assert both.items() > first.items()


def test_another_suite_measures_anew(
    tmp_path: Path, calls_measured: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    rows(tmp_path / "rows.jsonl", moduli(1.0), silent)
    monkeypatch.setattr(journal, "suite", lambda: "another")
    rows(tmp_path / "rows.jsonl", moduli(1.0), silent)
    assert calls_measured == ["E = 1", "E = 1"]


def test_a_changed_source_is_another_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As are changed data, which lie beside the sources or in their own folder."""
    monkeypatch.setattr("fe_contact.studies.journal.data_folder", lambda: tmp_path)
    digests = set()
    for text in ("radius = 1.0", "radius = 2.0"):
        (tmp_path / "scene.toml").write_text(text)
        digests |= {journal.suite.__wrapped__() for _ in range(2)}
    assert len(digests) == 2


@given(share=st.floats(0.0, 1.0), rubbish=st.binary(max_size=20))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
def test_a_file_cut_anywhere_loses_no_row_but_the_last(
    tmp_path: Path, calls_measured: list[str], share: float, rubbish: bytes
) -> None:
    """Nor does the row which is kept after the cut get lost in the cut line; a disk may have left anything there."""
    file, asked = tmp_path / "rows.jsonl", moduli(1.0, 2.0, 3.0)
    file.unlink(missing_ok=True)
    whole = rows(file, asked, silent)
    text = file.read_bytes()
    cut = round(share * len(text))
    whole_lines = sum(text[:cut].count(b'"row": ' + json.dumps(row).encode() + b"}") for row in whole.values())
    file.write_bytes(text[:cut] + (rubbish if cut < len(text) else b""))
    calls_measured.clear()
    assert rows(file, asked, silent) == whole
    assert 0 <= len(calls_measured) - (3 - whole_lines) <= bool(rubbish)  # which may stand on the last line
    calls_measured.clear()
    assert rows(file, asked, silent) == whole
    assert not calls_measured


def test_what_a_failure_interrupts_keeps_its_rows(tmp_path: Path, calls_measured: list[str]) -> None:
    wrong = {"two bodies": partial(contact_modulus, Elastic(0.0, 0.3))}
    with pytest.raises(ZeroDivisionError):
        rows(tmp_path / "rows.jsonl", moduli(1.0) | wrong | moduli(2.0), silent)
    rows(tmp_path / "rows.jsonl", moduli(1.0, 2.0), silent)
    assert calls_measured == ["E = 1", "E = 2"]


# processes


@pytest.mark.tenth
def test_processes_ask_others_and_what_they_tell_is_heard(tmp_path: Path) -> None:
    heard = list[str]()
    asked = {name: moduli(*youngs) for name, youngs in {"soft": (1.0, 2.0), "stiff": (3.0, 4.0)}.items()}
    calls = {name: partial(rows, tmp_path / name, some, tell, 2) for name, some in asked.items()}
    found = dict(measured(calls, 2, lambda word, *_: heard.append(word)))
    assert found == {name: {one: call() for one, call in some.items()} for name, some in asked.items()}
    assert sorted(heard) == ["E = 1", "E = 2", "E = 3", "E = 4"]


def test_processes_are_killed_when_nobody_asks_any_more() -> None:
    """Though they are at work."""
    found = measured({"short": partial(abs, -1.0), "long": partial(time.sleep, LONG), "other": partial(abs, -2.0)}, 2)
    assert next(found) == ("short", 1.0)
    assert active_children()
    found.close()
    assert not active_children()


@pytest.mark.tenth
def test_a_process_that_dies_is_a_named_failure() -> None:
    with pytest.raises(WorkerLost, match="memory"):
        list(measured({"dies": partial(os._exit, 9), "long": partial(time.sleep, LONG)}, 2))
    assert not active_children()
    assert WorkerLost().exit_code == 3


@pytest.mark.tenth
def test_an_answer_that_cannot_be_sent_is_not_waited_for() -> None:
    with pytest.raises(WorkerLost):
        list(measured({"a file": partial(open, os.devnull), "short": partial(abs, -1.0)}, 2))
    assert not active_children()


def test_a_named_failure_comes_out_of_a_process_as_it_went_in() -> None:
    faults = (Fault("scene.toml", "striker.mass", "missing"), Fault("scene.toml", "target", "missing"))
    sent = {"fe": partial(ContactNotSettled, 0.5, "a lower numerics.penalty"), "input": partial(BadInput, faults)}
    sent |= {"mesh": partial(GmshMissing, "no libGLU")}
    came = dict(measured(sent, 2))
    for name, call in sent.items():
        assert type(came[name]) is call.func
        assert str(came[name]) == str(call())
    assert came["input"].faults == faults
    lost = came["fe"]
    assert isinstance(lost, ContactNotSettled)
    assert str(lost) == f"{lost.reason}; cure: {lost.cure}"
    assert "numerics.steps" in lost.cure
    assert "cure" not in lost.reason


# studies that are killed


def ended(process: subprocess.Popen[str], within: float) -> tuple[str, str]:
    """What it said on stdout and stderr, which end when the last of its processes has: all hold them.

    Fails after a time, s.
    """
    return process.communicate(timeout=within)


def begun(*arguments: object) -> subprocess.Popen[str]:
    """A process that runs small studies; it leads a group of its own, as from a terminal."""
    process = subprocess.Popen(
        [sys.executable, str(SMALL), *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n", ended(process, ORPHAN)
    return process


def kept(where: Path) -> list[str]:
    """The calls whose rows a study's folder keeps."""
    lines = [line for file in where.glob("*.jsonl") for line in file.read_text().splitlines()]
    return [json.loads(line)["call"] for line in lines if line.startswith("{") and line.endswith("}")]


def killed(study: str, where: Path, sent: signal.Signals, count: int, delay: float) -> None:
    """A study that gets a signal some time, s, after so many rows, or ends before."""
    process = begun(study, where)
    while process.poll() is None and len(kept(where)) < count:
        time.sleep(0.005)
    time.sleep(delay)
    if sent is signal.SIGINT:
        os.killpg(process.pid, sent)  # as ^C: every process of the study gets it
    else:
        process.send_signal(sent)
    out, err = ended(process, ORPHAN)
    if sent is signal.SIGINT and "written to" not in out:
        assert (process.returncode, err) == (130, "fe-contact: interrupted\n")


def written(study: str, where: Path) -> dict[str, Any]:
    """What is in the files of a study that is done, but for processor times."""
    if study not in TIMED:
        return {path.name: path.read_bytes() for path in where.iterdir() if path.suffix != ".jsonl"}
    with (where / "tradeoff.csv").open(newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    return {str(place): {key: value for key, value in row.items() if key != "cpu_s"} for place, row in enumerate(table)}


def test_no_process_is_forgotten_while_all_of_them_are_shut_down() -> None:
    """Whoever shuts them down goes through what is known: one that died amid that made a crash of an interrupt."""
    executor, dead = Processes(1), _Worker(Mock(), Mock(**{"send.side_effect": EOFError}))
    executor._idle.get()
    executor._idle.put(dead)
    executor._known.add(dead.process)
    with executor._lock:
        call = executor.submit(os.getpid)
        time.sleep(0.05)
        assert executor._known == {dead.process}
        executor._ended = True
    with pytest.raises(WorkerLost):
        call.result()
    assert not executor._known


@pytest.mark.tenth
def test_killed_studies_resume_byte_by_byte(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """Killed some time after so many rows: no process stays, no row is measured twice, the files are the same."""
    rng = np.random.default_rng(12)
    full = request.config.getoption("--full")
    chosen = [STUDIES[place % len(STUDIES)] for place in range(100 if full else 1)]
    folders = [tmp_path / f"{place}-{study}" for place, study in enumerate(chosen)]
    for place, (study, where) in enumerate(zip(chosen, folders, strict=True)):
        sent = SIGNALS[(place + place // len(STUDIES)) % len(SIGNALS)]
        killed(study, where, sent, int(rng.integers(4)), float(rng.uniform(0.0, 0.5)))
    whole = {study: tmp_path / study for study in chosen}
    resumed = [part for pair in zip(chosen, folders, strict=True) for part in pair]
    process = begun(*resumed, *(part for pair in whole.items() for part in pair))
    _, said = ended(process, len(chosen) * LONG)
    assert process.returncode in (0, 3), said  # small studies may miss their tolerance
    for study, where in zip(chosen, folders, strict=True):
        assert written(study, where) == written(study, whole[study])
        assert len(kept(where)) == len(set(kept(where))) == len(kept(whole[study]))
