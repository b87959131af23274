"""What ``fe-contact ring`` writes: a line a depth as CSV, an entry a ring as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from fe_contact.validation.rings import SMALL_STRAIN, RingCurve
from fe_contact.validation.rings_verdict import verdict
from fe_contact.validation.tables import plain, write_csv, write_json

SCHEMA = "fe-contact/ring/1"
COLUMNS = (
    "ring", "depth_m", "strain", "force_N", "force_error_N", "contact_radius_m", "row_force_N", "row_deviation",
    "factor", "factor_error", "exponent", "exponent_error", "beyond_small_strain",
)  # fmt: skip


def write_rings(curves: Sequence[RingCurve], where: Path) -> dict[str, Any]:
    """Write ``ring.csv`` and ``ring.json`` into a folder; the content of the latter."""
    where.mkdir(parents=True, exist_ok=True)
    write_csv(where / "ring.csv", COLUMNS, [line for curve in curves for line in _lines(curve)])
    content: dict[str, Any] = plain({"schema": SCHEMA, "rings": [_described(curve) for curve in curves]})
    write_json(where / "ring.json", content)
    return content


def _lines(curve: RingCurve) -> list[list[Any]]:
    found, row = curve.found, curve.row_force
    numbers = np.column_stack(
        [
            found.depth, curve.strain, found.force, found.force_error, found.contact_radius, row,
            row / found.force - 1.0, curve.factor, curve.factor_error, curve.exponent, curve.exponent_error,
        ]
    ).tolist()  # fmt: skip
    return [[curve.case.name, *line, line[1] > SMALL_STRAIN] for line in numbers]


def _described(curve: RingCurve) -> dict[str, Any]:
    indenter = curve.case.indenter
    return {
        "ring": curve.case.name,
        "scene": indenter.to_dict(),
        "length": curve.case.length,
        "contact_modulus": curve.found.modulus,
        "instantaneous_modulus": indenter.modulus(True),
        "converged": curve.found.converged,
        "verdict": asdict(verdict(curve)),
        "model_ledger": [asdict(entry) for entry in curve.ledger],
        "error_budget": {cause: float(np.max(error)) for cause, error in curve.found.budget.items()},
    }
