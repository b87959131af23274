"""Lumped mass without any at the contact: the surface obeys statics, so that touching it makes no shock.

The mass of a node that may touch goes to the other nodes of its elements. Khenous, Laborde and Renard 2008,
doi:10.1016/j.euromechsol.2008.01.001; Doyen, Ern and Piperno 2011, doi:10.1137/100791440, section 6.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix
from fe_contact.dynamics.mass.base import Mass
from fe_contact.dynamics.mass.lumped import shares


def of(local: Array, dofs: Indices, size: int, contact: Indices) -> Matrix:
    """A diagonal that keeps every element's mass, zero at the contact."""
    share = shares(local)
    inside = np.where(np.isin(dofs, contact), 0.0, share)
    inside *= (share.sum(axis=1) / inside.sum(axis=1))[:, None]
    return sparse.diags(np.bincount(dofs.ravel(), inside.ravel(), size)).tocsc()


MEMBER = Mass(of)
