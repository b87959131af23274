"""Where contact may happen: the nodes of a boundary, in order, with normals and a measure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fe_contact.forms import Array

CONTACT_ZONE = 1.1  # contact is sought up to this multiple of the predicted contact radius


@dataclass(frozen=True, eq=False)
class Surface:
    """Scalar degrees of freedom (n_s,) along a boundary and their coordinate (n_s,), ascending from the first touch.

    ``normal`` (n_s, 2) out of the body; ``measure`` area per unit of the coordinate, and ``motion`` the component of
    the inward normal along the striker's motion, at coordinates of any shape; ``zone``: contact is sought up to
    there. ``dimension``: 3, forces in modulus x length^2, or 2, per unit length in modulus x length.
    """

    dofs: npt.NDArray[np.integer[Any]]
    coordinate: Array
    normal: Array
    measure: Callable[[Array], Array]
    motion: Callable[[Array], Array]
    zone: float
    dimension: int


def flat(basis: Any, dimension: int = 3, motion: Callable[[Array], Array] = np.ones_like) -> Surface:
    """The boundary ``surface`` of a mesh, z = 0, from the axis (or the plane of symmetry, of both halves) outwards."""
    dofs = basis.get_dofs("surface").flatten()
    dofs = dofs[np.argsort(basis.doflocs[0, dofs])]
    return Surface(
        dofs=dofs,
        coordinate=basis.doflocs[0, dofs],
        normal=np.tile([0.0, 1.0], (dofs.size, 1)),
        measure=ring_area if dimension == 3 else both_halves,
        motion=motion,
        zone=CONTACT_ZONE,
        dimension=dimension,
    )


def ring_area(radius: Array) -> Array:
    """2 pi r."""
    return np.asarray(2.0 * np.pi * radius)


def both_halves(coordinate: Array) -> Array:
    """2: the other side of a plane of symmetry counts too."""
    return np.full_like(coordinate, 2.0)
