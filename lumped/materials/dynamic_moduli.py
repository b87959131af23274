"""Storage and loss moduli over frequency, as a rheometer measures them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, freeze_columns
from lumped.schema.csv_file import read_columns, read_header

HERTZ, RADIANS = "frequency_Hz", "angular_frequency_rad_per_s"
MODULI = ("storage_Pa", "loss_Pa")
MOST_ROWS = 10_000  # ten times what a rheometer gives; the fit weighs some 100 times against all of them


@dataclass(frozen=True, eq=False)
class DynamicModuli:
    """E(i omega) = storage + i loss, Pa, at angular frequencies omega, 1/s, each of shape (n,), n >= 2.

    Raises BadInput with every fault: columns of different length, what is not finite, frequencies or storage moduli
    that are not positive, loss moduli below zero, a frequency given twice.
    """

    omega: Array
    storage: Array
    loss: Array
    source: str = "dynamic moduli"

    def __post_init__(self) -> None:
        columns = freeze_columns(self, ("omega", "storage", "loss"))
        faults = [Fault(self.source, name, message) for name, message in _faults(**columns)]
        if faults:
            raise BadInput(faults)

    @classmethod
    def read_csv(cls, path: Path) -> DynamicModuli:
        """A file with the columns storage_Pa, loss_Pa and one of frequency_Hz, angular_frequency_rad_per_s."""
        frequency = _frequency_column(path)
        columns = (frequency, *MODULI)
        table = read_columns(path, columns, MOST_ROWS)
        turns = 2.0 * np.pi if frequency == HERTZ else 1.0
        try:
            return cls(turns * table[frequency], table["storage_Pa"], table["loss_Pa"], str(path))
        except BadInput as bad:
            called = dict(zip(("omega", "storage", "loss"), columns, strict=True))
            raise BadInput(replace(fault, key=called.get(fault.key, "")) for fault in bad.faults) from None

    @property
    def modulus(self) -> NDArray[np.complex128]:
        """The complex modulus, Pa, (n,)."""
        return np.asarray(self.storage + 1j * self.loss)


def _faults(omega: Array, storage: Array, loss: Array) -> list[tuple[str, str]]:
    """Which column holds what it may not."""
    if omega.ndim != 1 or omega.size < 2 or not omega.shape == storage.shape == loss.shape:
        return [("", "columns are one-dimensional, of one length, at least 2")]
    wrong = {
        "omega": (np.any(omega <= 0.0), "accepted: frequencies above zero"),
        "storage": (np.any(storage <= 0.0), "accepted: storage moduli above zero, in Pa"),
        "loss": (np.any(loss < 0.0), "accepted: loss moduli of zero or above, in Pa: a passive material"),
    }
    columns = {"omega": omega, "storage": storage, "loss": loss}
    found = [(name, "accepted: finite values") for name, column in columns.items() if not np.all(np.isfinite(column))]
    found += [(name, message) for name, (is_wrong, message) in wrong.items() if is_wrong]
    if np.unique(omega).size < omega.size:
        found.append(("omega", "a frequency is given twice; accepted: each once"))
    return found


def _frequency_column(path: Path) -> str:
    """Which of the two frequency columns the header has. Raises BadInput when it has both."""
    header = read_header(path)
    if HERTZ in header and RADIANS in header:
        raise BadInput(Fault(str(path), RADIANS, f"accepted: one of {HERTZ} and {RADIANS}, not both"))
    return RADIANS if RADIANS in header else HERTZ
