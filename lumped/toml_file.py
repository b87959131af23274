"""Reading a TOML file, and setting single keys of it, with named faults."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lumped.errors import BadInput, Fault

MOST_BYTES = 1_000_000


def parsed(path: Path) -> dict[str, Any]:
    """The raw tables of a TOML file; raises BadInput when it cannot be read or is no TOML."""
    try:
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
        if len(content) > MOST_BYTES:
            raise BadInput(Fault(str(path), "", f"larger than {MOST_BYTES} bytes: no scene file"))
        return tomllib.loads(content.decode("utf-8"))
    except OSError as error:
        raise BadInput(Fault(str(path), "", f"cannot be read: {error.strerror or error}")) from error
    except UnicodeDecodeError as error:
        raise BadInput(Fault(str(path), "", "cannot be read: not a text in UTF-8")) from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise BadInput(Fault(str(path), "", f"not a TOML file: {error}")) from error


def parse_assignment(text: str) -> tuple[str, object]:
    """`striker.radius=0.01` -> ("striker.radius", 0.01); a value that is no TOML is taken as a text.

    Raises BadInput when there is no `=` or no key.
    """
    key, sign, value = (part.strip() for part in text.partition("="))
    if not sign or not all(part.strip() for part in key.split(".")):
        raise BadInput(Fault("--set", text, "accepted: key=value with a dotted key, as striker.radius=0.01"))
    try:
        table = tomllib.loads(f"value = {value}")
    except tomllib.TOMLDecodeError:
        return key, value
    return key, table["value"]


def overridden(table: Mapping[str, Any], overrides: Mapping[str, object], source: str) -> dict[str, Any]:
    """A copy of the tables with the dotted keys of `overrides` set. Raises BadInput."""
    result = dict(table)
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
