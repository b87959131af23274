"""``fe-contact plan SCENE``: the cheapest method and why, the settings of finite elements and the model ledger."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from fe_contact.commands import base
from fe_contact.settings import KEYS, SCALES
from lumped.errors import FeContactError, NotReached
from lumped.result.result import good_to
from lumped.scene.scene import Scene
from lumped.schema import Table

if TYPE_CHECKING:  # finite elements are loaded when they are needed
    from fe_contact.budget.plan import Plan
    from fe_contact.waves.plan import Cost


def execute(args: argparse.Namespace) -> int:
    """Print the methods, settings, ledger, what waves take, why finite elements refuse the scene; 3 where too much.

    An exact law is asked, in milliseconds; finite elements only with --measure, or where a material softens.
    """
    from fe_contact.budget.solved import planned
    from fe_contact.methods import lines_of, settings, weigh
    from fe_contact.reference import plan

    scene, table = base.read_scene(args)
    progress, given = base.progress_of(args), settings(table, None, scene.source)
    progress("plan")
    weighing = weigh(scene, given, progress)
    taken, weighed = weighing.taken, weighing.to_json()
    method = {"name": taken.method, "bar": taken.bar, "cpu_s": taken.cpu_s, "reason": taken.reason}
    title, methods = f"{scene.name}: {taken}", {"method": method, "weighed": weighed}
    lines = ["weighed:", *(f"  {line}" for line in lines_of(weighed))]
    if not scene.has_geometry:
        nothing: Table = {"numerics": None, "model_ledger": [], "cost": None, "refused": None}
        base.say(args, methods | nothing, lines, title)
        return base.DONE
    chosen = planned(scene, given, progress, plan)
    takes, refused = _takes(scene, chosen, given)
    ledger = [entry.to_json(float(chosen.numerics.tolerance)) for entry in chosen.ledger]
    content = methods | {
        "numerics": chosen.numerics.as_dict(),
        "model_ledger": ledger,
        "cost": takes and takes.as_dict(),
        "refused": refused and str(refused),
    }
    lines += _lines(chosen, takes)
    if args.measure:
        from fe_contact.studies.larger_models import measure, measured_lines

        measured = measure(scene, given, progress)
        content["measured"] = [one.to_json() for one in measured]
        lines += measured_lines(measured, chosen.ledger)
    base.say(args, content, lines, title)
    if refused and not args.json:
        base.complain(str(refused))
    return base.NOT_REACHED if isinstance(refused, NotReached) else base.DONE  # what only laws can follow is a plan too


def _lines(chosen: Plan, takes: Cost | None) -> list[str]:
    """Every setting, what waves take, every effect left out."""
    tolerance = float(chosen.numerics.tolerance)
    words = {name: key.meaning for name, key in KEYS.items()} | SCALES
    lines = ["settings of finite elements:"]
    for key, value in chosen.numerics.as_dict().items():
        lines.append(f"  {key:21s} {value if not isinstance(value, float) else format(value, '.6g'):<12} {words[key]}")
    lines += [] if takes is None else [f"takes {takes}"]
    lines.append("left out, relative to the peak force:")
    return [*lines, *(f"  {entry.line(tolerance)}" for entry in chosen.ledger), good_to(chosen.ledger)]


def _takes(scene: Scene, chosen: Plan, given: Table) -> tuple[Cost | None, FeContactError | None]:
    """What waves take, None without them, and why finite elements refuse the scene, None where they do not."""
    from fe_contact.errors import faults_of
    from fe_contact.large_strains import check_range
    from fe_contact.reference import check, with_waves
    from fe_contact.settings import WaveNumerics

    try:
        if not scene.model.inertia:
            check(scene, given)
            with faults_of(scene):
                check_range(scene)
            return None, None
        assert isinstance(chosen.numerics, WaveNumerics)
        with faults_of(scene):
            takes = with_waves(scene).cost(scene, chosen.numerics)
            takes.check()
    except FeContactError as failure:
        return None, failure
    return takes, None


MEMBER = base.Command(
    "the cheapest method, the settings of finite elements, and what the model leaves out",
    (
        *base.SCENE,
        *base.OUTPUT,
        base.MEASURE,
    ),
    execute,
    example="fe-contact plan polymer-sphere --tolerance 1e-2",
    group=base.START,
)
