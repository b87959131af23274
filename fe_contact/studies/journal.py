"""How a study comes by its rows: measured by several processes, kept on disk one by one, taken from there again.

A row is what a call gives: a function of the suite and its arguments. It is kept the moment it is known, as a line of a
file of its study, under its call and the suite that answered. So a study that was interrupted measures the rest alone,
and what is asked of another suite, of another scene or with other settings is measured anew.
"""

from __future__ import annotations

import json
from collections.abc import Generator, Mapping
from contextlib import closing
from functools import cache, partial
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from fe_contact.progress import Progress, silent
from fe_contact.studies.workers import answers, workers
from lumped.errors import CannotWrite
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
    WorkerLost, CannotWrite, and what a call raises; the rows until then are kept.
    """
    known = _kept(file)
    for name in (name for name, call in calls.items() if _said(call) in known):
        progress(name)
    left = {name: call for name, call in calls.items() if _said(call) not in known}
    with closing(measured(left, jobs)) as found:
        for name, row in found:
            call = left[name]
            line = json.dumps({"suite": suite(), "call": _said(call), "row": encoded(row, call.args)})
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
def suite() -> str:
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
        if isinstance(content, dict) and content.get("suite") == suite():
            found[content["call"]] = content["row"]
    return found


def _keep(file: Path, line: str) -> None:
    """A line more, at once; a line's end before it parts it from one that was cut short. Raises CannotWrite."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with file.open("ab", buffering=0) as lines:  # in one call: no line of another run comes between
            lines.write(f"\n{line}".encode())
    except OSError as failure:
        raise CannotWrite(file.parent, failure.strerror or str(failure)) from failure


def measured(
    calls: Mapping[str, partial[R]], jobs: int, heard: Progress = silent
) -> Generator[tuple[str, R], None, None]:
    """Names and results of calls as they come, from so many processes; from this one where one is enough.

    What calls of other processes tell is ``heard``; see :func:`fe_contact.studies.workers.tell`.

    The processes are killed when the caller stops, fails or is interrupted: close the iterator then. They also end
    when this process is killed itself. Raises WorkerLost, and whatever a call raises.
    """
    processes = max(1, min(jobs, len(calls)))
    with workers(processes, heard=heard) as (executor, ahead):
        yield from answers(executor, calls.items(), ahead)
