"""A bar in uniaxial stress or strain: line elements of order one, a rigid mass on its far end or none.

A surface without mass (:mod:`~fe_contact.dynamics.mass.redistributed`) hands its share to the next node, which a first
element of ``tip`` times the others' length h holds: mass (1/2 + tip) h, spring 1/tip, in units of the others'. Where a
wave crosses an element in a step, dt = h/c, what it leaves behind at a closed contact fades as z^n, n the steps,

    (tip + 1/2) z^2 + (1/tip - 2 tip) z + (tip - 1/2) = 0 :

not at all, |z| = 1, for tip = 1/2, which alone keeps the first moment of the mass as well (Khenous, Laborde and Renard
2008, doi:10.1016/j.euromechsol.2008.01.001); |z| = 0.58 for equal elements; 0.41 for TIP, whose middle term vanishes.

A touch or a separation between two steps errs in energy by about what one element holds, of either sign: with 100
elements by some thousandths of the whole, at worst by 0.03. The bouncing bar of Doyen, Ern and Piperno 2011, whose
contacts keep to steps, keeps its energy; under a gravity that makes hundreds of contacts it drifts by their sum.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Matrix, scatter
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing
from fe_contact.dynamics.mass.base import Mass
from lumped.materials import Relaxation

TIP = 0.5**0.5  # first element over the others, for a surface without mass


@dataclass(frozen=True)
class Bar:
    """Length, m; area, m2; density, kg/m3; modulus along it; a rigid mass on its far end, kg."""

    length: float
    area: float
    density: float
    relaxation: Relaxation
    end_mass: float = 0.0


@dataclass(frozen=True, eq=False)
class LineElements:
    """Of e elements: ``dofs`` (e, 2), ``mass`` (e, 2, 2), kg, and the ``stiffness`` of unit modulus, sparse
    (e + 1, e + 1), m. Node 0 is the near end.
    """

    dofs: Any
    mass: Array
    stiffness: Matrix


def pitch(length: float, elements: int, tip: float) -> float:
    """Length of all elements but the first, which is ``tip`` of it, m."""
    return length / (elements - 1 + tip)


def line_elements(bar: Bar, elements: int, tip: float) -> LineElements:
    """A bar cut into elements."""
    lengths = np.full(elements, pitch(bar.length, elements, tip))
    lengths[0] *= tip
    dofs = np.arange(elements)[:, None] + np.arange(2)
    mass = np.multiply.outer(bar.density * bar.area * lengths, np.array([[2.0, 1.0], [1.0, 2.0]]) / 6)
    springs = np.multiply.outer(bar.area / lengths, np.array([[1.0, -1.0], [-1.0, 1.0]]))
    return LineElements(
        dofs=dofs,
        mass=mass,
        stiffness=scatter(springs, dofs, elements + 1).tocsc(),
    )


def falling(bar: Bar, elements: int, mass: Mass, gravity: float, gap: float = 0.0, tip: float = 1.0) -> BodyWithMass:
    """A bar that moves freely towards a rigid plane, ``gap``, m, away; displacements count away from the plane."""
    line, size = line_elements(bar, elements, tip), elements + 1
    rigid = np.zeros(size)
    rigid[-1] = bar.end_mass
    return BodyWithMass(
        mass=mass.of(line.mass, line.dofs, size, np.array([0])),
        rigid=rigid,
        parts=(Part(line.stiffness, bar.relaxation),),
        dashpots=None,
        gravity=np.full(size, -gravity),
        pressing=Pressing(
            push=sparse.csc_matrix(([1.0], ([0], [0])), shape=(size, 1)),
            trace=np.ones((1, 1)),
            weights=np.array([bar.area]),
            clearance=np.array([-gap]),
        ),
    )
