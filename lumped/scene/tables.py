"""The small tables of a scene: `[model]`, `[motion]`, `[law]`, and the keys and ranges of its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.schema import Table
from lumped.schema.keys import Choice, Count, Flag, Key, Number, Text
from lumped.schema.members import Folder
from lumped.schema.record import Described, Record, read_table
from lumped.targets import TARGETS, Target

LAWS = Folder[Described]("lumped.laws", source="law")  # they know scenes: here only the names of their keys are known
LEAST_MASS = 1e-21  # safety: kg, the lightest body that is accepted
END_IN_CONTACT_TIMES = 50.0  # work: default end of the motion for each contact, in elastic contact times
DIRECTIONS = ("unsaid", "down", "horizontal")
MASS = Key(Number(0.0, 1e12, "kg"), "mass of the striker")
SPEED = Number(1e-9, 1e5, "m/s")
VELOCITY = Key(SPEED, "velocity of the striker at first touch")
SECOND_MASS = Key(Number(LEAST_MASS, 1e12, "kg"), "mass of a free second body", required=False)
NAME = Key(Text(), "name of the scene", required=False)
STRIKER_KEYS: Mapping[str, Key] = {"mass": MASS, "velocity": VELOCITY}
TARGET_KEYS: Mapping[str, Key] = {"mass": SECOND_MASS}
NAME_KEYS: Mapping[str, Key] = {"name": NAME}


@dataclass(frozen=True)
class Model(Record):
    """The `[model]` table: inertia of deformable bodies, profile, gravity along the motion (m/s2), where that leads.

    No gravity is assumed; `direction` tells whether that leaves a weight out.
    """

    inertia: Annotated[bool, Key(Flag(), "whether deformable bodies have inertia")] = False
    profile: Annotated[str, Key(Choice(("exact", "parabola")), "the striker's profile")] = "exact"
    gravity: Annotated[float, Key(Number(-1e6, 1e6, "m/s2"), "gravity along the motion")] = 0.0
    direction: Annotated[str, Key(Choice(DIRECTIONS), "where the motion leads")] = DIRECTIONS[0]
    name: ClassVar[str] = "model"


@dataclass(frozen=True)
class Motion(Record):
    """The `[motion]` table: how many impacts are followed, and until when (s; None: 50 contact times)."""

    impacts: Annotated[int, Key(Count(1, 100), "how many impacts are followed")] = 1
    end_time: Annotated[float | None, Key(Number(1e-15, 1e12, "s"), "when to stop")] = None
    name: ClassVar[str] = "motion"

    def until(self, contact_time: float, flight: float) -> float:
        """When to stop, s: the end time, else time for every impact and for the flight, s, between two."""
        return self.end_time or END_IN_CONTACT_TIMES * contact_time * self.impacts + flight * (self.impacts - 1)


@dataclass(frozen=True)
class LawChoice:
    """The `[law]` table: a lumped law by its name, with parameters of its own."""

    name: str
    values: Table = field(default_factory=dict)

    def __post_init__(self) -> None:
        (keys,) = LAWS.get(self.name).sets
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
    reason = f"{mass:g}: accepted {SECOND_MASS.kind.accepted}; 0 of a block with model.inertia"
    return [Fault(source, "striker.mass", reason)]


def _moving() -> str:
    """Names of the targets whose waves can be followed."""
    return ", ".join(name for name, target in TARGETS.members.items() if target.kind.has_inertia)
