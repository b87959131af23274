"""Every number which the paper claims, `data/paper/claims.csv`: printed, recomputed, deviation, verdict."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from lumped.paper import recompute, rules, table
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Values
from lumped.paper.rules import Rule

COLUMNS = ("id", "place", "quantity", "unit", "printed", "rule", "recompute", "recomputed_as", "note")


@dataclass(frozen=True)
class Claim:
    """One claim. `id` is that of the audit, with a part after a point where it holds several.

    `printed`: numbers separated by semicolons, or words. `recompute` names what computes it, empty where nothing
    does; `recomputed_as` says what comes out where that is not the claimed quantity itself.
    """

    id: str
    place: str
    quantity: str
    unit: str
    printed: str
    rule: Rule
    recompute: str
    recomputed_as: str
    note: str


@dataclass(frozen=True)
class JudgedClaim:
    """A claim with its recomputed values and the verdict of its rule."""

    claim: Claim
    values: Values
    verdict: str

    @property
    def deviation(self) -> float | None:
        """The largest recomputed/printed - 1; None where no value stands against a printed one."""
        if not self.claim.rule.compares:
            return None
        pairs = zip(rules.numbers(self.claim.printed), self.values, strict=True)
        return max((value.value / printed - 1.0 for printed, value in pairs), key=abs)


def load() -> tuple[Claim, ...]:
    """The packaged claims. Raises BadInput."""
    known = rules.load()
    cells = table.rows("claims.csv", COLUMNS)
    return tuple(Claim(rule=rules.get(known, row.pop("rule"), row["id"]), **row) for row in cells)


def judge(claim: Claim, examples: Examples) -> JudgedClaim:
    """Recompute one claim. Raises BadInput, and NotReached where a number did not converge."""
    values = recompute.get(claim.recompute)(examples) if claim.recompute else ()
    return JudgedClaim(claim, values, claim.rule.verdict(claim.printed, values))


def counts(judged: Sequence[JudgedClaim]) -> dict[str, int]:
    """How many claims have each verdict, and how many cannot be computed by which rule."""
    found = Counter(one.verdict for one in judged)
    by_rule = Counter(one.claim.rule.name for one in judged if one.verdict == rules.UNKNOWN)
    return {verdict: found[verdict] for verdict in rules.VERDICTS} | by_rule
