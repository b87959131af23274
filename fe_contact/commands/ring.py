"""``fe-contact ring``: what rings really do, against the paper's (27)-(32)."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from fe_contact.studies.rings.impact import RingStruck
    from fe_contact.studies.rings.study import RingCurve


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--out DIR] [--json] [--quiet]."""
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Press, strike, judge, write, draw; 0, or 3 where finite elements missed their tolerance."""
    from fe_contact.studies.rings.chart import plot_rings
    from fe_contact.studies.rings.impact import struck
    from fe_contact.studies.rings.study import cases, rings
    from fe_contact.studies.rings.verdict import write_rings

    where = base.folder(args, "ring", "paper")
    progress = base.progress_of(args)
    curves = rings(cases(), where, progress)
    impacts = struck(cases(), where, progress)

    def write(folder: Path) -> None:
        write_rings(curves, folder, impacts)
        progress("chart")
        plot_rings(curves, folder)

    content = publish(where, write, "ring.json")
    lines = [line for curve in curves for line in _said(curve)] + [line for one in impacts for line in _told(one)]
    base.tell(args, content, lines, where)
    missed = [curve.case.name for curve in curves if not curve.found.converged]
    missed += [one.ring for one in impacts if not (one.found.converged and one.bulk.converged)]
    if missed:
        base.complain(f"tolerance not reached: {', '.join(missed)}")
    return base.NOT_REACHED if missed else base.DONE


def _said(curve: RingCurve) -> list[str]:
    """A ring: the verdict, then every depth."""
    from fe_contact.studies.rings.verdict import verdict

    judged, found = verdict(curve), curve.found
    lines = [f"{curve.case.name}: (27)-(29) {judged.word}: {judged.sentence}"]
    lines += [f"    {one.effect} ({one.treated}): {one.estimate or 0.0:.2g}, {one.note}" for one in curve.ledger]
    table = zip(
        found.depth, found.force, found.force_error, curve.row_force, curve.exponent, curve.exponent_error, strict=True
    )
    return lines + [
        f"    {1e3 * depth:.3g} mm  {force:.5g} +- {error:.1e} N, row {row:.5g} N; alpha {alpha:.4g} +- {bar:.0e}"
        for depth, force, error, row, alpha, bar in table
    ]


def _told(one: RingStruck) -> list[str]:
    """An impact: the verdict, and what a constant bulk modulus would change."""
    changes = ((name, *one.of_bulk(name)) for name in ("peak_force", "peak_depth", "duration", "restitution"))
    bulk = ", ".join(f"{name} {100 * change:+.2g} +- {100 * bar:.1g} %" for name, change, bar in changes)
    return [
        f"{one.ring} struck at {1e3 * one.velocity:.3g} mm/s: (30)-(32) {one.verdict}",
        f"    constant bulk modulus instead of constant nu: {bulk}",
    ]


MEMBER = base.Command(
    "rod in ring, O-ring and washer pressed, the paper's ring struck, by finite elements against its (27)-(32)",
    arguments,
    execute,
)
