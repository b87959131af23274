"""The paper's numbers, printed and recomputed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from fe_contact.studies.paper import told, write_paper
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns
from lumped.paper import Examples
from lumped.paper.claims import AGREES, DIFFERS, UNDECIDED, UNKNOWN, JudgedClaim, counts, study

MOST = 3  # look: claims that the first screen names
FIGURES = (
    base.Figure("fig6", "Figure 6 again: force of the steel ball by every model", ("fig6.csv",)),
    base.Figure("fig7", "Figure 7 again: R1 varied, the exact law beside the clipped one", ("fig7.csv", "grid.csv")),
    base.Figure("fig8", "Figure 8 again: R2 varied, the exact law beside the clipped one", ("fig8.csv", "grid.csv")),
    base.Figure("fig9", "Figure 9 again: concrete, by every model", ("fig9.csv",)),
    base.Figure("fig10", "Figure 10 again: concrete, by two models, and cut at the measured peak", ("fig10.csv",)),
    base.Figure("fig15", "Figure 15 as numbers: what the surface remembers between contacts", ("fig15.csv",)),
)
LISTINGS = (
    base.Listing(
        "paper.csv",
        "Every number that the paper claims",
        (
            Column("id", "claim"),
            *columns("place", "quantity", "unit", "printed", "recomputed", "deviation", "verdict"),
        ),
    ),
    base.Listing(
        "assumptions.csv",
        "Assumptions behind the examples",
        columns("example", "assumption", "criterion", "recomputed", "verdict"),
    ),
    base.Listing(
        "misprints.csv",
        "Misprints and contradictions",
        columns("place", "printed", "correct", "proof"),
    ),
)


def make(asked: base.Request) -> base.Made:
    """Every claim, judged by rule."""
    examples = Examples.load({})
    found = study(examples, asked.progress)
    from fe_contact.studies.paper_chart import plot_paper

    section = base.Section((headline(found.claims),), tuple(told(found)[-2:]), FIGURES, LISTINGS)
    return base.Made(section, (partial(write_paper, found), partial(plot_paper, found)))


def headline(claims: Sequence[JudgedClaim]) -> base.Headline:
    """How many claims agree, and which differ."""
    number = counts(claims)
    differing = [f"{one.claim.quantity} ({one.claim.id})" for one in claims if one.verdict == DIFFERS]
    judged = number[AGREES] + number[DIFFERS] + number[UNDECIDED]
    where = f"; it differs in {base.named(differing, MOST)}" if differing else ""
    said = f"The paper's numbers: {number[AGREES]} of {judged} that can be recomputed agree{where}."
    return base.Headline(base.DIFFERS if differing else base.HOLDS, f"{said} {number[UNKNOWN]} {UNKNOWN}.")


MEMBER = base.ReportPart(
    rank=70,
    title="The paper's numbers",
    question="What of the source paper's printed numbers is found again, and where does it differ?",
    command="fe-contact paper",
    make=make,
    seconds=12,
)
