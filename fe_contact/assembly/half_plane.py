"""The half-plane's outside: springs that are exact for a line force, measured from a place far beyond the mesh.

In plane strain the displacement of a line force has no value of its own, only a difference between two places.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.far_field import springs
from fe_contact.assembly.forms import Array, Basis

BEYOND = 5.0  # logarithm of where the displacement vanishes on the axis, over the size of the mesh


def robin(facets: Basis, poisson: float) -> sparse.coo_matrix:
    """Stiffness of the outside on the far boundary for E* = 1, per unit length and of both halves, (2 N, 2 N)."""
    position = np.asarray(facets.global_coordinates())
    origin = np.exp(BEYOND) * float(np.hypot(*position).min())
    displacement, traction = flamant(position, np.asarray(facets.normals), poisson, origin)
    return springs(facets, displacement, traction, 2.0)


def flamant(position: Array, normal: Array, poisson: float, origin: float) -> tuple[Array, Array]:
    """Displacement and traction of a unit line force pressing on the half-plane z <= 0 with E* = 1.

    As :func:`fe_contact.assembly.far_field.boussinesq`, (x, z); ``origin``: the depth below the force that is taken to
    be at rest. Johnson, Contact Mechanics (1985), (2.15), (2.19).
    """
    x, depth = position[0], -position[1]
    distance, angle = np.hypot(x, depth), np.arctan2(x, depth)
    sine, cosine = np.sin(angle), np.cos(angle)
    far = np.log(origin / distance)
    side = (1.0 - 2.0 * poisson) / (1.0 - poisson)
    radial = 2.0 * cosine * far - side * angle * sine
    turning = -2.0 * sine * far + (2.0 * poisson / (1.0 - poisson) + side) * sine - side * angle * cosine
    displacement = np.stack([radial * sine + turning * cosine, -(radial * cosine - turning * sine)]) / np.pi
    direction = np.stack([sine, -cosine])
    stress = -2.0 * cosine / (np.pi * distance)
    return displacement, stress * direction * np.einsum("c...,c...", direction, normal)
