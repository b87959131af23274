"""The contact pressure that a lumped law implies, by hereditary superposition of elastic pressures.

Every law of the half-space is a rule for which elastic pressures p_el(r; a), per unit modulus, are added:

    p(r, t) = int_0^t1 E*(t - s) d p_el(r; a(s)) ,    d p_el = d depth / (pi sqrt(a^2 - r^2)) inside a ,

and its integral over the surface is the law's force. Hertz's and the correspondence law follow the contact
radius of the present depth to t1 = t. Then, in the rebound, the increments are negative while the moduli of
the older, positive ones have relaxed: the law pulls at the surface around the shrinking contact, within it
and outside. In the exact laws t1 is the earlier time at which the contact radius was the present one (Ting
1966, doi:10.1115/1.3625192), and the pressure is never negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fe_contact.assembly.forms import Array
from lumped.load_curves import LoadCurve
from lumped.materials import Relaxation
from lumped.result.result import Result
from lumped.scene.scene import Answered
from lumped.targets import HalfSpace

FOLLOWING, EXACT = ("hertz", "correspondence"), ("ting", "mdr")
PATH_POINTS = 400  # work: rows of the history along which a law's pressure is followed, at most


@dataclass(frozen=True, eq=False)
class LawPressure:
    """Pressure of a law: modulus E*(t), Pa; load curve; contact radius, m, and velocity, m/s, over time, s, (n,).

    ``returns``: in the rebound the law forgets what lies after t1.
    """

    modulus: Relaxation
    curve: LoadCurve
    times: Array
    contact_radii: Array
    velocities: Array
    returns: bool

    @classmethod
    def of(cls, result: Result) -> LawPressure | None:
        """The pressure of a law's result; None where it is not known.

        That is for other laws, fixed areas, dashpots on a layer, and where only forces on the load curve are known.
        """
        if result.method not in FOLLOWING + EXACT or isinstance(result.scene, Answered):
            return None
        geometry, modulus = result.scene.geometry, result.scene.contact_modulus
        grows = geometry.shape.fixed_radius is None
        if not grows or (modulus.viscosity > 0.0 and not isinstance(geometry.target, HalfSpace)):
            return None
        history = result.history
        rows = np.unique(np.linspace(0, len(history) - 1, PATH_POINTS).astype(int))
        return cls(
            modulus=Relaxation(modulus.relaxed) if result.method == "hertz" else modulus,
            curve=geometry.target.load_curve(geometry.shape.resolved(result.model.profile), geometry.material.nu),
            times=history.time[rows],
            contact_radii=history.contact_radius[rows],
            velocities=history.velocity[rows],
            returns=result.method in EXACT,
        )

    def at(self, time: float, radii: Array) -> Array:
        """Pressure at a time and radii (m,), Pa; zero when the law's contact is over."""
        if time > self.times[-1]:
            return np.zeros_like(radii)
        until = self._until(time)
        before = self.times < until
        times = np.append(self.times[before], until)
        edge = float(np.interp(until, self.times, self.contact_radii))
        path = _elastic(self.curve, tuple(self.contact_radii.tolist()), tuple(radii.tolist()))
        elastic = np.vstack([path[before], self.curve.pressure(radii, edge)])
        middles = 0.5 * (times[1:] + times[:-1])
        pressure = self.modulus(time - middles) @ np.diff(elastic, axis=0)
        if until == time:  # the viscosity's pulse acts at s = t only
            pressure = pressure + self.modulus.viscosity * self._growth(time, radii)
        return np.asarray(pressure)

    def _growth(self, time: float, radii: Array) -> Array:
        """Rate of the elastic pressure, 1/s: a flat punch as large as the contact, moved at the striker's velocity."""
        edge = np.interp(time, self.times, self.contact_radii)
        reach = np.sqrt(np.maximum(edge**2 - radii**2, 0.0))
        velocity = np.interp(time, self.times, self.velocities)
        return np.divide(velocity / np.pi, reach, out=np.zeros_like(radii), where=reach > 0.0)

    def _until(self, time: float) -> float:
        """t1: the present while the contact grows or the law does not return, an earlier time of equal radius else."""
        largest = int(np.argmax(self.contact_radii))
        if not self.returns or time <= self.times[largest]:
            return time
        now = np.interp(time, self.times, self.contact_radii)
        return float(np.interp(now, self.contact_radii[: largest + 1], self.times[: largest + 1]))


@lru_cache(maxsize=8)  # the laws of one comparison, each asked at several times, for its error and for the chart
def _elastic(curve: LoadCurve, contact_radii: tuple[float, ...], radii: tuple[float, ...]) -> Array:
    """Elastic pressures per unit modulus, a row a contact radius, m, at radii, m."""
    places = np.array(radii)
    return np.stack([curve.pressure(places, a) for a in contact_radii])
