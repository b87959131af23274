"""``fe-contact export SCENE --to PROGRAM``: a scene as the input file of another program."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from fe_contact.commands import base
from lumped.errors import BadInput, Fault
from lumped.result.folder import publish
from lumped.schema.members import available

PACKAGE = "fe_contact.studies.export"
MOST_ELEMENTS = 200  # work: of the other program


def execute(args: argparse.Namespace) -> int:
    """Answer the scene ourselves, write the file; 0."""
    from fe_contact.methods import settings
    from fe_contact.studies.export.base import PROGRAMS, ImpactCase, StaticCase

    program = PROGRAMS.get(args.to)
    elements = program.elements if args.elements is None else _count(args.elements)
    progress = base.progress_of(args)
    progress("our own answer")
    if args.depth is not None:
        indenter, table = base.read_indenter(args)
        case = StaticCase.of(indenter, base.number(args.depth, "--depth"), settings(table, None, indenter.source))
        text, name = program.static(case, elements), f"{case.name}-depth{program.suffix}"
    else:
        scene, table = base.read_scene(args)
        struck = ImpactCase.of(scene, settings(table, None, scene.source))
        text, name = program.impact(struck, elements), f"{struck.name}-impact{program.suffix}"
    where = base.folder(args, "export", Path(name).stem)
    runs = program.how.format(file=name, stem=Path(name).stem)
    content = publish(where, partial(_write, name=name, text=text, runs=runs))
    base.say(args, content, [f"written to {where / name}", f"to run it: {runs}"])
    return base.DONE


def _count(text: str) -> int:
    """A number of elements. Raises BadInput."""
    found = base.number(text, "--elements")
    if not (found.is_integer() and 2 <= found <= MOST_ELEMENTS):
        raise BadInput(Fault("--elements", "", f"{text}: accepted: a whole number from 2 to {MOST_ELEMENTS}"))
    return int(found)


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
        base.option(
            "--elements", metavar="N", help="elements along a contact radius; twice as many tell what they err by"
        ),
        base.option("--depth", metavar="D", help="slow indentation to this depth, m; without it the impact"),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact export polymer-sphere --to ngsolve",
)
