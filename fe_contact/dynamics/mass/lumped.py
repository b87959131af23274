"""Mass at the nodes alone, in proportion to the diagonal of the consistent one: makes waves too slow.

Hinton, Rock and Zienkiewicz 1976, doi:10.1002/eqe.4290040305: positive for every element order.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix
from fe_contact.dynamics.mass.base import Mass


def of(local: Array, dofs: Indices, size: int, contact: Indices) -> Matrix:
    """A diagonal that keeps every element's mass."""
    return sparse.diags(np.bincount(dofs.ravel(), shares(local).ravel(), size)).tocsc()


def shares(local: Array) -> Array:
    """Mass of every element's nodes, (e, k), kg."""
    diagonal = np.einsum("ekk->ek", local)
    return np.asarray(diagonal * (local.sum(axis=(1, 2)) / diagonal.sum(axis=1))[:, None])


MEMBER = Mass(of)
