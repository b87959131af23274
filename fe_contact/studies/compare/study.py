"""Lumped laws and a measured curve against the finite-element reference: scores, errors and error bars.

A load curve by slow indentation, for the laws, where the target has none in closed form. The verdict in words,
computed: what a law holds and where it errs by more than the error bars leave open. A comparison as files: a history a
law and its scores in CSV, verdict and errors in JSON.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_contact.budget.plan import has_curve
from fe_contact.budget.variation import factor
from fe_contact.indentation import indent
from fe_contact.progress import Count, Progress, silent
from fe_contact.reference import Solved, answered
from fe_contact.settings import Given
from fe_contact.studies.compare.deviations import (
    NestedAreas,
    Told,
    force_bars,
    force_errors,
    nested_areas,
    pressure_error,
    radius_error,
)
from fe_contact.studies.files import write_study
from fe_contact.studies.larger_models import MeasuredEffect
from lumped import simulate
from lumped.errors import BadInput, FeContactError
from lumped.laws import get
from lumped.load_curves.sampled import SampledCurve
from lumped.progress import counting_steps
from lumped.result.gate import DEVIATIONS, LEAST_ROWS, LEVEL, MeasuredPulse
from lumped.result.noise import memory
from lumped.result.result import RULED_RELATIVE, Result
from lumped.result.score import Curve as Measured
from lumped.result.score import score
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Answered, Scene
from lumped.schema import Table
from lumped.schema.json_file import plain

LAW_TOLERANCE = 1e-6  # of a law's own integration: far below any reference's bar
QUANTITIES = (*RULED_RELATIVE, "peak_time", "restitution")
DISTANCES = ("work", "loss", "shape", "peak_shift")  # of the two curves, without a bar
DEPTHS = 16  # of the slow indentation beside the impact
SHALLOWEST, DEEPEST = 1e-2, 1.02  # over the depth of the impact
TOLERANCE = 3e-4  # of that indentation
CURVE_ORDER = 2  # of the slopes at its depths, which what lies between them errs by: every other depth shows it
WITHIN = "within the reference's error bar"
DECISIVE = ("history", "held_until_max_depth", "peak_force", "peak_depth", "duration", "restitution")
SCHEMA = "fe-contact/compare/1"
MEASURED = "measured"  # what the curve's judgement is called
ABOUT = 0.5  # of the contact, after it: what is compared
SEEN = 1e-3  # look: of the peak, noise worth a word
FAR_LATER = 9.0  # look: a duration too long by ten times and more is no matter of per cent
SCORES = (
    "peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse", "work", "loss", "shape",
    "peak_shift", "contact_radius_rebound", "pressure_rebound", "held_until_max_depth",
)  # fmt: skip


@dataclass(frozen=True)
class Judgement:
    """One candidate against the reference.

    ``score_percent`` by (20)-(21). ``errors`` are candidate minus reference over reference, restitution
    absolute, None where undefined: peak_force, peak_depth, duration, impulse, peak_time, restitution; without a
    bar, as :class:`lumped.Score` has them, work, loss, shape, peak_shift; and, never negative,
    contact_radius_rebound (relative to the largest radius), pressure_rebound (misplaced force over force),
    held_until_max_depth (force, relative to the peak), history (force, norm over norm). ``bars``: how much of
    an error the error bars of reference and candidate together leave open. ``noise``: of a measured curve, its
    deviation over the peak; what is left of it in an average over neighbours counts in ``bars``.
    """

    name: str
    score_percent: float
    errors: Mapping[str, float | None]
    bars: Mapping[str, float]
    noise: float = 0.0

    def exceeds(self, name: str) -> bool:
        """Whether an error is known, and larger than its bar."""
        error = self.errors[name]
        return error is not None and abs(error) > self.bars[name]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Reference, candidates and judgements; ``refused`` maps laws without an answer to the reason.

    ``solved``: the reference's steps with their pressures, None where its history alone is told: with inertia, yield or
    large strains.

    ``nested``: whether the contact goes back through the areas it came through, which Ting's solution supposes.
    ``larger``: what larger models change, where they were asked.
    """

    solved: Solved | None
    told: Told
    reference: Result
    laws: Mapping[str, Result]
    measured: Measured | None
    judgements: tuple[Judgement, ...]
    refused: Mapping[str, str]
    nested: NestedAreas | None
    larger: tuple[MeasuredEffect, ...] | None = None

    def __repr__(self) -> str:
        return "\n  ".join([f"{self.reference.scene.name}: against {self.reference.method}", *verdicts(self)])


def compared(
    scene: Scene,
    given: Given,
    names: tuple[str, ...],
    measured: Measured | None = None,
    progress: Progress = silent,
) -> Comparison:
    """A scene, answered with checked settings, against lumped laws and a measured curve.

    Raises, before anything is solved, BadInput for an unknown law and for several impacts without inertia, and what
    finite elements raise.
    """
    for name in names:
        get(name)
    if not scene.model.inertia:
        scene.check_single("compare")
    reference, solved = answered(scene, given, progress)
    return compare(solved, reference, names, measured, progress)


def compare(
    solved: Solved | None,
    reference: Result,
    names: tuple[str, ...],
    measured: Measured | None = None,
    progress: Progress = silent,
) -> Comparison:
    """Judge laws by their names, and a measured curve where there is one. Raises BadInput for an unknown law."""
    members = {name: get(name) for name in names}
    scene, curve_error = known(reference.scene, reference.quantities["peak_depth"].value or 0.0)
    laws: dict[str, Result] = {}
    refused: dict[str, str] = {}
    for count, (name, member) in enumerate(members.items()):
        progress(f"law {name}", count, len(members))
        try:
            with counting_steps(Count(progress, f"time steps of {name}", 0.0)):
                laws[name] = simulate(member.of(scene), scene, LAW_TOLERANCE)
        except FeContactError as failure:  # what has no answer is told, and the others go on
            refused[name] = _reason(name, failure)
    told = Told.of(reference) if solved is None else Told.by(solved)
    judged = [_law(solved, told, reference, law, curve_error) for law in laws.values()]
    judged += [] if measured is None else [_curve(told, reference, measured)]
    nested = None if solved is None else nested_areas(reference.scene, solved)
    return Comparison(solved, told, reference, laws, measured, tuple(judged), refused, nested)


def _law(solved: Solved | None, told: Told, reference: Result, law: Result, curve_error: float) -> Judgement:
    """``curve_error``: relative, of the forces on the load curve that the law follows."""
    errors = {name: _error(reference, law, name) for name in QUANTITIES}
    errors["contact_radius_rebound"] = radius_error(told, law)
    errors["pressure_rebound"] = None if solved is None else pressure_error(solved, law)
    scored = score(reference.history, law.history)
    errors |= force_errors(told, law.history) | {name: getattr(scored, name) for name in DISTANCES}
    own = curve_error + float(law.history.force_error.max()) / (reference.quantities["peak_force"].value or np.inf)
    bars = {name: _bar(reference, name) + _bar(law, name) + curve_error for name in QUANTITIES}
    bars |= force_bars(told, own)
    return Judgement(law.method, 100 * scored.normalized_error, errors, bars)


def _curve(told: Told, reference: Result, measured: Measured) -> Judgement:
    """From the touch on to a while after the reference's end, between its rows as the reference bends.

    Of a noisy curve the average over neighbours, which rounds the reference too; how far noise may move it is in the
    bars. A record that ends before its force does tells no duration, impulse or norm.
    """
    near = (measured.time >= 0.0) & (measured.time <= (1.0 + ABOUT) * told.duration)
    near |= np.count_nonzero(measured.force[near] > 0.0) < LEAST_ROWS  # nothing presses there: all of it is judged
    time, force = measured.time[near], measured.force[near]
    own = reference.history.force_at(time)
    pulse, deviation, alike = MeasuredPulse(time, force), *_noise(measured, reference)
    peak = abs(pulse.peak) or math.inf
    noisy = deviation > SEEN * peak
    beyond = pulse.smooth - pulse.averaged(own) if noisy else force - own
    step = float(np.diff(time).max(initial=0.0))  # so far before its first row the record is taken as known
    every = np.union1d(told.time[(told.time > time[0] - step) & (told.time < time[-1])], time)
    steady = Measured(every, reference.history.force_at(every) + np.interp(every, time, beyond))
    scored = score(reference.history, steady)
    errors: dict[str, float | None] = {name: getattr(scored, name) for name in (*QUANTITIES, *DISTANCES)}
    errors |= {"contact_radius_rebound": None, "pressure_rebound": None} | force_errors(told, steady)
    left = DEVIATIONS * deviation * math.sqrt(alike / (pulse.window if pulse.noisy else 1)) / peak
    bars = {name: _bar(reference, name) + left for name in QUANTITIES} | force_bars(told, left)
    if noisy:  # what is noisy never comes to zero: how long either is above a tenth of its peak is compared
        theirs = MeasuredPulse(time, own)
        errors |= {"shape": None, "duration": pulse.width / theirs.width - 1.0}
    if not pulse.ended or (noisy and pulse.level > LEVEL * pulse.peak):
        errors |= dict.fromkeys(("duration", "impulse", "history", "shape"))
    bars["duration"] += 2.0 * step / told.duration
    return Judgement(MEASURED, 100 * scored.normalized_error, errors, bars, noise=deviation / peak)


def _noise(measured: Measured, reference: Result) -> tuple[float, float]:
    """Its deviation, N, of what changes from row to row beside the reference, or of the silence where that is larger;
    and how many neighbours tell as much as one.
    """
    whole = MeasuredPulse(measured.time, measured.force)
    beside = MeasuredPulse(measured.time, measured.force - reference.history.force_at(measured.time)).noise
    silence = np.concatenate([whole.before, whole.after])
    if silence.size < LEAST_ROWS:
        return beside, 1.0
    return max(beside, float(silence.std())), memory(silence - silence.mean())


def _error(reference: Result, law: Result, name: str) -> float | None:
    """Relative error of a quantity, restitution absolute; None where either is undefined, or nothing to relate to."""
    truth, value = reference.quantities[name].value, law.quantities[name].value
    if truth is None or value is None:
        return None
    if name == "restitution" or value == truth:
        return value - truth
    return value / truth - 1.0 if truth else None


def _bar(result: Result, name: str) -> float:
    """Error bar in the unit of :func:`_error`."""
    quantity = result.quantities[name]
    if not quantity.value or quantity.error is None:
        return 0.0
    return quantity.error if name == "restitution" else quantity.error / abs(quantity.value)


def known(scene: Scene, depth: float) -> tuple[Scene, float]:
    """The scene on a curve that finite elements found down to a depth, m, and the force's relative error on it.

    As it is, and 0, where the curve is known in closed form or no slow indentation is. Raises NotReached.
    """
    if scene.target.only_with_inertia or not scene.geometry.surface_remembers or has_curve(scene):
        return scene, 0.0
    asked = tuple(float(one) for one in np.geomspace(SHALLOWEST * depth, DEEPEST * depth, DEPTHS))
    elastic = scene.geometry.springs
    slow = Indenter(scene.profile, elastic.material, scene.target, elastic.striker_material)
    pressed = indent(slow, asked, {"tolerance": TOLERANCE})
    forces = pressed.force / (pressed.modulus * scene.geometry.shape.total)
    sampled = np.array([asked, forces, pressed.contact_radius])
    curve, fewer = (SampledCurve(*map(tuple, rows.tolist())) for rows in (sampled, sampled[:, 1::2]))
    between = factor(CURVE_ORDER, False) * np.abs(fewer.force(asked[2::2]) / forces[2::2] - 1.0).max()
    return Answered.by(scene, curve), float(np.max(pressed.force_error / pressed.force) + between)


def verdicts(comparison: Comparison) -> tuple[str, ...]:
    """What :func:`judged` says; then the laws that gave no answer, those of one reason together."""
    reasons: dict[str, list[str]] = {}
    for name, reason in comparison.refused.items():
        alike = reason.replace(f"law.name={name}", "law.name=NAME").replace(name, "it")
        reasons.setdefault(alike, []).append(name)
    refused = [f"{', '.join(names)}: {reason}" for reason, names in reasons.items()]
    return (*judged(comparison), *refused)


def _reason(name: str, failure: FeContactError) -> str:
    """Why a law has no answer, without its own name and without what would be accepted: no one asked to change that."""
    if not isinstance(failure, BadInput):
        return f"no answer: {failure}"
    fault = failure.faults[0]
    said = fault.message.partition("; accepted")[0]
    return said.removeprefix(f"{name} is ") if said.startswith(f"{name} is ") else f"no answer: {fault.key}: {said}"


def judged(comparison: Comparison) -> tuple[str, ...]:
    """One line a candidate, those of equal verdict together; then the areas."""
    sentences: dict[str, list[str]] = {}
    for judgement in comparison.judgements:
        sentences.setdefault(_sentence(comparison, judgement), []).append(judgement.name)
    lines = [
        sentence if names == [MEASURED] else f"{', '.join(names)}: {sentence}" for sentence, names in sentences.items()
    ]
    return (*lines, *([] if comparison.nested is None else [_nested(comparison.nested)]))


def _nested(areas: NestedAreas) -> str:
    """Whether Ting's solution may be asked of this contact."""
    says = "nest as Ting supposes" if areas.holds else "do not nest as Ting supposes"
    return f"areas of contact {says}: paired radii differ by {percent(areas.deviation)}, bar {percent(areas.bar)}"


def _sentence(comparison: Comparison, judgement: Judgement) -> str:
    if judgement.name == MEASURED:
        return _of_measured(judgement)
    if not any(judgement.exceeds(name) for name in DECISIVE) and not _only_one_separates(comparison, judgement):
        return WITHIN
    parts = [_approach(judgement)]
    parts += _signed(judgement, "peak_force", "peak force {} too low", "peak force {} too high")
    parts += [_end(comparison, judgement)]
    error = judgement.errors["restitution"]
    if error is not None and judgement.exceeds("restitution"):
        parts.append(f"restitution {_digits(abs(error))} too {'low' if error < 0 else 'high'}")
    return ", ".join(part for part in parts if part)


def _of_measured(judgement: Judgement) -> str:
    """A measurement does not err: what differs from it is the reference."""
    noise = f"the noise, {percent(judgement.noise)} of the peak" if judgement.noise > SEEN else ""
    if not any(judgement.exceeds(name) for name in DECISIVE):
        beside = f" and {noise}" if noise else ""
        return f"the reference agrees with the measured curve within its error bar{beside}"
    share = percent(judgement.errors["held_until_max_depth"] or 0.0)
    parts = [f"the reference differs from the measured curve by up to {share} of the peak before maximum depth"]
    parts += _signed(judgement, "peak_force", "the measured peak is {} lower", "the measured peak is {} higher")
    parts += _signed(judgement, "duration", "the measured contact is {} shorter", "the measured contact is {} longer")
    parts += [f"beyond {noise}"] if noise else []
    return ", ".join(parts)


def _approach(judgement: Judgement) -> str:
    share = percent(judgement.errors["held_until_max_depth"] or 0.0)
    if judgement.exceeds("held_until_max_depth"):
        return f"errs by up to {share} of the peak before maximum depth"
    return f"holds until maximum depth ({share} of the peak)"


def _end(comparison: Comparison, judgement: Judgement) -> str:
    if _only_one_separates(comparison, judgement):
        return "does not separate" if comparison.reference.separated else "separates where the reference does not"
    if (judgement.errors["duration"] or 0.0) > FAR_LATER:
        return "ends far later"
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
    return f"{value:.2g}" if 1e-4 <= value < 99.5 or value == 0 else f"{value:.0f}" if value >= 99.5 else f"{value:.0e}"


def write_comparison(comparison: Comparison, where: Path) -> None:
    """Write every history, ``scores.csv`` and ``compare.json`` into a folder."""
    comparison.reference.write_files(where)
    for name, law in comparison.laws.items():
        law.history.write_csv(where / f"{name}-history.csv")
    nested = comparison.nested and comparison.nested.holds  # of the reference: the same in every line
    scores = [
        {"law": one.name, "score_percent": one.score_percent}
        | {f"{name}_error": one.errors[name] for name in SCORES}
        | {"nested_areas": nested}
        for one in comparison.judgements
    ]
    write_study(where, "compare", comparison_content(comparison), {"scores": scores})


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
    if comparison.larger is not None:
        content["larger_models"] = [one.to_json() for one in comparison.larger]
    return content
