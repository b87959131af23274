"""The published histories: every packaged scene answered, its history and quantities with bars, for anyone to cite.

They lie in `data/references/` as a Data Package (https://datapackage.org, version 2): a CSV file of the history and a
JSON file of everything else a scene. Nothing reads them in place of a run: they are what a later suite is held against.
A value has moved by its difference over the sum of both bars; up to 1 the two agree. For other tools they are written
again in a format of theirs.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from fe_contact import __version__
from fe_contact.assembly.cache import forget
from fe_contact.assembly.disk_cache import without_disk
from fe_contact.methods import simulate
from fe_contact.progress import Progress, silent
from fe_contact.studies.files import Line, require_parquet, write_parquet, write_study
from lumped import laws
from lumped.errors import BadInput, Fault, FeContactError, nearest, shown
from lumped.fit import opensees
from lumped.numbers import Array
from lumped.result.history import COLUMNS, History
from lumped.result.result import Quantity, Result
from lumped.scene.scene import Scene
from lumped.scene.tables import load
from lumped.schema import Table
from lumped.schema.csv_file import write_columns, write_csv
from lumped.schema.files import SCENES, data_folder
from lumped.schema.json_file import write_json
from meshes.triangles import Imprint, imprints

PACKAGE, RECORD = "datapackage.json", "references.json"
SCHEMA = "fe-contact/references/1"
DIGITS = 9  # of a history as it is written
ROUNDING = 1e-8  # what they may move a force by: below every bar of elements
OURS = ("timing", "work")  # of a result: what another machine has otherwise
UNITS = {"_per_s": "m/s", "_s": "s", "_m": "m", "_N": "N"}  # by the end of a column's name, the longest first


@dataclass(frozen=True, eq=False)
class Reference:
    """What is published of a scene: its history, and its quantities with their bars."""

    history: History
    quantities: Mapping[str, Quantity]
    content: Table = field(default_factory=dict)  # of its JSON file

    @classmethod
    def read(cls, folder: Path, name: str) -> Reference | None:
        """That of a scene; None where none is published."""
        if not (folder / f"{name}.json").exists():
            return None
        content = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        quantities = {key: Quantity(**quantity) for key, quantity in content["quantities"].items()}
        return cls(History.read_csv(folder / f"{name}.csv"), quantities, content)

    @property
    def columns(self) -> dict[str, Array]:
        """The history by the names of its file's columns."""
        return {header: getattr(self.history, name) for name, header in COLUMNS.items()}


@dataclass(frozen=True)
class Move:
    """One quantity of a scene: published, found now, and by how much it moved over the sum of both bars.

    `moved` is None where only one of the two is defined.
    """

    scene: str
    quantity: str
    published: float | None
    found: float | None
    bars: float
    moved: float | None

    @property
    def size(self) -> float:
        """By how much it moved, infinite where only one of the two is defined."""
        return math.inf if self.moved is None else self.moved

    @property
    def agrees(self) -> bool:
        """Whether both can be true."""
        return self.size <= 1.0


@dataclass(frozen=True, eq=False)
class Renewal:
    """A scene answered again: the result, None where nothing may be published and `reason` says why; what moved.

    `meshes`: imprints of all that it was answered on.
    """

    scene: str
    result: Result | None
    moves: tuple[Move, ...]
    is_new: bool
    reason: str = ""
    meshes: tuple[Imprint, ...] = ()

    @property
    def agrees(self) -> bool:
        """Whether what is published still stands: nothing, where nothing could be."""
        return all(move.agrees for move in self.moves) if self.result is not None else self.is_new

    @property
    def line(self) -> str:
        """For a person."""
        if self.result is None:
            return f"{self.scene}: not published: {self.reason}"
        if self.is_new:
            return f"{self.scene}: new"
        most = max(self.moves, key=lambda move: move.size)
        if most.moved is None:
            return f"{self.scene}: {most.quantity} is undefined in one of both"
        verdict = "agrees" if self.agrees else "DIFFERS"
        return f"{self.scene}: {verdict}: moved by up to {most.moved:.2g} of both bars ({most.quantity})"


def folder() -> Path:
    """Where the published histories lie."""
    return data_folder() / "references"


def checked(names: Sequence[str]) -> tuple[str, ...]:
    """Names of packaged scenes, all of them where none is given. Raises BadInput with every unknown one."""
    known = SCENES.names
    faults = [
        Fault("--scenes", "", f"{name}: no packaged scene{nearest(name, known)}") for name in set(names) - {*known}
    ]
    if faults:
        raise BadInput(faults)
    return tuple(name for name in known if name in names) if names else known


def renewed(names: Sequence[str], published: Path, progress: Progress = silent) -> Iterator[Renewal]:
    """Every scene by its default method with the settings of its file, against what `published` holds of it."""
    for count, name in enumerate(names):
        progress(name, count, len(names))
        older = Reference.read(published, name)
        try:
            scene, settings = load(Scene, name)
            result, meshes = _afresh(scene, settings)
        except FeContactError as failure:
            yield Renewal(name, None, (), older is None, str(failure))
            continue
        if result.converged:
            yield Renewal(name, result, moves(name, older, result), older is None, meshes=meshes)
        else:
            yield Renewal(name, None, (), older is None, result.message)


def _afresh(scene: Scene, settings: Table) -> tuple[Result, tuple[Imprint, ...]]:
    """A scene's answer with nothing at hand, and the imprints of all meshes that were made for it."""
    forget()
    with without_disk(), imprints() as made:
        result = simulate(scene, None, settings)
    return result, tuple(dict.fromkeys(made))


def moves(name: str, older: Reference | None, newer: Result) -> tuple[Move, ...]:
    """What moved of a scene's quantities; the history by the norm of the difference over that of the force.

    Straight lines between rows, which may lie elsewhere now, miss up to the tolerance of it.
    """
    if older is None:
        return ()
    found = {key: newer.quantities[key] for key in older.quantities if key in newer.quantities}
    told = (found["history_l2"].error or 0.0) + newer.tolerance
    found["history_l2"] = Quantity(_apart(older.history, newer.history), told, "1")
    return tuple(_move(name, key, older.quantities[key], quantity) for key, quantity in found.items())


def _move(scene: str, key: str, older: Quantity, newer: Quantity) -> Move:
    bars = (older.error or 0.0) + (newer.error or 0.0)
    if older.value is None or newer.value is None:
        return Move(scene, key, older.value, newer.value, bars, 0.0 if older.value is newer.value else None)
    moved = abs(newer.value - older.value) / (bars + ROUNDING * (abs(older.value) or 1.0))
    return Move(scene, key, older.value, newer.value, bars, moved)


def _apart(older: History, newer: History) -> float:
    """The norm of the difference of two forces over that of the older, but for jumps, known as they are written."""
    times = np.union1d(older.time, newer.time)
    lasting = np.diff(times) > ROUNDING * times[-1]
    middle, width = (0.5 * (times[1:] + times[:-1]))[lasting], np.diff(times)[lasting]
    force = older.force_at(middle)
    return float(np.sqrt((width @ (newer.force_at(middle) - force) ** 2) / (width @ force**2)))


def write_references(renewals: Sequence[Renewal], where: Path) -> None:
    """Write all that is to be published, and ``moves.csv``, what moved, into a folder."""
    _write_package(renewals, where)
    lines = [asdict(move) | {"agrees": move.agrees} for one in renewals for move in one.moves]
    scenes = {one.scene: {"agrees": one.agrees, "new": one.is_new, "reason": one.reason} for one in renewals}
    headers = {"moves": (*Move.__dataclass_fields__, "agrees")}
    write_study(where, "references", {"schema": SCHEMA, "scenes": scenes}, {"moves": lines}, headers)


def write_published(renewals: Sequence[Renewal], where: Path) -> None:
    """Write all that is to be published, and its names, into a folder."""
    write_json(where / RECORD, {"schema": SCHEMA, "scenes": _write_package(renewals, where)})


def _write_package(renewals: Sequence[Renewal], where: Path) -> list[str]:
    """History and result of every scene that may be published, and the package's description; the scenes' names."""
    published = [one for one in renewals if one.result is not None]
    for one in published:
        _write_scene(one, where)
    names = [one.scene for one in published]
    write_json(where / PACKAGE, _package(names))
    return names


def _write_scene(renewal: Renewal, where: Path) -> None:
    result = renewal.result
    assert result is not None
    write_columns(where / f"{renewal.scene}.csv", *_table(result.history))
    content = {key: value for key, value in result.to_json().items() if key not in OURS}
    made = {**result.provenance, "meshes": [asdict(mesh) for mesh in renewal.meshes]}
    write_json(where / f"{renewal.scene}.json", content | {"suite": __version__, "provenance": made})


def _table(history: History) -> tuple[tuple[str, ...], list[Array], int]:
    """Header, columns and digits of a history's file."""
    return tuple(COLUMNS.values()), [getattr(history, name) for name in COLUMNS], DIGITS


def _package(names: Sequence[str]) -> Table:
    """The description of the package: a table a scene, its columns with their units."""
    fields = [{"name": column, "type": "number", "unit": _unit(column)} for column in COLUMNS.values()]
    return {
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": "fe-contact-references",
        "title": "Force histories of impacts with error bars",
        "version": __version__,
        "licenses": [{"name": "CC-BY-4.0", "path": "https://creativecommons.org/licenses/by/4.0/"}],
        "resources": [
            {
                "name": name,
                "path": f"{name}.csv",
                "type": "table",
                "format": "csv",
                "mediatype": "text/csv",
                "encoding": "utf-8",
                "description": f"history of the packaged scene {name}; quantities, bars and settings: {name}.json",
                "schema": {"fields": fields},
            }
            for name in names
        ],
    }


def _unit(column: str) -> str:
    return next(unit for end, unit in UNITS.items() if column.endswith(end))


def published(names: Sequence[str]) -> dict[str, Reference]:
    """What is published of these scenes. Raises BadInput where nothing is of one."""
    found = {name: Reference.read(folder(), name) for name in names}
    if missing := [name for name, one in found.items() if one is None]:
        raise BadInput(Fault("--scenes", "", f"{name}: no history of it is published") for name in missing)
    return {name: one for name, one in found.items() if one is not None}


def checked_format(name: str) -> str:
    """A key of FORMATS. Raises BadInput for another name, and where its package is missing."""
    if name not in FORMATS:
        raise BadInput(Fault("--format", "", f"{shown(name)}: accepted {', '.join(FORMATS)}"))
    if name == "parquet":
        require_parquet()
    return name


def write_for_others(references: Mapping[str, Reference], name: str, where: Path, progress: Progress = silent) -> None:
    """Write what is published of scenes in a format of FORMATS, and a record of it, into a folder."""
    FORMATS[name](references, where, progress)
    write_json(where / RECORD, {"schema": SCHEMA, "format": name, "scenes": [*references]})


def _as_csv(references: Mapping[str, Reference], where: Path, progress: Progress) -> None:
    """A table a scene, one of all quantities, and the package's description."""
    for name, one in references.items():
        write_columns(where / f"{name}.csv", *_table(one.history))
    lines = _quantities(references)
    write_csv(where / "quantities.csv", [*lines[0]], [[*line.values()] for line in lines])
    write_json(where / PACKAGE, _package([*references]))


def _as_json(references: Mapping[str, Reference], where: Path, progress: Progress) -> None:
    """A file a scene, its history in it."""
    for name, one in references.items():
        write_json(
            where / f"{name}.json",
            one.content | {"history": {column: values.tolist() for column, values in one.columns.items()}},
        )


def _as_parquet(references: Mapping[str, Reference], where: Path, progress: Progress) -> None:
    """All histories, and all quantities, in one table each. Raises ExtraMissing."""
    lengths = [len(one.history) for one in references.values()]
    columns = [np.concatenate([one.columns[column] for one in references.values()]) for column in COLUMNS.values()]
    histories = {"scene": np.repeat([*references], lengths), **dict(zip(COLUMNS.values(), columns, strict=True))}
    write_parquet(where / "histories.parquet", histories)
    lines = _quantities(references)
    write_parquet(where / "quantities.parquet", {key: [line[key] for line in lines] for key in lines[0]})


def _as_opensees(references: Mapping[str, Reference], where: Path, progress: Progress) -> None:
    """A Tcl file a scene: its force as a time series of two files, and the impact material that fits it best."""
    for count, (name, one) in enumerate(references.items(), start=1):
        progress(name, count - 1, len(references))
        rising = np.diff(one.history.time, prepend=-math.inf) > 0.0
        for column in ("time", "force"):
            np.savetxt(where / f"{name}-{column}.txt", getattr(one.history, column)[rising], fmt=f"%.{DIGITS}g")
        series = f"timeSeries Path {count} -fileTime {name}-time.txt -filePath {name}-force.txt"
        text = [f"# {name}: force on the striker, N, over time, s, since touch", series, _material(name, one, count)]
        (where / f"{name}.tcl").write_text("\n".join(text) + "\n", encoding="utf-8")


def _material(name: str, one: Reference, tag: int) -> str:
    """The law of the scene itself as OpenSees' lines, or of the one that fits its history; else why there is none."""
    scene = Scene.load(name)
    try:
        if one.content["method"] != "fe":
            return opensees.lines(laws.get(one.content["method"]).of(scene), scene, tag)
        return opensees.lines_for(one.history, scene, tag)
    except FeContactError as failure:
        return f"# no impact material: {failure}"


def _quantities(references: Mapping[str, Reference]) -> list[Line]:
    return [
        {"scene": name, "quantity": key, "value": one.value, "error": one.error, "unit": one.unit}
        for name, reference in references.items()
        for key, one in reference.quantities.items()
    ]


FORMATS: Mapping[str, Callable[[Mapping[str, Reference], Path, Progress], None]] = {
    "csv": _as_csv,
    "json": _as_json,
    "parquet": _as_parquet,
    "opensees": _as_opensees,
}
