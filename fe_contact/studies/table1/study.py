"""Table 1 on trial: D, E* and alpha of every row, identified from slow indentation and from impact by finite elements.

At nu = 0 every modulus of the table is Young's: the force there tells D and alpha, and forces at other Poisson's
ratios over it tell E*. Line contact tells its E* by the slope of its logarithm. From impacts they are read off the
loading branch: while the striker comes in, force and depth are those of a slow indentation at every instant, each with
the bar of its history. No force enters there that a slow indentation found.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.reference import solve
from fe_contact.studies import journal
from fe_contact.studies.finite_exponents import SHARES as FINITE_SHARES
from fe_contact.studies.finite_exponents import StrainedRow
from fe_contact.studies.table1.limits import CHORD, DEPTH, Block, Place, Reach, blocks, places, reach
from lumped.errors import NotReached
from lumped.indentation import Indentation, power_law
from lumped.paper.table1 import ROWS, Elastic, TableRow
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.targets import Target
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.layer import Layer

RATIOS = (0.0, 0.23, 0.45)  # Poisson's ratios
YOUNG = 1e9  # Pa
SHALLOW = tuple(float(share) for share in np.geomspace(1e-5, 1e-3, 5))  # depths over the row's length: they identify
DEEP = tuple(float(share) for share in np.geomspace(2e-3, 0.5, 16))  # they tell how far the power law holds
WHOLE = tuple(float(share) for share in np.geomspace(1e-4, 0.1, 7))  # the same for bodies of their true size
LINE = (1e-5, 1e-4)  # line contact has no power law to look for
TOLERANCE = 3e-4  # of the indentations of power laws
LINE_TOLERANCE = 1e-4  # the slope of a logarithm is a difference
# of impacts
IMPACT_DEPTH = 1e-4  # greatest depth over the row's length
SHARES = tuple(float(share) for share in np.geomspace(0.2, 0.95, 9))  # of the greatest depth, at which forces are read
ENDS = (0.1, 0.95)  # the same where the slope of a logarithm is wanted
DEEPER = 1.3  # greatest depth over the one at which line contact is tried, if it were as stiff as printed
IMPACT_TOLERANCE = 1e-3  # of the certified impacts
MASS = 1.0  # kg: the velocity follows from it
FINITE_NU = 0.45  # of large strains: rubber, which bears them
WORKERS = 2  # work: default processes side by side
KEPT = "table1.jsonl"


@dataclass(frozen=True)
class FromImpact:
    """``alpha`` and ``factor`` D, m^(2-alpha), at nu = 0, or a ``place`` of line contact; ``moduli`` E*, Pa, by nu."""

    moduli: Mapping[float, Quantity]
    alpha: Quantity | None = None
    factor: Quantity | None = None
    place: Place | None = None


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

    def __repr__(self) -> str:
        known = {"alpha": self.alpha, "D": self.factor}
        known |= {f"E* at nu = {nu:g}": modulus for nu, modulus in self.moduli.items()}
        found = ", ".join(f"{name} {quantity}" for name, quantity in known.items() if quantity)
        return f"Trial of row {self.row.number}, {self.row.case}: {found or self.failure}"


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


def finite_rows() -> tuple[StrainedRow, ...]:
    """Every row of the table as large strains try it."""
    return tuple(_strained(row) for row in ROWS.values())


def _strained(row: TableRow) -> StrainedRow:
    """Depths over the row's length, or, of the cone, in m: it has none."""
    pressed = bodies(row, FINITE_NU)
    scene = row.scene(*pressed)
    return StrainedRow(
        _named(row),
        scene,
        tuple(share * row.length for share in FINITE_SHARES),
        row.factor * row.modulus(*pressed),
        row.alpha,
        radius=None if row.block or not row.length_name else row.length,
        thickness=row.length if row.block else scene.target.body_depth,
    )


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
    moduli = {
        nu: logarithms_modulus(row, curve.depth, curve.force, curve.force_error / curve.force)
        for nu, curve in curves.items()
    }
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


def logarithms_modulus(row: TableRow, depth: Array, force: Array, relative: Array) -> Quantity:
    """E*, Pa: b^2 = 4 R F/(pi E* l), so that from the first contact to the last depth/F falls by ln F/(pi E* l).

    Where bodies end and where they are held adds the same to both. `relative`: bars of the forces; (n,) each.
    """
    length = row.factor / (0.25 * math.pi)
    ends = [0, -1]
    compliance, relative = (depth / force)[ends], relative[ends]
    fall, growth = float(compliance[0] - compliance[1]), float(np.log(force[-1] / force[0]))
    value = growth / (math.pi * length * fall)
    return Quantity(value, value * float(relative.sum() / growth + compliance @ relative / fall), "Pa")


@dataclass(frozen=True, eq=False)
class Loading:
    """Depth, m, force, N, and what both may err by together, relative to the force; (n,) each."""

    depth: Array
    force: Array
    relative: Array


def power_law_impacts(row: TableRow, bodies: Mapping[float, tuple[Elastic, ...]]) -> FromImpact:
    """Of a row with one D; ``bodies`` by Poisson's ratio, nu = 0 among them. Raises NotReached."""
    curves = {
        nu: loading(row, row.scene(*pressed), IMPACT_DEPTH * row.length, SHARES, *pressed)
        for nu, pressed in bodies.items()
    }
    base, known = curves[0.0], row.modulus(*bodies[0.0])
    law = power_law(base.depth, base.force / known, base.relative, row.alpha)
    moduli = {nu: _modulus(row, known, base, curve) for nu, curve in curves.items()}
    moduli[0.0] = Quantity(known, 0.0, "Pa")
    return FromImpact(moduli, law["alpha"], law["D_at_alpha"])


def line_impacts(row: TableRow, bodies: Mapping[float, tuple[Elastic, ...]], nu: float) -> FromImpact:
    """Of line contact: E* by the slope of its logarithm; D at one depth for one nu, with the row's own support."""
    moduli = {}
    for ratio, pressed in bodies.items():
        curve = loading(row, row.scene(*pressed), IMPACT_DEPTH * row.length, ENDS, *pressed)
        moduli[ratio] = logarithms_modulus(row, curve.depth, curve.force, curve.relative)
    return FromImpact(moduli, place=_place(row, bodies[nu]))


def _place(row: TableRow, bodies: tuple[Elastic, ...]) -> Place:
    """D/l and the exponent around one depth."""
    scene, modulus = row.scene(*bodies), row.modulus(*bodies)
    depths = tuple(factor * DEPTH * row.length for factor in CHORD)
    curve = loading(row, scene, DEEPER * DEPTH * row.length, depths, *bodies, shared=False)
    alpha = power_law(curve.depth, curve.force / modulus, curve.relative, row.alpha)["alpha"]
    length = row.factor / (0.25 * math.pi)
    factor = float(curve.force[1] / (modulus * curve.depth[1] * length))
    found = Quantity(factor, factor * float(curve.relative[1]), "1")
    support, size = _support(scene.target)
    return Place(support, size / row.length, "impact", found, alpha)


def _support(target: Target) -> tuple[str, float]:
    """What carries the contact, and its length, m."""
    if isinstance(target, Layer):
        return f"{target.base} layer", target.thickness
    assert isinstance(target, CylinderTarget)
    return target.support or "", target.radius


def loading(
    row: TableRow, slow: Indenter, deepest: float, wanted: tuple[float, ...], *bodies: Elastic, shared: bool = True
) -> Loading:
    """Forces on the way in, at depths ``wanted``, m, or ``shared`` with the greatest one; raises NotReached.

    The velocity is that of a striker which the row as printed would stop at the ``deepest``, m.
    """
    work = row.factor * row.modulus(*bodies) * deepest ** (row.alpha + 1.0) / (row.alpha + 1.0)
    scene = Scene(
        slow.shape,
        MASS,
        math.sqrt(2.0 * work / MASS),
        slow.material,
        target=slow.target,
        model=slow.model,
        striker_material=slow.striker_material,
        name=slow.name,
    )
    certified = solve(scene, {"tolerance": IMPACT_TOLERANCE}).certified
    curve = certified.curve
    turn = int(curve.dense.depth.argmax())
    top = float(curve.dense.depth[turn])
    depths = np.array(wanted) * (top if shared else 1.0)
    times = np.interp(depths, curve.dense.depth[: turn + 1], curve.dense_time[: turn + 1])
    here = curve.read(times)
    error = row.alpha * certified.total("peak_depth") / here.depth
    return Loading(here.depth, here.force, certified.force_error(times) / here.force + error)


def _modulus(row: TableRow, known: float, base: Loading, curve: Loading) -> Quantity:
    """E*, Pa: that at nu = 0 times the mean ratio of both forces over depth^alpha."""
    ratio = curve.force / curve.depth**row.alpha / (base.force / base.depth**row.alpha)
    value = known * float(np.exp(np.log(ratio).mean()))
    return Quantity(value, value * float((curve.relative + base.relative).mean()), "Pa")
