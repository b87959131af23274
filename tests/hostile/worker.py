"""Runs the command lines that stdin holds as JSON, each in an empty folder, and tells in a line of JSON how each ended.

A process of its own, for its memory is bounded and its clock strikes: see ``conftest.py``.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from pathlib import Path
from types import FrameType
from typing import Any

from fe_contact.cli import main

MOST_MEMORY = 4 * 2**30
# A hang ends: by what it works, as other processes slow it down, or by the clock, where it waits.
MOST_CPU, MOST_TIME = 30, 300


class TooLong(BaseException):
    """No failure of ours catches it."""


def strike(number: int, frame: FrameType | None) -> None:
    raise TooLong(signal.Signals(number).name)


def ended(arguments: list[str], environment: dict[str, str]) -> dict[str, Any]:
    folder = Path(tempfile.mkdtemp())
    out = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    err = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="backslashreplace")
    begun = time.process_time()
    os.chdir(folder)
    signal.setitimer(signal.ITIMER_PROF, MOST_CPU)
    signal.alarm(MOST_TIME)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code: object = main(arguments)
    except SystemExit as stop:
        code = stop.code
    except BaseException as failure:
        code = f"{failure!r} in {traceback.extract_tb(failure.__traceback__)[-1]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.alarm(0)
    written = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    crash = "".join(path.read_text() for path in folder.rglob("crash.txt"))
    os.chdir("/")
    shutil.rmtree(folder, ignore_errors=True)
    err.flush()
    return {
        "code": code,
        "said": err.buffer.getvalue().decode().splitlines(),  # type: ignore[attr-defined]
        "written": written,
        "crash": crash,
        "cpu": time.process_time() - begun,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
    }


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    signal.signal(signal.SIGPROF, strike)
    signal.signal(signal.SIGALRM, strike)
    for line in sys.stdin:
        print(json.dumps(ended(json.loads(line), {})), flush=True)
