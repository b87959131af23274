"""CalculiX: an input deck of a slow indentation, with a mesh of its own of eight-node axisymmetric elements.

CalculiX has no rigid analytic surface: the striker is a body ten thousand times as stiff, with face nodes on the
profile. Lengths are in mm: an element of a thousandth of that, in m, is none to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_contact.studies.export.base import ImpactCase, StaticCase
from lumped.errors import BadInput, Fault
from lumped.numbers import Array

ELEMENTS, ROWS = 12, 4  # of a contact radius; of the striker, one above another
DENSER = 1.3  # the striker's face is denser than the ground: no node of one lies on one of the other
STIFF, PENALTY = 1e4, 1e4  # striker over body; pressure over overlap, in Young's moduli over the contact radius
NO_PULL = 1e-9  # the tension that a gap may have, in Young's moduli
MM, MPA = 1e3, 1e-6  # of a metre, of a pascal


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid of eight-node elements: nodes (id -> r, z), elements (id -> eight nodes), rows of nodes by name."""

    nodes: dict[int, tuple[float, float]]
    elements: dict[int, tuple[int, ...]]
    bottom: tuple[int, ...]
    top: tuple[int, ...]
    left: tuple[int, ...]
    right: tuple[int, ...]
    lowest: tuple[int, ...]  # elements at the bottom
    highest: tuple[int, ...]  # and at the top


def block(r: Array, z: Array, first: int) -> Grid:
    """Of radii (2 n + 1,) and heights (2 m + 1, 2 n + 1), corners and middles in turn; ids count from ``first``."""
    count = r.size
    number = {(j, i): first + j * count + i for j in range(z.shape[0]) for i in range(count) if not (i % 2 and j % 2)}
    nodes = {one: (float(r[i]), float(z[j, i])) for (j, i), one in number.items()}
    corners = [(j, i) for j in range(0, z.shape[0] - 2, 2) for i in range(0, count - 2, 2)]
    around = ((0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0))
    elements = {first + k: tuple(number[j + dj, i + di] for dj, di in around) for k, (j, i) in enumerate(corners)}
    wide = (count - 1) // 2
    ids = list(elements)
    return Grid(
        nodes, elements,
        tuple(number[0, i] for i in range(count)), tuple(number[z.shape[0] - 1, i] for i in range(count)),
        tuple(number[j, 0] for j in range(z.shape[0])), tuple(number[j, count - 1] for j in range(z.shape[0])),
        tuple(ids[:wide]), tuple(ids[-wide:]),
    )  # fmt: skip


def _with_middles(corners: Array) -> Array:
    """Places and those in the middle of every interval."""
    return np.sort(np.concatenate([corners, 0.5 * (corners[1:] + corners[:-1])]))


@dataclass(frozen=True)
class CalculiX:
    """See the module."""

    suffix: ClassVar[str] = ".inp"
    how: ClassVar[str] = (
        "ccx -i {stem}, then the vertical force of STRIKER in {stem}.dat times 180 (a wedge of 2 degrees)"
    )

    def static(self, case: StaticCase) -> str:
        """As the contract says."""
        return "\n".join(_deck(case)) + "\n"

    def impact(self, case: ImpactCase) -> str:
        """Raises BadInput: CalculiX has no relaxation in time."""
        raise BadInput(Fault("--to", "calculix", f"{case.name}: no impact; cure: --depth D, m, or --to ngsolve"))


def _deck(case: StaticCase) -> Iterator[str]:
    """Line by line."""
    body = case.body
    r, z = map(_with_middles, body.lattice(ELEMENTS, case.refined))
    pressed = block(r, np.repeat(z[:, None], r.size, axis=1), 1)
    across = np.linspace(0.0, body.reach, 2 * round(body.reach / body.edge * ELEMENTS * DENSER) * case.refined + 1)
    face = body.height(across)
    up = np.linspace(0.0, 1.0, 2 * ROWS + 1)[:, None]
    striker = block(across, face + up * (face[-1] + body.edge - face), max(pressed.nodes) + 1)

    yield f"** {case.name}: a profile pressed {case.depth:.9g} m deep. Lengths in mm, forces in N, moduli in MPa."
    yield from (f"** {line}" for line in case.said)
    yield "*NODE, NSET=ALL"
    for part in (pressed, striker):
        yield from (f"{one}, {MM * x:.12g}, {MM * y:.12g}, 0" for one, (x, y) in part.nodes.items())
    for name, part in (("BODY", pressed), ("STRIKER", striker)):
        yield f"*ELEMENT, TYPE=CAX8, ELSET={name}"
        yield from (f"{one}, {', '.join(map(str, nodes))}" for one, nodes in part.elements.items())
    axis = (*pressed.left, *striker.left)
    yield from _set("*NSET, NSET=AXIS", [one for one in axis if one in pressed.nodes or one in striker.nodes])
    yield from _set("*NSET, NSET=BASE", pressed.bottom)
    yield from _set("*NSET, NSET=SIDE", pressed.right)
    yield from _set("*NSET, NSET=STRIKER", striker.top)
    yield from ("*SURFACE, NAME=GROUND", *(f"{one}, S3" for one in pressed.highest))
    yield from ("*SURFACE, NAME=FACE", *(f"{one}, S1" for one in striker.lowest))
    for name, young in (("BODY", case.young), ("STRIKER", STIFF * case.young)):
        yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{MPA * young:.9g}, {body.nu:.9g}")
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"
    yield from ("*SURFACE INTERACTION, NAME=HARD", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
    yield f"{PENALTY * MPA * case.young / (MM * body.edge):.9g}, {NO_PULL * MPA * case.young:.9g}"
    yield from ("*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE", "GROUND, FACE")
    yield from ("*BOUNDARY", "AXIS, 1, 1", "BASE, 2, 2")
    yield from ("BASE, 1, 1",) if body.bonded else ()
    yield from ("SIDE, 1, 2",) if body.held else ()
    yield from ("*STEP, INC=200", "*STATIC", "0.1, 1., 1e-4, 0.25")
    yield from ("*BOUNDARY", f"STRIKER, 2, 2, {-MM * case.depth:.12g}", "STRIKER, 1, 1, 0.")
    yield from ("*NODE PRINT, NSET=STRIKER, TOTALS=ONLY", "RF", "*END STEP")


def _set(head: str, ids: Sequence[int]) -> Iterator[str]:
    """A set of nodes, sixteen a line."""
    yield head
    for start in range(0, len(ids), 16):
        yield ", ".join(map(str, ids[start : start + 16]))


MEMBER = CalculiX()
