"""A body whose volume and shape relax apart, before an impact: its modes for all ratios that the moduli will pass."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.operators import ElasticBody, SurfaceOperator
from fe_contact.bodies.bulk_memory import BulkBody, Moduli
from fe_contact.bodies.memory import step_law
from fe_contact.bodies.modes import ByModes, Modes, modes
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from fe_contact.settings import Numerics
from fe_contact.steppers.struck import Deformable
from lumped.materials import Relaxation

# Steps between which the ratio of the moduli is looked for at least, in contact times; but for a dashpot's it changes
# little beyond.
SHORTEST, LONGEST = 1e-6, 50.0


class Pace(NamedTuple):
    """What of an impact's settings says how long its steps may be: the scheme, the contact time, s, and the shortest
    step over it.
    """

    scheme: str
    contact_time: float
    shortest: float

    @classmethod
    def of(cls, numerics: Numerics) -> Pace:
        """Of an impact, whose first step takes about 10 (peak share/steps)^2 of its time; by decades, so that a run of
        half the steps most often has the same.
        """
        first = 10.0 * (numerics.peak_share / numerics.steps) ** 2
        return cls(numerics.scheme, numerics.contact_time, min(SHORTEST, 10.0 ** math.floor(math.log10(first))))

    def ratios(self, moduli: Moduli) -> tuple[float, float]:
        """Least and largest ratio of shear to bulk modulus that the steps may meet."""
        scheme = SCHEMES.get(self.scheme)
        extremes = [share * self.contact_time for share in (self.shortest, LONGEST)]
        laws = [[step_law(modulus, scheme, length).now for modulus in moduli] for length in extremes]
        low, high = sorted(shear / bulk for bulk, shear in laws)
        return low, high


@dataclass(frozen=True, eq=False)
class BulkSurface(ByModes, Deformable):
    """A body before the impact, seen through its surface.

    ``length``: unit of its mesh, m; None: the contact radius expected. ``rim``: where a contact ends that no depth
    widens on a body loaded no farther, m.
    """

    modes: Modes
    moduli: Moduli
    follows_contact: bool = False
    length: float | None = None
    rim: float | None = None

    @property
    def operator(self) -> SurfaceOperator:
        """Of the elastic body at one of the ratios: places, weights and scale are those of all."""
        return self.modes.operator

    def unit(self, contact_radius: float) -> float:
        """The mesh's unit of length, m."""
        return contact_radius if self.length is None else self.length

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> BulkBody:
        """The body on its mesh of unit length ``scale``, m; its E*(t) follows from its own moduli."""
        return BulkBody(self.modes, self.moduli, scheme, scale)


@cached
def relaxing(
    body: Recipe[ElasticBody], moduli: Moduli, pace: Pace, length: float | None = None, rim: float | None = None
) -> BulkSurface:
    """A meshed body of a material with these moduli, in an impact of this pace; see :class:`BulkSurface`."""
    return BulkSurface(modes(body, *pace.ratios(moduli)), moduli, length=length, rim=rim)
