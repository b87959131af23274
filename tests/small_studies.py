"""Every study that keeps its rows, made small, as a process of its own: `tests/test_journal.py` kills and resumes it.

    python tests/small_studies.py STUDY DIR [STUDY DIR ...]

Says "begun" when a command has begun. What is made small stands before `if __name__`, so that it is in the processes of
a study, too.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from fe_contact.cli import main
from fe_contact.commands import base
from fe_contact.studies.exponents import check as exponents_check
from fe_contact.studies.exponents import finite_spheres
from fe_contact.studies.exponents import study as exponents
from fe_contact.studies.rings import impact as rings_impact
from fe_contact.studies.rings import study as rings
from fe_contact.studies.stability._bar import DEFAULT
from fe_contact.studies.stability.base import STUDIES
from fe_contact.studies.table1 import blocks
from fe_contact.studies.table1 import study as table1
from fe_contact.studies.tradeoff import study as tradeoff
from fe_contact.studies.tradeoff import study_with_waves as tradeoff_waves
from fe_contact.studies.tradeoff.targets import _rod
from lumped.paper.table1 import ROWS

TWO_ROWS = {name: ROWS[name] for name in ("prism", "punch")}
PROFILES = tuple(one for one in exponents.PROFILES if one.name in ("cone", "cylinder"))
CASES = [{**DEFAULT, "cfl": cfl, "elements": 20, "periods": 1} for cfl in (0.5, 1.0, 2.0, 3.0)]
COMMANDS = {
    "table1": ["table1"],
    "exponents": ["exponents", "--quick"],
    "ring": ["ring"],
    "tradeoff": ["tradeoff", "polymer-sphere", "--quick", "--tolerance", "1e-2"],
    "waves": ["tradeoff", "rod", "--quick"],
    "stability": ["stability", "--quick"],
}
SMALLER: dict[ModuleType, dict[str, Any]] = {
    table1: {"ROWS": TWO_ROWS, "RATIOS": (0.0, 0.45), "SHALLOW": table1.SHALLOW[::2], "DEEP": table1.DEEP[::8]}
    | {"power_law_impacts": lambda *_: None},
    blocks: {"WIDTHS": blocks.WIDTHS[::4]},
    exponents: {"PROFILES": PROFILES, "FEW_POINTS": 6},
    exponents_check: {"PROFILES": PROFILES},
    finite_spheres: {"SUPPORTS": ("free",), "SHARES": finite_spheres.SHARES[::3]},
    rings: {"PACKAGED": ("rod-in-ring", "polymer-washer"), "STRAINS": rings.STRAINS[::4]},
    rings_impact: {"STRAINS": ()},
    tradeoff: {"variations": lambda *_: (), "_laws": lambda *_: {}, "EXACT_TOLERANCE": 1e-5, "ROW_ELEMENTS": (25, 50)},
    tradeoff_waves: {"LAWS": ("hertz",)},
    _rod: {"ROD": replace(_rod.ROD, variations=lambda base, quick: iter([{"steps": 100}, {"steps": 200}]))},
}


def begun(*arguments: Any, folder: Callable[..., Path] = base.folder) -> Path:
    """What every command asks first: where its results go."""
    sys.stdout.write("begun\n")
    sys.stdout.flush()
    return folder(*arguments)


for study, member in STUDIES.members.items():
    fewer = replace(member, cases=lambda quick, own=study: CASES if own == "table" else [])
    SMALLER[import_module(f"{STUDIES.package}.{study}")] = {"MEMBER": fewer}
for module, changes in SMALLER.items():
    for key, value in changes.items():
        assert hasattr(module, key)
        setattr(module, key, value)

if __name__ == "__main__":
    for name in ("table1", "exponents", "rings", "tradeoff", "stability"):  # charts follow from the rows
        chart = sys.modules[f"fe_contact.studies.{name}.chart"] = ModuleType(name)
        setattr(chart, f"plot_{name}", lambda *_: ())
    base.folder = begun
    asked = zip(sys.argv[1::2], sys.argv[2::2], strict=True)
    sys.exit(max([main([*COMMANDS[study], "--out", where, "--quiet"]) for study, where in asked]))
