"""Restitution asked for against obtained, law by law."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from fe_contact.studies.restitution import RestitutionLine, table, write_restitution
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns
from lumped.restitution import EXACT
from lumped.schema.csv_file import write_csv

WITHIN = 1e-6  # of a restitution that counts as the one asked for: ten times the tolerance of each impact
COLUMNS = ("law", "damping", "exit", "difference", "at")
FIGURE = base.Figure("restitution", "Restitution asked for and obtained, by every law and published damping",
                ("restitution.csv",))  # fmt: skip
LISTING = base.Listing(
    "formulas.csv",
    "Every damping formula at its worst",
    (
        *columns("law", "damping"),
        Column("exit", "contact ends at zero"),
        Column("difference", "obtained less asked, at worst"),
        Column("at", "at e ="),
    ),
)


def make(asked: base.Request) -> base.Made:
    """One impact a law, formula, exit and restitution."""
    asked.progress("impacts")
    lines = table()
    from fe_contact.studies.restitution_chart import plot_restitution

    writers = (partial(write, lines) for write in (write_restitution, _write_formulas, plot_restitution))
    return base.Made(base.Section((headline(lines),), (), (FIGURE,), (LISTING,)), tuple(writers))


def _write_formulas(lines: Sequence[RestitutionLine], where: Path) -> None:
    rows = [(one.law, one.damping, one.exit, *(one.worst or (None, None))) for one in lines]
    write_csv(where / "formulas.csv", COLUMNS, rows)


def headline(lines: Sequence[RestitutionLine]) -> base.Headline:
    """Whether the exact dampings give what is asked, and the worst of the published ones."""
    exact = [one for one in lines if one.damping == EXACT and one.worst]
    published = [one for one in lines if one.damping != EXACT and one.worst]
    given = sum(abs(_off(one)) <= WITHIN for one in exact)
    most = max(published, key=lambda one: abs(_off(one)))
    said = (
        f"Restitution asked for is obtained to {max(abs(_off(one)) for one in exact):.0e} by {given} of {len(exact)} "
        f"exact dampings; of {len(published)} published ones {sum(abs(_off(one)) <= WITHIN for one in published)} give "
        f"it, the worst is {most.damping.replace('_', ' ')} in {most.law.replace('_', ' ')}, off by {_off(most):+.2f}."
    )
    return base.Headline(base.HOLDS if given == len(exact) else base.DIFFERS, said)


def _off(line: RestitutionLine) -> float:
    assert line.worst is not None
    return line.worst[0]


MEMBER = base.ReportPart(
    rank=60,
    title="Restitution",
    question="Does a law bounce as hard as it was asked to?",
    command="fe-contact restitution",
    make=make,
    seconds=14,
)
