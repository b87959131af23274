"""What moves: a linear body by its matrices, and the places where it may be pressed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Matrix
from lumped.materials import Relaxation


@dataclass(frozen=True, eq=False)
class Part:
    """Stiffness (N, N) per unit modulus, symmetric, and the modulus as a function of time.

    A constant Poisson's ratio needs one part; a constant bulk modulus two, volume and shape.
    """

    stiffness: Matrix
    relaxation: Relaxation


@dataclass(frozen=True, eq=False)
class Pressing:
    """Places of contact: overlap = ``clearance`` - trace push^T u at the points, where u = 0 is the undeformed body.

    ``push`` (N, m) nodal forces of unit surface forces, sparse; ``trace`` (q, m) surface displacement at the points;
    ``weights`` (q,) area of the points; ``clearance`` (q,) overlap there without displacement, m, negative if open;
    ``carriers`` (q, k) shape functions of a pressure that two bodies can follow, None of one.
    A rigid striker is one more degree of freedom, its depth: ``push`` -1, ``trace`` 1 for all points.
    """

    push: Matrix
    trace: Array
    weights: Array
    clearance: Array
    carriers: Array | None = None

    def overlap(self, displacement: Array) -> Array:
        """Interpenetration at the points, (q,), m, positive inside."""
        return np.asarray(self.clearance - self._seen @ displacement)

    def closing(self, velocity: Array) -> Array:
        """Rate of the overlap, (q,), m/s."""
        return np.asarray(-(self._seen @ velocity))

    def forces(self, pressure: Array) -> Array:
        """Surface forces (m,), N, of a pressure (q,), Pa."""
        return np.asarray(self.trace.T @ (self.weights * pressure))

    def load(self, pressure: Array) -> Array:
        """Nodal forces (N,), N, of a pressure (q,), Pa."""
        return np.asarray(self.push @ self.forces(pressure))

    @cached_property
    def _seen(self) -> Matrix:
        """Displacement at the points of that of the body, sparse (q, N)."""
        return sparse.csr_matrix(self.trace) @ self.push.T.tocsr()


@dataclass(frozen=True, eq=False)
class BodyWithMass:
    """Everything that moves in one scene, N degrees of freedom, SI units.

    ``mass`` (N, N) of the deformable bodies, sparse, may have zero rows; ``rigid`` (N,) that of rigid bodies;
    ``parts`` their stiffness; ``dashpots`` (N, N) that carry waves away, sparse, or None; ``gravity`` (N,) acceleration
    of free fall, m/s2; ``pressing`` where contact may be.
    """

    mass: Matrix
    rigid: Array
    parts: tuple[Part, ...]
    dashpots: Matrix
    gravity: Array
    pressing: Pressing

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return int(self.rigid.size)

    @property
    def is_elastic(self) -> bool:
        """Whether no part has a memory or a viscosity."""
        return all(part.relaxation.is_elastic for part in self.parts)

    @cached_property
    def inertia(self) -> Matrix:
        """All of the mass, sparse (N, N)."""
        return (self.mass + sparse.diags(self.rigid)).tocsc()

    @cached_property
    def weight(self) -> Array:
        """Nodal forces of gravity, (N,): where no mass is, none acts, so that a free fall does not strain."""
        return np.asarray(self.inertia @ self.gravity)

    @cached_property
    def damping(self) -> Matrix:
        """Force per velocity, (N, N): dashpots and the parallel viscosities of the material; None without any."""
        found = [p.relaxation.viscosity * p.stiffness for p in self.parts if p.relaxation.viscosity > 0.0]
        if self.dashpots is not None:
            found.append(self.dashpots)
        return sum(found[1:], found[0]).tocsc() if found else None

    @cached_property
    def massive(self) -> npt.NDArray[np.intp]:
        """Degrees of freedom that have mass."""
        return np.flatnonzero(self.inertia.diagonal() > 0.0)

    @cached_property
    def massless(self) -> npt.NDArray[np.intp]:
        """Degrees of freedom that obey statics."""
        return np.flatnonzero(self.inertia.diagonal() == 0.0)
