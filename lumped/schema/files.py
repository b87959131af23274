"""Files by their names: a user's, no device, no pipe, nothing without end; the packaged ones, and where they lie."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from lumped.errors import BadInput, Fault, nearest

# A pipe that nobody writes into opens at once, and the kernel's own files do not wait for something to say.
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def content(path: Path, most: int, kind: str) -> bytes:
    """The bytes of a regular file of at most `most` of them; `kind` says what it should be. Raises BadInput."""
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | AT_ONCE), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise BadInput(Fault(str(path), "", f"no regular file; accepted: {kind}"))
            found = file.read(most + 1) or b""
    except (OSError, ValueError) as error:  # a name with a null byte is no value for open
        reason = error.strerror if isinstance(error, OSError) else "its name cannot be one"
        raise BadInput(Fault(str(path), "", f"cannot be read: {reason or error}; accepted: {kind}")) from error
    if len(found) > most:
        raise BadInput(Fault(str(path), "", f"larger than {most} bytes; accepted: {kind}"))
    return found


def exists(path: Path) -> bool:
    """Whether there is something at this path; nothing is where no name like this can be."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def data_folder() -> Path:
    """The folder of the packaged data; raises BadInput when there is none."""
    candidates = [Path(__file__).resolve().parents[2] / "data"]
    spec = find_spec("fe_contact")
    if spec is not None:
        candidates = [Path(place) / "_data" for place in spec.submodule_search_locations or ()] + candidates
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    raise BadInput(Fault("data", "", "the packaged data are missing; install the suite again, or run in its checkout"))


@dataclass(frozen=True)
class Packaged:
    """The packaged TOML files in one `folder` of the data, each a `kind` of input that is asked for by its name."""

    folder: str
    kind: str

    @property
    def names(self) -> tuple[str, ...]:
        """Their names, sorted."""
        return tuple(sorted(path.stem for path in (data_folder() / self.folder).glob("*.toml")))

    def path(self, name: str) -> Path:
        """The file of a name; raises BadInput, with the nearest name, when there is none."""
        names = self.names
        if name not in names:
            known = f"neither a file nor a packaged {self.kind}; packaged: {', '.join(names)}{nearest(name, names)}"
            raise BadInput(Fault(name, "", known))
        return data_folder() / self.folder / f"{name}.toml"

    def resolved(self, source: str | Path) -> Path:
        """The file that a path or one of the names stands for. Raises BadInput for an unknown name."""
        path = Path(source)
        if not exists(path) and path.suffix != ".toml" and path.name == str(source):
            return self.path(str(source))
        return path


SCENES = Packaged("scenes", "scene")
