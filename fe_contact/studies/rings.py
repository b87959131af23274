"""What rings really do, against the paper: pressed slowly, F = (pi/4) E* l depth (27)-(29), and struck, (30)-(32).

With a constant Poisson's ratio the force over E* is the same against a slow and a sudden indentation: one verdict for
both. The paper's ring is struck by both masses of its damper, at speeds at which the row would sink in by a small share
of the thickness: a linear law has one contact time and one restitution for all speeds, a ring has not. Beside it, what
of the answer rests on a constant Poisson's ratio: the same ring with a constant bulk modulus.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.reference import fe
from fe_contact.studies import journal
from fe_contact.studies.files import Line, lines_of, write_study
from fe_contact.studies.finite_exponents import SHARES, StrainedRow, local_exponent, zero_after
from lumped.indentation import Indentation
from lumped.materials import Material, Relaxation
from lumped.materials.networks import sls
from lumped.paper.given import Examples
from lumped.paper.ring_impacts import RingImpact, impact, stiffness
from lumped.result.result import LedgerEntry, Quantity, Result
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.shapes.cylinder import Cylinder
from lumped.targets.o_ring import ORing
from lumped.targets.ring import Ring
from lumped.targets.washer import Washer

SCHEMA = "fe-contact/ring/1"
SETTINGS, STRUCK_SETTINGS = {"tolerance": 3e-4}, {"tolerance": 1e-3}  # tolerances of indentations and of impacts
STRAINS = tuple(float(strain) for strain in np.geomspace(1e-3, 0.3, 13))  # depth over what is pressed
SMALL_STRAIN = 0.05  # beyond, linear theory is no more than an indication
STRUCK_STRAINS = (0.2 * SMALL_STRAIN, SMALL_STRAIN)  # depth by the row over the thickness
JUDGED = ("peak_depth", "duration", "restitution")  # of an impact
TOLD = ("peak_force", *JUDGED)
HOLDS = 0.01  # of the force: a row this near to it holds
KEPT = "ring.jsonl"
PAPER = "paper-ring"
PACKAGED = ("rod-in-ring", "polymer-o-ring", "polymer-washer")


@dataclass(frozen=True)
class RingCase:
    """A ring and what presses it; ``length`` l of the paper's row and ``height`` of what is pressed, m."""

    name: str
    indenter: Indenter
    length: float
    height: float


@dataclass(frozen=True, eq=False)
class RingCurve:
    """Force over E* l depth in units of pi/4, 1 where the row holds, and its bar; local exponent between neighbours
    and its bar, 1 by the row; each (n,). ``ledger``: what the model leaves out.
    """

    case: RingCase
    found: Indentation
    factor: Array
    factor_error: Array
    exponent: Array
    exponent_error: Array
    ledger: tuple[LedgerEntry, ...]

    @property
    def strain(self) -> Array:
        """Depth over the height of what is pressed."""
        return self.found.depth / self.case.height

    @property
    def row_force(self) -> Array:
        """(pi/4) E* l depth, N: "(27)" with the relaxed modulus of "(29)"."""
        return 0.25 * math.pi * self.found.modulus * self.case.length * self.found.depth


def cases() -> tuple[RingCase, ...]:
    """The packaged rings, and the paper's: its rod and gap, one for each thickness that may be meant."""
    paper = Examples.load()
    material = Material(sls.of_ratios(E0=paper.ring.E0, R1=paper.ring.R1, R2=paper.ring.R2), paper.ring.nu)
    radius = 0.5 * paper.ring.rod_diameter
    rod, inner = Cylinder(radius, paper.ring.width), radius + paper.ptmd.gap
    own = [
        Indenter(rod, material, Ring(inner, thickness), name=f"{PAPER}-{1e3 * thickness:g}mm")
        for thickness in paper.ring.thickness
    ]
    return tuple(_case(one) for one in (*map(Indenter.load, PACKAGED), *own))


def _case(indenter: Indenter) -> RingCase:
    """The row's length l along which a ring is touched."""
    target, shape = indenter.target, indenter.shape
    if isinstance(target, Ring) and isinstance(shape, Cylinder):
        return RingCase(indenter.name, indenter, shape.length, target.thickness)
    if isinstance(target, ORing):
        return RingCase(indenter.name, indenter, 2.0 * math.pi * target.mean_radius, 2.0 * target.section_radius)
    assert isinstance(target, Washer)
    pressed = target.fixed_radius(shape) or target.outer_radius
    return RingCase(indenter.name, indenter, math.pi * (target.inner_radius + pressed), target.height)


def finite_rows() -> tuple[StrainedRow, ...]:
    """Every case, its relaxed rubber, as large strains try it, against "(27)"."""
    return tuple(
        StrainedRow(
            case.name,
            case.indenter,
            tuple(share * case.height for share in SHARES),
            0.25 * math.pi * case.indenter.modulus(False) * case.length,
            1.0,
            case.indenter.shape.tip_radius,
            case.height,
        )
        for case in cases()
    )


def rings(chosen: Sequence[RingCase], where: Path, progress: Progress = silent, jobs: int = 1) -> tuple[RingCurve, ...]:
    """Every case over three decades of depth, by so many processes; rows are kept in the folder `where`.

    Raises NotReached.
    """
    calls = {
        case.name: partial(indent, case.indenter, tuple(case.height * strain for strain in STRAINS), SETTINGS)
        for case in chosen
    }
    found = journal.rows(where / KEPT, calls, progress, jobs)
    return tuple(curve(case, found[case.name]) for case in chosen)


def curve(case: RingCase, found: Indentation) -> RingCurve:
    """What an indentation by finite elements says of the row."""
    relative = found.force_error / found.force
    factor = found.force / (0.25 * math.pi * found.modulus * case.length * found.depth)
    exponent, exponent_error = local_exponent(found.depth, found.force, relative)
    return RingCurve(case, found, factor, relative * factor, exponent, exponent_error, found.model_ledger)


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
    return float(np.exp(zero_after(x, y, int(passed[0])))) if passed.size else None


@dataclass(frozen=True, eq=False)
class RingStruck:
    """One impact of a mass, kg, at a velocity, m/s, that by the row reaches a strain: the law's and the ring's answer.

    ``spring``: the law's K(t), N/m. ``bulk``: of the ring whose bulk modulus, not its Poisson's ratio, is constant.
    """

    ring: str
    strain: float
    mass: float
    velocity: float
    spring: Relaxation
    row: RingImpact
    found: Result
    bulk: Result

    def by_row(self, name: str) -> float:
        """A judged quantity by (30)-(32): m, s, 1."""
        depth = self.velocity * self.row.depth_per_velocity
        return {"peak_depth": depth, "duration": self.row.duration, "restitution": self.row.restitution}[name]

    def deviation(self, name: str) -> tuple[float, float]:
        """Row over ring less one, of restitution the difference; and its bar."""
        value, bar = _known(self.found.quantities[name])
        if name == "restitution":
            return self.by_row(name) - value, bar
        return self.by_row(name) / value - 1.0, bar / value

    def of_bulk(self, name: str) -> tuple[float, float]:
        """What a quantity changes by with a constant bulk modulus, as :meth:`deviation`; and its bar."""
        (value, bar), (other, its_bar) = _known(self.found.quantities[name]), _known(self.bulk.quantities[name])
        scale = 1.0 if name == "restitution" else value
        return (other - value) / scale, (bar + its_bar) / scale

    @property
    def holds(self) -> bool:
        """Whether the law is within a per cent, or the bar, of the ring in everything."""
        return all(abs(off) <= HOLDS + bar for off, bar in map(self.deviation, JUDGED))

    @property
    def verdict(self) -> str:
        """In a line."""
        found = ((name, *self.deviation(name)) for name in JUDGED)
        parts = [f"{name} {100 * off:+.2g} +- {100 * bar:.1g} %" for name, off, bar in found]
        return f"{'holds' if self.holds else 'wrong'}: by the law {', '.join(parts)}"


def struck(cases: Sequence[RingCase], where: Path, progress: Progress = silent) -> tuple[RingStruck, ...]:
    """The paper's ring for each of its thicknesses and two speeds; impacts are kept in the folder `where`.

    Raises NotReached.
    """
    own = [case for case in cases if case.name.startswith(PAPER)]
    return tuple(_struck(case, strain, where, progress) for case in own for strain in STRUCK_STRAINS)


def _struck(case: RingCase, strain: float, where: Path, progress: Progress = silent) -> RingStruck:
    """At the speed that by the row reaches a strain."""
    paper, indenter = Examples.load(), case.indenter
    mass = paper.ptmd.m1 * paper.ptmd.m2 / (paper.ptmd.m1 + paper.ptmd.m2)
    spring = stiffness(paper.ring, indenter.material.nu)
    row = impact(spring, mass)
    velocity = strain * case.height / row.depth_per_velocity
    scene = Scene(indenter.shape, mass, velocity, indenter.material, target=indenter.target, name=case.name)
    other = replace(scene, material=replace(indenter.material, constant="bulk"))
    told = f"{case.name}, struck at {1e3 * velocity:.3g} mm/s"
    calls = {
        told: partial(fe, scene, STRUCK_SETTINGS),
        f"{told}, constant bulk modulus": partial(fe, other, STRUCK_SETTINGS),
    }
    known = journal.rows(where / KEPT, calls, progress)
    return RingStruck(case.name, strain, mass, velocity, spring, row, *known.values())


def _known(quantity: Quantity) -> tuple[float, float]:
    """Value and bar of what separates."""
    assert quantity.value is not None
    assert quantity.error is not None
    return quantity.value, quantity.error


def write_rings(curves: Sequence[RingCurve], where: Path, impacts: Sequence[RingStruck]) -> Table:
    """Write ``ring.csv``, ``ring_impacts.csv`` and ``ring.json`` into a folder; the content of the last."""
    tables: dict[str, list[Line]] = {
        "ring": [line for curve in curves for line in _depths(curve)],
        "ring_impacts": [_impact(one) for one in impacts],
    }
    content = {"schema": SCHEMA, "rings": [_described(one) for one in curves], "impacts": tables["ring_impacts"]}
    return write_study(where, "ring", content, tables)


def _depths(curve: RingCurve) -> list[Line]:
    """A line a depth."""
    found, row = curve.found, curve.row_force
    return lines_of(
        {
            "ring": curve.case.name,
            "depth_m": found.depth,
            "strain": curve.strain,
            "force_N": found.force,
            "force_error_N": found.force_error,
            "contact_radius_m": found.contact_radius,
            "row_force_N": row,
            "row_deviation": row / found.force - 1.0,
            "factor": curve.factor,
            "factor_error": curve.factor_error,
            "exponent": curve.exponent,
            "exponent_error": curve.exponent_error,
            "beyond_small_strain": curve.strain > SMALL_STRAIN,
        }
    )


def _described(curve: RingCurve) -> Table:
    indenter = curve.case.indenter
    return {
        "ring": curve.case.name,
        "scene": indenter.to_dict(),
        "length": curve.case.length,
        "contact_modulus": curve.found.modulus,
        "instantaneous_modulus": indenter.modulus(True),
        "converged": curve.found.converged,
        "verdict": verdict(curve),
        "model_ledger": [entry.to_json(curve.found.tolerance) for entry in curve.ledger],
        "error_budget": {cause: float(np.max(error)) for cause, error in curve.found.budget.items()},
    }


def _impact(one: RingStruck) -> Table:
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


def told(curves: Sequence[RingCurve], impacts: Sequence[RingStruck]) -> list[str]:
    """Of a ring the verdict, then every depth; of an impact the verdict, and what a constant bulk modulus changes."""
    return [line for curve in curves for line in _said(curve)] + [line for one in impacts for line in _struck_said(one)]


def missed(curves: Sequence[RingCurve], impacts: Sequence[RingStruck]) -> str:
    """Where finite elements missed their tolerance; empty where nowhere."""
    names = [curve.case.name for curve in curves if not curve.found.converged]
    names += [one.ring for one in impacts if not (one.found.converged and one.bulk.converged)]
    return f"tolerance not reached: {', '.join(names)}" if names else ""


def _said(curve: RingCurve) -> list[str]:
    judged, found = verdict(curve), curve.found
    lines = [f"{curve.case.name}: (27)-(29) {judged.word}: {judged.sentence}"]
    lines += [f"    {one.effect} ({one.treated}): {one.estimate or 0.0:.2g}, {one.note}" for one in curve.ledger]
    table = zip(
        found.depth, found.force, found.force_error, curve.row_force, curve.exponent, curve.exponent_error, strict=True
    )
    return lines + [
        f"    {1e3 * depth:.3g} mm  {force:.5g} +- {error:.1e} N, row {row:.5g} N; alpha {alpha:.4g} +- {bar:.0e}"
        for depth, force, error, row, alpha, bar in table
    ]


def _struck_said(one: RingStruck) -> list[str]:
    changes = ((name, *one.of_bulk(name)) for name in TOLD)
    bulk = ", ".join(f"{name} {100 * change:+.2g} +- {100 * bar:.1g} %" for name, change, bar in changes)
    return [
        f"{one.ring} struck at {1e3 * one.velocity:.3g} mm/s: (30)-(32) {one.verdict}",
        f"    constant bulk modulus instead of constant nu: {bulk}",
    ]
