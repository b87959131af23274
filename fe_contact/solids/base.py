"""What a bulk that is not linear asks of its material."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from fe_contact.assembly.forms import Array

State = tuple[Array, ...]  # what points remember, each (..., elements, points); empty of an elastic material
RADIAL, AXIAL = (0, 1, 4), (2, 3)  # components of the displacement gradient by u_r: rr, rz, tt; by u_z: zr, zz


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
