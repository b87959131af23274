"""``fe-contact exponents [--quick] [--out DIR] [--json]``: exponents of contact, and what is read from impacts."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Solve, check, write, draw; 0, or 3 where finite elements missed their tolerance."""
    if args.kinematics == "finite":
        from fe_contact.studies.exponents.layers import finite_rows

        return base.finite_exponents(args, "exponents", partial(finite_rows, args.quick))
    from fe_contact.studies.exponents.chart import plot_exponents
    from fe_contact.studies.exponents.study import study

    run = base.StudyRun.of(args, "exponents", "layers")
    found = study(args.quick, run.where, run.progress)
    plot = partial(plot_exponents, found)
    return run.finish("exponents.json", found.told, found.write, plot, missed=found.missed)


MEMBER = base.Command(
    "exponents and D from the half-space to the thin layer, checked by finite elements; how wrong those are that are "
    "read from impacts",
    (*base.OUTPUT, base.KINEMATICS, base.quick("fewer points, two Poisson's ratios, three impacts")),
    execute,
    example="fe-contact exponents --quick",
)
