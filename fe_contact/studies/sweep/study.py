"""The answers of a sweep: asked in batches from an executor, kept batch by batch, and read again into one table.

A batch is a file of rows, each under a digest of all that it depends on: the scene's tables, what is set in them, the
method, and the suite that answers. It appears in the folder whole or not at all. So what was finished is never lost,
whoever is killed, and a sweep that goes on, or one that has grown, asks only for the rest.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from hashlib import sha256
from itertools import islice, product
from pathlib import Path

from fe_contact.methods import simulation
from fe_contact.progress import Progress, silent
from fe_contact.studies.journal import suite
from fe_contact.studies.sweep.cases import BaseScene, Sweep
from fe_contact.studies.sweep.table import SweepTable
from fe_contact.studies.workers import answers, checked_jobs, workers
from fe_contact.threads import one_thread
from lumped.errors import BadInput, CannotWrite, FeContactError
from lumped.result.result import UNITS
from lumped.scene.tables import Known
from lumped.schema import Table
from lumped.solvers.hereditary.pieces import Followed, together

DIGITS = 32  # of a digest: no two of 1e18 rows share one
SHARES = 8  # batches of a worker: who is done first waits for an eighth of a share at most
BATCH, MOST = 2.0, 500  # work: s that a batch takes, which is lost with its worker, and its answers; a file each
TOGETHER = 100  # work: answers whose pieces are solved in one array, of some kilobytes each
HELD = 64  # batches held while the table is read, some hundred kilobytes each
# keys, or their last parts, that change no mesh: cases that differ in these alone follow one another
UNMESHED = ("velocity", "mass", "gravity", "direction", "impacts", "end_time")
MATERIAL, MESHED = ".material.", ("nu", "constant")
PART = ".part"  # what a file of rows is called before it is whole


@dataclass(frozen=True)
class Question:
    """One case by one method: what is set in the base scene; ``digest``: of all that the answer depends on."""

    digest: str
    overrides: Mapping[str, object]
    method: str


@dataclass(frozen=True, eq=False)
class Questions:
    """All that a sweep asks, case by case."""

    sweep: Sweep

    @cached_property
    def _shared(self) -> str:
        """A digest of what all answers depend on; of a file that a table names, its content."""
        base = self.sweep.base
        named = {*_texts([base.tables, [axis.places for axis in self.sweep.axes]])}
        files = {text: (base.folder / text).read_bytes().hex() for text in sorted(named) if _is_file(base.folder, text)}
        return _digest([suite(), base.tables, self.sweep.tolerance, files])

    def of(self, case: int) -> Iterator[Question]:
        """One a method, in their order."""
        overrides = self.sweep.overrides(case)
        for method in self.sweep.methods:
            yield Question(_digest([self._shared, overrides, method]), overrides, method)

    def cases(self) -> Iterator[int]:
        """All cases, those of one mesh one after the other: axes that change it are walked slowest."""
        axes = [*zip(self.sweep.axes, self.sweep.strides, strict=True)]
        ordered = sorted(axes, key=lambda one: not any(_meshed(key) for key in one[0].keys))
        for steps in product(*(range(0, len(axis.places) * stride, stride) for axis, stride in ordered)):
            yield sum(steps)


def _digest(content: object) -> str:
    text = json.dumps(content, sort_keys=True, default=str)  # a date of a file is its text
    return sha256(text.encode()).hexdigest()[:DIGITS]


def _texts(value: object) -> Iterator[str]:
    """Every text in tables and lists."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from _texts(tuple(value.values()))
    elif isinstance(value, (list, tuple)):
        for one in value:
            yield from _texts(one)


def _is_file(folder: Path, text: str) -> bool:
    try:
        return (folder / text).is_file()
    except (OSError, ValueError):  # no name of a file
        return False


def _meshed(key: str) -> bool:
    """Whether a key of a scene may change a mesh."""
    last = key.rpartition(".")[2]
    return last in MESHED if MATERIAL in key else last not in UNMESHED and not key.startswith("law.")


class Rows:
    """The rows in a folder, by their digests: files of batches, each whole."""

    def __init__(self, folder: Path, known: bool) -> None:
        """Those that are ``known`` from before count, or none."""
        self._folder, self._files = folder, dict[str, str]()
        self._read = lru_cache(HELD)(partial(_rows_of, folder))
        for path in sorted(folder.glob("*.jsonl")) if known else ():
            self._files |= dict.fromkeys(_rows_of(folder, path.name), path.name)

    def __contains__(self, digest: str) -> bool:
        return digest in self._files

    def __getitem__(self, digest: str) -> Table:
        return self._read(self._files[digest])[digest]

    def keep(self, batch: Mapping[str, Table]) -> None:
        """Rows more, in a file that appears all at once. Raises CannotWrite."""
        name = f"{_digest([*batch])}.jsonl"
        lines = (f"{json.dumps({'digest': digest, 'row': row})}\n" for digest, row in batch.items())
        part = self._folder / f"{name}.{os.getpid()}{PART}"
        try:
            part.write_text("".join(lines), encoding="utf-8")
            part.replace(self._folder / name)
        except OSError as failure:
            raise CannotWrite(self._folder, failure.strerror or str(failure)) from failure
        self._files |= dict.fromkeys(batch, name)

    def tidy(self) -> None:
        """Remove what a killed run left half written."""
        for path in self._folder.glob(f"*{PART}"):
            path.unlink(missing_ok=True)


def _rows_of(folder: Path, name: str) -> dict[str, Table]:
    """The rows of one file; none of a file that a failing disk has spoiled."""
    try:
        lines = (folder / name).read_text(encoding="utf-8").splitlines()
        return {one["digest"]: one["row"] for one in map(json.loads, lines)}
    except (OSError, ValueError, TypeError, KeyError):
        return {}


def answer(base: BaseScene, tolerance: float | None, batch: Iterable[Question]) -> dict[str, Table]:
    """Rows of a batch by their digests, in any process; a failure with a name is a row too."""
    rows, left, known = dict[str, Table](), iter(batch), Known()
    with one_thread:
        while some := [*islice(left, TOGETHER)]:
            begun = time.process_time()
            found = together(_row(base, known, tolerance, question) for question in some)
            share = {"cpu_s": (time.process_time() - begun) / len(some)}
            rows |= {question.digest: row | share for question, row in zip(some, found, strict=True)}
    return rows


def _row(base: BaseScene, known: Known, tolerance: float | None, question: Question) -> Followed[Table]:
    row: Table = {"converged": False, "refused": False, "reason": "", "values": {}}
    try:
        scene, given = base.read(question.overrides, known)
        own = None if "numerics.tolerance" in question.overrides else tolerance
        found = yield from simulation(scene, question.method, given, own)
        row |= {"converged": found.converged, "reason": found.message}
        row["values"] = {name: (one.value, one.error) for name, one in found.quantities.items() if name in UNITS}
    except FeContactError as failure:
        row |= {"refused": isinstance(failure, BadInput), "reason": "; ".join(str(failure).splitlines())}
    except MemoryError:
        row["reason"] = "out of memory; cure: a larger tolerance, fewer numerics.elements_per_contact, or more memory"
    return row


def run(
    sweep: Sweep,
    folder: Path,
    jobs: int = 1,
    dask: str | None = None,
    resume: bool = False,
    progress: Progress = silent,
) -> SweepTable:
    """The table of a sweep: ``jobs`` :func:`workers` are asked for all rows; to ``resume``, for what ``folder`` lacks.

    Raises what these raise, and what only a defect of ours does; the rows until then are kept.
    """
    jobs = checked_jobs(jobs)
    folder.mkdir(parents=True, exist_ok=True)
    questions, rows = Questions(sweep), Rows(folder, resume)

    def left() -> Iterator[Question]:
        return (one for case in questions.cases() for one in questions.of(case) if one.digest not in rows)

    total = sum(1 for _ in left()) if resume else sweep.count * len(sweep.methods)
    if total:
        with workers(min(jobs, total), dask) as (executor, count):
            _ask(sweep, left(), total, rows, executor, count, progress)
    rows.tidy()
    return SweepTable.of(
        sweep, ((case, [rows[one.digest] for one in questions.of(case)]) for case in questions.cases())
    )


def _ask(
    sweep: Sweep, left: Iterator[Question], total: int, rows: Rows, executor: Executor, count: int, progress: Progress
) -> None:
    """Ask so many workers for the ``total`` rows that are left, and keep them batch by batch.

    Two batches are asked of each, so that none waits; one of a lone worker, so that progress is told after each.
    """
    ahead = 2 * count if count > 1 else 1
    most, done, failed, spent, begun = min(MOST, total // (SHARES * count)), 0, 0, 0.0, time.monotonic()

    def calls() -> Iterator[tuple[int, Callable[[], dict[str, Table]]]]:
        while batch := tuple(islice(left, max(1, min(most, int(BATCH * done / spent) if spent else 1)))):
            yield len(batch), partial(answer, sweep.base, sweep.tolerance, batch)

    for answered, batch in answers(executor, calls(), ahead):
        rows.keep(batch)
        done += answered
        failed += sum(not row["converged"] for row in batch.values())
        spent += sum(row["cpu_s"] for row in batch.values())
        progress(f"{done / (time.monotonic() - begun):.3g} a second, {failed} without a result", done, total)
