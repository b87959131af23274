"""Table 1 on trial: D, E* and alpha of every row, identified from slow indentation and from impact by finite elements.

At nu = 0 every modulus of the table is Young's: the force there tells D and alpha, and forces at other Poisson's
ratios over it tell E*. Line contact tells its E* by the slope of its logarithm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.table1.blocks import Block, blocks
from fe_contact.studies.table1.datum import Place, places
from fe_contact.studies.table1.impact import FromImpact, line_impacts, power_law_impacts
from fe_contact.studies.table1.reach import Reach, reach
from lumped.errors import NotReached
from lumped.indentation import Indentation, power_law
from lumped.paper.table1 import ROWS, Elastic, TableRow
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter

RATIOS = (0.0, 0.23, 0.45)
YOUNG = 1e9  # Pa
SHALLOW = tuple(float(share) for share in np.geomspace(1e-5, 1e-3, 5))  # depths over the row's length: they identify
DEEP = tuple(float(share) for share in np.geomspace(2e-3, 0.5, 16))  # they tell how far the power law holds
WHOLE = tuple(float(share) for share in np.geomspace(1e-4, 0.1, 7))  # the same for bodies of their true size
LINE = (1e-5, 1e-4)  # line contact has no power law to look for
TOLERANCE = 3e-4
LINE_TOLERANCE = 1e-4  # the slope of a logarithm is a difference
WORKERS = 2
KEPT = "table1.jsonl"


@dataclass(frozen=True)
class Trial:
    """What finite elements make of one row.

    ``alpha`` and ``factor`` D, m^(2-alpha), from shallow depths at nu = 0; ``moduli``: E*, Pa, by Poisson's ratio (of
    the first body); rows whose D depends on a datum have ``datum`` instead. ``bonded``: blocks whose faces do
    not slide, at every nu above 0. ``impact``: the same identified from impacts. ``failure``: why there is no answer.
    """

    row: TableRow
    alpha: Quantity | None = None
    factor: Quantity | None = None
    moduli: Mapping[float, Quantity] = field(default_factory=dict)
    reach: Reach | None = None
    datum: tuple[Place, ...] = ()
    bonded: tuple[Block, ...] = ()
    impact: FromImpact | None = None
    failure: str = ""


def bodies(row: TableRow, nu: float) -> tuple[Elastic, ...]:
    """As many as the row has, the second twice as stiff and half as wide under pressure."""
    return (Elastic(YOUNG, nu), Elastic(2.0 * YOUNG, 0.5 * nu))[: row.bodies]


def table1(where: Path, progress: Progress = silent, jobs: int = WORKERS) -> tuple[Trial, ...]:
    """Every row of the table, in its order, by so many processes; rows are kept in the folder `where`.

    The longest work first: line contact at all its places, then two bodies before one, then the bonded blocks, which
    two rows share. Raises NotReached.
    """
    order = sorted(ROWS.values(), key=lambda row: (row.single, -row.bodies))
    calls: dict[str, partial[Any]] = {_named(row): partial(trial, row) for row in order}
    stuck = {f"bonded blocks, nu = {nu:g}": partial(blocks, Elastic(YOUNG, nu)) for nu in RATIOS if nu}
    found = journal.rows(where / KEPT, calls | stuck, progress, jobs)
    bonded = tuple(block for name in stuck for block in found[name])
    tried = (found[_named(row)] for row in ROWS.values())
    return tuple(replace(one, bonded=bonded) if one.row.block and not one.failure else one for one in tried)


def _named(row: TableRow) -> str:
    return f"row {row.number}: {row.case}"


def trial(row: TableRow) -> Trial:
    """One row but for its blocks; what finite elements cannot answer is said in ``failure``."""
    try:
        return _power_law(row) if row.single else _line_contact(row)
    except NotReached as failure:
        return Trial(row, failure=str(failure))


def _power_law(row: TableRow) -> Trial:
    curves = {nu: _pressed(row, row.scene(*bodies(row, nu)), SHALLOW + DEEP) for nu in RATIOS}
    whole, far = row.whole_scene(*bodies(row, RATIOS[1])), curves
    if whole != row.scene(*bodies(row, RATIOS[1])):
        far = {RATIOS[1]: _pressed(row, whole, WHOLE)}
    law = identified_law(row, curves[0.0])
    struck = power_law_impacts(row, {nu: bodies(row, nu) for nu in RATIOS})
    return Trial(
        row,
        *law,
        identified_moduli(row, curves),
        reach(row, far, {nu: bodies(row, nu) for nu in far}),
        impact=struck,
    )


def _line_contact(row: TableRow) -> Trial:
    curves = {nu: _pressed(row, row.scene(*bodies(row, nu)), LINE, LINE_TOLERANCE) for nu in RATIOS}
    moduli = {nu: logarithms_modulus(row, curve) for nu, curve in curves.items()}
    struck = line_impacts(row, {nu: bodies(row, nu) for nu in RATIOS}, RATIOS[1])
    found = () if struck.place is None else (struck.place,)
    return Trial(row, moduli=moduli, datum=(*places(row, *bodies(row, RATIOS[1])), *found), impact=struck)


def _pressed(row: TableRow, scene: Indenter, shares: tuple[float, ...], tolerance: float = TOLERANCE) -> Indentation:
    return indent(scene, tuple(share * row.length for share in shares), {"tolerance": tolerance})


def identified_law(row: TableRow, curve: Indentation) -> tuple[Quantity, Quantity]:
    """alpha, and D with the row's alpha held, from the shallow depths of the curve at nu = 0."""
    shallow = curve.depth <= SHALLOW[-1] * row.length * (1.0 + 1e-9)
    per_modulus = curve.force[shallow] / row.modulus(*bodies(row, 0.0))
    relative = (curve.force_error / curve.force)[shallow]
    found = power_law(curve.depth[shallow], per_modulus, relative, row.alpha)
    return found["alpha"], found["D_at_alpha"]


def identified_moduli(row: TableRow, curves: Mapping[float, Indentation]) -> dict[float, Quantity]:
    """E*, Pa: Young's modulus (of the bodies in series) times force over force at nu = 0, at the shallowest depth."""
    base, known = curves[0.0], row.modulus(*bodies(row, 0.0))
    found = {}
    for nu, curve in curves.items():
        value = known * float(curve.force[0] / base.force[0])
        relative = float(curve.force_error[0] / curve.force[0] + base.force_error[0] / base.force[0])
        found[nu] = Quantity(value, relative * value if nu else 0.0, "Pa")
    return found


def logarithms_modulus(row: TableRow, curve: Indentation) -> Quantity:
    """E*, Pa: b^2 = 4 R F/(pi E* l), so that from one small contact to another depth/F falls by ln F/(pi E* l).

    Where bodies end and where they are held adds the same to both.
    """
    length = row.factor / (0.25 * np.pi)
    compliance, relative = curve.depth / curve.force, curve.force_error / curve.force
    fall, growth = float(compliance[0] - compliance[1]), float(np.log(curve.force[1] / curve.force[0]))
    value = growth / (np.pi * length * fall)
    return Quantity(value, value * float(relative.sum() / growth + compliance @ relative / fall), "Pa")
