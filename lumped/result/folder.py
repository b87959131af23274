"""A folder of results: the files of a run become its files all at once, or the older ones stay, whole.

Files are first written into a hidden folder inside it. Then every final name becomes a link through one more link,
`now`, which points at the older files; `now` is made to point at the new ones, in one step of the file system; and
every link gives way to its file. Whenever a process is killed, each name reads as one result, the older or the newer,
and the next to write tidies up. A file system without links has the files replaced one by one, the record last.

The record is the JSON file that names all others with their checksums: only what the record of a former run names,
and nobody has changed since, is ever removed.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from lumped.errors import CannotWrite
from lumped.schema import Table
from lumped.schema.json_file import write_json

RECORD = "result.json"
SCHEMAS = "fe-contact/"  # how the schema of each of our records begins
HIDDEN = ".fe-contact-"
LOCK = ".fe-contact.lock"
WAIT, PAUSE = 300.0, 0.02  # s for other runs to end their writing, some seconds each with charts; between two looks
NO_LINKS = (errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EXDEV, errno.EMLINK)


def publish(directory: Path, write: Callable[[Path], object], record: str = RECORD) -> Table:
    """Make what `write` writes into a folder the content of `directory`, made where it is not; the record's content.

    `write` is given an empty folder and leaves files in it, among them the JSON file `record`, which then names the
    others: `files`, SHA-256 by name. Another run that writes into the same directory is waited for. Raises CannotWrite
    where the disk or its permissions refuse, or the other run does not end; nothing has changed then.
    """
    new = not directory.exists()
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with _alone(directory):
            _settle(directory)
            hidden = Path(tempfile.mkdtemp(prefix=HIDDEN, dir=directory))
            try:
                return _published(directory, hidden, write, record)
            finally:
                _settle(directory)
    except OSError as failure:
        if new:
            with suppress(OSError):
                directory.rmdir()
        raise CannotWrite(directory, failure.strerror or str(failure)) from failure


def _published(directory: Path, hidden: Path, write: Callable[[Path], object], record: str) -> Table:
    older, newer = hidden / "older", hidden / "newer"
    older.mkdir()
    newer.mkdir()
    write(newer)
    content: Table = json.loads((newer / record).read_text(encoding="utf-8"))
    names = sorted(path.name for path in newer.iterdir() if path.name != record)
    for name in (*names, record):
        if (directory / name).is_dir():
            raise IsADirectoryError(errno.EISDIR, f"{name} is a folder")
    content["files"] = {name: checksum(newer / name) for name in names}
    write_json(newer / record, content)
    for path in (*newer.iterdir(), newer, hidden, directory):
        _to_disk(path)
    _exchange(directory, hidden, [*names, record], sorted(_left(directory) - {*names, record}))
    _to_disk(directory)
    return content


def _exchange(directory: Path, hidden: Path, names: list[str], left: list[str]) -> None:
    """The new files for the older ones; those `left` by a former run go."""
    try:
        for name in (*names, *left):
            if (directory / name).exists():
                os.link(directory / name, hidden / "older" / name)
        (hidden / "now").symlink_to("older")
    except OSError as failure:
        if failure.errno not in NO_LINKS:
            raise
        for name in names:
            (hidden / "newer" / name).replace(directory / name)
        for name in left:
            (directory / name).unlink()
        return
    for name in (*names, *left):
        (hidden / "link").symlink_to(Path(hidden.name, "now", name))
        (hidden / "link").replace(directory / name)
    (hidden / "next").symlink_to("newer")
    (hidden / "next").replace(hidden / "now")
    # what is still a link gives way to its file where the folder is settled


def _settle(directory: Path) -> None:
    """Give every link of a run that ended, or was killed, its file, and remove what else it left."""
    for hidden in directory.glob(f"{HIDDEN}*"):
        for path in _linked(directory, hidden):
            try:
                (hidden / "now" / path.name).replace(path)
            except FileNotFoundError:  # the result that counts has no such file
                path.unlink()
        shutil.rmtree(hidden, ignore_errors=True)


def _linked(directory: Path, hidden: Path) -> list[Path]:
    links = [path for path in directory.iterdir() if path.is_symlink()]
    return [path for path in links if path.readlink().parts[:-1] == (hidden.name, "now")]


def _left(directory: Path) -> set[str]:
    """Names of what former runs left: their records, and each file that a record names and nobody has changed."""
    found = set[str]()
    for path in directory.glob("*.json"):
        files = _files(path)
        if files is not None:
            found |= {path.name, *(name for name, known in files.items() if _same(directory, name, known))}
    return found


def _files(path: Path) -> Mapping[str, object] | None:
    """What a record of ours names; None for any other file."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError, OSError):
        return None
    ours = isinstance(content, dict) and str(content.get("schema")).startswith(SCHEMAS)
    files = content.get("files") if ours else None
    return files if isinstance(files, dict) else None


def _same(directory: Path, name: str, known: object) -> bool:
    path = directory / name
    return Path(name).name == name and path.is_file() and checksum(path) == known


def checksum(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _to_disk(path: Path) -> None:
    """Wait until a file, or the names in a folder, would survive a loss of power."""
    if os.name == "nt" and path.is_dir():  # Windows opens no folder
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def _alone(directory: Path) -> Iterator[None]:
    """Hold the directory's lock, which ends with its owner; raises CannotWrite where another run keeps it."""
    lock, until = directory / LOCK, time.monotonic() + WAIT
    while (handle := _locked(lock)) is None:
        if time.monotonic() > until:
            raise CannotWrite(directory, f"another run has been writing here for {WAIT:g} s")
        time.sleep(PAUSE)
    try:
        yield
    finally:
        lock.unlink(missing_ok=True)
        os.close(handle)


def _locked(lock: Path) -> int | None:
    """A handle that holds the lock; None while another process does."""
    handle = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        if _claim(handle) and os.path.samestat(os.fstat(handle), lock.stat()):
            return handle
    except FileNotFoundError:  # its former owner removed it meanwhile
        pass
    os.close(handle)
    return None


def _claim(handle: int) -> bool:
    """Whether nobody else holds the lock of this handle, which is now ours."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as failure:
        if failure.errno in (errno.EWOULDBLOCK, errno.EACCES, errno.EDEADLK):
            return False
        raise
    return True
