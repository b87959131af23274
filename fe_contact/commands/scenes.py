"""``fe-contact scenes``: the packaged scenes."""

from __future__ import annotations

import argparse
import itertools
import textwrap
from pathlib import Path

from fe_contact.commands import base
from lumped.scene.scene import Scene


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped.schema.files import SCENES

    scenes = {name: Scene.load(name) for name in SCENES.names}
    width = max(map(len, scenes))
    lines = list[str]()
    for name, one in scenes.items():
        lines.append(f"{name:{width}s} {described(one)}, {one.mass:g} kg at {one.velocity:g} m/s")
        lines += textwrap.wrap(comment(SCENES.path(name)), 110, initial_indent="    ", subsequent_indent="    ")
    base.say(args, {name: scene.to_dict() for name, scene in scenes.items()}, lines)
    return base.DONE


def comment(path: Path) -> str:
    """What a scene file says of itself: the lines behind a # before its first key."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), path.read_text(encoding="utf-8").splitlines())
    return " ".join(line.lstrip("# ") for line in lines)


def described(scene: Scene) -> str:
    """Who strikes what, or by which law."""
    if scene.shape is not None:
        return f"{scene.shape.name} on {scene.target.name}"
    return f"law {scene.law.name}" if scene.law is not None else "two masses"


MEMBER = base.Command(
    "the packaged scenes: who strikes what, and what each is for",
    (base.JSON,),
    execute,
    group=base.START,
)
