"""The paper's pounding tuned mass damper, followed again."""

from __future__ import annotations

from functools import partial

from fe_contact.studies.ptmd import assumption, told, write_ptmd
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column
from lumped.ptmd.case_file import load
from lumped.ptmd.study import study

CAPTION = "Figure 14 again: the structure alone, with a damper, and with one that pounds on a ring"
FIGURES = (base.Figure("ptmd", CAPTION, ("ptmd.csv", "contacts.csv")),)
LISTINGS = (
    base.Listing(
        "contacts.csv",
        "Contacts of damper and ring",
        (
            Column("side", "side"),
            Column("start_s", "from, s"),
            Column("end_s", "to, s"),
            Column("peak_force_N", "peak force, N"),
            Column("peak_depth_m", "peak penetration, m"),
        ),
    ),
)


def make(asked: base.Request) -> base.Made:
    """Follow the structure with and without damper and ring."""
    found = study(load(), asked.progress)
    from fe_contact.studies.ptmd_chart import plot_study

    doubted = () if found.model_sufficient else (assumption(found),)
    said = base.Section((), (*told(found), *doubted), FIGURES, LISTINGS, missed=found.convergence.message)
    return base.Made(said, (partial(write_ptmd, found), partial(plot_study, found)))


MEMBER = base.ReportPart(
    rank=75,
    title="The paper's damper",
    question="What does a damper that pounds on a ring do to a structure's free vibration?",
    command="fe-contact ptmd",
    make=make,
    seconds=6,
)
