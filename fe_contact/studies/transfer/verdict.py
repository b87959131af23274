"""What a prediction is worth: its deviation against the bars, the range over which a law holds, and that in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from lumped.result.result import RULED_RELATIVE, Quantity
from lumped.schema import Table

QUANTITIES = (*RULED_RELATIVE, "restitution")
LEVELS = (0.01, 0.05, 0.1)  # what a law may be asked to hold to
# Rounding: a calibration tells its numbers to this at best, relatively, and what they predict with them.
CALIBRATED = 1e-6


class TransferVerdict(Enum):
    """Of one prediction: within both bars, within the tolerance, or neither; or there is none."""

    INSIDE = "inside"
    WITHIN = "within"
    OUTSIDE = "outside"
    REFUSED = "refused"


@dataclass(frozen=True)
class TransferRow:
    """One quantity of a law at a state. ``deviation``: predicted over reference less one, of the restitution the
    difference; ``reference_error``: the reference's bar alone; ``reason``: why there is no prediction.
    """

    law: str
    key: str
    value: float
    quantity: str
    predicted: float | None
    reference: float | None
    reference_error: float | None
    deviation: float | None
    verdict: TransferVerdict
    reason: str = ""

    def to_json(self) -> Table:
        """Its fields, as they stand in transfer.csv, and the reason."""
        return vars(self) | {"verdict": self.verdict.value}


def row_of(
    law: str,
    key: str,
    value: float,
    quantity: str,
    ours: Quantity | None,
    theirs: Quantity | None,
    within: float,
    reason: str = "",
) -> TransferRow:
    """The row of a prediction and its reference, both None where refused.

    Inside: they differ by no more than the bar of the reference and the law's own, that of its integration and of its
    calibration, together. Where neither bounces back, a duration is none on either side, and they agree.
    """
    predicted, reference = (None if one is None else one.value for one in (ours, theirs))
    deviation = _deviation(quantity, predicted, reference)
    if ours is None or theirs is None:
        verdict = TransferVerdict.REFUSED
    elif predicted is None or reference is None:
        verdict = TransferVerdict.INSIDE if predicted is reference else TransferVerdict.OUTSIDE
    elif abs(predicted - reference) <= (theirs.error or 0.0) + (ours.error or 0.0) + CALIBRATED * abs(reference):
        verdict = TransferVerdict.INSIDE
    else:
        verdict = (
            TransferVerdict.WITHIN if deviation is not None and abs(deviation) <= within else TransferVerdict.OUTSIDE
        )
    bar = None if theirs is None else theirs.error
    return TransferRow(law, key, value, quantity, predicted, reference, bar, deviation, verdict, reason)


def _deviation(quantity: str, predicted: float | None, reference: float | None) -> float | None:
    if predicted is None or reference is None:
        return None
    if quantity == "restitution" or predicted == reference:
        return predicted - reference
    return predicted / reference - 1.0 if reference else None


def holds(rows: Sequence[TransferRow], start: float) -> dict[str, dict[str, tuple[float, float] | None]]:
    """Over which values a law holds to every level, without a gap from the start on; None where not even there.

    By quantity, and ``all`` of them together; of one key. Only states that were judged are told of.
    """
    found = {}
    for name in ("all", *QUANTITIES):
        own = [row for row in rows if name in ("all", row.quantity)]
        found[name] = {percent(level): _reach(own, start, level) for level in LEVELS}
    return found


def percent(level: float) -> str:
    """A level as it is said."""
    return f"{100.0 * level:g} %"


def _reach(rows: Sequence[TransferRow], start: float, level: float) -> tuple[float, float] | None:
    """The lowest and the highest value next to the start, between which every row is as good."""
    values = sorted({row.value for row in rows})
    good = {value: all(is_good(row, level) for row in rows if row.value == value) for value in values}
    if not good.get(start):
        return None
    low = high = values.index(start)
    while low > 0 and good[values[low - 1]]:
        low -= 1
    while high < len(values) - 1 and good[values[high + 1]]:
        high += 1
    return values[low], values[high]


def is_good(row: TransferRow, level: float) -> bool:
    """Whether a prediction is as near as that, or inside the bars."""
    return row.verdict is TransferVerdict.INSIDE or (row.deviation is not None and abs(row.deviation) <= level)


def sentence(law: str, refused: str | None, rows: Sequence[TransferRow], start: Mapping[str, float]) -> str:
    """What a law is worth elsewhere, in one plain sentence."""
    known = [row for row in rows if row.verdict is not TransferVerdict.REFUSED]
    if not known:
        reason = refused or next((row.reason for row in rows if row.reason), "no state has a reference")
        return f"{law}: refused: {reason}"
    if all(row.verdict is TransferVerdict.INSIDE for row in known):
        return f"{law} holds at every state within the error bars{_left_out(rows)}"
    begin = [row for row in known if row.value == start[row.key]]
    if all(is_good(row, LEVELS[-1]) for row in begin):
        ranges = [_range(key, own, start[key]) for key in start if (own := [row for row in known if row.key == key])]
        said = f"{law} holds {'; '.join(ranges)}; it errs most in {_most(known)}"
    else:
        said = f"{law} errs in {_most(begin)} even where it was calibrated; at most in {_most(known)}"
    return said + _left_out(rows)


def _range(key: str, rows: Sequence[TransferRow], start: float) -> str:
    """The finest level that it holds to away from the start, else where it is calibrated, and the range."""
    reaches = [(level, reach) for level in LEVELS if (reach := _reach(rows, start, level))]
    level, (low, high) = next((one for one in reaches if one[1][0] < one[1][1]), reaches[0])
    if low < high:
        return f"to {percent(level)} for {key} from {low:.5g} to {high:.5g}"
    return f"to {percent(level)} at {key} = {start:.5g} alone"


def _most(rows: Sequence[TransferRow]) -> str:
    """The quantity that errs most, by how much, and where."""
    told = [row for row in rows if row.deviation is not None]
    if not told:
        return "whether the bodies part"
    most = max(told, key=lambda row: abs(row.deviation or 0.0))
    off = most.deviation or 0.0
    share = f"{100.0 * off:+.0f} %" if abs(off) >= 1.0 else f"{100.0 * off:+.2g} %"
    size = f"{off:+.2g}" if most.quantity == "restitution" else share
    return f"{most.quantity.replace('_', ' ')} by {size} at {most.key} = {most.value:.5g}"


def _left_out(rows: Sequence[TransferRow]) -> str:
    """How many states have no answer."""
    states = {(row.key, row.value): row.reason for row in rows if row.verdict is TransferVerdict.REFUSED}
    return f"; no answer at {len(states)} states: {next(iter(states.values()))}" if states else ""
