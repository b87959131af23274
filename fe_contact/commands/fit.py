"""``fe-contact fit CURVE.csv --law NAME --scene SCENE``: the parameters of a law from a force history."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.errors import BadInput, Fault, addressed, shown
from lumped.schema import Table

if TYPE_CHECKING:
    from lumped.fit import Fit
    from lumped.fit.ranking import RankedFit
    from lumped.result.score import Curve
    from lumped.scene.scene import Scene

EVERY = "all"
OPTIONS = {"free": "--free", "fixed": "--fix", "bounds": "--bounds", "law": "--law", "curve": "force_N"}


@dataclass(frozen=True, eq=False)
class FitQuestion:
    """What a command line asks: the run, the scene, the judged curve and remarks on it, free and held parameters."""

    run: base.StudyRun
    scene: Scene
    curve: Curve
    free: tuple[str, ...] | None
    fixed: Mapping[str, float]
    remarks: tuple[str, ...]

    @classmethod
    def of(cls, args: argparse.Namespace) -> FitQuestion:
        """Raises BadInput, also for a curve that is no impact of the scene."""
        from lumped.fit.space import TOUCH
        from lumped.result.curve_file import read_curve
        from lumped.result.gate import check_curve

        scene, curve = base.read_scene_for_fit(args), read_curve(args.curve)
        free = None if args.free is None else tuple(name.strip() for name in args.free.split(","))
        fixed = {name: base.number(value, "--fix") for name, value in _pairs(args.fix, "--fix")}
        run = base.StudyRun.of(args, "fit-all" if args.law == EVERY else "fit", scene.name)
        remarks = check_curve(curve, scene, str(args.curve), TOUCH not in {*(free or ()), *fixed})
        return cls(run, scene, curve, free, fixed, remarks)

    @contextmanager
    def addressed(self) -> Iterator[None]:
        """Faults within are those of the options, the curve's file, and the scene's."""
        with addressed(str(self.run.args.curve), OPTIONS), self.scene.addressed():
            yield


def execute(args: argparse.Namespace) -> int:
    """Fit one law or every one, write, report; 0 or 3."""
    every = args.law == EVERY
    (_check_ranking if every else _check_opensees)(args)
    asked = FitQuestion.of(args)
    asked.run.progress("fits of every law" if every else f"fit of {args.law}")
    code = (_rank if every else _fit)(asked)
    for remark in asked.remarks:
        base.complain(remark)
    return code


def _fit(asked: FitQuestion) -> int:
    """Fit a law, write, say its parameters; 0 or 3."""
    from fe_contact.studies.fit_chart import plot_fit
    from lumped.fit import RECORD, fit, write_failure

    args, where = asked.run.args, asked.run.where
    bounds = dict(_bounds(args.bounds))
    with base.recorded(partial(write_failure, where, args.law)), asked.addressed():
        found = fit(asked.curve, args.law, asked.scene, asked.free, asked.fixed, bounds, args.peak, asked.run.progress)
    published = base.publish(where, found.write_files, partial(plot_fit, asked.curve, found), record=RECORD)
    _report(args, asked.scene, found, *published)
    return base.DONE if found.result.converged else base.NOT_REACHED


def _rank(asked: FitQuestion) -> int:
    """Fit every law, write, say the ranking; 0."""
    from fe_contact.studies.fit_chart import plot_ranking
    from lumped.fit.ranking import RECORD, rank, write_ranking

    with asked.addressed():
        ranked = rank(asked.curve, asked.scene, asked.fixed, asked.free is not None, asked.run.progress)
    lines = [_ranking_line(i, one) for i, one in enumerate(ranked, start=1)]
    write, plot = partial(write_ranking, ranked, asked.curve), partial(plot_ranking, ranked, asked.curve)
    return asked.run.finish(RECORD, lines, write, plot, "law by law")


def _ranking_line(rank: int, one: RankedFit) -> str:
    if one.fit is None or one.whiteness is None:
        return f" -  {one.law:16s} {one.reason}"
    left = "noise is left" if one.whiteness.noise else "more than noise is left"
    values = ", ".join(f"{name} {estimate}" for name, estimate in one.fit.parameters.items())
    known = f"{one.fit.error_in_words:>9s}, AICc +{one.criterion:.4g}, {left}"
    return f"{rank:2d}  {one.law:16s} {known}: {values}"


def _report(args: argparse.Namespace, scene: Scene, found: Fit, content: Table, told: str) -> None:
    """Parameters; for OpenSees the law, with the parameters as comments; warnings on stderr."""
    from lumped import laws
    from lumped.fit import opensees

    text = [*found.summary().splitlines(), f"  {told}"]
    if args.opensees:
        law = laws.get(found.law).of(found.scene)
        # what is fitted of a material stands in the fit's scene, the gap in that given
        lines = opensees.lines(law, replace(found.scene, law=scene.law), language=args.opensees)
        text = [*(f"# {line}" for line in text), lines]
        content["opensees"] = lines.splitlines()
    base.say(args, content, text)
    for warning in found.warnings:
        base.complain(warning)


def _check_opensees(args: argparse.Namespace) -> None:
    """Refuse, before anything is computed, what OpenSees does not have; raises BadInput."""
    from lumped.fit import opensees

    if args.opensees is None:
        return
    with addressed(str(args.curve), OPTIONS):
        opensees.check(args.law)
    if args.opensees not in opensees.LANGUAGES:
        reason = f"{shown(args.opensees)}: accepted {', '.join(opensees.LANGUAGES)}"
        raise BadInput(Fault("--opensees", "", reason))


def _check_ranking(args: argparse.Namespace) -> None:
    """Refuse what only one law has; raises BadInput."""
    from lumped.fit.space import TOUCH

    given = {"--bounds": args.bounds, "--peak": args.peak, "--opensees": args.opensees}
    chosen = [name for name, value in given.items() if value]
    if chosen or args.free not in (None, TOUCH):
        reason = f"with --law {EVERY} each law has its own; accepted: --free {TOUCH}, --fix; cure: choose one law"
        raise BadInput(Fault(name, "", f"{reason} for {name}") for name in chosen or ["--free"])


def _pairs(text: str, option: str) -> Iterator[tuple[str, str]]:
    """`a=1,b=2` as pairs. Raises BadInput."""
    parts = filter(None, (part.strip() for part in text.split(",")))
    return base.pairs(parts, option, "accepted: name=value, separated by commas")


def _bounds(text: str) -> Iterator[tuple[str, tuple[float, float]]]:
    """`a=1:2` as name and ends. Raises BadInput."""
    for name, ends in _pairs(text, "--bounds"):
        low, sign, high = ends.partition(":")
        if not sign:
            raise BadInput(Fault("--bounds", name, f"{shown(ends)}: accepted low:high"))
        yield name, (base.number(low, "--bounds"), base.number(high, "--bounds"))


MEMBER = base.Command(
    "parameters of a law from a force history, with 95 % confidence intervals",
    (
        base.option("curve", type=Path, metavar="CURVE.csv", help="measured force: time_s,force_N"),
        base.option("--law", required=True, metavar="NAME", help="a lumped law (fe-contact laws), or all, ranked"),
        base.option("--scene", required=True, help="scene (file or packaged name) with mass, velocity, geometry"),
        base.option(
            "--free",
            metavar="a,b,...",
            help="what is found, others being held; default: stiffness and damping; to find the touch, s, too, "
            "name it beside them: k,xi,touch of jankowski; of all laws: touch",
        ),
        base.option("--fix", default="", metavar="a=v,...", help="parameters held at a value"),
        base.option("--bounds", default="", metavar="a=low:high,...", help="bounds of free parameters"),
        base.option("--peak", action="store_true", help="least error at equal peak force, (26)"),
        base.option("--opensees", nargs="?", const="tcl", metavar="tcl|python", help="print the law for OpenSees"),
        base.override(),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact fit curve.csv --law hunt_crossley --scene polymer-sphere --opensees",
    group=base.LAWS,
)
