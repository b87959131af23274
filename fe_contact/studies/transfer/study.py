"""Every law is calibrated at one state of a scene, carried to others, and judged there by a reference with bars.

A state is the scene with one key changed: its velocity, its mass, a length. A law is calibrated on the reference's
history by least squares, or as the field does it: by the restitution and the peak force that were measured, or by the
restitution beside E*. What is carried are the law's own numbers, as `[law]` names them; a law that follows from the
material carries what was fitted of the material, and takes the rest from the scene at every state.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from fe_contact import methods
from fe_contact.progress import Progress, silent
from fe_contact.settings import Given
from fe_contact.studies.files import write_study
from fe_contact.studies.transfer.verdict import QUANTITIES, TransferRow, holds, row_of, sentence
from lumped import laws, simulate
from lumped.errors import BadInput, Fault, FeContactError, shown
from lumped.fit import fit
from lumped.fit.opensees import SHARES
from lumped.fit.space import damping_names, own_keys, space_of
from lumped.laws._force_law import ForceLaw, between_masses
from lumped.laws._parameters import COMMON, EXPONENT
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice
from lumped.schema import Table
from lumped.schema.keys import Number
from lumped.solvers.point.bodies import Stage

SCHEMA = "fe-contact/transfer/1"
VELOCITY = "striker.velocity"
LAW_TOLERANCE = 1e-6  # of a law's own integration: far below any reference's bar
WITHIN, TOLERATED = 0.05, Number(0.0, 1.0)  # of the verdict `within`: where nobody asks for another; accepted ones
SceneWith = Callable[[Mapping[str, object]], Scene]  # the scene with dotted keys changed; raises BadInput


@dataclass(frozen=True)
class Asked:
    """What to calibrate and where to use it.

    ``start``: dotted keys of the state of calibration, what they leave out is the scene's. ``over``: keys and the
    values that each takes, alone; none: the velocity. ``within``: tolerance of a verdict. ``method``: of the
    reference, see :func:`fe_contact.run`. Raises BadInput.
    """

    laws: tuple[str, ...] = ()
    start: Mapping[str, float] = field(default_factory=dict)
    over: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    calibrate: str = "least_squares"
    within: float = WITHIN
    method: str | None = None

    def __post_init__(self) -> None:
        for name in self.laws:
            laws.get(name)
        faults = list[Fault]()
        if self.calibrate not in CALIBRATIONS:
            faults.append(Fault("--calibrate", "", f"{shown(self.calibrate)}: accepted {', '.join(CALIBRATIONS)}"))
        if not TOLERATED.low <= self.within <= TOLERATED.high:
            faults.append(Fault("--within", "", f"{self.within:g}: accepted {TOLERATED.accepted}"))
        if faults:
            raise BadInput(faults)


@dataclass(frozen=True, eq=False)
class TransferState:
    """The scene with ``key`` at this ``value``, and its reference, or the reason why there is none."""

    key: str
    value: float
    scene: Scene
    reference: Result | None
    reason: str = ""

    @property
    def missed(self) -> str:
        """What its reference did not reach; empty where it did."""
        fault = self.reason if self.reference is None else "" if self.reference.converged else self.reference.message
        return f"{self.key} = {self.value:g}: {fault}" if fault else ""

    def to_json(self) -> Table:
        """What transfer.json says of it."""
        found = self.reference
        known = {} if found is None else {name: vars(found.quantities[name]) for name in QUANTITIES}
        return {
            "key": self.key,
            "value": self.value,
            "converged": found is not None and found.converged,
            "reason": self.reason or (found.message if found else ""),
            "quantities": known,
        }


@dataclass(frozen=True)
class Calibration:
    """The numbers of a law that are carried, by their names; ``error`` "(20)" of the calibrated law on its history,
    None where nothing was fitted.
    """

    law: str
    values: Mapping[str, float]
    error: float | None = None

    def scene_at(self, scene: Scene) -> Scene:
        """A scene with this law and these numbers. Raises BadInput."""
        own = bare(self.law, scene)
        return space_of(self.law, own, tuple(self.values), {}, {}).scene_at(self.values) if self.values else own


@dataclass(frozen=True, eq=False)
class TransferStudy:
    """Rows of all laws, states and quantities; ``refused`` maps laws that could not be calibrated to the reason."""

    name: str
    asked: Asked
    start: Mapping[str, float]
    reference: Result
    states: tuple[TransferState, ...]
    calibrations: Mapping[str, Calibration]
    refused: Mapping[str, str]
    rows: tuple[TransferRow, ...]

    def __repr__(self) -> str:
        return "\n".join(self.sentences)

    @property
    def keys(self) -> tuple[str, ...]:
        """What the states vary."""
        return tuple(dict.fromkeys(state.key for state in self.states))

    @property
    def at(self) -> str:
        """The state of calibration, in words."""
        return ", ".join(f"{key} = {value:.5g}" for key, value in self.start.items())

    @property
    def sentences(self) -> tuple[str, ...]:
        """One a law."""
        return tuple(
            sentence(law, self.refused.get(law), [row for row in self.rows if row.law == law], self.start)
            for law in self.asked.laws
        )

    @property
    def missed(self) -> str:
        """Which references did not reach their tolerance; empty where all did."""
        missed = [state.missed for state in self.states if state.missed]
        return f"reference at {'; '.join(missed)}" if missed else ""

    def to_json(self) -> Table:
        """The content of transfer.json."""
        return {
            "schema": SCHEMA,
            "scene": self.name,
            "reference": self.reference.method,
            "calibrated": {"at": self.start, "by": self.asked.calibrate},
            "within": self.asked.within,
            "laws": {law: self._law(law, said) for law, said in zip(self.asked.laws, self.sentences, strict=True)},
            "references": [state.to_json() for state in self.states],
            "rows": [row.to_json() for row in self.rows],
        }

    def _law(self, law: str, said: str) -> Table:
        found, rows = self.calibrations.get(law), [row for row in self.rows if row.law == law]
        return {
            "parameters": found and dict(found.values),
            "normalized_error": found and found.error,
            "refused": self.refused.get(law),
            "holds": {key: holds([row for row in rows if row.key == key], self.start[key]) for key in self.keys},
            "sentence": said,
        }

    def write(self, where: str | Path) -> Table:
        """Write ``transfer.csv`` and ``transfer.json`` into a folder; the content of the latter."""
        lines = [{name: cell for name, cell in row.to_json().items() if name != "reason"} for row in self.rows]
        return write_study(Path(where), "transfer", self.to_json(), {"transfer": lines})


def transfer(scene_with: SceneWith, given: Given, asked: Asked, progress: Progress = silent) -> TransferStudy:
    """Calibrate every law, predict every state, judge.

    ``given``: checked settings of the references. Raises BadInput for a state that is no scene, and whatever the
    reference at the state of calibration raises; a reference or a law that fails elsewhere is refused there.
    """
    begin = scene_with(asked.start)
    over = dict(asked.over) or {VELOCITY: tuple(share * begin.velocity for share in SHARES)}
    scenes = {key: {value: scene_with({**asked.start, key: value}) for value in over[key]} for key in over}
    start = {key: asked.start.get(key, _value(begin, key)) for key in {**asked.start, **over}}
    names = asked.laws or laws.available()
    asked = replace(asked, laws=names, over=over)
    known = [
        (key, value, one) for key, own in scenes.items() for value, one in sorted({**own, start[key]: begin}.items())
    ]
    progress("reference at the state of calibration")
    reference = methods.simulate(begin, asked.method, given, progress=progress)
    states = tuple(_judged_by(reference, begin, one, asked.method, given, progress) for one in known)
    calibrations, refused = dict[str, Calibration](), dict[str, str]()
    for count, name in enumerate(names):
        progress(f"calibration of {name}", count, len(names))
        try:
            calibrations[name] = calibrated(name, begin, reference, asked.calibrate)
        except FeContactError as failure:  # what has no answer is told, and the others go on
            refused[name] = str(failure)
    rows = [
        row for name in names for state in states for row in _rows(name, state, calibrations, refused, asked.within)
    ]
    return TransferStudy(begin.name, asked, start, reference, states, calibrations, refused, tuple(rows))


def calibrated(name: str, scene: Scene, reference: Result, how: str) -> Calibration:
    """A law on the reference of a scene, by one of :data:`CALIBRATIONS`. Raises BadInput, NotReached."""
    own = bare(name, scene)
    if not own_keys(name):
        laws.get(name).of(own)  # says what it is for, before it is sought
    return CALIBRATIONS[how](name, own, reference)


def bare(name: str, scene: Scene) -> Scene:
    """The scene without the numbers of the law called so; what its own `[law]` says of gap, exit and exponent stays."""
    said = scene.law.values if scene.law is not None and scene.law.name == name else {}
    stays = {key: said[key] for key in (*COMMON, *EXPONENT) if key in said}
    return replace(scene, law=LawChoice(name, stays) if stays else None)


def _least_squares(name: str, scene: Scene, reference: Result) -> Calibration:
    found = fit(reference.history, name, scene)
    return Calibration(name, found.values, found.normalized_error)


def _restitution(name: str, scene: Scene, reference: Result) -> Calibration:
    """The stiffness that gives the measured peak and the damping that gives the measured restitution.

    A law without a stiffness of its own takes the material as the scene has it.
    """
    if "k" not in own_keys(name):
        return Calibration(name, {})
    found = fit(reference.history, name, scene, ("k",), _damped(name, reference), peak=True)
    law = between_masses(name, found.scene)
    return Calibration(name, _own_numbers(law, found.scene, found.values), found.normalized_error)


def _modulus(name: str, scene: Scene, reference: Result) -> Calibration:
    """The measured restitution alone: at every state E* and the geometry give the stiffness. Raises BadInput."""
    found = Calibration(name, _damped(name, reference))
    laws.get(name).of(found.scene_at(scene))
    return found


def _damped(name: str, reference: Result) -> dict[str, float]:
    """The measured restitution, where a law asks for one. Raises BadInput."""
    own, e = own_keys(name), reference.quantities["restitution"].value
    if "e" not in own:
        return {}
    if e is None:
        raise BadInput(Fault("--calibrate", "", f"nothing separates at the start; accepted: {LEAST}"))
    return {"e": min(max(e, own["e"].low), 1.0)}


def _own_numbers(law: ForceLaw, scene: Scene, known: Mapping[str, float]) -> dict[str, float]:
    """The numbers of a law that was made of k and e: k and its damping, or the springs of a loop."""
    dampers = damping_names(law.name)
    if not dampers:
        own = own_keys(law.name).keys() - {"k", "e", "alpha", "gap"}
        loop = {key: float(getattr(law, key)) for key in law.parameters if key in own}
        return loop or {"k": known["k"]}
    name, half = dampers[0], Stage(True, 1e-3 * scene.velocity, scene.velocity)
    of_one = replace(scene, law=LawChoice(law.name, {"k": known["k"], name: 1.0}))
    unit = between_masses(law.name, of_one)
    # every damper's force is in proportion to its number
    share = law.lost(half.deepest, scene.velocity, half) / unit.lost(half.deepest, scene.velocity, half)
    return {"k": known["k"], name: float(share)}


LEAST = "least_squares"
CALIBRATIONS: Mapping[str, Callable[[str, Scene, Result], Calibration]] = {
    LEAST: _least_squares,
    "restitution": _restitution,
    "modulus": _modulus,
}


def _judged_by(
    known: Result,
    begin: Scene,
    one: tuple[str, float, Scene],
    method: str | None,
    given: Given,
    progress: Progress,
) -> TransferState:
    """A state with its reference: that at the start is known."""
    key, value, scene = one
    if scene is begin:
        return TransferState(key, value, scene, known)
    try:
        return TransferState(key, value, scene, methods.simulate(scene, method, given, progress=progress))
    except FeContactError as failure:  # a state without a reference is told, and the others go on
        return TransferState(key, value, scene, None, str(failure))


def _rows(
    name: str, state: TransferState, calibrations: Mapping[str, Calibration], refused: Mapping[str, str], within: float
) -> Iterator[TransferRow]:
    """A row for every quantity of a law at a state."""
    found, reason = None, state.reason or refused.get(name, "")
    if not reason:
        try:
            scene = calibrations[name].scene_at(state.scene)
            found = simulate(laws.get(name).of(scene), scene, LAW_TOLERANCE)
        except FeContactError as failure:  # no answer at this state, which the rows say
            reason = str(failure)
    for quantity in QUANTITIES:
        ours = None if found is None else found.quantities[quantity]
        theirs = None if state.reference is None else state.reference.quantities[quantity]
        yield row_of(name, state.key, state.value, quantity, ours, theirs, within, reason)


def _value(scene: Scene, key: str) -> float:
    """The number of a key in the scene's tables. Raises BadInput."""
    place: object = scene.to_dict()
    for part in key.split("."):
        place = place.get(part) if isinstance(place, Mapping) else None
    if isinstance(place, float | int) and not isinstance(place, bool):
        return float(place)
    reason = "the scene does not tell where it starts from; accepted: a number of the scene, or --from with it"
    raise BadInput(Fault("--over", key, reason))
