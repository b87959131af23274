"""Reading a file that a user names: no device, no pipe, nothing without end."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from lumped.errors import BadInput, Fault

# A pipe that nobody writes into opens at once, and the kernel's own files do not wait for something to say.
AT_ONCE = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def content(path: Path, most: int, kind: str) -> bytes:
    """The bytes of a regular file of at most `most` of them; `kind` says what it should be. Raises BadInput."""
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | AT_ONCE), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise BadInput(Fault(str(path), "", f"no regular file; accepted: {kind}"))
            found = file.read(most + 1) or b""
    except (OSError, ValueError) as error:  # a name with a null byte is no value for open
        reason = error.strerror if isinstance(error, OSError) else "its name cannot be one"
        raise BadInput(Fault(str(path), "", f"cannot be read: {reason or error}; accepted: {kind}")) from error
    if len(found) > most:
        raise BadInput(Fault(str(path), "", f"larger than {most} bytes; accepted: {kind}"))
    return found


def exists(path: Path) -> bool:
    """Whether there is something at this path; nothing is where no name like this can be."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
