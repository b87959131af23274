"""A bar in uniaxial stress or strain: line elements of order one, a rigid mass on its far end or none."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.dynamics.body import Body, Part, Pressing
from fe_contact.forms import Array, scatter
from lumped.materials import Relaxation


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
    """Equal elements along [0, length]: ``nodes`` (n,), ``dofs`` (e, 2), ``mass`` (e, 2, 2), kg, and the
    ``stiffness`` of unit modulus, sparse (n, n), m. Node 0 is the near end.
    """

    nodes: Array
    dofs: Any
    mass: Array
    stiffness: Any


def line_elements(bar: Bar, elements: int) -> LineElements:
    """A bar cut into elements."""
    h = bar.length / elements
    dofs = np.arange(elements)[:, None] + np.arange(2)
    mass = np.tile(bar.density * bar.area * h / 6 * np.array([[2.0, 1.0], [1.0, 2.0]]), (elements, 1, 1))
    springs = np.tile(bar.area / h * np.array([[1.0, -1.0], [-1.0, 1.0]]), (elements, 1, 1))
    return LineElements(
        nodes=np.linspace(0.0, bar.length, elements + 1),
        dofs=dofs,
        mass=mass,
        stiffness=scatter(springs, dofs, elements + 1).tocsc(),
    )


def falling(bar: Bar, elements: int, mass: ModuleType, gravity: float, gap: float = 0.0) -> Body:
    """A bar that moves freely towards a rigid plane, ``gap``, m, away; displacements count away from the plane."""
    line = line_elements(bar, elements)
    size = line.nodes.size
    rigid = np.zeros(size)
    rigid[-1] = bar.end_mass
    return Body(
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
