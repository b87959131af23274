"""How many stages a step of central difference needs: 2/omega_max, bounded without an eigenvalue."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.body import Body
from fe_contact.dynamics.pressed import Enforced
from lumped.errors import BadInput, Fault

ROUNDING = 1e-9  # of a stage that just keeps the limit


def stages(body: Body, enforced: Enforced, step: float) -> int:
    """Equal parts of a ``step``, s, none longer than :func:`safe_step`. Raises BadInput as that does."""
    return max(math.ceil(step / safe_step(body, enforced) * (1 - ROUNDING)), 1)


def safe_step(body: Body, enforced: Enforced) -> float:
    """s, at most 2/omega_max, where omega_max^2 <= max_i sum_j |K_ij| / m_i (Gershgorin), K with every contact closed.

    A mass that couples its nodes stands for the diagonal m_i = M_ii - sum of |M_ij|, which it exceeds; degrees of
    freedom without mass are held, which stiffens the others. Raises BadInput where some m_i is not positive.
    """
    heavy = body.massive
    moduli = [part.relaxation.glassy * abs(part.stiffness.tocsr()[heavy][:, heavy]) for part in body.parts]
    pull = sum(_rows(modulus) for modulus in moduli)
    if enforced.is_law:
        seen = abs(sparse.csr_matrix(body.pressing.trace) @ body.pressing.push.T.tocsr()).tocsc()[:, heavy]
        pull = pull + seen.T @ (enforced.penalty * body.pressing.weights * _rows(seen))
    inertia = body.inertia.tocsr()[heavy][:, heavy]
    mass = 2 * inertia.diagonal() - _rows(abs(inertia))
    if mass.min() <= 0.0:
        reason = '"staged" needs a mass that hardly couples its nodes; accepted: lumped, redistributed, spread'
        raise BadInput(Fault("numerics", "mass", reason))
    return float(2.0 / np.sqrt(np.max(pull / mass)))


def _rows(matrix: Any) -> Array:
    """Sums of a sparse matrix's rows."""
    return np.asarray(matrix.sum(axis=1)).ravel()
