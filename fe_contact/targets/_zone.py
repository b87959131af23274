"""What the meshes share on which a contact may end anywhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fe_contact.forms import Array

# Elements along a contact radius where the contact may end anywhere, over those where it may not; a line's pressure
# ends as steeply, but less of its force lies there.
REFINEMENT, LINE_REFINEMENT = 2.5, 2.0
MARGIN = 1.35  # largest radius of the fine mesh over that of the contacts expected


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


def held(basis: Any, along: tuple[str, ...], across: tuple[str, ...]) -> npt.NDArray[np.integer[Any]]:
    """Degrees of freedom along the surface, and across it, on boundaries by their names."""
    first = [2 * basis.get_dofs(name).flatten() for name in along]
    second = [2 * basis.get_dofs(name).flatten() + 1 for name in across]
    return np.unique(np.concatenate([*first, *second]))
