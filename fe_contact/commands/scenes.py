"""``fe-contact scenes``: the packaged scenes."""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

from fe_contact.commands import base
from lumped.scene.scene import Scene


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped.schema.files import SCENES

    scenes = {name: Scene.load(name) for name in SCENES.names}
    width = max(map(len, scenes))
    lines = [f"{name:{width}s} {described(one)}: {comment(SCENES.path(name))}" for name, one in scenes.items()]
    base.say(args, {name: scene.to_dict() for name, scene in scenes.items()}, lines)
    return base.DONE


def comment(path: Path) -> str:
    """What a scene file says of itself: the first sentence behind a # before its first key."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), path.read_text(encoding="utf-8").splitlines())
    return " ".join(line.lstrip("# ") for line in lines).partition(". ")[0].rstrip(".")


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
