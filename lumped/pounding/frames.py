"""Shear frames, two of them or one beside a wall, with gaps between their storeys; and floors that have waves.

M q'' + C q' + K q = -M 1 a(t) - R^T F: q are the displacements of the storeys relative to the ground, to the right; a
row of R is +1 at the left and -1 at the right storey of a gap, so that R q - distance is its depth, and F >= 0 pushes
both back. A wall moves with the ground. Waves of slabs follow the storeys in q, and every gap at a storey presses on
those of its slab too.

A slab is the floor of a storey as an elastic rod that is struck at one end, by its modes. With s from the struck end
and q the mean displacement, u = q + sum_k q_k cos(k pi s/length): each mode is an oscillator of half the rod's mass,
and a gap sees q + sum_k q_k. The storey's mass lies evenly along the rod and its columns pull evenly, so that columns
and ground act on the mean alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import pi, sqrt
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from scipy.linalg import block_diag

from lumped.errors import BadInput, Fault
from lumped.numbers import Array
from lumped.pounding.flow import LinearBodies
from lumped.schema.keys import Choice, Count, Key, Number, Numbers, Record

ANY_LENGTH, ANY_SPEED = Number(-1e4, 1e4, "m"), Number(-1e4, 1e4, "m/s")
DAMPINGS = ("damping_ratio", "rayleigh", "dashpot")
MOST_STOREYS, MOST_MODES = 50, 200  # work: of one frame, of all slabs together
SIDES = ("left", "right")
STOREY = Count(1, MOST_STOREYS)


def storeys(each: Number) -> Numbers:
    """A list with a number for every storey."""
    return Numbers(each, MOST_STOREYS)


@dataclass(frozen=True)
class ShearFrame(Record):
    """Storeys, the lowest first: a mass each, and the columns below it. One kind of damping, or none.

    `displacement` and `velocity` are those at t = 0, relative to the ground. Raises BadInput.
    """

    mass: Annotated[tuple[float, ...], Key(storeys(Number(1e-9, 1e12, "kg")), "masses, the lowest storey first")]
    stiffness: Annotated[tuple[float, ...], Key(storeys(Number(0.0, 1e18, "N/m")), "of the columns below each storey")]
    damping_ratio: Annotated[float | None, Key(Number(0.0, 10.0), "of every mode")] = None
    rayleigh: Annotated[
        tuple[float, ...] | None,
        Key(Numbers(Number(0.0, 1e6, "1/s, then s"), 2), "C = first M + second K"),
    ] = None
    dashpot: Annotated[
        tuple[float, ...] | None, Key(storeys(Number(0.0, 1e15, "N s/m")), "beside the columns below each storey")
    ] = None
    displacement: Annotated[tuple[float, ...] | None, Key(storeys(ANY_LENGTH), "at t = 0")] = None
    velocity: Annotated[tuple[float, ...] | None, Key(storeys(ANY_SPEED), "at t = 0")] = None
    name: ClassVar[str] = "structure"

    def __post_init__(self) -> None:
        super().__post_init__()
        faults = [
            Fault(self.name, key, f"{len(values)} values; accepted: {count}")
            for key, values, count in (
                ("stiffness", self.stiffness, self.size),
                ("rayleigh", self.rayleigh, 2),
                ("dashpot", self.dashpot, self.size),
                ("displacement", self.displacement, self.size),
                ("velocity", self.velocity, self.size),
            )
            if values is not None and len(values) != count
        ]
        given = [key for key in DAMPINGS if getattr(self, key) is not None]
        if len(given) > 1:
            faults.append(
                Fault(self.name, given[1], f"given beside {given[0]}; accepted: one of {', '.join(DAMPINGS)}")
            )
        if faults:
            raise BadInput(faults)

    @property
    def size(self) -> int:
        """How many storeys."""
        return len(self.mass)

    @cached_property
    def stiffness_matrix(self) -> Array:
        """K, N/m, shape (n, n)."""
        return chain(self.stiffness)

    @cached_property
    def damping_matrix(self) -> Array:
        """C, N s/m, shape (n, n)."""
        if self.dashpot is not None:
            return chain(self.dashpot)
        if self.rayleigh is not None:
            return self.rayleigh[0] * np.diag(self.mass) + self.rayleigh[1] * self.stiffness_matrix
        root = np.sqrt(np.array(self.mass))
        squares, modes = np.linalg.eigh(self.stiffness_matrix / root / root[:, None])
        critical = 2.0 * np.sqrt(np.maximum(squares, 0.0))
        shaped = root[:, None] * modes
        return np.asarray((self.damping_ratio or 0.0) * (shaped * critical) @ shaped.T)


def chain(values: tuple[float, ...]) -> Array:
    """The matrix of springs, or dashpots, each between a storey and the one below it, shape (n, n)."""
    to_drift = np.eye(len(values)) - np.eye(len(values), k=-1)
    return np.asarray(to_drift.T @ np.diag(values) @ to_drift)


@dataclass(frozen=True)
class Gap(Record):
    """Between storey `left` of the left frame and `right` of the right one, counted from 1; None: the wall."""

    left: Annotated[int, Key(STOREY, "storey of the left structure")]
    right: Annotated[int | None, Key(STOREY, "storey of the right structure; none: a wall")] = None
    distance: Annotated[float, Key(Number(0.0, 1e4, "m"), "that has to close before they touch")] = 0.0
    name: ClassVar[str] = "gap"


@dataclass(frozen=True)
class PoundingFrames:
    """One or two frames, their gaps and the slabs that have waves, by names; how often to halve the modes of these.

    Raises BadInput for a gap at a storey that is not there, and for a slab at a storey without a gap.
    """

    left: ShearFrame
    right: ShearFrame | None = None
    gaps: Mapping[str, Gap] = field(default_factory=dict)
    slabs: Mapping[str, Slab] = field(default_factory=dict)
    halvings: int = 0

    def __post_init__(self) -> None:
        faults = [fault for name, gap in self.gaps.items() for fault in self._faults(f"gap.{name}", gap)]
        faults += self._slab_faults()
        if faults:
            raise BadInput(faults)

    def _faults(self, where: str, gap: Gap) -> list[Fault]:
        faults = []
        if gap.left > self.left.size:
            faults.append(Fault("gap", f"{where}.left", f"{gap.left}; accepted: 1 to {self.left.size}"))
        if gap.right is not None and self.right is None:
            faults.append(
                Fault("gap", f"{where}.right", f"{gap.right}, without a right structure; accepted: leave it out")
            )
        elif self.right is not None and not 1 <= (gap.right or 0) <= self.right.size:
            given = "missing" if gap.right is None else str(gap.right)
            faults.append(Fault("gap", f"{where}.right", f"{given}; accepted: 1 to {self.right.size}"))
        if not faults and self._overlap(gap) > 0.0:
            reason = f"closed by {self._overlap(gap):.3g} m at t = 0; accepted: a start that leaves it open"
            faults.append(Fault("gap", f"{where}.distance", reason))
        return faults

    def _slab_faults(self) -> list[Fault]:
        at = {f"{side}_{getattr(gap, side)}" for gap in self.gaps.values() for side in SIDES}
        struck, taken, faults = [name for name in self.storeys if name in at], set[str](), list[Fault]()
        for name, slab in self.slabs.items():
            if slab.at not in struck or slab.at in taken:
                accepted = f"accepted: storeys of a gap, one slab each: {', '.join(struck) or 'none here'}"
                faults.append(Fault("slab", f"slab.{name}.storey", f"{slab.at}; {accepted}"))
            taken.add(slab.at)
        if (modes := sum(slab.modes for slab in self.slabs.values())) > MOST_MODES:
            faults.append(Fault("slab", "slab.modes", f"{modes} of all together; accepted: at most {MOST_MODES}"))
        return faults

    def _overlap(self, gap: Gap) -> float:
        """Depth of a gap at t = 0, m."""
        left = (self.left.displacement or (0.0,) * self.left.size)[gap.left - 1]
        if self.right is None or gap.right is None:
            return left - gap.distance
        return left - (self.right.displacement or (0.0,) * self.right.size)[gap.right - 1] - gap.distance

    @property
    def frames(self) -> dict[str, ShearFrame]:
        """By name, in the order of the storeys in every array."""
        return {"left": self.left} if self.right is None else {"left": self.left, "right": self.right}

    @cached_property
    def storeys(self) -> tuple[str, ...]:
        """Their names, left_1 the lowest of the left frame."""
        return tuple(f"{name}_{i}" for name, frame in self.frames.items() for i in range(1, frame.size + 1))

    @cached_property
    def mass(self) -> Array:
        """kg, shape (n,), n the storeys of all frames."""
        return np.concatenate([frame.mass for frame in self.frames.values()])

    @cached_property
    def stiffness(self) -> Array:
        """K, N/m, shape (n, n)."""
        return block_diag(*(frame.stiffness_matrix for frame in self.frames.values()))

    @cached_property
    def columns(self) -> Array:
        """Stiffness of the columns below each storey, N/m, shape (n,)."""
        return np.concatenate([frame.stiffness for frame in self.frames.values()])

    @cached_property
    def damping(self) -> Array:
        """C, N s/m, shape (n, n)."""
        return block_diag(*(frame.damping_matrix for frame in self.frames.values()))

    @cached_property
    def to_drift(self) -> Array:
        """From displacements to drifts, each storey less the one below it, shape (n, n)."""
        return block_diag(*(np.eye(frame.size) - np.eye(frame.size, k=-1) for frame in self.frames.values()))

    @cached_property
    def bodies(self) -> LinearBodies:
        """The numbers that move: the storeys, then the waves of their slabs."""
        n, at = self.mass.size, [self.storeys.index(slab.at) for slab in self.slabs.values()]
        waves = [slab.waves(self.mass[i], self.halvings) for i, slab in zip(at, self.slabs.values(), strict=True)]
        mass, stiffness, damping = (np.concatenate(part) for part in zip(NO_MODES, *waves, strict=True))
        still, ends = np.zeros(mass.size), np.repeat(np.array(at, dtype=int), [one.mass.size for one in waves])
        return LinearBodies(
            np.append(self.mass, mass),
            block_diag(self.stiffness, np.diag(stiffness)),
            block_diag(self.damping, np.diag(damping)),
            np.hstack([self.rows, self.rows[:, ends]]),
            self.distances,
            np.concatenate([self.start[:n], still, self.start[n:], still]),
            mass.size,
        )

    @cached_property
    def rows(self) -> Array:
        """R, shape (m, n), m the gaps."""
        rows = np.zeros((len(self.gaps), self.mass.size))
        for row, gap in zip(rows, self.gaps.values(), strict=True):
            row[gap.left - 1] = 1.0
            if gap.right is not None:
                row[self.left.size + gap.right - 1] = -1.0
        return rows

    @cached_property
    def distances(self) -> Array:
        """Of the gaps, m, shape (m,)."""
        return np.array([gap.distance for gap in self.gaps.values()])

    def reduced_mass(self, gap: Gap) -> float:
        """Of the two storeys at a gap, kg; of the left one alone at a wall."""
        left, right = self.masses_at(gap)
        return left if right is None else left * right / (left + right)

    def masses_at(self, gap: Gap) -> tuple[float, float | None]:
        """Of the left and of the right storey of a gap, kg; None: a wall."""
        right = None if self.right is None or gap.right is None else self.right.mass[gap.right - 1]
        return self.left.mass[gap.left - 1], right

    @cached_property
    def start(self) -> Array:
        """Displacements, m, then velocities, m/s, at t = 0, shape (2 n,)."""
        still = [(0.0,) * frame.size for frame in self.frames.values()]
        places = [frame.displacement or zero for frame, zero in zip(self.frames.values(), still, strict=True)]
        speeds = [frame.velocity or zero for frame, zero in zip(self.frames.values(), still, strict=True)]
        return np.concatenate([*places, *speeds])


class SlabModes(NamedTuple):
    """Of shapes of a rod that are 1 at its struck end: mass, kg, stiffness, N/m, and damping, N s/m, each (n,)."""

    mass: Array
    stiffness: Array
    damping: Array


NO_MODES = SlabModes(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True)
class Slab(Record):
    """The floor of one storey, whose whole mass it has: its area is mass/(density length). Raises BadInput."""

    structure: Annotated[str, Key(Choice(SIDES), "which one it belongs to")]
    storey: Annotated[int, Key(STOREY, "whose floor it is, the lowest is 1")]
    length: Annotated[float, Key(Number(1e-3, 1e4, "m"), "from the struck end to the free one")]
    modulus: Annotated[float, Key(Number(1.0, 1e15, "Pa"), "along it")]
    density: Annotated[float, Key(Number(1e-3, 1e6, "kg/m3"), "with what it carries")]
    damping_ratio: Annotated[float, Key(Number(0.0, 1.0), "of its modes")] = 0.0
    modes: Annotated[int, Key(Count(4, MOST_MODES), "that are followed")] = 4
    name: ClassVar[str] = "slab"

    @property
    def at(self) -> str:
        """The name of its storey."""
        return f"{self.structure}_{self.storey}"

    @property
    def passage(self) -> float:
        """How long a wave takes along it, s."""
        return self.length * sqrt(self.density / self.modulus)

    def waves(self, mass: float, halvings: int = 0) -> SlabModes:
        """Its modes, and all higher ones as one shape more: what each yields at the struck end under a steady force.

        Of higher modes that is the sum of 1/(m_k w_k^2), and of 1/(m_k w_k^4) the kinetic energy that goes with it
        (Rubin 1975, doi 10.2514/3.60497). `mass`: the storey's, kg; `halvings`: of the modes followed, two at most.
        """
        from scipy.special import zeta  # late: only slabs need it

        first, count = pi / self.passage, self.modes >> halvings
        yields, carries = (2.0 / (mass * first**power) * float(zeta(power, count + 1)) for power in (2, 4))
        masses = np.append(np.full(count, 0.5 * mass), carries / yields**2)
        stiffness = np.append(0.5 * mass * (first * np.arange(1.0, count + 1.0)) ** 2, 1.0 / yields)
        return SlabModes(masses, stiffness, 2.0 * self.damping_ratio * np.sqrt(masses * stiffness))
