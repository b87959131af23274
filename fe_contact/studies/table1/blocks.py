"""Blocks with bonded faces and free sides: from Young's modulus to the confined one as they grow wide."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.indentation import indent
from lumped.paper.table1 import Elastic, TableRow, pressed
from lumped.result.result import Quantity
from lumped.shapes.plate import Plate
from lumped.targets.plane import Plane

WIDTHS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # radius of a disc over its thickness
DEPTH = 1e-3  # over the thickness: every answer is linear
TOLERANCE = 3e-4


@dataclass(frozen=True)
class Block:
    """A disc of this radius over its thickness; ``modulus``: force over area, thickness over depth, Pa."""

    body: Elastic
    width: float
    modulus: Quantity


def blocks(body: Elastic) -> tuple[Block, ...]:
    """Discs of unit thickness between rigid faces that they are bonded to, pressed by finite elements."""
    return tuple(_pressed(body, width) for width in WIDTHS)


def _pressed(body: Elastic, width: float) -> Block:
    area = float(np.pi * width**2)
    scene = pressed("bonded", Plate(area, 1.0, "free", "bonded"), Plane(), body)
    found = indent(scene, (DEPTH,), {"tolerance": TOLERANCE})
    scale = 1.0 / (area * DEPTH)
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
    low = 0.0 if first == 0 else math.exp(_crossing(width, off, first - 1))
    high = math.inf if last == width.size - 1 else math.exp(_crossing(width, off, last))
    return low, high


def _crossing(x: Array, y: Array, place: int) -> float:
    """Where the line from one point to the next meets zero."""
    return float(x[place] - y[place] * (x[place + 1] - x[place]) / (y[place + 1] - y[place]))
