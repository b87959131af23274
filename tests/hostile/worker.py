"""Runs the command lines that stdin holds as JSON, each in an empty folder, and tells in a line of JSON how each ended.

A process of its own: its memory is bounded, and who waits for it can end it.
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
MOST_CPU = 10  # s of this process's work, which others on the machine slow down but little
CUT = "cut"
LOG = "progress.log"  # of a command that may have one


class Cut(BaseException):
    """No failure of ours catches it."""


def cut(number: int, frame: FrameType | None) -> None:
    raise Cut


def ended(arguments: list[str]) -> dict[str, Any]:
    folder = Path(tempfile.mkdtemp())
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", errors) for errors in ("strict", "backslashreplace"))
    os.chdir(folder)
    Path("/proc/self/clear_refs").write_text("5")  # the peak of the memory begins anew
    begun = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, MOST_CPU)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code: object = main(arguments)
    except SystemExit as stop:  # argparse
        code = stop.code
    except Cut:
        code = CUT
    except BaseException:  # noqa: BLE001 - what escapes the command line is what is looked for
        code = traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    spent = time.process_time() - begun
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    crash = "".join(path.read_text() for path in files if path.name == "crash.txt")
    written = [str(path.relative_to(folder)) for path in files if path.name != LOG]
    silent = time.time() - max((path.stat().st_mtime for path in files if path.name == LOG), default=0.0)
    os.chdir("/")
    shutil.rmtree(folder)
    err.seek(0)
    said = err.read().splitlines()
    told = {"code": code, "said": said, "written": written, "crash": crash}
    return {**told, "cpu": spent, "silent": silent, "memory": peak_memory()}


def peak_memory() -> int:
    """Bytes since it began anew."""
    (line,) = (line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
    return 1024 * int(line.split()[1])


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    signal.signal(signal.SIGPROF, cut)
    for line in sys.stdin:
        sys.stdout.write(json.dumps(ended(json.loads(line))) + "\n")
        sys.stdout.flush()
