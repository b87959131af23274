"""``fe-contact sweep SWEEP.toml [--jobs N | --dask ADDRESS] [--resume]``: many scenes from one file."""

from __future__ import annotations

import argparse
import os
import sys
import time
from functools import partial
from pathlib import Path

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Ask for all cases, or for those that are left; write, say how they ended; 3 where some did not converge."""
    from fe_contact.studies.files import require_parquet
    from fe_contact.studies.sweep.cases import load
    from fe_contact.studies.sweep.chart import plot_sweep
    from fe_contact.studies.sweep.study import run as run_sweep
    from fe_contact.studies.workers import checked_jobs

    begun = time.monotonic()
    jobs, sweep = checked_jobs(_processors() if args.jobs is None else args.jobs), load(args.sweep)
    if args.parquet:
        require_parquet()
    run = base.StudyRun.of(args, "sweep", sweep.name)
    table = run_sweep(sweep, run.where / "cases", jobs, args.dask, args.resume, run.progress)
    write = partial(table.write, wall=time.monotonic() - begun, parquet=args.parquet)
    title = f"{sweep.name}: {sweep.count} case{'s' * (sweep.count > 1)}"
    return run.finish("sweep.json", table.summary(), write, partial(plot_sweep, table), title, table.missed)


def _processors() -> int:
    """Those this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


MEMBER = base.Command(
    "many scenes from one file: a table of all quantities with their bars, charts",
    (
        base.option("sweep", type=Path, help="sweep file (TOML): a scene, and the values that its keys take"),
        base.option("--jobs", metavar="N", help="processes that answer; default: the processors there are"),
        base.option("--dask", metavar="ADDRESS", help="scheduler of Dask whose workers answer, or local"),
        base.option("--resume", action="store_true", help="ask only for what the folder does not hold"),
        base.option("--parquet", action="store_true", help="the table as table.parquet too"),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact sweep sweep.toml --jobs 2",
)
