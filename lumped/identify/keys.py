"""The keys of a scene file that are sought: where they stand, what they accept, and the scene that has their values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from lumped.errors import BadInput, Fault, nearest
from lumped.fit.space import own_values
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.numbers import Array
from lumped.scene.scene import Scene
from lumped.scene.tables import STRIKER_KEYS, TARGET_KEYS, read
from lumped.schema import Table
from lumped.schema.files import SCENES, overridden, parsed
from lumped.schema.keys import File, Key, Number, Numbers, keys_of
from lumped.schema.members import alternatives
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

FREE = "--free"
# What is sought lies within this factor of the scene's own value, or of what the curves' peak and duration say.
REACH = 1e4
SMALL = 0.02  # of the whole modulus: a spring as weak is hardly told from none
BODIES = {"striker": (SHAPES, STRIKER_KEYS), "target": (TARGETS, TARGET_KEYS)}


@dataclass(frozen=True)
class FreeKey:
    """A number of a scene file: `key`, its dotted name, `place` in a list if it stands in one; its value, its kind.

    It is sought in its logarithm, or as it is where it may be zero or less, as Poisson's ratio. `beside`, in its unit:
    what is added before the logarithm, so that a branch that the curves do without is not infinitely far away.
    """

    key: str
    place: int | None
    value: float
    kind: Number
    beside: float = 0.0

    @property
    def name(self) -> str:
        """The key, in a list with its place: target.material.E[0]."""
        return self.key if self.place is None else f"{self.key}[{self.place}]"

    @property
    def in_logarithm(self) -> bool:
        """Whether it is sought in its logarithm."""
        return self.kind.low >= 0.0

    @property
    def is_modulus(self) -> bool:
        """Whether the force grows in proportion to it, beside others like it."""
        return self.kind.unit in ("Pa", "Pa s")

    @property
    def is_time(self) -> bool:
        """Whether it sets a time of relaxation."""
        return self.kind.unit in ("s", "Pa s")

    def limits(self, value: float) -> tuple[float, float]:
        """The least and the largest place that is looked at around a value."""
        if not self.in_logarithm:
            hair = 1e-9 * (self.kind.high - self.kind.low) if self.kind.above else 0.0  # rounding
            return self.kind.low + hair, self.kind.high
        low, high = max(self.kind.low, value / REACH), min(self.kind.high, value * REACH)
        return self.to_place(self.kind.low if self.beside else low), self.to_place(high)

    @property
    def opened(self) -> tuple[bool, bool]:
        """Which of the limits only end the search; beyond the others there is no value: none is less than none."""
        return self.in_logarithm and not self.beside, self.in_logarithm

    def to_place(self, value: float) -> float:
        """Where a value is sought."""
        return math.log(value + self.beside) if self.in_logarithm else value

    def at(self, place: float) -> float:
        """The value at a place."""
        return max(math.exp(place) - self.beside, self.kind.low) if self.in_logarithm else place

    def softened(self, modulus: float, width: float) -> FreeKey:
        """The same beside a share of what the bodies have at once, a modulus, Pa, for a pulse as wide, s."""
        sizes = {"Pa": modulus, "Pa s": modulus * width, "": 1.0}
        return replace(self, beside=SMALL * sizes.get(self.kind.unit, 0.0) if self.in_logarithm else 0.0)


@dataclass(frozen=True)
class SceneFile:
    """The tables of a scene file, and what faults call it; files that it names stand with their whole path."""

    table: Table
    source: str = "scene"

    @classmethod
    def of(cls, scene: str | Path | Table, overrides: Mapping[str, object]) -> SceneFile:
        """Of a path, a packaged name, or tables, with the dotted keys of `overrides` set. Raises BadInput."""
        if isinstance(scene, dict):
            return cls(overridden(scene, overrides, "scene"))
        path = SCENES.resolved(scene)
        table = overridden(parsed(path), overrides, path.name)
        return cls(overridden(table, dict(_whole_paths(table, path.parent)), path.name), path.name)

    def named_by(self, names: Sequence[str]) -> SceneFile:
        """The same with each network by that of its sets of keys whose names are asked for, as E0, R1, R2 of a solid
        that stands by E1, E2, C1.
        """
        table = self.table
        for part in BODIES:
            material = table.get(part, {}).get("material", {})
            own, others = _sets(material)
            asked = {name.rpartition(".")[2] for name in names if name.startswith((f"{part}.", *own, *others))}
            if own and asked & (others - own) and not asked & (own - others):
                values = own_values(NETWORKS.get(material["law"]).of(**{name: material[name] for name in own}))
                rest = {name: value for name, value in material.items() if name not in own}
                new = {**rest, **{name: value for name, value in values.items() if name in others}}
                table = {**table, part: {**table[part], "material": new}}
        return replace(self, table=table)

    def scene(self, keys: Sequence[FreeKey], places: Array, own: Mapping[str, object]) -> Scene:
        """The scene with the free keys at these places, (p,), and what a curve has of its own. Raises BadInput."""
        return read(Scene, self.with_values(keys, places), self.source, own)[0]

    def with_values(self, keys: Sequence[FreeKey], places: Array) -> Table:
        """The tables with the free keys at these places, (p,)."""
        changed: dict[str, object] = {}
        rows: dict[str, list[float]] = {}
        for one, place in zip(keys, places.tolist(), strict=True):
            if one.place is None:
                changed[one.key] = one.at(place)
            else:
                part, inner, name = one.key.split(".")
                rows.setdefault(one.key, list(self.table[part][inner][name]))[one.place] = one.at(place)
        return overridden(self.table, {**changed, **rows}, self.source)


def _whole_paths(table: Table, folder: Path) -> Iterator[tuple[str, str]]:
    """The files that materials name, by their dotted keys, so that another folder's scene file finds them too."""
    for part in BODIES:
        material = table.get(part, {}).get("material", {})
        for name, key in _network_keys(material).items() if material else ():
            if isinstance(key.kind, File) and isinstance(material.get(name), str):
                yield f"{part}.material.{name}", str((folder / material[name]).resolve())


def _network_keys(material: Table) -> Mapping[str, Key]:
    """The keys of a material's own set, and those of all materials."""
    own = max(alternatives(NETWORKS, material.get("law")), key=lambda keys: len(keys.keys() & material.keys()))
    return {**own, **keys_of(Material)}


def _sets(material: Table) -> tuple[set[str], set[str]]:
    """The names that a network stands by, and those that it could; both empty where it has one set alone."""
    sets = [set(keys) for keys in NETWORKS.get(material["law"]).sets] if material.get("law") in NETWORKS.names else []
    own = next((keys for keys in sets if keys <= material.keys()), set[str]())
    others = next((keys for keys in sets if keys != own), set[str]())
    return (own, others) if own and others else (set(), set())


def free_keys(file: SceneFile, names: Sequence[str]) -> tuple[FreeKey, ...]:
    """The free keys of a scene by their names; a list's own name stands for all of it, a key's last part, as E0, for
    the one key that ends so. Raises BadInput.
    """
    known = {one.name: one for one in _numbers(file.table)}
    faults, found = list[Fault](), dict[str, FreeKey]()
    for name in names:
        chosen = [one for one in known.values() if name in (one.name, one.key)]
        if not chosen:
            short = [one for one in known.values() if name in (one.name.rpartition(".")[2], one.key.rpartition(".")[2])]
            chosen = short if len({one.key for one in short}) == 1 else []
        if not chosen:
            accepted = ", ".join(known) or "none"
            reason = f"{name}: no number of {file.source}; accepted: {accepted}{nearest(name, tuple(known))}"
            faults.append(Fault(FREE, "", reason))
        none = [one.name for one in chosen if one.in_logarithm and one.value <= 0.0]
        faults += [Fault(FREE, one, "0: what is none cannot grow; accepted: a first guess above zero") for one in none]
        found |= {one.name: one for one in chosen}
    if not names:
        faults.append(Fault(FREE, "", "empty; accepted: at least one key of the scene"))
    if faults:
        raise BadInput(faults)
    return tuple(found.values())


def starting_places(keys: Sequence[FreeKey]) -> Array:
    """Where the scene's own values stand, (p,)."""
    return np.array([one.to_place(one.value) for one in keys])


def _numbers(table: Table) -> Iterator[FreeKey]:
    """Every number of the bodies and their materials, as the scene file has them."""
    for part, (folder, common) in BODIES.items():
        body = table.get(part, {})
        keys = dict(common)
        if "shape" in body:
            keys |= alternatives(folder, body["shape"])[0]
        yield from _of_table(part, body, keys)
        material = body.get("material", {})
        if material:
            yield from _of_table(f"{part}.material", material, _network_keys(material))


def _of_table(path: str, table: Table, keys: Mapping[str, Key]) -> Iterator[FreeKey]:
    for name, key in keys.items():
        if name not in table:
            continue
        if isinstance(key.kind, Number):
            yield FreeKey(f"{path}.{name}", None, float(table[name]), key.kind)
        elif isinstance(key.kind, Numbers):
            for place, value in enumerate(table[name]):
                yield FreeKey(f"{path}.{name}", place, float(value), key.kind.each)
