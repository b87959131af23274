"""The table of schemes of Doyen, Ern and Piperno 2011, doi:10.1137/100791440: ten periods of the bouncing bar.

Exact and penalty enforcement on the usual mass; damped schemes; a surface without mass, implicit and explicit.
"""

from __future__ import annotations

from fe_contact.bodies.bar import TIP
from fe_contact.studies.stability._bar import measured
from fe_contact.studies.stability.base import Case, Chart, MethodStudy
from fe_contact.studies.stability.bouncing import CHART as MAP
from lumped.schema import Table

CHART = Chart(rows=("scheme", "mass", "tip", "enforcement"), columns=("cfl",), measures=MAP.measures)
JUDGED = ("drift", "ripple", "duration_steps", "start")
ROWS = (
    ("trapezoidal", 1.0, "consistent", 1.0, "exact"),
    ("trapezoidal", 1.0, "consistent", 1.0, "penalty"),
    ("hht", 0.8, "consistent", 1.0, "penalty"),
    ("generalised_alpha", 0.8, "consistent", 1.0, "penalty"),
    ("fully_implicit", 0.0, "consistent", 1.0, "exact"),
    ("central_difference", 1.0, "lumped", 1.0, "penalty"),
    ("central_difference", 1.0, "lumped", 1.0, "exact"),
    ("trapezoidal", 1.0, "redistributed", 1.0, "penalty"),
    ("trapezoidal", 1.0, "redistributed", 1.0, "exact"),
    ("generalised_alpha", 0.8, "redistributed", 1.0, "corrected"),
    ("central_difference", 1.0, "redistributed", 1.0, "penalty"),
    ("central_difference", 1.0, "redistributed", 1.0, "exact"),
    ("central_difference", 1.0, "redistributed", 0.5, "exact"),
    ("central_difference", 1.0, "spread", 1.0, "exact"),
    ("staged", 1.0, "lumped", 1.0, "penalty"),
    ("staged", 1.0, "redistributed", 1.0, "exact"),
    ("trapezoidal", 1.0, "redistributed", TIP, "exact"),
    ("staged", 1.0, "redistributed", TIP, "corrected"),
    ("staged", 1.0, "redistributed", TIP, "exact"),
)
KEYS = ("scheme", "rho", "mass", "tip", "enforcement")


def cases(quick: bool) -> list[Case]:
    """Quick: a scheme of every kind, the default among them, in steps in which a wave crosses an element."""
    rows, steps = (ROWS[:: len(ROWS) // 3], (1.0,)) if quick else (ROWS, (1.0, 2.0))
    fixed = {"penalty": 1.0, "elements": 100, "periods": 10}
    return [{**dict(zip(KEYS, row, strict=True)), **fixed, "cfl": cfl} for row in rows for cfl in steps]


def measure(case: Case) -> Table:
    """Errors against the exact motion, and whether all limits are kept."""
    found = measured(case)
    kept = all(abs(found[name]) <= CHART.measures[name].limit for name in JUDGED)
    return found | {"all_kept": kept}


MEMBER = MethodStudy("Bouncing bar, ten periods: the schemes of the paper cited", cases, measure, CHART)
