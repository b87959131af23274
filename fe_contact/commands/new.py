"""``fe-contact new``: a scene file with a comment on every key, to be changed and run.

It starts with the numbers of the packaged scene whose bodies are the ones asked for; comments are the keys' own.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from fe_contact.commands import base
from fe_contact.settings import KEYS
from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.scene.scene import Scene
from lumped.scene.tables import STRIKER_KEYS, TARGET_KEYS, Model, Motion, SceneReader
from lumped.schema import Table
from lumped.schema.files import SCENES, overridden, parse_assignment, parsed, toml_text
from lumped.schema.keys import Key, keys_of, optional
from lumped.schema.members import Folder, Member, alternatives, unavailable
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

COLUMN = 28  # look: where comments begin
FOLDERS: Mapping[str, Folder[object]] = {"striker": SHAPES, "target": TARGETS, "material": NETWORKS}
BODIES = {"striker": (SHAPES, STRIKER_KEYS), "target": (TARGETS, TARGET_KEYS)}
KINDS = ("shape", "law")  # asked for before
START = {"striker": "sphere", "target": "half_space", "material": "sls"}
MATERIALS: Mapping[str, Table] = {  # a polymer's numbers; a law that reads a file of the user's has none
    "elastic": {"E": 1.0e6},
    "kelvin_voigt": {"E": 0.6e6, "eta": 1.0e3},
    "maxwell": {"E": 0.9e6, "eta": 1.8e4},
    "sls": {"E1": 1.8e6, "E2": 0.9e6, "C1": 1.8e4},
    "prony": {"E_inf": 0.6e6, "E": [0.2e6, 0.1e6], "tau": [2.0e-3, 2.0e-2]},
    "operators": {"p": [1.0, 0.01], "q": [0.6e6, 9.0e3]},
    "fractional_zener": {"E_inf": 0.6e6, "E_glass": 0.9e6, "tau": 0.01, "alpha": 0.5},
}
SECTIONS = {"model": keys_of(Model), "motion": keys_of(Motion), "numerics": optional(KEYS)}
HEAD = (
    "Written by fe-contact new; SI units. A line that begins with # may be left out; the value in it is the default.",
    "Editors complete keys after `fe-contact schema scene > scene-1.json` and a first line `#:schema ./scene-1.json`.",
)


def execute(args: argparse.Namespace) -> int:
    """Ask on a terminal for what is not given, check, write or print; 0. Raises BadInput."""
    asking = sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty() and not args.quiet
    given = {part: getattr(args, part) for part in START}
    _check(given)
    kinds = {part: kind or _kind(part, asking) for part, kind in given.items()}
    tables = overridden(first(**kinds), base.overrides_of(args), "--set")
    if asking:
        _ask(tables)
    tables.setdefault("name", args.out.stem if args.out else "mine")
    SceneReader("new", tables).scene(Scene)
    text = commented(tables.pop("name"), tables)
    if args.out is None:
        print(text, end="")
        return base.DONE
    _write(args.out, text)
    base.say(args, {"file": str(args.out)}, [f"written to {args.out}; next: fe-contact run {args.out}"])
    return base.DONE


def first(striker: str, target: str, material: str) -> Table:
    """Tables of a scene of these kinds, with a packaged scene's numbers. Raises BadInput for a material without any."""
    if material not in MATERIALS:
        reason = f"{material}: reads a file of yours; accepted: {', '.join(MATERIALS)}, then changed by hand"
        raise BadInput(Fault("--material", "", reason))
    scenes = _packaged()
    of_striker = [one for one in scenes if _shape(one, "striker") == striker]
    of_target = [one for one in scenes if _shape(one, "target") == target]
    found = next((one for one in of_striker if one in of_target), of_target[0])
    tables = {part: dict(table) for part, table in found.items() if part not in ("name", "numerics")}
    if _shape(found, "striker") != striker:
        own = {key: value for key, value in of_striker[0]["striker"].items() if key not in (*STRIKER_KEYS, "material")}
        stays = {key: value for key, value in tables["striker"].items() if key in (*STRIKER_KEYS, "material")}
        tables["striker"] = own | stays
    if material != "elastic" and tables["target"].get("end") == "absorbing":
        tables["target"]["end"] = "free"  # waves of what relaxes are not let out
    for body in tables.values():
        known = body.get("material")
        if known is not None and known["law"] != material:
            kept = {key: known[key] for key in keys_of(Material) if key in known}
            body["material"] = {"law": material, **MATERIALS[material], **kept}
    return tables


@cache
def _packaged() -> list[Table]:
    """The packaged scenes, the plainest first."""
    return sorted((parsed(SCENES.path(name)) for name in SCENES.names), key=_apart)


def _apart(scene: Table) -> tuple[bool, bool, int]:
    """How far a packaged scene is from the plainest: without waves, on the polymer, nothing said of the model."""
    inertia = bool(scene.get("model", {}).get("inertia"))
    return inertia, not str(scene["name"]).startswith("polymer"), len(scene)


def _shape(scene: Table, part: str) -> object:
    return scene.get(part, {}).get("shape")


def commented(name: str, tables: Table) -> str:
    """A scene file: every key with its meaning, range and unit; those that are not set, behind a #."""
    lines = [f"# {line}" for line in HEAD] + [f"name = {toml_text({'x': name})[4:].strip()}"]
    for path, table, keys in _bodies(tables):
        lines += _section(path, {key: value for key, value in table.items() if key != "material"}, keys)
    for part, keys in SECTIONS.items():
        lines += _section(part, tables.get(part, {}), keys)
    return "\n".join(lines) + "\n"


def _bodies(tables: Table) -> Iterator[tuple[str, Table, Mapping[str, Key]]]:
    """The tables of both bodies and of their materials, where each stands, and its keys in the way that it is given."""
    for part, (folder, common) in BODIES.items():
        body = tables.get(part, {})
        (own,) = alternatives(folder, body.get("shape"))
        yield part, body, {"shape": Key(Member(folder.package), "which kind"), **own, **common}
        if material := body.get("material"):
            law = Key(Member(NETWORKS.package), "how it deforms")
            ways = alternatives(NETWORKS, material.get("law"))
            own = max(ways, key=lambda keys: len(keys.keys() & material.keys()))
            yield f"{part}.material", material, {"law": law, **own, **keys_of(Material)}


def _section(path: str, table: Table, keys: Mapping[str, Key]) -> Iterator[str]:
    """A table: what it holds, also of keys that nobody knows, and then what it might hold."""
    yield ""
    yield f"[{path}]" if table else f"# [{path}]"
    for name, value in table.items():
        yield _line(name, value, keys.get(name))
    for name, key in keys.items():
        if name not in table:
            yield f"# {_line(name, key.default, key, COLUMN - 2)}"


def _line(name: str, value: object, key: Key | None, column: int = COLUMN) -> str:
    """A key, its value, and what it means; a default that is none is left open."""
    shown = "..." if value in (None, ()) or value == float("inf") else toml_text({name: value}).partition(" = ")[2]
    said = "" if key is None else f" # {key.meaning}: {key.kind.accepted}"
    return f"{f'{name} = {shown.strip()}':{column - 1}s}{said}".rstrip()


def _check(given: Mapping[str, str | None]) -> None:
    """Raise BadInput for every kind that is none."""
    faults = [
        Fault(f"--{part}", "", unavailable(FOLDERS[part].names, kind))
        for part, kind in given.items()
        if kind is not None and kind not in FOLDERS[part].names
    ]
    if faults:
        raise BadInput(faults)


def _kind(part: str, asking: bool) -> str:
    """The kind of a part that is not given: answered, or the first."""
    key = Key(Member(FOLDERS[part].package), "which kind")
    return str(_answered(part, START[part], key)) if asking else START[part]


def _ask(tables: Table) -> None:
    """Ask for the numbers of both bodies and of their materials; an empty answer keeps what stands there."""
    for path, table, keys in _bodies(tables):
        for name, value in table.items():
            if name in keys and name not in KINDS:
                table[name] = _answered(f"{path}.{name}", value, keys[name])


def _answered(question: str, start: object, key: Key) -> object:
    """What a person answers, asked until it is accepted; nothing keeps `start`."""
    while True:
        sys.stderr.write(f"{question}: {key.meaning} ({key.kind.accepted}) [{start}]: ")
        sys.stderr.flush()
        text = sys.stdin.readline().strip()
        if not text:
            return start
        try:
            return key.kind.read(parse_assignment(f"answer={text}")[1])
        except ValueError:
            sys.stderr.write(f"  accepted: {key.kind.accepted}\n")


def _write(path: Path, text: str) -> None:
    """A file that was not there. Raises BadInput."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError as failure:
        raise BadInput(
            Fault("--out", str(path), "is there already; cure: another name, or remove it first")
        ) from failure
    except OSError as failure:
        reason = f"cannot be written: {failure.strerror}; accepted: a new file, in a folder that is there"
        raise BadInput(Fault("--out", str(path), reason)) from failure


MEMBER = base.Command(
    "a scene file of your own, with a comment on every key; on a terminal it asks",
    (
        base.option("--striker", metavar="KIND", help="shape of the striker, as sphere; an unknown one lists all"),
        base.option("--target", metavar="KIND", help="what it strikes, as half_space or layer"),
        base.option("--material", metavar="LAW", help="law of the material that yields, as elastic or sls"),
        base.override("a value other than the first, as striker.radius=0.01"),
        base.option("--out", type=Path, metavar="FILE", help="new file; default: on stdout"),
        base.option("--quiet", action="store_true", help="ask nothing"),
        base.JSON,
    ),
    execute,
    example="fe-contact new --striker cone --target layer --material sls --out mine.toml",
    group=base.START,
)
