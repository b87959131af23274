"""What a fit found: parameters with their intervals, how they hang together, and what is left of the error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from lumped.numbers import Array
from lumped.result.folder import publish
from lumped.result.history import ForceOverTime, History
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json
from lumped.schema.shown import Picture, curves, html_table

SCHEMA, RECORD = "fe-contact/fit/1", "fit.json"
LEVEL = 0.95  # of the intervals
WIDTH = 12  # look: of a parameter's name


@dataclass(frozen=True)
class Estimate:
    """A value and its confidence interval of the level; the ends are None where the curve does not tell them."""

    value: float
    low: float | None
    high: float | None
    unit: str

    def __str__(self) -> str:
        if self.low is None and self.high is None:
            return f"{self.value:.6g} {self.unit}, interval unknown".replace(" ,", ",")
        low, high = ("open" if end is None else f"{end:.6g}" for end in (self.low, self.high))
        # what nothing free changes has none
        between = "" if low == high else f" ({low} to {high}, {100.0 * LEVEL:g} %)"
        return f"{self.value:.6g}{between} {self.unit}".rstrip()


@dataclass(frozen=True, eq=False)
class Fit:
    """A law fitted to a curve.

    `parameters` are the free ones, in the order of `covariance`, SI units, and `correlation`, a ratio, both (p, p);
    `held` the others that were given. `normalized_error` is "(20)", "(21)" over the points of the fit. `depth` is half
    of the greatest depth, m, and `force_at_depth` the force there in the approach: known well even where stiffness and
    exponent are not. `scene` holds the fitted law, `result` is its impact, `history` that on the clock of the `curve`
    it was fitted to.
    """

    law: str
    curve: ForceOverTime
    scene: Scene
    result: Result
    history: History
    parameters: Mapping[str, Estimate]
    held: Mapping[str, float]
    covariance: Array
    correlation: Array
    normalized_error: float
    depth: float
    force_at_depth: Estimate
    peak_held: bool
    points: int
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        table = html_table((self.law, "value, interval"), {**self.parameters, **self.held}.items())
        return f"{table}<p>normalized error {self.error_in_words}</p>{self.plot().svg}"

    def plot(self) -> Picture:
        """Force, N, over time, s, of the curve and of the law, as a notebook shows it or ``.write("fit.svg")``."""
        drawn = {"curve": self.curve, self.law: self.history}
        return curves({name: (one.time, one.force) for name, one in drawn.items()}, "time, s", "force, N")

    def summary(self) -> str:
        """Every parameter with its interval, one a line."""
        held = ", peak held" if self.peak_held else ""
        lines = [f"{self.law}: normalized error {self.error_in_words} on {self.points} points{held}"]
        lines += [f"{name:{WIDTH}s} {estimate}" for name, estimate in self.parameters.items()]
        lines += [f"{name:{WIDTH}s} {value:.6g} held" for name, value in self.held.items()]
        return "\n  ".join([*lines, f"force at half depth, {self.depth:.4g} m: {self.force_at_depth}"])

    @property
    def error_in_words(self) -> str:
        """The normalized error in per cent."""
        return f"{100.0 * self.normalized_error:.3g} %"

    @property
    def values(self) -> dict[str, float]:
        """Every parameter, free or held."""
        return {name: estimate.value for name, estimate in self.parameters.items()} | dict(self.held)

    def to_json(self) -> Table:
        """The content of fit.json."""
        content = {
            "schema": SCHEMA,
            "law": self.law,
            "converged": True,
            "level": LEVEL,
            "parameters": {name: asdict(estimate) for name, estimate in self.parameters.items()},
            "held": dict(self.held),
            "names": list(self.parameters),
            "covariance": self.covariance.tolist(),
            "correlation": self.correlation.tolist(),
            "normalized_error": self.normalized_error,
            "force_at_depth": {"depth": self.depth, **asdict(self.force_at_depth)},
            "peak_held": self.peak_held,
            "points": self.points,
            "warnings": list(self.warnings),
            "quantities": {name: asdict(quantity) for name, quantity in self.result.quantities.items()},
            "scene": self.scene.to_dict(),
        }
        return dict(plain(content))

    def write(self, directory: str | Path) -> None:
        """Make fit.json, fit.csv (the fitted history) and parameters.csv the content of a folder of results.

        Raises CannotWrite; what was there stays then, see :mod:`lumped.result.folder`.
        """
        publish(Path(directory), self.write_files, RECORD)

    def write_files(self, folder: Path) -> None:
        """The same files, one after the other, into a folder that is there."""
        write_json(folder / RECORD, self.to_json())
        self.history.write_csv(folder / "fit.csv")
        rows = [[name, *asdict(estimate).values()] for name, estimate in self.parameters.items()]
        rows += [[name, value, None, None, ""] for name, value in self.held.items()]
        write_csv(folder / "parameters.csv", ("parameter", "value", "low", "high", "unit"), rows)


def write_failure(directory: Path, law: str, message: str) -> None:
    """Write the fit.json of a search that did not converge; it takes the place of an older fit. Raises CannotWrite."""
    content = {"schema": SCHEMA, "law": law, "converged": False, "message": message, "parameters": None}
    publish(directory, lambda folder: write_json(folder / RECORD, content), RECORD)
