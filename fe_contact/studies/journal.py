"""How a study comes by its rows: measured by several processes, kept on disk one by one, taken from there again.

A row is what a call gives: a function of the suite and its arguments. It is kept the moment it is known, as a line of a
file of its study, under its call and the suite that answered. So a study that was interrupted measures the rest alone,
and what is asked of another suite, of another scene or with other settings is measured anew.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Generator, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import closing, contextmanager
from functools import cache, partial
from hashlib import sha256
from importlib.util import find_spec
from itertools import islice
from multiprocessing import connection, get_context, resource_tracker
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from fe_contact.errors import WorkerLost
from fe_contact.progress import Progress
from fe_contact.threads import one_thread
from lumped.result.result import provenance
from lumped.schema import Table
from lumped.schema.files import data_folder
from lumped.schema.json_file import decoded, encoded

PACKAGES = ("lumped", "meshes", "fe_contact")
SOURCES = (".py", ".toml", ".csv")
R = TypeVar("R")


def rows(file: Path, calls: Mapping[str, partial[R]], progress: Progress, jobs: int = 1) -> dict[str, R]:
    """What every call gives, by its name and in their order; what `file` keeps is not measured again.

    `calls` are of functions of a module, annotated with what they return. A positional argument is what the row depends
    on, and its `repr` says all of it; a keyword only saves work. `progress` hears the name of every row once. Raises
    WorkerLost, and what a call raises; the rows until then are kept.
    """
    known = _kept(file)
    for name in (name for name, call in calls.items() if _said(call) in known):
        progress(name)
    left = {name: call for name, call in calls.items() if _said(call) not in known}
    with closing(measured(left, jobs)) as found:
        for name, row in found:
            call = left[name]
            line = json.dumps({"suite": _suite(), "call": _said(call), "row": encoded(row, call.args)})
            _keep(file, line)
            known[_said(call)] = json.loads(line)["row"]  # as another run reads it
            progress(name)
    return {name: _row(call, known[_said(call)]) for name, call in calls.items()}


def _row(call: partial[R], content: Any) -> R:
    row: R = decoded(get_type_hints(call.func)["return"], content, call.args)
    return row


def _said(call: partial[Any]) -> str:
    """A call in words: all that its row depends on, but for the suite."""
    return f"{call.func.__module__}.{call.func.__qualname__}({', '.join(map(repr, call.args))})"


@cache
def _suite() -> str:
    """A digest of the suite, of its data and of the versions beneath it."""
    specs = [find_spec(package) for package in PACKAGES]
    folders = [Path(place) for spec in specs if spec for place in spec.submodule_search_locations or ()]
    found = {path for folder in (*folders, data_folder()) for path in folder.rglob("*") if path.suffix in SOURCES}
    digest = sha256(repr(provenance()).encode())
    for path in sorted(found):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _kept(file: Path) -> Table:
    """Rows by their calls; a line that an interruption cut short is none, nor is another suite's."""
    found = {}
    for line in file.read_text(encoding="utf-8", errors="replace").splitlines() if file.exists() else ():
        try:
            content = json.loads(line)
        except json.JSONDecodeError:
            continue
        if isinstance(content, dict) and content.get("suite") == _suite():
            found[content["call"]] = content["row"]
    return found


def _keep(file: Path, line: str) -> None:
    """A line more, at once; a line's end before it parts it from one that was cut short."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("ab", buffering=0) as lines:  # in one call: no line of another run comes between
        lines.write(f"\n{line}".encode())


def measured(calls: Mapping[str, partial[R]], jobs: int) -> Generator[tuple[str, R], None, None]:
    """Names and results of calls as they come, from so many processes; from this one where one is enough.

    The processes are killed when the caller stops, fails or is interrupted: close the iterator then. They also end
    when this process is killed itself. Raises WorkerLost, and whatever a call raises.
    """
    if min(jobs, len(calls)) < 2:
        for name, call in calls.items():
            with one_thread:
                found = call()
            yield name, found
        return
    left, asked = iter(calls.items()), dict[Any, str]()  # the calls that are at work, by the line to their process
    workers: list[BaseProcess] = []
    try:
        with _signals_held():  # a process that is interrupted while it starts would print how far it came
            for name, call in islice(left, jobs):
                worker, line = _started()
                workers.append(worker)
                asked[line] = name
                line.send(call)
        while asked:
            ready = connection.wait(list(asked))
            for line in [one for one in asked if one in ready]:
                name = asked.pop(line)
                failure, found = line.recv()
                for following, call in islice(left, 1):
                    asked[line] = following
                    line.send(call)
                if failure is not None:
                    raise failure
                yield name, found
    except (EOFError, ConnectionError):
        raise WorkerLost from None
    finally:
        with _signals_held():
            for worker in workers:
                worker.kill()
        for worker in workers:
            worker.join()


def _started() -> tuple[BaseProcess, connection.Connection]:
    """A process that answers calls, and the line to it.

    A pool of the standard library would need semaphores, which some systems refuse to a user.
    """
    context = get_context("spawn")
    ours, its = context.Pipe()
    worker = context.Process(target=_answer, args=(its,), daemon=True)
    worker.start()
    its.close()
    return worker, ours


@contextmanager
def _signals_held() -> Iterator[None]:
    """Signals that end this process come afterwards; processes started meanwhile hold them too."""
    if sys.platform == "win32":
        yield
        return
    resource_tracker.ensure_running()  # starts with the first process else, and lets signals through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _answer(line: connection.Connection) -> None:
    """In a new process: what calls give, or how they fail, until nobody asks any more, as without a parent.

    A second thread measures, so that this one hears the line's end at once. An interrupt is the parent's to answer.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})

    def said(done: Future[Any]) -> None:
        failure, sent = done.exception(), False
        try:
            line.send((failure, None if failure else done.result()))
            sent = True
        finally:
            if not sent:  # nothing else would be heard, and waited for without end
                os._exit(1)

    measuring = ThreadPoolExecutor(1, initializer=one_thread.__enter__)  # for as long as this process lives
    try:
        while True:
            measuring.submit(line.recv()).add_done_callback(said)
    except EOFError:
        os._exit(1)
