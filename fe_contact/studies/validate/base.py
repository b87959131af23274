"""What a section of the report is: a question, the study that answers it, and what of it a page shows.

A section holds no number of its own: its tables are the CSV files of the study, its figures the charts of the study,
its sentences are computed. ``verified`` is said of what was held against an exact answer, and of nothing else.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fe_contact.progress import Progress
from lumped.schema.members import Folder

VERIFIED, HOLDS, DIFFERS, LARGER, OPEN, FAILED = "verified", "holds", "differs", "larger model", "open", "failed"
FOLDER = "sections"  # of the report, a folder a section in it
NOTHING_MEASURED = "Nothing is called validated: that takes a measured curve, and the paper's text holds none."
WORDS = (VERIFIED, HOLDS, DIFFERS, LARGER, OPEN, FAILED)


@dataclass(frozen=True)
class Request:
    """What a section is asked: whether a ``quick`` answer will do, in so many processes (``jobs``), its rows kept in
    the folder ``where``.
    """

    where: Path
    quick: bool
    jobs: int
    progress: Progress


@dataclass(frozen=True)
class Headline:
    """A line of the first screen: one of :data:`WORDS`, and a sentence."""

    word: str
    text: str


@dataclass(frozen=True)
class Worst:
    """The largest error over its bar of a section, up to 1 where bars hold, of how many, and where.

    The ``ratio`` is None where one of both answers alone is defined.
    """

    ratio: float | None
    count: int
    place: str

    @property
    def size(self) -> float:
        """The ratio, infinite where there is none."""
        return math.inf if self.ratio is None else self.ratio


@dataclass(frozen=True)
class Figure:
    """A chart ``name.svg`` of the study, what it shows, and the CSV files whose numbers it draws."""

    name: str
    caption: str
    tables: tuple[str, ...]


@dataclass(frozen=True)
class Column:
    """A column ``key`` of a CSV file, its ``label``, and the column of its bar, empty where there is none."""

    key: str
    label: str
    error: str = ""


def columns(*keys: str) -> tuple[Column, ...]:
    """Columns without a bar, labelled as their keys say."""
    return tuple(Column(key, key.replace("_", " ")) for key in keys)


@dataclass(frozen=True)
class Listing:
    """A table of the page: columns of a CSV file, and of its rows those whose column ``only[0]`` holds ``only[1]``."""

    table: str
    caption: str
    columns: tuple[Column, ...]
    only: tuple[str, str] = ("", "")


@dataclass(frozen=True)
class Section:
    """What a page shows of a study.

    ``verdict``: sentences; ``histories``: a JSON file of force histories to be drawn as curves, empty without;
    ``missed``: what did not reach its tolerance, empty where all did.
    """

    headlines: tuple[Headline, ...]
    verdict: tuple[str, ...]
    figures: tuple[Figure, ...] = ()
    listings: tuple[Listing, ...] = ()
    worst: Worst | None = None
    histories: str = ""
    missed: str = ""


@dataclass(frozen=True)
class Made:
    """A section, and what writes the files that it names into a folder, one after the other."""

    section: Section
    writers: tuple[Callable[[Path], object], ...]


@dataclass(frozen=True)
class ReportPart:
    """A member of this folder: its ``rank`` on the page, what it asks, and what answers; ``command`` makes the same
    files without the report, ``quick`` is what a quick answer leaves out; ``seconds``: of one core, for a full one.

    ``make`` raises named failures: the page shows them in the section's place. It imports a chart, and matplotlib with
    it, when the study has its rows.
    """

    rank: int
    title: str
    question: str
    command: str
    make: Callable[[Request], Made]
    quick: str = ""
    seconds: float = 0.0


@dataclass(frozen=True)
class Chapter:
    """A section of the report under its name, of which part; ``failure``: why it is none."""

    name: str
    part: ReportPart
    section: Section
    failure: str = ""


@dataclass(frozen=True)
class Report:
    """All sections in the order of the page, whether they are ``quick`` answers, and the ``folder`` they stand in."""

    folder: Path
    quick: bool
    told: tuple[Chapter, ...]

    @property
    def headlines(self) -> tuple[Headline, ...]:
        """The first screen: the sections' own lines, and with the first of them the worst error of all."""
        lines = [line for one in self.told for line in one.section.headlines]
        first, worst = lines[:1], self._worst
        if [one.word for one in first] == [one.word for one in worst]:
            first, worst = (
                [Headline(one.word, f"{one.text} {more.text}") for one, more in zip(first, worst, strict=True)],
                (),
            )
        return (*first, *worst, *lines[1:])

    def command_of(self, part: ReportPart) -> str:
        """What makes the figures of a part as this report has them."""
        return f"{part.command} --quick" if self.quick and part.quick else part.command

    @property
    def _worst(self) -> tuple[Headline, ...]:
        """The largest error over its bar of all numbers with an exact answer; none where there are none."""
        known = [one.section.worst for one in self.told if one.section.worst]
        if not known:
            return ()
        worst, count = max(known, key=lambda one: one.size), sum(one.count for one in known)
        start = f"The worst error of {count} numbers with an exact answer"
        if worst.ratio is None:
            return (Headline(DIFFERS, f"{start} is that one side has none: {worst.place}."),)
        said = f"{start} is {worst.ratio:.2f} of its bar: {worst.place}."
        return (Headline(VERIFIED if worst.ratio <= 1.0 else DIFFERS, said),)

    @property
    def missed(self) -> str:
        """What failed, or did not reach its tolerance; empty where nothing did."""
        failed = [f"{one.name} failed: {one.failure}" for one in self.told if one.failure]
        return "; ".join([*failed, *(f"{one.name}: {one.section.missed}" for one in self.told if one.section.missed)])


PARTS = Folder[ReportPart]("fe_contact.studies.validate")


def parts() -> dict[str, ReportPart]:
    """All members by their names, in the order of the page."""
    return dict(sorted(PARTS.members.items(), key=lambda one: one[1].rank))


def named(names: Sequence[str], most: int) -> str:
    """So many of some names, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
