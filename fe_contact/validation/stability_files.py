"""What ``fe-contact stability`` keeps: every row as soon as it is known, then a CSV a study and one JSON."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from fe_contact import __version__
from fe_contact.progress import Progress
from fe_contact.validation.stability.base import STUDIES, Case, Row, row
from lumped.csv_file import write_csv
from lumped.json_file import plain, write_json
from lumped.members import available, get

SCHEMA = "fe-contact/stability/1"
KEPT = "stability.jsonl"


def rows_of(quick: bool, jobs: int, where: Path, progress: Progress) -> list[Row]:
    """Every row of every study; those of an earlier, interrupted run are read from ``where``."""
    where.mkdir(parents=True, exist_ok=True)
    done = _read(where / KEPT)
    asked = [(study, case) for study in available(STUDIES) for case in get(STUDIES, study).cases(quick)]
    left = [one for one in asked if _key(*one) not in done]
    with (where / KEPT).open("a", encoding="utf-8") as file:
        for count, found in enumerate(_measured(left, jobs), start=len(asked) - len(left) + 1):
            study, case, measured = found
            done[_key(study, case)] = measured
            file.write(json.dumps({"key": _key(study, case), "row": measured}, allow_nan=False) + "\n")
            file.flush()
            progress("cases", count, len(asked))
    return [done[_key(study, case)] for study, case in asked]


def write_stability(rows: Sequence[Row], where: Path) -> dict[str, Any]:
    """Write ``<study>.csv`` and ``stability.json`` into a folder; the content of the latter."""
    for study in available(STUDIES):
        own = [found for found in rows if found["study"] == study]
        header = list(dict.fromkeys(key for found in own for key in found if key != "study"))
        write_csv(where / f"{study}.csv", header, [[found.get(key) for key in header] for found in own])
    content = {
        "schema": SCHEMA,
        "cases": len(rows),
        "steps": sum(found.get("steps") or 0 for found in rows),
        "iterations": sum(found.get("iterations") or 0 for found in rows),
        "failures": dict(Counter(found["failure"] for found in rows if found["failure"])),
        "rows": list(rows),
    }
    write_json(where / "stability.json", content)
    return content


def _measured(asked: Sequence[tuple[str, Case]], jobs: int) -> Iterator[tuple[str, Case, dict[str, Any]]]:
    """Rows as they come, from some processes or from this one."""
    if jobs == 1 or not asked:
        for study, case in asked:
            yield study, case, plain(row(study, case))
        return
    with ProcessPoolExecutor(jobs) as pool:
        waiting = {pool.submit(row, study, case): (study, case) for study, case in asked}
        try:
            for future in as_completed(waiting):
                yield *waiting[future], plain(future.result())
        finally:
            pool.shutdown(cancel_futures=True)


def _read(path: Path) -> dict[str, Row]:
    """Rows kept before, by key; a line that an interruption cut short is none."""
    found = dict[str, Row]()
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            kept = json.loads(line)
        except json.JSONDecodeError:
            continue
        found[kept["key"]] = kept["row"]
    return found


def _key(study: str, case: Case) -> str:
    """Says which case of which version a row belongs to."""
    return json.dumps([__version__, study, case], sort_keys=True)
