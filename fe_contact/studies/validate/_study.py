"""The report: its sections, two at a time, each in a folder of its own, and the page of all of them.

A section's folder holds the files of its study, ``section.json``, what the page shows of them, and ``asked.json``, what
it was asked of which suite. They appear all at once: a section that was interrupted is not there, and one that is there
is whole. Rows that a study keeps stay beside them until the report is asked for anew.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
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
from fe_contact.studies.workers import tell
from lumped.errors import BadInput, CannotWrite, Fault, FeContactError, nearest
from lumped.result.folder import checksum, publish
from lumped.result.result import provenance
from lumped.schema import Table
from lumped.schema.json_file import decoded, encoded, plain, write_json
from meshes.errors import MeshError

SCHEMA, SECTION_SCHEMA = "fe-contact/validate/1", "fe-contact/validate-section/1"
LANES = 2  # look: sections at a time: while one draws its charts, or asks one process alone, another one goes on
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
    asked, begun = chosen(only), time.monotonic()
    for name in () if resume else asked:
        _forget(folder / FOLDER / name)
    known = {name: _kept(part, folder / FOLDER / name, quick) for name, part in asked.items()}
    told = {name: Chapter(name, asked[name], section) for name, section in known.items() if section}
    told |= _all_made({name: part for name, part in asked.items() if name not in told}, folder, quick, jobs, progress)
    report = Report(folder, quick, tuple(told[name] for name in asked))
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


def _all_made(
    asked: Mapping[str, ReportPart], folder: Path, quick: bool, jobs: int, progress: Progress
) -> dict[str, Chapter]:
    """Sections by their names, the longest first: with all processes where it takes longer than all others together,
    the others with their share of them.
    """
    longest, chapters = sorted(asked, key=lambda name: -asked[name].seconds), dict[str, Chapter]()
    alone = [name for name in longest[:1] if 2 * asked[name].seconds > sum(part.seconds for part in asked.values())]
    for names, most in ((alone, 1), (longest[len(alone) :], LANES)):
        lanes = max(min(most, jobs, len(names)), 1)
        heard = tell if lanes > 1 else progress
        requests = {name: Request(folder / FOLDER / name, quick, jobs // lanes, heard) for name in names}
        calls = {name: partial(_made, name, asked[name], request) for name, request in requests.items()}
        with closing(journal.measured(calls, lanes, progress)) as found:
            for name, chapter in found:
                chapters[name] = chapter
                progress(f"{chapter.part.title}: {len(chapters)} of {len(asked)} sections stand")
    return chapters


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
        made = part.make(replace(request, progress=_within(part.title, request.progress)))
        content = {"schema": SECTION_SCHEMA, "section": encoded(made.section)}

        def write(where: Path) -> None:
            for writer in made.writers:
                writer(where)
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
