"""A sweep file: one scene, the axes along which its keys vary, and the methods; every fault of it at once.

Cases are the product of all axes in the order written, the last one fastest. None of them is made before it is asked
for: a sweep of a million cases takes no more room than its axes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from statistics import NormalDist

import numpy as np

from fe_contact import methods, settings
from fe_contact.settings import Given
from lumped.errors import BadInput, Fault, shown
from lumped.numbers import Array
from lumped.scene.scene import Scene
from lumped.scene.tables import Known, SceneReader, TableReader
from lumped.schema import Table
from lumped.schema.files import SCENES, exists, overridden, parsed
from lumped.schema.keys import Count, File, Key, Number, Text

MOST_CASES = 10_000_000  # work: days on a hundred processes
MOST_VALUES = 1_000_000  # work: of all keys together, for they are held
DIGITS = 15  # rounding: between 0.01 and 0.03 lies 0.02, not 0.019999999999999997
SAMPLE = 24  # of cases that are read before any runs: a fault that all of them have is the sweep file's
RANGES: Mapping[str, Callable[..., Array]] = {"linear": np.linspace, "log": np.geomspace}
VALUES = "a list of values, or { linear = [low, high], count = n }, or { log = [low, high], count = n }"
_share = np.vectorize(NormalDist().cdf, otypes=[float])  # below z; scipy's would load what no law needs
# by kind of draw: its value where a standard normal variable is z
DRAWS: Mapping[str, Callable[[float, float, Array], Array]] = {
    "uniform": lambda low, high, z: low + (high - low) * _share(z),
    "log_uniform": lambda low, high, z: low * (high / low) ** _share(z),
    "normal": lambda mean, deviation, z: mean + deviation * z,
}
DRAWN = "{ uniform = [low, high] }, { log_uniform = [low, high] } or { normal = [mean, deviation] }"
PAIRS = "a list of pairs with their correlation, as [['striker.mass', 'striker.velocity', 0.5]]"
Values = tuple[object, ...]


@dataclass(frozen=True)
class Methods:
    """A list of names of methods."""

    @property
    def accepted(self) -> str:
        """In words."""
        return f"a list of methods, of {', '.join(methods.names())}"

    @property
    def schema(self) -> Table:
        """For editors."""
        return {"type": "array", "items": {"enum": list(methods.names())}, "minItems": 1}

    def read(self, value: object) -> tuple[str, ...]:
        """The names; raises ValueError for one that is none."""
        if not isinstance(value, list) or not value:
            raise ValueError
        if reason := next(filter(None, map(methods.refusal, value)), ""):
            raise ValueError(reason)
        return tuple(dict.fromkeys(value))


@dataclass(frozen=True)
class Subtable:
    """A table within the file."""

    accepted: str = "a table"

    @property
    def schema(self) -> Table:
        """For editors."""
        return {"type": "object"}

    def read(self, value: object) -> Mapping[str, object]:
        """The same; raises ValueError."""
        if not isinstance(value, Mapping):
            raise ValueError
        return value


KEYS: Mapping[str, Key] = {
    "name": Key(Text(), "name of the sweep", required=False),
    "scene": Key(File("a packaged scene, or a path from the folder of the sweep file"), "what is varied"),
    "methods": Key(Methods(), "how every case is answered", required=False),
    "tolerance": Key(settings.KEYS["tolerance"].kind, "asked of every answer", required=False),
    "axes": Key(Subtable(), "keys that vary each for itself", required=False),
    "zipped": Key(Subtable(), "keys that vary together", required=False),
    "draws": Key(Subtable(), "keys that are drawn at random", required=False),
}
DRAW_KEYS: Mapping[str, Key] = {
    "count": Key(Count(1, MOST_VALUES), "how many are drawn"),
    "seed": Key(Count(0, 2**63 - 1), "of the random numbers"),
}


@dataclass(frozen=True)
class Axis:
    """Keys that vary together, and their values: of all ``keys``, at every place of the axis; ``drawn`` at random."""

    keys: tuple[str, ...]
    places: tuple[Values, ...]
    drawn: bool = False


@dataclass(frozen=True)
class BaseScene:
    """Tables of a scene file, the ``source`` they came from; ``folder``: where the files begin that they name."""

    tables: Table
    source: str
    folder: Path

    def read(self, overrides: Mapping[str, object], known: Known | None = None) -> tuple[Scene, Table]:
        """The scene with some keys set, and its checked settings; raises BadInput with every fault.

        ``known``: parts of scenes that were read of this one before.
        """
        tables = overridden(self.tables, overrides, self.source)
        numerics = tables.get("numerics", {})
        refused = settings.faults(numerics, self.source) if isinstance(numerics, Mapping) else []
        try:
            scene, given = SceneReader(self.source, tables, self.folder, known).scene(Scene)
        except BadInput as bad:
            raise BadInput([*bad.faults, *refused]) from None
        if refused:
            raise BadInput(refused)
        return scene, given


@dataclass(frozen=True)
class Sweep:
    """What a sweep file asks for; ``tolerance``: None leaves it to the scene's file."""

    name: str
    source: str
    base: BaseScene
    axes: tuple[Axis, ...]
    methods: tuple[str, ...] = ("fe",)
    tolerance: float | None = None

    @property
    def count(self) -> int:
        """Of its cases."""
        return math.prod(len(axis.places) for axis in self.axes)

    @property
    def keys(self) -> tuple[str, ...]:
        """That vary, in the order written."""
        return tuple(key for axis in self.axes for key in axis.keys)

    @cached_property
    def strides(self) -> list[int]:
        """How many cases lie between two places of an axis."""
        return [math.prod(len(later.places) for later in self.axes[i + 1 :]) for i in range(len(self.axes))]

    def overrides(self, case: int) -> dict[str, object]:
        """The keys of a case, from 0 to ``count`` - 1, and their values."""
        found: dict[str, object] = {}
        for axis, stride in zip(self.axes, self.strides, strict=True):
            found |= zip(axis.keys, axis.places[case // stride % len(axis.places)], strict=True)
        return found


def load(source: str | Path | Mapping[str, object]) -> Sweep:
    """The sweep of a file, or of tables as in one. Raises BadInput with every fault, its base scene's too."""
    if isinstance(source, Mapping):
        return _Reader("sweep", dict(source), Path()).sweep()
    path = Path(source)
    return _Reader(path.name, parsed(path), path.parent).sweep()


def _flat(table: Given, path: str = "") -> dict[str, object]:
    """A table by dotted keys, whether they were written in quotes or as tables in tables."""
    found: dict[str, object] = {}
    for key, value in table.items():
        spec = "." in key or not isinstance(value, Mapping) or value.keys() & {*RANGES, *DRAWS, "count"}
        found |= {f"{path}{key}": value} if spec else _flat(table[key], f"{path}{key}.")
    return found


class _Reader(TableReader):
    """Walks the tables of a sweep file once and keeps every fault."""

    TABLES = ("axes", "zipped", "draws")
    held = 0  # values of ranges and draws

    def sweep(self) -> Sweep:
        values = self.checked("", self.raw, KEYS)
        axes, base = self.axes(values), self.base(values.get("scene"))
        if base is None:
            raise BadInput(self.faults)
        chosen = {name: values[name] for name in ("methods", "tolerance") if name in values}
        found = Sweep(values.get("name", Path(self.source).stem), self.source, base, axes, **chosen)
        self.faults += self.common_faults(found)
        if self.faults:
            raise BadInput(self.faults)
        return found

    def axes(self, values: Given) -> tuple[Axis, ...]:
        """All axes in the order written; every table that varies no key is a fault."""
        readers = {"axes": self.free, "zipped": self.zipped, "draws": self.draws}
        tables = [name for name in self.raw if name in readers and name in values]
        found = [axis for name in tables for axis in readers[name](_flat(values[name])) if axis.places]
        keys = [key for axis in found for key in axis.keys]
        for key in dict.fromkeys(key for key in keys if keys.count(key) > 1):
            self.fault(key, "varies twice; accepted: once, in [axes], [zipped] or [draws]")
        if not tables:
            self.fault("axes", "missing; accepted: [axes], [zipped] or [draws] with a key of the scene each")
        if math.prod(len(axis.places) for axis in found) > MOST_CASES:
            self.fault("axes", f"more than {MOST_CASES} cases; accepted: fewer values along an axis")
        return tuple(found)

    def free(self, table: Given) -> list[Axis]:
        """An axis for every key."""
        found = {key: self.values(f"axes.{key}", spec) for key, spec in table.items()}
        return [Axis((key,), tuple((value,) for value in values)) for key, values in found.items()]

    def zipped(self, table: Given) -> list[Axis]:
        """One axis of all keys, lists of one length."""
        lists = {key: self.values(f"zipped.{key}", spec) for key, spec in table.items()}
        lengths = {key: len(values) for key, values in lists.items()}
        if len(set(lengths.values())) > 1:
            said = ", ".join(f"{key} {length}" for key, length in lengths.items())
            self.fault("zipped", f"lists of different lengths ({said}); accepted: one length")
            return []
        return [Axis(tuple(lists), tuple(zip(*lists.values(), strict=True)))] if lists else []

    def values(self, where: str, spec: object) -> Values:
        """What a list or a range holds; empty with a fault noted."""
        if isinstance(spec, list) and spec:
            return tuple(spec)
        if isinstance(spec, Mapping):
            kinds = [kind for kind in RANGES if kind in spec]
            if len(kinds) == 1 and spec.keys() == {kinds[0], "count"}:
                return self.range(where, kinds[0], spec)
        self.fault(where, f"{shown(spec)}; accepted: {VALUES}")
        return ()

    def range(self, where: str, kind: str, spec: Given) -> Values:
        """So many values between two ends."""
        ends = self.pair(f"{where}.{kind}", spec[kind], above_zero=kind == "log")
        count, known = Count(1, MOST_VALUES), len(self.faults)
        values = self.checked(where, {"count": spec["count"]}, {"count": Key(count)})
        if ends is None or len(self.faults) > known or not self.holds(where, values["count"]):
            return ()
        return tuple(float(f"{value:.{DIGITS}g}") for value in RANGES[kind](*ends, values["count"]).tolist())

    def holds(self, where: str, count: int) -> bool:
        """Whether so many values more are not too many; else a fault is noted."""
        self.held += count
        if self.held > MOST_VALUES:
            self.fault(where, f"more than {MOST_VALUES} values in all; accepted: a smaller count")
        return self.held <= MOST_VALUES

    def pair(self, where: str, value: object, above_zero: bool = False) -> tuple[float, float] | None:
        """Two finite numbers; None with a fault noted."""
        number = Number(0.0 if above_zero else -1e300, 1e300, above=above_zero)
        try:
            if not isinstance(value, list) or len(value) != 2:
                raise ValueError
            return number.read(value[0]), number.read(value[1])
        except ValueError:
            self.fault(where, f"{shown(value)}; accepted: two of {number.accepted}")
            return None

    def draws(self, table: Given) -> list[Axis]:
        """One axis of all drawn keys: as many places as are drawn."""
        given = {name: table[name] for name in DRAW_KEYS if name in table}
        values = self.checked("draws", given, DRAW_KEYS)
        specs = {key: spec for key, spec in table.items() if key not in (*DRAW_KEYS, "correlation")}
        kinds = {key: self.transform(f"draws.{key}", spec) for key, spec in specs.items()}
        roots = self.correlation(table.get("correlation", []), list(kinds))
        if len(values) < len(DRAW_KEYS) or not kinds or None in kinds.values():
            if not kinds:
                self.fault("draws", f"draws no key; accepted: a key with {DRAWN}")
            return []
        if not self.holds("draws", values["count"] * len(kinds)):
            return []
        normal = np.random.default_rng(values["seed"]).standard_normal((values["count"], len(kinds))) @ roots.T
        columns = [made(z).tolist() for made, z in zip(kinds.values(), normal.T, strict=True) if made is not None]
        return [Axis(tuple(kinds), tuple(zip(*columns, strict=True)), drawn=True)]

    def transform(self, where: str, spec: object) -> Callable[[Array], Array] | None:
        """How a key follows from a standard normal variable; None with a fault noted."""
        if not isinstance(spec, Mapping) or len(spec) != 1 or next(iter(spec)) not in DRAWS:
            self.fault(where, f"{shown(spec)}; accepted: {DRAWN}")
            return None
        ((kind, value),) = spec.items()
        ends = self.pair(f"{where}.{kind}", value, above_zero=kind == "log_uniform")
        return None if ends is None else lambda z: DRAWS[kind](*ends, z)

    def correlation(self, pairs: object, keys: list[str]) -> Array:
        """The root of the correlation matrix of the normal variables, (n, n); the unit matrix with a fault noted."""
        matrix = np.eye(len(keys))
        try:
            if not isinstance(pairs, list):
                raise ValueError
            for one, other, value in pairs:
                if one == other or {one, other} - {*keys} or not -1.0 < value < 1.0:
                    raise ValueError
                place = keys.index(one), keys.index(other)
                matrix[place] = matrix[place[::-1]] = value
            return np.asarray(np.linalg.cholesky(matrix))
        except np.linalg.LinAlgError:
            reason = "no variables correlate so: the matrix is not positive definite; accepted: weaker ones"
        except (TypeError, ValueError):
            reason = f"{shown(pairs)}; accepted: {PAIRS}, of keys that are drawn, between -1 and 1"
        self.fault("draws.correlation", reason)
        return np.eye(len(keys))

    def base(self, scene: object) -> BaseScene | None:
        """What the base scene's file holds; None with faults noted."""
        if scene is None:
            return None
        beside = self.folder / str(scene)
        try:
            path = beside if exists(beside) and beside.is_file() else SCENES.resolved(str(scene))
            return BaseScene(parsed(path), path.name, path.parent.absolute())
        except BadInput as bad:
            said = shown(str(scene))
            self.faults += [Fault(self.source, "scene", f"{said}: {fault.message}") for fault in bad.faults]
            return None

    def common_faults(self, sweep: Sweep) -> list[Fault]:
        """What every case of a sample is refused for: a key that no scene has, a base scene with a fault.

        A value out of its range is its own case's fault alone. Beside other faults of the file, some axis is missing:
        then only what is said of the axes' own keys counts.
        """
        found: dict[Fault, None] | None = None
        for case in np.unique(np.linspace(0, sweep.count - 1, min(SAMPLE, sweep.count)).astype(int)).tolist():
            try:
                sweep.base.read(sweep.overrides(case))
                return []
            except BadInput as bad:
                found = {fault: None for fault in bad.faults if found is None or fault in found}
        own = {
            fault: Fault(self.source, key, fault.message)
            for fault in found or ()
            for key in sweep.keys
            if f"{key}.".startswith(f"{fault.key}.")  # or a table that there is not, which only this key names
        }
        return list(own.values()) if self.faults else [own.get(fault, fault) for fault in found or ()]

    def fault(self, key: str, message: str) -> None:
        self.faults.append(Fault(self.source, key, message))
