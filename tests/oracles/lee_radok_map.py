"""How far the paper's clipped correspondence law errs in a rebound: Lee-Radok against Ting, over material and time.

A rigid striker with F ~ depth^alpha, a paraboloid (3/2), cone (2) or flat punch (1), strikes a half-space of the
3-parameter solid. Without dimension only two numbers are left beside alpha: the instantaneous over the relaxed modulus,
and the relaxation time over the elastic contact time T_E of the relaxed one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from lumped.errors import NotReached
from lumped.laws import correspondence, ting
from lumped.materials import Material, Relaxation
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes import Shape, Sphere

# Any mass, velocity and size will do, the answers are without dimension.
PARABOLOID, MASS, VELOCITY, MODULUS = Sphere(1.0), 1.0, 1e-3, 1e6


@dataclass(frozen=True)
class MapPoint:
    """One material: `stiffening` E_i/E_inf, `tau` in T_E; times in T_E, the peak in that of the elastic impact.

    `exact_*` are Ting's, the others the clipped law's; `history_error` is the L2 distance of the two forces over
    the norm of Ting's.
    """

    stiffening: float
    tau: float
    peak_force: float
    duration: float
    exact_duration: float
    restitution: float
    exact_restitution: float
    peak_error: float
    history_error: float

    @property
    def duration_error(self) -> float:
        """Relative error of the duration."""
        return self.duration / self.exact_duration - 1.0

    @property
    def restitution_error(self) -> float:
        """Relative error of the restitution."""
        return self.restitution / self.exact_restitution - 1.0

    @property
    def loss_error(self) -> float:
        """Relative error of the energy lost, 1 - e^2."""
        return (1.0 - self.restitution**2) / (1.0 - self.exact_restitution**2) - 1.0


def point(stiffening: float, tau: float, tolerance: float = 1e-6, striker: Shape = PARABOLOID) -> MapPoint:
    """The errors for one material: E_i/E_inf > 1, relaxation time in T_E > 0; a sphere counts as its paraboloid.

    Raises BadInput, NotReached.
    """
    elastic = striker.hertz_impact(MODULUS, MASS, VELOCITY)
    contact = Relaxation(1.0, (stiffening - 1.0,), (tau * elastic.duration,)).scaled(MODULUS)
    scene = Scene(striker, MASS, VELOCITY, Material(contact, nu=0.0), model=Model(profile="parabola"))
    clipped = correspondence.of(scene).simulate(scene, tolerance)
    exact = ting.of(scene).simulate(scene, tolerance)
    return MapPoint(
        stiffening,
        tau,
        peak_force=_value(clipped, "peak_force") / elastic.force,
        duration=_value(clipped, "duration") / elastic.duration,
        exact_duration=_value(exact, "duration") / elastic.duration,
        restitution=_value(clipped, "restitution"),
        exact_restitution=_value(exact, "restitution"),
        peak_error=_value(clipped, "peak_force") / _value(exact, "peak_force") - 1.0,
        history_error=_distance(clipped, exact),
    )


def error_map(
    stiffenings: Iterable[float], taus: Iterable[float], tolerance: float = 1e-6, striker: Shape = PARABOLOID
) -> tuple[MapPoint, ...]:
    """A point for every pair, relaxation times running fastest. Raises BadInput, NotReached."""
    times = tuple(taus)
    return tuple(point(stiffening, tau, tolerance, striker) for stiffening in stiffenings for tau in times)


def _value(result: Result, name: str) -> float:
    """A quantity of an impact. Raises NotReached for one without end."""
    value = result.quantities[name].value
    if value is None or not result.converged:
        raise NotReached(f"{result.method} gives no {name} here: {result.message}")
    return value


def _distance(clipped: Result, exact: Result) -> float:
    """L2 norm of the difference of two forces over that of the second."""
    times = np.union1d(clipped.history.time, exact.history.time)
    force = exact.history.force_at(times)
    difference = clipped.history.force_at(times) - force
    return float(np.sqrt(np.trapezoid(difference**2, times) / np.trapezoid(force**2, times)))
