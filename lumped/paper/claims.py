"""What the paper claims, misprints and assumes, `data/paper/*.csv`, each with its numbers recomputed and a verdict.

The verdict is that of a rule, `data/paper/rules.toml`: whether recomputed values agree with printed ones.
"""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from decimal import Decimal
from typing import Any, TypeVar

from lumped.errors import BadInput, Fault, nearest
from lumped.paper import recompute
from lumped.paper.given import Examples
from lumped.paper.steel_impacts import solid
from lumped.paper.value import Value, Values
from lumped.result.result import Result
from lumped.schema.files import data_folder, parsed
from lumped.schema.keys import Choice, Key, Number, Text, read_table

CLIPPED, EXACT = "correspondence", "ting"
HOLDS, FAILS, OPEN = "holds", "fails", "cannot be judged"

AGREES, DIFFERS, UNDECIDED, UNKNOWN = "agrees", "differs", "undecided", "cannot be computed from the text"
UNPRINTED = "nothing printed"
VERDICTS = (AGREES, DIFFERS, UNDECIDED, UNKNOWN, UNPRINTED)
UNJUDGED = {"none": UNKNOWN, "unprinted": UNPRINTED}
SEPARATOR = ";"


@dataclass(frozen=True)
class Claim:
    """One number which the paper claims. `id` is that of the audit, with a part after a point where it holds several.

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
        pairs = zip(numbers(self.claim.printed), self.values, strict=True)
        return max((value.value / printed - 1.0 for printed, value in pairs), key=abs)


@dataclass(frozen=True)
class Misprint:
    """A misprint or contradiction: printed, correct, why; `recompute` and `recomputed_as` as those of a claim."""

    number: int
    place: str
    printed: str
    correct: str
    proof: str
    kind: str
    recompute: str
    recomputed_as: str


@dataclass(frozen=True)
class Assumption:
    """One of three assumptions for one example. Its number holds up to `holds_below`, fails from `fails_above` on."""

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


Row = TypeVar("Row", Claim, Misprint, Assumption)


def load() -> tuple[Claim, ...]:
    """The packaged claims. Raises BadInput."""
    known = load_rules()
    return _rows("claims.csv", Claim, rule=lambda name: rule_of(known, name, "claims.csv"))


def misprints() -> tuple[Misprint, ...]:
    """The packaged misprints. Raises BadInput."""
    return _rows("misprints.csv", Misprint, number=int)


def assumptions() -> tuple[Assumption, ...]:
    """The packaged assumptions. Raises BadInput for thresholds out of order."""
    found = _rows("assumptions.csv", Assumption, holds_below=float, fails_above=float)
    wrong = [one.id for one in found if not 0.0 < one.holds_below <= one.fails_above]
    if wrong:
        accepted = "accepted: 0 < holds_below <= fails_above"
        raise BadInput(Fault("assumptions.csv", name, accepted) for name in wrong)
    return found


def values_of(row: Claim | Misprint | Assumption, examples: Examples) -> Values:
    """Its numbers, none where nothing computes them. Raises BadInput, and NotReached where one did not converge."""
    return recompute.get(row.recompute)(examples) if row.recompute else ()


def judge(claim: Claim, examples: Examples) -> JudgedClaim:
    """Recompute one claim. Raises BadInput and NotReached."""
    values = values_of(claim, examples)
    return JudgedClaim(claim, values, claim.rule.verdict(claim.printed, values))


def judge_assumption(assumption: Assumption, examples: Examples) -> JudgedAssumption:
    """Compute the numbers of one assumption. Raises BadInput and NotReached."""
    values = values_of(assumption, examples)
    return JudgedAssumption(assumption, values, assumption.verdict(values))


def counts(judged: Sequence[JudgedClaim]) -> dict[str, int]:
    """How many claims have each verdict, and how many cannot be computed by which rule."""
    found = Counter(one.verdict for one in judged)
    by_rule = Counter(one.claim.rule.name for one in judged if one.verdict == UNKNOWN)
    return {verdict: found[verdict] for verdict in VERDICTS} | by_rule


def _rows(name: str, kind: type[Row], **read: Callable[[str], Any]) -> tuple[Row, ...]:
    """The rows of a table whose columns are the fields of `kind`, texts where nothing `read`s them. Raises BadInput."""
    columns = [field.name for field in fields(kind)]
    with (data_folder() / "paper" / name).open(newline="", encoding="utf-8") as file:
        header, *body = list(csv.reader(file))
    if header != columns:
        raise BadInput(Fault(name, "header", f"{','.join(header)}; accepted: {','.join(columns)}"))
    wrong = [line for line, row in enumerate(body, start=2) if len(row) != len(columns)]
    if wrong:
        raise BadInput(Fault(name, f"line {line}", f"accepted: {len(columns)} cells") for line in wrong)
    readers = [read.get(column, str) for column in columns]
    return tuple(kind(*(reader(cell) for reader, cell in zip(readers, row, strict=True))) for row in body)


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
    judged = tuple(judge(claim, examples) for claim in load())
    listen("assumptions and misprints")
    assumed = tuple(judge_assumption(one, examples) for one in assumptions())
    printed = tuple((one, values_of(one, examples)) for one in misprints())
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


@dataclass(frozen=True)
class Rule:
    """One rule: its kind, the allowance `width`, and what it says in words."""

    name: str
    kind: str
    says: str
    width: float = 0.0

    @property
    def compares(self) -> bool:
        """Whether each recomputed value stands against a printed one."""
        return self.kind in ("digits", "relative")

    def verdict(self, printed: str, values: Sequence[Value]) -> str:
        """AGREES when every value keeps the rule over the whole of its bar, DIFFERS when one breaks it over all of it.

        UNDECIDED between; or that nothing compares.
        """
        if self.kind in UNJUDGED:
            return UNJUDGED[self.kind]
        against = printed.split(SEPARATOR) if self.compares else [printed] * len(values)
        margin = MARGINS[self.kind]
        pairs = [(margin(text, one.value, self.width), one.error) for text, one in zip(against, values, strict=True)]
        if all(inside >= error for inside, error in pairs):
            return AGREES
        return DIFFERS if any(inside < -error for inside, error in pairs) else UNDECIDED


def numbers(printed: str) -> tuple[float, ...]:
    """The printed numbers, separated by semicolons. Raises ValueError for another text."""
    return tuple(float(part) for part in printed.split(SEPARATOR))


def half_unit(printed: str) -> float:
    """Half a unit of the last digit of a printed number: "80.3" -> 0.05, "1.05e11" -> 5e8."""
    exponent = Decimal(printed.strip()).as_tuple().exponent
    if not isinstance(exponent, int):
        raise ValueError(f"{printed!r} has no last digit")
    return float(Decimal(5).scaleb(exponent - 1))


def load_rules() -> dict[str, Rule]:
    """The packaged rules by name. Raises BadInput."""
    path = data_folder() / "paper" / "rules.toml"
    keys: Mapping[str, Key] = {
        "kind": Key(Choice((*MARGINS, *UNJUDGED)), "how a value is judged"),
        "says": Key(Text(), "the rule in words"),
        "width": Key(Number(-1.0, 1.0), "what it may differ by", required=False),
    }
    found, faults = {}, []
    for name, table in parsed(path).items():
        values, more = read_table(path.name, name, table if isinstance(table, Mapping) else {}, keys)
        faults += more
        if not more:
            found[name] = Rule(name, **values)
    if faults:
        raise BadInput(faults)
    return found


def rule_of(rules: Mapping[str, Rule], name: str, source: str) -> Rule:
    """A rule by its name; raises BadInput with the nearest one."""
    if name not in rules:
        accepted = f"accepted: {', '.join(rules)}{nearest(name, tuple(rules))}"
        raise BadInput(Fault(source, name, f"unknown rule; {accepted}"))
    return rules[name]


# How far inside its allowance a value lies, in its own unit: (printed, value, width) -> margin. Where values are
# compared, each has a printed one of its own.
MARGINS: Mapping[str, Callable[[str, float, float], float]] = {
    "digits": lambda printed, value, _: half_unit(printed) - abs(value - float(printed)),
    "relative": lambda printed, value, width: width * abs(float(printed)) - abs(value - float(printed)),
    "within": lambda _, value, width: width - abs(value),
    "above": lambda _, value, width: value - width,
    "below": lambda _, value, width: width - value,
    "between": lambda printed, value, _: min(value - numbers(printed)[0], numbers(printed)[1] - value),
}
