"""The free vibration of a pounding tuned mass damper: two masses in a row, and a gap at either side of the damper.

They are marched as pounding frames are, their ring by the law of the memory of a load. In "(33)" the force of the ring
has the sign of x2 - x1 (printed with one sign for both sides, which drives the damper out).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws.correspondence import HereditaryDent, HereditaryForce
from lumped.numbers import Array
from lumped.pounding.flow import FrameFlow, LinearBodies
from lumped.pounding.gaps import OPEN, FrameStep, GapState, Mode, pressed
from lumped.pounding.ground import STILL
from lumped.pounding.march import FrameMarch, FramesFlight, OnTime, ignore, rows
from lumped.pounding.simulation import Peaks
from lumped.pounding.trial import FramesAt, Rules
from lumped.ptmd.result import Energy, Measures, PtmdContact, PtmdMotion, PtmdResult
from lumped.ptmd.system import SIDES, PoundingDamper, Start, bodies_of, law_of
from lumped.schema.keys import Key, Number, read_table
from lumped.solvers.point.bodies import TINY, State
from lumped.solvers.point.memory import StepLoad
from lumped.solvers.radau import NODES

TIME = Number(1e-9, 1e9, "s")
TIME_KEYS = {"end_time": Key(TIME, "when to stop", False), "window": Key(TIME, "of the root mean squares", False)}
STEP_TOLERANCE = 1e-7  # default: error of a relative speed in one step of a contact, over the speed at touch
MOVING = 1e-12  # rounding: of the end of a window, for a row that stands there


def simulate(
    system: PoundingDamper,
    start: Start,
    end_time: float = 20.0,
    window: float = 5.0,
    tolerance: float = STEP_TOLERANCE,
    on_time: OnTime = ignore,
) -> PtmdResult:
    """Vibration from `start` to `end_time`, s; root mean squares over the first `window` seconds.

    `tolerance`: error of a relative speed in one step of a contact, over the speed at touch; `on_time` is told how
    far the motion is, s. Raises BadInput and NotReached.
    """
    _, faults = read_table("simulate", "", {"end_time": end_time, "window": window}, TIME_KEYS)
    if system.damper is None and not (start.x1 or start.v1):
        faults.append(Fault("start", "x1", "nothing moves without a damper; accepted: x1 or v1 that is not zero"))
    if faults:
        raise BadInput(faults)
    bodies = bodies_of(system, start)
    times, longest = rows(bodies, STILL, end_time, [window])
    laws = [law_of(system.ring, bodies)] * len(SIDES) if system.ring else []
    track = PtmdTrack(system, bodies, laws)
    march = FrameMarch(Rules(FrameFlow(bodies, longest), laws, tolerance), STILL)
    march.run(times, track, track.first_gaps, on_time)
    return PtmdResult(system, start, track.motion(), track.all_contacts, track.energy(), track.measures(window))


@dataclass
class OpenPtmdContact:
    """A contact under way since `start`, s: its force there, N, and the largest force and depth so far."""

    start: float
    first: float
    peaks: Peaks

    def contact(self, side: int, end: float | None) -> PtmdContact:
        """As it is known when it ends."""
        force, depth = self.peaks.size.tolist()
        return PtmdContact(side, self.start, end, max(force, self.first), depth)


class PtmdTrack:
    """Listens to a march: rows at all points of its steps, with their weights in time; contacts, and what is lost.

    Where the ring's exponent is 1 its law has an energy of its own: the springs' of the place y of the surface and of
    the places w_k of its dashpots, and what these lose.
    """

    def __init__(self, system: PoundingDamper, bodies: LinearBodies, laws: Sequence[HereditaryForce]) -> None:
        self.system, self.bodies, self.laws = system, bodies, laws
        self.blocks: list[tuple[Array, Array, Array, Array]] = []  # times, weights, states, forces
        self.modes: list[Mode] = []
        self.open: dict[int, OpenPtmdContact] = {}
        self.contacts: list[PtmdContact] = []
        self.acceleration = Peaks.of(1)
        self.lost_ring = self.cut_tension = 0.0
        self.last = FramesAt(0.0, bodies.start, bodies.depths(bodies.start), self.first_gaps)
        sides = zip(self.first_gaps, self.last.depths.tolist(), strict=True)
        self.held = [self.stored(side, gap, depth, 0.0) for side, (gap, depth) in enumerate(sides)]

    # the ring

    @cached_property
    def linear(self) -> bool:
        """Whether the ring's law has an energy of its own."""
        return self.system.ring is None or self.system.ring.exponent == 1.0

    @cached_property
    def first_gaps(self) -> tuple[GapState, ...]:
        """What both sides do at t = 0: one that the damper stands in is relaxed."""
        depths, rates = (found(self.bodies.start).tolist() for found in (self.bodies.depths, self.bodies.rates))
        return tuple(self._begun(*one) for one in zip(self.laws, depths, rates, strict=True))

    def _begun(self, law: HereditaryForce, depth: float, rate: float) -> GapState:
        if depth <= 0.0:
            return OPEN
        memory = (float(law.load.load(depth)),) * len(law.load.modulus.moduli)
        gap = replace(pressed(law, depth, rate, TINY, 0.0), memory=memory)
        if law.at_start(depth, rate, memory) > 0.0:
            return gap
        if law.follows:
            return replace(gap, mode=Mode.FOLLOWED)
        return replace(gap, mode=Mode.LEAVING, parted=(law.dent(State(depth, rate, 0.0, memory), gap.stage), 0.0))

    def stored(self, side: int, gap: GapState, depth: float, time: float) -> float:
        """Energy of the springs of a side, J."""
        if not self.linear or gap.mode is Mode.APART:
            return 0.0
        law = self.laws[side]
        place, dashpots = float(law.load.load(depth)), np.array(gap.memory)
        if gap.parted is not None and isinstance(gap.parted[0], HereditaryDent):
            place, *rest = gap.parted[0].surface.at(time - gap.parted[1]).tolist()
            dashpots = np.array(rest)
        modulus = law.load.modulus
        return float(0.5 * (modulus.equilibrium * place**2 + np.array(modulus.moduli) @ (place - dashpots) ** 2))

    def _spent(self, at: FramesAt, step: FrameStep, side: int, weights: Array) -> float:
        """What the dashpots of an active side lose in a step, J; for other exponents what the ring takes."""
        rate = step.rate[side]
        if not self.linear:
            return float(weights @ (step.force[side] * rate))
        law, gap, depth = self.laws[side], at.gaps[side], np.maximum(step.depth[side], TINY)
        slips = law.load.load(depth) - StepLoad.of(law.load, gap.memory, step.length, NODES).memories(depth)
        modulus = law.load.modulus
        dashpots = np.divide(modulus.moduli, modulus.times) @ slips**2
        return float(weights @ (dashpots + modulus.viscosity * rate**2))

    # what the march tells

    def flight(self, flight: FramesFlight) -> None:
        """Rows without contact."""
        lengths, apart = np.diff(flight.times)[:, None], [OPEN] * len(self.laws)
        gaps = FramesAt(float(flight.times[0]), flight.states[0], self.bodies.depths(flight.states[0]), tuple(apart))
        self._switch(gaps)
        force = np.zeros((*flight.ground.shape, len(self.laws)))
        times = flight.times[:-1, None] + lengths * NODES.points
        self._add(times, lengths * NODES.weights, flight.within, force)
        self.acceleration.see(self.bodies.accelerations(flight.within, force)[..., :1], NODES)
        self.last = gaps._replace(time=float(flight.times[-1]), state=flight.states[-1])

    def step(self, at: FramesAt, step: FrameStep, to: FramesAt) -> None:
        """One step."""
        self._switch(at)
        weights = step.length * step.nodes.weights * step.nodes.pace
        times = np.append(at.time + step.length * step.nodes.points[:-1], to.time)
        self._add(times, weights, step.states, step.force.T)
        self.acceleration.see(self.bodies.accelerations(step.states, step.force.T)[:, :1], step.nodes)
        for side, (gap, after) in enumerate(zip(at.gaps, to.gaps, strict=True)):
            if gap.active:
                ended = replace(gap, memory=step.memories[side])
                self.held[side] = self.stored(side, ended, float(step.depth[side, -1]), to.time)
                self.lost_ring += self._spent(at, step, side, weights)
                self.cut_tension -= float(weights @ (step.tension[side] * step.rate[side])) if self.linear else 0.0
            if after.mode is not gap.mode:
                self._settle(side, to)
            if gap.mode is Mode.PRESSED:
                self._press(side, at, step, None if after.mode is Mode.PRESSED else to.time)
        self.last = to

    def _settle(self, side: int, at: FramesAt) -> None:
        """What a side stored, and at an instant does no more, is lost."""
        now = self.stored(side, at.gaps[side], float(at.depths[side]), at.time)
        self.lost_ring += self.held[side] - now
        self.held[side] = now

    def _press(self, side: int, at: FramesAt, step: FrameStep, end: float | None) -> None:
        if side not in self.open:
            self.open[side] = OpenPtmdContact(at.time, self._forces(at)[side], Peaks.of(2))
        contact = self.open[side]
        contact.peaks.see(np.column_stack([step.force[side], step.depth[side]]), step.nodes)
        if end is not None:
            self.contacts.append(self.open.pop(side).contact(SIDES[side], end))

    def _switch(self, at: FramesAt) -> None:
        """A row more where some side begins to do another thing: there the force may jump."""
        modes = [gap.mode for gap in at.gaps]
        if self.blocks and modes == self.modes:
            return
        self.modes = modes
        self._add(np.array([at.time]), np.zeros(1), at.state[None], np.array([self._forces(at)]))

    def _forces(self, at: FramesAt) -> list[float]:
        """Of the sides at an instant, N."""
        rates = self.bodies.rates(at.state)
        return [
            law.at_start(float(depth), float(rate), gap.memory) if gap.mode is Mode.PRESSED else 0.0
            for law, gap, depth, rate in zip(self.laws, at.gaps, at.depths, rates, strict=True)
        ]

    def _add(self, times: Array, weights: Array, states: Array, force: Array) -> None:
        count = times.size
        self.blocks.append(
            (times.ravel(), weights.ravel(), states.reshape(count, -1), force.reshape(count, len(self.laws)))
        )

    # what it comes to

    @cached_property
    def all_contacts(self) -> tuple[PtmdContact, ...]:
        """In the order of their starts; those under way have no end."""
        still = [one.contact(SIDES[side], None) for side, one in self.open.items()]
        return tuple(sorted([*self.contacts, *still], key=lambda contact: contact.start))

    @cached_property
    def rows(self) -> tuple[Array, Array, Array, Array]:
        """Times, s, (k,), their weights, states (k, 2 n), and forces, N, (k, m)."""
        times, weights, states, forces = (np.concatenate(one) for one in zip(*self.blocks, strict=True))
        return times, weights, states, forces

    @cached_property
    def accelerations(self) -> Array:
        """Of the masses, m/s2, "(34)", (k, n)."""
        return self.bodies.accelerations(*self.rows[2:])

    def motion(self) -> PtmdMotion:
        """The rows."""
        times, _, states, forces = self.rows
        n, a = self.bodies.mass.size, self.accelerations
        absent = np.full(times.size, np.nan)
        x2, v2, a2 = (states[:, 1], states[:, 3], a[:, 1]) if n > 1 else (absent, absent, absent)
        depth = self.bodies.depths(states).max(axis=1, initial=0.0)
        force = np.maximum(forces, 0.0) @ np.array(SIDES[: len(self.laws)])  # rounding is left where a contact ends
        return PtmdMotion(times, states[:, 0], states[:, n], a[:, 0], x2, v2, a2, force, depth)

    def energy(self) -> Energy:
        """Each term on its own: the first and the last state, and what was lost in between."""
        _, weights, states, _ = self.rows
        one, two, n = self.system.structure, self.system.damper, self.bodies.mass.size
        closing = states[:, 3] - states[:, 2] if two else np.zeros(weights.size)
        first, last = self._held_at_start(), self.last
        kinetic, potential = self.bodies.energies(last.state)
        for side in range(len(self.laws)):
            self._settle(side, last)
        return Energy(
            initial=sum(self.bodies.energies(self.bodies.start)) + first,
            kinetic=kinetic,
            potential=potential,
            lost_structure=one.damping * float(weights @ states[:, n] ** 2),
            lost_damper=two.damping * float(weights @ closing**2) if two else 0.0,
            lost_ring=self.lost_ring + (0.0 if self.linear else first),
            stored_ring=sum(self.held) if self.linear else None,
            cut_tension=self.cut_tension,
        )

    def _held_at_start(self) -> float:
        """Work that presses the relaxed ring slowly to where it is, any exponent, J."""
        ring = self.system.ring
        if ring is None:
            return 0.0
        power = ring.exponent + 1.0
        depths = np.maximum(self.bodies.depths(self.bodies.start), 0.0)
        return float(ring.stiffness.relaxed * (depths**power).sum() / power)

    def measures(self, window: float) -> Measures:
        """The numbers that tell one motion from another."""
        times, weights, states, _ = self.rows
        found, a, release = self.all_contacts, self.accelerations[:, 0], abs(float(states[0, 0]))
        span = min(window, float(times[-1]))
        share = weights * (times <= span * (1.0 + MOVING)) / span
        later = [contact for contact in found if contact.start > 0.0 and contact.end is not None]
        return Measures(
            window=span,
            max_acceleration=max(float(self.acceleration.size[0]), float(np.abs(a).max())),
            rms_acceleration=float(np.sqrt(share @ a**2)),
            rms_displacement=float(np.sqrt(share @ states[:, 0] ** 2)),
            t50=self._last_above(0.5 * release) if release else None,
            t10=self._last_above(0.1 * release) if release else None,
            contacts=len(found),
            last_contact=(found[-1].end or float(times[-1])) if found else None,
            first_contact_duration=later[0].end - later[0].start if later and later[0].end else None,
            peak_force=max((contact.peak_force for contact in found), default=0.0),
            peak_depth=max((contact.peak_depth for contact in found), default=0.0),
        )

    def _last_above(self, level: float) -> float | None:
        """When |x1| exceeds a level, m, for the last time, s; None while it still does at the end.

        Between two rows x1 is the polynomial of their places, speeds and accelerations.
        """
        from scipy.optimize import brentq

        turns = self._turns
        heights = [place for _, place in turns]
        above = [i for i, height in enumerate(heights) if abs(height) >= level]
        if not above or above[-1] == len(turns) - 1:
            return None
        (after, height), (before, _) = turns[above[-1]], turns[above[-1] + 1]
        return float(
            brentq(lambda time: np.sign(height) * self._structure_at(time)[0] - level, after, before, xtol=1e-13)
        )

    @cached_property
    def _turns(self) -> list[tuple[float, float]]:
        """Times at which the structure turns, s, with both ends of the motion, and its places there, m."""
        from scipy.optimize import brentq

        times, _, states, _ = self.rows
        back = np.signbit(states[:, self.bodies.mass.size])
        pairs = ((float(times[i]), float(times[i + 1])) for i in np.flatnonzero(back[:-1] != back[1:]))
        between = [
            low if low == high else float(brentq(lambda time: self._structure_at(time)[1], low, high, xtol=1e-13))
            for low, high in pairs
        ]
        ordered = [float(times[0]), *between, float(times[-1])]
        return [(time, self._structure_at(time)[0]) for time in ordered]

    def _structure_at(self, time: float) -> tuple[float, float]:
        """Place and speed of the structure."""
        from scipy.interpolate import BPoly

        times, _, states, _ = self.rows
        i = min(max(int(np.searchsorted(times, time, side="right")) - 1, 0), times.size - 2)
        if time <= times[i]:
            return float(states[i, 0]), float(states[i, self.bodies.mass.size])
        ends = np.column_stack([states[:, 0], states[:, self.bodies.mass.size], self.accelerations[:, 0]])[i : i + 2]
        piece = BPoly.from_derivatives(times[i : i + 2], ends)
        return float(piece(time)), float(piece(time, 1))
