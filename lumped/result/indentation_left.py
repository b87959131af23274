"""The indentation that a contact leaves behind on its axis, and its course in time once the bodies are apart."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.schema.csv_file import write_columns

Array = NDArray[np.float64]
COLUMNS = ("time_after_separation_s", "depth_m", "depth_error_m")


@dataclass(frozen=True, eq=False)
class IndentationLeft:
    """Rows (n,): time after separation, s, depth and its bar, m; the first row at separation.

    ``permanent``, m: what is left for ever; ``retardation_times`` (k,), s: those of the creep compliance, with which
    the rest goes.
    """

    time: Array
    depth: Array
    error: Array
    permanent: float
    retardation_times: tuple[float, ...]

    def to_json(self) -> dict[str, Any]:
        """What result.json says of it."""
        return {
            "residual_depth": {"value": float(self.depth[0]), "error": float(self.error[0]), "unit": "m"},
            "permanent_depth": self.permanent,
            "retardation_times": self.retardation_times,
            "time": self.time,
            "depth": self.depth,
            "error": self.error,
        }

    def write_csv(self, path: Path) -> None:
        """Write the rows, every value with all its digits."""
        write_columns(path, COLUMNS, [self.time, self.depth, self.error])
