"""``fe-contact compare SCENE``: the finite-element reference against lumped laws and a measured curve."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.errors import BadInput, Fault, shown

if TYPE_CHECKING:
    from lumped.result.score import Curve


def execute(args: argparse.Namespace) -> int:
    """Solve, judge, write, say the verdict; 0 or 3."""
    from fe_contact.methods import settings
    from fe_contact.studies.compare.chart import plot_comparison
    from fe_contact.studies.compare.study import compared, comparison_content, write_comparison
    from lumped.result.gate import check_curve

    scene, table = base.read_scene(args)
    given, names = settings(table, None, scene.source), law_names(args.laws)
    measured = _measured(args)
    remarks = () if measured is None else check_curve(measured, scene, str(args.measured))
    run = base.StudyRun.of(args, "compare", scene.name)
    comparison, lines = compared(scene, given, names, measured, run.progress), list[str]()
    if args.measure:
        from fe_contact.studies.larger_models import measure, measured_lines

        larger = measure(scene, given, run.progress)
        comparison = replace(comparison, larger=larger)
        lines = measured_lines(larger, comparison.reference.model_ledger)
    content = comparison_content(comparison)
    _, told = base.publish(run.where, partial(write_comparison, comparison), partial(plot_comparison, comparison))
    for remark in remarks:
        base.complain(remark)
    title = f"{scene.name}: against finite elements"
    return base.report(args, comparison.reference, content, [*content["verdict"], *lines, told], title, scene.model)


def _measured(args: argparse.Namespace) -> Curve | None:
    """The measured curve, its times from the touch on; None where none is given. Raises BadInput."""
    from lumped.result.curve_file import read_curve

    touch = base.number(args.touch, "--touch")
    if not math.isfinite(touch) or (touch and args.measured is None):
        raise BadInput(Fault("--touch", "", f"{shown(args.touch)}: accepted a time on the clock of --measured, s"))
    if args.measured is None:
        return None
    curve = read_curve(args.measured)
    first, last = float(curve.time[0]), float(curve.time[-1])
    if touch and not first <= touch <= last:
        reason = f"{touch:g} s is not in {args.measured}, which is from {first:.4g} to {last:.4g} s"
        raise BadInput(Fault("--touch", "", f"{reason}; accepted: a time on its clock, s"))
    return replace(curve, time=curve.time - touch)


def law_names(text: str | None) -> tuple[str, ...]:
    """Checked names of the laws asked for, each once, or of all; raises BadInput with every unknown one."""
    from lumped.errors import nearest
    from lumped.laws import available

    if text is None:
        return available()
    names, known = tuple(dict.fromkeys(name.strip() for name in text.split(","))), available()
    faults = [
        Fault("--laws", "", f"{shown(name)}: accepted {', '.join(known)}{nearest(name, known)}")
        for name in names
        if name not in known
    ]
    if faults:
        raise BadInput(faults)
    return names


MEMBER = base.Command(
    "the finite-element reference against lumped laws: scores, verdict, chart",
    (
        *base.SCENE,
        *base.OUTPUT,
        base.option("--laws", metavar="a,b,...", help="lumped laws; default: all that the scene has an answer of"),
        base.MEASURE,
        base.option("--measured", type=Path, metavar="CURVE.csv", help="measured force: time_s,force_N"),
        base.option("--touch", default="0", metavar="T", help="when the bodies touch in that, s; fit or identify tell"),
    ),
    execute,
    example="fe-contact compare polymer-sphere --laws ting,hertz,kelvin",
    group=base.LAWS,
)
