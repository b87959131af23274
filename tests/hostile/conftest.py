"""Command lines run by a process that can be ended, and what must hold of every one of them."""

from __future__ import annotations

import json
import os
import re
import select
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest

WORKER = Path(__file__).with_name("worker.py")
MOST_WAIT = 300.0  # s of the clock, for what waits instead of working, or does not hear the worker's own alarm
MOST_SILENCE = 10.0  # s of the clock without a line in the log of a command that is at work
MOST_MEMORY = 10**9
DONE, BAD_INPUT, NOT_REACHED, CUT = 0, 2, 3, "cut"
MOST_LINES, MOST_CHARACTERS = 20, 1500


@dataclass(frozen=True)
class Ended:
    """How a command line ended; `code` is a traceback where it was a failure that escaped.

    `cpu`: s of work; `silent`: s since the last line of its log; `memory`: bytes.
    """

    arguments: Sequence[str]
    code: object
    said: Sequence[str] = ()
    written: Sequence[str] = ()
    crash: str = ""
    cpu: float = 0.0
    silent: float = 0.0
    memory: int = 0


@dataclass
class Worker:
    """Runs command lines one after the other, in a new process where one had to be ended."""

    process: subprocess.Popen[str] | None = None
    environment: dict[str, str] = field(default_factory=lambda: {**os.environ, "PYTHONWARNINGS": "default"})

    def run(self, arguments: Sequence[str]) -> Ended:
        if self.process is None:
            command = [sys.executable, str(WORKER)]
            pipe = subprocess.PIPE
            self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, env=self.environment)
        stdin, stdout = self.process.stdin, self.process.stdout
        assert stdin is not None
        assert stdout is not None
        stdin.write(json.dumps(list(arguments)) + "\n")
        stdin.flush()
        answered, _, _ = select.select([stdout], [], [], MOST_WAIT)
        line = stdout.readline() if answered else ""
        if line:
            return Ended(arguments, **json.loads(line))
        self.end()
        return Ended(arguments, CUT if not answered else "the process died")

    def end(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


@pytest.fixture(scope="session")
def run() -> Iterator[Callable[[Sequence[str]], Ended]]:
    """How a command line ends."""
    worker = Worker()
    yield worker.run
    worker.end()


@pytest.fixture(scope="session")
def hundredth(campaign_size: Callable[..., int]) -> Callable[[int], int]:
    """How many of a campaign's n cases to run: all with --full, a hundredth with --tenth, else a few."""
    return lambda n: campaign_size(campaign_size(n), least=40)


@pytest.fixture(scope="session")
def faults_of() -> Callable[..., list[str]]:
    """What is wrong with how a command line ended; empty where nothing is.

    `named`: what a line of bad input has to begin with, a pattern. `solves`: a command with a log whose work is bounded
    by what it solves, and looked after elsewhere: it may be cut while it tells how far it is.
    """

    def found(ended: Ended, named: str, solves: bool = False) -> list[str]:
        wrong = []
        if ended.code not in (DONE, BAD_INPUT, NOT_REACHED) and not (solves and ended.code == CUT):
            wrong.append(f"exit {ended.code}: {' '.join(ended.said[-1:])} {ended.crash[-600:]}")
        if ended.code == CUT and ended.silent > MOST_SILENCE:
            wrong.append(f"no sign of life for {ended.silent:.0f} s")
        if ended.memory > MOST_MEMORY and not solves:
            wrong.append(f"took {ended.memory / 1e9:.2g} GB")
        wrong += [f"no line for a terminal: {line!r}" for line in ended.said if not fit_for_a_terminal(line)]
        if ended.code == BAD_INPUT:
            wrong += [f"wrote {name}" for name in ended.written]
            wrong += [f"names no key: {line}" for line in ended.said if not re.match(named, line)]
            wrong += [] if 1 <= len(ended.said) <= MOST_LINES else [f"{len(ended.said)} lines"]
        return [f"{' '.join(ended.arguments)[:300]!r}: {reason}" for reason in wrong]

    return found


def fit_for_a_terminal(line: str) -> bool:
    return line.isprintable() and len(line) <= MOST_CHARACTERS and "Warning" not in line
