"""The free vibration of a pounding tuned mass damper: the march by either route, and what its track tells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault, NotReached, nearest
from lumped.ptmd import exact, integrated
from lumped.ptmd.equations import (
    ACCELERATION,
    DISPLACEMENT,
    LOST_STRUCTURE,
    Equations,
    SideStage,
    after,
    first_stages,
)
from lumped.ptmd.phase import ROWS_PER_PERIOD, Follow, PtmdPhase, row_spacing
from lumped.ptmd.result import Energy, Measures, PtmdContact, PtmdMotion, PtmdResult
from lumped.ptmd.system import SIDES, PoundingDamper, Start
from lumped.schema.keys import Key, Number, read_table

# How a phase is followed, and how many rows that may take.
ROUTES = {"exact": (exact.route, exact.MOST_ROWS), "integrated": (integrated.route, integrated.MOST_ROWS)}
TIME = Number(1e-9, 1e9, "s")
TIME_KEYS = {"end_time": Key(TIME, "when to stop", False), "window": Key(TIME, "of the root mean squares", False)}
MOST_SWITCHES = 20_000  # work: of contact, in one vibration
Array = NDArray[np.float64]
# Rows miss the top of a vibration by no more than this share of it.
ROW_LOSS = 0.01
NEAREST = 1e-7  # share of two rows to which a top is located; its height errs by the square


def simulate(
    system: PoundingDamper,
    start: Start,
    end_time: float = 20.0,
    window: float = 5.0,
    route: str | None = None,
    rows_per_period: int = ROWS_PER_PERIOD,
) -> PtmdResult:
    """Vibration from `start` to `end_time`, s; root mean squares over the first `window` seconds.

    `route`: "exact" (default for exponent 1: matrix exponentials between located switches) or "integrated"
    (any exponent: DOP853). Rows lie `rows_per_period` to the shortest period. Raises BadInput and NotReached.
    """
    _, faults = read_table("simulate", "", {"end_time": end_time, "window": window}, TIME_KEYS)
    equations = Equations(system)
    route = route or ("exact" if equations.linear else "integrated")
    if route not in ROUTES:
        faults.append(Fault("simulate", "route", f"accepted: {', '.join(ROUTES)}{nearest(route, tuple(ROUTES))}"))
    elif route == "exact" and not equations.linear:
        faults.append(Fault("simulate", "route", "exact only for exponent 1; accepted here: integrated"))
    if system.damper is None and not (start.x1 or start.v1):
        faults.append(Fault("start", "x1", "nothing moves without a damper; accepted: x1 or v1 that is not zero"))
    if faults:
        raise BadInput(faults)
    follow, most_rows = ROUTES[route]
    spacing = row_spacing(equations, start, end_time, rows_per_period, most_rows)
    track = PtmdTrack(equations, march(equations, start, end_time, follow(equations, start, spacing, end_time)))
    found = contacts(track)
    return PtmdResult(
        system=system,
        start=start,
        motion=motion(track),
        contacts=found,
        energy=energy(track),
        measures=measures(track, found, window),
    )


def march(equations: Equations, start: Start, end_time: float, follow: Follow) -> tuple[PtmdPhase, ...]:
    """The phases from t = 0 to `end_time`, s. Raises NotReached when the ring switches without end."""
    phases: list[PtmdPhase] = []
    state, time = equations.initial(start), 0.0
    stages = first_stages(equations, state)
    for _ in range(MOST_SWITCHES):
        phase, switch = follow(stages, state, time)
        # A switch may be followed by another at the same instant: nothing happens in between.
        phases += [phase] if phase.end > phase.start else []
        if switch is None or phase.end >= end_time:
            return tuple(phases)
        time = phase.end
        stages, state = after(equations, stages, switch, phase.states[:, -1])
    raise NotReached(f"more than {MOST_SWITCHES} switches of contact before t = {time:.6g} s; cure: lower end_time")


def motion(track: PtmdTrack) -> PtmdMotion:
    """The rows of the phases."""
    equations, y = track.equations, track.states
    absent = np.full(track.times.size, np.nan)
    damped, ringed = equations.system.damper is not None, equations.surface is not None

    def second(phase: PtmdPhase, states: Array) -> Array:
        found = _accelerations(equations, phase, states)[1]
        return np.full(phase.times.size, np.nan) if found is None else found

    deepest = np.max([equations.depth(side, y) for side in range(len(SIDES))], axis=0) if ringed else absent * 0.0
    return PtmdMotion(
        time=track.times,
        x1=y[0],
        v1=y[1],
        a1=track.rows(lambda phase, states: _accelerations(equations, phase, states)[0]),
        x2=y[2] if damped else absent,
        v2=y[3] if damped else absent,
        a2=track.rows(second),
        force=track.rows(lambda phase, states: equations.force(phase.stages, equations.moving(phase.stages, states))),
        depth=np.maximum(deepest, 0.0) if ringed else np.zeros(track.times.size),
    )


def _accelerations(equations: Equations, phase: PtmdPhase, states: Array) -> tuple[Array, Array | None]:
    """Of both bodies in states of a phase, (size, ...), m/s2."""
    return equations.accelerations(phase.stages, equations.moving(phase.stages, states))


def contacts(track: PtmdTrack) -> tuple[PtmdContact, ...]:
    """Every phase in which a side is pressed, phases of one contact joined."""
    found: list[PtmdContact] = []
    for index, side in enumerate(SIDES):
        run: list[PtmdPhase] = []
        for phase in track.phases:
            if index < len(phase.stages) and phase.stages[index] is SideStage.PRESSED:
                run.append(phase)
            elif run:
                found.append(_contact(track, index, side, run))
                run = []
        found += [_contact(track, index, side, run)] if run else []
    return tuple(sorted(found, key=lambda contact: contact.start))


def _contact(track: PtmdTrack, index: int, side: int, run: list[PtmdPhase]) -> PtmdContact:
    equations = track.equations

    def force(phase: PtmdPhase, states: Array) -> Array:
        return equations.side_force(index, SideStage.PRESSED, states)

    def depth(phase: PtmdPhase, states: Array) -> Array:
        return equations.depth(index, states)

    end = run[-1].end if run[-1] is not track.phases[-1] else None
    peak_force, peak_depth = (max(highest_of(phase, reading) for phase in run) for reading in (force, depth))
    return PtmdContact(side, run[0].start, end, peak_force, peak_depth)


def energy(track: PtmdTrack) -> Energy:
    """Each term on its own: the first and the last state, and the integrated losses."""
    equations, integrals = track.equations, track.integrals(track.end)
    first, last = track.phases[0].states[:, 0], track.phases[-1].states[:, -1]
    lost_structure, lost_damper, lost_ring, cut = (float(value) for value in integrals[LOST_STRUCTURE:])
    stored = _stored(equations, last)
    before = _stored(equations, first) if equations.linear else _relaxed_work(equations, first)
    at_once = _forgotten(track) if equations.linear else before
    return Energy(
        initial=equations.kinetic(first) + equations.potential(first) + before,
        kinetic=equations.kinetic(last),
        potential=equations.potential(last),
        lost_structure=lost_structure,
        lost_damper=lost_damper,
        lost_ring=lost_ring + at_once,
        stored_ring=stored if equations.linear else None,
        cut_tension=cut,
    )


def _stored(equations: Equations, y: Array) -> float:
    """Energy in the springs of both sides, for exponent 1, J."""
    surface = equations.surface
    return sum(surface.stored(y[equations.side(index)]) for index in range(len(SIDES))) if surface else 0.0


def _relaxed_work(equations: Equations, y: Array) -> float:
    """Work that presses the relaxed ring slowly to where it is, any exponent, J."""
    ring = equations.system.ring
    if ring is None:
        return 0.0
    depths = [max(float(equations.depth(index, y)), 0.0) for index in range(len(SIDES))]
    power = ring.exponent + 1.0
    return float(sum(ring.stiffness.relaxed * depth**power / power for depth in depths))


def _forgotten(track: PtmdTrack) -> float:
    """Energy that the ring loses at once where its memory is reset, J."""
    ends = ((a.states[:, -1], b.states[:, 0]) for a, b in pairwise(track.phases))
    return sum(_stored(track.equations, end) - _stored(track.equations, start) for end, start in ends)


def measures(track: PtmdTrack, found: tuple[PtmdContact, ...], window: float) -> Measures:
    """The measures, with the contacts of the same track."""
    equations, span = track.equations, min(window, track.end)
    squares = track.integrals(span) / span
    release = abs(float(track.states[0, 0]))
    later = [contact for contact in found if contact.start > 0.0 and contact.end is not None]
    return Measures(
        window=span,
        max_acceleration=track.highest(lambda phase, y: np.abs(_accelerations(equations, phase, y)[0])),
        rms_acceleration=float(np.sqrt(squares[ACCELERATION])),
        rms_displacement=float(np.sqrt(squares[DISPLACEMENT])),
        t50=track.last_above(0.5 * release) if release else None,
        t10=track.last_above(0.1 * release) if release else None,
        contacts=len(found),
        last_contact=(found[-1].end or track.end) if found else None,
        first_contact_duration=later[0].end - later[0].start if later and later[0].end else None,
        peak_force=max((contact.peak_force for contact in found), default=0.0),
        peak_depth=max((contact.peak_depth for contact in found), default=0.0),
    )


@dataclass(frozen=True, eq=False)
class PtmdTrack:
    """Phases that follow one another from t = 0."""

    equations: Equations
    phases: tuple[PtmdPhase, ...]

    @property
    def end(self) -> float:
        """Last instant, s."""
        return self.phases[-1].end

    @cached_property
    def times(self) -> Array:
        """Times of all rows, s, shape (k,); twice at a switch, where a force may jump."""
        return np.concatenate([phase.times for phase in self.phases])

    @cached_property
    def states(self) -> Array:
        """States of all rows, shape (size, k)."""
        return np.concatenate([phase.states for phase in self.phases], axis=1)

    @cached_property
    def _starts(self) -> Array:
        return np.array([phase.start for phase in self.phases])

    def rows(self, reading: Callable[[PtmdPhase, Array], Array]) -> Array:
        """A reading of every row: `reading` maps a phase and its states (size, ...) to (...)."""
        return np.concatenate([reading(phase, phase.states) for phase in self.phases])

    def at(self, time: float) -> Array:
        """The state at a time, s, shape (size,)."""
        return self.phases[max(int(np.searchsorted(self._starts, time, side="right")) - 1, 0)].at(time)

    def integrals(self, time: float) -> Array:
        """Integrals of the equations' integrands from 0 to a time, s, shape (6,)."""
        parts = [phase.integrals(min(time, phase.end)) for phase in self.phases if phase.start < time]
        return np.asarray(np.sum(parts, axis=0))

    def highest(self, reading: Callable[[PtmdPhase, Array], Array]) -> float:
        """The largest value of a reading of all phases, between the rows too."""
        tops = [float(np.max(reading(phase, phase.states))) for phase in self.phases]
        least = max(tops) - ROW_LOSS * abs(max(tops))
        near = [phase for phase, top in zip(self.phases, tops, strict=True) if top >= least]
        return max(highest_of(phase, reading) for phase in near)

    @cached_property
    def turns(self) -> list[float]:
        """Times at which the structure turns, s, ascending, with both ends of the motion."""
        from scipy.optimize import brentq

        back = np.signbit(self.states[1])
        pairs = ((self.times[i], self.times[i + 1]) for i in np.flatnonzero(back[:-1] != back[1:]))
        between = (float(brentq(lambda time: self.at(time)[1], low, high, xtol=1e-13)) for low, high in pairs)
        return sorted([0.0, *between, self.end])

    def last_above(self, level: float) -> float | None:
        """When |x1| exceeds a level, m, for the last time, s; None while it still does at the end."""
        from scipy.optimize import brentq

        turns = self.turns
        heights = [float(self.at(time)[0]) for time in turns]
        above = [i for i, height in enumerate(heights) if abs(height) >= level]
        if not above or above[-1] == len(turns) - 1:
            return None
        sign = np.sign(heights[above[-1]])
        after, before = turns[above[-1]], turns[above[-1] + 1]
        return float(brentq(lambda time: sign * self.at(time)[0] - level, after, before, xtol=1e-13))


def highest_of(phase: PtmdPhase, reading: Callable[[PtmdPhase, Array], Array]) -> float:
    """The largest value of a reading of one phase, between the rows too."""
    from scipy.optimize import minimize_scalar

    values = reading(phase, phase.states)
    i = int(np.argmax(values))
    around = phase.times[max(i - 1, 0) : i + 2]
    width = float(around[-1] - around[0])
    if width == 0.0:
        return float(values[i])
    found = minimize_scalar(
        lambda share: -float(reading(phase, phase.at(float(around[0] + share * width)))),
        bounds=(0.0, 1.0),
        method="bounded",
        options={"xatol": NEAREST},
    )
    return max(float(values[i]), -float(found.fun))
