"""The sides of a contact with inertia: deformable bodies under one pressure at common points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing


@dataclass(frozen=True, eq=False)
class WaveSide:
    """One of the bodies, n degrees of freedom of its own, SI units; its axis points out of it at the first touch.

    ``mass``, ``dashpots`` (or None) and the stiffness of its ``parts`` sparse (n, n); ``push`` (n, m) nodal forces of
    unit surface forces, ``trace`` (q, m) from its surface nodes to the points; ``axial`` (n,) one along its axis, zero
    throughout for a body that does not fly.
    """

    mass: Matrix
    parts: tuple[Part, ...]
    dashpots: Matrix
    push: Matrix
    trace: Array
    axial: Array

    @classmethod
    def struck(cls, body: BodyWithMass) -> WaveSide:
        """All of a body but the rigid striker, its last degree of freedom and the last of its surface."""
        rest = slice(None, -1)
        return cls(
            mass=body.mass[rest, rest],
            parts=tuple(Part(part.stiffness[rest, rest], part.relaxation) for part in body.parts),
            dashpots=None if body.dashpots is None else body.dashpots[rest, rest],
            push=body.pressing.push[rest, rest],
            trace=body.pressing.trace[:, rest],
            axial=np.zeros(body.size - 1),
        )

    @property
    def size(self) -> int:
        """Degrees of freedom."""
        return int(self.axial.size)

    @cached_property
    def mean(self) -> Array:
        """(n,): weights of all displacements in that of its centre of mass along the axis; none where it rests."""
        carried = (self.mass @ self.axial) * self.axial
        return np.asarray(carried / (carried.sum() or 1.0))

    def among(self, before: int, after: int) -> WaveSide:
        """The same among so many degrees of freedom of others, which it does not feel."""
        return replace(
            self,
            mass=_among(self.mass, before, after),
            parts=tuple(Part(_among(part.stiffness, before, after), part.relaxation) for part in self.parts),
            dashpots=None if self.dashpots is None else _among(self.dashpots, before, after),
            push=sparse.vstack([_none(before, self.push.shape[1]), self.push, _none(after, self.push.shape[1])]),
            axial=np.concatenate([np.zeros(before), self.axial, np.zeros(after)]),
        )


def together(
    sides: Sequence[WaveSide], gravity: float, weights: Array, clearance: Array, carriers: Array | None
) -> BodyWithMass:
    """One body of all sides, one after the other; ``gravity``, m/s2, pulls the first; areas and overlaps (q,).

    ``carriers``: what the pressure between two of them is made of, as in Pressing.
    """
    ends = np.cumsum([side.size for side in sides])
    placed = [side.among(end - side.size, ends[-1] - end) for side, end in zip(sides, ends, strict=True)]
    dashpots = [side.dashpots for side in placed if side.dashpots is not None]
    return BodyWithMass(
        mass=sum(side.mass for side in placed).tocsc(),
        rigid=np.zeros(ends[-1]),
        parts=tuple(part for side in placed for part in side.parts),
        dashpots=sum(dashpots[1:], dashpots[0]).tocsc() if dashpots else None,
        gravity=gravity * placed[0].axial,
        pressing=Pressing(
            push=sparse.hstack([side.push for side in placed]).tocsc(),
            trace=np.hstack([side.trace for side in sides]),
            weights=weights,
            clearance=clearance,
            carriers=carriers,
        ),
    )


def _among(matrix: Matrix, before: int, after: int) -> Matrix:
    return sparse.block_diag([_none(before, before), matrix, _none(after, after)]).tocsc()


def _none(rows: int, columns: int) -> sparse.csc_matrix:
    return sparse.csc_matrix((rows, columns))
