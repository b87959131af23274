"""The part of a body with inertia that may yield: its points, in numbers of the body in motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Basis, Indices, Matrix
from fe_contact.dynamics.flow import Flowed
from fe_contact.fields import at_nodes
from fe_contact.plastic.ground import GUARD, WIDEST, at_rest, yielding_basis
from fe_contact.plastic.path import PlasticZoneWide
from fe_contact.solids.base import PointAnswer
from fe_contact.solids.bulk import Bulk, Loaded
from lumped.materials.plasticity import GRADIENT, OFTEN, Yielding


@dataclass(frozen=True, eq=False)
class YieldingCore:
    """The ``elements`` (e,) of a mesh that may yield, as material points, SI units: ``bulk`` on N degrees of freedom of
    a body in motion and one that is held; ``basis`` of the mesh in units of its own, with these points.
    """

    bulk: Bulk
    yielding: Yielding
    basis: Basis
    elements: Indices

    @classmethod
    def of(cls, basis: Basis, free: Indices, size: int, unit: float, yielding: Yielding) -> YieldingCore:
        """Of a mesh in units of ``unit`` m, whose degrees of freedom ``free`` are the first of ``size``."""
        pointed = yielding_basis(basis.mesh, basis.elem.maxdeg)
        elements = np.flatnonzero(_distance(pointed) < WIDEST)
        own = Bulk.of(pointed, False, elements)
        numbers = np.full(own.size, size)
        numbers[free] = np.arange(free.size)
        bulk = replace(
            own,
            slopes=own.slopes / unit,
            weight=own.weight * unit**3,
            dofs=numbers[own.dofs],
            size=size + 1,
        )
        return cls(bulk, yielding, pointed, elements)

    @cached_property
    def at_rest(self) -> Flowed:
        """See :class:`fe_contact.dynamics.flow.Yields`."""
        none, (strain, amount) = np.zeros(self.bulk.size - 1), at_rest(self.bulk.weight.shape)
        return Flowed(strain, amount, forces=none, grew=none, stores=0.0, worked=0.0)

    def flowed(self, displacement: Array, before: Flowed) -> Flowed:
        """See :class:`fe_contact.dynamics.flow.Yields`."""
        gradient = self.bulk.gradient(np.append(displacement, 0.0))
        found = self.yielding.flowed(gradient, before.strain, before.amount)
        twice, weight = 2.0 * self.yielding.shear * found.strain, self.bulk.weight
        held = Loaded(self.bulk, PointAnswer(twice[GRADIENT], np.zeros((5, 5)), weight))
        forces = held.forces[:-1]
        return Flowed(
            strain=found.strain,
            amount=found.amount,
            forces=forces,
            grew=forces - before.forces,
            stores=0.5 * float(np.einsum("c,ep,cep,cep->", OFTEN, weight, twice, found.strain)),
            worked=float(np.vdot(weight, self.yielding.worked(found.amount))),
        )

    def softening(self, displacement: Array, before: Flowed) -> Matrix:
        """See :class:`fe_contact.dynamics.flow.Yields`."""
        bulk, yielding = self.bulk, self.yielding
        gradient = bulk.gradient(np.append(displacement, 0.0))
        elastic = replace(yielding, strength=np.inf).flowed(gradient, before.strain, before.amount).tangent
        lost = elastic - yielding.flowed(gradient, before.strain, before.amount).tangent
        entries = Loaded(bulk, PointAnswer(np.zeros_like(gradient), lost, bulk.weight)).matrices()
        rows = np.broadcast_to(bulk.dofs[:, :, None], entries.shape)
        columns = rows.transpose(0, 2, 1)
        whole = sparse.coo_matrix((entries.ravel(), (rows.ravel(), columns.ravel())), shape=(bulk.size, bulk.size))
        return whole.tocsc()[:-1, :-1]

    def check(self, flowed: Flowed, time: float) -> None:
        """See :class:`fe_contact.dynamics.flow.Yields`."""
        if np.any(flowed.amount[self._outer] > 0.0):
            raise PlasticZoneWide(f"t = {time:.3g} s", WIDEST)

    @cached_property
    def _outer(self) -> npt.NDArray[np.bool_]:
        """Elements so near the end of what may yield that it is too small if they do."""
        return _distance(self.basis)[self.elements] > GUARD * WIDEST

    def at_nodes(self, flowed: Flowed) -> tuple[Array, Array]:
        """Stress that plastic strain takes away, (n, 4), Pa, as in :mod:`fe_contact.fields`, and the amount of that,
        (n,), at all nodes of the mesh; zero where nothing may yield.
        """
        held = 2.0 * self.yielding.shear * flowed.strain[[0, 2, 3, 1]]  # rr, zz, hoop, rz
        *taken, amount = at_nodes(self.basis, self.elements, np.concatenate([held, flowed.amount[None]]))
        return np.stack(taken, axis=1), np.maximum(amount, 0.0)


def _distance(basis: Basis) -> Array:
    """Of every element's middle from the first touch."""
    middles = basis.mesh.p[:, basis.mesh.t].mean(axis=1)
    return np.asarray(np.hypot(middles[0], middles[1]))
