"""Points on the exponents' curves by finite elements, with bars, beside the exact ones."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fe_contact.forms import Array
from fe_contact.indentation import indent
from fe_contact.progress import Progress, silent
from fe_contact.validation import journal
from fe_contact.validation.exponents import KEPT, PROFILES, SMALL, Profile, named
from lumped.indentation import power_law
from lumped.indenter import Indenter
from lumped.load_curves.layer import Layer
from lumped.load_curves.layer_curve import LayerPunch
from lumped.materials import Material, Relaxation
from lumped.result import Quantity
from lumped.scene_tables import Model
from lumped.shapes import punch
from lumped.targets import layer as layers

CHORD = (1 / 1.2, 1.0, 1.2)  # depths around a place, between which the exponent is taken
TOLERANCE = 3e-4
ANY = 0.3  # nu on a sliding base, where it does not count
TRIED = (0.1, 1.0, 5.0)
PLACES = {("bonded", 0.3): TRIED, ("bonded", 0.49): TRIED[1:], ("sliding", None): TRIED[1:2]}
QUICK_PLACES = {("bonded", 0.3): TRIED[1:2]}


@dataclass(frozen=True)
class Check:
    """One point: `exponent` between two near depths and `factor`, with bars; the exact ones between the same depths."""

    profile: Profile
    base: str
    nu: float | None
    ratio: float
    exponent: Quantity
    factor: Quantity
    exact_exponent: float
    exact_factor: float
    converged: bool

    @property
    def covered(self) -> bool:
        """Whether both bars reach the exact values."""
        pairs = ((self.exponent, self.exact_exponent), (self.factor, self.exact_factor))
        return all(abs((one.value or 0.0) - exact) <= (one.error or 0.0) + 1e-9 for one, exact in pairs)


def checks(quick: bool, where: Path, progress: Progress = silent) -> tuple[Check, ...]:
    """Every named profile at a few places; rows are kept in the folder `where`. Raises NotReached."""
    calls = {
        f"{profile.label}, {named(base, nu)}, FE at a/h = {ratio:g}": partial(check, profile, base, nu, ratio)
        for profile in PROFILES
        if profile.name != "power" or (profile.n == 4.0 and not quick)
        for (base, nu), tried in (QUICK_PLACES if quick else PLACES).items()
        for ratio in tried
    }
    return tuple(journal.rows(where / KEPT, calls, progress).values())


def check(profile: Profile, base: str, nu: float | None, ratio: float) -> Check:
    """One point; raises NotReached."""
    layer = Layer(1.0, ANY if nu is None else nu, base)
    depth, force = _exact(profile, layer, ratio)
    shape = punch.of(ratio) if np.isinf(profile.n) else profile.shape
    material, model = Material(Relaxation(1.0), layer.nu), Model(profile="parabola")
    scene = Indenter(shape, material, target=layers.of(1.0, base), model=model)
    found = indent(scene, tuple(float(one) for one in depth), {"tolerance": TOLERANCE})
    relative, level = found.force_error / found.force, found.force / found.modulus
    row = (2.0 * ratio if np.isinf(profile.n) else profile.factor) * depth[1] ** profile.row
    return Check(
        profile,
        base,
        nu,
        ratio,
        exponent=power_law(depth, level, relative, profile.row)["alpha"],
        factor=Quantity(float(level[1] / row), float(relative[1] * level[1] / row), "1"),
        exact_exponent=power_law(depth, force, np.zeros_like(force), profile.row)["alpha"].value or np.nan,
        exact_factor=float(force[1] / row),
        converged=found.converged,
    )


def _exact(profile: Profile, layer: Layer, ratio: float) -> tuple[Array, Array]:
    """Depths around the one with this contact radius, in thicknesses, and forces over E*, shape (3,)."""
    if np.isinf(profile.n):
        depth = SMALL * np.array(CHORD)
        return depth, LayerPunch(ratio, layer).stiffness * depth
    curve = profile.on(layer)
    depth = np.array(CHORD) * float(curve.at(ratio).depth)
    return depth, np.asarray(curve.force(depth))
