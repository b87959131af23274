"""The table of a sweep: every case by every method, as columns; its files, and what moves which quantity."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fe_contact.errors import ExtraMissing
from fe_contact.studies.sweep.cases import Sweep
from lumped.numbers import Array
from lumped.result.result import UNITS, provenance
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/sweep/1"
LEAST_RANKED = 3  # values of a key, or of a quantity, below which no rank says anything
PARQUET_ROWS = 100_000  # work: of the table turned into Parquet at a time
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
        values, errors = np.full((2, *shape, len(UNITS)), np.nan)
        converged, refused = np.zeros((2, *shape), dtype=bool)
        reasons, cpu = dict[tuple[int, int], str](), 0.0
        for case, answered in rows:
            for method, row in enumerate(answered):
                place = case, method
                for quantity, name in enumerate(UNITS):
                    value, error = row["values"].get(name, (None, None))
                    values[(*place, quantity)] = np.nan if value is None else value
                    errors[(*place, quantity)] = np.nan if error is None else error
                converged[place], refused[place] = row["converged"], row["refused"]
                if row["reason"]:
                    reasons[place] = row["reason"]
                cpu += row["cpu_s"]
        return cls(sweep, values, errors, converged, refused, reasons, cpu)

    @property
    def all_ended(self) -> bool:
        """Whether every case is an answer that converged, or a refusal by name."""
        return bool((self.converged | self.refused).all())

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

        Empty where one of both hardly varies.
        """
        from scipy.stats import spearmanr

        known = self.converged[:, method] & np.isfinite(self.values[:, method, quantity])
        values = self.values[known, method, quantity]
        keys = {key: column[known] for key, column in self.numbers.items()}
        if np.unique(values).size < LEAST_RANKED:
            return {}
        varied = {key: column for key, column in keys.items() if np.unique(column).size >= LEAST_RANKED}
        return {key: float(spearmanr(column, values).statistic) for key, column in varied.items()}

    @property
    def header(self) -> list[str]:
        """Of the file; every quantity with its unit."""
        names = [(name, "" if unit == "1" else "_" + unit.replace(" ", "_")) for name, unit in UNITS.items()]
        columns = [column for name, unit in names for column in (f"{name}{unit}", f"{name}_error{unit}")]
        return ["case", *self.sweep.keys, "method", "converged", "reason", *columns]

    def lines(self) -> Iterator[list[object]]:
        """Of the file: case by case, and method by method."""
        for case in range(self.sweep.count):
            keys = [_cell(value) for value in self.sweep.overrides(case).values()]
            for place, method in enumerate(self.sweep.methods):
                pairs = np.stack([self.values[case, place], self.errors[case, place]], axis=-1).ravel().tolist()
                ended = bool(self.converged[case, place]), self.reasons.get((case, place), "")
                yield [case + 1, *keys, method, *ended, *pairs]

    def record(self, wall: float) -> Table:
        """What ``sweep.json`` says, ``wall`` s after the beginning."""
        sweep = self.sweep
        count = {"converged": self.converged, "refused": self.refused & ~self.converged}
        counted = {name: int(column.sum()) for name, column in count.items()}
        missed = int((~self.converged & ~self.refused).sum())
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
                "answers": {**counted, "not_converged": missed},
                "rank_correlation": ranks,
                "provenance": provenance(),
                "timing": {"cpu_s": self.cpu, "wall_s": wall},
            }
        )
        return content

    def write(self, where: Path, wall: float, parquet: bool = False) -> None:
        """``table.csv``, ``sweep.json`` and, where it is asked for, ``table.parquet``; raises ExtraMissing."""
        write_csv(where / "table.csv", self.header, self.lines())
        write_json(where / "sweep.json", self.record(wall))
        if parquet:
            self._write_parquet(where / "table.parquet")

    def _write_parquet(self, path: Path) -> None:
        try:
            from pyarrow import csv, parquet
        except ImportError:
            raise ExtraMissing("pyarrow", "parquet") from None
        with csv.open_csv(path.with_name("table.csv")) as batches:
            with parquet.ParquetWriter(path, batches.schema) as writer:
                for batch in batches:
                    writer.write_batch(batch)


def _cell(value: object) -> object:
    return json.dumps(value, default=str) if isinstance(value, list | dict) else value
