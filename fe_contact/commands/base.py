"""What commands share: common options, overrides, where results go, progress and the result's print-out."""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryFile
from typing import Protocol, TypeVar

from fe_contact.progress import Progress, clear, log_to, terminal, to_all
from fe_contact.settings import Given, faults
from lumped.errors import BadInput, Fault, shown
from lumped.result.result import NO_KEY, LedgerEntry, Result, good_to, worst
from lumped.scene.file import load, load_indenter
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.files import SCENES
from lumped.schema.toml_file import overridden, parse_assignment, parsed

DONE, NOT_REACHED = 0, 3
LONGEST = 80  # characters of what --set changed in a folder's name: file systems take 255 bytes with the scene's name
Read = TypeVar("Read")


@dataclass(frozen=True)
class Command:
    """A member of this folder: what it does, in one line; what it reads; and what it executes, to an exit code 0 or 3.

    Raises named failures for the other codes.
    """

    summary: str
    arguments: Callable[[argparse.ArgumentParser], None]
    execute: Callable[[argparse.Namespace], int]


def scene_arguments(parser: argparse.ArgumentParser) -> None:
    """SCENE, --tolerance and --set."""
    parser.add_argument("scene", help="scene file (TOML), or the name of a packaged one: fe-contact scenes")
    parser.add_argument(
        "--tolerance", metavar="T", help="relative error asked of forces, depths and times; default 1e-3"
    )
    override_argument(parser)


def override_argument(
    parser: argparse.ArgumentParser, says: str = "set a key of the scene file, as striker.velocity=0.1"
) -> None:
    """--set, as often as it is given."""
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE", help=says)


def json_argument(parser: argparse.ArgumentParser) -> None:
    """--json."""
    parser.add_argument("--json", action="store_true", help="machine-readable result on stdout")


def output_arguments(parser: argparse.ArgumentParser) -> None:
    """--out, --json, --quiet and --log."""
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results")
    json_argument(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")
    parser.add_argument("--log", metavar="FILE", help="write progress into a file, line by line")


def overrides_of(args: argparse.Namespace) -> dict[str, object]:
    """Dotted keys and the values that --set gives them; raises BadInput."""
    return dict(parse_assignment(text) for text in args.overrides)


def read_scene(args: argparse.Namespace) -> tuple[Scene, Table]:
    """Scene and raw settings of a command line; raises BadInput with every fault of both."""
    return _read(args, partial(load, Scene))


def read_scene_for_fit(args: argparse.Namespace) -> Scene:
    """The scene of a law that is yet to be found; raises BadInput with every fault."""
    return _read(args, partial(load, Scene, law_known=False))[0]


def read_indenter(args: argparse.Namespace) -> tuple[Indenter, Table]:
    """What a slow indentation needs, and raw settings; raises BadInput with every fault of both."""
    return _read(args, partial(load_indenter, Indenter))


def _read(args: argparse.Namespace, reader: Callable[..., tuple[Read, Table]]) -> tuple[Read, Table]:
    overrides = overrides_of(args)
    try:
        scene, table = reader(args.scene, overrides)
    except BadInput as bad:
        raise BadInput([*bad.faults, *_settings_faults(args.scene, overrides)]) from None
    tolerance = getattr(args, "tolerance", None)
    fixed = any(text.split("=")[0].strip() == "numerics.tolerance" for text in args.overrides)
    if tolerance is not None and not fixed:
        table = {**table, "tolerance": number(tolerance, "--tolerance")}
        if refused := faults({"tolerance": table["tolerance"]}, ""):
            raise BadInput(Fault("--tolerance", "", fault.message) for fault in refused)
    return scene, table


def _settings_faults(scene: str, overrides: dict[str, object]) -> list[Fault]:
    """Faults of the settings in a scene file whose physics is faulty too."""
    try:
        path = SCENES.resolved(scene)
        table = overridden(parsed(path), overrides, path.name).get("numerics", {})
    except BadInput:  # no TOML at all, which has been said
        return []
    return faults(table, path.name) if isinstance(table, dict) else []


def number(text: str, option: str) -> float:
    """A number given on the command line; raises BadInput."""
    try:
        return float(text)
    except ValueError:
        raise BadInput(Fault(option, "", f"{shown(text)}: accepted a number")) from None


def folder(args: argparse.Namespace, command: str, name: str) -> Path:
    """Where the results of a command on a scene or the like go, by its name and what --set changed.

    Raises BadInput, before any work, where nothing can be written.
    """
    chosen: Path | None = args.out
    overrides = (text for text in getattr(args, "overrides", ()) if text.partition("=")[0].strip() != "name")
    changes = "".join(f"-{text}" for text in overrides)
    where = chosen or Path("fe-contact-out") / (f"{command}-{name}" + _part_of_a_name(changes))
    if not _writable(where):
        raise BadInput(Fault("--out", str(where), "accepted: a folder that can be written, its name printable"))
    return where


def _writable(where: Path) -> bool:
    """Whether a folder is there, or can be made, in which files can be made."""
    try:
        with suppress(FileNotFoundError):  # it can be made in the folder above it
            where.lstat()
        standing = next(place for place in (where, *where.absolute().parents) if os.path.lexists(place))
        with TemporaryFile(dir=standing):
            return str(where).isprintable()
    except (OSError, ValueError):  # a name too long, or with a null byte; a file where a folder should be
        return False


def _part_of_a_name(text: str) -> str:
    """The text as it may stand in a file's name; told from every other by a checksum where it may not stand whole."""
    plain = re.sub(r"[^\w.=+-]+", "_", text)
    if plain == text and len(text) <= LONGEST:
        return text
    return f"{plain[:LONGEST]}-{hashlib.sha256(text.encode(errors='surrogateescape')).hexdigest()[:8]}"


def progress_of(args: argparse.Namespace) -> Progress:
    """Progress in the last line of a terminal, but not with --quiet, and into the file of --log.

    Raises BadInput, before any work, where that cannot be written.
    """
    listeners = list[Progress]()
    if args.log is not None:
        try:
            listeners.append(log_to(Path(args.log)))
        except (OSError, ValueError) as failure:  # a name with a null character is none
            raise BadInput(Fault("--log", args.log, f"{failure}: accepted a file that can be written")) from None
    if sys.stderr.isatty() and not args.quiet:
        listeners.append(terminal())
    return to_all(listeners)


def tell(args: argparse.Namespace, content: Given, lines: Sequence[str], where: Path, title: str = "") -> None:
    """On stdout what was found: as JSON, or line by line, under a title indented, and where it was written."""
    clear()
    if args.json:
        print(json.dumps(content, allow_nan=False))
    else:
        told = [*lines, f"written to {where}"]
        print("\n  ".join([title, *told]) if title else "\n".join(told))


def report(args: argparse.Namespace, result: Result, content: Given, where: Path) -> int:
    """Print a result, or the content of its file, warn of what the model lacks; the exit code."""
    clear()
    if args.json:
        print(json.dumps(content, allow_nan=False))
    else:
        print(summary(result, where))
    warn(result)
    return DONE if result.converged else NOT_REACHED


class Judged(Protocol):
    """What a result tells of itself."""

    @property
    def converged(self) -> bool: ...

    @property
    def message(self) -> str: ...

    @property
    def model_sufficient(self) -> bool: ...

    @property
    def model_ledger(self) -> Sequence[LedgerEntry]: ...


def warn(result: Judged) -> None:
    """One line each on stderr: a tolerance not reached, a model that is too small."""
    if not result.converged:
        complain(result.message)
    if not result.model_sufficient:
        most = worst(result.model_ledger)
        complain(
            f"model too small for the tolerance: {most.effect}, {most.treated}, "
            f"about {most.estimate:.2g} of the peak force; {'; '.join(filter(None, (most.note, most.key or NO_KEY)))}"
        )


def complain(message: str) -> None:
    """One line on stderr."""
    clear()
    print(f"fe-contact: {message}", file=sys.stderr)


def summary(result: Result, where: Path) -> str:
    """Quantities with their error bars, one a line."""
    lines = [f"{result.scene.name}: {result.method}, tolerance {result.tolerance:g}"]
    for name, quantity in result.quantities.items():
        if quantity.value is None:
            lines.append(f"  {name:13s} undefined: no separation")
        else:
            lines.append(f"  {name:13s} {quantity.value:.6g} +- {quantity.error or 0.0:.1e} {quantity.unit}")
    lines += [_contact(number, contact) for number, contact in enumerate(result.contacts, start=1)]
    if result.contacts and result.converged and result.message:
        lines.append(f"  {result.message}")
    lines += [f"  {line}" for line in (good_to(result.model_ledger),) if line]
    return "\n".join([*lines, f"  written to {where}"])


def _contact(number: int, contact: Mapping[str, float | None]) -> str:
    """One of several contacts in a line."""
    names = {"duration": "s", "restitution": "", "peak_force": "N"}
    told = [f"{name} {contact[name]:.6g} {unit}".rstrip() for name, unit in names.items() if contact[name] is not None]
    return f"  contact {number} at {contact['start']:.6g} s: {', '.join(told)}"
