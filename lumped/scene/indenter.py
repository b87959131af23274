"""What a slow indentation needs of a scene: shape, target and material, but no mass and no motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path

from lumped.errors import BadInput, Fault, addressed
from lumped.materials import Material
from lumped.numbers import Array
from lumped.scene.geometry import Geometry, plasticity_faults
from lumped.scene.tables import Model, load_indenter
from lumped.schema import Table
from lumped.schema.keys import Number
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target

DEPTH = Number(1e-15, 1e6, "m")
MOST_DEPTHS = 10_000  # work: depths of one indentation


@dataclass(frozen=True)
class Indenter:
    """A `shape` pressed slowly into a target; `name` and `source` are those of the scene.

    `material` is the target's, or the striker's where the target is rigid; `striker_material` that of a striker
    on a target which yields too, None: rigid.
    """

    shape: Shape
    material: Material
    target: Target = field(default_factory=HalfSpace)
    striker_material: Material | None = None
    model: Model = field(default_factory=Model)
    name: str = "scene"
    source: str = "scene"

    def __post_init__(self) -> None:
        self.geometry.check_striker(self.source, inertia=False)
        faults = plasticity_faults(self.source, self.model, self.geometry)
        if faults:
            raise BadInput(faults)
        if self.target.only_with_inertia:
            reason = f"{self.target.name}: made of waves, it has no slow indentation; accepted: another target"
            raise BadInput(Fault(self.source, "target.shape", reason))

    @classmethod
    def load(cls, source: str | Path, overrides: Mapping[str, object] | None = None) -> Indenter:
        """Of a scene file or a packaged scene's name; mass and velocity may be missing. Raises BadInput."""
        return load_indenter(cls, source, overrides)[0]

    @property
    def geometry(self) -> Geometry:
        """What is pressed into what."""
        return Geometry(self.shape, self.target, self.material, self.striker_material)

    @property
    def profile(self) -> Shape:
        """The striker's shape as `model.profile` resolves it."""
        return self.shape.resolved(self.model.profile)

    def addressed(self) -> AbstractContextManager[None]:
        """Inside, what a part refuses is said of the file and its keys, or of --depths."""
        return addressed(self.source, self.geometry.places("--depths"))

    def elastic(self, instant: bool) -> Indenter:
        """The same with the elastic materials that a slow or, `instant`, a sudden indentation meets."""
        striker = None if self.striker_material is None else self.striker_material.elastic(instant)
        return replace(self, material=self.material.elastic(instant), striker_material=striker)

    def modulus(self, instant: bool) -> float:
        """E* against a slow or, `instant`, a sudden indentation, Pa. Raises BadInput where there is none."""
        with self.addressed():
            contact = self.geometry.contact_modulus
        if instant and contact.viscosity > 0.0:
            raise self._refused("has a dashpot in parallel: infinitely stiff at once; accepted: leave out --instant")
        if not instant and contact.relaxed == 0.0:
            raise self._refused("is a fluid: no force stays; accepted: --instant, or a solid")
        return contact.glassy if instant else contact.relaxed

    def checked(self, depths: tuple[float, ...]) -> tuple[float, ...]:
        """The depths, m, as they were given; raises BadInput for one that cannot be."""
        if not 1 <= len(depths) <= MOST_DEPTHS:
            raise BadInput(Fault("--depths", "", f"{len(depths)} depths; accepted: 1 to {MOST_DEPTHS}"))
        if faults := self.depth_faults(depths):
            raise BadInput(faults)
        return depths

    def depth_faults(self, depths: Sequence[float]) -> list[Fault]:
        """Depths, m, that cannot be."""
        faults = [Fault("--depths", "", f"{d:g}: accepted {DEPTH.accepted}") for d in depths if not _accepted(d)]
        wrong = [(d, self.target.check_depth(self.shape, d)) for d in depths if _accepted(d)]
        return faults + [Fault("--depths", "", f"{d:g}: {reason}") for d, reason in wrong if reason]

    def check_contacts(self, depths: Array, contact_radii: Array) -> None:
        """Raise BadInput for depths, m, whose contacts, m, are too wide for the target."""
        widths = [(d, float(a)) for d, a in zip(depths, contact_radii, strict=True)]
        wrong = [(d, self.target.check_contact(a) or self.shape.check_contact(a)) for d, a in widths]
        faults = [Fault("--depths", "", f"{d:g}: {reason}; cure: a smaller depth") for d, reason in wrong if reason]
        if faults:
            raise BadInput(faults)

    def to_dict(self) -> Table:
        """The tables of a scene file that gives it back."""
        striker, target = self.geometry.tables()
        return {"name": self.name, "striker": striker, "target": target, "model": vars(self.model).copy()}

    def _refused(self, reason: str) -> BadInput:
        return BadInput(Fault(self.source, f"{self.target.owner}.material", reason))


def _accepted(depth: float) -> bool:
    return DEPTH.low <= depth <= DEPTH.high
