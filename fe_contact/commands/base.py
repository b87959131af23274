"""What commands share: common options, overrides, where results go, progress and what is said in the end."""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from operator import methodcaller
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, TypeVar

from fe_contact.progress import Progress, clear, log_to, terminal, to_all
from fe_contact.settings import Given, faults
from lumped.errors import BadInput, Fault, NotReached, shown
from lumped.indentation import Indentation
from lumped.result.folder import RECORD
from lumped.result.folder import publish as publish_files
from lumped.result.result import Result, worst
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.scene.tables import Model, SceneReader, reader_of
from lumped.schema import Table
from lumped.schema.files import SCENES, parse_assignment

if TYPE_CHECKING:
    from fe_contact.studies.finite_exponents import StrainedRow

AIR = 1.2  # physics: kg/m3, of air
SOFTEST = 100.0  # physics: Pa, rho g L: a centimetre of water's density would sink into itself
DONE, NOT_REACHED = 0, 3  # two of the exit codes of cli, which loads this file only when it is needed
WIDE = 88  # look: of a help that no terminal bounds
LONGEST = 80  # characters of what --set changed in a folder's name: file systems take 255 bytes with the scene's name
Read = TypeVar("Read")
Parser = TypeVar("Parser", bound=argparse.ArgumentParser)
START, LAWS, STUDIES, KEEPING = "start here", "laws and measurements", "studies", "keeping house"
GROUPS = {  # where a command stands in the help, and what to try first there
    START: "fe-contact run polymer-sphere --plot",
    LAWS: "fe-contact compare polymer-sphere --laws ting,hertz,kelvin",
    STUDIES: "fe-contact sweep sweep.toml --jobs 2",
    KEEPING: "fe-contact schema scene > scene-1.json",
}


FILE_KEYS = ("file", "scene")  # ends of the keys that hold the name of a file
option = partial(methodcaller, "add_argument")  # with argparse's names and keywords: an option, which a parser takes
SETTINGS = "set a key of the scene file, as striker.velocity=0.1"


@dataclass(frozen=True)
class Command:
    """A member of this folder: what it does, in one line; its options; and what it executes, to an exit code.

    That is 0 or 3, or 1 where an installation is broken. Raises named failures for the other codes. `example`: how it
    is called, by its name alone where that says it all; `group`: where it stands in the help.
    """

    summary: str
    options: Sequence[Callable[[argparse.ArgumentParser], object]]
    execute: Callable[[argparse.Namespace], int]
    example: str = ""
    group: str = STUDIES

    def parser(self, program: str) -> argparse.ArgumentParser:
        """What its options are read by; `program`: fe-contact and its name."""
        return self.fill(argparse.ArgumentParser(program, formatter_class=partial(argparse.HelpFormatter, width=WIDE)))

    def fill(self, parser: Parser) -> Parser:
        """The same parser with all that it says and takes."""
        for option_of in self.options:
            option_of(parser)
        parser.description = self.summary
        parser.epilog = f"example: {self.example or parser.prog}"
        return parser


def override(says: str = SETTINGS) -> methodcaller:
    """--set, as often as it is given."""
    return option("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE", help=says)


JSON = option("--json", action="store_true", help="machine-readable result on stdout")
NO_CACHE = option("--no-cache", action="store_true", help="mesh and condense anew, whatever is known on disk")
OUTPUT = (
    option("--out", type=Path, metavar="DIR", help="folder for the results, without those of a former run"),
    JSON,
    option("--quiet", action="store_true", help="no progress, no questions"),
    option("--log", metavar="FILE", help="write progress into a file, line by line"),
    NO_CACHE,
)
SCENE = (
    option("scene", help="scene file (TOML), or the name of a packaged one: fe-contact scenes"),
    option("--tolerance", metavar="T", help="relative error asked of forces, depths and times; default 1e-3"),
    override(),
)


KINEMATICS = option(
    "--kinematics",
    choices=("small", "finite"),
    default="small",
    help="finite: where each exponent leaves its small-strain value, for two energies",
)
MEASURE = option("--measure", action="store_true", help="run the larger model of each effect above the tolerance")


def quick(says: str) -> methodcaller:
    """--quick: what it leaves out."""
    return option("--quick", action="store_true", help=says)


def overrides_of(args: argparse.Namespace) -> dict[str, object]:
    """Dotted keys and the values that --set gives them, files from where the user stands; raises BadInput."""
    return {key: _from_here(key, value) for key, value in map(parse_assignment, args.overrides)}


def _from_here(key: str, value: object) -> object:
    """A value in which what names a file, but for a packaged scene, is a path from the root on."""
    if isinstance(value, dict):
        return {inner: _from_here(inner, one) for inner, one in value.items()}
    name = key.rpartition(".")[2]
    if name not in FILE_KEYS or not isinstance(value, str) or (name == "scene" and SCENES.is_name(value)):
        return value
    return str(Path(value).absolute())


def read_scene(args: argparse.Namespace) -> tuple[Scene, Table]:
    """Scene and raw settings of a command line; raises BadInput with every fault of both."""
    return _read(args, lambda reader: reader.scene(Scene))


def read_scene_for_fit(args: argparse.Namespace) -> Scene:
    """The scene of a law that is yet to be found; raises BadInput with every fault."""
    return _read(args, lambda reader: reader.scene(Scene, law_known=False))[0]


def read_indenter(args: argparse.Namespace) -> tuple[Indenter, Table]:
    """What a slow indentation needs, and raw settings; raises BadInput with every fault of both."""
    return _read(args, lambda reader: reader.indenter(Indenter))


def pairs(texts: Iterable[str], option: str, accepted: str) -> Iterator[tuple[str, str]]:
    """`KEY=VALUE`, each as a pair. Raises BadInput, which says what is `accepted`."""
    for text in texts:
        key, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not key:
            raise BadInput(Fault(option, text, accepted))
        yield key, value


def _read(args: argparse.Namespace, make: Callable[[SceneReader], tuple[Read, Table]]) -> tuple[Read, Table]:
    reader = reader_of(args.scene, overrides_of(args))
    try:
        scene, table = make(reader)
    except BadInput as bad:
        settings = reader.raw.get("numerics", {})
        refused = faults(settings, reader.source) if isinstance(settings, dict) else []
        raise BadInput([*bad.faults, *refused]) from None
    tolerance = getattr(args, "tolerance", None)
    fixed = any(text.split("=")[0].strip() == "numerics.tolerance" for text in args.overrides)
    if tolerance is not None and not fixed:
        table = {**table, "tolerance": number(tolerance, "--tolerance")}
        if refused := faults({"tolerance": table["tolerance"]}, ""):
            raise BadInput(Fault("--tolerance", "", fault.message) for fault in refused)
    return scene, table


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
    check_writable(where)
    return where


def check_writable(where: Path, option: str = "--out") -> None:
    """Raise BadInput for a folder in which nothing can be written."""
    if reason := unwritable(where):
        accepted = "accepted: a folder that can be written, its name printable"
        raise BadInput(Fault(option, str(where), f"{reason}; {accepted}"))


def unwritable(where: Path) -> str:
    """Why no file can be made in a folder, whether it is there or has to be made; empty where one can."""
    try:
        with suppress(FileNotFoundError):  # it can be made in the folder above it
            where.lstat()
        if where.is_file():
            return "it is a file"
        standing = next(place for place in (where, *where.absolute().parents) if os.path.lexists(place))
        with TemporaryFile(dir=standing):
            return "" if str(where).isprintable() else "no printable name"
    except OSError as failure:  # a name too long; a file where a folder should be
        return f"cannot be written: {failure.strerror}"
    except ValueError:  # a null byte
        return "no name of a folder"


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
            reason = getattr(failure, "strerror", None) or failure
            raise BadInput(Fault("--log", args.log, f"{reason}; accepted: a file that can be written")) from None
    if sys.stderr.isatty() and not args.quiet:
        listeners.append(terminal())
    return to_all(listeners)


@dataclass(frozen=True)
class StudyRun:
    """A study at work: its command line, the folder of its results, and who hears how far it is."""

    args: argparse.Namespace
    where: Path
    progress: Progress

    @classmethod
    def of(cls, args: argparse.Namespace, command: str, name: str) -> StudyRun:
        """Of a command on a scene or the like; raises BadInput, before any work, where nothing can be written."""
        return cls(args, folder(args, command, name), progress_of(args))

    def finish(
        self,
        record: str,
        lines: Sequence[str],
        write: Callable[[Path], object],
        plot: Callable[[Path], object],
        title: str = "",
        missed: str = "",
    ) -> int:
        """Publish files and charts, say what was found, complain of what missed its tolerance; the exit code."""

        def draw(where: Path) -> None:
            self.progress("chart")
            plot(where)

        content, told = publish(self.where, write, draw, record=record)
        say(self.args, content, [*lines, told], title)
        if missed:
            complain(missed)
        return NOT_REACHED if missed else DONE


@contextmanager
def recorded(write: Callable[[str], object]) -> Iterator[None]:
    """What comes to no end within is written, in the words of its failure, before it is told."""
    try:
        yield
    except NotReached as failure:
        write(str(failure))
        raise


def finite_exponents(args: argparse.Namespace, study: str, rows: Callable[[], Sequence[StrainedRow]]) -> int:
    """What a study says with --kinematics finite: press, compare, write, draw; the exit code."""
    from fe_contact.studies.finite_exponents import finite_exponents as compared
    from fe_contact.studies.finite_exponents import told, write_finite
    from fe_contact.studies.finite_exponents_chart import plot_finite

    run = StudyRun.of(args, study, "finite")
    found = compared(rows(), run.where, run.progress)
    write, plot = partial(write_finite, study, found), partial(plot_finite, study, found)
    return run.finish(f"{study}_finite.json", told(found), write, plot)


def publish(where: Path, *writers: Callable[[Path], object], record: str = RECORD) -> tuple[Table, str]:
    """What these leave in the folder they are given becomes the results, all at once, `record` being the JSON file that
    names them; its content, and a line that says where. Raises CannotWrite.
    """
    older = (where / record).is_file()
    content = publish_files(where, lambda folder: [write(folder) for write in writers], record)
    return content, f"written to {where}{', in place of older results' if older else ''}"


def say(args: argparse.Namespace, content: Given, lines: Sequence[str], title: str = "") -> None:
    """On stdout what was found: as JSON, or line by line, under a title indented."""
    clear()
    text = "\n  ".join([title, *lines]) if title else "\n".join(lines)
    print(json.dumps(content, allow_nan=False) if args.json else text)


def report(
    args: argparse.Namespace,
    result: Result | Indentation,
    content: Given,
    lines: Sequence[str],
    title: str,
    asked: Model,
) -> int:
    """Say what was found, warn of a tolerance not reached and of a model that is too small; the exit code.

    ``asked``: the scene's own model.
    """
    missed = "" if result.converged else result.message  # said once, on stderr
    say(args, content, [line for line in lines if line != missed], title)
    if missed:
        complain(missed)
    if not result.model_sufficient:
        complain(f"the model is too small for the tolerance: {_left_out(result, asked)}")
    for doubt in _doubts(result.indenter if isinstance(result, Indentation) else result.scene):
        complain(doubt)
    return DONE if result.converged else NOT_REACHED


def _doubts(body: Scene | Indenter) -> Iterator[str]:
    """Of the units: a modulus that no solid has, a ball lighter than air."""
    if body.material is not None:
        young = body.material.young
        least, verb = (young.equilibrium, "relaxes to") if young.glassy >= SOFTEST else (young.glassy, "is at most")
        if 0.0 < least < SOFTEST:
            told = f"{body.name}: the modulus {verb} {least:.3g} Pa, less than any solid's"
            yield f"{told}; are the values in Pa (9 GPa = 9e9)?"
    if isinstance(body, Scene) and body.shape is not None and 0.0 < body.mass < (body.shape.whole_mass(AIR) or 0.0):
        yield f"{body.name}: a whole ball of this radius would be lighter than air; are radius in m and mass in kg?"


def _left_out(result: Result | Indentation, asked: Model) -> str:
    """The largest effect left out, and its cure: another method, where a law leaves out what the scene asks for."""
    entry = worst(result.model_ledger)
    told = entry.told_of(result.ruled_force)
    if entry.key.startswith("model.") and getattr(asked, entry.key.removeprefix("model.")) == entry.value:
        return f"{told.removesuffix(entry.cure)}to include it, as the scene asks: --method fe"
    return told


def complain(message: str) -> None:
    """One line on stderr."""
    clear()
    print(f"fe-contact: {message}", file=sys.stderr)
