"""The command line: finds the command, turns every failure into one line and an exit code."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from fe_contact import __version__
from fe_contact.commands import base
from lumped.errors import SHOWN_OF_A_LINE, FeContactError, printable, shortened
from lumped.members import available, get

COMMANDS = "fe_contact.commands"
DEFECT, BAD_INPUT, INTERRUPTED = 1, 2, 130


class OneLine(argparse.ArgumentParser):
    """A parser that says what is wrong in one line, which no terminal obeys."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {shortened(printable(message), SHOWN_OF_A_LINE)}; see {self.prog} --help\n")


def parser() -> OneLine:
    """The parser of all commands."""
    top = OneLine(prog="fe-contact", description="Finite-element contact validation suite.")
    top.add_argument("--version", action="version", version=f"fe-contact {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in available(COMMANDS):
        module = get(COMMANDS, name)
        module.arguments(commands.add_parser(name, help=module.SUMMARY.replace("%", "%%"), description=module.SUMMARY))
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit code."""
    args = parser().parse_args(arguments)
    try:
        code: int = get(COMMANDS, args.command).execute(args)
        return code
    except KeyboardInterrupt:
        print("fe-contact: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader of our output has left: nothing more to say, and nobody to say it to
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return base.DONE
    except Exception as failure:  # noqa: BLE001 - the one place: a traceback never reaches a user
        return _failed(failure, args)


def _failed(failure: Exception, args: argparse.Namespace) -> int:
    from meshes.errors import MeshError

    if isinstance(failure, FeContactError | MeshError):
        print(failure, file=sys.stderr)
        return failure.exit_code
    if isinstance(failure, OSError) and failure.filename is not None:
        print(f"{failure.filename}: {failure.strerror}; accepted: a folder that can be written", file=sys.stderr)
        return BAD_INPUT
    where = _crash_folder(args) / "crash.txt"
    where.write_text("".join(traceback.format_exception(failure)), encoding="utf-8")
    print(f"fe-contact: a defect of ours: {failure!r}; traceback in {where}", file=sys.stderr)
    return DEFECT


def _crash_folder(args: argparse.Namespace) -> Path:
    """A folder for the traceback: the asked one if it can be made, else the working folder."""
    folder = getattr(args, "out", None) or Path("fe-contact-out")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path()
    return Path(folder)
