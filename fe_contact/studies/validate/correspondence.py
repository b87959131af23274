"""Maps of the paper's law beside the exact one and finite elements, over R1 and R2 of its steel ball.

The correspondence principle holds while the contact grows. Afterwards the paper's law cuts the force at zero; the exact
answer is Ting's (1966, doi:10.1115/1.3625192). Finite elements, which know neither, say which of them is right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.studies.files import Line, lines_of, write_study
from fe_contact.studies.sweep.cases import load
from fe_contact.studies.sweep.study import run
from fe_contact.studies.sweep.table import SweepTable
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column
from lumped.result.result import UNITS

SCHEMA = "fe-contact/validate-correspondence/1"
SCENE, EXACT, LAW = "steel-ball-sls", "ting", "correspondence"
R1, R2 = "target.material.R1", "target.material.R2"
# Ends of both axes, R2 in s: from a tenth of the stiffness to tenfold, from relaxed within an instant to never.
STIFFER, SLOWER = (0.1, 10.0), (1e-7, 1e-3)
POINTS, FEW_POINTS = (15, 25), (7, 11)  # of the map; of a quick one
PLACES, FEW_PLACES = (4, 5), (2, 3)  # at which finite elements are asked
LAW_TOLERANCE, TOLERANCE = 1e-5, 1e-3  # of the laws; of finite elements
MICRO = 1e6  # physics: µs in a s
HELD = ("peak_force", "peak_depth", "duration", "restitution", "impulse")


@dataclass(frozen=True, eq=False)
class CorrespondenceMap:
    """The paper's law and the exact one over the plane, and finite elements, with the exact law, at some places."""

    laws: SweepTable
    places: SweepTable

    def off(self, name: str) -> Array:
        """What the paper's law has too much of a quantity, relative, of the restitution absolute; (cases,)."""
        exact, law = (self.laws.values[:, method, _column(name)] for method in (0, 1))
        apart: Array = law - exact if name == "restitution" else law / exact - 1.0
        return apart

    @property
    def ratios(self) -> Array:
        """Finite elements less the exact law over both bars; (places, quantities held)."""
        columns = [_column(name) for name in HELD]
        values, bars = self.places.values[:, :, columns], self.places.errors[:, :, columns]
        return np.abs(values[:, 0] - values[:, 1]) / (bars[:, 0] + bars[:, 1])

    @property
    def agreeing(self) -> Array:
        """Whether finite elements agree with the exact law in everything; (places,)."""
        return np.asarray(np.nanmax(self.ratios, axis=1) <= 1.0)

    def place(self, table: SweepTable, case: int) -> str:
        """A case in words."""
        return f"R1 = {table.numbers[R1][case]:.3g}, R2 = {MICRO * table.numbers[R2][case]:.3g} µs"


def _column(name: str) -> int:
    return list(UNITS).index(name)


def make(asked: base.Request) -> base.Made:
    """Both laws over the plane, finite elements at some places."""
    laws = _swept(asked, "laws", FEW_POINTS if asked.quick else POINTS, [EXACT, LAW], LAW_TOLERANCE)
    places = _swept(asked, "places", FEW_PLACES if asked.quick else PLACES, ["fe", EXACT], TOLERANCE)
    found = CorrespondenceMap(laws, places)
    ratios, missed = found.ratios, places.missed or laws.missed
    case, quantity = np.unravel_index(int(np.nanargmax(ratios)), ratios.shape)
    place = (
        f"{HELD[quantity].replace('_', ' ')} of the steel ball with {found.place(places, int(case))} against {EXACT}"
    )
    worst = base.Worst(float(ratios[case, quantity]), int(np.isfinite(ratios).sum()), place)
    section = base.Section((headline(found),), tuple(sentences(found)), (FIGURE,), (LISTING,), worst, missed=missed)
    return base.Made(section, (partial(write, found),))


def _swept(asked: base.Request, name: str, counts: tuple[int, int], methods: list[str], tolerance: float) -> SweepTable:
    axes = {
        key: {"log": [*ends], "count": count}
        for key, ends, count in zip((R1, R2), (STIFFER, SLOWER), counts, strict=True)
    }
    sweep = load({"name": name, "scene": SCENE, "methods": methods, "tolerance": tolerance, "axes": axes})
    return run(sweep, asked.where / name, asked.jobs, None, True, asked.progress)


def headline(found: CorrespondenceMap) -> base.Headline:
    """How far the paper's law is off, and with which of both finite elements agree."""
    off, slow, agreeing = found.off("restitution"), found.off("duration"), found.agreeing
    said = (
        f"The paper's law in the rebound: restitution off by up to {_most(off):+.3f}, contact time by up to "
        f"{100.0 * _most(slow):+.2g} %, over {off.size} pairs of R1 and R2; finite elements agree with Ting's exact "
        f"answer at {int(agreeing.sum())} of {agreeing.size} places."
    )
    return base.Headline(base.DIFFERS if abs(_most(off)) > TOLERANCE or not agreeing.all() else base.HOLDS, said)


def _most(values: Array) -> float:
    """The one farthest from zero."""
    return float(values[np.nanargmax(np.abs(values))])


def sentences(found: CorrespondenceMap) -> list[str]:
    """Of every quantity where the paper's law is worst."""
    said = []
    for name in ("peak_force", "duration", "restitution"):
        off = found.off(name)
        case = int(np.nanargmax(np.abs(off)))
        if abs(off[case]) <= LAW_TOLERANCE:
            said.append(f"{name.replace('_', ' ')}: as the exact law has it, everywhere")
            continue
        size = f"{off[case]:+.2g}" if name == "restitution" else f"{100.0 * off[case]:+.2g} %"
        said.append(f"{name.replace('_', ' ')}: {size} at worst, at {found.place(found.laws, case)}")
    return said


def _lines(found: CorrespondenceMap) -> list[Line]:
    """Rows of correspondence.csv: the plane."""
    numbers = found.laws.numbers
    columns = {"R1": numbers[R1], "R2_s": numbers[R2]}
    for method, law in enumerate((EXACT, LAW)):
        columns |= {f"{law}_{name}": found.laws.values[:, method, _column(name)] for name in HELD}
    columns |= {f"{name}_off": found.off(name) for name in ("peak_force", "duration", "restitution")}
    return lines_of(columns)


def _checks(found: CorrespondenceMap) -> list[Line]:
    """Rows of elements.csv: the places."""
    table = found.places
    columns = {"R1": table.numbers[R1], "R2_s": table.numbers[R2]}
    for name in ("peak_force", "duration", "restitution"):
        place = _column(name)
        columns |= {name: table.values[:, 0, place], f"{name}_error": table.errors[:, 0, place]}
        columns |= {f"{name}_exact": table.values[:, 1, place]}
    return lines_of(columns | {"error_over_bar": np.nanmax(found.ratios, axis=1)})


def write(found: CorrespondenceMap, where: Path) -> None:
    """Write ``correspondence.csv``, ``elements.csv``, ``correspondence.json`` and the chart."""
    from fe_contact.studies.validate._chart import plot_correspondence

    tables: dict[str, Sequence[Line]] = {"correspondence": _lines(found), "elements": _checks(found)}
    write_study(where, "correspondence", {"schema": SCHEMA, "scene": SCENE, **tables}, tables)
    worst = np.nanmax(found.ratios, axis=1)
    plot_correspondence(
        found.laws.numbers[R1],
        found.laws.numbers[R2],
        {name: found.off(name) for name in ("restitution", "duration")},
        (found.places.numbers[R1], found.places.numbers[R2], worst),
        where,
    )


FIGURE = base.Figure(
    "correspondence",
    "The paper's law less the exact one, over R1 and R2 of its steel ball; dots: finite elements agree with the exact",
    ("correspondence.csv", "elements.csv"),
)
LISTING = base.Listing(
    "elements.csv",
    "Finite elements against the exact law",
    (
        Column("R1", "R1"),
        Column("R2_s", "R2, s"),
        Column("peak_force", "peak force, N", "peak_force_error"),
        Column("peak_force_exact", "exact, N"),
        Column("duration", "duration, s", "duration_error"),
        Column("duration_exact", "exact, s"),
        Column("restitution", "restitution", "restitution_error"),
        Column("restitution_exact", "exact"),
        Column("error_over_bar", "error over bar"),
    ),
)
MEMBER = base.ReportPart(
    rank=50,
    title="Correspondence maps",
    question="Where is the paper's viscoelastic law exact, and how far is it off in the rebound?",
    command="fe-contact validate --sections correspondence",
    make=make,
    seconds=19,
    quick="most places of the map",
)
