"""What was identified: parameters with their intervals, how they hang together, the noise, and whether the law fits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from lumped.numbers import Array
from lumped.result.noise import Whiteness
from lumped.schema import Table
from lumped.schema.csv_file import write_columns, write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA, RECORD = "fe-contact/identified/1", "identified.json"
LEVEL = 0.9  # of the intervals


@dataclass(frozen=True)
class Interval:
    """A value and the ends of its interval by profile likelihood at a `level`, a share; an end is None where open.

    Open is an end which the curves do not tell, or which lies beyond what is looked at. `unfound`: "low" or "high",
    where the search for that end did not converge; it is None too, and not open.
    """

    value: float
    low: float | None
    high: float | None
    level: float
    unit: str
    unfound: tuple[str, ...] = ()

    @property
    def share(self) -> float | None:
        """Half of the interval over the value; None where an end is open, or the value none."""
        if self.low is None or self.high is None or not self.value:
            return None
        return 0.5 * (self.high - self.low) / abs(self.value)

    @property
    def digits(self) -> int:
        """How many significant ones tell the ends from the value; three where one is open, or where they are wide."""
        return max(3, 2 - math.floor(math.log10(self.share))) if self.share else 3

    def holds(self, value: float) -> bool:
        """Whether a value lies within; an open end lets all through."""
        return (self.low is None or self.low <= value) and (self.high is None or value <= self.high)


def hull(every: Sequence[Interval]) -> Interval:
    """The value of the first with the ends of all."""
    lows, highs = [one.low for one in every], [one.high for one in every]
    low = None if None in lows else min(end for end in lows if end is not None)
    high = None if None in highs else max(end for end in highs if end is not None)
    unfound = tuple(dict.fromkeys(end for one in every for end in one.unfound))
    return replace(every[0], low=low, high=high, unfound=unfound)


@dataclass(frozen=True, eq=False)
class ToldValley:
    """What one valley of the likelihood says: its intervals, and the correlation, a ratio, (p, p), of the logarithms.

    `growth`: of the sum of squares over the noise, from the likeliest valley to this one.
    """

    parameters: Mapping[str, Interval]
    correlation: Array
    growth: float

    def holds(self, values: Mapping[str, float]) -> bool:
        """Whether all values lie within the intervals; an open end lets all through."""
        return all(one.holds(values[name]) for name, one in self.parameters.items())


@dataclass(frozen=True)
class Shift:
    """A parameter by the law alone and with the reference; its `bar`: how far the reference's own bars can move it."""

    by_law: float
    value: float
    bar: float


@dataclass(frozen=True)
class ByReference:
    """What a reference changed: parameters by their keys; the law's `error`, the largest difference over the peak.

    `runs`: histories that were asked of it; `others`: valleys as likely by the law alone, where nobody asked it.
    """

    parameters: Mapping[str, Shift]
    error: float
    runs: int
    others: int


@dataclass(frozen=True, eq=False)
class Posterior:
    """Draws of the posterior: `values` of the parameters in their order, SI, (n, p), `touches`, s, (n, curves).

    `logarithms` of the likelihood over its largest, (n,). `walkers` made them after `burned` steps each, a share
    `taken` of the moves; they tell as much as `effective` independent ones.
    """

    values: Array
    touches: Array
    logarithms: Array
    walkers: int
    burned: int
    taken: float
    effective: float

    def to_json(self, names: Sequence[str]) -> Table:
        """What the record says of it."""
        ends = np.quantile(self.values, [0.5, 0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL], axis=0).T.tolist()
        work = {"draws": len(self.values), "walkers": self.walkers, "burned": self.burned, "taken": self.taken}
        told = {
            name: dict(zip(("median", "low", "high"), row, strict=True)) for name, row in zip(names, ends, strict=True)
        }
        correlation = np.atleast_2d(np.corrcoef(self.values, rowvar=False)).tolist()
        return {**work, "effective": self.effective, "parameters": told, "correlation": correlation}


@dataclass(frozen=True, eq=False)
class FittedCurve:
    """One measured curve: times, s, forces, N, and the identified law's, (n,); its touch, s.

    `deviation` is that of the noise, N; `colour`: the coefficients of its recursion, (order,);
    `peak`: the highest force, N; `error`: of the law beyond the noise, over the peak. `band`: the law's force by the
    posterior, its ends at the level of the intervals, N, (2, n); empty where none was drawn.
    """

    name: str
    time: Array
    force: Array
    fitted: Array
    touch: float
    deviation: float
    colour: Array
    peak: float
    error: float
    band: Array

    @property
    def predicted(self) -> Array:
        """The band of another measurement, its noise included, N, (2, n)."""
        from scipy.special import ndtri

        noise = float(ndtri(0.5 + 0.5 * LEVEL)) * self.deviation
        away = np.hypot(self.band - self.fitted, noise)
        return np.asarray(self.fitted + np.array([[-1.0], [1.0]]) * away)

    @property
    def columns(self) -> dict[str, Array]:
        """Those of identified.csv, (n,) each."""
        found = {"time_s": self.time, "force_N": self.force, "fitted_N": self.fitted}
        if self.band.size:
            found |= dict(zip(("law_low_N", "law_high_N"), self.band, strict=True))
            found |= dict(zip(("predicted_low_N", "predicted_high_N"), self.predicted, strict=True))
        return found

    def noise_content(self) -> Table:
        """What the record says of the noise."""
        share = self.deviation / self.peak
        colour = "white" if not self.colour.size else self.colour.tolist()
        return {"curve": self.name, "deviation_N": self.deviation, "share_of_peak": share, "colour": colour}


@dataclass(frozen=True, eq=False)
class Identified:
    """What one or several curves say of a scene.

    `parameters` by dotted keys, SI units, their intervals over all `valleys`, of which the likeliest is the first;
    `table`: the scene file with the values found; `whiteness` tests what is left, and `warnings` say what it means.
    `widened`: the intervals are so many times as wide as those of noise alone. `posterior`: its draws, `by_reference`:
    what a reference changed, `each`: what every curve says alone, where these were asked for. `beyond`: keys that ran
    into an end of their search, beyond which the likeliest value lies: they are not found. `unneeded`: keys of which
    none is the likeliest value.
    """

    source: str
    parameters: Mapping[str, Interval]
    valleys: tuple[ToldValley, ...]
    curves: tuple[FittedCurve, ...]
    whiteness: Whiteness
    widened: float
    table: Table
    warnings: tuple[str, ...]
    posterior: Posterior | None = None
    by_reference: ByReference | None = None
    each: Mapping[str, Identified] = field(default_factory=dict)
    beyond: tuple[str, ...] = ()
    unneeded: tuple[str, ...] = ()

    @property
    def adequate(self) -> bool:
        """Whether what is left of the curves is noise."""
        return self.whiteness.noise

    @property
    def verdict(self) -> str:
        """What is left of the curves, in words, with the test that says so."""
        test = f"(Ljung-Box, p = {self.whiteness.probability:.2g})"
        if not self.whiteness.lags:
            return "nothing speaks against the law: too little is left of the curves, or too few rows, to be judged"
        if self.adequate:
            return f"what is left is noise {test}"
        if self.whiteness.of_the_law:
            return f"the law does not explain the curves {test}"
        return f"the noise is not of the colour it was taken for {test}"

    def to_json(self) -> Table:
        """The content of identified.json."""
        test = {"test": "Ljung-Box", **asdict(self.whiteness)}
        error = max(curve.error for curve in self.curves)
        alone = {name: {"parameters": one._parameters, "adequate": one.adequate} for name, one in self.each.items()}
        content = {
            "schema": SCHEMA,
            "scene": self.source,
            "law": "ting",
            "converged": not self.beyond,
            "parameters": self._parameters,
            "correlation": {"names": list(self.parameters), "matrix": self.valleys[0].correlation.tolist()},
            "unneeded": list(self.unneeded),
            "valleys": [asdict(one) | {"correlation": one.correlation.tolist()} for one in self.valleys],
            "model": {"adequate": self.adequate, "error": error, "widened": self.widened, **test},
            "onset_s": [curve.touch for curve in self.curves],
            "noise": [curve.noise_content() for curve in self.curves],
            "posterior": self.posterior and self.posterior.to_json(list(self.parameters)),
            "by_reference": self.by_reference and asdict(self.by_reference),
            "each": alone,
            "warnings": list(self.warnings),
        }
        return dict(plain(content))

    @property
    def _parameters(self) -> Table:
        return {name: asdict(one) for name, one in self.parameters.items()}

    def write_files(self, folder: Path) -> None:
        """identified.json, identified.csv, the curves with what is left of them, and sample.csv, the draws, into a
        folder that is there.
        """
        write_json(folder / RECORD, self.to_json())
        rows = [
            [curve.name, *row]
            for curve in self.curves
            for row in np.column_stack(list(curve.columns.values())).tolist()
        ]
        write_csv(folder / "identified.csv", ("curve", *self.curves[0].columns), rows)
        if self.posterior is not None:
            touches = [f"touch_{i}_s" for i in range(1, len(self.curves) + 1)]
            columns = [*self.posterior.values.T, *self.posterior.touches.T, self.posterior.logarithms]
            write_columns(folder / "sample.csv", (*self.parameters, *touches, "log_likelihood"), columns, 9)
