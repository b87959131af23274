"""What the paper prints of its examples, and what has to be assumed to compute them: `data/paper/examples.toml`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, get_type_hints

from lumped.errors import BadInput, Fault
from lumped.materials.material import DENSITY, MODULUS, POISSON
from lumped.materials.networks.base import TIME, Viscosity
from lumped.ptmd.system import DAMPING, MASS, STIFFNESS
from lumped.scene.tables import SPEED
from lumped.schema import Table
from lumped.schema.files import data_folder, overridden, parsed
from lumped.schema.keys import Key, Number, Numbers, keys_of, read_table, unknown_key
from lumped.shapes.base import SIZE

RATIO, FORCE = Number(1e-9, 1e9), Number(1e-15, 1e15, "N")
Length = Annotated[float, Key(SIZE, "length")]
Mass = Annotated[float, Key(MASS, "mass")]
Modulus = Annotated[float, Key(MODULUS, "modulus")]
Time = Annotated[float, Key(TIME, "time")]
Density = Annotated[float, Key(DENSITY, "density")]
Ratio = Annotated[float, Key(RATIO, "ratio")]
Force = Annotated[float, Key(FORCE, "force")]
Poisson = Annotated[float, Key(POISSON, "Poisson's ratio")]
Stiffness = Annotated[float, Key(STIFFNESS, "stiffness")]
Damping = Annotated[float, Key(DAMPING, "damping")]
Lengths = Annotated[tuple[float, ...], Key(Numbers(SIZE), "length, several")]
Velocities = Annotated[tuple[float, ...], Key(Numbers(SPEED), "velocity, several")]
Moduli = Annotated[tuple[float, ...], Key(Numbers(MODULUS), "modulus, several")]
Times = Annotated[tuple[float, ...], Key(Numbers(TIME), "time, several")]
Densities = Annotated[tuple[float, ...], Key(Numbers(DENSITY), "density, several")]
Ratios = Annotated[tuple[float, ...], Key(Numbers(RATIO), "ratio, several")]
Forces = Annotated[tuple[float, ...], Key(Numbers(FORCE), "force, several")]
Poissons = Annotated[tuple[float, ...], Key(Numbers(POISSON), "Poisson's ratio, several")]


@dataclass(frozen=True)
class Steel:
    """Section 4.1: the steel ball. Lengths in m, moduli in Pa, forces in N."""

    diameter: Length
    drop: Length
    young: Modulus
    nu: Poisson
    contact_modulus: Modulus
    R1: Ratio
    R2: Time
    measured_peak: Force
    theoretical_peak: Force
    pulse_peaks: Forces
    pulse_durations: Times
    density: Density
    gravity: Annotated[float, Key(Number(1e-3, 1e6, "m/s2"))]
    restitutions: Annotated[tuple[float, ...], Key(Numbers(Number(1e-3, 1.0)))]
    yield_strength: Moduli

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

    fig7_R1: Ratios
    fig7_R2: Times
    fig8_R1: Ratios
    fig8_R2: Times
    stiff_R2: Time
    soft_R2: Time


@dataclass(frozen=True)
class Concrete:
    """Section 4.3: the striker of concrete, kg, m/s, Pa, Pa s; radii of its head and sides of the pole in m."""

    mass: Mass
    velocities: Velocities
    E1: Modulus
    E2: Modulus
    C1: Viscosity
    peak_error: Ratio
    jankowski_peak_error: Ratio
    radii: Lengths
    density: Density
    sides: Lengths
    strength: Moduli


@dataclass(frozen=True)
class RingLining:
    """Section 5.2: the ring's polymer, Pa and s, and its sizes, m; ranges of what is not printed."""

    E0: Modulus
    R1: Ratio
    R2: Time
    rod_diameter: Length
    width: Length
    nu: Poisson
    nus: Poissons
    thickness: Lengths
    density: Densities


@dataclass(frozen=True)
class Ptmd:
    """Section 5.2: structure 1, damper 2, gap, release and duration of the free vibration; SI, but lb for a mass."""

    m1: Mass
    m2: Mass
    k1: Stiffness
    k2: Stiffness
    c1: Damping
    c2: Damping
    gap: Length
    displacement: Length
    frequency: Ratio
    damping_ratio: Ratio
    damper_pounds: Ratio
    end_time: Time
    window: Time


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
        path = data_folder() / "paper" / "examples.toml"
        table = overridden(parsed(path), overrides or {}, path.name)
        kinds = get_type_hints(cls)
        faults = [Fault(path.name, name, unknown_key(name, kinds)) for name in table if name not in kinds]
        found: dict[str, Table] = {}
        for name, kind in kinds.items():
            part = table.get(name)
            values, more = read_table(path.name, name, part if isinstance(part, Mapping) else {}, keys_of(kind))
            found[name], faults = values, faults + more
        if faults:
            raise BadInput(faults)
        return cls(**{name: kind(**found[name]) for name, kind in kinds.items()})
