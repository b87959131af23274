"""The contract of a law: a force between two masses, or what time does to a load curve; what a law asks of a scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Protocol

from lumped.errors import BadInput, Fault
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema.keys import Key, Sets
from lumped.targets import HalfSpace

if TYPE_CHECKING:  # most scenes are solved by one law, which loads what it needs
    from lumped.laws._damping import Family
    from lumped.solvers.hereditary.pieces import Followed


class Law(Protocol):
    """A force law with everything it took from its scene: a frozen dataclass. `needs_mass`: it moves a rigid mass."""

    name: ClassVar[str]
    needs_mass: ClassVar[bool]

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene; every claimed error is the integration error of this law. Raises NotReached."""


def own_spring(scene: Scene) -> str:
    """What a law with a spring and a damper of its own leaves out of a scene with a geometry."""
    return "shape and material: its spring and its damper are its own"


@dataclass(frozen=True)
class LawKind:
    """A member of this folder: how its Law is made `of` a scene, what it `says`, the `groups` of its `[law]` keys.

    `family`: its own damping against the coefficient of restitution; None: without damping, or with another law's.
    `leaves_out`: what it does not follow of the resolved model of a scene with a geometry that it answers, in words;
    empty where it is the exact impact of that model. `seconds`: processor time, s, of an impact to 1e-3, about.
    `elastic`: whether it is for an elastic material alone.
    """

    of: Callable[[Scene], Law]
    says: str | None
    groups: Sets = ()
    family: Family | None = None
    leaves_out: Callable[[Scene], str] = own_spring
    seconds: float = 0.005  # as measured of the packaged scenes that name such a law: it ranks methods, no more
    elastic: bool = False

    @cached_property
    def keys(self) -> Mapping[str, Key]:
        """Those of its `[law]` table."""
        return {name: key for group in self.groups for name, key in group.items()}

    @property
    def sets(self) -> Sets:
        """One."""
        return (self.keys,)

    @property
    def summary(self) -> str:
        """It in one line."""
        return (self.says or "").splitlines()[0]


def simulate(model: Law, scene: Scene, tolerance: float = 1e-6) -> Result:
    """The impacts of a scene under the law `model`, every ruled quantity to `tolerance`.

    Raises NotReached, or BadInput for a scene that the law has no answer for. A study of many impacts needs a function
    of its own, and a pool::

        def restitution(speed: float) -> float | None:
            scene = Scene.load("steel-ball-sls", {"striker.velocity": speed})
            return simulate(laws.correspondence.of(scene), scene, 1e-3).quantities["restitution"].value

        with concurrent.futures.ProcessPoolExecutor() as pool:
            found = list(pool.map(restitution, numpy.linspace(0.1, 2.0, 10_000), chunksize=100))
    """
    from lumped.solvers.hereditary.pieces import alone

    return alone(simulation(model, scene, tolerance))


def simulation(model: Law, scene: Scene, tolerance: float, dense: bool = True) -> Followed[Result]:
    """As :func:`simulate`; by pieces, where a law has memory: those of many impacts are solved together.

    Not `dense`: such a law's history has the rows of its integration alone, for quantities are all that is asked.
    """
    from lumped.laws._hereditary import HereditaryLaw

    if model.needs_mass:
        check_mass(scene)
    with scene.addressed():
        if isinstance(model, HereditaryLaw):
            return (yield from model.simulation(scene, tolerance, dense))
        return model.simulate(scene, tolerance)


def check_mass(scene: Scene) -> None:
    """Raise BadInput for a striker without a rigid mass."""
    if scene.mass == 0.0:
        reason = "0: a lumped law moves a rigid mass; accepted: more, or --method fe"
        raise BadInput(Fault(scene.source, "striker.mass", reason))


def waves(scene: Scene) -> str:
    """What an elastic law of small displacements without inertia leaves out of a scene, where that has any of it."""
    if scene.model.finite:
        return "large strains, which model.kinematics asks for"
    if scene.model.plasticity:
        return "plastic flow, which model.plasticity asks for"
    return "waves in the bodies, which have inertia here" if scene.model.inertia else ""


def check_geometry(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry."""
    if not scene.has_geometry:
        reason = f"missing; the law {name} follows from the striker's shape and the target's material"
        raise BadInput(Fault(scene.source, "striker.shape", reason))


def check_load_curve(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry, and where no load curve of its target is known."""
    check_geometry(scene, name)
    with scene.addressed():
        _ = scene.load_curve


def check_half_space(scene: Scene, name: str, otherwise: str = "") -> None:
    """Raise BadInput for a geometry which is not that of a half-space under an axisymmetric profile.

    `otherwise`: how else the law can be asked.
    """
    if scene.shape is not None and (not isinstance(scene.target, HalfSpace) or scene.shape.plane):
        reason = f"{name} is not for this {scene.target.name}, but for the half-space{otherwise}"
        reason += "; accepted: half_space, or another method"
        raise BadInput(Fault(scene.source, "target.shape", reason))
