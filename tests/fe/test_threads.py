"""BLAS has one thread inside every front door, its user's own number outside, and the bytes never tell which."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Barrier, Thread
from typing import Any

import pytest
import scipy.linalg  # noqa: F401 - scipy's own BLAS
from threadpoolctl import threadpool_info, threadpool_limits

import fe_contact
import fe_contact.indentation
from fe_contact.studies import journal
from fe_contact.threads import one_thread
from lumped import Scene
from lumped.scene.indenter import Indenter

SETTINGS = ("1", "2", None)
IMPACT = """
import numpy, scipy.linalg
import fe_contact, lumped
history = fe_contact.run(lumped.Scene.load("polymer-sphere"), tolerance=1e-2).history
print(*(column.tobytes().hex() for column in (history.time, history.depth, history.force)))
"""


def environment(threads: str | None) -> dict[str, str]:
    others = {key: value for key, value in os.environ.items() if "NUM_THREADS" not in key}
    return others if threads is None else {**others, "OPENBLAS_NUM_THREADS": threads}


def run(*arguments: str, threads: str | None, folder: Path) -> str:
    command = [sys.executable, *arguments]
    done = subprocess.run(command, env=environment(threads), cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def blas_threads() -> set[int]:
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


@pytest.mark.tenth
def test_python_gives_the_same_bytes_whatever_was_imported_first(tmp_path: Path) -> None:
    found = {run("-c", IMPACT, threads=threads, folder=tmp_path) for threads in SETTINGS}
    assert len(found) == 1
    assert len(found.pop()) > 1000


@pytest.mark.tenth
def test_the_command_line_gives_the_same_bytes(tmp_path: Path) -> None:
    asked = ("-m", "fe_contact", "indent", "polymer-layer", "--depths", "1e-5,2e-5,4e-5", "--quiet", "--out")
    for threads in SETTINGS:
        run(*asked, str(tmp_path / str(threads)), threads=threads, folder=tmp_path)
    assert len({(tmp_path / str(threads) / "indentation.csv").read_bytes() for threads in SETTINGS}) == 1


@pytest.fixture
def two() -> Any:
    """Two threads, as a user may have set; and a look at them from within."""
    with threadpool_limits(2, user_api="blas"):
        yield
        assert blas_threads() == {2}


@pytest.mark.usefixtures("two")
def test_every_front_door_has_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    inside: list[set[int]] = []

    def look(*_: Any) -> Any:
        inside.append(blas_threads())
        return {}

    monkeypatch.setattr("fe_contact.methods.simulate", look)
    fe_contact.run(Scene.load("steel-ball"))
    monkeypatch.setattr("fe_contact.indentation.check_kind", lambda *_: 1 / len(look()))
    with pytest.raises(ZeroDivisionError):
        fe_contact.indentation.indent(Indenter.load("steel-ball"), (1e-6,), {})
    dict(journal.measured({"a row of a study": partial(look)}, jobs=1))
    for _, found in journal.measured({name: partial(threadpool_info) for name in "ab"}, jobs=2):
        inside.append({library["num_threads"] for library in found if library["user_api"] == "blas"})
    assert inside == [{1}] * 5
    assert blas_threads() == {2}


@pytest.mark.tenth
def test_a_process_that_is_started_has_one_thread_and_loads_no_more_than_its_call() -> None:
    heavy = "sorted({'scipy.linalg', 'threadpoolctl', 'matplotlib', 'skfem'} & {*__import__('sys').modules})"
    calls = {"loaded": partial(eval, heavy), "limits": partial(os.getenv, "OPENBLAS_NUM_THREADS")}
    before = dict(os.environ)
    assert dict(journal.measured(calls, jobs=2)) == {"loaded": [], "limits": "1"}
    assert dict(os.environ) == before


def test_the_last_one_out_restores_the_number() -> None:
    """Two threads of a process, each in a run of its own, one leaving while the other is still inside."""
    before = blas_threads()
    both_in, one_out, seen = Barrier(2, timeout=60.0), Barrier(2, timeout=60.0), []

    def first() -> None:
        with one_thread:
            both_in.wait()
        one_out.wait()

    def second() -> None:
        with one_thread:
            both_in.wait()
            one_out.wait()
            seen.append(blas_threads())

    runs: list[Callable[[], None]] = [first, second]
    threads = [Thread(target=run) for run in runs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [{1}]
    assert blas_threads() == before
