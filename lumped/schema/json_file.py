"""JSON: files of Python's own types, null for what is not finite; dataclasses as plain data and back, every digit."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np

GIVEN = "given argument"  # no field and no key of ours is called so


def write_json(path: Path, content: Mapping[str, object]) -> None:
    """An indented file with a line's end; `content` is :func:`plain`. Raises ValueError for what is not finite."""
    text = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")


def plain(value: object) -> Any:  # as it was: a table of a mapping, a list of a sequence
    """Dictionaries, lists, texts and numbers of Python, None for a number that is not finite."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def encoded(value: object, given: Sequence[object] = ()) -> object:
    """Plain data for json.dumps, from which :func:`decoded` makes the value again; NaN and infinities stay.

    A dataclass becomes a dictionary of its fields; one that equals a `given` dataclass, its place among those; one that
    is a sequence, a list.
    """
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [encoded(item, given) for item in value]
    if is_dataclass(value):
        for place, one in enumerate(given):
            if type(one) is type(value) and one == value:
                return {GIVEN: place}
        return {one.name: encoded(getattr(value, one.name), given) for one in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): encoded(item, given) for key, item in value.items()}
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    return value


def decoded(kind: Any, content: Any, given: Sequence[object] = ()) -> Any:  # types have no type of their own
    """The value of an annotated `kind` which :func:`encoded` made into `content`.

    A kind is a dataclass or a named tuple, a number, a text, an array, a tuple, a mapping whose keys are texts or
    numbers, one of those or None, one of several plain ones, or object: plain data.
    """
    kind = getattr(kind, "__value__", kind)  # what an alias stands for, as NDArray is one from numpy 2.5 on
    origin, parts = get_origin(kind), get_args(kind)
    if isinstance(content, dict) and content.keys() == {GIVEN}:
        return given[content[GIVEN]]
    if NoneType in parts:
        others = [part for part in parts if part is not NoneType]
        return content if content is None or len(others) > 1 else decoded(others[0], content, given)
    if origin is np.ndarray:
        return np.array(content, dtype=float)
    if origin is Sequence:
        return tuple(decoded(parts[0], item, given) for item in content)
    if origin is tuple:
        kinds = parts[:1] * len(content) if parts[1:] == (...,) else parts
        return tuple(decoded(*pair, given) for pair in zip(kinds, content, strict=True))
    if isinstance(content, dict) and parts:
        name, item = parts
        return {name(key): decoded(item, one, given) for key, one in content.items()}
    if is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{name: decoded(hints[name], one, given) for name, one in content.items()})  # type: ignore[operator]  # a class
    if isinstance(kind, type) and issubclass(kind, tuple):
        return kind(*(decoded(*pair, given) for pair in zip(get_type_hints(kind).values(), content, strict=True)))
    return content
