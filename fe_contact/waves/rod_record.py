"""The record of an impact on a rod, its bars by the same impact with half the steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.certify import CAUSES, SAFETY
from fe_contact.forms import Array
from fe_contact.numerics import Numerics
from fe_contact.plan import Plan
from fe_contact.reference import CURE
from fe_contact.waves.rod_reading import DENT, DEPTH, FORCE, TIME, VELOCITY, Reading
from lumped.history import LEAST_ROWS, History
from lumped.result import UNITS, Quantity, Result, meets, provenance, unmet
from lumped.scene import Scene

ROUNDING = 1e-9  # relative, of what adds up over the steps
COMPARED = 2001  # places along the contact at which two histories are compared
AWAY = 0.02  # share of the contact within which a change counts as the error of its neighbours


@dataclass(frozen=True, eq=False)
class Run:
    """One march: what was read off it, its energies, J, its steps and unknowns."""

    reading: Reading
    energy: Mapping[str, float]
    steps: int
    unknowns: int


def bars(fine: Reading, coarse: Reading) -> dict[str, Quantity]:
    """Quantities with SAFETY times what twice the steps change as bars: order one, as at the fronts."""
    found = {}
    for name, unit in UNITS.items():
        value, other = fine.quantities[name], coarse.quantities[name]
        error = None
        if name == "history_l2":
            error = SAFETY * _distance(fine, coarse)
        elif value is not None:
            error = np.inf if other is None else SAFETY * abs(value - other) + ROUNDING * abs(value)
        found[name] = Quantity(value, error, unit)
    return found


def _distance(fine: Reading, coarse: Reading) -> float:
    """Norm of the change of the force over that of the force."""
    force, change = _compared(fine, coarse)
    return float(np.sqrt(np.sum(change**2) / np.sum(force**2)))


def _compared(fine: Reading, coarse: Reading) -> tuple[Array, Array]:
    places = np.linspace(0.0, fine.rows[TIME, -1], COMPARED)
    force = fine.force_at(places)
    return force, np.abs(force - coarse.force_at(places))


def result_of(
    scene: Scene,
    chosen: Plan,
    numerics: Numerics,
    fine: Run,
    coarse: Run,
    quantities: dict[str, Quantity],
    timing: Mapping[str, float],
    runs: list[Run],
) -> Result:
    """The record of an impact and its variation."""
    peak = quantities["peak_force"].value or np.inf
    errors = {name: quantity.error or 0.0 for name, quantity in quantities.items()}
    # steps and elements are one, and nothing else errs
    by_quantity = {name: dict.fromkeys(CAUSES, 0.0) | {"time_step": error} for name, error in errors.items()}
    converged = meets(quantities, numerics.tolerance)
    return Result(
        method="fe",
        converged=converged,
        separated=fine.reading.separated,
        scene=scene,
        model=scene.model,
        tolerance=numerics.tolerance,
        history=history(scene, fine.reading, coarse.reading),
        quantities=quantities,
        numerics=numerics.as_dict(),
        error_budget={cause: value / peak for cause, value in by_quantity["peak_force"].items()},
        error_budget_by_quantity=by_quantity,
        model_ledger=chosen.ledger,
        energy=fine.energy,
        provenance=provenance(),
        timing=timing,
        work={
            "degrees_of_freedom": fine.unknowns,
            "marches": len(runs),
            "steps": sum(one.steps for one in runs),
        },
        message="" if converged else f"{unmet(quantities, numerics.tolerance)}; {CURE}",
    )


def history(scene: Scene, fine: Reading, coarse: Reading) -> History:
    """The rows, at least as many as a history has, with the force's error band: the largest change around a time."""
    rows = fine.rows
    if rows.shape[1] < LEAST_ROWS:
        between = np.linspace(rows[TIME, 0], rows[TIME, -1], LEAST_ROWS)[1:-1]
        more = np.array([np.interp(between, rows[TIME], row) for row in rows])
        rows = np.hstack([rows, more])[:, np.argsort(np.append(rows[TIME], between), kind="stable")]
    _, change = _compared(fine, coarse)
    width = int(AWAY * COMPARED)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(change, width, mode="edge"), 2 * width + 1).max(axis=1)
    error = SAFETY * np.interp(rows[TIME], np.linspace(0.0, rows[TIME, -1], COMPARED), around)
    flat, curve = scene.profile.fixed_radius, scene.profile.load_curve
    radius = np.full(rows.shape[1], flat) if flat is not None else curve.contact_radius(rows[DENT])
    return History(rows[TIME], rows[DEPTH], rows[VELOCITY], rows[FORCE], np.asarray(radius), error)
