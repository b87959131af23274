"""The whole study of exponents: its rows, kept one by one, its files, and what it did not reach.

And how far two equal spheres of their true size are from Hertz's half-spaces: F/F_Hertz - 1 goes as a/R.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.exponents.impacts import ImpactExponents, impacts, sentences, to_dict
from fe_contact.studies.exponents.layers import KEPT, TOLERANCE, Check, ExponentCurve, checks, curves
from fe_contact.studies.files import Line, lines_of, write_study
from lumped.indentation import FiniteSize
from lumped.materials import Material, Relaxation
from lumped.scene.indenter import Indenter
from lumped.schema import Table
from lumped.shapes.sphere import Sphere
from lumped.targets._round import SUPPORTS
from lumped.targets.sphere import SphereTarget

SCHEMA = "fe-contact/exponents/1"
RATIOS, FEW_RATIOS = (0.0, 0.3, 0.49), (0.3,)  # Poisson's ratios of two spheres, in full and quick
SHARES = np.geomspace(0.01, 0.1, 7)  # a/R of two spheres


@dataclass(frozen=True, eq=False)
class Pair:
    """Two equal spheres, the struck one `support`-ed; `size`: how far their force is from Hertz's over a/R."""

    support: str
    nu: float
    size: FiniteSize
    converged: bool

    def to_dict(self) -> Table:
        """Its part of exponents.json."""
        return {"support": self.support, "nu": self.nu, "converged": self.converged, **self.size.to_dict()}

    @property
    def lines(self) -> list[Line]:
        """Its lines of finite_spheres.csv."""
        size = self.size
        numbers = {"a_over_R": size.share, "F_over_Hertz_minus_1": size.deviation, "error": size.error}
        return lines_of({"support": self.support, "nu": self.nu, **numbers})

    @property
    def told(self) -> str:
        """One line for a person."""
        slope, terms = self.size.slope, self.size.terms
        formula = f"{terms['c'].value:.4f} {terms['k'].value:+.4f} ln x {terms['d'].value:+.4f} x"
        return (
            f"two spheres, {self.support}, nu = {self.nu:g}: F/F_Hertz - 1 = x ({formula}), x = a/R; "
            f"slope {slope.value:.3f} +- {slope.error:.3f} up to x = {self.size.share.max():.2g}"
        )


def pairs(quick: bool, where: Path, progress: Progress = silent, jobs: int = 1) -> tuple[Pair, ...]:
    """Both supports with each nu; rows are kept in the folder `where`. Raises NotReached."""
    calls = {
        f"finite spheres, {support}, nu = {nu:g}": partial(pair, support, nu)
        for support in SUPPORTS
        for nu in (FEW_RATIOS if quick else RATIOS)
    }
    return tuple(journal.rows(where / KEPT, calls, progress, jobs).values())


def pair(support: str, nu: float) -> Pair:
    """Two unit spheres of one material at contact radii `SHARES`; raises NotReached."""
    alike = Material(Relaxation(1.0), nu)
    scene = Indenter(Sphere(1.0), alike, target=SphereTarget(1.0, support), striker_material=alike)
    found = indent(scene, tuple(map(float, 2.0 * SHARES**2)), {"tolerance": TOLERANCE})
    assert found.finite_size is not None
    return Pair(support, nu, found.finite_size, found.converged)


@dataclass(frozen=True)
class Exponents:
    """All rows: slow contact on layers, finite spheres, and what is read from impacts."""

    curves: tuple[ExponentCurve, ...]
    checks: tuple[Check, ...]
    pairs: tuple[Pair, ...]
    impacts: tuple[ImpactExponents, ...]

    @property
    def told(self) -> list[str]:
        """Lines for a person."""
        return [
            *(one.told for part in (self.curves, self.checks, self.pairs) for one in part),
            *sentences(self.impacts),
        ]

    @property
    def missed(self) -> str:
        """How often finite elements missed their tolerance; empty where never."""
        reached = [one.converged for part in (self.checks, self.pairs, self.impacts) for one in part]
        count = reached.count(False)
        return f"tolerance not reached at {count} of {len(reached)} places" if count else ""

    def write(self, where: Path) -> Table:
        """Write ``exponents.csv``, ``finite_spheres.csv``, ``exponents_from_impacts.csv`` and ``exponents.json`` into
        a folder; the content of the last.
        """
        content = {
            "schema": SCHEMA,
            "curves": [curve.to_dict() for curve in self.curves],
            "checks": [asdict(check) | {"covered": check.covered} for check in self.checks],
            "finite_spheres": [pair.to_dict() for pair in self.pairs],
            "all_covered": all(check.covered for check in self.checks),
            "from_impacts": to_dict(self.impacts),
        }
        tables = {
            "exponents": [line for curve in self.curves for line in curve.lines] + [one.line for one in self.checks],
            "finite_spheres": [line for pair in self.pairs for line in pair.lines],
            "exponents_from_impacts": [line for impact in self.impacts for line in impact.lines],
        }
        return write_study(where, "exponents", content, tables)


def study(quick: bool, where: Path, progress: Progress = silent, jobs: int = 1) -> Exponents:
    """Every row, finite elements by so many processes; rows are kept in the folder `where`. Raises NotReached."""
    return Exponents(
        curves(quick, where, progress),
        checks(quick, where, progress, jobs),
        pairs(quick, where, progress, jobs),
        impacts(quick, where, progress, jobs),
    )
