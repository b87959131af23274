"""The elastic layer on a rigid foundation: how much less it yields than the half-space, wave by wave."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault, nearest
from lumped.numbers.quadrature import gauss

Array = NDArray[np.float64]
BASES = ("bonded", "sliding")
# Beyond this wavenumber (times thickness) the deficit is below rounding.
LAST_WAVENUMBER = 22.0
WAVE_POINTS = 24


@dataclass(frozen=True)
class PointLayer:
    """Thickness in m, Poisson's ratio in (-1, 0.5] and `base`: "bonded" or "sliding" (held normally, both ways).

    A pressure cos(k x) on its surface raises the displacement 2 L(k thickness) cos(k x)/(E* k): L -> 1 on the
    half-space. Raises BadInput.
    """

    thickness: float
    nu: float
    base: str = "bonded"

    def __post_init__(self) -> None:
        faults = []
        if not 0.0 < self.thickness < inf:
            faults.append(Fault("layer", "thickness", f"must be above 0 m, is {self.thickness}"))
        if not -1.0 < self.nu <= 0.5:
            faults.append(Fault("layer", "nu", f"must lie above -1 and not above 0.5, is {self.nu}"))
        if self.base not in BASES:
            message = f"is one of {', '.join(BASES)}, not {self.base!r}{nearest(self.base, BASES)}"
            faults.append(Fault("layer", "base", message))
        if faults:
            raise BadInput(faults)

    def check_depth(self, depth: ArrayLike) -> None:
        """Raises BadInput where a depth reaches the thickness."""
        deepest = np.max(np.asarray(depth), initial=0.0)
        if deepest >= self.thickness:
            message = f"a depth of {deepest:.3g} m; accepted below the layer's thickness {self.thickness:g} m"
            raise BadInput(Fault("depth", "", message))


def deficit(nu: float, base: str, u: Array) -> Array:
    """1 - L(u) at wavenumbers u (times thickness), shape (n,), written without a difference.

    Bonded: L = (2 kappa sinh 2u - 4u)/(2 kappa cosh 2u + 1 + kappa^2 + 4u^2), kappa = 3 - 4 nu; sliding:
    L = sinh^2 u/(sinh u cosh u + u), which knows no nu.
    Hayes et al. 1972, J. Biomech. 5, 541-551.
    """
    if base == "sliding":
        return np.asarray((1.0 + 2.0 * u - np.exp(-2.0 * u)) / (np.sinh(2.0 * u) + 2.0 * u))
    kappa = 3.0 - 4.0 * nu
    rest = 1.0 + kappa**2 + 4.0 * u**2
    return np.asarray((2.0 * kappa * np.exp(-2.0 * u) + rest + 4.0 * u) / (2.0 * kappa * np.cosh(2.0 * u) + rest))


def waves(ratio: float, refinement: float) -> tuple[Array, Array]:
    """Wavenumbers (times thickness) and their weights, enough for a contact of half-width `ratio` thicknesses."""
    panels = int(np.ceil(refinement * (7.0 + 1.2 * ratio)))
    nodes, weights = gauss(WAVE_POINTS)
    width = LAST_WAVENUMBER / panels
    return (width * (np.arange(panels)[:, None] + nodes)).ravel(), np.tile(width * weights, panels)
