"""Slow indentation: force and contact radius over depth, and the power law through them; by a load curve, exact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, Clock
from lumped.result.folder import RECORD, publish
from lumped.result.model_ledger import Peak, ledger_at_rest
from lumped.result.result import LedgerEntry, Quantity, good_to, groups_at_rest, provenance, sufficient
from lumped.scene.indenter import Indenter
from lumped.schema import Table
from lumped.schema.csv_file import write_columns
from lumped.schema.json_file import plain, write_json
from lumped.schema.shown import Picture, curves, html_table
from lumped.targets.sphere import SphereTarget

SCHEMA = "fe-contact/indentation/1"
COLUMNS = ("depth_m", "force_N", "contact_radius_m", "force_error_N")
FEWEST = 3  # depths which a power law with an error bar needs
HALF_SPACE_ALONE = ("mdr", "hertz")
TERMS = ("c", "k", "d")  # of the deviation of finite spheres


@dataclass(frozen=True, eq=False)
class FiniteSize:
    """How far the contact of finite spheres lies from Hertz's, which knows two half-spaces alone.

    With x = a/R, a the contact radius of the half-spaces at the same depth and R the target's radius,

        F / F_Hertz - 1 = x (c + k ln x + d x) + ... .

    It goes as a/R but for a logarithm, that of a point load on a sphere beside the half-space's 1/r, which vanishes
    where the spheres are incompressible.
    ``share`` x = a/R, ``deviation`` F / F_Hertz - 1 and its half-width ``error``; each (n,), with n >= 3.
    """

    share: Array
    deviation: Array
    error: Array

    @property
    def slope(self) -> Quantity:
        """Deviation over a/R: the middle of what is found at these depths; the bar holds all of it, bars included."""
        slope, bar = self.deviation / self.share, self.error / self.share
        low, high = float((slope - bar).min()), float((slope + bar).max())
        return Quantity(0.5 * (low + high), 0.5 * (high - low), "1")

    @cached_property
    def terms(self) -> dict[str, Quantity]:
        """c, k and d by least squares of deviation/x; bars whatever the signs of the errors, without what follows d."""
        columns = np.stack([np.ones_like(self.share), np.log(self.share), self.share], axis=1)
        weights = np.linalg.pinv(columns)
        values, bars = weights @ (self.deviation / self.share), np.abs(weights) @ (self.error / self.share)
        return {
            name: Quantity(float(value), float(bar), "1") for name, value, bar in zip(TERMS, values, bars, strict=True)
        }

    def to_dict(self) -> Table:
        """Its part of result.json."""
        return {
            "a/R": self.share.tolist(),
            "F/F_Hertz-1": self.deviation.tolist(),
            "error": self.error.tolist(),
            "slope": asdict(self.slope),
            "terms": {name: asdict(term) for name, term in self.terms.items()},
        }


def finite_size(indenter: Indenter, depth: Array, force: Array, error: Array) -> FiniteSize | None:
    """Of force over modulus, m^2, with its half-width, at depths, m; each (n,). None for all but finite spheres."""
    target = indenter.target
    if not isinstance(target, SphereTarget) or target.support is None:
        return None
    curve = SphereTarget(target.radius, None).load_curve(indenter.profile, indenter.material.nu)
    hertz, share = np.asarray(curve.force(depth)), np.asarray(curve.contact_radius(depth)) / target.radius
    return FiniteSize(share, force / hertz - 1.0, error / hertz)


@dataclass(frozen=True, eq=False)
class Indentation:
    """Force, N, contact radius, m, and half-width of the force's bar, N, at every asked depth, m; shape (n,).

    `modulus` is the E* of the material at this speed, Pa; `budget` the relative error of the force by cause, (n,).
    """

    indenter: Indenter
    method: str
    modulus: float
    tolerance: float
    depth: Array
    force: Array
    contact_radius: Array
    force_error: Array
    budget: Mapping[str, Array] = field(default_factory=dict)
    numerics: Table = field(default_factory=dict)
    timing: Mapping[str, float] = field(default_factory=dict)
    work: Mapping[str, int] = field(default_factory=dict)
    ruled_force: ClassVar[str] = "force"  # to which the ledger's estimates are relative: none peaks here

    @property
    def converged(self) -> bool:
        """Whether every bar lies within the tolerance."""
        return bool(np.all(self.force_error <= self.tolerance * self.force))

    @property
    def message(self) -> str:
        """What was missed."""
        if self.converged:
            return ""
        return f"tolerance {self.tolerance:g} not reached: force to {np.max(self.force_error / self.force):.2g}"

    @property
    def model_ledger(self) -> tuple[LedgerEntry, ...]:
        """What the model leaves out, at the largest depth."""
        deepest = int(self.depth.argmax())
        force, depth, radius = (float(row[deepest]) for row in (self.force, self.depth, self.contact_radius))
        return ledger_at_rest(self.indenter, Peak(force, depth, radius, math.inf))

    @property
    def model_sufficient(self) -> bool:
        """Whether no known estimate of the model ledger exceeds the tolerance."""
        return sufficient(self.model_ledger, self.tolerance)

    @property
    def quantities(self) -> dict[str, Quantity]:
        """`alpha`, `D`, and `D_at_alpha` with the exponent of Table 1's row held; from three depths on."""
        row = self.indenter.shape.exponent_of_force
        if np.unique(self.depth).size < FEWEST:
            return {}
        return power_law(self.depth, self.force / self.modulus, self.force_error / self.force, row)

    @property
    def finite_size(self) -> FiniteSize | None:
        """How far finite spheres are from Hertz; from three depths on, None before and for all else."""
        if np.unique(self.depth).size < FEWEST:
            return None
        return finite_size(self.indenter, self.depth, self.force / self.modulus, self.force_error / self.modulus)

    def __repr__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        table = zip(self.depth, self.force, self.force_error, strict=True)
        rows = [(f"{depth:.6g} m", f"{force:.6g} +- {error:.1e} N") for depth, force, error in table]
        return html_table(("depth", "force"), [*rows, *self.quantities.items()]) + self.plot().svg

    def plot(self) -> Picture:
        """Force, N, over depth, m, as a notebook shows it or ``.write("force.svg")``."""
        order = np.argsort(self.depth)
        return curves({"force": (self.depth[order], self.force[order])}, "depth, m", "force, N")

    def summary(self) -> str:
        """Depth and force, a line each, the power law through them, and what the model is good to."""
        lines = [f"{self.indenter.name}: {self.method}, tolerance {self.tolerance:g}"]
        table = zip(self.depth, self.force, self.force_error, strict=True)
        lines += [f"{depth:.6g} m  {force:.6g} +- {error:.1e} N" for depth, force, error in table]
        lines += [f"{name:11s} {quantity}" for name, quantity in self.quantities.items()]
        if self.finite_size is not None:
            lines.append(f"F/F_Hertz-1 {self.finite_size.slope} a/R")
        return "\n  ".join([*lines, *filter(None, [good_to(self.model_ledger, self.ruled_force)])])

    def to_json(self) -> Table:
        """The content of result.json."""
        content = {
            "schema": SCHEMA,
            "method": self.method,
            "converged": self.converged,
            "model_sufficient": self.model_sufficient,
            "tolerance": self.tolerance,
            "message": self.message,
            "scene": self.indenter.to_dict(),
            "model": self.indenter.model.resolved(self.indenter.material),
            "contact_modulus": self.modulus,
            "numerics": self.numerics,
            "quantities": {name: asdict(quantity) for name, quantity in self.quantities.items()},
            "deviation": self.finite_size and self.finite_size.to_dict(),
            "dimensionless": groups_at_rest(self.indenter.geometry, self.contact_radius),
            "error_budget": {cause: float(np.max(error)) for cause, error in self.budget.items()},
            "model_ledger": [entry.to_json(self.tolerance) for entry in self.model_ledger],
            "work": self.work,
            "provenance": provenance(),
            "timing": self.timing,
        }
        return dict(plain(content))

    def write(self, directory: str | Path) -> None:
        """Make indentation.csv and result.json the content of a folder of results.

        Raises CannotWrite; what was there stays then, see :mod:`lumped.result.folder`.
        """
        publish(Path(directory), self.write_files)

    def write_files(self, folder: Path) -> None:
        """The same files, one after the other, into a folder that is there."""
        columns = [self.depth, self.force, self.contact_radius, self.force_error]
        write_columns(folder / "indentation.csv", COLUMNS, columns)
        write_json(folder / RECORD, self.to_json())


def power_law(depth: Array, force: Array, error: Array, row: float) -> dict[str, Quantity]:
    """D and alpha of force = D depth^alpha by least squares of ln force on ln depth; `force` is F/E*, m^2.

    `error`: relative half-widths of the force, (n,); bars hold whatever the signs of the errors. `row`: the exponent
    held for D_at_alpha.
    """
    x, y = np.log(depth), np.log(force)
    centred = x - x.mean()
    slopes = centred / (centred @ centred)
    levels = 1.0 / x.size - x.mean() * slopes
    alpha, level, held = float(slopes @ y), float(levels @ y), float(np.mean(y - row * x))
    bar = -np.log1p(-np.minimum(error, 0.99))
    return {
        "alpha": Quantity(alpha, float(np.abs(slopes) @ bar), "1"),
        "D": _factor(level, float(np.abs(levels) @ bar), alpha),
        "D_at_alpha": _factor(held, float(bar.mean()), row),
    }


def _factor(logarithm: float, error: float, alpha: float) -> Quantity:
    """A geometry factor from its logarithm."""
    value = math.exp(logarithm)
    return Quantity(value, value * math.expm1(error), f"m^{round(2.0 - alpha, 4):g}")


def indent(
    indenter: Indenter, depths: tuple[float, ...], method: str, instant: bool = False, tolerance: float = 1e-3
) -> Indentation:
    """Force and contact radius at every depth, m, by the load curve of the profile; Hertz's is the parabola's.

    Raises BadInput for depths and materials that cannot be, NotReached where the load curve ends.
    """
    if method in HALF_SPACE_ALONE and indenter.target.has_length:
        reason = f"{method} knows the half-space alone; accepted: another method, or half_space without a datum"
        raise BadInput(Fault(indenter.source, "target.shape", reason))
    resolved = replace(indenter.model, kinematics="small", plasticity=False)
    clock, indenter = Clock(), replace(indenter, model=resolved)
    depth, modulus = np.array(indenter.checked(depths)), indenter.modulus(instant)
    shape = indenter.shape.resolved("parabola") if method == "hertz" else indenter.profile
    with indenter.addressed():
        curve = indenter.target.load_curve(shape, indenter.elastic(instant).material.nu)
        force = modulus * shape.total * np.asarray(curve.force(depth))
    return Indentation(
        indenter=indenter,
        method=method,
        modulus=modulus,
        tolerance=tolerance,
        depth=depth,
        force=force,
        contact_radius=np.asarray(curve.contact_radius(depth)),
        force_error=curve.accuracy * force,
        timing=clock.read(),
    )
