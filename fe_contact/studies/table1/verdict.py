"""The verdict on a row of Table 1, by rule, from what finite elements identified and their bars.

What ``fe-contact table1`` writes: a line a row, a line a datum or layer, and everything as JSON.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from fe_contact.studies.files import Line, write_study
from fe_contact.studies.table1.limits import DEPTH, LIMIT, WIDTHS, Block, within
from fe_contact.studies.table1.study import FromImpact, Trial, bodies
from lumped.result.result import Quantity
from lumped.schema import Table

HOLDS, RANGE, WRONG = "holds", "holds within a range", "wrong, corrected"
UNDECIDED, UNTRIED = "undecided", "not tried"
# How far a number may lie from the printed one and still agree; a bar wider than this decides nothing.
ALPHA, FACTOR, MODULUS = 5e-4, 1e-3, 1e-3
LINE = 0.25 * math.pi  # D over the length l, as printed in both rows of line contact
SCHEMA = "fe-contact/table1/1"
HEADERS = {  # of tables that may have no line
    "table1-datum": ("number", "row", "support", "length_over_radius", "method", "D_over_l", "D_over_l_error", "alpha",
                     "alpha_error", "depth_over_radius_with_printed_D"),
    "table1-bonded": ("nu", "radius_over_thickness", "modulus_over_young", "modulus_over_young_error"),
}  # fmt: skip


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


def write_table1(trials: Sequence[Trial], where: Path) -> Table:
    """Write ``table1.csv``, ``-datum.csv``, ``-bonded.csv`` and ``table1.json`` into a folder; the latter's content."""
    tables = {
        "table1": [_line(trial) for trial in trials],
        "table1-bonded": [_block(one) for one in dict.fromkeys(one for trial in trials for one in trial.bonded)],
        "table1-datum": [line for trial in trials for line in _data(trial)],
    }
    content = {"schema": SCHEMA, "rows": [_described(trial) for trial in trials]}
    return write_study(where, "table1", content, tables, HEADERS)


def _line(trial: Trial) -> Line:
    """One row of table1.csv; E* at the Poisson's ratio where it lies farthest from the printed one."""
    row, printed, judged, reach = trial.row, deviations(trial), verdict(trial), trial.reach
    nu = max(trial.moduli, key=lambda one: _off(trial, one), default=None)
    struck = trial.impact or FromImpact({})
    return {
        "number": row.number,
        "row": row.name,
        "case": row.case,
        "D_printed_formula": row.printed[0],
        "D_printed": row.factor,
        **_cells(trial.factor, "D", "D_error"),
        "D_deviation": _known(printed, "D"),
        "alpha_printed": row.alpha,
        **_cells(trial.alpha, "alpha", "alpha_error"),
        "E_printed_formula": row.printed[1],
        "E_corrected_formula": row.corrected[1],
        "nu": nu,
        "E_printed_Pa": None if nu is None else row.printed_modulus(*bodies(row, nu)),
        **_cells(None if nu is None else trial.moduli[nu], "E_Pa", "E_error_Pa"),
        "E_deviation": _known(printed, "E*"),
        "depth_tried_from": reach and reach.first,
        "depth_tried_to": reach and reach.last,
        **_cells(None if reach is None else reach.held, "holds_to_1_percent_up_to", "holds_up_to_error"),
        "verdict": judged.word,
        "statement": judged.sentence,
        "validity": row.validity,
        "correction": row.correction or None,
        **_cells(struck.factor, "D_impact", "D_impact_error"),
        **_cells(struck.alpha, "alpha_impact", "alpha_impact_error"),
        **_cells(None if nu is None else struck.moduli.get(nu), "E_impact_Pa", "E_impact_error_Pa"),
    }


def _data(trial: Trial) -> list[Line]:
    """Its rows of table1-datum.csv."""
    return [
        {
            "number": trial.row.number,
            "row": trial.row.name,
            "support": place.support,
            "length_over_radius": place.length,
            "method": place.method,
            **_cells(place.factor, "D_over_l", "D_over_l_error"),
            **_cells(place.alpha, "alpha", "alpha_error"),
            "depth_over_radius_with_printed_D": place.once,
        }
        for place in trial.datum
    ]


def _block(block: Block) -> Line:
    """One row of table1-bonded.csv."""
    young, modulus = block.body.young, block.modulus
    share = Quantity((modulus.value or 0.0) / young, (modulus.error or 0.0) / young, "1")
    found = _cells(share, "modulus_over_young", "modulus_over_young_error")
    return {"nu": block.body.nu, "radius_over_thickness": block.width, **found}


def _described(trial: Trial) -> Table:
    """One row of table1.json."""
    row, reach = trial.row, trial.reach
    return {
        "number": row.number,
        "row": row.name,
        "case": row.case,
        "geometry": row.to_dict(),
        "young_Pa": [body.young for body in bodies(row, 0.0)],
        "printed": {"D": row.printed[0], "E*": row.printed[1], "alpha": row.alpha, "D_value": row.factor},
        "corrected": {"D": row.corrected[0], "E*": row.corrected[1], "alpha": row.alpha if row.single else None},
        "validity": row.validity,
        "correction": row.correction or None,
        "alpha": trial.alpha,
        "D": trial.factor,
        "E*": [_modulus(trial, nu, found) for nu, found in trial.moduli.items()],
        "impact": None if trial.impact is None else _from_impact(trial.impact),
        "reach": None if reach is None else _reach(trial),
        "datum": trial.datum,
        "datum_depth_over_radius": DEPTH if trial.datum else None,
        "bonded": [
            {"nu": block.body.nu, "radius_over_thickness": block.width, **asdict(block.modulus)}
            for block in trial.bonded
        ],
        "deviations": deviations(trial),
        "verdict": verdict(trial),
        "failure": trial.failure or None,
    }


def _from_impact(found: FromImpact) -> Table:
    moduli = [{"nu": nu, **asdict(modulus)} for nu, modulus in found.moduli.items()]
    return {"alpha": found.alpha, "D": found.factor, "E*": moduli}


def _modulus(trial: Trial, nu: float, found: Quantity) -> Table:
    row, pressed = trial.row, bodies(trial.row, nu)
    known = {"printed": row.printed_modulus(*pressed), "corrected": row.modulus(*pressed)}
    return {"nu": [body.nu for body in pressed], **asdict(found), **known}


def _reach(trial: Trial) -> Table:
    reach = trial.reach
    assert reach is not None
    ends = {"first": reach.first, "last": reach.last, "held": reach.held, "throughout": reach.throughout}
    curve = {"depth": reach.depth, "departure": reach.departure}
    return {"length": trial.row.length_name or "m", **ends, **curve}


def _off(trial: Trial, nu: float) -> float:
    known = trial.row.printed_modulus(*bodies(trial.row, nu))
    return abs((trial.moduli[nu].value or 0.0) / known - 1.0)


def _cells(quantity: Quantity | None, value: str, error: str) -> Line:
    """Its value and its bar under the names of their columns."""
    return {value: quantity and quantity.value, error: quantity and quantity.error}


def _known(found: Mapping[str, Deviation], name: str) -> float | None:
    return found[name].value if name in found else None


def told(trials: Sequence[Trial]) -> list[str]:
    """Of every row its verdict, then its numbers."""
    return [line for trial in trials for line in _said(trial)]


def undecided(trials: Sequence[Trial]) -> str:
    """Which rows bars leave undecided; empty where they leave none."""
    names = [trial.row.name for trial in trials if verdict(trial).word == UNDECIDED]
    return f"undecided: {', '.join(names)}" if names else ""


def _said(trial: Trial) -> list[str]:
    """A row: its verdict, then its numbers."""
    row, judged = trial.row, verdict(trial)
    lines = [f"{row.number} {row.case}: {judged.word}: {judged.sentence}"]
    if trial.alpha is not None and trial.factor is not None:
        alpha, factor = trial.alpha, trial.factor
        lines.append(f"    alpha {alpha.value:.6g} +- {alpha.error:.1e}, printed {row.alpha:g}")
        lines.append(f"    D {factor.value:.6g} +- {factor.error:.1e} {factor.unit}, printed {row.factor:.6g}")
    if trial.moduli:
        nu, found = max(trial.moduli.items())
        lines.append(f"    E* {found.value:.6g} +- {found.error:.1e} Pa at nu = {nu:g}, printed {row.printed[1]}")
    return [*lines, *_struck(trial)]


def _struck(trial: Trial) -> list[str]:
    """What its impacts say."""
    if trial.impact is None:
        return []
    found = trial.impact
    said = [] if found.alpha is None or found.factor is None else [
        f"alpha {found.alpha.value:.6g} +- {found.alpha.error:.1e}",
        f"D {found.factor.value:.6g} +- {found.factor.error:.1e} {found.factor.unit}",
    ]  # fmt: skip
    nu, modulus = max(found.moduli.items())
    said.append(f"E* {modulus.value:.6g} +- {modulus.error:.1e} Pa at nu = {nu:g}")
    return [f"    from impact: {', '.join(said)}"]
