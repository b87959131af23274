"""``fe-contact restitution``: restitution asked for against obtained, for every law and damping formula."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from fe_contact.studies.restitution.table import RestitutionLine


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--out DIR] [--json] [--quiet]."""
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Simulate, write, say how far each formula is off; 0."""
    from fe_contact.studies.restitution.chart import plot_restitution
    from fe_contact.studies.restitution.table import table, write_restitution

    where = base.folder(args, "restitution", "laws")
    progress = base.progress_of(args)
    progress("impacts")
    lines = table()

    def write(folder: Path) -> None:
        write_restitution(lines, folder)
        progress("chart")
        plot_restitution(lines, folder)

    content = publish(where, write, "restitution.json")
    base.tell(args, content, [*map(_said, lines)], where)
    return base.DONE


def _said(line: RestitutionLine) -> str:
    worst = line.worst
    off = "nothing obtained" if worst is None else f"{worst[0]:+.1e} at most, at e = {worst[1]:g}"
    return f"{line.law:16s} {line.damping:20s} exit {line.exit:6s} {off}"


MEMBER = base.Command(
    "restitution asked for against obtained: every law, exact and published dampings, both exits", arguments, execute
)
