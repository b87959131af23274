"""``fe-contact exponents``: where the exponents of contact lie, from the half-space to the thin layer."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from fe_contact.studies.exponents.check import Check
    from fe_contact.studies.exponents.study import ExponentCurve


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--quick] [--out DIR] [--json] [--quiet]."""
    base.output_arguments(parser)
    parser.add_argument("--quick", action="store_true", help="fewer points, two Poisson's ratios")


def execute(args: argparse.Namespace) -> int:
    """Solve, check, write, draw; 0, or 3 where finite elements missed their tolerance."""
    from fe_contact.studies.exponents.chart import plot_exponents
    from fe_contact.studies.exponents.check import checks, write_exponents
    from fe_contact.studies.exponents.finite_spheres import pairs
    from fe_contact.studies.exponents.study import curves

    where = base.folder(args, "exponents", "layers")
    progress = base.progress_of(args)
    found, checked = curves(args.quick, where, progress), checks(args.quick, where, progress)
    spheres = pairs(args.quick, where, progress)

    def write(folder: Path) -> None:
        write_exponents(found, checked, spheres, folder)
        progress("chart")
        plot_exponents(found, checked, folder)

    content = publish(where, write, "exponents.json")
    base.tell(args, content, [*map(_curve, found), *map(_check, checked), *(pair.told for pair in spheres)], where)
    reached = [*(check.converged for check in checked), *(pair.converged for pair in spheres)]
    if missed := reached.count(False):
        base.complain(f"tolerance not reached at {missed} of {len(reached)} places checked by finite elements")
    return base.NOT_REACHED if missed else base.DONE


def _curve(curve: ExponentCurve) -> str:
    layer = f"{curve.base}, " + ("any nu" if curve.nu is None else f"nu = {curve.nu:g}")
    ends = f"alpha {curve.exponent[0]:.3f} to {curve.exponent[-1]:.3f} at a/h = {curve.ratio[-1]:g}"
    return f"{curve.profile.label:12s} {layer:18s} {ends}, thin limit {curve.thin:.3f}"


def _check(check: Check) -> str:
    layer = f"{check.base}, " + ("any nu" if check.nu is None else f"nu = {check.nu:g}")
    return (
        f"{check.profile.label:12s} {layer:18s} a/h = {check.ratio:g} by FE: alpha {check.exponent.value:.5f} +- "
        f"{check.exponent.error:.0e} (exact {check.exact_exponent:.5f}), D {check.factor.value:.5f} +- "
        f"{check.factor.error:.0e} (exact {check.exact_factor:.5f})"
    )


MEMBER = base.Command(
    "local exponent and D from the half-space to the thin layer, every profile, base and nu, checked by finite "
    "elements; how far finite spheres are from Hertz",
    arguments,
    execute,
)
