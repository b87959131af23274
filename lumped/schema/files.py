"""Files by their names: a user's, no device, no pipe, nothing without end; the packaged ones, and where they lie.

Those in TOML are read here, and single keys of them set, with named faults.
"""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from lumped.errors import BadInput, Fault, nearest, shown
from lumped.schema import Table

# A pipe that nobody writes into opens at once, and the kernel's own files do not wait for something to say.
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
# No scene needs as much; what tomllib takes for a key of n parts or n brackets grows by n^2 or ends its recursion.
MOST_BYTES, MOST_DEPTH = 100_000, 16
TEXT_OR_COMMENT = re.compile(
    r""""{3}(?:[^\\]|\\.)*?(?:"{3,5}|\Z)|'{3}.*?(?:'{3,5}|\Z)|"(?:[^"\\\n]|\\.)*"?|'[^'\n]*'?|\#[^\n]*""", re.DOTALL
)
DEEP_KEY = re.compile(rf"(?<![\w-])(?:[\w-]+[ \t]*\.[ \t]*){{{MOST_DEPTH}}}")
TOO_DEEP = f"nested too deep; accepted: dotted keys, tables and lists up to {MOST_DEPTH} deep"
LINE = re.compile(r"at line (\d+)")


def content(path: Path, most: int, kind: str) -> bytes:
    """The bytes of a regular file of at most `most` of them; `kind` says what it should be. Raises BadInput."""
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | AT_ONCE), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise BadInput(Fault(str(path), "", f"no regular file; accepted: {kind}"))
            found = file.read(most + 1) or b""
    except (OSError, ValueError) as error:  # a name with a null byte is no value for open
        reason = error.strerror if isinstance(error, OSError) else "its name cannot be one"
        hint = nearest(path.stem, _beside(path, path.suffix)) if isinstance(error, FileNotFoundError) else ""
        raise BadInput(Fault(str(path), "", f"cannot be read: {reason or error}{hint}; accepted: {kind}")) from error
    if len(found) > most:
        raise BadInput(Fault(str(path), "", f"larger than {most} bytes; accepted: {kind}"))
    return found


def _beside(path: Path, ending: str) -> Mapping[str, str]:
    """By their stems the files of an ending in the folder of a path; none where that is no folder, or cannot be one."""
    with suppress(OSError, ValueError):
        return {one.stem: str(one) for one in sorted(path.parent.iterdir()) if one.suffix == ending}
    return {}


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
        if name not in self.names:
            hint = nearest(name, self._near(Path(name)))
            said = f"no such file, nor a packaged {self.kind}{hint}"
            raise BadInput(Fault(name, "", said if hint else f"{said}; packaged: {', '.join(self.names)}"))
        return data_folder() / self.folder / f"{name}.toml"

    def resolved(self, source: str | Path) -> Path:
        """The file that a path or one of the names stands for. Raises BadInput, with the nearest name, for neither.

        A folder of one of the names, as of its results, hides no packaged file.
        """
        path = Path(source)
        hidden = exists(path) and not (path.is_dir() and str(source) in self.names)
        if not hidden and self.is_name(str(source)):
            return self.path(str(source))
        if not hidden:
            reason = f"cannot be read: no such file{nearest(path.stem, self._near(path))}"
            accepted = f"accepted: a TOML file, or the name of a packaged {self.kind}"
            raise BadInput(Fault(str(source), "", f"{reason}; {accepted}"))
        return path

    @staticmethod
    def is_name(text: str) -> bool:
        """Whether a text looks like a packaged name, and not like a path."""
        path = Path(text)
        return path.suffix != ".toml" and path.name == text

    def _near(self, path: Path) -> Mapping[str, str]:
        """What may be meant by a path that is none: the packaged names, and by their stems the TOML files beside it."""
        return {**dict(zip(self.names, self.names, strict=True)), **_beside(path, ".toml")}


SCENES = Packaged("scenes", "scene")
DECIMAL_COMMA = re.compile(r"=\s*[+-]?\d+,\d+\s*(#.*)?$")


def parsed(path: Path) -> Table:
    """The raw tables of a TOML file; raises BadInput when it cannot be read or is no TOML."""
    source, kind = str(path), f"a TOML file of at most {MOST_BYTES} bytes"
    try:
        text = content(path, MOST_BYTES, kind).decode("utf-8-sig")  # editors on Windows put a mark before it
    except UnicodeDecodeError as error:
        raise BadInput(Fault(source, "", f"cannot be read: not a text in UTF-8; accepted: {kind}, in UTF-8")) from error
    try:
        return _tables(text)
    except ValueError as error:
        raise BadInput(Fault(source, "", f"not a TOML file: {error}{_line_of(error, text)}")) from error


def parse_assignment(text: str) -> tuple[str, object]:
    """`striker.radius=0.01` -> ("striker.radius", 0.01); a value that is no TOML is taken as a text.

    Raises BadInput when there is no `=` or no key.
    """
    key, sign, value = (part.strip() for part in text.partition("="))
    parts = key.split(".")
    if not sign or not all(part.strip() for part in parts):
        raise BadInput(Fault("--set", text, "accepted: key=value with a dotted key, as striker.radius=0.01"))
    if len(parts) > MOST_DEPTH:
        raise BadInput(Fault("--set", key, TOO_DEEP))
    try:
        table = _tables(f"value = {value}")
    except tomllib.TOMLDecodeError:
        return key, value
    except ValueError as error:
        raise BadInput(Fault("--set", key, str(error))) from error
    return key, table["value"] if len(table) == 1 else value


def overridden(table: Mapping[str, object], overrides: Mapping[str, object], source: str) -> Table:
    """A copy of the tables with the dotted keys of `overrides` set. Raises BadInput."""
    result: Table = dict(table)
    for dotted, value in overrides.items():
        *path, last = dotted.split(".")
        place = result
        for part in path:
            inner = place.get(part, {})
            if not isinstance(inner, Mapping):
                raise BadInput(Fault(source, dotted, f"{part} is a value, not a table"))
            place[part] = dict(inner)
            place = place[part]
        place[last] = value
    return result


def toml_text(table: Mapping[str, object], path: str = "") -> str:
    """Tables of numbers, texts and lists of them as a TOML file."""
    inner = {name: value for name, value in table.items() if isinstance(value, Mapping)}
    own = [f"{name} = {_toml_value(value)}" for name, value in table.items() if name not in inner]
    head = [f"[{path}]"] if path and own else []
    below = [toml_text(value, f"{path}.{name}".lstrip(".")) for name, value in inner.items()]
    return "\n".join(filter(None, ["\n".join([*head, *own, ""]) if own else "", *below]))


def _toml_value(value: object) -> str:
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml_value, value))}]"
    return json.dumps(value)  # whose texts, numbers and truth values are TOML's too


def _tables(text: str) -> Table:
    """What a text in TOML says; raises ValueError, a TOMLDecodeError where it is none, also of one too deep to read."""
    bare = TEXT_OR_COMMENT.sub(lambda found: "" if found[0].startswith("#") else "text", text)
    if DEEP_KEY.search(bare) or _brackets(bare) > MOST_DEPTH:
        raise ValueError(TOO_DEEP)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except ValueError as error:  # Python reads no number of more than 4300 digits
        raise ValueError("a number has thousands of digits; accepted: up to 1e300") from error


def _brackets(text: str) -> int:
    """How deep the brackets of a text are nested at most."""
    depth = deepest = 0
    for bracket in re.findall(r"[\[\]{}]", text):
        depth = depth + 1 if bracket in "[{" else max(depth - 1, 0)
        deepest = max(deepest, depth)
    return deepest


def _line_of(error: ValueError, text: str) -> str:
    """The line that an error names, so that it names the key too; empty where it names none."""
    number, lines = LINE.search(str(error)), text.splitlines()
    at = int(number[1]) if number else 0
    if not 1 <= at <= len(lines):
        return ""
    cure = "; cure: a decimal point" if DECIMAL_COMMA.search(lines[at - 1]) else ""
    return f": {shown(lines[at - 1].strip())}{cure}"
