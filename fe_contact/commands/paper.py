"""``fe-contact paper [--set a.b=value ...] [--out DIR] [--json]``: every number of the source paper, recomputed.

Printed and recomputed, with a verdict by rule.
"""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Recompute, write, say the verdicts; 0."""
    from fe_contact.studies.paper import told, write_paper
    from fe_contact.studies.paper_chart import plot_paper
    from lumped.paper import Examples
    from lumped.paper.claims import study

    examples = Examples.load(base.overrides_of(args))
    run = base.StudyRun.of(args, "paper", examples.name)
    found = study(examples, run.progress)
    return run.finish("paper.json", told(found), partial(write_paper, found), partial(plot_paper, found))


MEMBER = base.Command(
    "the source paper's claims: printed, recomputed, deviation, verdict; its figures drawn again",
    (base.override("change an input of the examples, as steel.density=8000"), *base.OUTPUT),
    execute,
)
