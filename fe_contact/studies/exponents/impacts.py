"""Exponents that are read from impacts on viscoelastic bodies: how wrong each reader is, and what Ting's law repairs.

The striker meets a 3-parameter solid on a half-space or on a bonded layer. Ting's exact histories make the map, over
the ratio of the moduli and the relaxation time; finite elements prove it at a few places. A bias is what was read less
the exponent of Table 1's row.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.methods import FE, simulate
from fe_contact.progress import Progress, silent
from fe_contact.studies import journal
from fe_contact.studies.exponents import readers
from fe_contact.studies.exponents.layers import KEPT, PROFILES, Profile
from fe_contact.studies.exponents.readers import Reader, ReadExponent, Samples
from fe_contact.studies.files import Line
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material, Relaxation
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema import Table
from lumped.targets import HalfSpace
from lumped.targets.layer import Layer

READERS: Mapping[str, Reader] = {
    "log_log": readers.log_log,
    "hunt_crossley": readers.hunt_crossley,
    "correspondence": readers.correspondence,
}
EXACT = "ting"
TOLERANCES = {EXACT: 1e-6, FE: 1e-3}  # of the histories, by their method
NU = 0.3  # physics: Poisson's ratio, which counts on a layer alone
CONE, SPHERE, POWER = (next(one for one in PROFILES if (one.name, one.n) == kind) for kind in
                       (("cone", 1.0), ("sphere", 2.0), ("power", 4.0)))  # fmt: skip
STIFFER = (1.5, 3.0, 10.0)  # E_i over E_inf
TIMES = tuple(np.geomspace(1e-3, 1e2, 13).tolist())  # relaxation times over the relaxed body's contact time
WIDE = (0.3, 1.0, 3.0)  # contact radii over a layer's thickness, were it relaxed
FEW_TIMES = (0.1, 1.0)  # in quick
ON_LAYER = 3.0  # E_i over E_inf on a layer, and of what finite elements prove
FIRST_DEPTH = 1e-4  # rounding: share of the greatest depth below which the load is the row's


class Impact(NamedTuple):
    """A profile on a solid whose instantaneous modulus is `ratio` times that of equilibrium, 1 Pa; `relaxation` time
    over the contact time, and `wide`, contact radius over thickness, of the relaxed body, None on a half-space.
    """

    profile: Profile
    ratio: float
    relaxation: float
    wide: float | None
    method: str

    @property
    def named(self) -> str:
        """What a person calls it."""
        layer = "" if self.wide is None else f", layer a/h = {self.wide:g}"
        return f"{self.profile.label}, E_i/E_inf = {self.ratio:g}, tau = {self.relaxation:.3g}{layer}, {self.method}"

    @property
    def load_curve(self) -> LoadCurve:
        """The elastic answer, per unit E*."""
        return self._target.load_curve(self.profile.shape.resolved("parabola"), NU)

    @property
    def scene(self) -> Scene:
        """Of a unit mass, so fast that the relaxed body meets it as wide as asked."""
        curve = self.load_curve
        deep = curve.depth(self.wide or 1.0)
        speed = math.sqrt(2.0 * float(curve.energy(deep)) / (1.0 - NU**2))
        relaxed = Scene(self.profile.shape, 1.0, speed, Material(Relaxation(1.0), NU), target=self._target,
                        model=Model(profile="parabola"))  # fmt: skip
        if self.ratio == 1.0:
            return relaxed
        time = self.relaxation * relaxed.elastic_contact_time
        return replace(relaxed, material=Material(Relaxation(1.0, (self.ratio - 1.0,), (time,)), NU))

    def factor(self, depth: Array) -> Array:
        """The elastic load at depths, m, over that of the row, but for a constant."""
        if self.wide is None:
            return np.ones_like(depth)
        inside = np.maximum(depth, FIRST_DEPTH * depth.max())
        return np.asarray(self.load_curve.force(inside) / inside**self.profile.row)

    @property
    def _target(self) -> HalfSpace | Layer:
        return HalfSpace() if self.wide is None else Layer(1.0, "bonded")


@dataclass(frozen=True)
class ImpactExponents:
    """What was read from one impact, by reader; `corrected` by Ting's law with the exponent free, the load of a layer
    known. `tau_over_T`: over the true contact time; `a_over_h` the greatest, None on a half-space.
    """

    impact: Impact
    tau_over_T: float
    a_over_h: float | None
    read: dict[str, ReadExponent]
    corrected: ReadExponent
    converged: bool

    def bias(self, reader: str) -> float:
        """What a reader returns less the row's exponent."""
        return self.read[reader].exponent - self.impact.profile.row

    @property
    def left(self) -> float:
        """What the correction leaves."""
        return abs(self.corrected.exponent - self.impact.profile.row)

    @property
    def lines(self) -> list[Line]:
        """Its lines of exponents_from_impacts.csv, one a reader."""
        impact, corrected = self.impact, self.corrected
        return [
            {
                "shape": impact.profile.name,
                "profile_exponent": impact.profile.n,
                "E_i_over_E_inf": impact.ratio,
                "tau_over_T": self.tau_over_T,
                "a_over_h": self.a_over_h,
                "method": impact.method,
                "reader": name,
                "exponent": found.exponent,
                "error": found.error,
                "bias": self.bias(name),
                "corrected": corrected.exponent,
                "corrected_error": corrected.error,
                "row_exponent": impact.profile.row,
            }
            for name, found in self.read.items()
        ]


def impacts(quick: bool, where: Path, progress: Progress = silent, jobs: int = 1) -> tuple[ImpactExponents, ...]:
    """Every impact of the study; rows are kept in the folder `where`. Raises NotReached."""
    calls = {impact.named: partial(impact_exponents, *impact) for impact in cases(quick)}
    return tuple(journal.rows(where / KEPT, calls, progress, jobs).values())


def cases(quick: bool) -> Iterator[Impact]:
    """The map by exact histories, and what finite elements prove of it."""
    if quick:
        yield from (Impact(CONE, ON_LAYER, time, None, EXACT) for time in FEW_TIMES)
        yield Impact(CONE, ON_LAYER, FEW_TIMES[0], None, FE)
        return
    for profile, ratio, time in product((CONE, SPHERE, POWER), STIFFER, TIMES):
        yield Impact(profile, ratio, time, None, EXACT)
    for wide in WIDE:
        yield Impact(SPHERE, 1.0, 1.0, wide, EXACT)
        yield from (Impact(SPHERE, ON_LAYER, time, wide, EXACT) for time in TIMES)
    for method in (EXACT, FE):
        yield from (Impact(profile, ON_LAYER, time, None, method)
                    for profile, time in product((CONE, SPHERE, POWER), FEW_TIMES))  # fmt: skip
        yield Impact(SPHERE, ON_LAYER, FEW_TIMES[0], WIDE[1], method)


def impact_exponents(
    profile: Profile, ratio: float, relaxation: float, wide: float | None, method: str
) -> ImpactExponents:
    """One impact, and what each reader makes of it. Raises NotReached."""
    impact = Impact(profile, ratio, relaxation, wide, method)
    scene = impact.scene
    result = simulate(scene, method, {}, TOLERANCES[method])
    history = result.history
    samples = Samples.of(history, result.quantities["history_l2"].error or 0.0, scene.mass, impact.factor)
    times = scene.material.young.times if scene.material else ()
    return ImpactExponents(
        impact,
        tau_over_T=(times[0] if times else 0.0) / float(history.time[-1]),
        a_over_h=None if wide is None else float(history.contact_radius.max()),
        read={name: reader(samples.of_half_space) for name, reader in READERS.items()},
        corrected=readers.ting(samples),
        converged=result.converged,
    )


def agreeing(found: Sequence[ImpactExponents]) -> list[tuple[ImpactExponents, bool]]:
    """What finite elements prove, and whether every reader gets from them what it gets from the exact history."""
    exact = {one.impact: one for one in found if one.impact.method == EXACT}
    proved = [one for one in found if one.impact.method == FE]
    return [(one, _alike(one, exact[one.impact._replace(method=EXACT)])) for one in proved]


def _alike(one: ImpactExponents, other: ImpactExponents) -> bool:
    """Whether all exponents agree within the sum of their bars."""
    pairs = [(one.read[name], other.read[name]) for name in READERS] + [(one.corrected, other.corrected)]
    return all(abs(a.exponent - b.exponent) <= a.error + b.error for a, b in pairs)


def sentences(found: Sequence[ImpactExponents]) -> list[str]:
    """For a person: the worst bias of every reader on a half-space, what the correction leaves, what was proved."""
    exact = [one for one in found if one.impact.method == EXACT]
    open_ground = [one for one in exact if one.impact.wide is None]
    said = [_worst(name, max(open_ground, key=lambda one: abs(one.bias(name)))) for name in READERS]
    most = max(exact, key=lambda one: one.left)
    proved = [alike for _, alike in agreeing(found)]
    said.append(f"impacts: Ting's law with alpha free leaves {most.left:.0e} at most, bar {most.corrected.error:.0e} "
                f"({_place(most)})")  # fmt: skip
    said.append(f"impacts: finite elements and exact histories give every reader the same exponent within the bars "
                f"at {sum(proved)} of {len(proved)} places")  # fmt: skip
    return said


def _worst(reader: str, one: ImpactExponents) -> str:
    reading, row = one.read[reader], one.impact.profile.row
    read = f"reads {reading.exponent:.3f} for {row:g} at worst, bias {one.bias(reader):+.3f}"
    return f"impacts: {reader} {read} ({_place(one)})"


def _place(one: ImpactExponents) -> str:
    layer = "" if one.a_over_h is None else f", a/h = {one.a_over_h:.2g}"
    return f"{one.impact.profile.label}, E_i/E_inf = {one.impact.ratio:g}, tau/T = {one.tau_over_T:.2g}{layer}"


def to_dict(found: Sequence[ImpactExponents]) -> Table:
    """The part of exponents.json."""
    exact = [one for one in found if one.impact.method == EXACT]
    return {
        "worst_bias": {name: max((one.bias(name) for one in exact if one.impact.wide is None), key=abs)
                       for name in READERS},
        "left_by_correction": max(one.left for one in exact),
        "all_corrected_within_bar": all(one.left <= one.corrected.error for one in exact),
        "checks": [{"place": one.impact.named, "agrees": alike, "converged": one.converged,
                    "read": one.read, "corrected": one.corrected} for one, alike in agreeing(found)],
    }  # fmt: skip
