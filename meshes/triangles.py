"""From gmsh's open model to plain arrays of triangles, their number estimated before gmsh is asked.

Element sizes are expressions over (x, y), in the words of gmsh.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from meshes.errors import MeshError, MeshTooFine, MeshTooLarge
from meshes.session import session

if TYPE_CHECKING:
    from skfem import MeshTri

Array = npt.NDArray[np.float64]

MOST_NODES = 40_000  # some five seconds of gmsh, in which it answers to nothing
ON_BOUNDARY = 0.25  # of them: as long again, for these take time by the square of their number
PER_AREA = 2 / 3**0.5  # nodes of equal triangles of size h a square h
DIGITS = 10  # of sizes: a mesh is to be the same whatever unit or machine made the sixteenth one
BESIDE_GROWTH = 5.0  # element size over the distance from the rim of a flat end, for one element along the radius
LEAST_BESIDE = 1e-4  # over the largest contact: nearer to the rim of a flat end it is as good as sharp
COARSE = 1.5  # sides of a cell over the size of the elements in it, at most: a finer look hardly changes the sum


@dataclass(frozen=True)
class Outline:
    """What is meshed: a box from its ``low`` (x, y) to its ``high`` corner, or its part in a disc (x, y, radius)."""

    low: tuple[float, float]
    high: tuple[float, float]
    disc: tuple[float, float, float] | None = None

    @property
    def sides(self) -> Array:
        """Lengths of the box, (2, 1)."""
        return np.subtract(self.high, self.low)[:, None]

    def holds(self, places: Array) -> npt.NDArray[np.bool_]:
        """Which places (2, n) of the box lie within, (n,)."""
        if self.disc is None:
            return np.ones(places.shape[1], dtype=bool)
        x, y, radius = self.disc
        return np.asarray(np.hypot(places[0] - x, places[1] - y) <= radius)

    def rims(self, places: Array, lengths: Array) -> Array:
        """What cells about places have of the box's boundary, (n,); both (2, n)."""
        ends = np.array([self.low, self.high])[:, :, None]
        touching = (abs(ends - places) <= 0.51 * lengths).sum(axis=0)
        return np.asarray((touching * lengths[::-1]).sum(axis=0))


@dataclass(frozen=True)
class Imprint:
    """By which a mesh is known again: how many ``nodes`` and ``triangles``, the ``sha256`` of both arrays' bytes."""

    nodes: int
    triangles: int
    sha256: str


_imprints: ContextVar[list[Imprint] | None] = ContextVar("imprints", default=None)


@contextmanager
def imprints() -> Iterator[list[Imprint]]:
    """A list that meanwhile gets the imprint of every mesh that gmsh makes, in the order in which they are made."""
    found: list[Imprint] = []
    before = _imprints.set(found)
    try:
        yield found
    finally:
        _imprints.reset(before)


def triangulated(gmsh: Any, size: str, outline: Outline) -> tuple[np.ndarray, np.ndarray]:
    """Mesh the open model with an element size over (x, y); node coordinates (2, n) and triangles (3, m).

    Nodes of no triangle are dropped. Raises MeshTooLarge, before gmsh is asked, where too many are to be expected.
    """
    if expected_nodes(size, outline, MOST_NODES) > MOST_NODES:
        raise MeshTooLarge(MOST_NODES)
    meshing = gmsh.model.mesh
    field = meshing.field.add("MathEval")
    meshing.field.setString(field, "F", size)
    meshing.field.setAsBackgroundMesh(field)
    meshing.generate(2)
    tags, coordinates, _ = meshing.getNodes()
    kinds, _, connectivity = meshing.getElements(2)
    corners = connectivity[list(kinds).index(2)].astype(int)
    used, triangles = np.unique(corners, return_inverse=True)
    row_of_tag = np.zeros(int(tags.max()) + 1, dtype=int)
    row_of_tag[tags.astype(int)] = np.arange(len(tags))
    nodes = np.ascontiguousarray(coordinates.reshape(-1, 3)[row_of_tag[used], :2].T)
    triangles = np.ascontiguousarray(triangles.reshape(-1, 3).T)
    if (found := _imprints.get()) is not None:
        digest = hashlib.sha256(nodes.tobytes() + triangles.tobytes()).hexdigest()
        found.append(Imprint(nodes.shape[1], triangles.shape[1], digest))
    return nodes, triangles


def filled(
    points: Sequence[tuple[float, float]],
    edges: Sequence[tuple[int, ...]],
    faces: Sequence[tuple[int, ...]],
    size: str,
    outline: Outline,
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (2, n) and triangles (3, m) of faces whose edges are lines and arcs between points (x, y).

    An edge is the places of its points in their list, an arc's centre between them; a face the numbers of its edges,
    from 1 on, negative where it runs along one backwards.
    """
    with session("faces") as gmsh:
        geometry = gmsh.model.geo
        tags = [geometry.addPoint(x, y, 0) for x, y in points]
        adding = {2: geometry.addLine, 3: geometry.addCircleArc}
        lines = [adding[len(edge)](*(tags[place] for place in edge)) for edge in edges]
        for face in faces:
            loop = [lines[number - 1] if number > 0 else -lines[-number - 1] for number in face]
            geometry.addPlaneSurface([geometry.addCurveLoop(loop)])
        geometry.synchronize()
        return triangulated(gmsh, size, outline)


def polygon(corners: Sequence[tuple[float, float]], size: str) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (2, n) and triangles (3, m) of a rectangle by its corners (x, y), other nodes of its rim among them."""
    count = len(corners)
    edges = [(start, (start + 1) % count) for start in range(count)]
    low, high = ((extreme(x for x, _ in corners), extreme(y for _, y in corners)) for extreme in (min, max))
    return filled(corners, edges, [tuple(range(1, count + 1))], size, Outline(low, high))


def tagged(nodes: Array, triangles: np.ndarray, boundaries: Mapping[str, Callable[[Array], Any]]) -> MeshTri:
    """The mesh of nodes (2, n) and triangles (3, m), ``boundaries`` by what holds at the middles of their facets."""
    from skfem import MeshTri  # late: a body that is known already needs no mesh

    return MeshTri(nodes, triangles).with_boundaries(dict(boundaries))


def expected_nodes(size: str, outline: Outline, most: float) -> float:
    """About how many nodes a mesh of this size over (x, y), in the words of gmsh, has; infinite if clearly over most.

    Also where more than ``ON_BOUNDARY`` of most would lie on the outline. Cells are quartered until none is much larger
    than the elements in it; no element is larger than the box.
    """
    formula = compile(size.replace("^", "**"), "size", "eval")
    sides, found, around = outline.sides, 0.0, 0.0
    parts = np.ceil(sides / sides.min())
    if parts.prod() > most:
        return np.inf
    lengths, places = sides / parts, _grid(outline, parts)
    while places.shape[1]:
        sizes = _sizes(formula, places)
        coarse = lengths.max() > COARSE * sizes
        if coarse.sum() > most:
            return np.inf
        cells, here = places[:, ~coarse], sizes[~coarse]
        area = lengths.prod() / (np.minimum(here, sides[0]) * np.minimum(here, sides[1]))
        holds = outline.holds(cells)
        rim = outline.rims(cells, lengths) / here * holds
        around += float(rim.sum())
        found += float((PER_AREA * area * holds + 0.5 * rim).sum())
        lengths = lengths / 2
        shifts = 0.5 * lengths * np.array([[-1, 1, -1, 1], [-1, -1, 1, 1]])
        places = (places[:, coarse, None] + shifts[:, None, :]).reshape(2, -1)
    return found if around <= ON_BOUNDARY * most else np.inf


def _grid(outline: Outline, parts: Array) -> Array:
    """Middles of equal cells, so many along each side, (2, n)."""
    (x, y), (low, high) = parts[:, 0].astype(int), (outline.low, outline.high)
    axes = [start + (end - start) * (np.arange(n) + 0.5) / n for start, end, n in zip(low, high, (x, y), strict=True)]
    return np.array([axis.ravel() for axis in np.meshgrid(*axes)])


def _sizes(formula: Any, places: Array) -> Array:
    """The very formula that gmsh reads, made of our own numbers alone, at places (2, n)."""
    names = {"__builtins__": {}, "Sqrt": np.sqrt, "Fabs": np.abs, "x": places[0], "y": places[1]}
    return np.broadcast_to(eval(formula, names), places.shape[1:])


def smaller(first: str, second: str) -> str:
    """The smaller of two."""
    return f"({first}+({second})-Fabs({first}-({second})))/2"


def larger(first: str, second: str) -> str:
    """The larger of two."""
    return f"({first}+({second})+Fabs({first}-({second})))/2"


def beyond(value: str, start: float) -> str:
    """How far a value lies beyond a start, 0 before it."""
    return f"({value}-{start!r}+Fabs({value}-{start!r}))/2"


def distance(x: float, y: float) -> str:
    """From a point."""
    return f"Sqrt((x-({x!r}))^2+(y-({y!r}))^2)"


def beside_flat(size: str, elements: float, flat: float, beside: float) -> str:
    """No larger than in proportion to the distance from the rim (flat, 0) of a flat end, or from as little ``beside``.

    So all contacts are resolved alike that end so near to it, where their pressure is steep; an end of 0 has no rim.
    Raises MeshError for lengths out of their ranges.
    """
    rim = checked("radius of the flat end over the largest contact", flat, 0.0, 1.0)
    nearest = checked("distance of the smallest contact from it", beside, LEAST_BESIDE, 1.0)
    if rim == 0.0:
        return size
    return smaller(size, f"{min(BESIDE_GROWTH / elements, 1.0)!r}*({nearest!r}+{distance(rim, 0.0)})")


def elements_checked(along: str, value: float, low: float, high: float) -> float:
    """Elements along a length within their range. Raises MeshTooFine, or MeshError where there are too few."""
    if value > high:
        raise MeshTooFine(f"{value:g} elements along {along}: accepted {low:g} to {high:g}")
    return checked(f"elements along {along}", value, low, high)


def checked(name: str, value: float, low: float, high: float) -> float:
    """A number within its range, of ``DIGITS``: gmsh reads them. Raises MeshError, `name` in plain words."""
    if not low <= value <= high:
        raise MeshError(f"{name} = {value:g}: accepted {low:g} to {high:g}")
    return float(f"{value:.{DIGITS}g}")
