"""``fe-contact restitution [--out DIR] [--json] [--quiet]``: restitution asked for against obtained, law by law."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Simulate, write, say how far each formula is off; 0."""
    from fe_contact.studies.restitution import table, write_restitution
    from fe_contact.studies.restitution_chart import plot_restitution

    run = base.StudyRun.of(args, "restitution", "laws")
    run.progress("impacts")
    lines = table()
    told = [line.told for line in lines]
    return run.finish("restitution.json", told, partial(write_restitution, lines), partial(plot_restitution, lines))


MEMBER = base.Command(
    "restitution asked for against obtained: every law, exact and published dampings, both exits",
    base.OUTPUT,
    execute,
    group=base.LAWS,
)
