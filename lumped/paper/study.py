"""The whole study of the paper: claims, assumptions, misprints, and the grids by the clipped and the exact law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lumped.paper import assumptions, claims, misprints
from lumped.paper.assumptions import JudgedAssumption
from lumped.paper.claims import JudgedClaim
from lumped.paper.examples.given import Examples
from lumped.paper.examples.steel_impacts import solid
from lumped.paper.examples.value import Values
from lumped.paper.misprints import Misprint
from lumped.result.result import Result

CLIPPED, EXACT = "correspondence", "ting"


@dataclass(frozen=True, eq=False)
class GridRow:
    """One curve of Fig. 7 or 8: its panel from 0 on, R1, R2 in s, and the impact by either law."""

    figure: int
    panel: int
    R1: float
    R2: float
    clipped: Result
    exact: Result


@dataclass(frozen=True, eq=False)
class PaperStudy:
    """Everything recomputed of one set of examples."""

    examples: Examples
    claims: tuple[JudgedClaim, ...]
    assumptions: tuple[JudgedAssumption, ...]
    misprints: tuple[tuple[Misprint, Values], ...]
    grid: tuple[GridRow, ...]


def study(examples: Examples, listen: Callable[[str], None]) -> PaperStudy:
    """Recompute and judge; `listen` hears what is being done. Raises BadInput and NotReached."""
    listen("claims")
    judged = tuple(claims.judge(claim, examples) for claim in claims.load())
    listen("assumptions and misprints")
    assumed = tuple(assumptions.judge(one, examples) for one in assumptions.load())
    printed = tuple((one, one.values(examples)) for one in misprints.load())
    listen("grids of Fig. 7 and 8")
    return PaperStudy(examples, judged, assumed, printed, grid(examples))


def grid(examples: Examples) -> tuple[GridRow, ...]:
    """The curves of Fig. 7, whose panels are R2, then of Fig. 8, whose panels are R1. Raises NotReached."""
    grids = examples.grids
    places = [(7, i, R1, R2) for i, R2 in enumerate(grids.fig7_R2) for R1 in grids.fig7_R1]
    places += [(8, i, R1, R2) for i, R1 in enumerate(grids.fig8_R1) for R2 in grids.fig8_R2]
    return tuple(
        GridRow(figure, panel, R1, R2, *(solid(examples.steel, R1, R2, law) for law in (CLIPPED, EXACT)))
        for figure, panel, R1, R2 in places
    )
