"""The exact impact of an elastic bar on a rigid plane, by its waves: contact after contact, under gravity or none.

Depth and velocity are those of the bar's centre of mass, which the force moves: M dv/dt = M g - F.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws._assembly import Answer, assemble, bars, values_of_several
from lumped.laws.base import LawKind, check_geometry
from lumped.numbers import Array, Clock, bisected
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.shapes._block import Block
from lumped.solvers.bar import Bounces, StraightBar, bounces
from lumped.solvers.point.track import Outcome

BEFORE = 1e-12  # rounding: share of a time, just before a jump of the force
SAFETY = 2.0  # safety: of the bars, over rounding


@dataclass(frozen=True)
class BarWaves:
    """The law: the bar, of which the scene says how it falls."""

    bar: StraightBar
    name: ClassVar[str] = "bar_waves"
    needs_mass: ClassVar[bool] = False  # the bar has its own

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene, exact but for rounding, whatever the tolerance. Raises NotReached."""
        clock = Clock()
        impacts = scene.motion.impacts
        motion = bounces(self.bar, scene.velocity, scene.gravity, 0.0, scene.end_time, impacts)
        answer = _answer(scene, _Fall(motion, impacts, scene.profile.fixed_radius or 0.0))
        quantities, force_error = bars(answer, answer, SAFETY)
        work = {"waves": len(motion.pieces)}
        numerics = {"series": "exact"}
        return assemble(
            self.name, scene, tolerance, answer, quantities, force_error, clock, numerics, work, scene.model
        )


def of(scene: Scene) -> BarWaves:
    """The law for a scene. Raises BadInput for all but an elastic bar on a rigid plane, without a mass behind it."""
    check_geometry(scene, BarWaves.name)
    block, faults = scene.shape, []
    if not isinstance(block, Block) or not block.uniform or not scene.model.inertia:
        reason = "bar_waves is not for this striker, but for a prism or plate with inertia, strained uniformly"
        reason += "; accepted: one, or another method"
        raise BadInput(Fault(scene.source, "striker.shape", reason))
    modulus, density = block.modulus(scene.geometry.material), scene.geometry.material.density or 0.0
    if not modulus.is_elastic:
        reason = "its waves disperse, which bar_waves does not follow; accepted: elastic, or --method fe"
        faults.append(Fault(scene.source, "striker.material.law", reason))
    if scene.mass > 0.0:
        reason = f"{scene.mass:g}: bar_waves has no mass behind the bar; accepted: 0, or --method fe"
        faults.append(Fault(scene.source, "striker.mass", reason))
    if faults:
        raise BadInput(faults)
    speed = math.sqrt(modulus.glassy / density)
    return BarWaves(StraightBar(block.thickness, speed, density * block.area * speed))


@dataclass(frozen=True, eq=False)
class _Fall:
    """The centre of mass of a bouncing bar, until its contacts are as many as asked for; ``radius`` of its end, m."""

    motion: Bounces
    impacts: int
    radius: float

    @property
    def contacts(self) -> tuple[tuple[float, float], ...]:
        """Touch and separation of those followed, s."""
        return self.motion.contacts[: self.impacts]

    @property
    def end(self) -> float:
        """Of the last one, s."""
        return self.contacts[-1][1]

    @cached_property
    def knots(self) -> Array:
        """Times between which the force is straight, s."""
        starts = np.array([piece.start for piece in self.motion.pieces])
        found = np.unique(np.concatenate([starts, starts + self.motion.bar.echo, np.ravel(self.contacts)]))
        return found[found <= self.end]

    @cached_property
    def spans(self) -> tuple[Array, Array, Array, Array]:
        """On the spans between knots, shape (n,): the force at the start, N, and its slope, the integral of the force
        up to there, N s, and the integral of that, N s2.
        """
        starts, lengths = self.knots[:-1], np.diff(self.knots)
        early, late = (self.motion.force(starts + share * lengths) for share in (0.25, 0.75))
        force, slope = 1.5 * early - 0.5 * late, 2.0 * (late - early) / lengths
        passed = force * lengths + slope * lengths**2 / 2
        momentum = np.append(0.0, np.cumsum(passed)[:-1])
        lag = momentum * lengths + force * lengths**2 / 2 + slope * lengths**3 / 6
        return force, slope, momentum, np.append(0.0, np.cumsum(lag)[:-1])

    def __call__(self, times: Array) -> Array:
        """Depth, velocity, force, contact radius at times (n,), s, shape (4, n)."""
        place = np.clip(np.searchsorted(self.knots, times, side="right") - 1, 0, self.knots.size - 2)
        force, slope, momentum, lag = (column[place] for column in self.spans)
        since = times - self.knots[place]
        momentum = momentum + force * since + slope * since**2 / 2
        lag = lag + self.spans[2][place] * since + force * since**2 / 2 + slope * since**3 / 6
        fall, mass = self.motion, self.motion.bar.mass
        depth = fall.velocity * times + fall.gravity * times**2 / 2 - lag / mass
        pressed = self.force(times)
        radius = np.where(pressed > 0.0, self.radius, 0.0)
        return np.array([depth, fall.velocity + fall.gravity * times - momentum / mass, pressed, radius])

    def force(self, times: Array) -> Array:
        """The force alone, N; zero from the end on."""
        return np.where(times < self.end, np.maximum(self.motion.force(times), 0.0), 0.0)

    def contact(self, start: float, end: float) -> Outcome:
        """What one contact comes to."""
        inside = self.knots[(self.knots >= start) & (self.knots < end)]
        rows = np.unique(np.append(inside, np.append(inside[1:], end) * (1.0 - BEFORE)))
        force, (velocity, away) = self.force(rows), self(np.array([start, end]))[1].tolist()
        parted = end < self.motion.end
        return Outcome(
            start=start,
            duration=end - start if parted else None,
            velocity=velocity,
            restitution=-away / velocity if parted else None,
            peak_force=float(force.max()),
            peak_time=float(rows[force.argmax()]),
            peak_depth=self._deepest(start, end),
        )

    def _deepest(self, start: float, end: float) -> float:
        """Largest depth between two times, m: at a knot, or where the velocity is zero between two."""
        places = np.unique(np.concatenate([self.knots, np.linspace(start, end, 4 * self.knots.size)]))
        places = places[(places >= start) & (places <= end)]
        velocity = self(places)[1]
        turns = np.flatnonzero((velocity[:-1] > 0.0) & (velocity[1:] <= 0.0))
        deepest = [bisected(self._inward, *places[i : i + 2].tolist())[0] for i in turns]
        return float(self(np.append(places, deepest))[0].max())

    def _inward(self, time: float) -> bool:
        return bool(self(np.array([time]))[1, 0] > 0.0)


def _answer(scene: Scene, fall: _Fall) -> Answer:
    """What the waves say, in SI."""
    contacts = [fall.contact(*one) for one in fall.contacts]
    end, mass = fall.end, fall.motion.bar.mass
    depth, velocity = fall(np.array([end]))[:2, 0].tolist()
    values = values_of_several(contacts, mass * (scene.velocity - velocity + scene.gravity * end))
    given, out = 0.5 * mass * scene.velocity**2 + mass * scene.gravity * depth, 0.5 * mass * velocity**2
    stored = fall.motion.energy(end) - out
    energy = {"in": given, "out": out, "stored": stored, "viscous": 0.0, "residual": given - out - stored}
    ending = End.SEPARATED if end < fall.motion.end else End.TIME
    rows = np.unique(np.concatenate([fall.knots, fall.knots[1:] * (1.0 - BEFORE)]))
    said = [] if ending is End.SEPARATED else [ending.value]
    if ending is End.SEPARATED and len(contacts) < fall.impacts:
        said.append(f"{len(contacts)} of {fall.impacts} impacts: the bar did not meet the plane again before the end")
    told = tuple(one._asdict() for one in contacts) if scene.motion.impacts > 1 else ()
    return Answer(rows, fall, values, ending, energy, "; ".join(said), contacts=told)


MEMBER = LawKind(of, __doc__, leaves_out=lambda scene: "", seconds=0.01)
