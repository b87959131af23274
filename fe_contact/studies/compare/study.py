"""Lumped laws and a measured curve against the finite-element reference: scores, errors and error bars.

A load curve by slow indentation, for the laws, where the target has none in closed form.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.budget.scales import has_curve
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.reference import Solved
from fe_contact.studies.compare.deviations import force_bars, force_errors, pressure_error, radius_error
from fe_contact.studies.compare.nested_areas import NestedAreas, nested_areas
from fe_contact.studies.compare.told import Told
from lumped import simulate
from lumped.errors import FeContactError
from lumped.laws import get
from lumped.load_curves.sampled import SampledCurve
from lumped.result.result import RULED_RELATIVE, Result
from lumped.result.score import Curve as Measured
from lumped.result.score import score
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Answered, Scene

DEFAULT_LAWS = ("hertz", "correspondence", "ting", "mdr")
LAW_TOLERANCE = 1e-6  # of a law's own integration: far below any reference's bar
QUANTITIES = (*RULED_RELATIVE, "peak_time", "restitution")
DISTANCES = ("work", "loss", "shape", "peak_shift")  # of the two curves, without a bar
DEPTHS = 16
SHALLOWEST, DEEPEST = 1e-2, 1.02  # over the depth of the impact
TOLERANCE = 3e-4


@dataclass(frozen=True)
class Judgement:
    """One candidate against the reference.

    ``score_percent`` by (20)-(21). ``errors`` are candidate minus reference over reference, restitution
    absolute, None where undefined: peak_force, peak_depth, duration, impulse, peak_time, restitution; without a
    bar, as :class:`lumped.Score` has them, work, loss, shape, peak_shift; and, never negative,
    contact_radius_rebound (relative to the largest radius), pressure_rebound (misplaced force over force),
    held_until_max_depth (force, relative to the peak), history (force, norm over norm). ``bars``: how much of
    an error the error bars of reference and candidate together leave open.
    """

    name: str
    score_percent: float
    errors: Mapping[str, float | None]
    bars: Mapping[str, float]

    def exceeds(self, name: str) -> bool:
        """Whether an error is known, and larger than its bar."""
        error = self.errors[name]
        return error is not None and abs(error) > self.bars[name]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Reference, candidates and judgements; ``refused`` maps laws without an answer to the reason.

    ``solved``: the reference's steps with their pressures, None with inertia, where its history tells all.

    ``nested``: whether the contact goes back through the areas it came through, which Ting's solution supposes.
    """

    solved: Solved | None
    told: Told
    reference: Result
    laws: Mapping[str, Result]
    measured: Measured | None
    judgements: tuple[Judgement, ...]
    refused: Mapping[str, str]
    nested: NestedAreas | None


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
            laws[name] = simulate(member.of(scene), scene, LAW_TOLERANCE)
        except FeContactError as failure:  # what has no answer is told, and the others go on
            refused[name] = str(failure)
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
    scored = score(reference.history, measured)
    errors: dict[str, float | None] = {name: getattr(scored, name) for name in (*QUANTITIES, *DISTANCES)}
    errors |= {"contact_radius_rebound": None, "pressure_rebound": None} | force_errors(told, measured)
    bars = {name: _bar(reference, name) for name in QUANTITIES} | force_bars(told, 0.0)
    return Judgement("measured", 100 * scored.normalized_error, errors, bars)


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
    slow = Indenter(scene.profile, scene.geometry.material, scene.target, scene.striker_material)
    pressed = indent(slow, asked, {"tolerance": TOLERANCE})
    forces = pressed.force / (pressed.modulus * scene.geometry.shape.total)
    curve = SampledCurve(
        asked, tuple(float(force) for force in forces), tuple(float(radius) for radius in pressed.contact_radius)
    )
    return Answered.by(scene, curve), float(np.max(pressed.force_error / pressed.force))
