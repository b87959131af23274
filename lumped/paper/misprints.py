"""Misprints and contradictions of the paper, `data/paper/misprints.csv`: printed, correct, why, and the numbers."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.paper import recompute, table
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Values

COLUMNS = ("number", "place", "printed", "correct", "proof", "kind", "recompute", "recomputed_as")


@dataclass(frozen=True)
class Misprint:
    """One of them; `recompute` names what computes the numbers `recomputed_as`, empty where there are none."""

    number: int
    place: str
    printed: str
    correct: str
    proof: str
    kind: str
    recompute: str
    recomputed_as: str

    def values(self, examples: Examples) -> Values:
        """Its numbers. Raises BadInput and NotReached."""
        return recompute.get(self.recompute)(examples) if self.recompute else ()


def load() -> tuple[Misprint, ...]:
    """The packaged list. Raises BadInput."""
    cells = table.rows("misprints.csv", COLUMNS)
    return tuple(Misprint(int(row["number"]), *(row[name] for name in COLUMNS[1:])) for row in cells)
