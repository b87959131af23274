"""``fe-contact ptmd [FILE]``: section 5 of the paper, a structure with a pounding tuned mass damper."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Simulate, write, report; 0 or 3."""
    from fe_contact.studies.ptmd import RECORD, assumption, told, write_failure, write_ptmd
    from fe_contact.studies.ptmd_chart import plot_study
    from lumped.ptmd.case_file import load
    from lumped.ptmd.study import study

    case = load(args.file, base.overrides_of(args))
    run = base.StudyRun.of(args, "ptmd", case.name)
    with base.recorded(partial(write_failure, case, where=run.where)):
        found = study(case, run.progress)
    title = f"{case.name}: {case.end_time:g} s of free vibration"
    write, plot = partial(write_ptmd, found), partial(plot_study, found)
    code = run.finish(RECORD, told(found), write, plot, title, missed=found.convergence.message)
    if not found.model_sufficient:
        base.complain(assumption(found))
    return code


MEMBER = base.Command(
    "free vibration of a pounding tuned mass damper: motion, contacts, energies, chart",
    (
        base.option("file", nargs="?", default="paper", help="file (TOML) or packaged name; default: the paper's"),
        base.override("override a key of the file"),
        *base.OUTPUT,
    ),
    execute,
    group=base.LAWS,
)
