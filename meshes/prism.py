"""The upper half of a round block, from its axis to its side."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from meshes.triangles import checked, elements_checked
from meshes.washer import rectangle

if TYPE_CHECKING:
    from skfem import MeshTri

NEAR = 2.0  # shorter sides from face and side within which triangles are well shaped: what ends there decays as fast


def prism(elements: float, half_height: float, sharp: bool) -> MeshTri:
    """Triangles of ``0 <= r <= 1``, ``-half_height <= z <= 0``, the longer the farther they lie from (1, 0).

    Parameters
    ----------
    elements : along the shorter side, 0.5 to 200.
    half_height : over the radius, 1e-4 to 1e4.
    sharp : whether the corner (1, 0) is graded to, as its stress is singular where face meets side.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``base`` (the middle plane), ``inside`` (the
    axis), ``outside``.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n = elements_checked("the shorter side", elements, 0.5, 200.0)
    half_height = checked("half of the height over the radius", half_height, 1e-4, 1e4)
    near = NEAR * min(half_height, 1.0)
    width, height = (_drawn_in(side, near) for side in (1.0, half_height))
    mesh = rectangle(1.0 - width, 1.0, height, (), ((1.0, 0.0),) if sharp else (), n)
    r, z = mesh.doflocs
    return replace(mesh, doflocs=np.array([1.0 - _drawn_out(1.0 - r, near), -_drawn_out(-z, near)]))


def _drawn_in(distance: float, near: float) -> float:
    """A distance that beyond ``near`` counts by its logarithm."""
    return min(distance, near) * (1.0 + math.log(max(distance / near, 1.0)))


def _drawn_out(distance: npt.NDArray[np.float64], near: float) -> npt.NDArray[np.float64]:
    """The other way round."""
    return np.minimum(distance, near) * np.exp(np.maximum(distance / near - 1.0, 0.0))
