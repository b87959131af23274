"""The whole study of exponents: its rows, kept one by one, its files, and what it did not reach."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from fe_contact.progress import Progress, silent
from fe_contact.studies.exponents.impacts import ImpactExponents, impacts, sentences, to_dict
from fe_contact.studies.exponents.layers import Check, ExponentCurve, checks, curves
from fe_contact.studies.exponents.spheres import Pair, pairs
from fe_contact.studies.files import write_study
from lumped.schema import Table

SCHEMA = "fe-contact/exponents/1"


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
