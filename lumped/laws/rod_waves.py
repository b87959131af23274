"""The exact impact on an elastic rod, by its waves: St Venant's series for a flat end, else a dent that presses."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws._assembly import Answer, assemble, bars, values_of
from lumped.laws.base import LawKind, check_geometry
from lumped.numbers import Array, Clock, highest
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.solvers.rod import LONGEST, FlatImpact, TippedImpact, Waves
from lumped.targets.rod import Rod

COARSEST, FINEST, FINER = 1e-6, 1e-12, 1e-3  # of the tolerance, asked of every step
COARSER = 1e2  # where what is left of the error shows
# The longest steps of the coarser answer over those of the finer: where no tolerance binds both would take the same
# steps, and differ by nothing.
LONGER = 2.0
SAFETY = 2.0  # safety: of the bars, over the change from the coarser run
PLACES = 400  # in the history, where peaks are looked for


@dataclass(frozen=True)
class RodWaves:
    """The law; everything it needs is in the scene."""

    name: ClassVar[str] = "rod_waves"
    needs_mass: ClassVar[bool] = True

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """One impact to this tolerance. Raises NotReached."""
        clock, rtol = Clock(), max(min(FINER * tolerance, COARSEST), FINEST)
        fine = _answer(scene, rtol)
        coarse = fine if scene.profile.fixed_radius else _answer(scene, rtol * COARSER, LONGER * LONGEST)
        quantities, force_error = bars(fine, coarse, SAFETY)
        integration: Table = {"rtol": rtol} if coarse is not fine else {"series": "exact"}
        work, model = {"echoes": int(fine.times.size // PLACES) - 1}, scene.model
        return assemble(self.name, scene, tolerance, fine, quantities, force_error, clock, integration, work, model)


def of(scene: Scene) -> RodWaves:
    """The law for a scene. Raises BadInput where the target is no elastic rod, or several impacts are asked for."""
    check_geometry(scene, RodWaves.name)
    scene.check_single(RodWaves.name)
    if not isinstance(scene.target, Rod):
        reason = f"rod_waves is not for this {scene.target.name}, but for a rod; accepted: rod, or another method"
        raise BadInput(Fault(scene.source, "target.shape", reason))
    if not scene.geometry.material.young.is_elastic:
        reason = "its waves disperse, which rod_waves does not follow; accepted: elastic, or --method fe"
        raise BadInput(Fault(scene.source, "target.material.law", reason))
    return RodWaves()


def _answer(scene: Scene, rtol: float, longest: float = LONGEST) -> Answer:
    """One integration of the scene; of a flat end the series, whatever ``rtol`` and the ``longest`` step."""
    impact = _impact(scene, rtol, longest)
    _, end, separated = impact.pieces
    breaks = np.append(impact.starts, end)
    between = [np.union1d(np.linspace(*ends, PLACES + 1), impact.steps(*ends)) for ends in pairwise(breaks)]
    rows = np.unique(np.concatenate(between))
    depth, velocity, _, _ = impact.columns(rows)
    ending = End.SEPARATED if separated else End.TIME
    deepest = highest(lambda t: impact.columns(t)[0], rows)[1]
    values = values_of(scene, ending, _peak(impact, between), deepest, float(velocity[-1]), end)
    columns = _RodColumns(scene, impact, end if separated else np.inf)
    energy = _energy(scene, impact, rows, float(depth[-1]), float(velocity[-1]))
    return Answer(rows, columns, values, ending, energy, "" if separated else ending.value)


def _impact(scene: Scene, rtol: float, longest: float) -> FlatImpact | TippedImpact:
    waves = Waves.of(scene)
    shape, mass, velocity, until = scene.profile, scene.reduced_mass, scene.velocity, scene.end_time
    if shape.fixed_radius is not None:
        return FlatImpact(waves, mass, velocity, scene.gravity, until)
    modulus = shape.modulus(scene.geometry.material).relaxed
    curve, elastic = shape.load_curve, shape.hertz_impact(modulus, mass, velocity)
    return TippedImpact(
        waves=waves,
        force=lambda dent: modulus * curve.force(dent),
        mass=mass,
        velocity=velocity,
        gravity=scene.gravity,
        until=until,
        depth=elastic.depth,
        time=elastic.duration,
        rtol=rtol,
        longest=longest,
    )


@dataclass(frozen=True)
class _RodColumns:
    """Depth, velocity, force, contact radius at times (n,), shape (4, n); nothing presses from the end on."""

    scene: Scene
    impact: FlatImpact | TippedImpact
    end: float

    def __call__(self, times: Array) -> Array:
        columns = self.impact.columns(times)
        columns[2] = np.where(times < self.end, np.maximum(columns[2], 0.0), 0.0)
        radius = self.scene.profile.fixed_radius
        if isinstance(self.impact, TippedImpact):
            columns[3] = self.scene.profile.load_curve.contact_radius(self.impact.dents(times))
        else:
            columns[3] = radius
        return columns

    def force(self, times: Array) -> Array:
        """The force alone, shape (n,), N."""
        return np.asarray(self(times)[2])


def _peak(impact: FlatImpact | TippedImpact, between: list[Array]) -> tuple[float, float]:
    """Time and height of the greatest force: ``between`` two echoes it is smooth, at one it may jump, up or down."""
    found = []
    for places in between:
        rows = np.append(places[:-1], np.nextafter(places[-1], places[0]))
        found.append(highest(lambda t: impact.columns(t)[2], rows))
        found.append((float(rows[0]), float(impact.columns(rows[:1])[2, 0])))
    return max(found, key=lambda place: place[1])


def _energy(
    scene: Scene, impact: FlatImpact | TippedImpact, rows: Array, depth: float, velocity: float
) -> dict[str, float | None]:
    """Energies at the end, J; ``stored``: in the waves on the rod's length and in the dent, if it is still there."""
    given = 0.5 * scene.reduced_mass * scene.velocity**2 + scene.reduced_mass * scene.gravity * depth
    out = 0.5 * scene.reduced_mass * velocity**2
    held, radiated = impact.waves.energies(lambda t: impact.columns(t)[3], rows)
    if isinstance(impact, TippedImpact):
        modulus = scene.contact_modulus.relaxed
        held += modulus * float(scene.profile.load_curve.energy(float(impact.dents(rows[-1:])[0])))
    residual = given - out - held - radiated
    return {"in": given, "out": out, "stored": held, "viscous": 0.0, "radiated": radiated, "residual": residual}


MEMBER = LawKind(of, __doc__, leaves_out=lambda scene: "", seconds=0.01, elastic=True)
