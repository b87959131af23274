"""The paper's three assumptions judged per example by numbers and thresholds, `data/paper/assumptions.csv`."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.errors import BadInput, Fault
from lumped.paper import recompute, table
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Values

HOLDS, FAILS, OPEN = "holds", "fails", "cannot be judged"
COLUMNS = ("id", "example", "assumption", "criterion", "recompute", "holds_below", "fails_above", "note")
THRESHOLDS = ("holds_below", "fails_above")


@dataclass(frozen=True)
class Assumption:
    """One assumption for one example. Its number holds up to `holds_below`, fails from `fails_above` on."""

    id: str
    example: str
    assumption: str
    criterion: str
    recompute: str
    holds_below: float
    fails_above: float
    note: str

    def verdict(self, values: Values) -> str:
        """HOLDS or FAILS where all values say so over the whole of their bars, else OPEN."""
        if values and all(value.value + value.error <= self.holds_below for value in values):
            return HOLDS
        if values and all(value.value - value.error >= self.fails_above for value in values):
            return FAILS
        return OPEN


@dataclass(frozen=True)
class JudgedAssumption:
    """An assumption with its numbers, over the range of what is not printed, and its verdict."""

    assumption: Assumption
    values: Values
    verdict: str


def load() -> tuple[Assumption, ...]:
    """The packaged assumptions. Raises BadInput for thresholds out of order."""
    found = tuple(_read(row) for row in table.rows("assumptions.csv", COLUMNS))
    wrong = [one.id for one in found if not 0.0 < one.holds_below <= one.fails_above]
    if wrong:
        accepted = "accepted: 0 < holds_below <= fails_above"
        raise BadInput(Fault("assumptions.csv", name, accepted) for name in wrong)
    return found


def judge(assumption: Assumption, examples: Examples) -> JudgedAssumption:
    """Compute the numbers of one assumption. Raises BadInput and NotReached."""
    values = recompute.get(assumption.recompute)(examples) if assumption.recompute else ()
    return JudgedAssumption(assumption, values, assumption.verdict(values))


def _read(row: dict[str, str]) -> Assumption:
    low, high = (float(row.pop(name)) for name in THRESHOLDS)
    return Assumption(holds_below=low, fails_above=high, **row)
