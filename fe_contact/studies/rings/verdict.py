"""The verdict on the paper's row for rings: how it errs over the depths tried, whatever the bars leave open.

What ``fe-contact ring`` writes: a line a depth, and a line an impact, as CSV; an entry for each as JSON.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from fe_contact.studies.rings.impact import JUDGED, RingStruck
from fe_contact.studies.rings.study import HOLDS, SMALL_STRAIN, RingCurve
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/ring/1"
COLUMNS = (
    "ring", "depth_m", "strain", "force_N", "force_error_N", "contact_radius_m", "row_force_N", "row_deviation",
    "factor", "factor_error", "exponent", "exponent_error", "beyond_small_strain",
)  # fmt: skip


@dataclass(frozen=True)
class RingVerdict:
    """``word``: "holds", "holds at one depth", "wrong"; where the row crosses the curve, m; ``sentence``: why."""

    word: str
    crossing: float | None
    sentence: str


def verdict(curve: RingCurve) -> RingVerdict:
    """On the depths whose strain is small; a row within a per cent, or within the bar, holds there."""
    small = curve.strain <= SMALL_STRAIN
    factor, bar = curve.factor[small], curve.factor_error[small]
    if np.all(np.abs(factor - 1.0) <= HOLDS + bar):
        return RingVerdict("holds", None, _range(curve))
    crossing = _crossing(curve)
    if crossing is None:
        return RingVerdict("wrong", None, _range(curve))
    strain = crossing / curve.case.height
    return RingVerdict(
        "holds at one depth",
        crossing,
        f"at {1e3 * crossing:.3g} mm, {100 * strain:.2g} % of the height; {_range(curve)}",
    )


def _range(curve: RingCurve) -> str:
    """What the factor and the exponent are over all depths, and up to where strains are small."""
    factor, exponent = curve.factor, curve.exponent
    return (
        f"F over (pi/4) E* l depth from {factor[0]:.3g} to {factor[-1]:.3g}, "
        f"exponent {exponent.min():.3g} to {exponent.max():.3g} instead of 1; strains beyond "
        f"{100 * SMALL_STRAIN:g} % from {1e3 * SMALL_STRAIN * curve.case.height:.3g} mm on"
    )


def _crossing(curve: RingCurve) -> float | None:
    """Depth at which the factor passes one, m, on a straight line in logarithms."""
    x, y = np.log(curve.found.depth), np.log(curve.factor)
    passed = np.flatnonzero(y[:-1] * y[1:] <= 0.0)
    if not passed.size:
        return None
    i = int(passed[0])
    return float(np.exp(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i])))


def write_rings(curves: Sequence[RingCurve], where: Path, impacts: Sequence[RingStruck] = ()) -> Table:
    """Write ``ring.csv``, ``ring_impacts.csv`` and ``ring.json`` into a folder; the content of the last."""
    where.mkdir(parents=True, exist_ok=True)
    write_csv(where / "ring.csv", COLUMNS, [line for curve in curves for line in _lines(curve)])
    struck = [_struck(one) for one in impacts]
    if struck:
        write_csv(where / "ring_impacts.csv", tuple(struck[0]), [list(one.values()) for one in struck])
    content: Table = plain({"schema": SCHEMA, "rings": [_described(curve) for curve in curves], "impacts": struck})
    write_json(where / "ring.json", content)
    return content


def _lines(curve: RingCurve) -> list[list[object]]:
    found, row = curve.found, curve.row_force
    numbers = np.column_stack(
        [
            found.depth, curve.strain, found.force, found.force_error, found.contact_radius, row,
            row / found.force - 1.0, curve.factor, curve.factor_error, curve.exponent, curve.exponent_error,
        ]
    ).tolist()  # fmt: skip
    return [[curve.case.name, *line, line[1] > SMALL_STRAIN] for line in numbers]


def _described(curve: RingCurve) -> Table:
    indenter = curve.case.indenter
    return {
        "ring": curve.case.name,
        "scene": indenter.to_dict(),
        "length": curve.case.length,
        "contact_modulus": curve.found.modulus,
        "instantaneous_modulus": indenter.modulus(True),
        "converged": curve.found.converged,
        "verdict": asdict(verdict(curve)),
        "model_ledger": [entry.to_json(curve.found.tolerance) for entry in curve.ledger],
        "error_budget": {cause: float(np.max(error)) for cause, error in curve.found.budget.items()},
    }


def _struck(one: RingStruck) -> Table:
    """An impact: what the ring does, how far (30)-(32) are from it, and what constant bulk modulus would change."""
    table: Table = {
        "ring": one.ring,
        "strain": one.strain,
        "mass_kg": one.mass,
        "velocity_m_per_s": one.velocity,
    }
    for name in JUDGED:
        quantity = one.found.quantities[name]
        table |= {name: quantity.value, f"{name}_error": quantity.error, f"{name}_by_row": one.by_row(name)}
        table |= dict(zip((f"{name}_row_deviation", f"{name}_row_deviation_error"), one.deviation(name), strict=True))
        table |= dict(zip((f"{name}_of_bulk", f"{name}_of_bulk_error"), one.of_bulk(name), strict=True))
    return table | {"converged": one.found.converged and one.bulk.converged, "verdict": one.verdict}
