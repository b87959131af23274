"""What the meshes share on which a contact may end anywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices
from fe_contact.errors import BodyTooThin
from lumped.shapes import Shape

# Elements along a contact radius where the contact may end anywhere, over those where it may not; a line's pressure
# ends as steeply, but less of its force lies there.
REFINEMENT, LINE_REFINEMENT = 2.5, 2.0
STRUCK_REFINEMENT = 4.0  # the same in an impact: its force must be smooth in time
FAINT = 1e-4  # share of the peak force below which an impact's contact may be resolved less
SPHERE_REFINEMENT = 3.0  # the same on spheres, of which two may touch whose meshes do not match
WIDEST = 1.2  # rad from the first touch: a contact on a circle ends before
MARGIN = 1.35  # largest radius of the fine mesh over that of the contacts expected
WIDEST_THIN = 130.0  # thicknesses of the body that a fine mesh may be wide: its elements shrink with the thickness


@dataclass(frozen=True)
class Zone:
    """Where contacts end: the largest radius, in the target's own places, and the smallest over it."""

    reference: float
    smallest: float

    @classmethod
    def of(cls, radii: Array) -> Zone:
        """Of contact radii, m."""
        reference = MARGIN * float(radii.max())
        return cls(reference, float(radii.min()) / reference)

    @classmethod
    def round(cls, radii: Array, radius: float) -> Zone:
        """Angles on a circle of this radius, of contacts that end so far, m, from the line of motion."""
        angles = np.arcsin(np.minimum(radii / radius, 1.0))
        reference = min(MARGIN * float(angles.max()), WIDEST)
        return cls(reference, min(float(angles.min()) / reference, 1.0))


def thickness_over(width: float, thickness: float) -> float:
    """Thickness of a body over the width of its fine mesh, both m. Raises BodyTooThin."""
    if width > WIDEST_THIN * thickness:
        raise BodyTooThin(width, thickness, WIDEST_THIN)
    return thickness / width


def smallest_struck(shape: Shape) -> float:
    """Contact radius over the largest one below which elements grow no finer: F ~ a^3 of a sphere, else a^2."""
    return math.pow(FAINT, 1.0 / 3.0 if shape.tip_radius is not None and not shape.plane else 0.5)


def held(basis: Basis, along: tuple[str, ...], across: tuple[str, ...]) -> Indices:
    """Degrees of freedom along the surface, and across it, on boundaries by their names."""
    first = [2 * basis.get_dofs(name).flatten() for name in along]
    second = [2 * basis.get_dofs(name).flatten() + 1 for name in across]
    return np.unique(np.concatenate([*first, *second]))
