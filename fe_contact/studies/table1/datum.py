"""Line contact: what F/(E* l depth) comes to with every datum, layer and way to hold a cylinder."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.indentation import indent
from lumped.indentation import power_law
from lumped.load_curves.half_plane import HalfPlane
from lumped.load_curves.layer import LineLayer, PointLayer
from lumped.load_curves.plane_contact import CylinderProfile as Profile
from lumped.load_curves.plane_contact import LineCurve
from lumped.paper.table1 import Elastic, TableRow, pressed
from lumped.result.result import Quantity
from lumped.scene.indenter import Indenter
from lumped.shapes.cylinder import Cylinder
from lumped.targets import Target
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.half_space import HalfSpace
from lumped.targets.layer import Layer

DEPTH = 0.01  # over the radius R of the gap
CHORD = (1 / 1.1, 1.0, 1.1)  # depths around it, between which the exponent is taken
# Datum, or thickness, over R; a datum nearer than the contact is wide means nothing.
EXACT = {
    "datum": tuple(float(share) for share in np.geomspace(1.0, 1e3, 25)),
    "bonded layer": tuple(float(share) for share in np.geomspace(0.1, 1e3, 33)),
}
CHECKED = {"datum": (3.0, 30.0), "bonded layer": (0.3, 3.0, 30.0)}
# Radius of the struck cylinder over R, from two equal ones to one much larger than the other.
HELD = {"free": (2.0, 5.0, 20.0), "held": (2.0, 5.0, 20.0)}
TOLERANCE = 3e-4
NARROW = 1e-6  # a contact over the widest, below which no D of the table lies


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
