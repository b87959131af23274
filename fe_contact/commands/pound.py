"""``fe-contact pound FILE``: structures that pound on each other, or on a wall, while the ground moves."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Simulate, write, report; 0 or 3."""
    from fe_contact.studies.pound.chart import plot_study
    from fe_contact.studies.pound.study import RECORD, told, write_failure, write_pound
    from lumped.pounding.case_file import load
    from lumped.pounding.study import study

    case = load(args.file, base.overrides_of(args), args.calibrate is not None)
    names = [name.strip() for name in args.laws.split(",") if name.strip()]
    if args.calibrate is None:
        case.check_laws(names)
    run = base.StudyRun.of(args, "pound", case.name)
    compared = None
    with base.recorded(partial(write_failure, case, where=run.where)):
        if args.calibrate is None:
            found = study(case, names, run.progress)
        else:
            from fe_contact.studies.pound.calibration import calibrated_study  # late: most work calibrates nothing

            compared = calibrated_study(case, names, args.calibrate, progress=run.progress)
            found = compared.study
    title = f"{case.name}: {case.end_time:g} s"
    changes = compared.told() if compared else []
    write = partial(write_pound, found, beside=compared.to_json() if compared else None)
    plot = partial(plot_study, found, beside=changes)
    return run.finish(RECORD, [*told(found), *changes], write, plot, title, missed=found.message)


MEMBER = base.Command(
    "structures that pound on each other or on a wall: response, contacts, energies, chart",
    (
        base.option("file", help="file (TOML) or packaged name, as two-frames; see the page pounding of the manual"),
        base.option("--laws", default="", metavar="A,B", help="other laws to compare, given by e and the same peak"),
        base.option(
            "--calibrate",
            metavar="HOW",
            help="each law on one reference of two storeys, as transfer calibrates",
        ),
        base.override("override a key of the file"),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact pound two-frames --laws hertzdamp",
    group=base.LAWS,
)
