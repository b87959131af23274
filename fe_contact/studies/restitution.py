"""Restitution asked for against obtained, for every law, its exact damping and every published one, at both exits.

What ``fe-contact restitution`` writes: a row an impact as CSV, a line a formula as JSON.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from fe_contact.studies.files import write_study
from lumped import laws, restitution
from lumped.errors import BadInput
from lumped.laws._force_law import between_masses
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice, Motion
from lumped.schema import Table
from lumped.schema.keys import Choice

ASKED = (0.01, *(round(0.05 * i, 2) for i in range(1, 20)), 0.99, 0.999)  # restitutions of the table
EXITS = ("force", "depth")
TOLERANCE = 1e-7  # of each impact
# The restitution does not depend on mass, stiffness and velocity when it is what the law is given.
UNIT, LATEST = 1.0, 1e12
SCHEMA = "fe-contact/restitution/1"


class RestitutionLine(NamedTuple):
    """One law, damping formula and exit: restitution obtained, None where the formula or the law gives none."""

    law: str
    damping: str
    exit: str
    asked: tuple[float, ...]
    obtained: tuple[float | None, ...]

    @property
    def worst(self) -> tuple[float, float] | None:
        """The largest difference, obtained less asked, and at which e; None where nothing was obtained."""
        pairs = [(got - e, e) for e, got in zip(self.asked, self.obtained, strict=True) if got is not None]
        return max(pairs, key=lambda pair: abs(pair[0])) if pairs else None

    @property
    def told(self) -> str:
        """One line for a person."""
        worst = self.worst
        off = "nothing obtained" if worst is None else f"{worst[0]:+.1e} at most, at e = {worst[1]:g}"
        return f"{self.law:16s} {self.damping:20s} exit {self.exit:6s} {off}"


def table(asked: Sequence[float] = ASKED) -> tuple[RestitutionLine, ...]:
    """A line for every law that takes e, each of its formulas and either exit, found by simulation.

    `asked`: from 1e-4 to 1. Raises BadInput, NotReached.
    """
    return tuple(
        RestitutionLine(name, formula, exit, tuple(asked), tuple(obtained(name, formula, exit, e) for e in asked))
        for name, formula in formulas()
        for exit in EXITS
    )


def formulas() -> Iterator[tuple[str, str]]:
    """Every law that takes e, with the names of its formulas, the exact one first."""
    for name in laws.available():
        keys = laws.get(name).keys
        if "e" in keys:
            choice = keys["damping"].kind if "damping" in keys else None
            options = choice.options if isinstance(choice, Choice) else (restitution.EXACT,)
            yield from ((name, formula) for formula in options)


def obtained(name: str, formula: str, exit: str, e: float) -> float | None:
    """The restitution of one simulated impact; None where the formula has no damping for e. Raises NotReached."""
    chosen = {} if formula == restitution.EXACT else {"damping": formula}
    law = LawChoice(name, {"k": UNIT, "e": e, "exit": exit, **chosen})
    scene = Scene(None, UNIT, UNIT, law=law, motion=Motion(end_time=LATEST))
    try:
        model = between_masses(name, scene)
    except BadInput:
        return None
    return model.outcome(scene, TOLERANCE).restitution


def write_restitution(lines: Sequence[RestitutionLine], where: Path) -> Table:
    """Write ``restitution.csv`` and ``restitution.json`` into a folder; the content of the latter."""
    rows = [
        {
            "law": line.law,
            "damping": line.damping,
            "exit": line.exit,
            "asked": e,
            "obtained": got,
            "difference": None if got is None else got - e,
        }
        for line in lines
        for e, got in zip(line.asked, line.obtained, strict=True)
    ]
    worst = [line.worst and dict(zip(("difference", "asked"), line.worst, strict=True)) for line in lines]
    described = [{**line._asdict(), "worst": one} for line, one in zip(lines, worst, strict=True)]
    return write_study(where, "restitution", {"schema": SCHEMA, "lines": described}, {"restitution": rows})
