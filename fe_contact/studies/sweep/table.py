"""The table of a sweep: every case by every method, as columns; its files, and what moves which quantity."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fe_contact.studies.files import write_parquet
from fe_contact.studies.sweep.cases import Sweep
from lumped.numbers import Array
from lumped.result.result import UNITS, provenance
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/sweep/1"
UNDEFINED = None, None  # a value and its bar
LEAST_RANKED = 3  # values of a key, or of a quantity, below which no rank says anything
Truths = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SweepTable:
    """Answers of a sweep: arrays (cases, methods), and of values and their bars (cases, methods, quantities).

    ``refused``: by name, as a value out of its range; what is neither that nor ``converged`` did not converge.
    ``cpu``, s, is what all answers took, whenever they were found.
    """

    sweep: Sweep
    values: Array
    errors: Array
    converged: Truths
    refused: Truths
    reasons: dict[tuple[int, int], str]
    cpu: float

    @classmethod
    def of(cls, sweep: Sweep, rows: Iterable[tuple[int, Sequence[Table]]]) -> SweepTable:
        """Of rows by case, in any order, one a method."""
        shape = sweep.count, len(sweep.methods)
        pairs = np.full((*shape, len(UNITS), 2), np.nan)
        converged, refused = np.zeros((2, *shape), dtype=bool)
        reasons, cpu = dict[tuple[int, int], str](), 0.0
        for case, answered in rows:
            for method, row in enumerate(answered):
                place = case, method
                pairs[place] = [row["values"].get(name, UNDEFINED) for name in UNITS]
                converged[place], refused[place] = row["converged"], row["refused"]
                if row["reason"]:
                    reasons[place] = row["reason"]
                cpu += row["cpu_s"]
        return cls(sweep, pairs[..., 0], pairs[..., 1], converged, refused, reasons, cpu)

    @cached_property
    def numbers(self) -> dict[str, Array]:
        """The keys whose values are all numbers, (cases,)."""
        cases = [self.sweep.overrides(case) for case in range(self.sweep.count)]
        columns = {key: [case[key] for case in cases] for key in self.sweep.keys}
        plain_numbers = {
            key: column
            for key, column in columns.items()
            if all(isinstance(one, int | float) and not isinstance(one, bool) for one in column)
        }
        return {key: np.array(column, dtype=float) for key, column in plain_numbers.items()}

    def ranks(self, method: int, quantity: int) -> dict[str, float]:
        """Spearman's rank correlation of a quantity with every key that is a number, over the answers that converged.

        Empty where the quantity varies by less than its bars, or takes too few values.
        """
        known = self.converged[:, method] & np.isfinite(self.values[:, method, quantity])
        values = self.values[known, method, quantity]
        keys = {key: column[known] for key, column in self.numbers.items()}
        bars = self.errors[known, method, quantity]
        if np.unique(values).size < LEAST_RANKED or np.ptp(values) <= 2.0 * bars.max():
            return {}
        varied = {key: column for key, column in keys.items() if np.unique(column).size >= LEAST_RANKED}
        return {key: float(np.corrcoef(_places(column), _places(values))[0, 1]) for key, column in varied.items()}

    @property
    def header(self) -> list[str]:
        """Of the file; every quantity with its unit."""
        names = [(name, "" if unit == "1" else "_" + unit.replace(" ", "_")) for name, unit in UNITS.items()]
        columns = [column for name, unit in names for column in (f"{name}{unit}", f"{name}_error{unit}")]
        return ["case", *self.sweep.keys, "method", "converged", "reason", *columns]

    def lines(self) -> Iterator[list[object]]:
        """Of the file: case by case, and method by method."""
        pairs = np.stack([self.values, self.errors], axis=-1).reshape(*self.converged.shape, -1)
        for case in range(self.sweep.count):
            keys = [_cell(value) for value in self.sweep.overrides(case).values()]
            for place, method in enumerate(self.sweep.methods):
                ended = bool(self.converged[case, place]), self.reasons.get((case, place), "")
                yield [case + 1, *keys, method, *ended, *pairs[case, place].tolist()]

    def record(self, wall: float) -> Table:
        """What ``sweep.json`` says, ``wall`` s after the beginning."""
        sweep = self.sweep
        ended = {"converged": self.converged, "refused": self.refused, "not_converged": ~self.converged & ~self.refused}
        ranks = {
            method: {name: self.ranks(place, quantity) for quantity, name in enumerate(UNITS)}
            for place, method in enumerate(sweep.methods)
        }
        content: Table = plain(
            {
                "schema": SCHEMA,
                "name": sweep.name,
                "scene": sweep.base.tables,
                "methods": sweep.methods,
                "tolerance": sweep.tolerance,
                "axes": [{"keys": axis.keys, "values": len(axis.places)} for axis in sweep.axes],
                "cases": sweep.count,
                "answers": {name: int(column.sum()) for name, column in ended.items()},
                "rank_correlation": ranks,
                "provenance": provenance(),
                "timing": {"cpu_s": self.cpu, "wall_s": wall},
            }
        )
        return content

    def __repr__(self) -> str:
        return "\n".join([f"{self.sweep.name}: {self.sweep.count} cases", *self.summary()])

    def summary(self) -> list[str]:
        """A line a method: how its answers ended, and the widest bar of a peak force."""
        said = []
        for place, method in enumerate(self.sweep.methods):
            converged, refused = self.converged[:, place], self.refused[:, place]
            counts = f"{converged.sum()} converged, {refused.sum()} refused"
            missed = (~converged & ~refused).sum()
            said.append(f"{method}: {counts}, {missed} not converged{self._widest(place)}{self._refusal(place)}")
        return said

    def _refusal(self, method: int) -> str:
        """Why cases were refused, as most of them were; nothing where none was."""
        cases = np.flatnonzero(self.refused[:, method]).tolist()
        reasons = Counter(self.reasons.get((case, method), "no reason given") for case in cases).most_common(1)
        return f"; refused: {reasons[0][0]}" if reasons else ""

    def _widest(self, method: int) -> str:
        """The case whose answer converged with the widest bar; nothing where none has a bar."""
        force = (slice(None), method, list(UNITS).index("peak_force"))
        known = self.converged[:, method] & (self.values[force] > 0.0) & np.isfinite(self.errors[force])
        if not known.any():
            return ""
        bars = np.divide(self.errors[force], self.values[force], out=np.full(known.size, -1.0), where=known)
        return f"; widest bar {bars.max():.1e} of the peak force, case {bars.argmax() + 1}"

    @property
    def missed(self) -> str:
        """What did not converge, in one line; nothing where all did."""
        places = np.argwhere(~self.converged & ~self.refused).tolist()
        if not places:
            return ""
        case, method = places[0]
        first = (
            f"case {case + 1} by {self.sweep.methods[method]}: {self.reasons.get((case, method), 'no reason given')}"
        )
        return f"{len(places)} of {self.converged.size} answers did not converge; {first}"

    def write(self, where: str | Path, wall: float, parquet: bool = False) -> None:
        """``table.csv``, ``sweep.json`` and, where it is asked for, ``table.parquet``; raises ExtraMissing."""
        folder = Path(where)
        write_csv(folder / "table.csv", self.header, self.lines())
        write_json(folder / "sweep.json", self.record(wall))
        if parquet:
            write_parquet(folder / "table.parquet", dict(zip(self.header, self._columns(), strict=True)))

    def _columns(self) -> Iterator[Sequence[object] | npt.NDArray[np.generic]]:
        """Of the table, each of all its rows."""
        cases, methods = range(self.sweep.count), self.sweep.methods
        yield np.repeat(np.arange(1, len(cases) + 1), len(methods))
        for key in self.sweep.keys:
            column = self.numbers.get(key)
            yield np.repeat(
                [str(_cell(self.sweep.overrides(case)[key])) for case in cases] if column is None else column,
                len(methods),
            )
        yield [*methods] * len(cases)
        yield self.converged.ravel()
        yield [self.reasons.get((case, method), "") for case in cases for method in range(len(methods))]
        for quantity in range(len(UNITS)):
            yield self.values[..., quantity].ravel()
            yield self.errors[..., quantity].ravel()


def _places(values: Array) -> Array:
    """Where each value stands among all of them, ascending; equal ones share the mean of their places."""
    _, which, counts = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - 0.5 * counts)[which])


def _cell(value: object) -> object:
    return json.dumps(value, default=str) if isinstance(value, list | dict) else value
