"""Dynamic far field: dashpots that let plane waves out, beside the springs that carry the static load.

On the outer boundary the traction is ``t = -density (c_p n n + c_s s s) v``, n the normal, s along the boundary: no
reflection of what arrives head on (Lysmer and Kuhlemeyer 1969, doi:10.1061/JMCEA3.0001144). The springs are those of
:mod:`fe_contact.assembly.far_field`; with them the pair is nearly the impedance of an expanding wave.
"""

from __future__ import annotations

import math

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly import far_field as static
from fe_contact.assembly.forms import Basis


def dashpots(facets: Basis, poisson: float) -> sparse.coo_matrix:
    """Force over velocity on the far boundary for E* = 1 and density 1, shape (2 N, 2 N).

    Parameters
    ----------
    facets : scalar scikit-fem facet basis of the far boundary, coordinates (r, z).
    poisson : Poisson's ratio.
    """
    normal = np.asarray(facets.normals)
    along = np.stack([-normal[1], normal[0]])
    pressure, shear = wave_speeds(poisson)
    tensor = pressure * normal[:, None] * normal[None] + shear * along[:, None] * along[None]
    return static.on_boundary(facets, tensor, 2 * np.pi * np.asarray(facets.global_coordinates())[0])


def wave_speeds(poisson: float) -> tuple[float, float]:
    """c_p and c_s for E* = E/(1 - nu^2) = 1 and density 1."""
    shear = (1 - poisson) / 2
    return math.sqrt(shear * (2 - 2 * poisson) / (1 - 2 * poisson)), math.sqrt(shear)
