"""``fe-contact scenes``: the packaged scenes."""

from __future__ import annotations

import argparse
import json

from fe_contact.commands import base
from lumped.scene.scene import Scene


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--json]."""
    base.json_argument(parser)


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped.schema.files import SCENES

    scenes = {name: Scene.load(name) for name in SCENES.names}
    if args.json:
        print(json.dumps({name: scene.to_dict() for name, scene in scenes.items()}, allow_nan=False))
        return base.DONE
    width = max(map(len, scenes))
    for name, scene in scenes.items():
        print(f"{name:{width}s} {described(scene)}, {scene.mass:g} kg at {scene.velocity:g} m/s")
    return base.DONE


def described(scene: Scene) -> str:
    """Who strikes what, or by which law."""
    if scene.shape is not None:
        return f"{scene.shape.name} on {scene.target.name}"
    return f"law {scene.law.name}" if scene.law is not None else "two masses"


MEMBER = base.Command("the packaged scenes, one line each", arguments, execute)
