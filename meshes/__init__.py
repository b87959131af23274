"""Geometry without physics: numbers in, tagged mesh out.

One target's mesh a file. Every function returns a :class:`skfem.MeshTri`, or of a rod a MeshLine, with named
boundaries and raises :class:`meshes.errors.MeshError`; nothing here knows a material or a load.
"""

from meshes.cylinder import cylinder
from meshes.errors import GmshMissing, MeshError
from meshes.half_space import half_space, half_space_for_waves
from meshes.layer import layer, layer_for_waves, layer_under_rim
from meshes.o_ring import o_ring
from meshes.prism import prism
from meshes.ring import ring
from meshes.rod import rod
from meshes.sphere import sphere
from meshes.washer import washer

__all__ = [
    "GmshMissing",
    "MeshError",
    "cylinder",
    "half_space",
    "half_space_for_waves",
    "layer",
    "layer_for_waves",
    "layer_under_rim",
    "o_ring",
    "prism",
    "ring",
    "rod",
    "sphere",
    "washer",
]
