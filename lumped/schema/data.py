"""Where the packaged data lie: beside the installed suite, else in the checkout."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from lumped.errors import BadInput, Fault, nearest


def directory() -> Path:
    """The folder of the packaged data; raises BadInput when there is none."""
    candidates = [Path(__file__).resolve().parents[2] / "data"]
    spec = find_spec("fe_contact")
    if spec is not None:
        candidates = [Path(place) / "_data" for place in spec.submodule_search_locations or ()] + candidates
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    raise BadInput(Fault("data", "", "the packaged data are missing; install the suite again, or run in its checkout"))


def scene_names() -> tuple[str, ...]:
    """Names of the packaged scenes, sorted."""
    return tuple(sorted(path.stem for path in (directory() / "scenes").glob("*.toml")))


def scene_path(name: str) -> Path:
    """The file of a packaged scene; raises BadInput, with the nearest name, when there is none."""
    names = scene_names()
    if name not in names:
        known = f"neither a file nor a packaged scene; packaged: {', '.join(names)}{nearest(name, names)}"
        raise BadInput(Fault(name, "", known))
    return directory() / "scenes" / f"{name}.toml"
