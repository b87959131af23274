"""What a bulk that is not linear asks of its material."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from fe_contact.assembly.forms import Array

State = tuple[Array, ...]  # what points remember, each (..., elements, points); empty of an elastic material
RADIAL, AXIAL = (0, 1, 4), (2, 3)  # components of the displacement gradient by u_r: rr, rz, tt; by u_z: zr, zz
DIRECTIONS = 16  # of waves in the plane


@dataclass(frozen=True, eq=False)
class PointAnswer:
    """What material points answer to a displacement gradient of components (rr, rz, zr, zz, tt).

    ``stress`` (5, ...), first Piola-Kirchhoff's, of small strains Cauchy's, Pa; ``tangent`` its derivative (5, 5, ...),
    symmetric; ``energy`` (...), J/m3, whose derivative the stress is, infinite where the material cannot be; ``state``
    what the points remember at the end of the step. ``pulls`` (2, ...) and ``drifts`` (2, 5, ...) as of
    :class:`lumped.materials.energies.base.Strained`, None of small strains.
    """

    stress: Array
    tangent: Array
    energy: Array
    state: State = field(default=())
    pulls: Array | None = None
    drifts: Array | None = None


class Response(Protocol):
    """A material at every point of a body: a law and its numbers."""

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        """To a displacement gradient (5, elements, points) after ``state``; in plane strain its last row is zero."""


def elliptic(tangent: Array) -> bool:
    """Whether points of a ``tangent`` (5, 5, ...) bear waves of every direction N in the plane: N A N is definite.

    Where one does not, equations of equilibrium change their kind, and strains gather in bands as thin as elements are.
    """
    angle = np.linspace(0.0, np.pi, DIRECTIONS, endpoint=False).reshape(-1, *(1,) * (tangent.ndim - 2))
    along, across = np.cos(angle), np.sin(angle)

    def borne(row: int, column: int) -> Array:
        """Of the rows rr, rz or zr, zz, and of such columns."""
        block = tangent[row : row + 2, column : column + 2]
        mixed = along * across * (block[0, 1] + block[1, 0])
        return np.asarray(along**2 * block[0, 0] + mixed + across**2 * block[1, 1])

    radial, axial = borne(0, 0), borne(2, 2)
    return bool(np.all((radial > 0.0) & (radial * axial > borne(0, 2) ** 2)))
