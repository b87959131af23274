"""``fe-contact export SCENE --to PROGRAM``: a scene as the input file of another program."""

from __future__ import annotations

import argparse
from dataclasses import replace
from functools import partial
from pathlib import Path

from fe_contact.commands import base
from lumped.errors import BadInput
from lumped.result.folder import publish
from lumped.schema.members import available

PACKAGE = "fe_contact.studies.export"


def execute(args: argparse.Namespace) -> int:
    """Answer the scene ourselves, write the file; 0."""
    from fe_contact.methods import settings
    from fe_contact.studies.export.base import PROGRAMS, ImpactCase, StaticCase

    program = PROGRAMS.get(args.to)
    progress = base.progress_of(args)
    progress("our own answer")
    if args.depth is not None:
        indenter, table = base.read_indenter(args)
        depth = base.number(args.depth, "--depth")
        try:
            case = StaticCase.of(indenter, depth, args.refined, settings(table, None, indenter.source))
        except BadInput as bad:
            faults = (replace(one, source="--depth") if one.source == "--depths" else one for one in bad.faults)
            raise BadInput(faults) from bad
        text, name = program.static(case), f"{case.name}-depth{program.suffix}"
    else:
        scene, table = base.read_scene(args)
        struck = ImpactCase.of(scene, args.refined, settings(table, None, scene.source))
        text, name = program.impact(struck), f"{struck.name}-impact{program.suffix}"
    where = base.folder(args, "export", Path(name).stem)
    runs = program.how.format(file=name, stem=Path(name).stem)
    content = publish(where, partial(_write, name=name, text=text, runs=runs))
    base.say(args, content, [f"written to {where / name}", f"to run it: {runs}"])
    return base.DONE


def _write(folder: Path, name: str, text: str, runs: str) -> None:
    """The input file and the record that names it."""
    from lumped.schema.json_file import write_json

    (folder / name).write_text(text, encoding="utf-8")
    write_json(folder / "result.json", {"schema": "fe-contact/export/1", "file": name, "run": runs})


MEMBER = base.Command(
    "a scene as the input file of another program, with our own answer in it",
    (
        *base.SCENE,
        base.option("--to", required=True, choices=available(PACKAGE), help="the program"),
        base.option("--depth", metavar="D", help="slow indentation to this depth, m; without it the impact"),
        base.option("--refined", type=int, choices=(1, 2, 3, 4), default=1, help="elements and steps divided so often"),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact export polymer-sphere --to ngsolve",
)
