"""The command line: finds the command, turns every failure into one line and an exit code.

numpy, and all that needs it, is imported inside functions: where there is too little memory to load it, OpenBLAS never
comes back or a traceback would be all that a user sees.

What a signal interrupts ends like any failure, by an exception; where a library does not come back in time to raise
it, a watching thread ends the process. Either is safe: results change all at once or not at all.
"""

from __future__ import annotations

import argparse
import errno
import multiprocessing
import os
import re
import signal
import socket
import sys
import tempfile
import textwrap
import threading
import traceback
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, NoReturn

from fe_contact.progress import clear
from fe_contact.threads import one_thread

if TYPE_CHECKING:
    from fe_contact.commands.base import Command

DESCRIPTION = (
    "Impact of bodies on viscoelastic targets: finite elements with error bars, beside lumped pounding models."
)
CITATION = """the paper that it checks:
  Q. Xue, C. Zhang, J. He, G. Zou, J. Zhang, An Updated Analytical Structural Pounding Force Model Based on
  Viscoelasticity of Materials, Shock and Vibration 2016, doi 10.1155/2016/2596923; to cite the suite: CITATION.cff"""
DONE, DEFECT, BAD_INPUT, NOT_REACHED = 0, 1, 2, 3  # exit codes of the program
LEAST_MEMORY = 640 * 2**20  # bytes of address space: below, the libraries of gmsh and scipy crash while they load
SIGNALLED = 128  # plus the signal's number, as shells count: 130 after Ctrl-C, 143 after SIGTERM
GRACE = 1.0  # s for a library to come back and let Python raise the interruption
OURS = ("", "lumped", "meshes", "fe_contact")  # a module that is missing there is a defect
DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS, errno.EBADF)


class Interrupted(KeyboardInterrupt):
    """A signal asked us to end."""

    def __init__(self, number: int) -> None:
        self.exit_code = SIGNALLED + number
        super().__init__("interrupted" if number == signal.SIGINT else f"ended by {signal.Signals(number).name}")


class OneLine(argparse.ArgumentParser):
    """A parser that says what is wrong in one line, which no terminal obeys, and which known word is most like it."""

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def]  # overloaded there
        """As argparse does, but a command names its own unknown options."""
        from lumped.errors import nearest

        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            name, options = unknown[0], [one for action in self._actions for one in action.option_strings]
            said = f"no option of this command{nearest(name.partition('=')[0], options)}"
            self.error(f"{name}: {said if name.startswith('-') else 'a word more than this command takes'}")
        return found, unknown

    def error(self, message: str) -> NoReturn:
        from lumped.errors import SHOWN_OF_A_LINE, nearest, printable, shortened

        if other := re.match(r"argument COMMAND: invalid choice: '(.*?)' \(", message):
            from fe_contact.commands import COMMANDS

            message = f"{other[1]}: no command{nearest(other[1], COMMANDS.names)}"
        self.exit(BAD_INPUT, f"{self.prog}: {shortened(printable(message), SHOWN_OF_A_LINE)}; see {self.prog} --help\n")


class Versions(argparse.Action):
    """Says which versions are installed, and ends."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        from fe_contact.commands.doctor import version_line

        print(version_line())
        parser.exit()


class Overview(argparse.RawTextHelpFormatter):
    """Leaves out the list of commands, which stand below in their groups; completions take it from the parser."""

    def _iter_indented_subactions(self, action: argparse.Action) -> Generator[argparse.Action, None, None]:
        yield from ()


def parser() -> OneLine:
    """The parser of all commands."""
    from fe_contact.commands import COMMANDS

    return _parser_of(COMMANDS.members, _overview())


def _parser_for(arguments: Sequence[str]) -> OneLine:
    """The parser of the command that stands first, the others not loaded; of all, where none does."""
    from fe_contact.commands import COMMANDS

    first = arguments[0] if arguments else ""
    return _parser_of({first: COMMANDS.get(first)}) if first in COMMANDS.names else parser()


def _parser_of(members: Mapping[str, Command], epilog: str = "") -> OneLine:
    top = OneLine(prog="fe-contact", description=DESCRIPTION, epilog=epilog, formatter_class=Overview)
    top.add_argument("--version", action=Versions, nargs=0, help="versions of this suite and what it computes with")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND", help="one of those below")
    for name, command in members.items():
        command.fill(commands.add_parser(name, help=command.summary.replace("%", "%%")))
    return top


def _overview() -> str:
    """All commands in their groups, each group with an example."""
    from fe_contact.commands import COMMANDS
    from fe_contact.commands.base import GROUPS

    lines = list[str]()
    for group, example in GROUPS.items():
        own = {name: one for name, one in COMMANDS.members.items() if one.group == group}
        lines += [f"{group}, as {example}", *(_entry(name, one.summary) for name, one in own.items()), ""]
    return "\n".join([*lines, CITATION])


def _entry(name: str, summary: str) -> str:
    """A command in the overview, its summary beside it."""
    indent = " " * 15
    return textwrap.fill(summary, 100, initial_indent=f"  {name:13s}", subsequent_indent=indent)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit code."""
    if sys.stdout is None:  # files would take its place
        return _said("stdout is closed: accepted an open one, as > /dev/null", BAD_INPUT)
    if _memory_limit() < LEAST_MEMORY:
        return _said(f"out of memory; cure: a limit of {LEAST_MEMORY // 1024} kB or more (ulimit -v)", NOT_REACHED)
    from fe_contact.commands import COMMANDS

    args = _parser_for(sys.argv[1:] if arguments is None else arguments).parse_args(arguments)
    try:
        with _interruptible(), one_thread, _disk(args):
            code = COMMANDS.get(args.command).execute(args)
            sys.stdout.flush()
            return code
    except KeyboardInterrupt as interruption:
        number = SIGNALLED + signal.SIGINT
        return _said(str(interruption) or "interrupted", getattr(interruption, "exit_code", number))
    except BrokenPipeError:  # the reader of our output has left: nothing more to say, and nobody to say it to
        _leave_stdout()
        return DONE
    except Exception as failure:  # noqa: BLE001 - the one place: a traceback never reaches a user
        return _failed(failure, args)


def _disk(args: argparse.Namespace) -> AbstractContextManager[None]:
    """Known geometries are read from disk, and written, but with --no-cache."""
    if not getattr(args, "no_cache", False):
        return nullcontext()
    from fe_contact.assembly.disk_cache import without_disk

    return without_disk()


def _memory_limit() -> float:
    """Bytes of address space that this process may have."""
    if sys.platform == "win32":
        return float("inf")
    import resource

    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return float("inf") if limit == resource.RLIM_INFINITY else limit


@contextmanager
def _interruptible() -> Iterator[None]:
    """SIGINT and SIGTERM raise Interrupted; what does not end soon after is ended."""
    if threading.current_thread() is not threading.main_thread():  # Python gives signals to the main thread alone
        yield
        return
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    former = {number: signal.signal(number, _interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    wakeup, ended = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False), threading.Event()
    unraisable = sys.unraisablehook
    sys.unraisablehook = partial(_left_to_the_watch, unraisable)
    threading.Thread(target=_watch, args=(reader, ended), daemon=True).start()
    try:
        yield
    finally:
        ended.set()
        signal.set_wakeup_fd(wakeup)
        sys.unraisablehook = unraisable
        for number, handler in former.items():
            signal.signal(number, handler)
        writer.close()


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise Interrupted(number)


def _left_to_the_watch(former: Callable[[sys.UnraisableHookArgs], object], failure: sys.UnraisableHookArgs) -> None:
    """What is raised while Python cleans up goes no further: an interruption there is the watching thread's."""
    if not isinstance(failure.exc_value, Interrupted):
        former(failure)


def _watch(reader: socket.socket, ended: threading.Event) -> None:
    """Wait for the number of a signal, or for the end; a process that does not end after a signal is ended."""
    with reader:
        for number in iter(lambda: reader.recv(1), b""):
            if number[0] in (signal.SIGINT, signal.SIGTERM) and not ended.wait(GRACE):
                for worker in multiprocessing.active_children():
                    worker.kill()
                os._exit(_said(str(Interrupted(number[0])), SIGNALLED + number[0]))


def _failed(failure: Exception, args: argparse.Namespace) -> int:
    from lumped.errors import BadInput, FeContactError
    from meshes.errors import MeshError

    if isinstance(failure, BadInput):
        keys = (text.partition("=")[0].strip() for text in getattr(args, "overrides", ()))
        return _said(str(failure.told_of("--set", keys)), failure.exit_code, "")
    if isinstance(failure, FeContactError | MeshError):
        return _said(str(failure), failure.exit_code, "")
    if isinstance(failure, ModuleNotFoundError) and (failure.name or "").partition(".")[0] not in OURS:
        return _said(f"{failure.name} is not installed; cure: pip install fe-contact, with all it needs", BAD_INPUT)
    if isinstance(failure, MemoryError):
        cure = "cure: a larger --tolerance, fewer numerics.elements_per_contact, or more memory"
        return _said(f"out of memory; {cure}", NOT_REACHED)
    if isinstance(failure, OSError) and failure.filename is not None:
        return _said(f"{failure.filename}: {failure.strerror}; accepted: a folder that can be written", BAD_INPUT, "")
    if isinstance(failure, OSError) and failure.errno in DISK:
        _leave_stdout()
        return _said(f"cannot write: {failure.strerror}; accepted: a disk with room, an open stdout", BAD_INPUT)
    return _said(f"a defect of ours: {failure!r}; {_crash(failure, args)}", DEFECT)


def _said(message: str, code: int, name: str = "fe-contact: ") -> int:
    """One line on stderr, where there is one; the exit code given."""
    clear()
    with suppress(OSError, AttributeError):
        sys.stderr.write(f"{name}{message}\n")
        sys.stderr.flush()
    return code


def _leave_stdout() -> None:
    """Let Python's last flush of stdout go nowhere."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _crash(failure: Exception, args: argparse.Namespace) -> str:
    """Write crash.txt into the folder asked for, else where it can be; where it is."""
    text = "".join(traceback.format_exception(failure))
    for folder in (getattr(args, "out", None) or Path("fe-contact-out"), Path(), Path(tempfile.gettempdir())):
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "crash.txt").write_text(text, encoding="utf-8")
            return f"traceback in {folder / 'crash.txt'}"
    return "its traceback could not be written anywhere"
