"""``fe-contact ptmd [FILE]``: section 5 of the paper, a structure with a pounding tuned mass damper."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.errors import NotReached
from lumped.result.folder import publish
from lumped.result.result import worst

if TYPE_CHECKING:
    from lumped.ptmd.study import PtmdStudy


def arguments(parser: argparse.ArgumentParser) -> None:
    """[FILE] [--set a.b=value ...] [--out DIR] [--json] [--quiet]."""
    parser.add_argument("file", nargs="?", default="paper", help="file (TOML) or packaged name; default: the paper's")
    base.override_argument(parser, "override a key of the file")
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Simulate, write, report; 0 or 3."""
    from fe_contact.studies.ptmd.chart import plot_study
    from fe_contact.studies.ptmd.files import RECORD, write_failure, write_study
    from lumped.ptmd.case_file import load
    from lumped.ptmd.study import study

    case = load(args.file, base.overrides_of(args))
    where = base.folder(args, "ptmd", case.name)
    try:
        found = study(case, base.progress_of(args))
    except NotReached as failure:
        write_failure(case, str(failure), where)
        raise

    def write(folder: Path) -> None:
        write_study(found, folder)
        plot_study(found, folder)

    content = publish(where, write, RECORD)
    title = f"{case.name}: {case.end_time:g} s of free vibration"
    base.tell(args, content, _lines(found), where, title)
    for line in _warnings(found):
        base.complain(line)
    return base.NOT_REACHED if found.convergence.message else base.DONE


def _lines(found: PtmdStudy) -> list[str]:
    """The measures of every variant, then the energies, one a line."""
    lines = []
    for name, result in found.results.items():
        m = result.measures
        halved = "not reached" if m.t50 is None else f"{m.t50:.3g} s"
        lines.append(
            f"{name:19s} rms x1 {1e3 * m.rms_displacement:.4g} mm, max |a1| {m.max_acceleration:.4g} m/s2, "
            f"last above 50 % {halved}, contacts {m.contacts}"
        )
    m, energy = found.main.measures, found.main.energy
    lines.append(f"peak force {m.peak_force:.4g} N, penetration {1e3 * m.peak_depth:.4g} mm")
    lines.append(
        f"of {energy.initial:.4g} J lost in structure {energy.lost_structure:.4g}, damper {energy.lost_damper:.4g}, "
        f"ring {energy.lost_ring:.4g}; residual {energy.residual:.1e}"
    )
    return lines


def _warnings(found: PtmdStudy) -> list[str]:
    """What did not converge, and an assumption of the contact law that does not hold."""
    lines = [found.convergence.message] if found.convergence.message else []
    if not found.model_sufficient:
        most = worst(found.ledger)
        lines.append(f"the contact law assumes small deformation: {most.effect} is {most.estimate:.2g}")
    return lines


MEMBER = base.Command(
    "free vibration of a pounding tuned mass damper: motion, contacts, energies, chart", arguments, execute
)
