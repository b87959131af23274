"""``fe-contact exponents [--quick] [--out DIR] [--json]``: exponents of contact, from half-space to thin layer."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Solve, check, write, draw; 0, or 3 where finite elements missed their tolerance."""
    from fe_contact.studies.exponents import checks, curves, missed, pairs, write_exponents
    from fe_contact.studies.exponents_chart import plot_exponents

    run = base.StudyRun.of(args, "exponents", "layers")
    found, checked = curves(args.quick, run.where, run.progress), checks(args.quick, run.where, run.progress)
    spheres = pairs(args.quick, run.where, run.progress)
    told = [*(one.told for one in found), *(one.told for one in checked), *(one.told for one in spheres)]
    write, plot = partial(write_exponents, found, checked, spheres), partial(plot_exponents, found, checked)
    return run.finish("exponents.json", told, write, plot, missed=missed(checked, spheres))


MEMBER = base.Command(
    "local exponent and D from the half-space to the thin layer, every profile, base and nu, checked by finite "
    "elements; how far finite spheres are from Hertz",
    (*base.OUTPUT, base.quick("fewer points, two Poisson's ratios")),
    execute,
)
