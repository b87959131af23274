"""The verdict in words, computed: what a law holds and where it errs by more than the error bars leave open.

A comparison as files: a history a law and its scores in CSV, verdict and errors in JSON.
"""

from __future__ import annotations

from pathlib import Path

from fe_contact.studies.compare.nested_areas import NestedAreas
from fe_contact.studies.compare.study import Comparison, Judgement
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

WITHIN = "within the reference's error bar"
DECISIVE = ("history", "held_until_max_depth", "peak_force", "peak_depth", "duration", "restitution")
SCHEMA = "fe-contact/compare/1"
SCORE_COLUMNS = {
    "peak_force": "peak_force_error",
    "peak_time": "peak_time_error",
    "peak_depth": "peak_depth_error",
    "duration": "duration_error",
    "restitution": "restitution_error",
    "impulse": "impulse_error",
    "work": "work_error",
    "loss": "loss_error",
    "shape": "shape_error",
    "peak_shift": "peak_shift_error",
    "contact_radius_rebound": "contact_radius_rebound_error",
    "pressure_rebound": "pressure_rebound_error",
    "held_until_max_depth": "held_until_max_depth_error",
}


def verdicts(comparison: Comparison) -> tuple[str, ...]:
    """One line a candidate, those of equal verdict together; the areas; then the laws that gave no answer."""
    sentences: dict[str, list[str]] = {}
    for judgement in comparison.judgements:
        sentences.setdefault(_sentence(comparison, judgement), []).append(judgement.name)
    lines = [f"{', '.join(names)}: {sentence}" for sentence, names in sentences.items()]
    lines += [] if comparison.nested is None else [_nested(comparison.nested)]
    return (*lines, *(f"{name}: no answer: {reason}" for name, reason in comparison.refused.items()))


def _nested(areas: NestedAreas) -> str:
    """Whether Ting's solution may be asked of this contact."""
    says = "nest as Ting supposes" if areas.holds else "do not nest as Ting supposes"
    return f"areas of contact {says}: paired radii differ by {percent(areas.deviation)}, bar {percent(areas.bar)}"


def _sentence(comparison: Comparison, judgement: Judgement) -> str:
    if not any(judgement.exceeds(name) for name in DECISIVE) and not _only_one_separates(comparison, judgement):
        return WITHIN
    parts = [_approach(judgement)]
    parts += _signed(judgement, "peak_force", "peak force {} too low", "peak force {} too high")
    parts += [_end(comparison, judgement)]
    error = judgement.errors["restitution"]
    if error is not None and judgement.exceeds("restitution"):
        parts.append(f"restitution {_digits(abs(error))} too {'low' if error < 0 else 'high'}")
    return ", ".join(part for part in parts if part)


def _approach(judgement: Judgement) -> str:
    share = percent(judgement.errors["held_until_max_depth"] or 0.0)
    if judgement.exceeds("held_until_max_depth"):
        return f"errs by up to {share} of the peak before maximum depth"
    return f"holds until maximum depth ({share} of the peak)"


def _end(comparison: Comparison, judgement: Judgement) -> str:
    if _only_one_separates(comparison, judgement):
        return "does not separate" if comparison.reference.separated else "separates where the reference does not"
    signed = _signed(judgement, "duration", "ends {} too early", "ends {} too late")
    return signed[0] if signed else "ends on time" if judgement.errors["duration"] is not None else ""


def _only_one_separates(comparison: Comparison, judgement: Judgement) -> bool:
    law = comparison.laws.get(judgement.name)
    return law is not None and law.separated != comparison.reference.separated


def _signed(judgement: Judgement, name: str, low: str, high: str) -> list[str]:
    """The phrase for an error beyond its bar, none otherwise."""
    error = judgement.errors[name]
    if error is None or not judgement.exceeds(name):
        return []
    return [(low if error < 0 else high).format(percent(abs(error)))]


def percent(share: float) -> str:
    """A share in per cent, two significant digits."""
    return f"{_digits(100 * share)} %"


def _digits(value: float) -> str:
    """Two significant digits, never in exponential notation for what a reader meets."""
    return f"{value:.2g}" if 1e-4 <= value < 100 or value == 0 else f"{value:.0f}" if value >= 100 else f"{value:.0e}"


def write_comparison(comparison: Comparison, where: Path) -> None:
    """Write every history, ``scores.csv`` and ``compare.json`` into a folder."""
    comparison.reference.write_files(where)
    for name, law in comparison.laws.items():
        law.history.write_csv(where / f"{name}-history.csv")
    nested = comparison.nested and comparison.nested.holds  # of the reference: the same in every row
    rows = [[j.name, j.score_percent, *(j.errors[key] for key in SCORE_COLUMNS), nested] for j in comparison.judgements]
    write_csv(where / "scores.csv", ["law", "score_percent", *SCORE_COLUMNS.values(), "nested_areas"], rows)
    write_json(where / "compare.json", comparison_content(comparison))


def comparison_content(comparison: Comparison) -> Table:
    """The content of ``compare.json``: verdict, errors, and what the error bars leave open of each."""
    reference = comparison.reference
    content: Table = plain(
        {
            "schema": SCHEMA,
            "scene": reference.scene.name,
            "tolerance": reference.tolerance,
            "converged": reference.converged,
            "verdict": verdicts(comparison),
            "reference": {name: vars(quantity) for name, quantity in reference.quantities.items()},
            "candidates": {
                j.name: {"score_percent": j.score_percent, "errors": j.errors, "bars": j.bars}
                for j in comparison.judgements
            },
            "nested_areas": comparison.nested and vars(comparison.nested) | {"holds": comparison.nested.holds},
            "refused": comparison.refused,
        }
    )
    return content
