"""Verdict by rule: whether recomputed values agree with printed ones, `data/paper/rules.toml`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from lumped.errors import BadInput, Fault, nearest
from lumped.paper.value import Value
from lumped.schema.files import data_folder, parsed
from lumped.schema.keys import Choice, Key, Number, Text, read_table

AGREES, DIFFERS, UNDECIDED, UNKNOWN = "agrees", "differs", "undecided", "cannot be computed from the text"
UNPRINTED = "nothing printed"
VERDICTS = (AGREES, DIFFERS, UNDECIDED, UNKNOWN, UNPRINTED)
UNJUDGED = {"none": UNKNOWN, "unprinted": UNPRINTED}
SEPARATOR = ";"


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


def load() -> dict[str, Rule]:
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


def get(rules: Mapping[str, Rule], name: str, source: str) -> Rule:
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
