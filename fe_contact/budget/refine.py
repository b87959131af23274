"""Refinement, written once: solve, look at the bars, and again with finer settings until the bars meet the tolerance.

How an impact is solved, and which settings may be finer, is a :class:`Way`. Two rules choose what to refine: where a
march is cheap, all causes that stand out at once, by a fixed factor; where it is dear, no more than the bars say is
missing, each cause's error predicted to fall with the order that its bar trusts.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import SETTING
from fe_contact.errors import MemoryTooSmall
from fe_contact.settings import RANGES, AnyNumerics, Numerics
from lumped.errors import NotReached
from lumped.result.result import LedgerEntry

WIDER = 1.5  # the mesh again where the contact outgrew it
DOMINANT = 0.5  # causes above this share of the largest one, or of the tolerance, are refined together
FACTOR = {"mesh": 1.5, "penalty": 4, "time_step": 2, "far_field": 2}  # by which they are
AIM = 0.9  # of the tolerance: predictions err too

Found = TypeVar("Found")


class Finer(NamedTuple):
    """What to do after a round: finer settings, None where nothing helps or is needed; why they are not afforded."""

    settings: Numerics | None
    refused: str = ""


class Way(Protocol[Found]):
    """One way to solve a scene; ``rounds`` of refinement before it gives up."""

    @property
    def rounds(self) -> int:
        """Of refinement, at most."""

    def certified(self, numerics: Numerics) -> Found:
        """The answer and its bars. Raises NotReached where it fails, MemoryTooSmall where the contact outgrows it."""

    def finer(self, found: Found) -> Finer:
        """What is to be tried next."""


class ImpactWay(Way[Found], Protocol):
    """The same of an impact."""

    def ledger(self, found: Found) -> Sequence[LedgerEntry]:
        """What the model leaves out."""


def refine(way: Way[Found], numerics: Numerics) -> tuple[Found, str]:
    """The last answer that was found, and why no finer settings were tried that may have met the tolerance.

    Raises NotReached where there is none. Where finer settings lose their way, what is known stands, with its bars, and
    what they met is why.
    """
    found, outgrown, refused = None, None, ""
    for _ in range(way.rounds + 1):
        try:
            found = way.certified(numerics)
        except MemoryTooSmall as failure:
            outgrown = failure
            numerics = numerics.varied(contact_radius=WIDER * numerics.contact_radius)
            continue
        except NotReached as failure:
            if found is None:
                raise
            refused = f"with finer settings {failure.reason}"  # its cure is for settings of one's own
            break
        finer, refused = way.finer(found)
        if finer is None or refused:
            break
        numerics = finer
    else:
        refused = f"refined {way.rounds} times, which was not enough"
    if found is None:
        raise outgrown or MemoryTooSmall(numerics.contact_radius)
    return found, refused


def dominant(
    errors: Mapping[str, float], numerics: Numerics, pinned: Iterable[str], least: float = np.inf
) -> Numerics | None:
    """Settings with less of the causes that stand in the way; None where nothing helps.

    ``errors`` by cause; ``pinned``: settings to keep; ``least``: an error that is refined whatever the others are.
    """
    worst, finer = max(errors.values()), numerics
    for cause, error in errors.items():
        key = SETTING[cause]
        value = FACTOR[cause] * getattr(finer, key)
        if key not in pinned and error >= DOMINANT * min(worst, least) and value <= RANGES[key][1]:
            finer = finer.varied(**{key: value})
    return None if finer == numerics else finer


class Growth(NamedTuple):
    """How a setting is raised: by steps of a factor, at most so much in a round; what a march costs goes as the setting
    to ``work``, the error as it to minus ``order``.
    """

    order: float
    step: float
    most: float
    work: float

    def worth(self, share: float) -> float:
        """What one step more takes from a bar, per work."""
        return share * (1.0 - math.pow(self.step, -self.order)) / (self.work * math.log(self.step))


def missing(
    shares: Mapping[str, Array], growths: Mapping[str, Growth], numerics: AnyNumerics, pinned: Iterable[str]
) -> AnyNumerics:
    """Settings whose bars are predicted to meet the tolerance; the same where all is ``pinned``.

    ``shares`` (quantities,) of the tolerance that every cause takes of each, infinite where it is unknown.
    """
    pinned = set(pinned)
    room = {cause: _room(numerics, cause, growth.most, pinned) for cause, growth in growths.items()}
    finer = numerics
    for cause, factor in factors(shares, growths, room).items():
        value = factor * getattr(numerics, SETTING[cause])
        finer = finer.varied(**{SETTING[cause]: int(value) if cause == "time_step" else value})
    return finer


def factors(shares: Mapping[str, Array], growths: Mapping[str, Growth], room: Mapping[str, float]) -> dict[str, float]:
    """By how much to raise the setting of every cause, up to its ``room``: one small step after the other, each time
    the one that takes most from the widest bar for its work.
    """
    chosen = dict.fromkeys(shares, 1.0)
    while True:
        left = {cause: share / chosen[cause] ** growths[cause].order for cause, share in shares.items()}
        bars = np.sum(list(left.values()), axis=0)
        free = [cause for cause in shares if chosen[cause] * growths[cause].step <= room[cause] and left[cause].any()]
        if bars.max() <= AIM or not free:
            return chosen
        widest = int(bars.argmax())
        best = max(free, key=lambda cause: growths[cause].worth(float(left[cause][widest])))
        chosen[best] *= growths[best].step


def _room(numerics: Numerics, cause: str, most: float, pinned: set[str]) -> float:
    """The factor by which the setting of a cause may be raised in one round."""
    key = SETTING[cause]
    return 1.0 if key in pinned else min(most, RANGES[key][1] / getattr(numerics, key))
