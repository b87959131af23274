"""The verdict on a row of Table 1, by rule, from what finite elements identified and their bars."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fe_contact.studies.table1.blocks import WIDTHS, within
from fe_contact.studies.table1.reach import LIMIT
from fe_contact.studies.table1.study import Trial, bodies
from lumped.result.result import Quantity

HOLDS, RANGE, WRONG = "holds", "holds within a range", "wrong, corrected"
UNDECIDED, UNTRIED = "undecided", "not tried"
# How far a number may lie from the printed one and still agree; a bar wider than this decides nothing.
ALPHA, FACTOR, MODULUS = 5e-4, 1e-3, 1e-3
LINE = 0.25 * math.pi  # D over the length l, as printed in both rows of line contact


@dataclass(frozen=True)
class Deviation:
    """Of one number from the table's: absolute for alpha, relative for D and E*; its bar and what still agrees."""

    value: float
    error: float
    allowed: float

    @property
    def differs(self) -> bool:
        """Beyond what is allowed, whatever the bar hides."""
        return abs(self.value) > self.allowed + self.error

    @property
    def open(self) -> bool:
        """Neither in agreement nor apart for certain."""
        return not self.differs and abs(self.value) + self.error > 2.0 * self.allowed


@dataclass(frozen=True)
class Verdict:
    """One of the five words, and a sentence with the numbers behind it."""

    word: str
    sentence: str


def deviations(trial: Trial, corrected: bool = False) -> dict[str, Deviation]:
    """alpha, D and E* (at the worst nu) against the row as printed, or as corrected."""
    row, found = trial.row, {}
    if trial.alpha is not None and trial.factor is not None:
        found["alpha"] = Deviation(_value(trial.alpha) - row.alpha, trial.alpha.error or 0.0, ALPHA)
        found["D"] = _relative(trial.factor, row.factor, FACTOR)
    against = row.modulus if corrected else row.printed_modulus
    moduli = [_relative(found_, against(*bodies(row, nu)), MODULUS) for nu, found_ in trial.moduli.items()]
    if moduli:
        found["E*"] = max(moduli, key=lambda one: (one.differs, abs(one.value)))
    return found


def verdict(trial: Trial) -> Verdict:
    """The rule: what differs from the printed row beyond its bar is wrong; what holds somewhere only has a range.

    A row whose D spreads beyond 1 % over datum and thickness has no D.
    """
    if trial.failure:
        return Verdict(UNTRIED, trial.failure)
    printed, corrected = deviations(trial), deviations(trial, corrected=True)
    wrong = [name for name, one in printed.items() if one.differs]
    if trial.datum:
        return _spread(trial, wrong)
    if any(one.open for one in (*printed.values(), *corrected.values())):
        return Verdict(UNDECIDED, "error bars wider than what would decide")
    if wrong:
        healed = not any(one.differs for one in corrected.values())
        return Verdict(WRONG if healed else UNDECIDED, _what_differs(trial, printed, wrong))
    return _within(trial)


def _within(trial: Trial) -> Verdict:
    reach, name = trial.reach, trial.row.length_name
    assert reach is not None
    if reach.throughout:
        last = f", up to {reach.last:.2g} of the {name}" if name else ""
        where = f"at every depth tried{last}"
        if trial.row.alpha == 1.0:  # any depth gives the same answer
            tried = ", ".join(f"{nu:g}" for nu in trial.moduli)
            where = f"at every nu tried, {tried}; small displacements are linear here, whatever the depth"
        return Verdict(HOLDS, f"within {100 * LIMIT:g} % {where}{_bonded(trial)}")
    held = f"within {100 * LIMIT:g} % up to a depth of {_value(reach.held):.3g} of the {name}"
    return Verdict(RANGE, f"{held}; tried up to {reach.last:.2g}")


def _bonded(trial: Trial) -> str:
    """What becomes of the row when the faces of its block are bonded."""
    said = []
    for body in dict.fromkeys(block.body for block in trial.bonded):
        found = within(trial.row, [block for block in trial.bonded if block.body == body], LIMIT)
        if found is None:
            said.append(f"nowhere up to {WIDTHS[-1]:g} at nu = {body.nu:g}")
        else:
            ends = (f"from {found[0]:.2g}" if found[0] else "", f"up to {found[1]:.2g}" if found[1] < math.inf else "")
            said.append(f"{' '.join(end for end in ends if end)} at nu = {body.nu:g}")
    return f"; faces bonded, sides free: at radius over thickness {', '.join(said)}" if said else ""


def _spread(trial: Trial, wrong: list[str]) -> Verdict:
    """Of a row without a D of its own."""
    factors = [_value(place.factor) for place in trial.datum]
    exponents = [_value(place.alpha) for place in trial.datum]
    if max(factors) <= (1.0 + LIMIT) * min(factors):
        return Verdict(UNDECIDED, "D does not depend on the datum")
    beside = f"; {', '.join(wrong)} differs too" if wrong else ""
    inside = "among them" if min(factors) <= LINE <= max(factors) else "beyond them"
    sentence = (
        f"no half-space answer; D depends on the datum: {min(factors):.2f} to {max(factors):.2f} l, printed "
        f"{LINE:.2f} l {inside}; alpha {min(exponents):.2f} to {max(exponents):.2f}, over the data and layers tried"
        f"{beside}"
    )
    return Verdict(WRONG, sentence)


def _what_differs(trial: Trial, printed: dict[str, Deviation], wrong: list[str]) -> str:
    """Each number that differs, and why."""
    said = []
    for name in wrong:
        off = printed[name].value
        said.append(f"{name} is off by {off:+.2g}" if name == "alpha" else f"{name} is off by {100 * off:+.2f} %")
    return "; ".join([*said, trial.row.correction] if trial.row.correction else said)


def _relative(found: Quantity, expected: float, allowed: float) -> Deviation:
    return Deviation(_value(found) / expected - 1.0, (found.error or 0.0) / expected, allowed)


def _value(quantity: Quantity) -> float:
    assert quantity.value is not None
    return quantity.value
