"""Geometry without physics: numbers in, tagged mesh out.

One target's mesh a file. Every function returns a :class:`skfem.MeshTri` with named boundaries and
raises :class:`meshes.errors.MeshError`; nothing here knows a material or a load.
"""

from meshes.errors import GmshMissing, MeshError
from meshes.half_space import half_space
from meshes.layer import layer, layer_under_rim
from meshes.ring import ring

__all__ = ["GmshMissing", "MeshError", "half_space", "layer", "layer_under_rim", "ring"]
