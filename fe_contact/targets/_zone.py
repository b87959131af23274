"""What the meshes share on which a contact may end anywhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fe_contact.forms import Array
from lumped.shapes import Shape

REFINEMENT = 4.0  # elements along a contact radius where the contact may end anywhere, over those where it may not
LARGEST, SMALLEST = 1.6, 0.4  # contact radius over the one at which the undeformed surfaces overlap, in any body


@dataclass(frozen=True)
class Zone:
    """The reference radius, in the target's own places, and the smallest contact over it."""

    reference: float
    smallest: float

    @classmethod
    def of(cls, shape: Shape, overlapping: Array) -> Zone:
        """From the places where the undeformed surfaces overlap at the depths to come."""
        if shape.fixed_radius is not None:
            return cls(shape.fixed_radius, 1.0)
        reference = LARGEST * float(overlapping.max())
        return cls(reference, min(SMALLEST * float(overlapping.min()) / reference, 1.0))


def held(basis: Any, along: tuple[str, ...], across: tuple[str, ...]) -> npt.NDArray[np.integer[Any]]:
    """Degrees of freedom along the surface, and across it, on boundaries by their names."""
    first = [2 * basis.get_dofs(name).flatten() for name in along]
    second = [2 * basis.get_dofs(name).flatten() + 1 for name in across]
    return np.unique(np.concatenate([*first, *second]))
