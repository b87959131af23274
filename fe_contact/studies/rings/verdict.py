"""The verdict on the paper's row for rings: how it errs over the depths tried, whatever the bars leave open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.studies.rings.study import HOLDS, SMALL_STRAIN, RingCurve


@dataclass(frozen=True)
class RingVerdict:
    """``word``: "holds", "holds at one depth", "wrong"; where the row crosses the curve, m; ``sentence``: why."""

    word: str
    crossing: float | None
    sentence: str


def verdict(curve: RingCurve) -> RingVerdict:
    """On the depths whose strain is small; a row within a per cent, or within the bar, holds there."""
    small = curve.strain <= SMALL_STRAIN
    factor, bar = curve.factor[small], curve.factor_error[small]
    if np.all(np.abs(factor - 1.0) <= HOLDS + bar):
        return RingVerdict("holds", None, _range(curve))
    crossing = _crossing(curve)
    if crossing is None:
        return RingVerdict("wrong", None, _range(curve))
    strain = crossing / curve.case.height
    return RingVerdict(
        "holds at one depth",
        crossing,
        f"at {1e3 * crossing:.3g} mm, {100 * strain:.2g} % of the height; {_range(curve)}",
    )


def _range(curve: RingCurve) -> str:
    """What the factor and the exponent are over all depths, and up to where strains are small."""
    factor, exponent = curve.factor, curve.exponent
    return (
        f"F over (pi/4) E* l depth from {factor[0]:.3g} to {factor[-1]:.3g}, "
        f"exponent {exponent.min():.3g} to {exponent.max():.3g} instead of 1; strains beyond "
        f"{100 * SMALL_STRAIN:g} % from {1e3 * SMALL_STRAIN * curve.case.height:.3g} mm on"
    )


def _crossing(curve: RingCurve) -> float | None:
    """Depth at which the factor passes one, m, on a straight line in logarithms."""
    x, y = np.log(curve.found.depth), np.log(curve.factor)
    passed = np.flatnonzero(y[:-1] * y[1:] <= 0.0)
    if not passed.size:
        return None
    i = int(passed[0])
    return float(np.exp(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i])))
