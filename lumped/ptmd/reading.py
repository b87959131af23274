"""From the track of a motion to its rows, contacts, energies and measures."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.equations import ACCELERATION, DISPLACEMENT, LOST_STRUCTURE, Equations
from lumped.ptmd.phase import PtmdPhase
from lumped.ptmd.result import Energy, Measures, PtmdContact, PtmdMotion
from lumped.ptmd.surface import SideStage
from lumped.ptmd.system import SIDES
from lumped.ptmd.track import PtmdTrack, highest_of

Array = NDArray[np.float64]


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
