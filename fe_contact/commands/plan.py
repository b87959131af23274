"""``fe-contact plan SCENE``: the settings chosen and the model ledger, without solving."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict

from fe_contact.commands import base

SUMMARY = "the settings chosen and what the model leaves out, without solving"


def arguments(parser: argparse.ArgumentParser) -> None:
    """SCENE [--tolerance T] [--set a.b=value ...] [--json]."""
    base.scene_arguments(parser)
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Print settings and ledger; 0."""
    from fe_contact.methods import settings
    from fe_contact.plan import plan

    scene, table = base.read_scene(args)
    chosen = plan(scene, settings(table, None, scene.source))
    ledger = [asdict(entry) for entry in chosen.ledger]
    if args.json:
        print(json.dumps({"numerics": chosen.numerics.as_dict(), "model_ledger": ledger}, allow_nan=False))
        return base.DONE
    print(f"{scene.name}")
    for key, value in chosen.numerics.as_dict().items():
        print(f"  {key:21s} {value if not isinstance(value, float) else format(value, '.6g')}")
    print("  left out, relative to the peak force:")
    for entry in chosen.ledger:
        size = "unknown" if entry.estimate is None else f"{entry.estimate:.2g}"
        print(f"    {entry.effect} ({entry.treated}): {size}; {entry.note}")
    return base.DONE
