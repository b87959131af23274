"""``fe-contact table1``: the eight rows of the paper's Table 1 by finite elements, with error bars and verdicts."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from fe_contact.studies.table1.study import Trial


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--out DIR] [--json] [--quiet]."""
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Press, identify, judge, write, draw; 0, or 3 where bars leave a row undecided."""
    from fe_contact.studies.table1.study import table1
    from fe_contact.studies.table1.verdict import UNDECIDED, verdict, write_table1

    where = base.folder(args, "table1", "paper")
    progress = base.progress_of(args)
    trials = table1(where, progress)

    def write(folder: Path) -> None:
        write_table1(trials, folder)
        progress("chart")
        from fe_contact.studies.table1.chart import plot_table1  # matplotlib, once the two processes are gone

        plot_table1(trials, folder)

    content = publish(where, write, "table1.json")
    base.tell(args, content, [line for trial in trials for line in _said(trial)], where)
    undecided = [trial.row.name for trial in trials if verdict(trial).word == UNDECIDED]
    if undecided:
        base.complain(f"undecided: {', '.join(undecided)}")
    return base.NOT_REACHED if undecided else base.DONE


def _said(trial: Trial) -> list[str]:
    """A row: its verdict, then its numbers."""
    from fe_contact.studies.table1.verdict import verdict

    row, judged = trial.row, verdict(trial)
    lines = [f"{row.number} {row.case}: {judged.word}: {judged.sentence}"]
    if trial.alpha is not None and trial.factor is not None:
        alpha, factor = trial.alpha, trial.factor
        lines.append(f"    alpha {alpha.value:.6g} +- {alpha.error:.1e}, printed {row.alpha:g}")
        lines.append(f"    D {factor.value:.6g} +- {factor.error:.1e} {factor.unit}, printed {row.factor:.6g}")
    if trial.moduli:
        nu, found = max(trial.moduli.items())
        lines.append(f"    E* {found.value:.6g} +- {found.error:.1e} Pa at nu = {nu:g}, printed {row.printed[1]}")
    return [*lines, *_struck(trial)]


def _struck(trial: Trial) -> list[str]:
    """What its impacts say."""
    if trial.impact is None:
        return []
    found = trial.impact
    said = [] if found.alpha is None or found.factor is None else [
        f"alpha {found.alpha.value:.6g} +- {found.alpha.error:.1e}",
        f"D {found.factor.value:.6g} +- {found.factor.error:.1e} {found.factor.unit}",
    ]  # fmt: skip
    nu, modulus = max(found.moduli.items())
    said.append(f"E* {modulus.value:.6g} +- {modulus.error:.1e} Pa at nu = {nu:g}")
    return [f"    from impact: {', '.join(said)}"]


MEMBER = base.Command(
    "the paper's Table 1 on trial: D, alpha and E* of every row by finite elements, with error bars and verdicts",
    arguments,
    execute,
)
