"""A profile of one's own, as a table of heights over the radius: measured, or drawn.

Between the rows the slope is linear piece by piece, with a bend between two rows where it needs one: heights and slopes
at the rows are met and what is convex stays convex (Schumaker 1983, doi 10.1137/0720057).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, ClassVar, NamedTuple

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.load_curves.bent import BentCurve
from lumped.numbers import Array
from lumped.schema.csv_file import read_columns
from lumped.schema.keys import File, Key, Number, Numbers, Part, Sets, keys_of, made, optional
from lumped.shapes.base import SIZE, Bent

MOST_ROWS = 200  # each bend is summed over at every step of every method
COLUMNS = ("r_m", "height_m")
EVEN = 1e-9  # rounding, of the last slope: rows on one straight line need no bend, nor does a dent as small count


@dataclass(frozen=True)
class Profile(Bent):
    """Heights, m, over radii from 0 on, m, both ascending from zero and convex, each of shape (n,), 3 <= n <= 200.

    A contact wider than the table is refused. Raises BadInput with every fault.
    """

    r: Annotated[tuple[float, ...], Key(Numbers(Number(0.0, SIZE.high, "m"), MOST_ROWS), "radii, ascending from 0")]
    heights: Annotated[
        tuple[float, ...], Key(Numbers(Number(0.0, SIZE.high, "m"), MOST_ROWS), "height at each radius", name="height")
    ]
    name: ClassVar[str] = "profile"

    def __post_init__(self) -> None:
        super().__post_init__()
        if reason := _wrong(np.array(self.r), np.array(self.heights)):
            raise BadInput(Fault(self.name, "height", reason))

    @property
    def exponent_of_force(self) -> float:
        """That of its start: 2 of a pointed tip, 1 of a flat one, else 3/2."""
        curve = self.load_curve
        return 2.0 if curve.slope > 0.0 else 1.0 if curve.least_radius > 0.0 else 1.5

    @cached_property
    def load_curve(self) -> BentCurve:
        """Its bends, in closed form."""
        return _bent(np.array(self.r), np.array(self.heights))

    def check_contact(self, contact_radius: float) -> str:
        """Not beyond the last row."""
        wide = f"a contact of {contact_radius:.3g} m; the profile's table ends at {self.r[-1]:g} m"
        return wide if contact_radius > self.r[-1] else ""


class _Chords(NamedTuple):
    """Between n rows: widths, m, and slopes, (n - 1,); at the rows between them by how much the slope rises, (n - 2,),
    and the curvature just before and just after, 1/m times m.
    """

    width: Array
    slope: Array
    rise: Array
    before: Array
    after: Array

    @classmethod
    def of(cls, r: Array, height: Array) -> _Chords:
        """Of a table whose radii ascend; before the first row the profile is its own mirror image."""
        width = np.diff(r)
        slope = np.diff(height) / width
        rise = np.diff(slope)
        rise[np.abs(rise) <= EVEN * slope[-1]] = 0.0
        curvature = 2.0 * rise / (width[:-1] + width[1:])
        first = min(curvature[0], 2.0 * slope[0] / width[0])
        around = np.array([first, *curvature, curvature[-1]])
        return cls(width, slope, rise, width[:-1] * around[:-2], width[1:] * around[2:])


def _wrong(r: Array, height: Array) -> str:
    """What is wrong with a table; empty where nothing is."""
    if r.size != height.size or r.size < 3:
        return f"{height.size} heights at {r.size} radii; accepted: one each, at least 3"
    if r[0] != 0.0 or height[0] != 0.0 or np.any(np.diff(r) <= 0.0):
        return "accepted: radii that ascend from 0, and the height 0 at the first"
    chords = _Chords.of(r, height)
    if chords.slope[-1] <= 0.0 or chords.slope[0] < 0.0:
        return "accepted: heights that nowhere fall and rise in the end"
    if np.any(chords.rise < 0.0):
        return f"hollow at the radius {r[1 + chords.rise.argmin()]:g} m; accepted: a convex profile"
    corner = np.flatnonzero((chords.rise > 0.0) & (chords.before + chords.after == 0.0))
    return f"a corner at the radius {r[1 + corner[0]]:g} m; accepted: one rounded by more rows" if corner.size else ""


def _bent(r: Array, height: Array) -> BentCurve:
    """The convex spline of second degree through the rows; its slope bends where it is that of a chord too.

    At a row the slope is nearer to the chord on whose side the profile is less curved, so that what is straight
    stays straight; a parabola is met whole.
    """
    width, chord, rise, before, after = _Chords.of(r, height)
    inner = chord[:-1] + rise * np.divide(before, before + after, out=np.zeros_like(rise), where=rise > 0.0)
    slope = np.array([max(2.0 * chord[0] - inner[0], 0.0), *inner, 2.0 * chord[-1] - inner[-1]])
    whole = np.diff(slope)
    share = np.divide(slope[1:] - chord, whole, out=np.full_like(whole, 0.5), where=whole > EVEN * chord[-1])
    places = np.append(np.column_stack([r[:-1], r[:-1] + share * width]).ravel(), r[-1])
    slopes = np.append(np.column_stack([slope[:-1], chord]).ravel(), slope[-1])
    bends = np.diff(np.diff(slopes) / np.diff(places), prepend=0.0)
    counts = np.abs(bends) > EVEN * chord[-1] / r[-1]
    return BentCurve(tuple(places[:-1][counts].tolist()), tuple(bends[counts].tolist()), float(slope[0]))


class ProfilePart(Part[Profile]):
    """A table in a file of its own, or in the scene's."""

    @property
    def sets(self) -> Sets:
        """One: `file`, or `r` and `height`."""
        return (optional({**keys_of(read), **keys_of(Profile)}),)

    def of(self, **values: object) -> Profile:
        """The instance of a table's checked values. Raises BadInput."""
        if values.keys() == keys_of(read).keys():
            return made(read, values)
        if values.keys() == keys_of(Profile).keys():
            return made(Profile, values)
        raise BadInput(Fault(Profile.name, "file", "accepted: file, or r and height, and not both"))


def read(file: Annotated[Path, Key(File(), "CSV table of the profile, columns r_m and height_m")]) -> Profile:
    """The profile of a CSV file. Raises BadInput."""
    columns = read_columns(file, COLUMNS, MOST_ROWS)
    return Profile(*(tuple(columns[name].tolist()) for name in COLUMNS))


MEMBER = ProfilePart(Profile)
