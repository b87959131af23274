"""``fe-contact ring [--out DIR] [--json] [--quiet]``: what rings really do, against the paper's (27)-(32)."""

from __future__ import annotations

import argparse
from functools import partial

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Press, strike, judge, write, draw; 0, or 3 where finite elements missed their tolerance."""
    if args.kinematics == "finite":
        from fe_contact.studies.rings import finite_rows

        return base.finite_exponents(args, "ring", finite_rows)
    from fe_contact.studies.rings import cases, missed, rings, struck, told, write_rings
    from fe_contact.studies.rings_chart import plot_rings

    run = base.StudyRun.of(args, "ring", "paper")
    curves = rings(cases(), run.where, run.progress)
    impacts = struck(cases(), run.where, run.progress)
    write, plot = partial(write_rings, curves, impacts=impacts), partial(plot_rings, curves, impacts=impacts)
    return run.finish("ring.json", told(curves, impacts), write, plot, missed=missed(curves, impacts))


MEMBER = base.Command(
    "rod in ring, O-ring and washer pressed, the paper's ring struck, by finite elements against its (27)-(32)",
    (*base.OUTPUT, base.KINEMATICS),
    execute,
)
