"""Numerics: every choice that is not physics, validated; Scene says what happens, Numerics how it is solved.

Numerics of a body with inertia: beside the settings of every impact, how its mass stands on the nodes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from itertools import islice
from typing import Annotated, Any, Self, TypeVar

from lumped.errors import SHOWN_FAULTS, BadInput, Fault, as_number, nearest, shown
from lumped.schema import Table
from lumped.schema.keys import Key, keys_of
from lumped.schema.members import available

Given = Mapping[str, Any]  # values of keys, each of its own type
DEFAULT_TOLERANCE = 1e-3  # default: relative, of every certified quantity without waves
STATIC_SCHEMES, WAVE_SCHEMES = "fe_contact.schemes", "fe_contact.dynamics.schemes"
OF_WAVES = ("mass", "rho")  # mean nothing without inertia


@dataclass(frozen=True)
class Range:
    """A number in `[low, high]`, or a ``whole`` one, which may be written as 4 or as 4.0."""

    low: float
    high: float
    whole: bool = False

    @property
    def accepted(self) -> str:
        """In words."""
        return f"{'a whole number' if self.whole else 'a number'} from {self.low:g} to {self.high:g}"

    @property
    def schema(self) -> Table:
        """For editors."""
        return {"type": "integer" if self.whole else "number", "minimum": self.low, "maximum": self.high}

    def read(self, value: object) -> float:
        """The number; raises ValueError."""
        value = as_number(value)
        if isinstance(value, bool) or not isinstance(value, int | float) or not self.low <= value <= self.high:
            raise ValueError
        if self.whole and not float(value).is_integer():
            raise ValueError
        return int(value) if self.whole else value


@dataclass(frozen=True)
class MemberOf:
    """The name of a member of one of some ``packages``."""

    packages: tuple[str, ...]

    @property
    def names(self) -> list[str]:
        """All of them."""
        return sorted({name for package in self.packages for name in available(package)})

    @property
    def accepted(self) -> str:
        """In words."""
        return ", ".join(self.names)

    @property
    def schema(self) -> Table:
        """For editors."""
        return {"enum": self.names}

    def read(self, value: object) -> str:
        """The name; raises ValueError, with the nearest one."""
        if not isinstance(value, str) or value not in self.names:
            hint = nearest(value, self.names) if isinstance(value, str) else ""
            raise ValueError(f"{shown(value)}: accepted {self.accepted}{hint}")
        return value


@dataclass(frozen=True)
class Numerics:
    """Settings of one finite-element impact.

    ``tolerance`` asked of the result; ``elements_per_contact`` along the contact radius; ``order`` of the
    elements; ``penalty`` stiffness in units of contact modulus over contact radius; ``enforcement`` and
    ``scheme`` by name; ``steps`` per contact time (a multiple of four); ``far_radius`` of the mesh in contact radii.
    ``contact_radius`` (m, the largest expected), ``contact_time`` (s) and ``peak_share`` (time of the peak
    force over contact time) are scales that place mesh, memory and time steps; they enter no value.
    """

    tolerance: Annotated[float, Key(Range(1e-6, 0.1), "relative, asked of every ruled quantity")]
    elements_per_contact: Annotated[float, Key(Range(1, 32), "elements along the contact radius")]
    order: Annotated[int, Key(Range(1, 4, whole=True), "order of the elements")]
    penalty: Annotated[float, Key(Range(1.0, 1e7), "penalty stiffness over contact modulus over contact radius")]
    enforcement: Annotated[str, Key(MemberOf(("fe_contact.contact.enforcement",)), "how the surfaces are kept apart")]
    scheme: Annotated[str, Key(MemberOf((STATIC_SCHEMES, WAVE_SCHEMES)), "time integrator")]
    steps: Annotated[int, Key(Range(8, 8192, whole=True), "time steps along the contact, raised to a multiple of four")]
    far_radius: Annotated[float, Key(Range(2.0, 1e4), "where the mesh ends, in contact radii")]
    contact_radius: float
    contact_time: float
    peak_share: float

    def varied(self, **changes: Any) -> Self:
        """A copy with some settings changed."""
        return replace(self, **changes)

    def as_dict(self) -> Table:
        """Plain data for ``result.json``."""
        return asdict(self)


AnyNumerics = TypeVar("AnyNumerics", bound=Numerics)


@dataclass(frozen=True)
class WaveNumerics(Numerics):
    """``scheme`` is one of :mod:`fe_contact.dynamics.schemes`, of spectral radius ``rho`` for what no step follows;
    ``mass`` one of :mod:`fe_contact.dynamics.mass`; ``finer``: times as many elements at the surface as the body has;
    ``echoes``: how often in the contact time a wave comes back; ``swing``: share of the peak force by which that may
    swing it where steps do not follow it; the rest as in Numerics.
    """

    rho: Annotated[float, Key(Range(0.0, 1.0), "spectral radius for what no step follows, with waves")]
    mass: Annotated[str, Key(MemberOf(("fe_contact.dynamics.mass",)), "how mass stands on the nodes, with waves")]
    finer: float = 1.0
    echoes: float = 0.0
    swing: float = 0.0

    @property
    def follows_echoes(self) -> bool:
        """Whether there are some that the steps follow."""
        return self.echoes > 0.0 and self.swing == 0.0


@dataclass(frozen=True)
class EdgedNumerics(Numerics):
    """Of a flat end whose rim is sharp, struck as the limit of ever narrower edges: ``edge_radius``, m, of the
    narrowest; the rest as in Numerics.
    """

    edge_radius: float = 0.0


KEYS = keys_of(WaveNumerics)  # what a user may choose
SCALES = {  # what a plan estimates, by field
    "contact_radius": "m, the largest that is expected",
    "contact_time": "s, as it is expected",
    "peak_share": "time of the peak force over the contact time, as it is expected",
    "finer": "times as many elements at the surface as the body has, with waves",
    "echoes": "how often a wave comes back in the contact time",
    "swing": "of the peak force, by echoes that the steps do not follow",
    "edge_radius": "m, of the narrowest edge around a flat end whose rim is sharp",
}
RANGES = {name: (key.kind.low, key.kind.high) for name, key in KEYS.items() if isinstance(key.kind, Range)}


def checked(table: Given, source: str) -> Table:
    """Settings a user gave, type and range checked; raises BadInput naming every fault at once.

    Steps up to a multiple of four: the error budget halves them twice.
    """
    found = faults(table, source)
    if found:
        raise BadInput(found)
    values: Table = {name: KEYS[name].kind.read(value) for name, value in table.items()}
    return values | ({"steps": 4 * math.ceil(values["steps"] / 4)} if "steps" in values else {})


def faults(table: Given, source: str) -> list[Fault]:
    """Everything wrong with a table of settings."""
    found = (fault for name, value in table.items() for fault in _faults(name, value, source))
    return list(islice(found, SHOWN_FAULTS))


def _faults(name: str, value: object, source: str) -> list[Fault]:
    where = f"numerics.{name}"
    if name not in KEYS:
        return [Fault(source, where, f"unknown key; accepted: {', '.join(KEYS)}{nearest(name, tuple(KEYS))}")]
    kind = KEYS[name].kind
    try:
        kind.read(value)
    except ValueError as refused:
        return [Fault(source, where, str(refused) or f"{shown(value)}: accepted {kind.accepted}")]
    return []


def tolerance_of(given: Given) -> float:
    """What is asked of every ruled quantity, relative; without waves, which have defaults of their own."""
    return float(given.get("tolerance", DEFAULT_TOLERANCE))


def check_kind(given: Given, inertia: bool, source: str) -> None:
    """Raise BadInput for checked settings of the other kind of motion: with inertia or without."""
    state, found = f"with model.inertia = {str(inertia).lower()}", []
    schemes = available(WAVE_SCHEMES if inertia else STATIC_SCHEMES)
    if given.get("scheme", schemes[0]) not in schemes:
        reason = f"{shown(given['scheme'])}: {state} accepted {', '.join(schemes)}"
        found.append(Fault(source, "numerics.scheme", reason))
    if not inertia:
        found += [Fault(source, f"numerics.{key}", f"no such setting {state}") for key in OF_WAVES if key in given]
    if found:
        raise BadInput(found)
