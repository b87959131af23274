"""What the paper prints of its examples, and what has to be assumed to compute them: `data/paper/examples.toml`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lumped.errors import BadInput, Fault
from lumped.schema.data import directory
from lumped.schema.key_table import read_table, unknown_key
from lumped.schema.keys import Key, Number, Numbers
from lumped.schema.toml_file import overridden, parsed

LENGTH, MASS, VELOCITY = Number(1e-9, 1e4, "m"), Number(1e-9, 1e12, "kg"), Number(1e-9, 1e5, "m/s")
MODULUS, TIME, DENSITY = Number(1.0, 1e15, "Pa"), Number(1e-15, 1e12, "s"), Number(1e-3, 1e6, "kg/m3")
RATIO, FORCE, NU = Number(1e-9, 1e9), Number(1e-15, 1e15, "N"), Number(-0.99, 0.5)
STIFFNESS, DAMPING = Number(1e-9, 1e18, "N/m"), Number(1e-15, 1e15, "N s/m")
KEYS: Mapping[str, Mapping[str, Key]] = {
    "steel": {
        "diameter": LENGTH, "drop": LENGTH, "young": MODULUS, "nu": NU, "contact_modulus": MODULUS, "R1": RATIO,
        "R2": TIME, "measured_peak": FORCE, "theoretical_peak": FORCE,
        "pulse_peaks": Numbers(FORCE), "pulse_durations": Numbers(TIME), "density": DENSITY,
        "gravity": Number(1e-3, 1e6, "m/s2"), "restitutions": Numbers(Number(1e-3, 1.0)),
        "yield_strength": Numbers(MODULUS),
    },
    "grids": {
        "fig7_R1": Numbers(RATIO), "fig7_R2": Numbers(TIME), "fig8_R1": Numbers(RATIO), "fig8_R2": Numbers(TIME),
        "stiff_R2": TIME, "soft_R2": TIME,
    },
    "concrete": {
        "mass": MASS, "velocities": Numbers(VELOCITY), "E1": MODULUS, "E2": MODULUS, "C1": Number(1e-9, 1e18, "Pa s"),
        "peak_error": RATIO, "jankowski_peak_error": RATIO, "radii": Numbers(LENGTH), "density": DENSITY,
        "sides": Numbers(LENGTH), "strength": Numbers(MODULUS),
    },
    "ring": {
        "E0": MODULUS, "R1": RATIO, "R2": TIME, "rod_diameter": LENGTH, "width": LENGTH, "nu": NU,
        "nus": Numbers(NU), "thickness": Numbers(LENGTH), "density": Numbers(DENSITY),
    },
    "ptmd": {
        "m1": MASS, "m2": MASS, "k1": STIFFNESS, "k2": STIFFNESS, "c1": DAMPING, "c2": DAMPING, "gap": LENGTH,
        "displacement": LENGTH, "frequency": RATIO, "damping_ratio": RATIO, "damper_pounds": RATIO,
        "end_time": TIME, "window": TIME,
    },
}  # fmt: skip


@dataclass(frozen=True)
class Steel:
    """Section 4.1: the steel ball. Lengths in m, moduli in Pa, forces in N."""

    diameter: float
    drop: float
    young: float
    nu: float
    contact_modulus: float
    R1: float
    R2: float
    measured_peak: float
    theoretical_peak: float
    pulse_peaks: tuple[float, ...]
    pulse_durations: tuple[float, ...]
    density: float
    gravity: float
    restitutions: tuple[float, ...]
    yield_strength: tuple[float, ...]

    @property
    def radius(self) -> float:
        """Radius of the ball, m."""
        return 0.5 * self.diameter

    @property
    def mass(self) -> float:
        """Mass of the ball, kg."""
        return 4.0 / 3.0 * math.pi * self.radius**3 * self.density

    @property
    def velocity(self) -> float:
        """Velocity of the fall, sqrt(2 g h), m/s."""
        return math.sqrt(2.0 * self.gravity * self.drop)


@dataclass(frozen=True)
class Grids:
    """Section 4.2: the parameters of Fig. 7 and 8 in the order of the panels, and the thresholds of R2; s."""

    fig7_R1: tuple[float, ...]
    fig7_R2: tuple[float, ...]
    fig8_R1: tuple[float, ...]
    fig8_R2: tuple[float, ...]
    stiff_R2: float
    soft_R2: float


@dataclass(frozen=True)
class Concrete:
    """Section 4.3: the striker of concrete, kg, m/s, Pa, Pa s; radii of its head and sides of the pole in m."""

    mass: float
    velocities: tuple[float, ...]
    E1: float
    E2: float
    C1: float
    peak_error: float
    jankowski_peak_error: float
    radii: tuple[float, ...]
    density: float
    sides: tuple[float, ...]
    strength: tuple[float, ...]


@dataclass(frozen=True)
class RingLining:
    """Section 5.2: the ring's polymer, Pa and s, and its sizes, m; ranges of what is not printed."""

    E0: float
    R1: float
    R2: float
    rod_diameter: float
    width: float
    nu: float
    nus: tuple[float, ...]
    thickness: tuple[float, ...]
    density: tuple[float, ...]


@dataclass(frozen=True)
class Ptmd:
    """Section 5.2: structure 1, damper 2, gap, release and duration of the free vibration; SI, but lb for a mass."""

    m1: float
    m2: float
    k1: float
    k2: float
    c1: float
    c2: float
    gap: float
    displacement: float
    frequency: float
    damping_ratio: float
    damper_pounds: float
    end_time: float
    window: float


@dataclass(frozen=True)
class Examples:
    """All examples; frozen, so that what is computed of one can be kept."""

    steel: Steel
    grids: Grids
    concrete: Concrete
    ring: RingLining
    ptmd: Ptmd

    @property
    def name(self) -> str:
        """What results are filed under."""
        return "xue-2016"

    @classmethod
    def load(cls, overrides: Mapping[str, object] | None = None) -> Examples:
        """The packaged examples with dotted keys changed, as {"steel.density": 8000.0}. Raises BadInput."""
        path = directory() / "paper" / "examples.toml"
        table = overridden(parsed(path), overrides or {}, path.name)
        faults = [Fault(path.name, name, unknown_key(name, KEYS)) for name in table if name not in KEYS]
        found: dict[str, dict[str, Any]] = {}
        for name, keys in KEYS.items():
            part = table.get(name)
            values, more = read_table(path.name, name, part if isinstance(part, Mapping) else {}, keys)
            found[name], faults = values, faults + more
        if faults:
            raise BadInput(faults)
        return cls(
            Steel(**found["steel"]),
            Grids(**found["grids"]),
            Concrete(**found["concrete"]),
            RingLining(**found["ring"]),
            Ptmd(**found["ptmd"]),
        )
