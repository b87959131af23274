"""What lies beyond the mesh: springs that carry the static load on, and dashpots that let waves out.

Static: a tensor Robin condition that is exact for a point force on the half-space, or for a line force on the
half-plane. On the outer boundary the traction is ``t = -k u`` with a symmetric 2 x 2 tensor ``k(x)`` chosen so that
Boussinesq's displacement, or Flamant's, meets the traction that belongs to it at every point. What is left decays like
the next moments of the pressure; a fixed boundary would err by about 1.1 contact radii over far radius instead.

In plane strain the displacement of a line force has no value of its own, only a difference between two places: it is
measured from a place far beyond the mesh.

Dynamic: dashpots beside these springs, ``t = -density (c_p n n + c_s s s) v``, n the normal, s along the boundary: no
reflection of what arrives head on (Lysmer and Kuhlemeyer 1969, doi:10.1061/JMCEA3.0001144). With the springs the pair
is nearly the impedance of an expanding wave.
"""

from __future__ import annotations

import math

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Basis, scatter, vector_dofs


def robin(facets: Basis, poisson: float) -> sparse.coo_matrix:
    """Stiffness of the outside on the far boundary for E* = 1, shape (2 N, 2 N).

    Parameters
    ----------
    facets : scalar scikit-fem facet basis of the far boundary, coordinates (r, z) with the body at z < 0.
    poisson : Poisson's ratio.
    """
    position = np.asarray(facets.global_coordinates())
    displacement, traction = boussinesq(position, np.asarray(facets.normals), poisson)
    return springs(facets, displacement, traction, 2 * np.pi * position[0])


def springs(facets: Basis, displacement: Array, traction: Array, measure: Array | float) -> sparse.coo_matrix:
    """Stiffness of ``t = -k u`` with the symmetric k that meets this displacement and traction, shape (2 N, 2 N).

    Both (2, facets, points) on the boundary of ``facets``; ``measure``: area per length of the boundary.
    """
    length = np.hypot(*displacement)
    along = displacement / length
    across = np.stack([-along[1], along[0]])
    direct = -np.einsum("c...,c...", traction, along) / length
    coupling = -np.einsum("c...,c...", traction, across) / length
    tensor = direct * (_outer(along, along) + _outer(across, across))
    tensor += coupling * (_outer(along, across) + _outer(across, along))
    return on_boundary(facets, tensor, measure)


def on_boundary(facets: Basis, tensor: Array, measure: Array | float) -> sparse.coo_matrix:
    """``int u.k v`` over a boundary, k (2, 2, facets, points); shape (2 N, 2 N)."""
    weight = measure * np.asarray(facets.dx)
    value = np.stack([np.broadcast_to(np.asarray(shape[0]), weight.shape) for shape in facets.basis])
    local = np.einsum("ifq,jfq,abfq,fq->fiajb", value, value, tensor, weight, optimize=True)
    functions = 2 * len(facets.basis)
    matrices = local.reshape(len(weight), functions, functions)
    return scatter(matrices, vector_dofs(facets.element_dofs), 2 * facets.N)


def boussinesq(position: Array, normal: Array, poisson: float) -> tuple[Array, Array]:
    """Displacement and traction of a unit point force pressing on the half-space z <= 0 with E* = 1.

    Parameters
    ----------
    position, normal : (r, z) arrays of shape (2, ...); the force acts at the origin along -z.

    Returns
    -------
    displacement, traction on the plane with that normal, both (r, z), shape (2, ...).
    Source: Johnson, Contact Mechanics (1985), (3.18)-(3.19).
    """
    r, depth = position[0], -position[1]
    distance = np.hypot(r, depth)
    shear = (1 - poisson) / 2  # E* = 1: E = 1 - nu^2, G = E / (2 (1 + nu))
    radial = r * depth / distance**3 - (1 - 2 * poisson) * r / (distance * (distance + depth))
    axial = 2 * (1 - poisson) / distance + depth**2 / distance**3
    displacement = np.stack([radial, -axial]) / (4 * np.pi * shear)
    stress_rr = (1 - 2 * poisson) / (distance * (distance + depth)) - 3 * depth * r**2 / distance**5
    stress_rz = 3 * r * depth**2 / distance**5  # z points out of the body, depth into it
    stress_zz = -3 * depth**3 / distance**5
    traction = np.stack([stress_rr * normal[0] + stress_rz * normal[1], stress_rz * normal[0] + stress_zz * normal[1]])
    return displacement, traction / (2 * np.pi)


def _outer(first: Array, second: Array) -> Array:
    return first[:, None] * second[None]


BEYOND = 5.0  # logarithm of where the displacement vanishes on the axis, over the size of the mesh


def plane_robin(facets: Basis, poisson: float) -> sparse.coo_matrix:
    """Stiffness of the outside on the far boundary for E* = 1, per unit length and of both halves, (2 N, 2 N)."""
    position = np.asarray(facets.global_coordinates())
    origin = np.exp(BEYOND) * float(np.hypot(*position).min())
    displacement, traction = flamant(position, np.asarray(facets.normals), poisson, origin)
    return springs(facets, displacement, traction, 2.0)


def flamant(position: Array, normal: Array, poisson: float, origin: float) -> tuple[Array, Array]:
    """Displacement and traction of a unit line force pressing on the half-plane z <= 0 with E* = 1.

    As :func:`boussinesq`, (x, z); ``origin``: the depth below the force that is taken to
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
    return on_boundary(facets, tensor, 2 * np.pi * np.asarray(facets.global_coordinates())[0])


def wave_speeds(poisson: float) -> tuple[float, float]:
    """c_p and c_s for E* = E/(1 - nu^2) = 1 and density 1."""
    shear = (1 - poisson) / 2
    return math.sqrt(shear * (2 - 2 * poisson) / (1 - 2 * poisson)), math.sqrt(shear)
