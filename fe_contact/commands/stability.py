"""``fe-contact stability [--quick] [--jobs N] [--out DIR]``: where methods break, and why the defaults do not."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Measure what is not yet measured, write, draw; 0."""
    from fe_contact.studies.stability._chart import plot_stability
    from fe_contact.studies.stability.base import rows_of, told, write_stability

    run = base.StudyRun.of(args, "stability", "bars")
    rows = rows_of(args.quick, args.jobs, run.where, run.progress)
    return run.finish("stability.json", told(rows), partial(write_stability, rows), partial(plot_stability, rows))


MEMBER = base.Command(
    "maps of where methods break: schemes, masses, penalties, locking, relaxation, exits, gaps, far ends",
    (
        *base.OUTPUT,
        base.quick("fewer elements, steps and penalties"),
        base.option("--jobs", type=int, default=2, choices=range(1, 65), metavar="N", help="processes; default 2"),
    ),
    execute,
    example="fe-contact stability --quick",
)
