"""What ``fe-contact exponents`` writes: a line a point as CSV, a line a curve as JSON, and the finite spheres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from fe_contact.studies.exponents.check import Check
from fe_contact.studies.exponents.finite_spheres import Pair
from fe_contact.studies.exponents.study import ExponentCurve, Profile
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/exponents/1"
COLUMNS = (
    "shape", "profile_exponent", "base", "nu", "a_over_h", "method", "exponent", "exponent_error", "D_over_row",
    "D_over_row_error", "depth_over_height", "force_over_height", "row_exponent", "thin_exponent",
)  # fmt: skip
SPHERE_COLUMNS = ("support", "nu", "a_over_R", "F_over_Hertz_minus_1", "error")


def write_exponents(
    curves: Sequence[ExponentCurve], checks: Sequence[Check], pairs: Sequence[Pair], where: Path
) -> dict[str, Any]:
    """Write ``exponents.csv``, ``finite_spheres.csv`` and ``exponents.json`` into a folder; the content of the last."""
    where.mkdir(parents=True, exist_ok=True)
    rows = [line for curve in curves for line in _points(curve)] + [_checked(check) for check in checks]
    write_csv(where / "exponents.csv", COLUMNS, rows)
    write_csv(where / "finite_spheres.csv", SPHERE_COLUMNS, [line for pair in pairs for line in pair.rows()])
    content: dict[str, Any] = plain(
        {
            "schema": SCHEMA,
            "curves": [_described(curve) for curve in curves],
            "checks": [asdict(check) | {"covered": check.covered} for check in checks],
            "finite_spheres": [pair.to_dict() for pair in pairs],
            "all_covered": all(check.covered for check in checks),
        }
    )
    write_json(where / "exponents.json", content)
    return content


def _points(curve: ExponentCurve) -> list[list[Any]]:
    """Exact points; a depth under the flat end says nothing."""
    flat = np.isinf(curve.profile.n)
    columns = np.column_stack([curve.ratio, curve.exponent, curve.factor, curve.depth, curve.force]).tolist()
    return [
        [*_layer(curve.profile, curve.base, curve.nu), ratio, "exact", exponent, 0.0, factor, 0.0,
         *((None, None) if flat else (depth, force)), curve.profile.row, curve.thin]
        for ratio, exponent, factor, depth, force in columns
    ]  # fmt: skip


def _checked(check: Check) -> list[Any]:
    """A point by finite elements."""
    profile = check.profile
    numbers = check.exponent.value, check.exponent.error, check.factor.value, check.factor.error
    limits = profile.row, profile.thin(check.base, check.nu)
    return [*_layer(profile, check.base, check.nu), check.ratio, "fe", *numbers, None, None, *limits]


def _layer(profile: Profile, base: str, nu: float | None) -> list[Any]:
    return [profile.name, profile.n, base, nu]


def _described(curve: ExponentCurve) -> dict[str, Any]:
    return {
        "shape": curve.profile.name,
        "profile_exponent": curve.profile.n,
        "base": curve.base,
        "nu": curve.nu,
        "row_exponent": curve.profile.row,
        "thin_exponent": curve.thin,
        "exponent": [float(curve.exponent[0]), float(curve.exponent[-1])],
        "a_over_h": [float(curve.ratio[0]), float(curve.ratio[-1])],
        "D_over_row": [float(curve.factor[0]), float(curve.factor[-1])],
    }
