"""Table 1 of the paper on trial."""

from __future__ import annotations

from functools import partial

from fe_contact.studies.table1.study import Trial, table1
from fe_contact.studies.table1.verdict import HOLDS, RANGE, UNDECIDED, UNTRIED, WRONG, undecided, verdict, write_table1
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns

TABLES = ("table1.csv", "table1-datum.csv", "table1-bonded.csv")
SPOKEN = {
    HOLDS: "rows hold",
    RANGE: "hold within a range",
    WRONG: "are wrong, and corrected",
    UNDECIDED: "are undecided",
    UNTRIED: "have no answer",
}
COLUMNS = (
    Column("number", "row"),
    *columns("case", "verdict"),
    Column("statement", "why"),
    Column("D_printed", "D printed"),
    Column("D", "D found", "D_error"),
    Column("alpha_printed", "α printed"),
    Column("alpha", "α found", "alpha_error"),
    Column("E_printed_Pa", "E* printed, Pa"),
    Column("E_Pa", "E* found, Pa", "E_error_Pa"),
)


def make(asked: base.Request) -> base.Made:
    """Every row, by slow indentation and from impacts."""
    trials = table1(asked.where, asked.progress, asked.jobs)
    from fe_contact.studies.table1.chart import plot_table1

    judged = [(trial.row, verdict(trial)) for trial in trials]
    figure = base.Figure("table1", "E*, reach of the power laws, line contact and bonded blocks, row by row", TABLES)
    listing = base.Listing("table1.csv", "The eight rows, printed and found", COLUMNS)
    sentences = tuple(f"{row.number} {row.case}: {one.word}: {one.sentence}" for row, one in judged)
    section = base.Section((headline(trials),), sentences, (figure,), (listing,), missed=undecided(trials))
    return base.Made(section, (partial(write_table1, trials), partial(plot_table1, trials)))


def headline(trials: tuple[Trial, ...]) -> base.Headline:
    """How many rows hold, and which do not."""
    rows = {word: [str(one.row.number) for one in trials if verdict(one).word == word] for word in SPOKEN}
    said = ", ".join(
        f"{len(numbers)} {SPOKEN[word]} ({', '.join(numbers)})" for word, numbers in rows.items() if numbers
    )
    word = base.DIFFERS if rows[WRONG] else base.OPEN if rows[UNDECIDED] or rows[UNTRIED] else base.HOLDS
    return base.Headline(word, f"Of the paper's Table 1, by finite elements: {said}.")


MEMBER = base.ReportPart(
    rank=20,
    title="Table 1",
    question="Do the paper's geometry factors, exponents and moduli hold, row by row?",
    command="fe-contact table1",
    make=make,
    seconds=31,
)
