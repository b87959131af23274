"""A scene: who strikes what, how fast. Physics only; frozen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lumped.errors import BadInput, Fault
from lumped.keys import Choice, Count, Flag, Key, Number, Text, check_fields
from lumped.materials import Material, Relaxation
from lumped.scales import stiffest_impact
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target

END_IN_CONTACT_TIMES = 50.0

STRIKER_KEYS: Mapping[str, Key] = {
    "mass": Number(1e-21, 1e12, "kg"),
    "velocity": Number(1e-9, 1e5, "m/s"),
}
MODEL_KEYS: Mapping[str, Key] = {
    "inertia": Flag(required=False),
    "profile": Choice(("exact", "parabola"), required=False),
    "gravity": Number(-1e6, 1e6, "m/s2", required=False),
}
MOTION_KEYS: Mapping[str, Key] = {
    "impacts": Count(1, 1000, required=False),
    "end_time": Number(1e-15, 1e12, "s", required=False),
}
NAME_KEYS: Mapping[str, Key] = {"name": Text(required=False)}


@dataclass(frozen=True)
class Model:
    """The `[model]` table: inertia of deformable bodies, profile, gravity along the motion (m/s2)."""

    inertia: bool = False
    profile: str = "exact"
    gravity: float = 0.0

    def __post_init__(self) -> None:
        check_fields("model", self, MODEL_KEYS)


@dataclass(frozen=True)
class Motion:
    """The `[motion]` table: how many impacts are followed, and until when (s; None: 50 contact times)."""

    impacts: int = 1
    end_time: float | None = None

    def __post_init__(self) -> None:
        check_fields("motion", self, MOTION_KEYS)
        if self.impacts > 1:
            raise BadInput(Fault("motion", "impacts", "more than one impact is not available in this version"))


@dataclass(frozen=True)
class Scene:
    """One impact: a rigid striker of `shape`, `mass` (kg) and `velocity` (m/s) on a target of `material`.

    Raises BadInput, naming the key, for what cannot be used.
    """

    shape: Shape
    mass: float
    velocity: float
    material: Material
    target: Target = field(default_factory=HalfSpace)
    model: Model = Model()
    motion: Motion = Motion()
    name: str = "scene"
    source: str = "scene"

    def __post_init__(self) -> None:
        check_fields(self.source, self, {**NAME_KEYS, **STRIKER_KEYS})
        faults = inertia_faults(self.source, self.model.inertia, self.material.density, self.target)
        if faults:
            raise BadInput(faults)
        message = self._absurd_depth()
        if message:
            raise BadInput(Fault(self.source, "striker.velocity", message))

    @classmethod
    def load(cls, source: str | Path, overrides: Mapping[str, object] | None = None) -> Scene:
        """The scene of a file, or a packaged scene by its name. Raises BadInput with every fault."""
        from lumped.scene_file import load

        return load(source, overrides)[0]

    @classmethod
    def from_dict(cls, table: Mapping[str, object], source: str = "scene") -> Scene:
        """The scene of a table as in a scene file. Raises BadInput with every fault."""
        from lumped.scene_file import read

        return read(table, source)[0]

    @property
    def profile(self) -> Shape:
        """The striker's shape as `model.profile` resolves it."""
        return self.shape.resolved(self.model.profile)

    @property
    def contact_modulus(self) -> Relaxation:
        """E*(t) of the target, Pa."""
        return self.material.contact_modulus()

    @property
    def elastic_contact_time(self) -> float:
        """Hertz contact time with the relaxed modulus, or the glassy one of a fluid, s."""
        modulus = self.contact_modulus
        if modulus.relaxed:
            return self.shape.hertz_impact(modulus.relaxed, self.mass, self.velocity).duration
        if modulus.glassy:
            return self.shape.hertz_impact(modulus.glassy, self.mass, self.velocity).duration
        return stiffest_impact(self.shape, modulus, self.mass, self.velocity).duration

    @property
    def end_time(self) -> float:
        """When to stop if the bodies have not separated, s."""
        return self.motion.end_time or END_IN_CONTACT_TIMES * self.elastic_contact_time

    def to_dict(self) -> dict[str, Any]:
        """The tables of a scene file that gives this scene back."""
        motion: dict[str, Any] = {"impacts": self.motion.impacts, "end_time": self.end_time}
        striker = self.shape.to_dict() | {"mass": self.mass, "velocity": self.velocity}
        target = self.target.to_dict() | {"material": self.material.to_dict()}
        return {
            "name": self.name,
            "striker": striker,
            "target": target,
            "model": vars(self.model).copy(),
            "motion": motion,
        }

    def _absurd_depth(self) -> str:
        """Even the stiffest answer of the material lets the striker sink in deeper than it is round."""
        impact = stiffest_impact(self.shape, self.contact_modulus, self.mass, self.velocity)
        if impact.contact_radius <= impact.depth:
            return (
                f"the striker sinks in by {impact.depth:.3g} m, deeper than its radius: no small-displacement theory "
                "holds; accepted: a lower velocity or mass, or a stiffer material"
            )
        return ""


def inertia_faults(source: str, inertia: bool, density: float | None, target: Target) -> list[Fault]:
    """What is missing for `model.inertia = true`."""
    faults = []
    if inertia and not target.has_inertia:
        reason = f"true is not available for {target.name} in this version; accepted: false"
        faults.append(Fault(source, "model.inertia", reason))
    if inertia and density is None:
        faults.append(Fault(source, "target.material.density", "missing; model.inertia = true needs it, in kg/m3"))
    return faults
