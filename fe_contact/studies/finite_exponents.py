"""Where exponents leave their small-strain values as strains grow large, for two energies: study, sentences, files.

A row's exponent is d ln F/d ln depth between the neighbours of a depth, with large displacements and with small ones on
the same profile: what a true profile or a thickness does at small strain is no departure. Two energies with one E and
nu tell what moves it: what both change alike, the lesser of two changes of one sign, is geometry (the deformed surface,
turned and stretched bodies), what they differ by is the material.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress
from fe_contact.studies import journal
from fe_contact.studies.files import Line, lines_of, write_study
from lumped.errors import BadInput, NotReached
from lumped.result.model_ledger import ENERGY_NAMES
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.schema import Table

SCHEMA = "fe-contact/finite-exponents/1"
ENERGIES = ("neo_hooke", "mooney_rivlin")
LIMITS = (0.01, 0.05, 0.1)  # departures of an exponent that are looked for, relative
SHARES = tuple(float(share) for share in np.geomspace(2e-3, 0.4, 11))  # depths over a row's length
TOLERANCE = 1e-3  # of the forces
LEAST = 1e-9  # rounding: departure below which it rules
KEPT = "finite_exponents.jsonl"


@dataclass(frozen=True)
class StrainedRow:
    """A row F = `factor` depth^`alpha`, N, pressed to `depths`, m, over a radius R and a thickness h, m, if any.

    `label` is what a person calls it; the `indenter` has small displacements.
    """

    label: str
    indenter: Indenter
    depths: tuple[float, ...]
    factor: float
    alpha: float
    radius: float | None = None
    thickness: float | None = None

    @property
    def lengths(self) -> dict[str, float]:
        """Those that it has, m, by their letters."""
        known = {"R": self.radius, "h": self.thickness}
        return {name: length for name, length in known.items() if length is not None}

    def strained(self, energy: str) -> Indenter:
        """With large displacements and an energy."""
        indenter = self.indenter
        material = replace(indenter.material, hyperelastic=energy)
        return replace(indenter, material=material, model=replace(indenter.model, kinematics="finite"))


@dataclass(frozen=True, eq=False)
class ExponentsOf:
    """A `force`, N, its relative bar, and the local `exponent` with its own bar, at every depth; (n,) each."""

    force: Array
    relative: Array
    exponent: Array
    error: Array

    @classmethod
    def of(cls, indenter: Indenter, depths: tuple[float, ...]) -> ExponentsOf:
        """By slow indentation. Raises BadInput, NotReached."""
        found = indent(indenter, depths, {"tolerance": TOLERANCE})
        relative = found.force_error / found.force
        return cls(found.force, relative, *local_exponent(found.depth, found.force, relative))


def local_exponent(depth: Array, force: Array, relative: Array) -> tuple[Array, Array]:
    """Slope of ln F on ln depth between the neighbours of every depth, and its bar; (n,)."""
    places = np.arange(depth.size)
    left, right = np.maximum(places - 1, 0), np.minimum(places + 1, depth.size - 1)
    width = np.log(depth[right] / depth[left])
    return np.log(force[right] / force[left]) / width, (relative[right] + relative[left]) / width


def zero_after(x: Array, y: Array, place: int) -> float:
    """Where the straight line from one point to the next meets zero."""
    return float(x[place] - y[place] * (x[place + 1] - x[place]) / (y[place + 1] - y[place]))


def first_beyond(share: Array, departure: Array, bar: Array, limit: float) -> Quantity | None:
    """The first of ascending places at which a departure passes a limit, by a parabola through three, in logarithms.

    Its bar: how far the ``bar`` of the departure moves it, and how far it lies from the straight line's answer. Zero,
    with the first place as its bar, where that is beyond; None where none is. (n,) each.
    """
    beyond = np.flatnonzero(departure > limit)
    if not beyond.size:
        return None
    if beyond[0] == 0:
        return Quantity(0.0, float(share[0]), "1")
    end = int(beyond[0])
    near = slice(max(end - 2, 0), end + 1)
    x, y = np.log(share[near]), np.log(np.maximum(departure[near], LEAST) / limit)
    slopes = np.diff(y) / np.diff(x)
    straight, bend = y[-1] / slopes[-1], float(np.diff(slopes).sum()) / (x[-1] - x[0])
    steep = slopes[-1] + bend * (x[-1] - x[-2])
    before = 2.0 * y[-1] / (steep + math.sqrt(max(steep**2 - 4.0 * bend * y[-1], 0.0)))
    moved = abs(before - straight) + float(bar[end]) / (limit * slopes[-1])
    place = math.exp(x[-1] - before)
    return Quantity(place, place * math.expm1(moved), "1")


@dataclass(frozen=True, eq=False)
class Departures:
    """A row by `small` displacements and, by energy, by `large` ones; or why it is `refused`."""

    row: StrainedRow
    small: ExponentsOf | None = None
    large: dict[str, ExponentsOf] = field(default_factory=dict)
    refused: str = ""

    def departure(self, energy: str) -> tuple[Array, Array]:
        """Exponent over the one of small strain, less one, and its bar, (n,)."""
        assert self.small is not None
        own, small = self.large[energy], self.small
        ratio = own.exponent / small.exponent
        return ratio - 1.0, (own.error + ratio * small.error) / small.exponent

    @property
    def geometry(self) -> Array:
        """What both energies change alike, (n,)."""
        changes = np.array([self.departure(energy)[0] for energy in self.large])
        alike = np.abs(np.sum(np.sign(changes), axis=0)) == len(changes)
        return np.where(alike, np.sign(changes[0]) * np.abs(changes).min(axis=0), 0.0)

    @property
    def material(self) -> Array:
        """What they differ by, (n,)."""
        changes = np.array([self.departure(energy)[0] for energy in self.large])
        return np.asarray(changes.max(axis=0) - changes.min(axis=0))

    def end(self, energy: str, limit: float) -> Quantity | None:
        """Depth, m, at which the exponent has departed by a limit; None: nowhere."""
        departure, bar = self.departure(energy)
        found = first_beyond(np.array(self.row.depths), np.abs(departure), bar, limit)
        return found and replace(found, unit="m")

    def over_row(self, energy: str) -> Array:
        """Force over the row's, (n,)."""
        return self.large[energy].force / (self.row.factor * np.array(self.row.depths) ** self.row.alpha)


def departures(row: StrainedRow) -> Departures:
    """One row; what large strains do not answer yet is said in ``refused``."""
    try:
        large = {energy: ExponentsOf.of(row.strained(energy), row.depths) for energy in ENERGIES}
        return Departures(row, ExponentsOf.of(row.indenter, row.depths), large)
    except BadInput as refused:
        return Departures(row, refused=refused.faults[0].message)
    except NotReached as failure:
        return Departures(row, refused=str(failure))


def finite_exponents(rows: Sequence[StrainedRow], where: Path, progress: Progress) -> tuple[Departures, ...]:
    """Every row; kept in the folder `where`."""
    calls = {row.label: partial(departures, row) for row in rows}
    return tuple(journal.rows(where / KEPT, calls, progress).values())


def told(found: Sequence[Departures]) -> list[str]:
    """A sentence a row."""
    return [f"{one.row.label}: {sentence(one)}" for one in found]


def sentence(found: Departures) -> str:
    """Where the exponent has departed, by how much at the deepest, and what of that is geometry."""
    if found.small is None:
        return f"not with large strains yet: {found.refused}"
    row, depth = found.row, max(found.row.depths)
    ends = (_ends(found, limit) for limit in LIMITS)
    at = ", ".join(f"depth/{name} = {depth / length:.3g}" for name, length in row.lengths.items()) or f"{depth:.3g} m"
    last = ", ".join(f"{100 * found.departure(energy)[0][-1]:+.2g} %" for energy in ENERGIES)
    forces = ", ".join(f"{found.over_row(energy)[-1]:.3g}" for energy in ENERGIES)
    return (
        f"alpha {found.small.exponent[0]:.4g} leaves its small-strain value {'; '.join(ends)} "
        f"({' | '.join(ENERGY_NAMES[energy] for energy in ENERGIES)}); at {at} it is off by {last}: geometry "
        f"{100 * found.geometry[-1]:+.2g} %, material {100 * found.material[-1]:.2g} %; force over the row's {forces}"
    )


def _ends(found: Departures, limit: float) -> str:
    """By one limit, each energy's place in the row's first length."""
    name, length = next(iter(found.row.lengths.items()), ("m", 1.0))
    places = [found.end(energy, limit) for energy in ENERGIES]
    said = f"by {100 * limit:g} %"
    if not any(places):
        return f"{said} nowhere"
    told = ["nowhere" if one is None else f"{(one.value or 0.0) / length:.3g}" for one in places]
    return f"{said} at depth/{name} = {' | '.join(told)}"


def write_finite(study: str, found: Sequence[Departures], where: Path) -> Table:
    """Write ``<study>_finite.csv``, ``<study>_finite_depths.csv`` and ``<study>_finite.json`` into a folder.

    Returns the content of the last.
    """
    tables = {
        f"{study}_finite": [line for one in found for line in _ends_of(one)],
        f"{study}_finite_depths": [line for one in found for energy in one.large for line in _depths(one, energy)],
    }
    content = {"schema": SCHEMA, "study": study, "energies": ENERGIES, "rows": [_described(one) for one in found]}
    return write_study(where, f"{study}_finite", content, tables, {f"{study}_finite_depths": ("row", "energy")})


def _ends_of(found: Departures) -> list[Line]:
    """A line an energy: depths over every length at which the exponent departs, what there is at the deepest."""
    row = found.row
    lines: list[Line] = []
    for energy in ENERGIES:
        line: dict[str, object] = {"row": row.label, "energy": energy, "nu": row.indenter.material.nu}
        line |= {"row_exponent": row.alpha, "small_exponent": found.small and float(found.small.exponent[0])}
        for limit in LIMITS:
            end = found.end(energy, limit) if found.small is not None else None
            line |= _over("R", row.radius, limit, end) | _over("h", row.thickness, limit, end)
        if found.small is not None:
            departure, bar = found.departure(energy)
            line |= {"tried_to_m": max(row.depths), "departure_there": float(departure[-1]), "error": float(bar[-1])}
            line |= {"geometry_there": float(found.geometry[-1]), "material_there": float(found.material[-1])}
            line |= {"force_over_row_there": float(found.over_row(energy)[-1])}
        lines.append(line | {"refused": found.refused or None, "statement": sentence(found)})
    return lines


def _over(name: str, length: float | None, limit: float, end: Quantity | None) -> dict[str, object]:
    """Two cells: a depth over a length, and its bar."""
    column = f"depth_over_{name}_at_{100 * limit:g}_percent"
    if end is None or length is None:
        return {column: None, f"{column}_error": None}
    return {column: (end.value or 0.0) / length, f"{column}_error": (end.error or 0.0) / length}


def _depths(found: Departures, energy: str) -> list[Line]:
    """A line a depth."""
    assert found.small is not None
    row, own, depth = found.row, found.large[energy], np.array(found.row.depths)
    departure, bar = found.departure(energy)
    return lines_of(
        {
            "row": row.label,
            "energy": energy,
            "depth_m": depth,
            **{f"depth_over_{name}": depth / length for name, length in row.lengths.items()},
            "force_N": own.force,
            "force_error_N": own.relative * own.force,
            "force_over_row": found.over_row(energy),
            "force_over_small_strain": own.force / found.small.force,
            "exponent": own.exponent,
            "exponent_error": own.error,
            "small_exponent": found.small.exponent,
            "small_exponent_error": found.small.error,
            "departure": departure,
            "departure_error": bar,
            "geometry": found.geometry,
            "material": found.material,
        }
    )


def _described(found: Departures) -> Table:
    """One row of the record."""
    row = found.row
    ends = {energy: {f"{limit:g}": found.end(energy, limit) for limit in LIMITS} for energy in found.large}
    return {
        "row": row.label,
        "scene": row.indenter.to_dict(),
        "row_exponent": row.alpha,
        "lengths": row.lengths,
        "departs_at_depth": ends,
        "statement": sentence(found),
        "refused": found.refused or None,
    }
