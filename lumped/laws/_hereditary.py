"""What the laws integrated by scipy share: two integrations, the bars from their difference, the Result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ending import End
from lumped.hereditary.problem import Hereditary
from lumped.hereditary.solve import STIFF, Settings
from lumped.interpolation import highest
from lumped.laws._assembly import Answer, Clock, assemble, bars
from lumped.materials import Relaxation
from lumped.result import Result, meets
from lumped.scene import Model, Scene
from lumped.shapes import Shape

Array = NDArray[np.float64]
# The integrators err globally by some hundred times their local tolerance.
LOCAL_SHARE = 1e-2
LOOSEST, TIGHTEST = 1e-7, 1e-12
NEXT = 0.1
# The looser integration is the bar of the tighter one, which errs several times less.
SAFETY = 2.0


@dataclass(frozen=True)
class Curves:
    """One integration: dimensionless force and depth over the root of time, for the peaks, and how it ended.

    `columns` maps times in s to depth, velocity, force and contact radius, SI, shape (4, n).
    """

    force: Callable[[Array], Array]
    depth: Callable[[Array], Array]
    roots: Array
    times: Array
    columns: Callable[[Array], Array]
    last: Array
    end_time: float
    end: End
    evaluations: int


def simulate(
    name: str,
    scene: Scene,
    profile: Shape,
    modulus: Relaxation,
    tolerance: float,
    solve: Callable[[Hereditary, float, Settings], Curves],
    model: Model | None = None,
    message: str = "",
) -> Result:
    """Integrate tighter and tighter until every bar is within the tolerance. Raises NotReached."""
    clock = Clock()
    problem = Hereditary.of(
        profile.load_curve,
        modulus,
        scene.reduced_mass,
        scene.velocity,
        scene.gravity,
        scene.elastic_contact_time,
    )
    elastic = profile.hertz_impact(problem.scales.unit, scene.reduced_mass, scene.velocity)
    stiff = problem.stiffest(elastic.contact_radius) > STIFF
    rtol = min(max(tolerance * LOCAL_SHARE, TIGHTEST / NEXT), LOOSEST)
    curves = solve(problem, scene.end_time, Settings(rtol, stiff))
    evaluations, coarse = curves.evaluations, _answer(scene, problem, curves, message)
    while True:
        rtol *= NEXT
        curves = solve(problem, scene.end_time, Settings(rtol, stiff))
        evaluations += curves.evaluations
        fine = _answer(scene, problem, curves, message)
        quantities, force_error = bars(fine, coarse, SAFETY)
        if meets(quantities, tolerance) or rtol * NEXT < TIGHTEST:
            break
        coarse = fine
    numerics = {"integrator": Settings(rtol, stiff).method, "rtol": rtol}
    work = {"force_evaluations": evaluations}
    return assemble(name, scene, tolerance, fine, quantities, force_error, clock, numerics, work, model)


def _answer(scene: Scene, problem: Hereditary, curves: Curves, message: str) -> Answer:
    scales, separated = problem.scales, curves.end is End.SEPARATED
    root, force = highest(curves.force, curves.roots)
    _, depth = highest(curves.depth, curves.roots)
    velocity = float(curves.last[1]) * scales.velocity
    duration = curves.end_time * scales.time
    impulse = scene.reduced_mass * (scene.velocity - velocity + scene.gravity * duration)
    values: Mapping[str, float | None] = {
        "peak_force": force * scales.force,
        "peak_time": root**2 * scales.time,
        "peak_depth": depth * scales.depth,
        "duration": duration if separated else None,
        "restitution": -velocity / scene.velocity if separated else None,
        "impulse": None if curves.end is End.SECOND_APPROACH else impulse,
    }
    said = "; ".join(part for part in (message, "" if separated else curves.end.value) if part)
    times = curves.times * scales.time
    return Answer(times, curves.columns, values, curves.end, _energy(scene, problem, curves), said)


def _energy(scene: Scene, problem: Hereditary, curves: Curves) -> dict[str, float | None]:
    """Energies, J. `viscous` is the work done on the target and not given back: spent by now, or later."""
    depth, velocity, work = (float(value) for value in curves.last[:3])
    unit = scene.reduced_mass * scene.velocity**2
    given, out = 0.5 * unit + unit * problem.gravity * depth, 0.5 * unit * velocity**2
    return {"in": given, "out": out, "viscous": unit * work, "residual": given - out - unit * work}
