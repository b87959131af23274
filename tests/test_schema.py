"""The published JSON Schemas: what the readers accept, and what they refuse for a key, a type or a range."""

from __future__ import annotations

import json
import math
import random
import re
import tomllib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from fe_contact.cli import main
from fe_contact.manual.schemas import SCHEMAS, names_of_files, published
from fe_contact.settings import faults as settings_faults
from lumped import Scene, laws, simulate
from lumped.errors import BadInput
from lumped.pounding import case_file as pounding
from lumped.ptmd import case_file as damper
from lumped.result.result import write_failure
from lumped.scene.tables import read
from lumped.schema.files import SCENES, data_folder

Table = dict[str, Any]
SEED, MUTANTS = 20260601, 3000
OTHERS = (-1.0, 0.0, 1e40, -1e40, "a word", True, 7, [1.0], [], {"a": 1.0}, [True], "")  # in the place of a value
# What is said of a key alone; a law's "missing; accepted: the damping: one of e or xi" is no key's.
OF_A_KEY = re.compile(
    "unknown key|is not accepted; accepted|is not known; accepted|not a table|missing; a scene needs"
    "|missing; accepted: (?:a number|a whole|a list|one of)"
)


@cache
def checker(kind: str) -> Any:
    schema = json.loads((data_folder() / "schema" / names_of_files()[kind]).read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def complaints(kind: str, table: Table) -> list[str]:
    return [f"{fault.json_path}: {fault.message[:300]}" for fault in checker(kind).iter_errors(table)]


@pytest.mark.parametrize("name", SCHEMAS)
def test_what_is_published_is_what_the_keys_say(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    file = data_folder() / "schema" / names_of_files()[name]
    cure = f"cure: fe-contact schema {name} > data/schema/{file.name}"
    assert json.loads(file.read_text(encoding="utf-8")) == json.loads(json.dumps(published(name))), cure
    assert main(["schema", name]) == 0
    assert capsys.readouterr().out == file.read_text(encoding="utf-8"), cure


def test_an_unknown_schema_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "scenes"]) == 2
    assert "did you mean scene?" in capsys.readouterr().err


@pytest.mark.parametrize(("kind", "names"), [("scene", SCENES), ("ptmd", damper.CASES), ("pound", pounding.CASES)])
def test_every_packaged_file_is_accepted(kind: str, names: Any) -> None:
    assert names.names
    for name in names.names:
        assert not complaints(kind, tomllib.loads(names.path(name).read_text(encoding="utf-8"))), name


def test_what_a_scene_writes_of_itself_is_a_scene_file() -> None:
    for name in SCENES.names:
        assert not complaints("scene", json.loads(json.dumps(Scene.load(name).to_dict()))), name


def test_sweep_files_are_told_apart() -> None:
    good = {"scene": "polymer-sphere", "axes": {"striker": {"velocity": {"log": [0.01, 0.1], "count": 3}}}}
    assert not complaints("sweep", good)
    assert not complaints("sweep", good | {"draws": {"count": 9, "seed": 1, "striker.mass": {"normal": [1.0, 0.1]}}})
    for wrong in (
        {"scene": "polymer-sphere"},
        good | {"methods": ["fee"]},
        good | {"tolerance": 1.0},
        good | {"axis": {}},
        {"scene": "x", "axes": {"striker.velocity": {"log": [0.01, 0.1]}}},
        {"scene": "x", "draws": {"count": 0, "seed": 1}},
    ):
        assert complaints("sweep", wrong), wrong


def test_results_are_as_their_schema_says(tmp_path: Path) -> None:
    for path in sorted((data_folder() / "references").glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        if content.pop("suite", None):
            assert not complaints("result", content), path.name
    scene = Scene.load("pounding-wall-kelvin")
    simulate(laws.kelvin.of(scene), scene).write(tmp_path / "law")
    write_failure(tmp_path / "failure", scene, "kelvin", "no end")
    for folder in ("law", "failure"):
        content = json.loads((tmp_path / folder / "result.json").read_text(encoding="utf-8"))
        assert not complaints("result", content)
        assert complaints("result", content | {"quantities": {}})


def places(table: Table) -> Iterator[tuple[Table, str]]:
    for key, value in table.items():
        yield table, key
        if isinstance(value, dict):
            yield from places(value)


def mutant(rng: random.Random) -> tuple[str, Table]:
    """A packaged scene with one key misspelt, left out, or of another value, near or far."""
    table = tomllib.loads(SCENES.path(rng.choice(SCENES.names)).read_text(encoding="utf-8"))
    inside, key = rng.choice(list(places(table)))
    change = rng.choice(("misspelt", "left out", "other", "nearby"))
    value = inside.pop(key)
    if change == "misspelt":
        inside[key[:-1] + "qx"] = value
    elif change == "nearby":
        inside[key] = 1.01 * value if isinstance(value, float) else value
    elif change == "other":
        inside[key] = rng.choice(OTHERS)
    return f"{key} {change}", table


def refusals(table: Table) -> list[str] | None:
    """What the reader says of a table; None where it accepts it."""
    numerics = table.get("numerics", {})
    found = [str(fault) for fault in settings_faults(numerics, "")] if isinstance(numerics, dict) else []
    try:
        read(Scene, table)
    except BadInput as bad:
        found += [fault.message for fault in bad.faults]
    return found or None


def test_schema_and_reader_agree(campaign_size: Callable[..., int]) -> None:
    """What the reader accepts the schema accepts; a key, type or range that the reader refuses the schema refuses."""
    rng, refused, accepted = random.Random(SEED), 0, 0
    for _ in range(campaign_size(MUTANTS, 60)):
        change, table = mutant(rng)
        said, seen = refusals(table), complaints("scene", table)
        if said is None:
            assert not seen, (change, table)
            accepted += 1
        elif any(map(OF_A_KEY.search, said)):
            assert seen, (change, said, table)
            refused += 1
    assert refused > 10
    assert accepted > 5


def test_a_number_that_is_none_is_no_number() -> None:
    table = Scene.load("polymer-sphere").to_dict()
    assert complaints("scene", table | {"striker": table["striker"] | {"mass": True}})
    assert math.inf > checker("scene").schema["properties"]["striker"]["anyOf"][0]["properties"]["mass"]["maximum"]
