"""``fe-contact paper``: every number of the source paper, printed and recomputed, with a verdict by rule."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from lumped.result.folder import publish

if TYPE_CHECKING:
    from lumped.paper import JudgedClaim, Value
    from lumped.paper.study import PaperStudy


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--set a.b=value ...] [--out DIR] [--json] [--quiet]."""
    base.override_argument(parser, "change an input of the examples, as steel.density=8000")
    base.output_arguments(parser)


def execute(args: argparse.Namespace) -> int:
    """Recompute, write, say the verdicts; 0."""
    from fe_contact.studies.paper.chart import plot_paper
    from fe_contact.studies.paper.files import write_study
    from lumped.paper import Examples
    from lumped.paper.study import study

    examples = Examples.load(base.overrides_of(args))
    where = base.folder(args, "paper", examples.name)
    progress = base.progress_of(args)
    found = study(examples, progress)

    def write(folder: Path) -> None:
        write_study(found, folder)
        progress("charts")
        plot_paper(found, folder)

    content = publish(where, write, "paper.json")
    base.tell(args, content, _lines(found), where)
    return base.DONE


def _lines(found: PaperStudy) -> list[str]:
    """One line a claim, one an assumption, then the counts."""
    from lumped.paper.claims import counts
    from lumped.paper.rules import AGREES, DIFFERS, UNDECIDED, UNKNOWN, UNPRINTED, VERDICTS

    lines = [f"{'claim':14s} {'quantity':54s} {'printed':26s} {'recomputed':30s} {'deviation':>9s}  verdict"]
    lines += [_line(one) for one in found.claims]
    for judged in found.assumptions:
        one = judged.assumption
        lines.append(f"{one.id:17s} {one.assumption}: {one.criterion} {_shown(judged.values)}: {judged.verdict}")
    number = counts(found.claims)
    reasons = ", ".join(f"{count} {name}" for name, count in number.items() if name not in VERDICTS)
    sums = f"{number[AGREES]} agree, {number[DIFFERS]} differ, {number[UNDECIDED]} {UNDECIDED}"
    lines.append(f"{sums}, {number[UNKNOWN]} {UNKNOWN} ({reasons})")
    lines.append(f"{number[UNPRINTED]} numbers beside them with {UNPRINTED}")
    return lines


def _line(one: JudgedClaim) -> str:
    from lumped.paper.rules import UNJUDGED, UNKNOWN

    claim, share = one.claim, "" if one.deviation is None else f"{round(100.0 * one.deviation, 2) + 0.0:+.2f} %"
    printed = f"{claim.printed} {claim.unit}" if claim.printed and claim.unit != "1" else claim.printed
    values, verdict = _shown(one.values), one.verdict
    if claim.rule.kind in UNJUDGED:  # the value is not the claimed quantity
        reason = f" ({claim.rule.name})" if verdict == UNKNOWN else ""
        beside = ": ".join(part for part in (claim.recomputed_as, values) if part)
        values, verdict = "", "; ".join(part for part in (verdict + reason, beside) if part)
    return f"{claim.id:14s} {claim.quantity:54s} {printed:26s} {values:30s} {share:>9s}  {verdict}"


def _shown(values: Sequence[Value]) -> str:
    return "; ".join(f"{value.value:.5g}" for value in values)


MEMBER = base.Command(
    "the source paper's claims: printed, recomputed, deviation, verdict; its figures drawn again", arguments, execute
)
