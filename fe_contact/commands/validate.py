"""``fe-contact validate [--quick] [--resume] [--out DIR]``: everything on the packaged scenes, in one report."""

from __future__ import annotations

import argparse
import json

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Make what is not yet made, write the page, say its first lines; 0, or 3 where a part failed or missed."""
    from fe_contact.studies.validate._study import RECORD, validate
    from fe_contact.studies.workers import checked_jobs

    jobs, only = checked_jobs(args.jobs), args.sections.split(",") if args.sections else ()
    run = base.StudyRun.of(args, "validate", "quick" if args.quick else "all")
    report = validate(run.where, args.quick, jobs, args.resume, only, run.progress)
    content = json.loads((run.where / RECORD).read_text(encoding="utf-8"))
    lines = [f"{line.word}: {line.text}" for line in report.headlines]
    base.say(args, content, [*lines, f"the report: {(run.where / 'index.html').absolute().as_uri()}"])
    if report.missed:
        base.complain(report.missed)
    return base.NOT_REACHED if report.missed else base.DONE


MEMBER = base.Command(
    "everything on the packaged scenes: what holds and what does not, in one page to open in a browser",
    (
        *base.OUTPUT,
        base.quick("fewer places, settings and scenes: two minutes instead of a quarter of an hour"),
        base.option("--resume", action="store_true", help="make only what the folder does not hold of this suite"),
        base.option("--jobs", default=2, metavar="N", help="processes; default 2"),
        base.option("--sections", metavar="a,b,...", help="sections of the report; default: all"),
    ),
    execute,
    example="fe-contact validate --quick --out report",
    group=base.START,
)
