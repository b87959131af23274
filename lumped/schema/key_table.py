"""A table is checked against a mapping of keys: its accepted values, and every fault at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

from lumped.errors import SHOWN_FAULTS, BadInput, Fault, nearest, shown
from lumped.schema.keys import Key


def read_table(
    source: str, path: str, table: Mapping[str, object], keys: Mapping[str, Key]
) -> tuple[dict[str, Any], list[Fault]]:
    """Check a table against its keys: the accepted values, and every fault (unknown, missing, refused)."""
    values: dict[str, Any] = {}
    strange = islice((name for name in table if name not in keys), SHOWN_FAULTS)
    faults = [Fault(source, _join(path, name), unknown_key(name, keys)) for name in strange]
    for name, key in keys.items():
        if name not in table:
            if key.required:
                faults.append(Fault(source, _join(path, name), f"missing; accepted: {key.accepted}"))
            continue
        try:
            values[name] = key.read(table[name])
        except ValueError as error:
            faults.append(Fault(source, _join(path, name), str(error) or _refused(key, table[name])))
    return values, faults


def placed(values: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The same values, files from this folder on."""
    return {name: folder / value if isinstance(value, Path) else value for name, value in values.items()}


def optional(keys: Mapping[str, Any]) -> dict[str, Any]:
    """The same keys, none of them required."""
    return {name: replace(key, required=False) for name, key in keys.items()}


def check_fields(owner: str, record: object, keys: Mapping[str, Key]) -> None:
    """Check the attributes of a record built in Python; raises BadInput naming every one that is refused."""
    present = {name: getattr(record, name) for name in keys if getattr(record, name) is not None}
    _, faults = read_table(owner, "", present, keys)
    if faults:
        raise BadInput(faults)


def unknown_key(name: str, names: Iterable[str]) -> str:
    """What to say of a key which is none of `names`."""
    names = sorted(names)
    return f"unknown key; accepted: {', '.join(names)}{nearest(name, names)}"


def _join(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _refused(key: Key, value: object) -> str:
    return f"{shown(value)} is not accepted; accepted: {key.accepted}"
