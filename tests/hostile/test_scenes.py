"""Scenes and files of studies with keys dropped, doubled, misspelt and exchanged, and with every kind of value.

None of them is a defect, a hang or a file written by halves: it runs, or every line names the file and a key of it.
"""

from __future__ import annotations

import copy
import datetime
import json
import math
import random
import shutil
import tomllib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumped import laws
from lumped.pounding.case_file import CASES as POUND
from lumped.ptmd.case_file import CASES as PTMD
from lumped.schema.files import SCENES as PACKAGED

Table = dict[str, Any]
SCENES = 20_000
CHANGED_STUDIES = 500
SEED = 20260512
TOP = ("name", "striker", "target", "model", "motion", "law", "numerics")
BODIES = ("striker", "target")
TEXTS = ("", "heavy", "\x1b[31mred", "\u202egnp", "sphere", "a" * 300, "../x", "true", "1e3", "nan", "\n\n", "\0")
EXTREMES = (0, 0.0, -0.0, 5e-324, 1.7e308, 1e150, -1e150, 2**53, 1, 2, 0.5, math.nan, math.inf, -math.inf)
DIGITS = (20, 150, 400, 5000)
SWITCHES: dict[str, tuple[Table, ...]] = {
    "model": ({"inertia": True}, {"inertia": False}, {"profile": "parabola"}, {"gravity": 9.81}, {"gravity": -1e5}),
    "motion": tuple({"impacts": n} for n in (2, 100, 1000)) + tuple({"end_time": t} for t in (1e-15, 1.0, 1e12)),
    "numerics": (
        {"tolerance": 1e-6},
        {"tolerance": 0.1},
        {"steps": 8},
        {"steps": 10**400},
        {"penalty": 1e300},
        {"order": 2.5},
        {"scheme": "galerkin"},
        {"mass": "lumped"},
        {"far_radius": 2.0},
        {"elements_per_contact": 1},
        {"enforcement": "exact"},
        {"contact_radius": 1.0},
    ),
}
DEPTHS = ("1e-6,2e-6,5e-6", "1e-4", "1e-9,1e-3", "1e3", "nan", "0", "-1", "1e-5,x", "")
LOGGED = ("--log", "progress.log")  # where every command says how far it is
TOLERANCES = ("1e-6", "0.1", "x", "nan", "1e400", "-1", "0")


def written(value: object) -> str:
    """A value in TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, list):
        return f"[{', '.join(written(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{json.dumps(key)} = {written(item)}' for key, item in value.items())}}}"
    if isinstance(value, int) and abs(value) >= 10**300:
        return hex(value)
    return str(value)


def table_of(path: Path) -> Table:
    return tomllib.loads(path.read_text(encoding="utf-8"))


def tables_of(table: Table) -> Iterator[Table]:
    yield table
    for value in table.values():
        if isinstance(value, dict):
            yield from tables_of(value)


class Mutations:
    """Draws files from one generator: one of those known, changed in one to four places."""

    def __init__(self, seed: int, known: Sequence[Table]) -> None:
        self.rng, self.known = random.Random(seed), known
        self.ways: tuple[Callable[[Table], None], ...] = (
            self.drop, self.misspell, self.replace, self.replace, self.scale, self.scale, self.scale, self.scale,
        )  # fmt: skip

    def changed(self) -> Table:
        table = copy.deepcopy(self.rng.choice(self.known))
        for _ in range(self.rng.choice((1, 1, 2, 2, 3, 4))):
            self.rng.choice(self.ways)(table)
        return table

    def drop(self, table: Table) -> None:
        place = self.rng.choice([place for place in tables_of(table) if place] or [table])
        place.pop(self.rng.choice(list(place)), None) if place else None

    def misspell(self, table: Table) -> None:
        place = self.rng.choice([place for place in tables_of(table) if place] or [{"": 0}])
        key = self.rng.choice(list(place))
        cut = self.rng.randrange(len(key) or 1)
        ways = (key[:cut] + key[cut + 1 :], key[:cut] + key[cut : cut + 1] + key[cut:], key + "_", key.upper())
        place[self.rng.choice((*ways, "\x1b[" + key, key.replace("_", " ")))] = place.pop(key)

    def replace(self, table: Table) -> None:
        place = self.rng.choice([place for place in tables_of(table) if place] or [{"": 0}])
        key = self.rng.choice(list(place))
        place[key] = self.anything(place[key])

    def anything(self, value: object) -> object:
        """A value of any other kind, or the same one repeated, or deep in brackets."""
        deep = value
        for _ in range(self.rng.choice((3, 14, 40))):
            deep = [deep]
        wide = self.rng.choice((1.0, -1.0)) * 10.0 ** self.rng.uniform(-300, 300)
        kinds: Sequence[object] = (
            True,
            [],
            {"a": 1},
            datetime.date(2020, 1, 1),
            [value] * self.rng.choice((1, 2, 200)),
            deep,
            wide,
        )
        drawn = (self.rng.choice(TEXTS), self.rng.choice(EXTREMES), 10 ** self.rng.choice(DIGITS))
        return self.rng.choice((*kinds, *drawn, *drawn))

    def scale(self, table: Table) -> None:
        """A number moved within what might be accepted, a whole one to a whole one: most of these scenes run."""
        numbers = [
            (place, key)
            for place in tables_of(table)
            for key, value in place.items()
            if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e200
        ]
        if numbers:
            place, key = self.rng.choice(numbers)
            found = (
                place[key]
                * self.rng.choice((1.0, 1.0, 1.0, -1.0))
                * 10.0 ** (self.rng.uniform(-1, 1) + self.rng.choice((0, 0, 1, -1, 2, -2, 4, -4, 8, -8)))
            )
            place[key] = round(found) if isinstance(place[key], int) else found


class Scenes(Mutations):
    """The same of the packaged scenes, whose parts and materials are exchanged as well, and commands on them."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed, [table_of(PACKAGED.path(name)) for name in PACKAGED.names])
        self.ways += (self.exchange_part, self.exchange_material, self.draw_material, self.switch, self.switch)

    def exchange_part(self, table: Table) -> None:
        part, other = self.rng.choice(TOP[1:]), self.rng.choice(self.known)
        if part in other:
            table[part] = copy.deepcopy(other[part])

    def exchange_material(self, table: Table) -> None:
        other = self.rng.choice(self.known)
        found = [other[part]["material"] for part in BODIES if "material" in other.get(part, {})]
        body = table.get(self.rng.choice(BODIES))
        if found and isinstance(body, dict):
            body["material"] = copy.deepcopy(found[0])

    def draw_material(self, table: Table) -> None:
        """Of any network: with a spring for ever, a fluid, or a dashpot alone; its times up to 1e6 contact times."""
        body = table.get("target")
        if not isinstance(body, dict):
            return
        modulus, time = 10.0 ** self.rng.uniform(4, 12), 10.0 ** self.rng.uniform(-9, 3)
        viscosity, ratio = modulus * time, 10.0 ** self.rng.uniform(-3, 3)
        networks: Sequence[Table] = (
            {"law": "elastic", "E": modulus},
            {"law": "kelvin_voigt", "E": modulus, "eta": viscosity},
            {"law": "maxwell", "E": modulus, "eta": viscosity},
            {"law": "sls", "E1": modulus, "E2": ratio * modulus, "C1": viscosity},
            {"law": "prony", "E_inf": 0.0, "E": [modulus, ratio * modulus], "tau": [time, ratio * time]},
            {"law": "operators", "p": [1.0], "q": [0.0, viscosity]},
            {"law": "operators", "p": [1.0, time], "q": [0.0, viscosity, ratio * viscosity * time]},
            {"law": "fractional_zener", "E_inf": modulus, "E_glass": 50.0 * modulus, "tau": time, "alpha": 0.4},
        )
        nu = self.rng.choice((-0.5, 0.0, 0.3, 0.45, 0.4999))
        body["material"] = {**self.rng.choice(networks), "nu": nu, "density": 1200.0}

    def switch(self, table: Table) -> None:
        part = self.rng.choice(list(SWITCHES))
        place = table.setdefault(part, {})
        if isinstance(place, dict):
            place.update(self.rng.choice(SWITCHES[part]))

    def command(self, scene: Path, curve: Path) -> list[str]:
        """A command on the scene; finite elements only where `cheapest` falls back on them."""
        every = laws.available()
        kind = self.rng.random()
        if kind < 0.3:
            command = ["plan", str(scene)]
        elif kind < 0.82:
            command = ["run", str(scene), "--method", self.rng.choice((*every, "cheapest"))]
        elif kind < 0.96:
            method = self.rng.choice(("mdr", "ting", "correspondence", "hertz", "hertzz"))
            instant = self.rng.choice(([], ["--instant"]))
            command = ["indent", str(scene), "--depths", self.rng.choice(DEPTHS), "--method", method, *instant]
        else:
            return ["fit", str(curve), "--law", self.rng.choice(every), "--scene", str(scene)]
        return command + (["--tolerance", self.rng.choice(TOLERANCES)] if self.rng.random() < 0.1 else [])


@pytest.fixture(scope="module")
def curve(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("curve") / "curve.csv"
    time = np.linspace(0.0, 6e-5, 60)
    force = 15.0 * np.maximum(np.sin(np.pi * time / 5.5e-5), 0.0) ** 1.5
    np.savetxt(path, np.column_stack([time, force]), delimiter=",", header="time_s,force_N", comments="")
    return path


@pytest.mark.tenth
def test_a_changed_scene_runs_or_every_line_names_its_file_and_key(
    tmp_path: Path,
    curve: Path,
    hundredth: Callable[[int], int],
    run: Callable[[Sequence[str]], Any],
    faults_of: Callable[..., list[str]],
) -> None:
    mutations, wrong, codes = Scenes(SEED), [], set()
    scene = tmp_path / "scene.toml"
    keys = "|".join(TOP)
    for _ in range(hundredth(SCENES)):
        scene.write_text("".join(f"{json.dumps(k)} = {written(v)}\n" for k, v in mutations.changed().items()))
        command = mutations.command(scene, curve)
        ended = run([*command, *LOGGED])
        named = rf"scene\.toml: (({keys})[.\w]*|[^:]+: unknown key|name: )|--\w+: |.*curve\.csv: "
        named += "|.*: (not a TOML file|larger than)"
        found = faults_of(ended, named, solves=command[0] == "fit" or "cheapest" in command)
        wrong += [f"{fault}\n{scene.read_text()}" for fault in found]
        codes.add(ended.code)
    assert not wrong, "\n".join(wrong)
    assert codes >= {0, 2}, "both what runs and what is refused is among them"


SWEEPS: tuple[Table, ...] = (
    {
        "name": "map", "scene": "steel-ball", "methods": ["hertz", "mdr"], "tolerance": 1e-3,
        "axes": {"striker.velocity": {"log": [0.1, 1.0], "count": 3}, "striker.radius": [1e-3, 2e-3]},
    },
    {
        "name": "drawn", "scene": "polymer-sphere", "methods": ["correspondence"],
        "zipped": {"striker.mass": [0.01, 0.02], "striker.velocity": [0.02, 0.01]},
        "draws": {"count": 3, "seed": 7, "target.material.C1": {"log_uniform": [1e3, 1e5]}},
    },
)  # fmt: skip
SHORT_PTMD = table_of(PTMD.path("paper"))
SHORT_PTMD["motion"] |= {"end_time": 1.0, "window": 0.2}
# Of each command, the files it takes and the parts that a line of bad input may name.
STUDIES: dict[str, tuple[Sequence[Table], str]] = {
    "sweep": (SWEEPS, "name|scene|methods|tolerance|axes|zipped|draws|striker|target"),
    "ptmd": ([SHORT_PTMD], "name|structure|damper|ring|motion"),
    "pound": ([table_of(POUND.path(name)) for name in POUND.names], "name|structure|gap|slab|law|ground|motion"),
}


@pytest.mark.tenth
@pytest.mark.parametrize("study", STUDIES)
def test_a_changed_study_runs_or_every_line_names_its_file_and_key(
    study: str,
    tmp_path: Path,
    campaign_size: Callable[[int], int],
    run: Callable[[Sequence[str]], Any],
    faults_of: Callable[..., list[str]],
) -> None:
    known, keys = STUDIES[study]
    mutations, wrong, codes = Mutations(SEED, known), [], set()
    for record in POUND.path("two-frames").parent.glob("*.csv"):
        shutil.copy(record, tmp_path)
    file = tmp_path / "study.toml"
    count = campaign_size(campaign_size(CHANGED_STUDIES))
    for table in (known[0], *(mutations.changed() for _ in range(count))):
        file.write_text("".join(f"{json.dumps(k)} = {written(v)}\n" for k, v in table.items()))
        ended = run([study, str(file), *(["--jobs", "1"] if study == "sweep" else []), *LOGGED])
        named = rf"study\.toml: (({keys})[^:]*|[^:]+: unknown key|name: )|.*\.csv: "
        named += "|.*: (not a TOML file|larger than|cannot be read)"
        wrong += [f"{fault}\n{file.read_text()}" for fault in faults_of(ended, named, solves=True)]
        codes.add(ended.code)
    assert not wrong, "\n".join(wrong)
    assert codes >= {0, 2}, "both what runs and what is refused is among them"
