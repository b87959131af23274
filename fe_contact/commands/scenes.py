"""``fe-contact scenes``: the packaged scenes."""

from __future__ import annotations

import argparse

from fe_contact.commands import base

SUMMARY = "the packaged scenes, one line each"


def arguments(parser: argparse.ArgumentParser) -> None:
    """No arguments."""


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped.data import scene_names
    from lumped.scene import Scene

    for name in scene_names():
        scene = Scene.load(name)
        print(f"{name:20s} {scene.shape.name} on {scene.target.name}, {scene.mass:g} kg at {scene.velocity:g} m/s")
    return base.DONE
