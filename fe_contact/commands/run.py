"""``fe-contact run SCENE``: one impact, its history and its error bars."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.errors import BadInput, Fault, NotReached
from lumped.result.result import Result, write_failure
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema import Table

if TYPE_CHECKING:  # finite elements are loaded when they are needed
    from fe_contact.plastic.fields import PressedAgain
    from fe_contact.reference import Solved
    from fe_contact.studies.larger_models import SufficientModel


EFFECTS = ("inertia", "kinematics", "plasticity")  # keys of the model that a larger one switches on


def execute(args: argparse.Namespace) -> int:
    """Run, write, report; 0 or 3."""
    from fe_contact.methods import default

    scene, table = base.read_scene(args)
    args.method = default(scene) if args.method is None else args.method
    where = base.folder(args, "run", scene.name)
    larger = _larger(args, scene, table)
    asked = scene if larger is None else larger.scene
    _check(args, asked)
    while True:
        try:
            return _impact(args, asked, table, where, [] if larger is None else [str(larger)])
        except NotReached as refused:
            if larger is None or not larger.taken or args.method != "fe":
                write_failure(where, asked, args.method, str(refused))
                raise
            larger = larger.less(scene, refused)
            asked = larger.scene


def _larger(args: argparse.Namespace, scene: Scene, table: Table) -> SufficientModel | None:
    """The larger model that was asked for. Raises BadInput."""
    if args.model == "given":
        return None
    if scene.shape is None:
        reason = "sufficient: there are larger models of a shape and a material, and the scene has a law alone"
        raise BadInput(Fault("--model", "", f"{reason}; accepted: given"))
    from fe_contact.methods import settings
    from fe_contact.studies.larger_models import sufficient

    return sufficient(scene, settings(table, None, scene.source))


def _impact(args: argparse.Namespace, scene: Scene, table: Table, where: Path, taken: list[str]) -> int:
    from fe_contact.methods import lines_of, settings, simulate

    if args.method == "fe":
        from fe_contact.reference import answered

        result, solved = answered(scene, settings(table, None, scene.source), base.progress_of(args))
    else:
        result, solved = simulate(scene, args.method, table, progress=base.progress_of(args)), None
        if taken:
            _check_taken(args.method, scene.model, result.model)
    content, told = base.publish(where, lambda folder: _write(args, solved, result, folder))
    title, *lines = result.summary().split("\n  ")
    weighed = (f"weighed: {line}" for line in lines_of(result.weighed))
    return base.report(args, result, content, [*taken, *weighed, *lines, told], title, scene.model)


def _check_taken(method: str, asked: Model, answered: Model) -> None:
    """Raises BadInput where a law leaves out an effect that the sufficient model takes in."""
    names = [f"model.{name}" for name in EFFECTS if getattr(asked, name) != getattr(answered, name)]
    if names:
        reason = f"sufficient: that takes {', '.join(names)}, which {method} leaves out; accepted: --method fe"
        raise BadInput(Fault("--model", "", reason))


def _write(args: argparse.Namespace, solved: Solved | None, result: Result, folder: Path) -> None:
    """The files of a result, and what else was asked for."""
    result.write_files(folder)
    again = _pressed_again(result) if args.fields or args.plot else None
    if args.fields:
        _write_fields(result, solved, again, folder)
    if args.plot:
        from fe_contact.studies.history_chart import plot_history

        plot_history(result, folder, solved, None if again is None else again.dent)


def _pressed_again(result: Result) -> PressedAgain | None:
    """The body at the largest force and at the end, where it yields by finite elements."""
    if result.method != "fe" or not result.model.plasticity or result.model.inertia:
        return None
    from fe_contact.plastic.fields import PressedAgain

    return PressedAgain.of(result.scene, result)


def _check(args: argparse.Namespace, scene: Scene) -> None:
    """Refuse, before anything is computed, fields that this method or scene cannot give; raises BadInput."""
    if not args.fields:
        return
    if args.method != "fe":
        raise BadInput(Fault("--fields", "", "only with --method fe"))
    from fe_contact.fields import check_fields
    from fe_contact.reference import with_waves

    if scene.model.inertia and (with_waves(scene).write_fields is None or scene.striker_material is not None):
        reason = f"{scene.target.name}: accepted with --fields and model.inertia: half_space, its striker rigid"
        raise BadInput(Fault(scene.source, "target.shape", reason))
    if not (scene.model.inertia or scene.model.plasticity):
        check_fields(scene)


def _write_fields(result: Result, solved: Solved | None, again: PressedAgain | None, where: Path) -> None:
    from fe_contact.fields import strained_fields, write_fields, written
    from fe_contact.reference import strained_at_peak, with_waves

    if again is not None:
        again.write_fields(result.quantities["peak_time"].value or 0.0, where)
    elif result.model.finite:
        written(strained_fields(result, *strained_at_peak(result)), where)
    elif solved is None:
        write = with_waves(result.scene).write_fields
        assert write is not None  # see _check
        write(result.scene, result, where)
    else:
        write_fields(result.scene, solved.certified, where)


MEMBER = base.Command(
    "one impact: history.csv and result.json, with error bars",
    (
        *base.SCENE,
        *base.OUTPUT,
        base.option("--method", help="fe (default without [law]), cheapest, or a lumped law"),
        base.option(
            "--model",
            choices=("given", "sufficient"),
            default="given",
            help="sufficient: with every effect that the model ledger puts above the tolerance and has a key for",
        ),
        base.option("--fields", action="store_true", help="VTU of the fields at peak force"),
        base.option("--plot", action="store_true", help="force history and contact pressure as SVG and PNG"),
    ),
    execute,
    example="fe-contact run polymer-sphere --plot",
    group=base.START,
)
