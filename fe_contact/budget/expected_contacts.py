"""How large slow contacts will be, about: what meshes are made for. It enters no value."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import Still
from fe_contact.settings import TARGETS, Numerics
from lumped.scene.indenter import Indenter
from lumped.schema.members import get

BISECTIONS = 40
SMALL = 1e-3  # radius, in depths, from which the search for the overlap's end begins
SCOUTING, SCOUTING_ORDER = 2.0, 2  # elements along the contact radius that tell how large contacts will be
LEAST_SHARE, LARGEST_SHARE = 0.4, 2.0  # contact radius over the one at which the undeformed surfaces overlap


def expected(indenter: Indenter, depth: Array, numerics: Numerics) -> Array:
    """Contact radii which the meshes are made for, m, shape (n,); they enter no value.

    Where the undeformed surfaces overlap, times what a coarse mesh finds of it at the extreme depths.
    """
    overlapping = _overlapping(indenter, depth)
    if indenter.target.fixed_radius(indenter.shape) is not None or not indenter.target.has_length:
        return overlapping
    ends = [int(depth.argmin()), int(depth.argmax())]
    coarse = numerics.varied(elements_per_contact=SCOUTING, order=SCOUTING_ORDER)
    reach = overlapping[ends] * np.array([LEAST_SHARE, LARGEST_SHARE])
    body: Still = get(TARGETS, indenter.target.name).still(indenter, reach, coarse)
    found = [body.press(float(depth[i]), float(overlapping[i])).contact_radius for i in ends]
    share = np.interp(np.log(depth), np.log(depth[ends]), np.log(found / overlapping[ends]))
    return np.asarray(overlapping * np.exp(share))


def _overlapping(indenter: Indenter, depth: Array) -> Array:
    """Length on the target up to which the undeformed surfaces overlap at each depth, m, by bisection; shape (n,)."""
    target, profile = indenter.target, indenter.profile
    fixed = target.fixed_radius(indenter.shape)
    if fixed is not None:
        return np.full_like(depth, fixed)
    low, high = np.zeros_like(depth), SMALL * depth / target.length_of_place
    while np.any(touched := target.overlap(profile, high, depth) > 0.0):
        high = np.where(touched, 2.0 * high, high)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        touched = target.overlap(profile, middle, depth) > 0.0
        low, high = np.where(touched, middle, low), np.where(touched, high, middle)
    return target.length_of_place * high
