"""Where contact may happen: the nodes of a boundary, in order, with normals and a measure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices

MIDDLE = 0.5 * np.pi - 1e-6  # rad from the top of a circle: just above its middle plane
CONTACT_ZONE = 1.1  # contact is sought up to this multiple of the predicted contact radius


@dataclass(frozen=True, eq=False)
class Surface:
    """Scalar degrees of freedom (n_s,) along a boundary and their coordinate (n_s,), ascending from the first touch.

    ``normal`` (n_s, 2) out of the body; ``measure`` area per unit of the coordinate, and ``motion`` the component of
    the inward normal along the striker's motion, at coordinates of any shape; ``zone``: contact is sought up to
    there. ``dimension``: 3, forces in modulus x length^2, or 2, per unit length in modulus x length.
    """

    dofs: Indices
    coordinate: Array
    normal: Array
    measure: Callable[[Array], Array]
    motion: Callable[[Array], Array]
    zone: float
    dimension: int


def flat(basis: Basis, dimension: int = 3, motion: Callable[[Array], Array] = np.ones_like) -> Surface:
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


def crown(basis: Basis, contact: float, mean_radius: float | None) -> Surface:
    """The boundary ``surface`` of a circle of radius 1, by its angle from the top, rad, where ``contact`` may end.

    The pressure is vertical and acts on what the circle shows from above: ``mean_radius`` is its distance from the
    axis, where the left of the top counts too, 0 on the axis, None in plane strain. The circle's top is the mesh's.
    """
    dofs = basis.get_dofs("surface").flatten()
    places = basis.doflocs[:, dofs]
    angle = np.arctan2(places[0] - (mean_radius or 0.0), places[1] + 1.0)
    ascending, order = np.argsort(angle), basis.elem.maxdeg
    corners = angle[ascending][::order]
    above = np.flatnonzero(np.abs(corners) < MIDDLE)  # the middle plane may be held, and then gives way to no pressure
    zone = min(CONTACT_ZONE * contact, float(corners[above[-1]]))
    first = max(int(np.searchsorted(corners, -zone)) - 1, int(above[0]))
    chosen = ascending[first * order :]
    return Surface(
        dofs=dofs[chosen],
        coordinate=angle[chosen],
        normal=np.tile([0.0, 1.0], (chosen.size, 1)),
        measure=lambda angle: np.cos(angle) * _breadth(angle, mean_radius),
        motion=np.ones_like,
        zone=zone,
        dimension=2 if mean_radius is None else 3,
    )


def _breadth(angle: Array, mean_radius: float | None) -> Array:
    """Area of a band over its width seen from above."""
    return both_halves(angle) if mean_radius is None else ring_area(mean_radius + np.sin(angle))


def ring_area(radius: Array) -> Array:
    """2 pi r."""
    return np.asarray(2.0 * np.pi * radius)


def both_halves(coordinate: Array) -> Array:
    """2: the other side of a plane of symmetry counts too."""
    return np.full_like(coordinate, 2.0)
