"""Where methods break, and whether the defaults do not."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from fe_contact.studies.stability.bars import DEFAULT, KEYS
from fe_contact.studies.stability.base import Row, rows_of, studies, told, write_stability
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns

LISTING = base.Listing(
    "table.csv",
    "A bouncing bar over ten periods",
    (
        *columns("scheme", "mass", "tip", "enforcement"),
        Column("cfl", "CFL"),
        Column("drift", "energy drift"),
        Column("ripple", "ripple"),
        Column("duration_steps", "duration, steps"),
        Column("start", "start, periods"),
        Column("all_kept", "all limits kept"),
        Column("failure", "failure"),
    ),
)


def make(asked: base.Request) -> base.Made:
    """Every case of every study."""
    rows = rows_of(asked.quick, asked.jobs, asked.where, asked.progress)
    from fe_contact.studies.stability._chart import plot_stability

    drawn = dict.fromkeys(row["study"] for row in rows)
    figures = tuple(base.Figure(name, studies()[name].title, (f"{name}.csv",)) for name in drawn)
    section = base.Section((headline(rows),), tuple(told(rows)), figures, (LISTING,))
    return base.Made(section, (partial(write_stability, rows), partial(plot_stability, rows)))


def headline(rows: Sequence[Row]) -> base.Headline:
    """Whether the defaults keep all limits, how many ways do, how many cases end as a named failure."""
    judged = [row for row in rows if "all_kept" in row]
    default = [row["all_kept"] for row in judged if all(row[key] == DEFAULT[key] for key in KEYS) and row["cfl"] == 1.0]
    failed, kept = sum(bool(row["failure"]) for row in rows), sum(row["all_kept"] for row in judged)
    good = bool(default) and all(default)
    said = (
        f"Over ten periods of a bouncing bar the default way to step {'keeps' if good else 'breaks'} the limits; "
        f"of {len(judged)} ways tried {kept} keep{'s' if kept == 1 else ''} them all. Of all {len(rows)} stability "
        f"cases {failed} end as a named failure."
    )
    return base.Headline(base.HOLDS if good else base.DIFFERS, said)


MEMBER = base.ReportPart(
    rank=80,
    title="Stability",
    question="Where do methods break, and do the defaults hold there?",
    command="fe-contact stability",
    make=make,
    seconds=1000,
    quick="elements, steps and penalties",
)
