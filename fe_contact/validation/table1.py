"""Table 1 on trial: D, E* and alpha of every row, identified from slow indentation by finite elements.

At nu = 0 every modulus of the table is Young's: the force there tells D and alpha, and forces at other Poisson's
ratios over it tell E*.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fe_contact.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.validation.datum import Place, places
from lumped.errors import NotReached
from lumped.indentation import Indentation, power_law
from lumped.result import Quantity
from lumped.table1 import Elastic, Row, examples

RATIOS = (0.0, 0.23, 0.45)
YOUNG = 1e9  # Pa
SHALLOW = tuple(float(share) for share in np.geomspace(1e-5, 1e-3, 5))  # depths over the row's length: they identify
DEEP = tuple(float(share) for share in np.geomspace(2e-3, 0.5, 16))  # they tell how far the power law holds
LINE_DEPTHS = (0.01,)  # line contact has no power law to look for
TOLERANCE = 3e-4
LIMIT = 0.01  # departure from the power law that counts as its end


@dataclass(frozen=True)
class Reach:
    """Depths over the row's length: tried `first` to `last`, the power law within 1 % up to `held` (with a bar).

    `departure`, shape (n,): force over the corrected row's, less one, at `depth`, the worst of all nu.
    """

    first: float
    last: float
    held: Quantity
    depth: Array
    departure: Array

    @property
    def throughout(self) -> bool:
        """Whether it holds at every depth tried."""
        return self.held.value == self.last


@dataclass(frozen=True)
class Trial:
    """What finite elements make of one row.

    ``alpha`` and ``factor`` D, m^(2-alpha), from shallow depths at nu = 0; ``moduli``: E*, Pa, by Poisson's ratio (of
    the first body); rows whose D depends on a datum have ``datum`` instead. ``failure``: why there is no answer.
    """

    row: Row
    alpha: Quantity | None = None
    factor: Quantity | None = None
    moduli: Mapping[float, Quantity] = field(default_factory=dict)
    reach: Reach | None = None
    datum: tuple[Place, ...] = ()
    failure: str = ""


def bodies(row: Row, nu: float) -> tuple[Elastic, ...]:
    """As many as the row has, the second twice as stiff and half as wide under pressure."""
    return (Elastic(YOUNG, nu), Elastic(2.0 * YOUNG, 0.5 * nu))[: row.bodies]


def table1(progress: Progress = silent) -> tuple[Trial, ...]:
    """Every row of the table, in its order."""
    found = []
    for row in examples():
        progress(f"row {row.number}: {row.case}")
        found.append(trial(row))
    return tuple(found)


def trial(row: Row) -> Trial:
    """One row; what finite elements cannot answer is said in ``failure``."""
    depths = np.array(SHALLOW + DEEP if row.single else LINE_DEPTHS) * row.length
    try:
        curves = {nu: _pressed(row, nu, depths) for nu in RATIOS}
        place = places(row, bodies(row, RATIOS[1])) if not row.single else ()
    except NotReached as failure:
        return Trial(row, failure=str(failure))
    moduli = identified_moduli(row, curves)
    if not row.single:
        return Trial(row, moduli=moduli, datum=place)
    return Trial(row, *identified_law(row, curves[0.0]), moduli, reach(row, curves))


def _pressed(row: Row, nu: float, depths: Array) -> Indentation:
    scene = row.scene(*bodies(row, nu))
    if scene is None:
        raise NotReached("finite elements have no such body in this version")
    return indent(scene, tuple(float(depth) for depth in depths), {"tolerance": TOLERANCE})


def identified_law(row: Row, curve: Indentation) -> tuple[Quantity, Quantity]:
    """alpha, and D with the row's alpha held, from the shallow depths of the curve at nu = 0."""
    shallow = curve.depth <= SHALLOW[-1] * row.length * (1.0 + 1e-9)
    per_modulus = curve.force[shallow] / row.modulus(*bodies(row, 0.0))
    relative = (curve.force_error / curve.force)[shallow]
    found = power_law(curve.depth[shallow], per_modulus, relative, row.alpha)
    return found["alpha"], found["D_at_alpha"]


def identified_moduli(row: Row, curves: Mapping[float, Indentation]) -> dict[float, Quantity]:
    """E*, Pa: Young's modulus (of the bodies in series) times force over force at nu = 0, at the shallowest depth."""
    base, known = curves[0.0], row.modulus(*bodies(row, 0.0))
    found = {}
    for nu, curve in curves.items():
        value = known * float(curve.force[0] / base.force[0])
        relative = float(curve.force_error[0] / curve.force[0] + base.force_error[0] / base.force[0])
        found[nu] = Quantity(value, relative * value if nu else 0.0, "Pa")
    return found


def reach(row: Row, curves: Mapping[float, Indentation]) -> Reach:
    """How deep the corrected row holds within 1 %, at every nu."""
    departures, bars = [], []
    for nu, curve in curves.items():
        departures.append(curve.force / row.force(curve.depth, *bodies(row, nu)) - 1.0)
        bars.append(curve.force_error / curve.force)
    every = np.array(departures)
    worst = every[np.abs(every).argmax(axis=0), np.arange(every.shape[1])]
    share = curves[0.0].depth / row.length
    held = _held(share, np.abs(worst), np.max(bars, axis=0))
    return Reach(float(share[0]), float(share[-1]), held, share, worst)


def _held(share: Array, departure: Array, bar: Array) -> Quantity:
    """The first depth at which a departure passes the limit, by a parabola through three depths around it.

    Its bar: how far the bars of the forces move it, and how far it lies from the straight line's answer.
    """
    beyond = np.flatnonzero(departure > LIMIT)
    if not beyond.size:
        return Quantity(float(share[-1]), 0.0, "1")
    if beyond[0] == 0:
        return Quantity(0.0, float(share[0]), "1")
    end = int(beyond[0])
    low, high = departure[end - 1], departure[end]
    slope = (high - low) / (share[end] - share[end - 1])
    straight = share[end - 1] + (LIMIT - low) / slope
    start = max(end - 2, 0)
    fit = np.polynomial.Polynomial.fit(share[start : end + 1], departure[start : end + 1] - LIMIT, 2)
    roots = np.real(fit.roots())
    bent = roots[np.abs(roots - straight).argmin()]
    return Quantity(float(bent), float(abs(bent - straight) + bar[end] / slope), "1")
