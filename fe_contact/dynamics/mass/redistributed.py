"""Lumped mass without any at the contact: the surface obeys statics, so that touching it makes no shock.

The mass of a node that may touch goes to the other nodes of its elements. Khenous, Laborde and Renard 2008,
doi:10.1016/j.euromechsol.2008.01.001; Doyen, Ern and Piperno 2011, doi:10.1137/100791440, section 6.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.mass.consistent import Nodes
from fe_contact.dynamics.mass.lumped import shares


def of(local: Array, dofs: Nodes, size: int, contact: Nodes) -> Any:
    """A diagonal that keeps every element's mass, zero at the contact."""
    share = shares(local)
    inside = np.where(np.isin(dofs, contact), 0.0, share)
    inside *= (share.sum(axis=1) / inside.sum(axis=1))[:, None]
    return sparse.diags(np.bincount(dofs.ravel(), inside.ravel(), size)).tocsc()
