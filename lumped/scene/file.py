"""A scene from a TOML file, from a packaged one by its name, or from a table; with its raw [numerics]."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

from lumped.scene.reader import Described, SceneReader
from lumped.scene.table_reader import Table
from lumped.schema import data
from lumped.schema.bounded_file import exists
from lumped.schema.toml_file import overridden, parsed

Impact = TypeVar("Impact", bound=Described)
Pressed = TypeVar("Pressed")


def load(
    kind: Callable[..., Impact],
    source: str | Path,
    overrides: Mapping[str, object] | None = None,
    law_known: bool = True,
) -> tuple[Impact, Table]:
    """The scene, made by its ``kind``, of a file or of a packaged name, and its raw `[numerics]` table.

    `overrides` maps dotted keys ("striker.velocity") to values that replace the file's. Where the law is yet to be
    found, not `law_known`, mass and velocity are enough. Raises BadInput with every fault found, at most 20.
    """
    return _reader(source, overrides).scene(kind, law_known)


def load_indenter(
    kind: Callable[..., Pressed], source: str | Path, overrides: Mapping[str, object] | None = None
) -> tuple[Pressed, Table]:
    """What a slow indentation needs of a file, and its raw `[numerics]`. Raises BadInput with every fault."""
    return _reader(source, overrides).indenter(kind)


def resolved(source: str | Path) -> Path:
    """The file that a path or the name of a packaged scene stands for. Raises BadInput for an unknown name."""
    path = Path(source)
    if not exists(path) and path.suffix != ".toml" and path.name == str(source):
        return data.scene_path(str(source))
    return path


def read(
    kind: Callable[..., Impact],
    table: Mapping[str, object],
    source: str = "scene",
    overrides: Mapping[str, object] | None = None,
) -> tuple[Impact, Table]:
    """The scene of a table as in a scene file, and its raw `[numerics]` table. Raises BadInput."""
    return SceneReader(source, overridden(table, overrides or {}, source)).scene(kind)


def _reader(source: str | Path, overrides: Mapping[str, object] | None) -> SceneReader:
    """What reads the file of a path or a packaged name. Raises BadInput."""
    path = resolved(source)
    return SceneReader(path.name, overridden(parsed(path), overrides or {}, path.name), path.parent)
