"""A scene: who strikes what, how fast, and by which law where it names one. Physics only; frozen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Annotated, Protocol

from lumped.errors import BadInput, Fault, addressed
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material, Relaxation
from lumped.scene.geometry import Geometry, absurd_depth, flying_faults, plasticity_faults, relaxed_impact
from lumped.scene.tables import (
    LAWS,
    MASS,
    NAME,
    SECOND_MASS,
    VELOCITY,
    LawChoice,
    Model,
    Motion,
    gravity_faults,
    inertia_faults,
    load,
    mass_faults,
    read,
)
from lumped.schema import Table
from lumped.schema.files import overridden
from lumped.schema.keys import check_fields
from lumped.schema.members import Folder
from lumped.schema.shown import html_table
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target


@dataclass(frozen=True)
class Scene:
    """One impact: a striker of `shape`, `mass` (kg) and `velocity` (m/s) on a target of `material`.

    Where the target is rigid `material` is the striker's; `striker_material` is that of a striker on a target which
    yields too, None: rigid.
    A law with parameters of its own needs neither shape nor material (both None); `law` may name one.
    `target_mass`: mass of a free second body, kg; None: the target is held. Raises BadInput, naming the key,
    for what cannot be used.
    """

    shape: Shape | None
    mass: Annotated[float, MASS]
    velocity: Annotated[float, VELOCITY]
    material: Material | None = None
    target: Target = field(default_factory=HalfSpace)
    model: Model = field(default_factory=Model)
    motion: Motion = field(default_factory=Motion)
    target_mass: Annotated[float | None, SECOND_MASS] = None
    law: LawChoice | None = None
    striker_material: Material | None = None
    name: Annotated[str, NAME] = "scene"
    source: str = "scene"

    def __post_init__(self) -> None:
        check_fields(self.source, self)
        if (self.shape is None) != (self.material is None):
            missing = "striker.shape" if self.shape is None else f"{self.target.owner}.material"
            raise BadInput(Fault(self.source, missing, "missing; shape and material come together"))
        geometry = self.geometry if self.has_geometry else None
        if geometry is not None:
            geometry.check_striker(self.source, self.model.inertia)
        density = None if self.material is None else self.material.density
        target = None if geometry is None else geometry.target
        faults = inertia_faults(self.source, self.model.inertia, density, target)
        faults += mass_faults(self.source, self.mass, self.swinging_mass)
        faults += gravity_faults(self.source, self.model)
        faults += plasticity_faults(self.source, self.model, geometry, self.motion.impacts)
        if self.model.finite and geometry is None:
            reason = "finite: a law of its own has no body that is strained; accepted: small"
            faults.append(Fault(self.source, "model.kinematics", reason))
        if self.model.inertia and geometry is not None:
            faults += flying_faults(self.source, geometry, self.mass, self.target_mass)
        if faults:
            raise BadInput(faults)
        if self.shape is not None:
            with self.addressed():
                modulus = self.contact_modulus
            reason = absurd_depth(self.shape, modulus, self.swinging_mass, self.velocity)
            if reason:
                raise BadInput(Fault(self.source, "striker.velocity", reason))

    @classmethod
    def load(cls, source: str | Path, overrides: Mapping[str, object] | None = None) -> Scene:
        """The scene of a file, or a packaged scene by its name. Raises BadInput with every fault."""
        return load(cls, source, overrides)[0]

    @classmethod
    def from_dict(cls, table: Mapping[str, object], source: str = "scene") -> Scene:
        """The scene of a table as in a scene file. Raises BadInput with every fault."""
        return read(cls, table, source)[0]

    @property
    def has_geometry(self) -> bool:
        """Whether the scene has a shape and a material, not a law's parameters alone."""
        return self.shape is not None

    @cached_property
    def geometry(self) -> Geometry:
        """Shape, target and material; raises BadInput where the scene has a law's parameters alone."""
        if self.shape is None or self.material is None:
            reason = "missing; only the law of [law] runs without a shape and a material"
            raise BadInput(Fault(self.source, "striker.shape", reason))
        return Geometry(self.shape, self.target, self.material, self.striker_material)

    @property
    def reduced_mass(self) -> float:
        """m1 m2/(m1 + m2), kg; the striker's mass where the target is held."""
        return self.mass if self.target_mass is None else self.mass / (1.0 + self.mass / self.target_mass)

    @property
    def swinging_mass(self) -> float:
        """What a contact time goes with, kg: a block with inertia counts by a third of its own mass (Rayleigh)."""
        if not self.model.inertia or self.shape is None or self.material is None:
            return self.reduced_mass
        return self.reduced_mass + self.shape.own_mass(self.material.density or 0.0) / 3.0

    @property
    def gravity(self) -> float:
        """What drives the approach, m/s2: two free bodies fall alike."""
        return self.model.gravity if self.target_mass is None else 0.0

    @property
    def profile(self) -> Shape:
        """The striker's shape as `model.profile` resolves it. Raises BadInput without geometry."""
        return self.geometry.shape.resolved(self.model.profile)

    @cached_property
    def contact_modulus(self) -> Relaxation:
        """E*(t) of the contact, Pa. Raises BadInput without geometry."""
        return self.geometry.contact_modulus

    @property
    def load_curve(self) -> LoadCurve:
        """The target's exact elastic answer to the profile, per unit E* (and length). Raises BadInput without one."""
        self.check_memory()
        with self.addressed():
            return self.target.load_curve(self.profile, self.geometry.material.nu)

    @cached_property
    def elastic_contact_time(self) -> float:
        """Hertz contact time with the relaxed modulus, or the glassy one of a fluid; or of the bare law, s."""
        if self.law is not None and not self.has_geometry:
            return _LAWS.get(self.law.name).of(self).elastic_contact_time(self)
        geometry = self.geometry
        local = relaxed_impact(geometry.shape, self.contact_modulus, self.swinging_mass, self.velocity).duration
        return geometry.target.contact_time(local, geometry.material, self.reduced_mass)

    @property
    def end_time(self) -> float:
        """When to stop if the bodies have not separated, s."""
        return self.end_time_of(self.elastic_contact_time)

    def end_time_of(self, contact_time: float) -> float:
        """That of a law with this elastic contact time, s."""
        flight = 2.0 * self.velocity / self.gravity if self.gravity > 0.0 else 0.0
        return self.motion.until(contact_time, flight)

    def to_dict(self) -> Table:
        """The tables of a scene file that gives this scene back."""
        motion = {"impacts": self.motion.impacts} | self._ending()
        given = {**self._bodies(), "model": vars(self.model).copy(), "motion": motion, "law": self._law()}
        return {"name": self.name} | {key: table for key, table in given.items() if table}

    def __repr__(self) -> str:
        return "\n  ".join([f"Scene {self.name}", *(f"{part}: {said}" for part, said in self._lines())])

    def _repr_html_(self) -> str:
        return html_table((self.name, ""), self._lines())

    def _lines(self) -> Iterator[tuple[str, str]]:
        """Every table in words, but what the model has by default."""
        plain = vars(Model())
        model = {key: value for key, value in vars(self.model).items() if value != plain[key]}
        motion = {} if self.motion.impacts == 1 else {"impacts": self.motion.impacts}
        for part, table in {**self._bodies(), "model": model, "motion": motion, "law": self._law()}.items():
            material = table.pop("material", {})
            for path, one in ((part, table), (f"{part}.material", material)):
                if one:
                    yield path, ", ".join(f"{key} {_short(value)}" for key, value in one.items())

    def _bodies(self) -> dict[str, Table]:
        """The tables of striker and target."""
        striker: Table = {"mass": self.mass, "velocity": self.velocity}
        target: Table = {} if self.target_mass is None else {"mass": self.target_mass}
        if self.has_geometry:
            own, held = self.geometry.tables()
            striker, target = own | striker, held | target
        return {"striker": striker, "target": target}

    def _law(self) -> Table:
        """The table of the law that the scene names; empty without one."""
        return {} if self.law is None else {"name": self.law.name, **self.law.values}

    def changed(self, keys: Mapping[str, object]) -> Scene:
        """The scene with dotted keys of its tables changed; an end that nobody asked for follows. Raises BadInput."""
        tables = self.to_dict()
        if self.motion.end_time is None:
            tables["motion"].pop("end_time", None)
        return Scene.from_dict(overridden(tables, keys, self.source), self.source)

    def addressed(self) -> AbstractContextManager[None]:
        """Inside, what a part refuses is said of this scene's file and keys."""
        return addressed(self.source, self.geometry.places("striker.velocity") if self.has_geometry else {})

    def check_law(self) -> None:
        """Raise BadInput for a law of the scene's own that has no answer for it."""
        if self.law is not None:
            with self.addressed():
                _LAWS.get(self.law.name).of(self)

    def check_single(self, method: str) -> None:
        """Raise BadInput for several impacts, which need a memory that `method` does not have."""
        if self.motion.impacts > 1:
            reason = f"{self.motion.impacts}: {method} follows one impact; accepted: 1, or a law between two masses"
            raise BadInput(Fault(self.source, "motion.impacts", reason))

    def check_memory(self) -> None:
        """Raise BadInput where no surface alone remembers: of a body with lengths, nu(t) changes the load curve."""
        if not self.geometry.surface_remembers:
            reason = '"bulk" changes nu in time, which no load curve follows; accepted: "poisson", or --method fe'
            raise BadInput(Fault(self.source, f"{part}.material.constant", reason) for part in self.geometry.changing)

    def check_sunk(self, depth: float, contact_radius: float = 0.0) -> None:
        """Raise BadInput where an impact went to a depth, m, or a contact radius, m, that is too much."""
        target, shape = self.geometry.target, self.geometry.shape
        wide = target.check_contact(contact_radius) or shape.check_contact(contact_radius)
        reason = target.check_depth(shape, depth) or wide
        if reason:
            cure = "a lower velocity, a stiffer material: are its moduli in Pa?"
            told = f"the striker sinks in by {depth:.3g} m: {reason}; cure: {cure}"
            raise BadInput(Fault(self.source, "striker.velocity", told))

    def _ending(self) -> dict[str, float]:
        """The end time, where the scene alone tells it."""
        known = self.motion.end_time is not None or self.has_geometry or self.law is not None
        return {"end_time": self.end_time} if known else {}


def _short(value: object) -> str:
    """A value with six digits; of a list its first ones."""
    if isinstance(value, list | tuple):
        shown = ", ".join(_short(one) for one in value[:4])
        return f"[{shown}{', ...' if len(value) > 4 else ''}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class _Timed(Protocol):
    """A law made for a scene, as far as a scene asks."""

    def elastic_contact_time(self, scene: Scene) -> float: ...


class _LawKind(Protocol):
    """A member of the folder of laws, as far as a scene asks."""

    def of(self, scene: Scene, /) -> _Timed: ...


_LAWS = Folder[_LawKind](LAWS.package)


@dataclass(frozen=True, kw_only=True)
class Answered(Scene):
    """The scene, on this curve per unit contact modulus: laws that need no more than a curve follow it."""

    curve: LoadCurve

    @classmethod
    def by(cls, scene: Scene, curve: LoadCurve) -> Answered:
        """A scene with its curve."""
        return cls(**{one.name: getattr(scene, one.name) for one in fields(Scene)}, curve=curve)

    @property
    def load_curve(self) -> LoadCurve:
        """The one that was told."""
        self.check_memory()
        return self.curve
