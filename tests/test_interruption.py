"""What a shell sees of signals, full disks and closed streams: an exit code and at most one line, no traceback."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumped.result.folder import checksum

ROOT = Path(__file__).resolve().parent.parent
FAST = ("run", "polymer-sphere", "--method", "ting", "--out", "results")
SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}
# Never comes back, and answers no signal, as a mesh generator may.
DEAF = """
import hashlib, sys
from dataclasses import replace
from fe_contact import cli
from fe_contact.commands import laws
def execute(args):
    print("begun", flush=True)
    hashlib.pbkdf2_hmac("sha256", b"", b"", 2**31 - 1)
laws.MEMBER = replace(laws.MEMBER, execute=execute)
sys.exit(cli.main(["laws"]))
"""
# A signal reaches Python while it cleans up, where nothing can be raised.
CLEANING = """
import signal, sys, time
from dataclasses import replace
from fe_contact import cli
from fe_contact.commands import laws
class Cleaned:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)
def execute(args):
    print("begun", flush=True)
    Cleaned()
    time.sleep(60)
laws.MEMBER = replace(laws.MEMBER, execute=execute)
sys.exit(cli.main(["laws"]))
"""


def begun(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "fe_contact", *arguments]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(folder: Path, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "fe_contact", *arguments]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    return subprocess.run(command, cwd=folder, text=True, check=False, timeout=120, **streams)


def state(folder: Path) -> dict[str, str]:
    """Every file and its checksum."""
    return {path.name: checksum(path) for path in folder.iterdir() if path.is_file() and path.name[0] != "."}


def is_whole(folder: Path) -> bool:
    """The record names all other files, and truly."""
    found = state(folder)
    del found["result.json"]
    files: dict[str, str] = json.loads((folder / "result.json").read_text())["files"]
    return found == files


@pytest.mark.family
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_answered_by_one_line_even_in_a_library_that_does_not_come_back(number: signal.Signals) -> None:
    run = subprocess.Popen(
        [sys.executable, "-c", DEAF], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    with run:
        assert run.stdout is not None
        assert run.stdout.readline() == "begun\n"
        run.send_signal(number)
        _, err = run.communicate(timeout=60)
        assert run.returncode == SIGNALS[number]
        assert len(err.splitlines()) == 1, err


@pytest.mark.tenth
def test_a_signal_while_python_cleans_up_is_answered_by_one_line() -> None:
    run = subprocess.run(
        [sys.executable, "-c", CLEANING], cwd=ROOT, capture_output=True, text=True, check=False, timeout=60
    )
    assert run.returncode == SIGNALS[signal.SIGINT]
    assert run.stderr == "fe-contact: interrupted\n"


@pytest.mark.tenth
def test_a_run_killed_at_any_moment_leaves_a_whole_result(empty: Path, campaign_size: Callable[..., int]) -> None:
    """Over older results of another kind, by every signal, from its start to its end."""
    rng = np.random.default_rng(77)
    assert ended(empty, *FAST, "--plot").returncode == 0
    results = empty / "results"
    for _ in range(campaign_size(100, most=6)):
        number = list(SIGNALS)[rng.integers(len(SIGNALS))]
        run = begun(empty, *FAST, "--set", f"striker.velocity={rng.uniform(0.01, 0.1):.6f}")
        with run:
            try:
                run.wait(timeout=float(rng.uniform(0.2, 1.2)))
            except subprocess.TimeoutExpired:
                run.send_signal(number)
            _, err = run.communicate(timeout=60)
            assert run.returncode in (0, SIGNALS[number], -number), err
            assert "Traceback" not in err or run.returncode == -number  # before Python runs a line of ours
        assert is_whole(results), number
    assert ended(empty, *FAST).returncode == 0
    assert {path.name for path in results.iterdir()} == {"history.csv", "result.json"}


@pytest.mark.tenth
def test_a_limit_of_a_files_size_is_one_line_and_the_older_result_stays(empty: Path) -> None:
    assert ended(empty, *FAST).returncode == 0
    older = state(empty / "results")
    small = (10_000, resource.RLIM_INFINITY)
    done = ended(empty, *FAST, "--plot", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, small))
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "results" in done.stderr
    assert "File too large" in done.stderr
    assert state(empty / "results") == older


def test_a_full_stdout_is_one_line(empty: Path) -> None:
    with Path("/dev/full").open("w") as full:
        done = ended(empty, "laws", stdout=full)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "No space left" in done.stderr


def test_a_closed_stdout_is_refused_before_the_work(empty: Path) -> None:
    shell = f'exec "{sys.executable}" -m fe_contact {" ".join(FAST)} >&-'
    done = subprocess.run(["sh", "-c", shell], cwd=empty, stderr=subprocess.PIPE, text=True, check=False, timeout=120)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert not (empty / "results").exists()


@pytest.mark.tenth
def test_a_reader_that_leaves_ends_nothing_but_the_talk(empty: Path) -> None:
    shell = f'"{sys.executable}" -m fe_contact {" ".join(FAST)} | true; echo "${{PIPESTATUS[0]}}"'
    done = subprocess.run(["bash", "-c", shell], cwd=empty, capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout == "0\n"
    assert "Traceback" not in done.stderr
    assert is_whole(empty / "results")


def test_too_little_memory_is_one_line(empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from fe_contact.cli import main

    def greedy(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("fe_contact.reference.certify", greedy)
    assert main(["run", "polymer-sphere"]) == 3


def test_a_crash_that_can_be_written_nowhere_is_still_one_line(
    empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from fe_contact.cli import main

    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("a wire came loose")

    def refused(*_: object, **__: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr("fe_contact.reference.certify", broken)
    monkeypatch.setattr(Path, "write_text", refused)
    assert main(["run", "polymer-sphere"]) == 1
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert "a wire came loose" in err


@pytest.mark.tenth
def test_a_home_that_cannot_be_written_is_nothing_to_talk_about(empty: Path) -> None:
    home = {**os.environ, "HOME": "/proc/self", "XDG_CACHE_HOME": "", "XDG_CONFIG_HOME": "", "MPLCONFIGDIR": ""}
    done = ended(empty, *FAST, "--plot", env=home)
    assert done.returncode == 0
    assert "atplotlib" not in done.stderr
    assert is_whole(empty / "results")
