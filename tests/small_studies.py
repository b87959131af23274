"""Every study that keeps its rows, made small, as a process of its own: `tests/test_journal.py` kills and resumes it.

    python tests/small_studies.py STUDY DIR [STUDY DIR ...]

Says "begun" when a command has begun. What is made small stands before `if __name__`, so that it is in the processes of
a study, too.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

from fe_contact.cli import main
from fe_contact.commands import base
from fe_contact.studies import rings
from fe_contact.studies.exponents import layers
from fe_contact.studies.exponents import study as exponents
from fe_contact.studies.stability.bars import DEFAULT
from fe_contact.studies.stability.base import studies
from fe_contact.studies.table1 import limits
from fe_contact.studies.table1 import study as table1
from fe_contact.studies.tradeoff import study as tradeoff
from fe_contact.studies.tradeoff.tried import ROW
from lumped.paper.table1 import ROWS

TWO_ROWS = {name: ROWS[name] for name in ("prism", "punch")}
PROFILES = tuple(one for one in layers.PROFILES if one.name in ("cone", "cylinder"))
CASES = [{**DEFAULT, "cfl": cfl, "elements": 20, "periods": 1} for cfl in (0.5, 1.0, 2.0, 3.0)]
ROWS_OF_SPRINGS = tuple((ROW, {"elements": count}) for count in (25, 50))
FEW_STEPS = ({"steps": 100}, {"steps": 200})
FEW_LAWS = (("hertz", {"tolerance": 1e-6}),)
COMMANDS = {
    "table1": ["table1"],
    "exponents": ["exponents", "--quick"],
    "ring": ["ring"],
    "tradeoff": ["tradeoff", "polymer-sphere", "--quick", "--tolerance", "1e-2"],
    "waves": ["tradeoff", "rod", "--quick"],
    "stability": ["stability", "--quick"],
}
CHARTS = {
    "table1.chart": "plot_table1",
    "exponents.chart": "plot_exponents",
    "rings_chart": "plot_rings",
    "tradeoff.chart": "plot_tradeoff",
    "stability._chart": "plot_stability",
}
SMALLER: dict[ModuleType, dict[str, Any]] = {
    table1: {"ROWS": TWO_ROWS, "RATIOS": (0.0, 0.45), "SHALLOW": table1.SHALLOW[::2], "DEEP": table1.DEEP[::8]}
    | {"power_law_impacts": lambda *_: None},
    limits: {"WIDTHS": limits.WIDTHS[::4]},
    layers: {"PROFILES": PROFILES, "FEW_POINTS": 6},
    exponents: {"SUPPORTS": ("free",), "SHARES": exponents.SHARES[::3]},
    rings: {"PACKAGED": ("rod-in-ring", "polymer-washer"), "STRAINS": rings.STRAINS[::4], "STRUCK_STRAINS": ()},
    tradeoff: {"TIGHTEST": 1e-5, "variations": lambda scene, *_: iter(FEW_STEPS if scene.model.inertia else ())}
    | {"asked_laws": lambda scene, _: FEW_LAWS if scene.model.inertia else ROWS_OF_SPRINGS},
}


def begun(*arguments: Any, folder: Callable[..., Path] = base.folder) -> Path:
    """What every command asks first: where its results go."""
    sys.stdout.write("begun\n")
    sys.stdout.flush()
    return folder(*arguments)


for name, study in studies().items():
    studies()[name] = replace(study, cases=lambda quick, own=name: CASES if own == "table" else [])
for module, changes in SMALLER.items():
    for key, value in changes.items():
        assert hasattr(module, key)
        setattr(module, key, value)

if __name__ == "__main__":
    for place, name in CHARTS.items():  # charts follow from the rows
        chart = sys.modules[f"fe_contact.studies.{place}"] = ModuleType(name)
        setattr(chart, name, lambda *_, **__: ())
    base.folder = begun
    asked = zip(sys.argv[1::2], sys.argv[2::2], strict=True)
    sys.exit(max([main([*COMMANDS[study], "--out", where, "--quiet"]) for study, where in asked]))
