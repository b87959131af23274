"""The law in the gaps of a file, made for the two storeys at each of them; and another law to compare it with."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated

from lumped import laws
from lumped.errors import BadInput, Fault
from lumped.laws._force_law import ForceLaw, between_masses
from lumped.laws._power_law import PowerLaw, spring_depth, spring_of_peak
from lumped.laws.correspondence import Correspondence, law_of
from lumped.pounding.frames import Gap, PoundingFrames
from lumped.scene.scene import Scene
from lumped.scene.tables import LAWS, SPEED
from lumped.schema import Table
from lumped.schema.keys import Key
from lumped.solvers.point.bodies import Bodies

# What two laws have in common, so that one of them can be given by the keys of the other.
SHARED = ("k", "alpha", "e", "exit")
TRIED = (1.0, 2.0)  # m/s: a law that is the same for both needs no velocity
ALPHA = 1.5  # physics: Hertz's, of a law without an exponent of its own


@dataclass(frozen=True)
class GapLaw:
    """A law by its name and the `values` of its keys. `velocity`: a typical speed at touch, m/s, for laws that take
    their numbers from it; `scene`: tables of a scene whose shapes and materials the storeys have there; `source`: the
    file.
    """

    name: str
    values: Table = field(default_factory=dict)
    velocity: Annotated[float | None, Key(SPEED, "typical speed at touch", required=False)] = None
    scene: Table = field(default_factory=dict)
    source: str = "pounding"

    def at(self, frames: PoundingFrames, gap: Gap) -> ForceLaw:
        """The law between the two storeys of a gap. Raises BadInput, also for a law that is none between two masses."""
        if self.velocity is not None:
            return self._made(frames, gap, self.velocity)
        one, other = (self._made(frames, gap, velocity) for velocity in TRIED)
        if one.parameters != other.parameters:
            reason = f"missing; {self.name} takes its numbers from the speed at touch; accepted: {SPEED.accepted}"
            raise BadInput(Fault(self.source, "law.velocity", reason))
        return one

    def _made(self, frames: PoundingFrames, gap: Gap, velocity: float) -> ForceLaw:
        try:
            return force_of(self.name, self._scene(frames, gap, velocity, {"name": self.name, **self.values}))
        except BadInput as bad:
            raise BadInput(self._said_here(fault) for fault in bad.faults) from bad

    @property
    def numerics(self) -> Table:
        """The raw settings of the scene."""
        return dict(self.scene.get("numerics", {}))

    def impact(self, frames: PoundingFrames, gap: Gap) -> Scene:
        """The two storeys of a gap alone, as they meet with the scene's shapes and materials. Raises BadInput."""
        if not self.scene or self.velocity is None:
            missing = "velocity" if self.scene else "scene"
            reason = "missing; accepted: with it the two storeys are an impact that a law can be calibrated on"
            raise BadInput(Fault(self.source, f"law.{missing}", reason))
        return self._scene(frames, gap, self.velocity, None)

    def _scene(self, frames: PoundingFrames, gap: Gap, velocity: float, law: Table | None) -> Scene:
        left, right = frames.masses_at(gap)
        striker: Table = {**self.scene.get("striker", {}), "mass": left, "velocity": velocity}
        target: Table = {**self.scene.get("target", {}), "mass": right}
        if right is None:
            del target["mass"]
        tables = {"striker": striker, "target": target}
        # a force between two masses follows no larger model: that is the reference's, which no law is named for
        rest = {"model": self.scene.get("model", {})} if law is None else {"law": law}
        return Scene.from_dict(tables | rest, self.source)

    def _said_here(self, fault: Fault) -> Fault:
        """A fault of the scene that stands for two storeys."""
        if fault.key == "striker.velocity":
            return Fault(self.source, "law.scene", f"two storeys meet there: {fault.message}")
        if fault.key != "striker.shape":
            return fault
        reason = f"{self.name} follows from a shape and a material; accepted: with law.scene, or another, as kelvin"
        return Fault(self.source, "law.name", reason)

    def like(self, name: str, frames: PoundingFrames, gap: Gap) -> GapLaw:
        """The law called so for a gap, given by what it shares with this one: e, and k of the same elastic peak force.

        Where both have one exponent that is the same k; else it takes a velocity. Raises BadInput.
        """
        (keys,) = LAWS.get(name, "--laws", "").sets
        values = {key: value for key, value in self.values.items() if key in SHARED and key in keys}
        if name == self.name:
            return self
        if self.values.keys() >= {"k"} and "e" in keys and "e" not in self.values:
            reason = f"missing; accepted: the restitution by which {name} is to be like {self.name}"
            raise BadInput(Fault(self.source, "law.e", reason))
        other = replace(self, name=name, values=values)
        if "k" not in values:
            return other
        alpha, own = (exponent(law, frames, gap) for law in (self, other))
        if alpha == own:
            return other
        if self.velocity is None:
            reason = f"missing; k of {name}, with exponent {own:g}, is that of the same peak force at a speed"
            raise BadInput(Fault(self.source, "law.velocity", f"{reason}; accepted: {SPEED.accepted}"))
        bodies = Bodies(frames.reduced_mass(gap), self.velocity)
        peak = peak_of_spring(float(values["k"]), alpha, bodies)
        return replace(other, values={**values, "k": spring_of_peak(peak, own, bodies)})


def force_of(name: str, scene: Scene) -> ForceLaw:
    """The law called so as a force between two masses, whatever it remembers. Raises BadInput where it is none."""
    law = laws.get(name).of(scene)
    return law_of(scene, law.exit, law.memory) if isinstance(law, Correspondence) else between_masses(name, scene)


def exponent(law: GapLaw, frames: PoundingFrames, gap: Gap) -> float:
    """Of the depth in the spring that `k` is of."""
    made = replace(law, velocity=law.velocity or TRIED[0]).at(frames, gap)
    return made.alpha if isinstance(made, PowerLaw) else float(law.values.get("alpha", ALPHA))


def peak_of_spring(k: float, alpha: float, bodies: Bodies) -> float:
    """Of the elastic impact on k depth^alpha, N."""
    return float(k * spring_depth(k, alpha, bodies) ** alpha)
