"""What the suite answers, written down: values, histories and counted work of every packaged scene. A script.

    python tests/record.py FOLDER [--tolerance 1e-2 ...] [--only PATTERN]    write it
    python tests/record.py FOLDER --against OTHER                            compare two of them

Before and after code is moved the two records are the same to the last digit; where an algorithm has changed, values
lie within the sum of both bars, and the comparison says how far apart they are, and whose bar has grown.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import fe_contact
from fe_contact.assembly.disk_cache import without_disk
from lumped import FeContactError, Scene

SCENES = Path(__file__).resolve().parent.parent / "data" / "scenes"
TOLERANCES = (1e-2, 1e-3)


def answer(name: str, tolerance: float) -> dict[str, Any]:
    """The result of a packaged scene without its times, its history as lists; or why there is none."""
    try:
        with without_disk():
            found = fe_contact.run(Scene.load(name), tolerance)
    except FeContactError as failure:
        return {"failure": str(failure)}
    values = {key: [one.value, one.error] for key, one in found.quantities.items()}
    columns = {"time": found.history.time, "force": found.history.force, "depth": found.history.depth}
    return {
        "converged": found.converged,
        "quantities": values,
        "work": found.work,
        "energy": found.energy,
        "history": {key: column.tolist() for key, column in columns.items()},
    }


def differences(before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    """What has changed of one answer: by how many of both bars, and by how much a bar grew."""
    if before == after:
        return
    for name, (value, error) in before.get("quantities", {}).items():
        other, bar = after.get("quantities", {}).get(name, (None, None))
        if (value, error) == (other, bar):
            continue
        if None in (value, error, other, bar):
            yield f"{name}: {value} +- {error}, now {other} +- {bar}"
        else:
            bars = abs(value - other) / (error + bar) if error + bar else math.inf
            wider = bar / error if error else math.inf
            yield f"{name}: {bars:.2g} of both bars apart, the bar {wider:.2g} times as wide"
    for part in ("failure", "converged", "work", "energy", "history"):
        if before.get(part) != after.get(part):
            yield f"{part} differs"


def compare(ours: Path, theirs: Path) -> bool:
    """Whether nothing differs; a line for every answer that does."""
    alike = True
    for path in sorted(ours.glob("*.json")):
        other = theirs / path.name
        before, after = (json.loads(one.read_text(encoding="utf-8")) if one.exists() else {} for one in (other, path))
        for line in differences(before, after):
            alike = False
            sys.stdout.write(f"{path.stem}: {line}\n")
    return alike


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--tolerance", type=float, nargs="+", default=TOLERANCES)
    parser.add_argument("--only", default="*", help="pattern of scenes")
    parser.add_argument("--against", type=Path, help="a record to compare with, instead of writing one")
    given = parser.parse_args()
    if given.against:
        return 0 if compare(given.folder, given.against) else 1
    given.folder.mkdir(parents=True, exist_ok=True)
    for name in sorted(path.stem for path in SCENES.glob("*.toml")):
        if fnmatch(name, given.only):
            for tolerance in given.tolerance:
                text = json.dumps(answer(name, tolerance), indent=1)
                (given.folder / f"{name}-{tolerance:g}.json").write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
