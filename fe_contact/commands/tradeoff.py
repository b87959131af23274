"""``fe-contact tradeoff SCENE [--quick]``: what accuracy costs, by finite elements and by the lumped laws."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Measure, write, say what to use and where the defaults lie; 0."""
    from fe_contact.methods import settings
    from fe_contact.studies.tradeoff.chart import plot_tradeoff
    from fe_contact.studies.tradeoff.study import tradeoff, write_tradeoff

    scene, table = base.read_scene(args)
    run = base.StudyRun.of(args, "tradeoff", scene.name)
    found = tradeoff(scene, settings(table, None, scene.source), args.quick, run.where, run.progress)
    write, plot = partial(write_tradeoff, found), partial(plot_tradeoff, found)
    advice, *lines = found.verdict
    return run.finish("tradeoff.json", lines, write, plot, f"{scene.name}: {advice}")


MEMBER = base.Command(
    "error over processor time and counted work, by every method; where the defaults lie",
    (*base.SCENE, *base.OUTPUT, base.quick("a quarter of the settings; ten times the tolerance where no law is exact")),
    execute,
    example="fe-contact tradeoff polymer-sphere --quick",
)
