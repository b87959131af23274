"""How large the house is, and which files only one other takes something from. A script, not a test.

    python tests/house.py

What is a rule stands in tests/test_floors.py, whose walk over the imports this counts with: order of the rooms, no
circles, the size of the roots, one name for one class, typed joints, constants with a word.
"""

from __future__ import annotations

import runpy
import sys
from collections import Counter, defaultdict
from pathlib import Path

FLOORS = runpy.run_path(str(Path(__file__).with_name("test_floors.py")))
PACKAGES, ROOT = FLOORS["PACKAGES"], FLOORS["ROOT"]
# Fronts and contracts; a chart stands alone since it is loaded where one is drawn, with matplotlib.
APART = ("base.py", "__init__.py", "__main__.py", "cli.py", "chart.py", "_chart.py")


def member_folders() -> set[str]:
    """Folders with a contract for what stands in them, and the meshes, one a target."""
    return {"meshes"} | {FLOORS["name"](path.parent) for path in FLOORS["sources"](*PACKAGES) if path.name == "base.py"}


def importers() -> dict[str, set[str]]:
    """By file, the files that take something from it."""
    found = defaultdict[str, set[str]](set)
    for path in FLOORS["sources"](*PACKAGES):
        for file in FLOORS["imported_files"](path):
            found[file].add(FLOORS["name"](path))
    return found


def alone() -> list[str]:
    """Files that one other imports, that are no member of a folder and no front of a package."""
    members, found = member_folders(), []
    for file, above in importers().items():
        folder, _, name = file.rpartition("/")
        fronts = {one for one in above if not one.endswith("__init__.py")}
        if len(fronts) == 1 and not name.endswith(APART) and folder not in members:
            found.append(f"{file} <- {fronts.pop()}")
    return sorted(found)


def main() -> int:
    """Print the counts."""
    files = FLOORS["sources"](*PACKAGES)
    lines = Counter(dict.fromkeys(PACKAGES, 0))
    for path in files:
        lines[path.relative_to(ROOT).parts[0]] += len(path.read_text(encoding="utf-8").splitlines())
    single = alone()
    roots = {package: len(list((ROOT / package).glob("*.py"))) for package in PACKAGES}
    sys.stdout.write(f"lines: {lines.total()} ({dict(lines)})\nfiles: {len(files)}, at the roots {roots}\n")
    sys.stdout.write(f"files with one importer that are no member: {len(single)}\n")
    sys.stdout.writelines(f"  {line}\n" for line in single)
    return 0


if __name__ == "__main__":
    sys.exit(main())
