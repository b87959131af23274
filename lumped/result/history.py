"""The history of one impact, what every model, lumped or finite element, returns; and how an impact can end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault, PackageMissing
from lumped.numbers import Array, freeze_columns
from lumped.schema.csv_file import read_columns, write_columns
from lumped.schema.shown import Picture, curves, html_table

if TYPE_CHECKING:
    from pandas import DataFrame

COLUMNS = {
    "time": "time_s",
    "depth": "depth_m",
    "velocity": "velocity_m_per_s",
    "force": "force_N",
    "contact_radius": "contact_radius_m",
    "force_error": "force_error_N",
}
LEAST_ROWS = 201  # look: equal parts and one more, so dense at least is a history
MOST_ROWS = 100_001  # work: rows at which it is made no denser
# Relative to the time at the end of an interval, and of the first one to the whole: what halving stops at.
SHORTEST, FIRST = 2.0**-50, 1e-150
# In so many parts at most an interval is divided at once; a peak force that divides without harm.
MOST_PARTS, TINY = 16.0, 1e-300
FLATTENED = 3  # work: divisions after which a smooth arc is straight enough
# In a fluid without gravity the approach may die away without a turn: below this share of the velocity at
# touch the striker counts as at rest.
AT_REST = 1e-7


class End(Enum):
    """Why the history of an impact stops; the value says so to the user."""

    SEPARATED = "separated"
    TIME = "not separated at end_time"
    REST = "not separated: the striker came to rest"
    SECOND_APPROACH = (
        "the striker approaches again before it has left, which this law does not follow; cure: --method fe"
    )


class ForceOverTime:
    """What has rows of a time, s, never decreasing, and a force, N, both of shape (n,)."""

    time: Array
    force: Array

    def force_at(self, time: ArrayLike) -> Array:
        """Force at other times, N: linear between the rows, zero outside them."""
        return np.asarray(np.interp(np.asarray(time, dtype=float), self.time, self.force, left=0.0, right=0.0))


@dataclass(frozen=True, eq=False)
class History(ForceOverTime):
    """Columns of one length >= 2: `time`, s, never decreasing; `depth`, m, positive into the target; `velocity`, m/s,
    positive while approaching; `force`, N; `contact_radius`, m; `force_error`, N, half-width of the force's bar.

    Raises BadInput.
    """

    time: Array
    depth: Array
    velocity: Array
    force: Array
    contact_radius: Array
    force_error: Array

    def __post_init__(self) -> None:
        columns = freeze_columns(self, COLUMNS)
        for name, column in columns.items():
            if column.ndim != 1 or column.size < 2 or column.shape != self.time.shape:
                raise BadInput(Fault("history", name, "columns are one-dimensional, of one length, at least 2"))
        finite = np.isfinite([*columns.values()]).all(axis=1)
        if not finite.all():
            raise BadInput(Fault("history", [*columns][finite.argmin()], "every value is finite"))
        if np.any(np.diff(self.time) < 0.0):
            raise BadInput(Fault("history", "time", "time never decreases"))

    def __len__(self) -> int:
        return int(self.time.size)

    def __repr__(self) -> str:
        ends = [f"{name} {column.min():.4g} to {column.max():.4g} {unit}" for name, column, unit in self._columns()]
        return f"History of {len(self)} rows: {', '.join(ends)}"

    def _repr_html_(self) -> str:
        rows = ((name, f"{column.min():.5g}", f"{column.max():.5g}", unit) for name, column, unit in self._columns())
        return html_table(("column", "least", "most", "unit"), rows) + self.plot().svg

    def _columns(self) -> Iterator[tuple[str, Array, str]]:
        """Name, values and unit of each."""
        for name, header in COLUMNS.items():
            yield name, getattr(self, name), header.removeprefix(f"{name}_").replace("_per_", "/")

    def plot(self, **others: ForceOverTime) -> Picture:
        """Force, N, over time, s, as a notebook shows it or ``.write("force.svg")``; beside others by their names."""
        every = {"force" if not others else "this": self} | others
        return curves({name: (one.time, one.force) for name, one in every.items()}, "time, s", "force, N")

    def to_pandas(self) -> DataFrame:
        """A table of pandas with the columns of history.csv. Raises PackageMissing without pandas."""
        try:
            import pandas as pd
        except ImportError:
            raise PackageMissing("pandas") from None
        return pd.DataFrame({header: getattr(self, name) for name, header in COLUMNS.items()})

    def resampled(self, time: ArrayLike) -> History:
        """The history at other times, s, linear between the rows and held at its ends."""
        t = np.asarray(time, dtype=float)
        columns = {name: np.interp(t, self.time, getattr(self, name)) for name in COLUMNS if name != "time"}
        return History(time=t, **columns)

    def write_csv(self, path: Path) -> None:
        """Write the columns, every value with all its digits."""
        write_columns(path, tuple(COLUMNS.values()), [getattr(self, name) for name in COLUMNS])

    @classmethod
    def read_csv(cls, path: Path) -> History:
        """Read what `write_csv` wrote; more columns may follow. Raises BadInput."""
        table = read_columns(path, tuple(COLUMNS.values()))
        return cls(**{name: table[column] for name, column in COLUMNS.items()})


def densified(times: ArrayLike, force: Callable[[Array], Array], tolerance: float) -> Array:
    """Times between which linear interpolation of `force` errs by less than `tolerance` times its peak.

    `times` is where to start, shape (n,), n >= 2; `force` maps times, s, to forces, N. At least 201 rows come
    back; an interval stops being divided when it is 2^-50 of the time there (a step in the force), the first one,
    where a force may rise with a small power of time, when it is 1e-150 of the whole, or at 100001 rows.
    """
    t = np.unique(np.asarray(times, dtype=float))
    t = divided(t, np.ceil(np.diff(t) * ((LEAST_ROWS - 1) / (t[-1] - t[0]))))[0]
    f, rough = force(t), np.ones(t.size - 1, dtype=bool)
    start, first, rounds = t[0], FIRST * (t[-1] - t[0]), 0
    while rough.any() and t.size < MOST_ROWS:
        rounds += 1
        lengths = np.diff(t)
        middle = 0.5 * (t[:-1] + t[1:])[rough]
        off = np.abs(force(middle) - 0.5 * (f[:-1] + f[1:])[rough])
        # A smooth arc deviates most at its middle; half of the allowance covers one that does not.
        allowed = 0.5 * tolerance * np.abs(f).max()
        long = lengths[rough] > np.maximum(SHORTEST * np.maximum(t[1:][rough] - start, abs(start)), first)
        parts = np.ones(lengths.size)
        # The deviation falls with the square of the length.
        more = np.minimum(np.ceil(np.sqrt(off / max(allowed, TINY)) - 1.0), MOST_PARTS - 1.0)
        if rounds > FLATTENED:  # after the first row, where a power may rise, no arc is left but a step
            more = np.where((more > 0.0) & (t[:-1][rough] > start), MOST_PARTS - 1.0, more)
        parts[rough] += long * more
        if parts.max() <= 1.0:
            break
        t, f, rough = _refined(t, f, parts, force)
    return t


def divided(t: Array, parts: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Ascending times with every interval in so many equal parts, shape (n - 1,), zero as one; which are new."""
    counts = np.maximum(parts, 1.0).astype(np.intp)
    which = np.repeat(np.arange(counts.size), counts)
    nth = np.arange(which.size) - np.repeat(np.cumsum(counts) - counts, counts)
    found = t[which] + np.diff(t)[which] * (nth / counts[which])
    return np.append(found, t[-1]), np.append(nth > 0, False)


def _refined(
    t: Array, f: Array, parts: Array, force: Callable[[Array], Array]
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """The rows with their intervals divided, and which intervals are new."""
    rows, new = divided(t, parts)
    forces = np.empty(rows.size)
    forces[~new] = f
    if new.any():
        forces[new] = force(rows[new])
    return rows, forces, new[:-1] | new[1:]
