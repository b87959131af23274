"""What rings really do when they are pressed slowly, against the paper's row for them, F = (pi/4) E* l depth (27)-(29).

With a constant Poisson's ratio the force over E* is the same against a slow and a sudden indentation: one verdict for
both. Impacts, (30)-(32), have one of their own: :mod:`fe_contact.studies.rings.impact`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from lumped.indentation import Indentation
from lumped.materials import Material
from lumped.materials.networks import sls
from lumped.paper.examples.given import Examples
from lumped.result.result import LedgerEntry
from lumped.scene.indenter import Indenter
from lumped.shapes.cylinder import Cylinder
from lumped.targets.o_ring import ORing
from lumped.targets.ring import Ring
from lumped.targets.washer import Washer

SETTINGS = {"tolerance": 3e-4}
STRAINS = tuple(float(strain) for strain in np.geomspace(1e-3, 0.3, 13))  # depth over what is pressed
SMALL_STRAIN = 0.05  # beyond, linear theory is no more than an indication
HOLDS = 0.01  # of the force: a row this near to it holds
KEPT = "ring.jsonl"
PACKAGED = ("rod-in-ring", "polymer-o-ring", "polymer-washer")


@dataclass(frozen=True)
class RingCase:
    """A ring and what presses it; ``length`` l of the paper's row and ``height`` of what is pressed, m."""

    name: str
    indenter: Indenter
    length: float
    height: float


@dataclass(frozen=True, eq=False)
class RingCurve:
    """Force over E* l depth in units of pi/4, 1 where the row holds, and its bar; local exponent between neighbours
    and its bar, 1 by the row; each (n,). ``ledger``: what the model leaves out.
    """

    case: RingCase
    found: Indentation
    factor: Array
    factor_error: Array
    exponent: Array
    exponent_error: Array
    ledger: tuple[LedgerEntry, ...]

    @property
    def strain(self) -> Array:
        """Depth over the height of what is pressed."""
        return self.found.depth / self.case.height

    @property
    def row_force(self) -> Array:
        """(pi/4) E* l depth, N: "(27)" with the relaxed modulus of "(29)"."""
        return 0.25 * math.pi * self.found.modulus * self.case.length * self.found.depth


def cases() -> tuple[RingCase, ...]:
    """The packaged rings, and the paper's: its rod and gap, one for each thickness that may be meant."""
    paper = Examples.load()
    material = Material(sls.of_ratios(E0=paper.ring.E0, R1=paper.ring.R1, R2=paper.ring.R2), paper.ring.nu)
    radius = 0.5 * paper.ring.rod_diameter
    rod, inner = Cylinder(radius, paper.ring.width), radius + paper.ptmd.gap
    own = [
        Indenter(rod, material, Ring(inner, thickness), name=f"paper-ring-{1e3 * thickness:g}mm")
        for thickness in paper.ring.thickness
    ]
    return tuple(_case(one) for one in (*map(Indenter.load, PACKAGED), *own))


def _case(indenter: Indenter) -> RingCase:
    """The row's length l along which a ring is touched."""
    target, shape = indenter.target, indenter.shape
    if isinstance(target, Ring) and isinstance(shape, Cylinder):
        return RingCase(indenter.name, indenter, shape.length, target.thickness)
    if isinstance(target, ORing):
        return RingCase(indenter.name, indenter, 2.0 * math.pi * target.mean_radius, 2.0 * target.section_radius)
    assert isinstance(target, Washer)
    pressed = target.fixed_radius(shape) or target.outer_radius
    return RingCase(indenter.name, indenter, math.pi * (target.inner_radius + pressed), target.height)


def rings(chosen: Sequence[RingCase], where: Path, progress: Progress = silent) -> tuple[RingCurve, ...]:
    """Every case over three decades of depth; rows are kept in the folder `where`. Raises NotReached."""
    calls = {
        case.name: partial(indent, case.indenter, tuple(case.height * strain for strain in STRAINS), SETTINGS)
        for case in chosen
    }
    found = journal.rows(where / KEPT, calls, progress)
    return tuple(curve(case, found[case.name]) for case in chosen)


def curve(case: RingCase, found: Indentation) -> RingCurve:
    """What an indentation by finite elements says of the row."""
    relative = found.force_error / found.force
    factor = found.force / (0.25 * math.pi * found.modulus * case.length * found.depth)
    exponent, exponent_error = local_exponent(found.depth, found.force, relative)
    return RingCurve(case, found, factor, relative * factor, exponent, exponent_error, found.model_ledger)


def local_exponent(depth: Array, force: Array, relative: Array) -> tuple[Array, Array]:
    """Slope of ln F on ln depth between the neighbours of every depth, and its bar; (n,)."""
    places = np.arange(depth.size)
    left, right = np.maximum(places - 1, 0), np.minimum(places + 1, depth.size - 1)
    width = np.log(depth[right] / depth[left])
    return np.log(force[right] / force[left]) / width, (relative[right] + relative[left]) / width
