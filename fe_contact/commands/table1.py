"""``fe-contact table1 [--out DIR] [--json]``: the eight rows of the paper's Table 1, with error bars and verdicts."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Press, identify, judge, write, draw; 0, or 3 where bars leave a row undecided."""
    if args.kinematics == "finite":
        from fe_contact.studies.table1.study import finite_rows

        return base.finite_exponents(args, "table1", finite_rows)
    from fe_contact.studies.table1.study import table1
    from fe_contact.studies.table1.verdict import told, undecided, write_table1

    run = base.StudyRun.of(args, "table1", "paper")
    trials = table1(run.where, run.progress)
    from fe_contact.studies.table1.chart import plot_table1  # matplotlib, once the two processes are gone

    write, plot = partial(write_table1, trials), partial(plot_table1, trials)
    return run.finish("table1.json", told(trials), write, plot, missed=undecided(trials))


MEMBER = base.Command(
    "the paper's Table 1 on trial: D, alpha and E* of every row by finite elements, with error bars and verdicts",
    (*base.OUTPUT, base.KINEMATICS),
    execute,
)
