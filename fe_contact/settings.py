"""Numerics: every choice that is not physics, validated; Scene says what happens, Numerics how it is solved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from itertools import islice
from typing import Any

from lumped.errors import SHOWN_FAULTS, BadInput, Fault, nearest, shown
from lumped.schema.members import available

ENFORCEMENTS = "fe_contact.contact.enforcement"
SCHEMES = "fe_contact.schemes"
TARGETS = "fe_contact.targets"
MASSES = "fe_contact.dynamics.mass"
WAVE_SCHEMES = "fe_contact.dynamics.schemes"
WAVES = "fe_contact.waves.targets"

RANGES: dict[str, tuple[float, float]] = {
    "tolerance": (1e-6, 0.1),
    "elements_per_contact": (1, 32),
    "order": (1, 4),
    "penalty": (1.0, 1e7),
    "steps": (8, 8192),
    "far_radius": (2.0, 1e4),
    "rho": (0.0, 1.0),
}
INTEGERS = ("order", "steps")
OF_WAVES = ("mass", "rho")  # mean nothing without inertia
MEMBERS = {"enforcement": (ENFORCEMENTS,), "scheme": (SCHEMES, WAVE_SCHEMES), "mass": (MASSES,)}


@dataclass(frozen=True)
class Numerics:
    """Settings of one finite-element impact.

    ``tolerance`` asked of the result; ``elements_per_contact`` along the contact radius; ``order`` of the
    elements; ``penalty`` stiffness in units of contact modulus over contact radius; ``enforcement`` and
    ``scheme`` by name; ``steps`` per contact time (a multiple of four); ``far_radius`` of the mesh in contact radii.
    ``contact_radius`` (m, the largest expected), ``contact_time`` (s) and ``peak_share`` (time of the peak
    force over contact time) are scales that place mesh, memory and time steps; they enter no value.
    """

    tolerance: float
    elements_per_contact: float
    order: int
    penalty: float
    enforcement: str
    scheme: str
    steps: int
    far_radius: float
    contact_radius: float
    contact_time: float
    peak_share: float

    def varied(self, **changes: Any) -> Numerics:
        """A copy with some settings changed."""
        return replace(self, **changes)

    def as_dict(self) -> dict[str, Any]:
        """Plain data for ``result.json``."""
        return asdict(self)


KEYS = (*RANGES, *MEMBERS)  # what a user may choose


def checked(table: Mapping[str, Any], source: str) -> dict[str, Any]:
    """Settings a user gave, type and range checked; raises BadInput naming every fault at once."""
    found = faults(table, source)
    if found:
        raise BadInput(found)
    return {key: _rounded(key, value) for key, value in table.items()}


def faults(table: Mapping[str, Any], source: str) -> list[Fault]:
    """Everything wrong with a table of settings."""
    found = (fault for key, value in table.items() for fault in _faults(key, value, source))
    return list(islice(found, SHOWN_FAULTS))


def check_kind(given: Mapping[str, Any], inertia: bool, source: str) -> None:
    """Raise BadInput for checked settings of the other kind of motion: with inertia or without."""
    state, found = f"with model.inertia = {str(inertia).lower()}", []
    schemes = available(WAVE_SCHEMES if inertia else SCHEMES)
    if given.get("scheme", schemes[0]) not in schemes:
        reason = f"{shown(given['scheme'])}: {state} accepted {', '.join(schemes)}"
        found.append(Fault(source, "numerics.scheme", reason))
    if not inertia:
        found += [Fault(source, f"numerics.{key}", f"no such setting {state}") for key in OF_WAVES if key in given]
    if found:
        raise BadInput(found)


def _rounded(key: str, value: Any) -> Any:
    """Whole numbers as such, steps up to a multiple of four: the error budget halves them twice."""
    if key == "steps":
        return 4 * math.ceil(value / 4)
    return int(value) if key in INTEGERS else value


def _faults(key: str, value: Any, source: str) -> list[Fault]:
    where = f"numerics.{key}"
    if key in MEMBERS:
        names = sorted({name for package in MEMBERS[key] for name in available(package)})
        if value in names:
            return []
        hint = nearest(value, names) if isinstance(value, str) else ""
        return [Fault(source, where, f"{shown(value)}: accepted {', '.join(names)}{hint}")]
    if key not in RANGES:
        return [Fault(source, where, f"unknown key; accepted: {', '.join(KEYS)}{nearest(key, KEYS)}")]
    low, high = RANGES[key]
    kind = "a whole number" if key in INTEGERS else "a number"
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and low <= value <= high and (key not in INTEGERS or float(value).is_integer()):
        return []
    return [Fault(source, where, f"{shown(value)}: accepted {kind} from {low:g} to {high:g}")]
