"""Whether a model is enough: the known estimates of its ledger against what may be left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lumped.result import LedgerEntry


def sufficient(ledger: Sequence[LedgerEntry], most: float) -> bool:
    """Whether no known estimate exceeds the most that may be left out."""
    return all(entry.estimate is None or entry.estimate <= most for entry in ledger)


def worst(ledger: Sequence[LedgerEntry]) -> LedgerEntry:
    """The entry of the largest estimate, of a ledger in which one is known."""
    return max((entry for entry in ledger if entry.estimate is not None), key=lambda entry: entry.estimate or 0.0)
