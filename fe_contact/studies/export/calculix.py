"""CalculiX: an input deck of a slow indentation, with a mesh of its own of eight-node axisymmetric elements.

CalculiX has no rigid analytic surface: the striker is a body a thousand times as stiff, its face nodes on the profile.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_contact.studies.export.base import ImpactCase, StaticCase
from lumped.errors import BadInput, Fault
from lumped.numbers import Array

FAR = 4000.0  # contact radii, where an infinite body ends
REACH, GROWTH = 1.4, 1.25  # how far the fine elements go, in contact radii; how those beyond grow
ROWS = 4  # of the striker's elements
STIFF, PENALTY = 1e4, 1e3  # striker over body; pressure over overlap, in Young's moduli over the contact radius


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


def graded(fine: float, uniform: float, end: float) -> Array:
    """Places from 0 to ``end``, equal up to ``uniform``, then growing, with a middle in every interval."""
    places = np.linspace(0.0, min(uniform, end), max(round(min(uniform, end) / fine), 2) + 1).tolist()
    size = fine
    while places[-1] < end:
        size *= GROWTH
        places.append(places[-1] + size if places[-1] + 1.5 * size < end else end)
    corners = np.asarray(places)
    return np.sort(np.concatenate([corners, 0.5 * (corners[1:] + corners[:-1])]))


@dataclass(frozen=True)
class CalculiX:
    """See the module."""

    suffix: ClassVar[str] = ".inp"
    how: ClassVar[str] = (
        "ccx -i {stem}, then the vertical force of STRIKER in {stem}.dat times 180 (a wedge of 2 degrees)"
    )

    elements: ClassVar[int] = 12

    def static(self, case: StaticCase, elements: int) -> str:
        """As the contract says."""
        return "\n".join(_deck(case, elements)) + "\n"

    def impact(self, case: ImpactCase, elements: int) -> str:
        """Raises BadInput: CalculiX has no relaxation in time."""
        raise BadInput(Fault("--to", "calculix", f"{case.name}: slow indentation alone; accepted: --depth, or ngsolve"))


def _deck(case: StaticCase, elements: int) -> Iterator[str]:
    """Line by line."""
    body, fine = case.body.cut_off(FAR), case.body.edge / elements
    r = graded(fine, REACH * body.edge, body.radius)
    deep = -graded(fine, 0.5 * body.edge, body.thickness)[::-1]
    pressed = block(r, np.repeat(deep[:, None], r.size, axis=1), 1)
    across = np.linspace(0.0, REACH * body.edge, 2 * round(REACH * elements * 1.3) + 1)
    face = body.height(across)
    up = np.linspace(0.0, 1.0, 2 * ROWS + 1)[:, None]
    striker = block(across, face + up * (face[-1] + body.edge - face), max(pressed.nodes) + 1)

    yield f"** {case.name}: a profile pressed {case.depth:.9g} m deep. Lengths in m, forces in N."
    yield from (f"** {line}" for line in case.said)
    yield "*NODE, NSET=ALL"
    for part in (pressed, striker):
        yield from (f"{one}, {x:.12g}, {y:.12g}, 0" for one, (x, y) in part.nodes.items())
    for name, part in (("BODY", pressed), ("STRIKER", striker)):
        yield f"*ELEMENT, TYPE=CAX8, ELSET={name}"
        yield from (f"{one}, {', '.join(map(str, nodes))}" for one, nodes in part.elements.items())
    axis = (*pressed.left, *striker.left)
    yield from _set("*NSET, NSET=AXIS", [one for one in axis if _known(one, pressed, striker)])
    yield from _set("*NSET, NSET=BASE", pressed.bottom)
    yield from _set("*NSET, NSET=SIDE", pressed.right)
    yield from _set("*NSET, NSET=STRIKER", striker.top)
    yield from ("*SURFACE, NAME=GROUND", *(f"{one}, S3" for one in pressed.highest))
    yield from ("*SURFACE, NAME=FACE", *(f"{one}, S1" for one in striker.lowest))
    for name, young in (("BODY", case.young), ("STRIKER", STIFF * case.young)):
        yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.9g}, {body.nu:.9g}")
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"
    yield from ("*SURFACE INTERACTION, NAME=HARD", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
    yield f"{PENALTY * case.young / body.edge:.9g}, {1e-6 * case.young:.9g}"
    yield from ("*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE", "GROUND, FACE")
    yield from ("*BOUNDARY", "AXIS, 1, 1", "BASE, 2, 2")
    yield from ("BASE, 1, 1",) if body.bonded else ()
    yield from ("SIDE, 1, 2",) if body.held else ()
    yield from ("*STEP, INC=200", "*STATIC", "0.1, 1., 1e-4, 0.25")
    yield from ("*BOUNDARY", f"STRIKER, 2, 2, {-case.depth:.12g}", "STRIKER, 1, 1, 0.")
    yield from ("*NODE PRINT, NSET=STRIKER, TOTALS=ONLY", "RF", "*END STEP")


def _known(one: int, *parts: Grid) -> bool:
    return any(one in part.nodes for part in parts)


def _set(head: str, ids: Sequence[int]) -> Iterator[str]:
    """A set of nodes, sixteen a line."""
    yield head
    for start in range(0, len(ids), 16):
        yield ", ".join(map(str, ids[start : start + 16]))


MEMBER = CalculiX()
