"""The paper's ring struck: (30)-(32), one linear spring with a memory, against finite elements of the ring itself.

The impact is that of both masses of the damper, at speeds at which the row would sink in by a small share of the
thickness. A linear law has one contact time and one restitution for all speeds; a ring has not. Beside it, what of the
answer rests on a constant Poisson's ratio: the same ring with a constant bulk modulus.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from fe_contact.progress import Progress, silent
from fe_contact.reference import fe
from fe_contact.studies import journal
from fe_contact.studies.rings.study import HOLDS, KEPT, SMALL_STRAIN, RingCase
from lumped.paper.examples.given import Examples
from lumped.paper.examples.ring_impact import RingImpact, impact, stiffness
from lumped.result.result import Quantity, Result
from lumped.scene.scene import Scene

SETTINGS = {"tolerance": 1e-3}
STRAINS = (0.2 * SMALL_STRAIN, SMALL_STRAIN)  # depth by the row over the thickness
JUDGED = ("peak_depth", "duration", "restitution")
PAPER = "paper-ring"


@dataclass(frozen=True, eq=False)
class RingStruck:
    """One impact of a mass, kg, at a velocity, m/s, that by the row reaches a strain: the law's and the ring's answer.

    ``bulk``: of the ring whose bulk modulus is constant instead of its Poisson's ratio.
    """

    ring: str
    strain: float
    mass: float
    velocity: float
    row: RingImpact
    found: Result
    bulk: Result

    def by_row(self, name: str) -> float:
        """A judged quantity by (30)-(32): m, s, 1."""
        depth = self.velocity * self.row.depth_per_velocity
        return {"peak_depth": depth, "duration": self.row.duration, "restitution": self.row.restitution}[name]

    def deviation(self, name: str) -> tuple[float, float]:
        """Row over ring less one, of restitution the difference; and its bar."""
        value, bar = _known(self.found.quantities[name])
        if name == "restitution":
            return self.by_row(name) - value, bar
        return self.by_row(name) / value - 1.0, bar / value

    def of_bulk(self, name: str) -> tuple[float, float]:
        """What a quantity changes by with a constant bulk modulus, as :meth:`deviation`; and its bar."""
        (value, bar), (other, its_bar) = _known(self.found.quantities[name]), _known(self.bulk.quantities[name])
        scale = 1.0 if name == "restitution" else value
        return (other - value) / scale, (bar + its_bar) / scale

    @property
    def holds(self) -> bool:
        """Whether the law is within a per cent, or the bar, of the ring in everything."""
        return all(abs(off) <= HOLDS + bar for off, bar in map(self.deviation, JUDGED))

    @property
    def verdict(self) -> str:
        """In a line."""
        found = ((name, *self.deviation(name)) for name in JUDGED)
        parts = [f"{name} {100 * off:+.2g} +- {100 * bar:.1g} %" for name, off, bar in found]
        return f"{'holds' if self.holds else 'wrong'}: by the law {', '.join(parts)}"


def struck(cases: Sequence[RingCase], where: Path, progress: Progress = silent) -> tuple[RingStruck, ...]:
    """The paper's ring for each of its thicknesses and two speeds; impacts are kept in the folder `where`.

    Raises NotReached.
    """
    own = [case for case in cases if case.name.startswith(PAPER)]
    return tuple(_struck(case, strain, where, progress) for case in own for strain in STRAINS)


def _struck(case: RingCase, strain: float, where: Path, progress: Progress = silent) -> RingStruck:
    """At the speed that by the row reaches a strain."""
    paper, indenter = Examples.load(), case.indenter
    mass = paper.ptmd.m1 * paper.ptmd.m2 / (paper.ptmd.m1 + paper.ptmd.m2)
    row = impact(stiffness(paper.ring, indenter.material.nu), mass)
    velocity = strain * case.height / row.depth_per_velocity
    scene = Scene(indenter.shape, mass, velocity, indenter.material, target=indenter.target, name=case.name)
    other = replace(scene, material=replace(indenter.material, constant="bulk"))
    told = f"{case.name}, struck at {1e3 * velocity:.3g} mm/s"
    calls = {told: partial(fe, scene, SETTINGS), f"{told}, constant bulk modulus": partial(fe, other, SETTINGS)}
    return RingStruck(case.name, strain, mass, velocity, row, *journal.rows(where / KEPT, calls, progress).values())


def _known(quantity: Quantity) -> tuple[float, float]:
    """Value and bar of what separates."""
    assert quantity.value is not None
    assert quantity.error is not None
    return quantity.value, quantity.error
