"""Sparse symmetric factorisation, the same everywhere."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import scipy.sparse.linalg as linalg

from fe_contact.forms import Array


def factorized(matrix: Any) -> Callable[[Array], Array]:
    """Back-substitution for a symmetric positive definite sparse matrix, of one right-hand side or several."""
    factor = linalg.splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    solve: Callable[[Array], Array] = factor.solve
    return solve
