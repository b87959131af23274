"""Element sizes as expressions over (x, y), in the words of gmsh."""

from __future__ import annotations


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


def elements_checked(along: str, value: float, low: float, high: float) -> float:
    """Elements along a length within their range. Raises MeshTooFine, or MeshError where there are too few."""
    from meshes.errors import MeshTooFine

    if value > high:
        raise MeshTooFine(f"{value:g} elements along {along}: accepted {low:g} to {high:g}")
    return checked(f"elements along {along}", value, low, high)


def checked(name: str, value: float, low: float, high: float) -> float:
    """A number within its range, as a plain float: gmsh reads its digits. Raises MeshError, `name` in plain words."""
    from meshes.errors import MeshError

    if not low <= value <= high:
        raise MeshError(f"{name} = {value:g}: accepted {low:g} to {high:g}")
    return float(value)
