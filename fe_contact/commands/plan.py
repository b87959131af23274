"""``fe-contact plan SCENE``: the settings chosen and the model ledger, without solving."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.errors import FeContactError, NotReached
from lumped.result.result import good_to
from lumped.scene.scene import Scene

if TYPE_CHECKING:  # finite elements are loaded when they are needed
    from fe_contact.budget.plan import Plan
    from fe_contact.waves.plan import Cost


def execute(args: argparse.Namespace) -> int:
    """Print settings, ledger, what waves take, and why finite elements refuse the scene; 3 where that is too much."""
    from fe_contact.methods import settings
    from fe_contact.reference import plan

    scene, table = base.read_scene(args)
    progress = base.progress_of(args)
    progress("plan")
    chosen = plan(scene, settings(table, None, scene.source))
    takes, refused = _takes(scene, chosen)
    ledger = [entry.to_json(float(chosen.numerics.tolerance)) for entry in chosen.ledger]
    content = {"numerics": chosen.numerics.as_dict(), "model_ledger": ledger, "cost": takes and takes.as_dict()}
    base.say(args, content | {"refused": refused and str(refused)}, _lines(chosen, takes), scene.name)
    if refused and not args.json:
        base.complain(str(refused))
    return base.NOT_REACHED if isinstance(refused, NotReached) else base.DONE  # what only laws can follow is a plan too


def _lines(chosen: Plan, takes: Cost | None) -> list[str]:
    """Every setting, what waves take, every effect left out."""
    tolerance = float(chosen.numerics.tolerance)
    settings = chosen.numerics.as_dict().items()
    lines = [f"{key:21s} {value if not isinstance(value, float) else format(value, '.6g')}" for key, value in settings]
    lines += [] if takes is None else [f"takes {takes}"]
    lines.append("left out, relative to the peak force:")
    for entry in chosen.ledger:
        size = f"{entry.spread[0]:.2g} to {entry.spread[1]:.2g}, " if entry.spread else ""
        size += f"{entry.estimate:.2g}, " if entry.estimate is not None else ""
        lines.append(f"  {entry.effect} ({entry.treated}): {size}{entry.verdict(tolerance)}")
    return [*lines, good_to(chosen.ledger)]


def _takes(scene: Scene, chosen: Plan) -> tuple[Cost | None, FeContactError | None]:
    """What waves take, None without them, and why finite elements refuse the scene, None where they do not."""
    from fe_contact.reference import check_target, with_waves
    from fe_contact.settings import WaveNumerics

    try:
        if not scene.model.inertia:
            check_target(scene)
            return None, None
        assert isinstance(chosen.numerics, WaveNumerics)
        takes = with_waves(scene).cost(scene, chosen.numerics)
        takes.check()
    except FeContactError as failure:
        return None, failure
    return takes, None


MEMBER = base.Command(
    "the settings chosen and what the model leaves out, without solving",
    (
        *base.SCENE,
        *base.OUTPUT,
    ),
    execute,
)
