"""Unit operators on disk, in the user's cache folder: a geometry that is known is neither meshed nor condensed again.

One file an answer, named by a SHA-256 of all that decides it: the function and its arguments, the source that computes
it, the versions of the libraries, and the kernels that BLAS has chosen for this processor. So numbers with and without
are the same to the bit, and nothing old is ever taken for new.

A file is an npz of plain arrays, which numpy reads without pickles. It ends, as the comment of its zip, in the SHA-256
of what stands before; a file that does not is no answer, and is written anew. Files take their names all at once, so
that processes may share the folder and may be killed. Whatever the disk refuses, an answer is computed as ever.

``FE_CONTACT_CACHE``: another folder, or ``off``; ``FE_CONTACT_CACHE_MB``: what the folder may hold, 512 unless told;
the files not used for longest go first.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import sys
import tempfile
import zipfile
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import fields, is_dataclass
from functools import cache, update_wrapper
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar, get_type_hints

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.cache import Recipe
from fe_contact.threads import blas
from lumped.errors import BadInput, Fault, shown

FORMAT = 1  # of the files: counted up whenever what is in them means something else
MEGABYTES = 512  # work: what the folder may hold, some thousand bodies
SEAL = 64  # characters of a SHA-256: the name of a file, and its end
PLACE, BOUND, OFF = "FE_CONTACT_CACHE", "FE_CONTACT_CACHE_MB", "off"
ROOMS = ("meshes", "fe_contact/assembly", "fe_contact/bodies", "fe_contact/targets")  # whose source decides answers

_Arguments = ParamSpec("_Arguments")
_Answer = TypeVar("_Answer")
Arrays = dict[str, npt.NDArray[np.generic]]


class on_disk(Generic[_Arguments, _Answer]):  # noqa: N801 - a decorator, written like functools.cache
    """A function that answers from disk what it has ever been asked.

    Its arguments are numbers, text, tuples and recipes; its answer is a frozen dataclass whose fields are contiguous
    arrays, numbers, None, or the like dataclasses.
    """

    def __init__(self, make: Callable[_Arguments, _Answer]) -> None:
        update_wrapper(self, make)
        self._make = make

    def __call__(self, *arguments: _Arguments.args, **named: _Arguments.kwargs) -> _Answer:
        """The answer at hand, or a new one. Raises BadInput for a bound that is no number."""
        where = folder()
        if where is None:
            return self._make(*arguments, **named)
        path = where / f"{_key(Recipe(self._make, (*arguments, *named.items())))}.npz"
        known = _read(path)
        if known is not None:
            kind: type[_Answer] = get_type_hints(self._make)["return"]
            return _rebuilt(kind, known)
        answer = self._make(*arguments, **named)
        _write(path, _arrays(answer))
        return answer


def folder() -> Path | None:
    """Where answers are kept, whether it is there yet or not; None: nowhere."""
    chosen = os.environ.get(PLACE, "")
    if chosen:
        return None if chosen == OFF else Path(chosen)
    try:
        return _users_caches() / "fe-contact"
    except RuntimeError:  # a user without a home
        return None


def _users_caches() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", "") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    named = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return named if named.is_absolute() else Path.home() / ".cache"  # as the XDG specification has it


@contextmanager
def without_disk() -> Iterator[None]:
    """Within, this process and those it starts neither read nor write answers on disk."""
    before = os.environ.get(PLACE)
    os.environ[PLACE] = OFF
    try:
        yield
    finally:
        if before is None:
            del os.environ[PLACE]
        else:
            os.environ[PLACE] = before


def most_bytes() -> float:
    """What the folder may hold. Raises BadInput."""
    said = os.environ.get(BOUND, "") or str(MEGABYTES)
    with suppress(ValueError):
        if float(said) >= 0.0:
            return float(said) * 2**20
    raise BadInput(Fault(BOUND, "", f"{shown(said)}: accepted a number of megabytes, 0 or more"))


def entries(where: Path) -> list[tuple[float, int, Path]]:
    """Files of answers, whole or begun: when they were used last, their bytes, their names; the oldest first."""
    found = []
    for path in where.glob("[0-9a-f]" * SEAL + ".npz*"):
        with suppress(OSError):  # another process was faster
            known = path.stat()
            found.append((known.st_mtime, known.st_size, path))
    return sorted(found)


def clear(where: Path, most: float = 0.0) -> None:
    """Remove the files not used for longest until the rest takes no more than ``most`` bytes."""
    files = entries(where)
    taken = sum(size for _, size, _ in files)
    for _, size, path in files:
        if taken <= most:
            return
        with suppress(OSError):  # another process was faster, or still reads it where that is a lock
            path.unlink()
        taken -= size


def _key(question: Recipe[_Answer]) -> str:
    """SHA-256 of a question and of all else that decides the answer."""
    return hashlib.sha256(json.dumps([_in_json(question), _maker(), blas()]).encode()).hexdigest()


def _in_json(argument: Hashable) -> object:
    """An argument in JSON: floats by all their digits, a recipe by its function's name."""
    if isinstance(argument, Recipe):
        return [f"{argument.make.__module__}.{argument.make.__qualname__}", *map(_in_json, argument.arguments)]
    return [_in_json(part) for part in argument] if isinstance(argument, tuple) else argument


@cache
def _maker() -> list[object]:
    """What computes answers: this format, our source, whatever version it says it has, and the libraries' versions."""
    from importlib.metadata import version  # scikit-fem and gmsh are not imported for this

    root, source = Path(__file__).parents[2], hashlib.sha256()
    for path in sorted(path for room in ROOMS for path in (root / room).glob("*.py")):
        source.update(path.read_bytes())
    libraries = {name: version(name) for name in ("fe-contact", "numpy", "scipy", "scikit-fem", "gmsh")}
    return [FORMAT, sys.platform, libraries, source.hexdigest()]


def _arrays(answer: Any, prefix: str = "") -> Arrays:
    """The fields of a dataclass as arrays, those of a dataclass within by dotted names."""
    found: Arrays = {}
    for field in fields(answer):
        value, name = getattr(answer, field.name), prefix + field.name
        if is_dataclass(value):
            found |= _arrays(value, f"{name}.")
        elif value is not None:
            found[name] = np.asarray(value)
    return found


def _rebuilt(kind: type[_Answer], arrays: Arrays, prefix: str = "") -> _Answer:
    """The dataclass of these fields."""
    hints, values = get_type_hints(kind), dict[str, Any]()
    for field in fields(kind):  # type: ignore[arg-type]  # every kind of answer is a dataclass
        name = prefix + field.name
        if is_dataclass(hints[field.name]):
            values[field.name] = _rebuilt(hints[field.name], arrays, f"{name}.")
        else:
            array = arrays.get(name)
            values[field.name] = array.item() if array is not None and array.ndim == 0 else array
    return kind(**values)


def _read(path: Path) -> Arrays | None:
    """The arrays of a file that is there and whole, which has been used now."""
    try:
        content = path.read_bytes()
        if hashlib.sha256(content[:-SEAL]).hexdigest().encode() != content[-SEAL:]:
            return None
        os.utime(path)
    except OSError:
        return None
    with np.load(io.BytesIO(content)) as arrays:
        return dict(arrays)


def _write(path: Path, arrays: Arrays) -> None:
    """A whole file or none, and room for it. Raises BadInput for a bound that is no number."""
    most, content = most_bytes(), _sealed(arrays)
    if len(content) > most:
        return
    with suppress(OSError):  # no room, or not ours to write: nothing is kept then
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f"{path.name}.", dir=path.parent)
        begun = Path(name)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            begun.replace(path)
        finally:
            begun.unlink(missing_ok=True)
        clear(path.parent, most)


def _sealed(arrays: Arrays) -> bytes:
    """An npz whose comment is the SHA-256 of what stands before it."""
    content = io.BytesIO()
    np.savez(content, **arrays)  # type: ignore[arg-type]  # no array has the name of its one other keyword
    with zipfile.ZipFile(content, "a") as archive:
        archive.comment = b" " * SEAL
    body = content.getvalue()[:-SEAL]
    return body + hashlib.sha256(body).hexdigest().encode()
