"""``fe-contact tradeoff SCENE``: what accuracy costs, by finite elements and by the lumped laws."""

from __future__ import annotations

import argparse
from pathlib import Path

from fe_contact.commands import base
from lumped.result.folder import publish


def arguments(parser: argparse.ArgumentParser) -> None:
    """SCENE [--quick] [--tolerance T] [--set a.b=value ...] [--out DIR] [--json] [--quiet]."""
    base.scene_arguments(parser)
    base.output_arguments(parser)
    parser.add_argument("--quick", action="store_true", help="a quarter of the settings")


def execute(args: argparse.Namespace) -> int:
    """Measure, write, say where the defaults lie; 0."""
    from fe_contact.methods import settings
    from fe_contact.studies.tradeoff import study as tradeoff
    from fe_contact.studies.tradeoff import study_with_waves as tradeoff_waves
    from fe_contact.studies.tradeoff.chart import plot_tradeoff
    from fe_contact.studies.tradeoff.front import write_tradeoff

    scene, table = base.read_scene(args)
    where = base.folder(args, "tradeoff", scene.name)
    study = tradeoff_waves if scene.model.inertia else tradeoff
    points = study.tradeoff(scene, settings(table, None, scene.source), args.quick, where, base.progress_of(args))

    def write(folder: Path) -> None:
        write_tradeoff(scene, points, folder)
        plot_tradeoff(scene, points, folder)

    content = publish(where, write, "tradeoff.json")
    base.tell(args, content, content["verdict"], where, f"{scene.name}: {len(points)} points")
    return base.DONE


MEMBER = base.Command(
    "error over processor time and counted work, by every method; where the defaults lie", arguments, execute
)
