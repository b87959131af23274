"""The report: its sections made one after the other, each in a folder of its own, and the page of all of them.

A section's folder holds the files of its study, ``section.json``, what the page shows of them, and ``asked.json``, what
it was asked of which suite. They appear all at once: a section that was interrupted is not there, and one that is there
is whole. Rows that a study keeps stay beside them until the report is asked for anew.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Sequence
from pathlib import Path

from fe_contact import __version__
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.validate._page import page
from fe_contact.studies.validate.base import (
    FAILED,
    FOLDER,
    Chapter,
    Headline,
    Report,
    ReportPart,
    Request,
    Section,
    parts,
)
from lumped.errors import BadInput, CannotWrite, Fault, FeContactError, nearest
from lumped.result.folder import checksum, publish
from lumped.result.result import provenance
from lumped.schema import Table
from lumped.schema.json_file import decoded, encoded, plain, write_json
from meshes.errors import MeshError

SCHEMA, SECTION_SCHEMA = "fe-contact/validate/1", "fe-contact/validate-section/1"
RECORD, SECTION, ASKED, PROVENANCE = "validate.json", "section.json", "asked.json", "provenance.json"


def validate(
    folder: Path,
    quick: bool = False,
    jobs: int = 2,
    resume: bool = False,
    only: Sequence[str] = (),
    progress: Progress = silent,
) -> Report:
    """Every section, or those named ``only``, and the page in ``folder``.

    ``resume`` takes sections, and rows of others, that are there, of this suite; else all is made anew. Raises BadInput
    for an unknown name, CannotWrite; what else fails with a name is shown in the section's place.
    """
    asked, told = chosen(only), list[Chapter]()
    begun = time.monotonic()
    for place, (name, part) in enumerate(asked.items(), 1):
        where = folder / FOLDER / name
        if not resume:
            _forget(where)
        kept = _kept(part, where, quick)
        own = _within(f"{place} of {len(asked)}, {part.title}", progress)
        told.append(Chapter(name, part, kept) if kept else _made(name, part, Request(where, quick, jobs, own)))
    report = Report(folder, quick, tuple(told))
    progress("page")
    publish(folder, lambda where: _write(report, where), RECORD)
    _write_provenance(folder, quick, jobs, time.monotonic() - begun)
    return report


def chosen(only: Sequence[str]) -> dict[str, ReportPart]:
    """Sections by their names, all of them where none is named. Raises BadInput with every unknown name."""
    known = parts()
    faults = [
        Fault("--sections", "", f"{name}: accepted {', '.join(known)}{nearest(name, [*known])}")
        for name in only
        if name not in known
    ]
    if faults:
        raise BadInput(faults)
    return {name: part for name, part in known.items() if not only or name in only}


def _within(title: str, progress: Progress) -> Progress:
    """What a section tells, under its title."""

    def told(message: str, done: float = 0, total: float = 0) -> None:
        progress(f"{title}: {message}", done, total)

    told("begun")
    return told


def _forget(where: Path) -> None:
    """A section is no longer known, nor are its rows."""
    for path in (where / ASKED, *where.glob("*.jsonl"), *where.glob("*/*.jsonl")):
        path.unlink(missing_ok=True)


def _question(quick: bool) -> Table:
    """What a section's answer depends on, but for its name."""
    return {"schema": SECTION_SCHEMA, "quick": quick, "suite": journal.suite()}


def _kept(part: ReportPart, where: Path, quick: bool) -> Section | None:
    """The section that stands in a folder; none where it is another suite's, another question's, or not whole."""
    try:
        asked = json.loads((where / ASKED).read_text(encoding="utf-8"))
        record = json.loads((where / SECTION).read_text(encoding="utf-8"))
        whole = all(checksum(where / name) == known for name, known in record["files"].items())
    except (OSError, ValueError, KeyError):
        return None
    if asked != _question(quick) or not whole:
        return None
    found: Section = decoded(Section, record["section"])
    return found


def _made(name: str, part: ReportPart, request: Request) -> Chapter:
    """A section made and written, or what kept it from being made."""
    try:
        made = part.make(request)
        content = {"schema": SECTION_SCHEMA, "section": encoded(made.section)}

        def write(where: Path) -> None:
            made.write(where)
            write_json(where / ASKED, _question(request.quick))
            write_json(where / SECTION, plain(content))

        publish(request.where, write, SECTION)
        return Chapter(name, part, made.section)
    except CannotWrite:
        raise
    except (FeContactError, MeshError) as failure:
        said = " ".join(str(failure).split())
        return Chapter(name, part, Section((Headline(FAILED, f"{part.title}: {said}"),), ()), said)


def _write(report: Report, where: Path) -> None:
    """The page, and what it says in the first place as JSON."""
    (where / "index.html").write_text(page(report), encoding="utf-8")
    write_json(where / RECORD, _content(report))


def _content(report: Report) -> Table:
    """Of ``validate.json``: no time, and nothing of the machine."""
    sections = {
        one.name: {
            "title": one.part.title,
            "command": one.part.command,
            "verdict": one.section.verdict,
            "worst": encoded(one.section.worst) if one.section.worst else None,
            "missed": one.section.missed or None,
            "failure": one.failure or None,
        }
        for one in report.told
    }
    lines = [vars(line) for line in report.headlines]
    found: Table = plain(
        {"schema": SCHEMA, "version": __version__, "quick": report.quick, "headlines": lines, "sections": sections}
    )
    return found


def _write_provenance(folder: Path, quick: bool, jobs: int, wall: float) -> None:
    """Who made this report, where, and in which time: apart from what it says."""
    content = {**provenance(), "suite": journal.suite(), "quick": quick, "jobs": jobs, "wall_s": round(wall, 1)}
    part = folder / f"{PROVENANCE}.{os.getpid()}.part"
    write_json(part, content)
    part.replace(folder / PROVENANCE)
