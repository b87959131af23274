"""How far the contact of finite spheres lies from Hertz's, which knows two half-spaces alone.

With x = a/R, a the contact radius of the half-spaces at the same depth and R the target's radius,

    F / F_Hertz - 1 = x (c + k ln x + d x) + ... .

It goes as a/R but for a logarithm, that of a point load on a sphere beside the half-space's 1/r, which vanishes where
the spheres are incompressible.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.schema import Table
from lumped.targets.sphere import SphereTarget

Array = NDArray[np.float64]
TERMS = ("c", "k", "d")


@dataclass(frozen=True, eq=False)
class FiniteSize:
    """``share`` x = a/R, ``deviation`` F / F_Hertz - 1 and its half-width ``error``; each (n,), with n >= 3."""

    share: Array
    deviation: Array
    error: Array

    @property
    def slope(self) -> Quantity:
        """Deviation over a/R: the middle of what is found at these depths; the bar holds all of it, bars included."""
        slope, bar = self.deviation / self.share, self.error / self.share
        low, high = float((slope - bar).min()), float((slope + bar).max())
        return Quantity(0.5 * (low + high), 0.5 * (high - low), "1")

    @cached_property
    def terms(self) -> dict[str, Quantity]:
        """c, k and d by least squares of deviation/x; bars whatever the signs of the errors, without what follows d."""
        columns = np.stack([np.ones_like(self.share), np.log(self.share), self.share], axis=1)
        weights = np.linalg.pinv(columns)
        values, bars = weights @ (self.deviation / self.share), np.abs(weights) @ (self.error / self.share)
        return {
            name: Quantity(float(value), float(bar), "1") for name, value, bar in zip(TERMS, values, bars, strict=True)
        }

    def to_dict(self) -> Table:
        """Its part of result.json."""
        return {
            "a/R": self.share.tolist(),
            "F/F_Hertz-1": self.deviation.tolist(),
            "error": self.error.tolist(),
            "slope": asdict(self.slope),
            "terms": {name: asdict(term) for name, term in self.terms.items()},
        }


def finite_size(indenter: Indenter, depth: Array, force: Array, error: Array) -> FiniteSize | None:
    """Of force over modulus, m^2, with its half-width, at depths, m; each (n,). None for all but finite spheres."""
    target = indenter.target
    if not isinstance(target, SphereTarget) or target.support is None:
        return None
    curve = SphereTarget(target.radius, None).load_curve(indenter.profile, indenter.material.nu)
    hertz, share = np.asarray(curve.force(depth)), np.asarray(curve.contact_radius(depth)) / target.radius
    return FiniteSize(share, force / hertz - 1.0, error / hertz)
