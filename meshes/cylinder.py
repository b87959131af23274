"""Half of a cylinder's section, one side of the plane of symmetry: the half disc that is half of a sphere's."""

from meshes.sphere import sphere as cylinder

__all__ = ["cylinder"]
