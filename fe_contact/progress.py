"""How long work tells what it is doing, how much of it is done and how long the rest may take, to whoever listens."""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TextIO

from lumped.progress import Counted as Counted
from lumped.progress import Progress as Progress
from lumped.progress import silent as silent
from lumped.progress import uncounted as uncounted

OFTEN = 0.2  # s between two words on a terminal, as fast as anybody reads
SELDOM = 1.0  # s between two lines of a log


def to_all(listeners: Sequence[Progress]) -> Progress:
    """Several listeners as one."""

    def told(message: str, done: float = 0, total: float = 0) -> None:
        for listener in listeners:
            listener(message, done, total)

    return told if listeners else silent


@dataclass
class Count:
    """Equal parts of one work, as the steps of marches, told as they are done; ``total`` expected, 0: nobody knows."""

    progress: Progress
    message: str
    total: float
    done: float = 0.0

    @classmethod
    def of(cls, progress: Progress, message: str, total: float) -> Count:
        """Of a work that begins, which is told at once."""
        progress(message)
        return cls(progress, message, total)

    def __call__(self, parts: float = 1.0) -> None:
        """So many more are done."""
        self.done += parts
        self.progress(self.message, self.done, max(self.total, self.done) if self.total else 0.0)


@dataclass
class ProgressPace:
    """Since when the work, and the part of it that is counted now, goes on; ``pause``, s, between words of the same."""

    clock: Callable[[], float]
    pause: float

    def __post_init__(self) -> None:
        self.begun = self.spoke = self.since = self.clock()
        self.message, self.counted = "", (0.0, 0.0)

    def due(self, message: str, done: float, total: float) -> bool:
        """Whether it is time for a word: what is new, or all done, is said at once."""
        now, (before, expected) = self.clock(), self.counted
        more = done >= before and done >= total  # than was expected, where that grows with it
        if done < before or (total != expected and not more):  # another part begins
            self.since = now
        ended = done >= total > 0 and not before >= expected > 0
        again, self.message, self.counted = message == self.message, message, (done, total)
        if again and now - self.spoke < self.pause and not ended:
            return False
        self.spoke = now
        return True

    def elapsed(self) -> float:
        """S from the first moment on."""
        return self.spoke - self.begun

    def left(self, done: float, total: float) -> float | None:
        """S that the rest takes if it goes on as it did; None before anything is known."""
        passed = self.spoke - self.since
        return passed * (total - done) / done if 0 < done <= total and passed > 0.0 else None


class ProgressLine:
    """The last line of a terminal, rewritten in place, never longer than it is wide."""

    def __init__(
        self,
        stream: TextIO,
        clock: Callable[[], float] = time.monotonic,
        width: Callable[[], int] = lambda: shutil.get_terminal_size().columns,
    ) -> None:
        self._stream, self._pace, self._width, self._shown = stream, ProgressPace(clock, OFTEN), width, 0

    def __call__(self, message: str, done: float = 0, total: float = 0) -> None:
        """Tell; see :class:`Progress`."""
        global _line
        if self._pace.due(message, done, total):
            _line = self
            left = self._pace.left(done, total)
            parts = [_share(done, total)] if done or total else []
            parts += [f"about {_spoken(left)} left"] if left else []
            self._write(f"fe-contact: {', '.join([*parts, message])} ...")  # a narrow terminal cuts the message

    def clear(self) -> None:
        """Leave the line empty, as if nothing had been told."""
        self._write("")

    def _write(self, text: str) -> None:
        text = text[: max(self._width() - 1, 0)]  # a full line would wrap
        blank = " " * (self._shown - len(text))
        with suppress(OSError, ValueError):  # nobody is there to see it
            self._stream.write(f"\r{text}{blank}" if text else f"\r{blank}\r" * bool(blank))
            self._stream.flush()
        self._shown = len(text)


_line: ProgressLine | None = None  # the one that stands on the terminal


def clear() -> None:
    """Make room on the terminal for what is not progress."""
    global _line
    if _line is not None:
        _line.clear()
        _line = None


class Log:
    """A line of a file for each word, with the time of day, s since the start, what is done and about what is left."""

    def __init__(
        self,
        write: Callable[[str], object],
        clock: Callable[[], float] = time.monotonic,
        today: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        self._write, self._pace, self._today = write, ProgressPace(clock, SELDOM), today

    def __call__(self, message: str, done: float = 0, total: float = 0) -> None:
        """Tell; see :class:`Progress`."""
        if self._pace.due(message, done, total):
            left = self._pace.left(done, total)
            parts = [f"{self._today():%Y-%m-%dT%H:%M:%SZ}", f"{self._pace.elapsed():.1f} s", message]
            parts += [_share(done, total)] if done or total else []
            parts += [] if left is None else [f"about {_spoken(left)} left"]
            self._write(", ".join(parts) + "\n")


def log_to(path: Path) -> Log:
    """A log in a file made anew; raises OSError where it cannot be.

    A disk that fills up later costs the log alone, and a line on stderr.
    """
    path.write_text("", encoding="utf-8")
    failures = list[OSError]()

    def write(line: str) -> None:
        try:
            with path.open("a", encoding="utf-8") as file:
                file.write(line)
        except OSError as failure:
            if not failures:
                clear()
                sys.stderr.write(f"--log: {path}: {failure.strerror}; lines are missing there\n")
            failures.append(failure)

    return Log(write)


def terminal() -> ProgressLine:
    """The line of the terminal that stderr is."""
    return ProgressLine(sys.stderr)


def _share(done: float, total: float) -> str:
    return f"{done:.0f} of {total:.0f}" if total else f"{done:.0f}"


def _spoken(seconds: float) -> str:
    """A time to come, in the unit that people use for it."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"
