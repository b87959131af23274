"""Table 1 from impacts: D, alpha and E* of a row, read off the loading branch of elastic impacts by finite elements.

While the striker comes in, force and depth are those of a slow indentation at every instant, each with the bar of its
history. No force enters that a slow indentation found.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.reference import solve
from fe_contact.studies.table1.datum import CHORD, DEPTH, Place
from lumped.indentation import power_law
from lumped.paper.table1 import Elastic, TableRow
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.targets import Target
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.layer import Layer

SHALLOW = 1e-4  # greatest depth over the row's length
SHARES = tuple(float(share) for share in np.geomspace(0.2, 0.95, 9))  # of the greatest depth, at which forces are read
ENDS = (0.1, 0.95)  # the same where the slope of a logarithm is wanted
DEEPER = 1.3  # greatest depth over the one at which line contact is tried, if it were as stiff as printed
TOLERANCE = 1e-3
MASS = 1.0  # kg: the velocity follows from it


@dataclass(frozen=True)
class FromImpact:
    """``alpha`` and ``factor`` D, m^(2-alpha), at nu = 0, or a ``place`` of line contact; ``moduli`` E*, Pa, by nu."""

    moduli: Mapping[float, Quantity]
    alpha: Quantity | None = None
    factor: Quantity | None = None
    place: Place | None = None


@dataclass(frozen=True, eq=False)
class Loading:
    """Depth, m, force, N, and what both may err by together, relative to the force; (n,) each."""

    depth: Array
    force: Array
    relative: Array


def power_law_impacts(row: TableRow, bodies: Mapping[float, tuple[Elastic, ...]]) -> FromImpact:
    """Of a row with one D; ``bodies`` by Poisson's ratio, nu = 0 among them. Raises NotReached."""
    curves = {
        nu: loading(row, row.scene(*pressed), SHALLOW * row.length, SHARES, *pressed) for nu, pressed in bodies.items()
    }
    base, known = curves[0.0], row.modulus(*bodies[0.0])
    law = power_law(base.depth, base.force / known, base.relative, row.alpha)
    moduli = {nu: _modulus(row, known, base, curve) for nu, curve in curves.items()}
    moduli[0.0] = Quantity(known, 0.0, "Pa")
    return FromImpact(moduli, law["alpha"], law["D_at_alpha"])


def line_impacts(row: TableRow, bodies: Mapping[float, tuple[Elastic, ...]], nu: float) -> FromImpact:
    """Of line contact: E* by the slope of its logarithm; D at one depth for one nu, with the row's own support."""
    moduli = {}
    for ratio, pressed in bodies.items():
        curve = loading(row, row.scene(*pressed), SHALLOW * row.length, ENDS, *pressed)
        moduli[ratio] = logarithms_modulus(row, curve)
    return FromImpact(moduli, place=_place(row, bodies[nu]))


def _place(row: TableRow, bodies: tuple[Elastic, ...]) -> Place:
    """D/l and the exponent around one depth."""
    scene, modulus = row.scene(*bodies), row.modulus(*bodies)
    depths = tuple(factor * DEPTH * row.length for factor in CHORD)
    curve = loading(row, scene, DEEPER * DEPTH * row.length, depths, *bodies, shared=False)
    alpha = power_law(curve.depth, curve.force / modulus, curve.relative, row.alpha)["alpha"]
    length = row.factor / (0.25 * math.pi)
    factor = float(curve.force[1] / (modulus * curve.depth[1] * length))
    found = Quantity(factor, factor * float(curve.relative[1]), "1")
    support, size = _support(scene.target)
    return Place(support, size / row.length, "impact", found, alpha)


def _support(target: Target) -> tuple[str, float]:
    """What carries the contact, and its length, m."""
    if isinstance(target, Layer):
        return f"{target.base} layer", target.thickness
    assert isinstance(target, CylinderTarget)
    return target.support or "", target.radius


def loading(
    row: TableRow, slow: Indenter, deepest: float, wanted: tuple[float, ...], *bodies: Elastic, shared: bool = True
) -> Loading:
    """Forces on the way in, at depths ``wanted``, m, or ``shared`` with the greatest one; raises NotReached.

    The velocity is that of a striker which the row as printed would stop at the ``deepest``, m.
    """
    work = row.factor * row.modulus(*bodies) * deepest ** (row.alpha + 1.0) / (row.alpha + 1.0)
    scene = Scene(
        slow.shape,
        MASS,
        math.sqrt(2.0 * work / MASS),
        slow.material,
        target=slow.target,
        model=slow.model,
        striker_material=slow.striker_material,
        name=slow.name,
    )
    certified = solve(scene, {"tolerance": TOLERANCE}).certified
    curve = certified.curve
    turn = int(curve.dense.depth.argmax())
    top = float(curve.dense.depth[turn])
    depths = np.array(wanted) * (top if shared else 1.0)
    times = np.interp(depths, curve.dense.depth[: turn + 1], curve.dense_time[: turn + 1])
    here = curve.read(times)
    error = row.alpha * certified.total("peak_depth") / here.depth
    return Loading(here.depth, here.force, certified.force_error(times) / here.force + error)


def logarithms_modulus(row: TableRow, curve: Loading) -> Quantity:
    """E*, Pa: b^2 = 4 R F/(pi E* l), so that from the first contact to the last depth/F falls by ln F/(pi E* l)."""
    length = row.factor / (0.25 * math.pi)
    ends = [0, -1]
    compliance, relative = (curve.depth / curve.force)[ends], curve.relative[ends]
    fall, growth = float(compliance[0] - compliance[1]), float(np.log(curve.force[-1] / curve.force[0]))
    value = growth / (math.pi * length * fall)
    return Quantity(value, value * float(relative.sum() / growth + compliance @ relative / fall), "Pa")


def _modulus(row: TableRow, known: float, base: Loading, curve: Loading) -> Quantity:
    """E*, Pa: that at nu = 0 times the mean ratio of both forces over depth^alpha."""
    ratio = curve.force / curve.depth**row.alpha / (base.force / base.depth**row.alpha)
    value = known * float(np.exp(np.log(ratio).mean()))
    return Quantity(value, value * float((curve.relative + base.relative).mean()), "Pa")
