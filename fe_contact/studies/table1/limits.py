"""Where a row of Table 1 ends: how deep its power law holds, blocks whose faces are bonded, line contact's datum.

From slow indentation by finite elements. Blocks with bonded faces and free sides go from Young's modulus to the
confined one as they grow wide; line contact has another F/(E* l depth) with every datum, layer and way to hold a
cylinder.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from fe_contact.studies.finite_exponents import first_beyond, zero_after
from lumped.indentation import Indentation, power_law
from lumped.load_curves.half_plane import HalfPlane
from lumped.load_curves.layer import LineLayer, PointLayer
from lumped.load_curves.plane_contact import CylinderProfile as Profile
from lumped.load_curves.plane_contact import LineCurve
from lumped.paper.table1 import Elastic, TableRow, pressed
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.plate import Plate
from lumped.targets import Target
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.half_space import HalfSpace
from lumped.targets.layer import Layer
from lumped.targets.plane import Plane

LIMIT = 0.01  # departure from the power law that counts as its end
WIDTHS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # radius of a disc over its thickness
BLOCK_DEPTH = 1e-3  # over the thickness: every answer is linear
TOLERANCE = 3e-4  # of the indentations by finite elements
DEPTH = 0.01  # over the radius R of the gap
CHORD = (1 / 1.1, 1.0, 1.1)  # depths around it, between which the exponent is taken
# Datum, or thickness, over R; a datum nearer than the contact is wide means nothing.
EXACT = {
    "datum": tuple(float(share) for share in np.geomspace(1.0, 1e3, 25)),
    "bonded layer": tuple(float(share) for share in np.geomspace(0.1, 1e3, 33)),
}
# Lengths over R that finite elements check, by support.
CHECKED = {"datum": (3.0, 30.0), "bonded layer": (0.3, 3.0, 30.0)}
# Radius of the struck cylinder over R, from two equal ones to one much larger than the other.
HELD = {"free": (2.0, 5.0, 20.0), "held": (2.0, 5.0, 20.0)}
NARROW = 1e-6  # a contact over the widest, below which no D of the table lies


@dataclass(frozen=True)
class Reach:
    """Depths over the row's length: tried `first` to `last`, the power law within 1 % up to `held` (with a bar).

    `departure`, shape (n,): force over the corrected row's, less one, at `depth`, the worst of all nu.
    """

    first: float
    last: float
    held: Quantity
    depth: Array
    departure: Array

    @property
    def throughout(self) -> bool:
        """Whether it holds at every depth tried."""
        return self.held.value == self.last


def reach(row: TableRow, curves: Mapping[float, Indentation], pressed: Mapping[float, tuple[Elastic, ...]]) -> Reach:
    """How deep the corrected row holds within 1 %, at every nu of the bodies that were pressed."""
    departures, bars = [], []
    for nu, curve in curves.items():
        departures.append(curve.force / row.force(curve.depth, *pressed[nu]) - 1.0)
        bars.append(curve.force_error / curve.force)
    every = np.array(departures)
    worst = every[np.abs(every).argmax(axis=0), np.arange(every.shape[1])]
    share = next(iter(curves.values())).depth / row.length
    never = Quantity(float(share[-1]), 0.0, "1")
    held = first_beyond(share, np.abs(worst), np.max(bars, axis=0), LIMIT) or never
    return Reach(float(share[0]), float(share[-1]), held, share, worst)


@dataclass(frozen=True)
class Block:
    """A disc of this radius over its thickness; ``modulus``: force over area, thickness over depth, Pa."""

    body: Elastic
    width: float
    modulus: Quantity


def blocks(body: Elastic) -> tuple[Block, ...]:
    """Discs of unit thickness between rigid faces that they are bonded to, pressed by finite elements."""
    return tuple(_block(body, width) for width in WIDTHS)


def _block(body: Elastic, width: float) -> Block:
    area = float(np.pi * width**2)
    scene = pressed("bonded", Plate(area, 1.0, "free", "bonded"), Plane(), body)
    found = indent(scene, (BLOCK_DEPTH,), {"tolerance": TOLERANCE})
    scale = 1.0 / (area * BLOCK_DEPTH)
    return Block(body, width, Quantity(scale * float(found.force[0]), scale * float(found.force_error[0]), "Pa"))


def within(row: TableRow, tried: Sequence[Block], limit: float) -> tuple[float, float] | None:
    """Widths between which blocks of one body have the row's modulus within a limit; None where none tried has.

    0 and infinite where the first or the last block still has it; else the end is found between two blocks, on a
    straight line in logarithms.
    """
    width = np.log([block.width for block in tried])
    moduli = np.array([block.modulus.value for block in tried], dtype=float)
    off = np.log(np.abs(moduli / row.modulus(tried[0].body) - 1.0) / limit)
    holding = np.flatnonzero(off <= 0.0)
    if not holding.size:
        return None
    first, last = int(holding[0]), int(holding[-1])
    low = 0.0 if first == 0 else math.exp(zero_after(width, off, first - 1))
    high = math.inf if last == width.size - 1 else math.exp(zero_after(width, off, last))
    return low, high


@dataclass(frozen=True)
class Place:
    """D/l = F/(E* l depth) and the local exponent at one depth, with one support; `method`: "exact", "fe" or "impact".

    ``length``: datum, thickness or the struck cylinder's radius over R of the gap; ``once``: depth over R at which the
    exact D is pi l/4, None where there is none or where finite elements answer.
    """

    support: str
    length: float
    method: str
    factor: Quantity
    alpha: Quantity
    once: float | None = None


def places(row: TableRow, *bodies: Elastic) -> tuple[Place, ...]:
    """One body: exact places over decades of datum and thickness, some checked. Two: finite cylinders, by FE alone."""
    if row.bodies == 2:
        return tuple(_cylinders(row, bodies, support, share) for support, tried in HELD.items() for share in tried)
    exact = [_exact(support, share, bodies[0].nu) for support, tried in EXACT.items() for share in tried]
    checked = [_body(row, bodies, support, share) for support, tried in CHECKED.items() for share in tried]
    return (*exact, *checked)


def curve(support: str, share: float, nu: float) -> LineCurve:
    """Of a cylinder of unit radius."""
    if support == "datum":
        return HalfPlane(Profile(1.0), share, nu)
    return LineLayer(Profile(1.0), PointLayer(share, nu, "bonded"))


def _exact(support: str, share: float, nu: float) -> Place:
    line = curve(support, share, nu)
    here = line.at(line.contact_radius(DEPTH))
    factor, alpha = float(here.force / DEPTH), float(here.stiffness * DEPTH / here.force)
    return Place(support, share, "exact", Quantity(factor, 0.0, "1"), Quantity(alpha, 0.0, "1"), _once(line))


def _once(line: LineCurve) -> float | None:
    """The depth at which F/(E* l depth) = pi/4: it grows with the contact."""
    from scipy.optimize import brentq

    def short(half_width: float) -> float:
        here = line.at(half_width)
        return float(here.force / here.depth) - 0.25 * np.pi

    low, high = NARROW * line.edges[-1], line.edges[-1]
    if not short(low) < 0.0 < short(high):
        return None
    return float(line.depth(brentq(short, low, high, xtol=1e-9 * low)))


def _body(row: TableRow, bodies: tuple[Elastic, ...], support: str, share: float) -> Place:
    """A rigid cylinder on a body of finite elements."""
    length = share * row.length
    target: Target = HalfSpace(length) if support == "datum" else Layer(length, "bonded")
    return _found(pressed(row.name, Cylinder(row.length, 1.0), target, *bodies), row, support, share)


def _cylinders(row: TableRow, bodies: tuple[Elastic, ...], support: str, share: float) -> Place:
    """Two cylinders; 1/R = 1/R_a + 1/R_b gives the striker's radius."""
    struck = share * row.length
    striker = Cylinder(1.0 / (1.0 / row.length - 1.0 / struck), 1.0)
    return _found(pressed(row.name, striker, CylinderTarget(struck, support), *bodies), row, support, share)


def _found(scene: Indenter, row: TableRow, support: str, share: float) -> Place:
    """By finite elements: a power law through three near depths."""
    depths = tuple(factor * DEPTH * row.length for factor in CHORD)
    found = indent(scene, depths, {"tolerance": TOLERANCE})
    relative = found.force_error / found.force
    alpha = power_law(found.depth, found.force / found.modulus, relative, row.alpha)["alpha"]
    factor = float(found.force[1] / (found.modulus * found.depth[1]))
    return Place(support, share, "fe", Quantity(factor, factor * float(relative[1]), "1"), alpha)
