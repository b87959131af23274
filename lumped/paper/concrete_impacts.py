"""Impacts of the paper's concrete striker, whose head and pole are not printed: radius and section are assumed.

Section 4.3: a force cut at a plateau, which lasts until the impulse is the uncut one's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws import correspondence
from lumped.materials import Material
from lumped.materials.networks import sls
from lumped.numbers import Array
from lumped.paper.given import Concrete, Examples
from lumped.paper.value import Value, closed, duration, peak, read
from lumped.result.history import History
from lumped.result.result import Result
from lumped.result.score import Curve
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes import Sphere

TOLERANCE = 1e-6  # of the impacts by the correspondence law
# The fit takes the printed moduli as contact moduli, so Poisson's ratio plays no part.
NU = 0.0


@cache
def proposed(concrete: Concrete, radius: float, velocity: float) -> Result:
    """The 3-parameter solid on a round head of this radius, m, at a velocity, m/s. Raises NotReached."""
    material = Material(sls.of_springs(E1=concrete.E1, E2=concrete.E2, C1=concrete.C1), NU)
    parabola = Model(profile="parabola")
    scene = Scene(Sphere(radius), concrete.mass, velocity, material, model=parabola, name="concrete striker")
    return correspondence.of(scene).simulate(scene, TOLERANCE)


def slow(c: Concrete) -> Result:
    """At the lower velocity, with the smallest assumed radius."""
    return proposed(c, min(c.radii), min(c.velocities))


def memory(e: Examples) -> list[Value]:
    """R2 and tau = C1/(E1 + E2), s; tau over the contact time, and the restitution, smallest assumed radius."""
    c, impact = e.concrete, slow(e.concrete)
    R2, tau = closed(c.C1 / c.E1, c.C1 / (c.E1 + c.E2))
    return [R2, tau, tau / duration(impact), read(impact, "restitution")]


@cache
def cut_at_measured_peak(concrete: Concrete) -> PlateauCut:
    """The force at the higher velocity cut at the experiment's peak, which its printed error tells.

    Over the uncut force and its duration no radius enters; the smallest assumed one is taken.
    """
    impact = proposed(concrete, min(concrete.radii), max(concrete.velocities))
    return plateau_cut(impact.history, peak(impact).value / (1.0 + concrete.peak_error))


@dataclass(frozen=True, eq=False)
class PlateauCut:
    """The cut force, and what the cut changes: duration, s, and impulse, N s, before and after."""

    curve: Curve
    duration: tuple[float, float]
    impulse: tuple[float, float]


def plateau_cut(history: History, plateau: float) -> PlateauCut:
    """The force of `history` until it first reaches `plateau`, N, then flat until the areas are equal.

    The area is the impulse, so the striker leaves as fast as without the cut. Raises BadInput for a plateau that
    the force does not reach.
    """
    time, force = np.asarray(history.time), np.asarray(history.force)
    if not force[0] < plateau < force.max():
        accepted = f"accepted: between the first force {force[0]:.6g} N and the peak {force.max():.6g} N"
        raise BadInput(Fault("plateau cut", "plateau", f"{plateau:.6g} N; {accepted}"))
    i = int(np.argmax(force >= plateau))
    reached = float(np.interp(plateau, force[i - 1 : i + 1], time[i - 1 : i + 1]))
    rising = np.append(time[:i], reached), np.append(force[:i], plateau)
    whole, before = _impulse(time, force), _impulse(*rising)
    end = reached + (whole - before) / plateau
    curve = Curve(np.append(rising[0], [end, end]), np.append(rising[1], [plateau, 0.0]))
    durations = float(time[-1] - time[0]), end - float(time[0])
    return PlateauCut(curve, durations, (whole, _impulse(curve.time, curve.force)))


def plateau(e: Examples) -> list[Value]:
    """The force at the higher velocity cut at the experiment's peak: duration, impulse over those of the uncut one."""
    cut = cut_at_measured_peak(e.concrete)
    # rows of the history are linear to its tolerance, and so are areas below them
    error = 2.0 * TOLERANCE
    return [Value(after / before, error * after / before) for before, after in (cut.duration, cut.impulse)]


def _impulse(time: Array, force: Array) -> float:
    return float(np.trapezoid(force, time))
