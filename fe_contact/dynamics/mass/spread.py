"""Lumped mass without any at the contact, made up for by all other nodes alike.

Beside :mod:`~.redistributed` no node near the contact is heavier than its neighbours, so that a sudden touch makes no
peak; but the whole body is heavier than it should be, by the share of the contact's mass.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix
from fe_contact.dynamics.mass.base import Mass
from fe_contact.dynamics.mass.lumped import shares


def of(local: Array, dofs: Indices, size: int, contact: Indices) -> Matrix:
    """A diagonal that keeps the body's mass, zero at the contact."""
    diagonal = np.bincount(dofs.ravel(), shares(local).ravel(), size)
    total = diagonal.sum()
    diagonal[contact] = 0.0
    return sparse.diags(diagonal * (total / diagonal.sum())).tocsc()


MEMBER = Mass(of)
