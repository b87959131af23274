"""Points on the exponents' curves by finite elements, with bars, beside the exact ones.

What ``fe-contact exponents`` writes: a line a point as CSV, a line a curve as JSON, and the finite spheres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.exponents.finite_spheres import Pair
from fe_contact.studies.exponents.study import KEPT, PROFILES, SMALL, ExponentCurve, Profile, named
from lumped.load_curves.layer import LayerPunch, PointLayer
from lumped.materials import Material, Relaxation
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json
from lumped.shapes.punch import Punch
from lumped.targets.layer import Layer

AROUND = (1.15**-2, 1.15**-1, 1.0, 1.15, 1.15**2)  # depths over that of a place: two chords, one twice as long
MIDDLE = 2
TOLERANCE = 3e-4
ANY = 0.3  # nu on a sliding base, where it does not count
TRIED = (0.1, 1.0, 5.0)
PLACES = {("bonded", 0.3): TRIED, ("bonded", 0.49): TRIED[1:], ("sliding", None): TRIED[1:2]}
QUICK_PLACES = {("bonded", 0.3): TRIED[1:2]}
SCHEMA = "fe-contact/exponents/1"
COLUMNS = (
    "shape", "profile_exponent", "base", "nu", "a_over_h", "method", "exponent", "exponent_error", "D_over_row",
    "D_over_row_error", "depth_over_height", "force_over_height", "row_exponent", "thin_exponent",
)  # fmt: skip
SPHERE_COLUMNS = ("support", "nu", "a_over_R", "F_over_Hertz_minus_1", "error")


@dataclass(frozen=True)
class Check:
    """One point: local `exponent` d ln F/d ln depth and `factor`, with bars; the exact ones beside."""

    profile: Profile
    base: str
    nu: float | None
    ratio: float
    exponent: Quantity
    factor: Quantity
    exact_exponent: float
    exact_factor: float
    converged: bool

    @property
    def covered(self) -> bool:
        """Whether both bars reach the exact values."""
        pairs = ((self.exponent, self.exact_exponent), (self.factor, self.exact_factor))
        return all(abs((one.value or 0.0) - exact) <= (one.error or 0.0) + 1e-9 for one, exact in pairs)


def checks(quick: bool, where: Path, progress: Progress = silent) -> tuple[Check, ...]:
    """Every named profile at a few places; rows are kept in the folder `where`. Raises NotReached."""
    calls = {
        f"{profile.label}, {named(base, nu)}, FE at a/h = {ratio:g}": partial(check, profile, base, nu, ratio)
        for profile in PROFILES
        if profile.name != "power" or (profile.n == 4.0 and not quick)
        for (base, nu), tried in (QUICK_PLACES if quick else PLACES).items()
        for ratio in tried
    }
    return tuple(journal.rows(where / KEPT, calls, progress).values())


def check(profile: Profile, base: str, nu: float | None, ratio: float) -> Check:
    """One point; raises NotReached."""
    layer = PointLayer(1.0, ANY if nu is None else nu, base)
    depth, force, exponent = _exact(profile, layer, ratio)
    around = depth * np.array(AROUND)
    shape = Punch(ratio) if np.isinf(profile.n) else profile.shape
    material, model = Material(Relaxation(1.0), layer.nu), Model(profile="parabola")
    scene = Indenter(shape, material, target=Layer(1.0, base), model=model)
    found = indent(scene, tuple(around.tolist()), {"tolerance": TOLERANCE})
    relative, level = found.force_error / found.force, found.force / found.modulus
    row = (2.0 * ratio if np.isinf(profile.n) else profile.factor) * depth**profile.row
    return Check(
        profile,
        base,
        nu,
        ratio,
        exponent=_local(np.log(around), np.log(level), relative),
        factor=Quantity(float(level[MIDDLE] / row), float(relative[MIDDLE] * level[MIDDLE] / row), "1"),
        exact_exponent=exponent,
        exact_factor=force / row,
        converged=found.converged,
    )


def _local(depth: Array, force: Array, error: Array) -> Quantity:
    """The slope in the middle of five logarithms, by both chords, whose difference counts in the bar."""
    slopes, errors = np.empty(2), np.empty(2)
    for i in range(2):  # the long one, the short one
        span = depth[-1 - i] - depth[i]
        slopes[i], errors[i] = (force[-1 - i] - force[i]) / span, (error[i] + error[-1 - i]) / span
    bent = (slopes[1] - slopes[0]) / 3.0
    return Quantity(float(slopes[1] + bent), float((4.0 * errors[1] + errors[0]) / 3.0 + abs(bent)), "1")


def _exact(profile: Profile, layer: PointLayer, ratio: float) -> tuple[float, float, float]:
    """The depth with this contact radius, in thicknesses, the force there over E*, and the local exponent."""
    if np.isinf(profile.n):
        return SMALL, float(LayerPunch(ratio, layer).stiffness) * SMALL, 1.0
    here = profile.on(layer).at(np.asarray(ratio))
    return float(here.depth), float(here.force), float(here.stiffness * here.depth / here.force)


def write_exponents(
    curves: Sequence[ExponentCurve], checks: Sequence[Check], pairs: Sequence[Pair], where: Path
) -> Table:
    """Write ``exponents.csv``, ``finite_spheres.csv`` and ``exponents.json`` into a folder; the content of the last."""
    where.mkdir(parents=True, exist_ok=True)
    rows = [line for curve in curves for line in _points(curve)] + [_checked(check) for check in checks]
    write_csv(where / "exponents.csv", COLUMNS, rows)
    write_csv(where / "finite_spheres.csv", SPHERE_COLUMNS, [line for pair in pairs for line in pair.rows()])
    content: Table = plain(
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


def _points(curve: ExponentCurve) -> list[list[object]]:
    """Exact points; a depth under the flat end says nothing."""
    flat = np.isinf(curve.profile.n)
    columns = np.column_stack([curve.ratio, curve.exponent, curve.factor, curve.depth, curve.force]).tolist()
    return [
        [*_layer(curve.profile, curve.base, curve.nu), ratio, "exact", exponent, 0.0, factor, 0.0,
         *((None, None) if flat else (depth, force)), curve.profile.row, curve.thin]
        for ratio, exponent, factor, depth, force in columns
    ]  # fmt: skip


def _checked(check: Check) -> list[object]:
    """A point by finite elements."""
    profile = check.profile
    numbers = check.exponent.value, check.exponent.error, check.factor.value, check.factor.error
    limits = profile.row, profile.thin(check.base, check.nu)
    return [*_layer(profile, check.base, check.nu), check.ratio, "fe", *numbers, None, None, *limits]


def _layer(profile: Profile, base: str, nu: float | None) -> list[object]:
    return [profile.name, profile.n, base, nu]


def _described(curve: ExponentCurve) -> Table:
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
