"""JSON Schemas (draft 7, which editors know) of every file that a user writes, and of result.json.

They are written of the keys which readers check by, so that editor, reader and error text say one thing. What no schema
says (bodies that cannot meet, materials that cannot be) is the reader's alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from fe_contact import settings
from fe_contact.studies.sweep import cases
from lumped.errors import BadInput, Fault, nearest
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.pounding import case_file as pounding
from lumped.pounding.frames import Gap, ShearFrame, Slab
from lumped.pounding.gap_laws import GapLaw
from lumped.ptmd import case_file as damper
from lumped.ptmd.free_vibration import TIME_KEYS
from lumped.ptmd.system import Oscillator
from lumped.result.result import ENERGY_TERMS, UNITS
from lumped.scene.tables import LAWS, NAME_KEYS, STRIKER_KEYS, TARGET_KEYS, Model, Motion
from lumped.schema import Table
from lumped.schema.keys import Key, keys_of
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

VERSION = 1  # of the schemas: counted up when a file that was accepted no longer is
Keys = Mapping[str, Key]


def names_of_files() -> Mapping[str, str]:
    """By name, the file that holds a schema."""
    return {name: f"{name}-{VERSION}.json" for name in SCHEMAS}


def published(name: str) -> Table:
    """The schema called so, whole. Raises BadInput for a name that is none."""
    if name not in SCHEMAS:
        raise BadInput(Fault(name, "", f"no schema; accepted: {', '.join(SCHEMAS)}{nearest(name, tuple(SCHEMAS))}"))
    head = {"$schema": "http://json-schema.org/draft-07/schema#", "$id": f"urn:fe-contact:{name}:{VERSION}"}
    return head | {"title": f"fe-contact {name}"} | SCHEMAS[name]()


def of_key(key: Key) -> Table:
    """What a key accepts, what it means, and its default."""
    found = key.kind.schema | {"description": f"{key.meaning}; {key.kind.accepted}".lstrip("; ")}
    told = isinstance(key.default, str | int | float) and (isinstance(key.default, str) or math.isfinite(key.default))
    return found | ({"default": key.default} if told else {})


def of_keys(keys: Keys, inside: Mapping[str, Table] | None = None, required: Iterable[str] = ()) -> Table:
    """A table of these keys and no other but the tables `inside` it."""
    needed = [name for name, key in keys.items() if key.required] + [*required]
    known = {name: of_key(key) for name, key in keys.items()} | dict(inside or {})
    return {"type": "object", "properties": known, "required": needed, "additionalProperties": False}


def one_of(kind: str, options: Mapping[str, Iterable[Table]]) -> Table:
    """Tables told apart by the name which each has under `kind`."""
    found = []
    for name, tables in options.items():
        for table in tables:
            known = {kind: {"const": name}, **table["properties"]}
            found.append(table | {"properties": known, "required": [kind, *table["required"]]})
    return {"anyOf": found}


def material() -> Table:
    """The table of a material, law by law."""
    shared = keys_of(Material)
    laws = {name: [of_keys({**own, **shared}) for own in law.sets] for name, law in NETWORKS.members.items()}
    return one_of("law", laws)


def law() -> Table:
    """The table of a lumped law."""
    return one_of("name", {name: [of_keys(keys) for keys in member.sets] for name, member in LAWS.members.items()})


def scene() -> Table:
    """A scene file: bodies with a geometry, or masses and a law alone."""
    yielding, masses = {"material": REFERENCES["material"]}, {"not": {"required": ["shape"]}}
    shapes = {
        name: [of_keys({**STRIKER_KEYS, **keys}, yielding) for keys in shape.sets]
        for name, shape in SHAPES.members.items()
    }
    targets = {
        name: [
            of_keys({**TARGET_KEYS, **keys}, yielding, ["material"])
            if target.kind.deformable
            else of_keys({**TARGET_KEYS, **keys})
            for keys in target.sets
        ]
        for name, target in TARGETS.members.items()
    }
    striker, target = one_of("shape", shapes), one_of("shape", targets)
    tables: dict[str, Table] = {
        "striker": {"anyOf": [*striker["anyOf"], of_keys(STRIKER_KEYS)]},
        "target": {"anyOf": [*target["anyOf"], of_keys(TARGET_KEYS)]},
        "model": of_keys(keys_of(Model)),
        "motion": of_keys(keys_of(Motion)),
        "law": REFERENCES["law"],
        "numerics": of_keys({name: replace(key, required=False) for name, key in settings.KEYS.items()}),
    }
    bodies = {name: {"required": ["shape"]} for name in ("striker", "target")}
    alone = {"striker": masses, "target": masses}
    kinds = [{"required": ["target"], "properties": bodies}, {"required": ["law"], "properties": alone}]
    rigid = [name for name, target in TARGETS.members.items() if not target.kind.deformable]
    on_rigid = {"if": _part("target", {"shape": {"enum": rigid}}), "then": _part("striker", {"material": {}})}
    known = {"anyOf": kinds, **on_rigid, "definitions": definitions("material", "law")}
    return of_keys(NAME_KEYS, tables, ["striker"]) | known


def sweep() -> Table:
    """A sweep file: keys of its scene by dotted names, or in tables in tables."""
    pair = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
    count = {"type": "integer", "minimum": 1, "maximum": cases.MOST_VALUES}
    ranges = [_whole({kind: pair, "count": count}) for kind in cases.RANGES]
    draws = [_whole({kind: pair}) for kind in cases.DRAWS]
    drawn: Table = of_keys(cases.DRAW_KEYS, {"correlation": {"type": "array", "items": {"type": "array"}}})
    tables: dict[str, Table] = {
        "axes": _nested("values"),
        "zipped": _nested("values"),
        "draws": drawn | {"additionalProperties": _reference("drawn")},
    }
    known = {
        "values": {"anyOf": [{"type": "array", "minItems": 1}, *ranges, _nested("values")]},
        "drawn": {"anyOf": [*draws, _nested("drawn")]},
    }
    varied = [{"required": [name]} for name in tables]
    plain = {name: key for name, key in cases.KEYS.items() if name not in tables}
    return of_keys(plain, tables) | {"anyOf": varied, "definitions": known}


def ptmd() -> Table:
    """A file of a pounding tuned mass damper."""
    lining = {"material": REFERENCES["material"]}
    rings = [of_keys({**damper.SIZE_KEYS, **keys}, lining, ["material"]) for keys in damper.LAW_KEYS]
    starts = [of_keys({**keys, **TIME_KEYS}) for keys in (damper.RELEASE_KEYS, damper.START_KEYS)]
    body = of_keys(keys_of(Oscillator))
    tables = {"structure": body, "damper": body, "ring": {"anyOf": rings}, "motion": {"anyOf": starts}}
    return of_keys(NAME_KEYS, tables, ["structure", "motion"]) | {"definitions": definitions("material")}


def pound() -> Table:
    """A file of pounding frames."""
    frame = of_keys(keys_of(ShearFrame))
    named: Table = {"type": "object", "maxProperties": pounding.MOST_GAPS}
    shared = {"velocity": keys_of(GapLaw)["velocity"], "scene": pounding.SCENE_KEY}
    laws = {
        name: [of_keys({key: one for key, one in keys.items() if key != "gap"} | shared) for keys in member.sets]
        for name, member in LAWS.members.items()
    }
    frames: Table = {"type": "object", "properties": {"left": frame, "right": frame}, "required": ["left"]}
    tables: dict[str, Table] = {
        "structure": frames | {"additionalProperties": False},
        "gap": named | {"additionalProperties": of_keys(keys_of(Gap))},
        "slab": named | {"additionalProperties": of_keys(keys_of(Slab))},
        "law": one_of("name", laws),
        "ground": one_of("kind", {kind: [of_keys(keys)] for kind, keys in pounding.GROUNDS.items()}),
        "motion": of_keys(pounding.MOTION_KEYS),
    }
    return of_keys(NAME_KEYS, tables, ["structure", "motion"])


NUMBER: Table = {"type": ["number", "null"]}
NUMBERS: Table = {"type": "object", "additionalProperties": NUMBER}
TEXT: Table = {"type": "string"}
FLAG: Table = {"type": "boolean"}
ANY_TABLE: Table = {"type": "object"}
VERDICTS = ("within tolerance", "above it", "open", "unknown")

ENTRY: Mapping[str, tuple[Table, str]] = {
    "effect": (TEXT, "what the model leaves out"),
    "treated": (TEXT, "how this run treats it"),
    "estimate": (NUMBER, "its effect over the peak force; null where unknown"),
    "note": (TEXT, "what the estimate rests on"),
    "key": (TEXT, "of the scene file, which selects the larger model; empty where there is none"),
    "value": ({"type": ["boolean", "number", "string", "null"]}, "of this key: what selects the larger model"),
    "spread": ({"type": ["array", "null"], "items": {"type": "number"}}, "lowest and highest, where the scene is open"),
    "verdict": ({**TEXT, "pattern": f"^({'|'.join(VERDICTS)})"}, "whether it may be left out at this tolerance"),
}
RESULT: Mapping[str, tuple[Table, str]] = {
    "schema": ({"const": "fe-contact/result/1"}, "what this file is"),
    "method": (TEXT, "fe, or the law that answered"),
    "weighed": (
        {"type": "array", "items": ANY_TABLE},
        "every method, its bar and cost, where the cheapest was asked",
    ),
    "converged": (FLAG, "whether the tolerance was reached"),
    "separated": (FLAG, "whether the bodies parted before the end time"),
    "model_sufficient": ({"type": ["boolean", "null"]}, "whether no effect left out exceeds the tolerance"),
    "tolerance": ({"type": "number"}, "asked of every ruled quantity"),
    "message": (TEXT, "why it did not converge or separate, in words"),
    "scene": (ANY_TABLE, "the scene as it was resolved: a scene file's tables"),
    "model": (
        of_keys(keys_of(Model)) | {"additionalProperties": TEXT},
        "the model as it was resolved, with finite kinematics the energy too; every claimed error refers to it",
    ),
    "numerics": (ANY_TABLE, "settings that answered"),
    "quantities": (ANY_TABLE, "value, error (absolute half-width) and unit of each; null where undefined"),
    "dimensionless": (ANY_TABLE, "groups without units, and the scales F0 and T0 of the elastic impact"),
    "contacts": ({"type": "array", "items": NUMBERS}, "each of several contacts: start, duration, restitution ..."),
    "recovery": ({"type": ["object", "null"]}, "the dent after separation: residual and permanent depth, m"),
    "error_budget": (NUMBERS, "by cause, over the peak force"),
    "error_budget_by_quantity": ({"type": "object", "additionalProperties": NUMBERS}, "by cause and quantity"),
    "model_ledger": ({"type": "array", "items": ANY_TABLE}, "every effect left out, its estimate and verdict"),
    "energy": (NUMBERS, "J, each term computed on its own; residual is what is left"),
    "energy_error": (NUMBERS, "J, bars of these terms"),
    "work": (NUMBERS, "counted work: solves, evaluations, steps"),
    "provenance": (ANY_TABLE, "versions of what computed it"),
    "timing": (ANY_TABLE, "seconds it took"),
    "files": (ANY_TABLE, "the other files of the folder, with their SHA-256"),
}
ALWAYS = ("schema", "method", "converged", "separated", "model_sufficient", "message", "scene", "model", "quantities")


def result() -> Table:
    """What an impact leaves: result.json."""
    quantity = {
        name: _whole({"value": NUMBER, "error": NUMBER, "unit": {"const": unit}}) for name, unit in UNITS.items()
    }
    exact = {
        "quantities": _whole(quantity),
        "model_ledger": {"type": "array", "items": _told(ENTRY, (*(name for name in ENTRY if name != "value"),))},
        "energy": _whole(dict.fromkeys(ENERGY_TERMS, NUMBER), plastic=NUMBER),
    }
    return _told({name: (exact.get(name, kind), says) for name, (kind, says) in RESULT.items()}, ALWAYS)


SCHEMAS: Mapping[str, Callable[[], Table]] = {
    "scene": scene, "sweep": sweep, "ptmd": ptmd, "pound": pound, "result": result,
}  # fmt: skip


def definitions(*names: str) -> Table:
    """What several tables of a schema refer to."""
    makers = {"material": material, "law": law}
    return {name: makers[name]() for name in names}


def _told(keys: Mapping[str, tuple[Table, str]], required: tuple[str, ...]) -> Table:
    """A table of what results say, each with its meaning."""
    known = {name: kind | {"description": says} for name, (kind, says) in keys.items()}
    return {"type": "object", "properties": known, "required": [*required], "additionalProperties": False}


def _whole(properties: Mapping[str, Table], **more: Table) -> Table:
    """A table of all these keys, and of no other but perhaps ``more``."""
    known = {**properties, **more}
    return {"type": "object", "properties": known, "required": [*properties], "additionalProperties": False}


def _part(table: str, inside: Table) -> Table:
    """Files whose table has all these keys."""
    return {"required": [table], "properties": {table: {"required": [*inside], "properties": inside}}}


def _nested(name: str) -> Table:
    """Keys of a scene as tables in tables; none is called as a range is."""
    words = {"not": {"enum": [*cases.RANGES, *cases.DRAWS, "count"]}}
    return {"type": "object", "propertyNames": words, "additionalProperties": _reference(name)}


def _reference(name: str) -> Table:
    return {"$ref": f"#/definitions/{name}"}


REFERENCES: Mapping[str, Table] = {name: _reference(name) for name in ("material", "law")}
