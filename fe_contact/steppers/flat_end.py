"""A body under an end that no depth widens: all that an impact needs of it is one stiffness, found at rest.

With a constant Poisson's ratio every point remembers in proportion to the depth, so that the force is the stiffness
times the hereditary depth, exactly (Lee and Radok 1960, doi:10.1115/1.3644020), and it ends everywhere at once.

One time step of an impact by a flat end: its area touches at once, so that depth alone remembers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.bodies.memory import SurfaceMemory
from fe_contact.bodies.pressing import Still
from fe_contact.contact.problem import ContactSolution
from fe_contact.errors import ContactLost
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import Inertia, OfSurface, Snapshot, State, Step, Stepping, Strike, Work
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter

SHALLOW = 1e-3  # depth over radius: every answer is in proportion
TOUCHING = ContactSolution(np.ones(1), 0, True, (np.ones(1, dtype=bool),))

Pressing = Callable[[Indenter, Array, Numerics], Still]  # at rest; radii of the contacts expected, m


@dataclass(frozen=True)
class FlatEnd:
    """``stiffness``: force per depth for unit modulus, m; ``radius`` of the contact, m. Alike are those on one mesh.

    The contract of :class:`fe_contact.steppers.struck.Struck`; ``mesh_order`` and ``operator`` as of
    :class:`fe_contact.bodies.pressing.Still`.
    """

    stiffness: float = field(compare=False)
    radius: float
    degrees_of_freedom: int
    mesh_order: float
    operator: SurfaceOperator | None = None
    follows_contact: bool = False
    factorizations: int = 1

    @classmethod
    def of(cls, geometry: Geometry, radius: float, numerics: Numerics, pressed: Pressing) -> FlatEnd:
        """Pressed once, at rest, as the target says. Raises NotReached."""
        indenter = Indenter(geometry.shape, geometry.material, geometry.target)
        still = pressed(indenter, np.array([radius]), numerics)
        depth = SHALLOW * radius
        force = still.press(depth, radius).force
        return cls(force / depth, radius, still.degrees_of_freedom, still.mesh_order, still.operator)

    @property
    def solves(self) -> int:
        """One a node of the contact zone; one of a block, which is pressed as a whole."""
        return 1 if self.operator is None else len(self.operator.stiffness)

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps in closed form."""
        return FlatStepper(strike, self.stiffness, self.radius, numerics)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """What the snapshot says, of which its stepper takes none."""
        return snapshot.radii, snapshot.pressure


class FlatStepper(OfSurface):
    """Takes steps, each in closed form: the contract of :class:`fe_contact.steppers.steps.Stepping`.

    ``stiffness``: force per depth for unit modulus, m; ``radius`` of the contact, m.
    """

    shortest = 1e-7  # the force falls straight to zero: what is left of it then is below every tolerance

    def __init__(self, strike: Strike, stiffness: float, radius: float, numerics: Numerics) -> None:
        self.strike, self.stiffness, self.radius, self.numerics = strike, stiffness, radius, numerics
        self.relaxation, self.scheme = strike.relaxation, SCHEMES.get(numerics.scheme)
        self.first_force = stiffness * (self.relaxation.viscosity * strike.velocity + self._held(self.touch().memory))

    def at_rest(self) -> SurfaceMemory:
        """Of depth and force, at the one place."""
        return SurfaceMemory.at_rest(np.ones(1), self.relaxation, fields=2)

    def standing(self) -> int:
        """The one place there is."""
        return 0

    def clearance(self, surface: SurfaceMemory, depth: float) -> Array:
        """Gap of the surfaces, m, (1,)."""
        return np.asarray(surface.strain[0] - depth)

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s: force = stiffness (now depth + past), depth = free depth - give force.

        Raises ContactLost where the body would have to pull.
        """
        strike, law = self.strike, self.law(length)
        carried = state.memory.carried(law)
        inertia = Inertia.of(strike, self.scheme, state, length)
        yielding = 1.0 + self.stiffness * law.now * inertia.lever / strike.mass
        response = (law.now * inertia.free_depth + float(carried[0, 0])) / yielding
        if response <= 0.0:
            raise ContactLost(state.time)
        force = self.stiffness * response
        strain = inertia.depth(force) * np.array([[1.0], [self.stiffness]])
        moved = inertia.moved(force, state.memory.advanced(law, strain))
        found_at = state.time + length * self.scheme.sample
        return Step(length, moved, force, self.radius, found_at, response, TOUCHING, self.radius, Work(1, 1, 1))

    def snapshots(self, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
        """None: the pressure is that of the indentation, infinite at a rim."""
        return ()

    def _held(self, memory: SurfaceMemory) -> float:
        """What the springs press with, Pa m, which a dashpot alone holds back until touch."""
        relaxation, strain = self.relaxation, memory.strain[0, 0]
        return float(relaxation.equilibrium * strain + np.array(relaxation.moduli) @ memory.branches[:, 0, 0])

    def between(self, before: State, step: Step) -> float:
        """None: all places stay in touch, and the penalty's softness is in the stiffness."""
        return 0.0
