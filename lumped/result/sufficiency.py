"""What a model leaves out, effect by effect, and whether it is enough for a tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from lumped.schema import Table

WITHIN, ABOVE, OPEN, UNKNOWN = "within tolerance", "above it", "open", "unknown"
NO_KEY = "no larger model here"


@dataclass(frozen=True)
class LedgerEntry:
    """One thing the model leaves out, and its estimated effect relative to the peak force, None where unknown.

    `key` selects the larger model, empty where there is none. `spread`: lowest and highest change of the force where
    the scene does not decide; the estimate is then what is left out at least, None where that may be nothing.
    """

    effect: str
    treated: str
    estimate: float | None
    note: str = ""
    key: str = ""
    spread: tuple[float, float] | None = None

    @property
    def size(self) -> float:
        """The most that is left out, as far as it is known."""
        return max(map(abs, self.spread)) if self.spread else self.estimate or 0.0

    @property
    def known(self) -> bool:
        """Whether anything is said of its size."""
        return self.estimate is not None or self.spread is not None

    def exceeds(self, tolerance: float) -> bool:
        """Whether it is certainly above what may be left out."""
        return self.estimate is not None and self.estimate > tolerance

    def verdict(self, tolerance: float) -> str:
        """Whether the effect may be left out: within tolerance, above it, open by the scene, or unknown."""
        if not self.known:
            return f"{UNKNOWN}: {self.note}"
        if self.size <= tolerance:
            return WITHIN
        return f"{ABOVE}: {self.key or NO_KEY}" if self.exceeds(tolerance) else f"{OPEN}: {self.note}"

    def to_json(self, tolerance: float) -> Table:
        """Its fields, and its verdict at a tolerance."""
        return asdict(self) | {"verdict": self.verdict(tolerance)}


def sufficient(ledger: Sequence[LedgerEntry], tolerance: float) -> bool:
    """Whether no effect certainly exceeds what may be left out."""
    return not any(entry.exceeds(tolerance) for entry in ledger)


def worst(ledger: Sequence[LedgerEntry]) -> LedgerEntry:
    """The entry of the largest estimate, of a ledger in which one is known."""
    return max((entry for entry in ledger if entry.estimate is not None), key=lambda entry: entry.estimate or 0.0)


def good_to(ledger: Sequence[LedgerEntry]) -> str:
    """A line: how much of the force the model may miss, by what, and what is not known; empty where nothing is."""
    if not any(entry.known for entry in ledger):
        return ""
    most = max(ledger, key=lambda entry: entry.size)
    unknown = [entry.effect for entry in ledger if not entry.known]
    said = f"this model is good to about {most.size:.1g} of the peak force"
    said += f", for {most.effect}" if most.size else ""
    return f"{said}; unknown: {', '.join(unknown)}" if unknown else said
