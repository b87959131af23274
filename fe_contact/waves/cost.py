"""What an impact with waves costs, counted: a unit of work is one unknown, one step later.

A step is a back-substitution and a few products with sparse matrices, so its time goes as the unknowns; factors and
what contact knows of the body are kept a length of step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fe_contact.budget.plan import EARLY_PEAK
from fe_contact.dynamics.march import MOST_WORK
from fe_contact.errors import WavesTooDear
from fe_contact.settings import Numerics
from fe_contact.waves.impact import graded

STEP = 300  # unknowns whose share of a step takes as long as all the rest of it
SECONDS = 1.5e-6  # of one core a unit of work: 1.1 to 1.7 of them were measured over all kinds of bodies
BYTES, AT_LEAST = 8e3, 150e6  # an unknown, and at all, as measured
MARCHES = 2.5  # that a budget takes beside the finest one, at most, in units of that
JUDGED = 0.5  # the same of one with half the steps
FLIGHT = 1.5  # a contact and the flight that follows, in contacts
MANY = 12  # contacts that are expected at most: few bodies come back so often
MOST_BYTES = 2e9


@dataclass(frozen=True)
class Cost:
    """``unknowns`` of the body, ``steps`` of the finest march and the ``work`` of all marches of one error budget."""

    unknowns: int
    steps: int
    work: float

    @classmethod
    def of(cls, unknowns: int, numerics: Numerics, impacts: int, finer: int = 0) -> Cost:
        """Of a budget with these settings; nearly every contact asked for is expected to come.

        ``finer``: unknowns of the mesh that judges one which is too coarse to be halved.
        """
        octaves = len(graded(numerics)[1])
        row = 1.0 if impacts == 1 else FLIGHT * min(impacts, MANY)
        steps = math.ceil(row * numerics.steps * (1.0 + EARLY_PEAK * octaves))
        return cls(max(unknowns, finer), steps, (MARCHES * (unknowns + STEP) + JUDGED * finer) * steps)

    @property
    def all_steps(self) -> float:
        """Of all marches of the budget, counted as if all were on the finest mesh."""
        return MARCHES * self.steps

    @property
    def seconds(self) -> float:
        """Of one core."""
        return SECONDS * self.work

    @property
    def bytes(self) -> float:
        """Of memory."""
        return AT_LEAST + BYTES * self.unknowns

    def __str__(self) -> str:
        return (
            f"{self.unknowns} unknowns, {self.steps} steps: "
            f"about {self.seconds:.2g} s of one core and {self.bytes / 1e9:.1f} GB"
        )

    def as_dict(self) -> dict[str, float]:
        """Plain data for JSON."""
        return {"unknowns": self.unknowns, "steps": self.steps, "cpu_s": self.seconds, "memory_bytes": self.bytes}

    def check(self, spent: float = 0.0) -> None:
        """Raise WavesTooDear where this, after what has been ``spent``, is more work than one march may be."""
        if spent + self.work > MOST_WORK or self.bytes > MOST_BYTES:
            raise WavesTooDear(str(self), f"{SECONDS * MOST_WORK:.2g} s and {MOST_BYTES / 1e9:.0f} GB")
