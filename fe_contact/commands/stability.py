"""``fe-contact stability``: where methods break, and why the defaults do not."""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fe_contact.studies.stability.base import Row


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--quick] [--jobs N] [--out DIR] [--json] [--quiet]."""
    base.output_arguments(parser)
    parser.add_argument("--quick", action="store_true", help="fewer elements, steps and penalties")
    parser.add_argument("--jobs", type=int, default=2, choices=range(1, 65), metavar="N", help="processes; default 2")


def execute(args: argparse.Namespace) -> int:
    """Measure what is not yet measured, write, draw; 0."""
    from fe_contact.studies.stability._chart import plot_stability
    from fe_contact.studies.stability.base import rows_of, write_stability

    where = base.folder(args, "stability", "bars")
    progress = base.progress_of(args)
    rows = rows_of(args.quick, args.jobs, where, progress)

    def write(folder: Path) -> None:
        write_stability(rows, folder)
        progress("charts")
        plot_stability(rows, folder)

    content = publish(where, write, "stability.json")
    base.tell(args, content, _lines(rows), where)
    return base.DONE


def _lines(rows: Sequence[Row]) -> list[str]:
    """A line a study."""
    counted = Counter(row["study"] for row in rows)
    failed = Counter(row["study"] for row in rows if row["failure"])
    lines = [f"{study:16s} {count} cases, {failed[study]} of them named failures" for study, count in counted.items()]
    kept = [row for row in rows if row.get("all_kept")]
    held = [
        f"{row['scheme']} {row['mass']} tip {row['tip']:.2f} {row['enforcement']}, CFL {row['cfl']:g}" for row in kept
    ]
    return [*lines, f"all limits kept over ten periods: {'; '.join(held) or 'by no scheme'}"]


MEMBER = base.Command(
    "maps of where methods break: schemes, masses, penalties, locking, relaxation, exits, gaps, far ends",
    arguments,
    execute,
)
