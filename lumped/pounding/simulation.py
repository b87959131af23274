"""The motion of frames under a ground motion: marched once, and what is kept of every step.

That is rows, peaks between them, contacts, and energies summed by the steps' own quadrature.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np
from numpy.polynomial.legendre import legder, legroots, legval, legvander
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.laws._force_law import ForceLaw
from lumped.numbers import Array
from lumped.pounding.flow import TERMS, FrameFlow
from lumped.pounding.frames import PoundingFrames
from lumped.pounding.gaps import FrameStep, GapState, Mode
from lumped.pounding.ground import STILL, GroundMotion
from lumped.pounding.march import FrameMarch, FramesFlight, OnTime, ignore, rows
from lumped.pounding.trial import FramesAt, Rules
from lumped.schema import Table
from lumped.solvers.point.bodies import TINY, State
from lumped.solvers.radau import NODES, STAGES, Nodes

TOGETHER = 64  # work: steps that are accounted for at once
# Safety: shares of a peak by which the points of its step, and AMONG them these places, may all be lower.
POINTS_APART, AMONG_APART = 0.1, 5e-3
AMONG = legvander(np.linspace(-1.0, 1.0, 33), STAGES - 1)


def simulate(
    frames: PoundingFrames,
    laws: Sequence[ForceLaw] = (),
    ground: GroundMotion = STILL,
    end_time: float = 20.0,
    tolerance: float = 1e-10,
    on_time: OnTime = ignore,
) -> FramesResult:
    """The frames from their start to `end_time`, s, a law for each gap.

    `tolerance`: error of a relative speed in one step of a contact, over the speed at touch; `on_time` is told how
    far the motion is, s. Raises BadInput, and NotReached where contacts do not end.
    """
    if len(laws) != len(frames.gaps):
        raise BadInput(Fault("simulate", "laws", f"{len(laws)}; accepted: one for each of {len(frames.gaps)} gaps"))
    times, longest = rows(frames.bodies, ground, end_time)
    march = FrameMarch(Rules(FrameFlow(frames.bodies, longest), laws, tolerance), ground)
    account = Account(frames, march)
    march.run(times, account, on_time=on_time)
    return account.result()


@dataclass
class Peaks:
    """The largest sizes of some numbers, and the polynomials over the place in the steps where they were.

    Of two peaks nearly as high the higher one may be lower at the points of its step: all such steps are looked into.
    """

    size: Array
    series: Array

    @classmethod
    def of(cls, count: int) -> Peaks:
        """Nothing yet."""
        return cls(np.zeros(count), np.zeros((STAGES, count)))

    def see(self, values: Array, nodes: Nodes) -> NDArray[np.bool_]:
        """Values at the points of one step or more, (..., s, n); which rise higher than any before, (n,)."""
        steps = values.reshape(-1, *values.shape[-2:])
        sizes, before = np.abs(steps).max(axis=1), self.size.copy()
        which, columns = np.nonzero(sizes > (1.0 - POINTS_APART) * np.maximum(sizes.max(axis=0), self.size))
        series = nodes.series @ steps[which, :, columns].T
        heights = np.abs(AMONG @ series).max(axis=0)
        for k in np.argsort(-heights).tolist():
            i = columns[k]
            if heights[k] > (1.0 - AMONG_APART) * self.size[i]:
                height = _top(series[:, k])[1]
                if height > self.size[i]:
                    self.size[i], self.series[:, i] = height, series[:, k]
        return np.asarray(self.size > before)

    def top(self, i: int) -> tuple[float, float]:
        """Place in its step, and height."""
        return _top(self.series[:, i])[0], float(self.size[i])


def _top(series: Array) -> tuple[float, float]:
    """Place and size of the largest that a polynomial over the place has within its step."""
    turns = legroots(legder(series)) if series[1:].any() else np.zeros(0)
    inside = np.real(turns[(np.imag(turns) == 0.0) & (np.abs(turns) < 1.0)])
    places = np.concatenate([inside, [-1.0, 1.0]])
    heights = np.abs(legval(places, series))
    best = int(heights.argmax())
    return 0.5 * (1.0 + float(places[best])), float(heights[best])


@dataclass
class OpenContact:
    """A contact that is under way: touched at `start`, s, at `closing`, m/s; its largest force so far and where."""

    start: float
    closing: float
    impulse: float = 0.0
    peak: Peaks = field(default_factory=lambda: Peaks.of(1))
    step: tuple[float, FrameStep] | None = None

    def see(self, time: float, step: FrameStep, gap: int) -> None:
        """One step more, from `time`, s, on."""
        self.impulse += step.length * float(step.nodes.weights @ step.gain[gap])
        if self.peak.see(step.force[gap][:, None], step.nodes)[0] or self.step is None:
            self.step = time, step

    def contact(self, gap: str, end: float | None, rate: float) -> FrameContact:
        """As it is known when it ends; at the end of the motion None."""
        place, height = self.peak.top(0)
        time, step = self.step or (self.start, None)
        share = 0.0 if step is None else float(np.interp(place, step.nodes.places, step.nodes.points, left=0.0))
        parted = None if end is None or self.closing <= 0.0 else -rate / self.closing
        peak_time = time + share * (0.0 if step is None else step.length)
        return FrameContact(gap, self.start, end, height, peak_time, self.impulse, self.closing, parted)


class Account:
    """Listens to a march."""

    def __init__(self, frames: PoundingFrames, march: FrameMarch) -> None:
        self.march, self.flow, self.frames = march, march.rules.flow, frames
        self.names = tuple(frames.gaps)
        self.times, self.states = [0.0], [frames.bodies.start]
        self.forces = [np.zeros(len(frames.gaps))]
        self.peaks = Peaks.of(4 * frames.mass.size)
        self.open: dict[int, OpenContact] = {}
        self.contacts: list[FrameContact] = []
        self.input = self.damping = self.lost = 0.0
        self.steps = self.pressed_steps = 0
        self.last: FramesAt | None = None
        self.waiting: list[tuple[Array, ...]] = []

    def flight(self, flight: FramesFlight) -> None:
        """Rows of the march without contact."""
        count, weights = flight.times.size - 1, np.diff(flight.times)[:, None] * NODES.weights
        self.steps += count
        self._account(weights, flight.within, np.zeros((*weights.shape, len(self.names))), flight.ground)
        self.times += flight.times[1:].tolist()
        self.states += list(flight.states[1:])
        self.forces += [np.zeros(len(self.names))] * count

    def step(self, at: FramesAt, step: FrameStep, to: FramesAt) -> None:
        """One step of the march."""
        pressed = [i for i, gap in enumerate(at.gaps) if gap.mode is Mode.PRESSED]
        self.steps, self.pressed_steps = self.steps + 1, self.pressed_steps + bool(pressed)
        self._sum(at, step, pressed)
        for i in pressed:
            if i not in self.open:
                self.open[i] = OpenContact(at.time, float(step.first_rate[i]))
                self.lost -= self._stored(i, at.gaps[i], float(at.depths[i]))
            self.open[i].see(at.time, step, i)
            if to.gaps[i].mode is not Mode.PRESSED:
                self.contacts.append(self.open.pop(i).contact(self.names[i], to.time, float(step.rate[i, -1])))
                self.lost += self._stored(i, at.gaps[i], float(step.depth[i, -1]))
        self.times.append(to.time)
        self.states.append(to.state)
        self.forces.append(step.force[:, -1] * [gap.mode is Mode.PRESSED for gap in to.gaps])
        self.last = to

    def _sum(self, at: FramesAt, step: FrameStep, pressed: list[int]) -> None:
        """One step to be accounted for; losses in its contacts."""
        weights = step.length * step.nodes.weights * step.nodes.pace
        shares = self.flow.shares(step.nodes, step.length)[:, :TERMS]
        ground = shares @ self.march.ground.series(at.time, self.flow.unit, TERMS)
        self._account(weights[None], step.states[None], step.force.T[None], ground[None])
        for i in pressed:
            known = State(float(at.depths[i]), float(step.first_rate[i]), 0.0, at.gaps[i].memory)
            law = self.march.rules.laws[i].within(known, step.length)
            depth = np.maximum(step.depth[i], TINY)
            self.lost += float(weights @ (law.lost(depth, step.rate[i], at.gaps[i].stage) * step.rate[i]))

    def _account(self, *rows: Array) -> None:
        """Weights in time (r, s), states (r, s, 2 n), forces (r, s, m) and ground (r, s) of r steps more."""
        self.waiting.append(rows)
        if sum(one[0].shape[0] for one in self.waiting) >= TOGETHER:
            self._close()

    def _close(self) -> None:
        """Work of the ground, losses in the structures, and peaks, of all steps that wait."""
        if not self.waiting:
            return
        weights, states, forces, ground = map(np.concatenate, zip(*self.waiting, strict=True))
        self.waiting.clear()
        speeds, n = states[..., self.flow.size :], self.frames.mass.size
        self.input -= float((weights * ground * (speeds[..., :n] @ self.frames.mass)).sum())
        self.damping += float((weights * ((speeds @ self.frames.bodies.damping) * speeds).sum(axis=-1)).sum())
        self.peaks.see(self._values(states, forces), NODES)

    def _values(self, states: Array, forces: Array) -> Array:
        """Displacement, drift, total acceleration and speed of every storey, (..., 4 n)."""
        places, speeds = self._of_storeys(states)
        drifts, accelerations = places @ self.frames.to_drift.T, self._accelerations(states, forces)
        return np.concatenate([places, drifts, accelerations, speeds], axis=-1)

    def _of_storeys(self, states: Array) -> tuple[Array, Array]:
        """Displacements, m, and velocities, m/s, of the storeys, both (..., n)."""
        n, first = self.frames.mass.size, self.flow.size
        return states[..., :n], states[..., first : first + n]

    def _accelerations(self, states: Array, forces: Array) -> Array:
        """Total ones of the storeys, m/s2, (..., n)."""
        return self.frames.bodies.accelerations(states, forces)[..., : self.frames.mass.size]

    def _stored(self, i: int, gap: GapState, depth: float) -> float:
        return float(self.march.rules.laws[i].stored(max(depth, 0.0), gap.stage))

    def result(self) -> FramesResult:
        """All of it."""
        self._close()
        time, states, forces = np.array(self.times), np.array(self.states), np.array(self.forces)
        (places, speeds), frames = self._of_storeys(states), self.frames
        motion = FramesMotion(
            time,
            places,
            places @ frames.to_drift.T,
            speeds,
            self._accelerations(states, forces),
            self.march.ground.acceleration(time),
            forces,
        )
        still = [one.contact(self.names[i], None, 0.0) for i, one in self.open.items()]
        contacts = tuple(sorted([*self.contacts, *still], key=lambda contact: (contact.start, contact.gap)))
        return FramesResult(frames, motion, contacts, self._peaks(), self._energy(), self.steps, self.pressed_steps)

    def _peaks(self) -> tuple[StoreyPeaks, ...]:
        displacement, drift, acceleration, speed = self.peaks.size.reshape(4, -1)
        strain, kinetic = 0.5 * self.frames.columns * drift**2, 0.5 * self.frames.mass * speed**2
        columns = np.array([displacement, drift, acceleration, strain, kinetic]).T.tolist()
        return tuple(StoreyPeaks(*column) for column in columns)

    def _energy(self) -> FramesEnergy:
        first, last = self.states[0], self.states[-1]
        return FramesEnergy(
            initial=sum(self.frames.bodies.energies(first)),
            input=self.input,
            kinetic=self.frames.bodies.energies(last)[0],
            strain=self.frames.bodies.energies(last)[1],
            damping=self.damping,
            contact=self.lost,
            contact_stored=self._held(),
        )

    def _held(self) -> float:
        """What contacts that are still under way could give back, J."""
        if self.last is None:
            return 0.0
        return sum(self._stored(i, self.last.gaps[i], float(self.last.depths[i])) for i in self.open)


@dataclass(frozen=True, eq=False)
class FramesMotion:
    """Rows of time, s, (k,): displacements and drifts, m, velocities, m/s, and total accelerations, m/s2, (k, n); the
    ground's, m/s2, (k,); forces of the gaps, N, (k, m).
    """

    time: Array
    displacement: Array
    drift: Array
    velocity: Array
    acceleration: Array
    ground: Array
    force: Array


@dataclass(frozen=True)
class FrameContact:
    """One contact: its gap; start and end, s; largest force, N, and when, s; impulse, N s.

    `closing`: the speed at touch, m/s; `restitution`: that at the end over it. `end` and `restitution` are None where
    it lasts to the end of the motion.
    """

    gap: str
    start: float
    end: float | None
    peak_force: float
    peak_time: float
    impulse: float
    closing: float
    restitution: float | None


@dataclass(frozen=True)
class StoreyPeaks:
    """The largest of each, in size: displacement and drift, m, total acceleration, m/s2; strain energy of the columns
    below and kinetic energy, J.
    """

    displacement: float
    drift: float
    acceleration: float
    strain: float
    kinetic: float


@dataclass(frozen=True)
class FramesEnergy:
    """Where the energy is at the end, J, relative to the ground; each term computed on its own.

    `initial` at t = 0, `input` what the ground did since; lost in the structures' dashpots and in contacts, and what
    contacts still hold.
    """

    initial: float
    input: float
    kinetic: float
    strain: float
    damping: float
    contact: float
    contact_stored: float

    @property
    def residual(self) -> float:
        """What is left of the balance, J."""
        spent = self.damping + self.contact
        return self.initial + self.input - spent - self.kinetic - self.strain - self.contact_stored

    @property
    def open_share(self) -> float:
        """The residual over all that came in and was there, or was lost since."""
        whole = self.initial + abs(self.input) + self.damping + abs(self.contact)
        return abs(self.residual) / whole if whole else 0.0

    def to_dict(self) -> dict[str, float]:
        """The terms and the residual, J."""
        return asdict(self) | {"residual": self.residual}


@dataclass(frozen=True, eq=False)
class FramesResult:
    """One motion of frames. `steps`: how many it took, `pressed_steps` those of them within contacts."""

    frames: PoundingFrames
    motion: FramesMotion
    contacts: tuple[FrameContact, ...]
    peaks: tuple[StoreyPeaks, ...]
    energy: FramesEnergy
    steps: int
    pressed_steps: int

    @property
    def peak_force(self) -> float:
        """Of all contacts, N."""
        return max((contact.peak_force for contact in self.contacts), default=0.0)

    @property
    def impulse(self) -> float:
        """Of all contacts together, N s."""
        return sum(contact.impulse for contact in self.contacts)

    def measures(self) -> Table:
        """The numbers that tell one motion from another, SI."""
        found: Table = {
            "peak_drift": max(one.drift for one in self.peaks),
            "peak_displacement": max(one.displacement for one in self.peaks),
            "peak_acceleration": max(one.acceleration for one in self.peaks),
            "peak_force": self.peak_force,
            "impulse": self.impulse,
            "contacts": len(self.contacts),
        }
        return found
