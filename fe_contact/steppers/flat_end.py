"""A body under an end that no depth widens: all that an impact needs of it is one stiffness, found at rest.

With a constant Poisson's ratio every point remembers in proportion to the depth, so that the force is the stiffness
times the hereditary depth, exactly (Lee and Radok 1960, doi:10.1115/1.3644020), and it ends everywhere at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import Still
from fe_contact.settings import TARGETS, Numerics
from fe_contact.steppers.flat_stepping import FlatStepper
from fe_contact.steppers.march import Snapshot, Strike
from fe_contact.steppers.steps import Stepping
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.schema.members import get

SHALLOW = 1e-3  # depth over radius: every answer is in proportion


@dataclass(frozen=True)
class FlatEnd:
    """``stiffness``: force per depth for unit modulus, m; ``radius`` of the contact, m.

    The contract of :class:`fe_contact.steppers.struck.Struck`; ``mesh_order`` as of
    :class:`fe_contact.bodies.pressing.Still`.
    """

    stiffness: float
    radius: float
    degrees_of_freedom: int
    mesh_order: float
    breathes: bool = False
    recovers: bool = True
    factorizations: int = 1
    solves: int = 1

    @classmethod
    def of(cls, geometry: Geometry, radius: float, numerics: Numerics) -> FlatEnd:
        """Pressed once, at rest. Raises NotReached."""
        indenter = Indenter(geometry.shape, geometry.material, geometry.target)
        still: Still = get(TARGETS, geometry.target.name).still(indenter, np.array([radius]), numerics)
        depth = SHALLOW * radius
        force = still.press(depth, radius).force
        return cls(force / depth, radius, still.degrees_of_freedom, still.mesh_order)

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps in closed form."""
        return FlatStepper(strike, self.stiffness, self.radius, numerics)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """What the snapshot says, of which its stepper takes none."""
        return snapshot.radii, snapshot.pressure
