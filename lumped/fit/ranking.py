"""All laws fitted to one curve and ranked: how near each comes, with how many parameters, and what it leaves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from lumped import laws
from lumped.errors import BadInput, Fault, NotReached
from lumped.fit.measured import Measured
from lumped.fit.record import LEVEL, Fit
from lumped.fit.search import search
from lumped.fit.space import TOUCH, default_free
from lumped.numbers import Array
from lumped.progress import Progress, silent
from lumped.result.noise import Whiteness, whiteness
from lumped.result.score import Curve
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.csv_file import write_columns, write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA, RECORD = "fe-contact/fits/1", "fits.json"
# Laws that are another one by a slower way.
ALIKE = {"mdr": "ting"}
ROUNDING = 1e-16  # of the square of the force: a law's own history leaves nothing
HEADER = ("rank", "law", "normalized_error", "criterion", "parameters", "noise_probability", "reason")


@dataclass(frozen=True, eq=False)
class RankedFit:
    """A law's fit; or, with None, the reason why there is none.

    `criterion`: Akaike's, corrected for few rows, less that of the best law; about 10 more is much worse, a ratio of
    logarithms. `whiteness`: whether what is left may be noise.
    """

    law: str
    fit: Fit | None = None
    criterion: float | None = None
    whiteness: Whiteness | None = None
    reason: str = ""

    def to_json(self) -> Table:
        """What the record says of it."""
        if self.fit is None or self.whiteness is None:
            return {"law": self.law, "reason": self.reason}
        return {
            "law": self.law,
            "normalized_error": self.fit.normalized_error,
            "criterion": self.criterion,
            "left": {"test": "Ljung-Box", "noise": self.whiteness.noise, **asdict(self.whiteness)},
            "parameters": {name: asdict(one) for name, one in self.fit.parameters.items()},
            "warnings": list(self.fit.warnings),
        }


def rank(
    curve: Curve,
    scene: Scene,
    fixed: Mapping[str, float] | None = None,
    touch: bool = False,
    progress: Progress = silent,
) -> tuple[RankedFit, ...]:
    """Every law's fit by its own default parameters, the best criterion first, those without a fit last.

    `fixed`: values held; `touch`: whether the first touch is sought too; `progress`: see :func:`lumped.fit`. Raises
    BadInput or NotReached, that of the first law, where none can be fitted.
    """
    held = dict(fixed or {})
    fitted, refused, failures = list[RankedFit](), list[RankedFit](), list[BadInput | NotReached]()
    for law in laws.available():
        try:
            if law in ALIKE:
                refused.append(RankedFit(law, reason=f"the same as {ALIKE[law]}, by a slower way"))
            else:
                free = (*default_free(law, scene, held), *((TOUCH,) if touch else ()))
                fitted.append(_ranked(curve, search(curve, law, scene, free, held, progress=progress)))
        except (BadInput, NotReached) as failure:
            failures.append(failure)
            refused.append(RankedFit(law, reason=_why(law, failure)))
    if not fitted:
        raise failures[0]
    least = min(one.criterion or 0.0 for one in fitted)
    ranked = [replace(one, criterion=(one.criterion or 0.0) - least) for one in fitted]
    return (*sorted(ranked, key=lambda one: one.criterion or 0.0), *refused)


def _why(law: str, failure: BadInput | NotReached) -> str:
    """Why a law has no fit, in a line without its name and the cure, for the others are already tried."""
    fault = failure.faults[0] if isinstance(failure, BadInput) else Fault("", "", str(failure).splitlines()[0])
    said = fault.message.partition("; accepted")[0].partition("; cure")[0]
    return said.removeprefix(f"{law} is ") if said.startswith(law) else f"{fault.key}: {said}".removeprefix(": ")


def _ranked(curve: Curve, fit: Fit) -> RankedFit:
    """n ln(S/n) + 2 p + 2 p (p + 1)/(n - p - 1), the noise's deviation among the p parameters; and what is left."""
    left = residuals(curve, fit)
    n, p = left.size, len(fit.parameters) + 1
    spread = max(float(left @ left) / n, ROUNDING * float(np.abs(curve.force).max()) ** 2)
    criterion = n * math.log(spread) + 2.0 * p + 2.0 * p * (p + 1) / max(n - p - 1, 1)
    return RankedFit(fit.law, fit, criterion, whiteness([left]))


def residuals(curve: Curve, fit: Fit) -> Array:
    """Measured less fitted force at the points of the fit, N, (n,)."""
    measured = Measured.of(curve)
    own = slice(0, measured.points)
    return measured.force[own] - fit.history.force_at(measured.time[own])


def write_ranking(ranked: Sequence[RankedFit], curve: Curve, where: Path) -> None:
    """fits.json, fits.csv with a line a law, and forces.csv with the fitted forces at the curve's own times."""
    content = {"schema": SCHEMA, "level": LEVEL, "laws": [one.to_json() for one in ranked]}
    write_json(where / RECORD, dict(plain(content)))
    write_csv(where / "fits.csv", HEADER, [_row(i, one) for i, one in enumerate(ranked, start=1)])
    fits = [one.fit for one in ranked if one.fit is not None]
    columns = [curve.time, curve.force, *(fit.history.force_at(curve.time) for fit in fits)]
    write_columns(where / "forces.csv", ("time_s", "force_N", *(f"{fit.law}_N" for fit in fits)), columns)


def _row(rank: int, one: RankedFit) -> list[object]:
    if one.fit is None or one.whiteness is None:
        return [None, one.law, None, None, None, None, one.reason]
    values = " ".join(f"{name}={estimate.value:.6g}" for name, estimate in one.fit.parameters.items())
    return [rank, one.law, one.fit.normalized_error, one.criterion, values, one.whiteness.probability, ""]
