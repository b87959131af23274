"""The table of schemes of Doyen, Ern and Piperno 2011, doi:10.1137/100791440: ten periods of the bouncing bar.

Exact and penalty enforcement on the usual mass; damped schemes; a surface without mass, implicit and explicit.
"""

from __future__ import annotations

from typing import Any

from fe_contact.validation.stability._bar import measured
from fe_contact.validation.stability.base import Case, Chart
from fe_contact.validation.stability.bouncing import CHART as MAP

TITLE = "Bouncing bar, ten periods: the schemes of the paper cited"
CHART = Chart(rows=("scheme", "mass", "enforcement"), columns=("cfl",), measures=MAP.measures)
ROWS = (
    ("trapezoidal", 1.0, "consistent", "exact"),
    ("trapezoidal", 1.0, "consistent", "penalty"),
    ("hht", 0.8, "consistent", "penalty"),
    ("generalised_alpha", 0.8, "consistent", "penalty"),
    ("fully_implicit", 0.0, "consistent", "exact"),
    ("central_difference", 1.0, "lumped", "penalty"),
    ("central_difference", 1.0, "lumped", "exact"),
    ("trapezoidal", 1.0, "redistributed", "penalty"),
    ("trapezoidal", 1.0, "redistributed", "exact"),
    ("generalised_alpha", 0.8, "redistributed", "corrected"),
    ("central_difference", 1.0, "redistributed", "penalty"),
    ("central_difference", 1.0, "redistributed", "exact"),
    ("central_difference", 1.0, "spread", "exact"),
)


def cases(quick: bool) -> list[Case]:
    """Quick: fewer elements, only the step in which a wave crosses one of them."""
    every = [(row, cfl) for row in ROWS for cfl in ((1.0,) if quick else (1.0, 2.0))]
    return [_case(*row, cfl, 40 if quick else 100) for row, cfl in every]


def _case(scheme: str, rho: float, mass: str, enforcement: str, cfl: float, elements: int) -> dict[str, Any]:
    return {
        "scheme": scheme,
        "rho": rho,
        "mass": mass,
        "enforcement": enforcement,
        "penalty": 1.0,
        "cfl": cfl,
        "elements": elements,
        "periods": 10,
    }


def measure(case: Case) -> dict[str, Any]:
    """Errors against the exact motion, and whether all limits are kept."""
    found = measured(case)
    kept = all(abs(found[name]) <= limit.limit for name, limit in CHART.measures.items() if name in JUDGED)
    return found | {"all_kept": kept}


JUDGED = ("drift", "ripple", "duration_steps", "start")
