"""The outside of a layer that slides on its base: far from the contact a plate in plane stress, u_r ~ 1/r."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.far_field import on_boundary


def robin(facets: Any, shear: float) -> sparse.coo_matrix:
    """Radial springs E/((1 + nu) r) = 2 G/r on the layer's side, of the shear modulus alone, shape (2 N, 2 N)."""
    radius = np.asarray(facets.global_coordinates())[0]
    tensor = np.zeros((2, 2, *radius.shape))
    tensor[0, 0] = 2.0 * shear / radius
    return on_boundary(facets, tensor, 2 * np.pi * radius)
