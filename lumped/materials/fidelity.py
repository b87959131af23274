"""How far a series stands from the modulus that it represents."""

from __future__ import annotations

import math
from dataclasses import dataclass

from lumped.errors import BadInput, Fault

# The load d^(3/2) of a depth that is a half sine over time rises by at most so many peaks per duration.
STEEPEST = 3.0


@dataclass(frozen=True)
class Fidelity:
    """Largest relative deviation of a series from its modulus at times in `window`, s, before it and after it.

    Infinite where nothing is known. Raises BadInput.
    """

    window: tuple[float, float]
    inside: float
    before: float = math.inf
    after: float = math.inf

    def __post_init__(self) -> None:
        shortest, longest = self.window
        if not 0.0 < shortest <= longest < math.inf:
            raise BadInput(Fault("material", "fit_window", "accepted: shortest <= longest, both finite and above zero"))
        if not all(deviation >= 0.0 for deviation in (self.inside, self.before, self.after)):
            raise BadInput(Fault("material", "fit_error", "accepted: relative deviations >= 0"))

    def of_force(self, duration: float) -> float:
        """Bound of the deviation in the force of an impact this long, s, relative to its peak.

        F = int E(t-s) dy(s) deviates by what E does at the ages t-s it meets, from zero to the duration; the
        load of the ages below the window is a small share of all when the impact is much longer.
        """
        shortest, longest = self.window
        if duration > longest:
            return max(self.inside, self.before, self.after)
        young = STEEPEST * shortest
        return self.inside + (self.before if duration <= young else young / duration * self.before)
