"""The small tables of a scene: `[model]`, `[motion]`, `[law]`, and the keys and ranges of its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumped.errors import BadInput, Fault
from lumped.schema.key_table import check_fields, read_table
from lumped.schema.keys import Choice, Count, Flag, Key, Number, Text
from lumped.schema.members import available, get
from lumped.targets import Target

LEAST_MASS = 1e-21
END_IN_CONTACT_TIMES = 50.0
DIRECTIONS = ("unsaid", "down", "horizontal")
STRIKER_KEYS: Mapping[str, Key] = {
    "mass": Number(0.0, 1e12, "kg"),
    "velocity": Number(1e-9, 1e5, "m/s"),
}
MODEL_KEYS: Mapping[str, Key] = {
    "inertia": Flag(required=False),
    "profile": Choice(("exact", "parabola"), required=False),
    "gravity": Number(-1e6, 1e6, "m/s2", required=False),
    "direction": Choice(DIRECTIONS, required=False),
}
MOTION_KEYS: Mapping[str, Key] = {
    "impacts": Count(1, 100, required=False),
    "end_time": Number(1e-15, 1e12, "s", required=False),
}
NAME_KEYS: Mapping[str, Key] = {"name": Text(required=False)}
SECOND_BODY_KEYS: Mapping[str, Key] = {"target_mass": Number(LEAST_MASS, 1e12, "kg", required=False)}
LAWS, TARGETS = "lumped.laws", "lumped.targets"


@dataclass(frozen=True)
class Model:
    """The `[model]` table: inertia of deformable bodies, profile, gravity along the motion (m/s2), where that leads.

    No gravity is assumed; `direction` tells whether that leaves a weight out.
    """

    inertia: bool = False
    profile: str = "exact"
    gravity: float = 0.0
    direction: str = DIRECTIONS[0]

    def __post_init__(self) -> None:
        check_fields("model", self, MODEL_KEYS)


@dataclass(frozen=True)
class Motion:
    """The `[motion]` table: how many impacts are followed, and until when (s; None: 50 contact times)."""

    impacts: int = 1
    end_time: float | None = None

    def __post_init__(self) -> None:
        check_fields("motion", self, MOTION_KEYS)

    def until(self, contact_time: float, flight: float) -> float:
        """When to stop, s: the end time, else time for every impact and for the flight, s, between two."""
        return self.end_time or END_IN_CONTACT_TIMES * contact_time * self.impacts + flight * (self.impacts - 1)


@dataclass(frozen=True)
class LawChoice:
    """The `[law]` table: a lumped law by its name, with parameters of its own."""

    name: str
    values: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        keys = get(LAWS, self.name, source="law").KEYS
        _, faults = read_table("law", "", self.values, keys)
        if faults:
            raise BadInput(faults)


def inertia_faults(source: str, inertia: bool, density: float | None, target: Target | None) -> list[Fault]:
    """What is missing for `model.inertia = true`, or speaks against false; without geometry there is no target."""
    if not inertia:
        if target is not None and target.only_with_inertia:
            reason = f"missing or false: a {target.name} is made of waves; accepted: true"
            return [Fault(source, "model.inertia", reason)]
        return []
    faults = []
    if target is None or not target.has_inertia:
        where = "a law of its own" if target is None else target.name
        reason = f"true is not available for {where} in this version; accepted: false, or target.shape {_moving()}"
        faults.append(Fault(source, "model.inertia", reason))
    if target is not None and density is None:
        reason = "missing; model.inertia = true needs it, in kg/m3; the equivalent E* of two bodies is no wave medium"
        owner = "target" if target.deformable else "striker"
        faults.append(Fault(source, f"{owner}.material.density", reason))
    return faults


def gravity_faults(source: str, model: Model) -> list[Fault]:
    """Gravity along a motion that is said to lead across it."""
    if not model.gravity or model.direction != "horizontal":
        return []
    reason = f"{model.gravity:g} m/s2 along a horizontal motion; accepted: 0, or model.direction = 'down'"
    return [Fault(source, "model.gravity", reason)]


def mass_faults(source: str, mass: float, swinging: float) -> list[Fault]:
    """Too little mass, kg: none at all is for a block whose own inertia swings."""
    if mass >= LEAST_MASS or (mass == 0.0 and swinging > 0.0):
        return []
    reason = f"{mass:g}: accepted a number from {LEAST_MASS:g} to 1e+12 kg; 0 of a block with model.inertia"
    return [Fault(source, "striker.mass", reason)]


def _moving() -> str:
    """Names of the targets whose waves can be followed."""
    members = [value for name in available(TARGETS) for value in vars(get(TARGETS, name)).values()]
    targets = {member for member in members if isinstance(member, type) and issubclass(member, Target)}
    return ", ".join(sorted(target.name for target in targets if getattr(target, "has_inertia", False)))
