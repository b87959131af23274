"""The only place that opens and closes gmsh."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from meshes.errors import GmshMissing

_ONE_AT_A_TIME = threading.Lock()  # gmsh keeps one global model a process
PLACED = 1e-6  # accuracy of a node's place on a line, in elements: gmsh's own 1e-9 costs more than all the rest


@contextmanager
def session(name: str) -> Iterator[Any]:
    """Yield the gmsh module with an empty model called ``name``; close it whatever happens.

    Sizes come from the background field alone, so that a mesh depends on its numbers only. Raises
    :class:`GmshMissing` where a system library is missing.
    ``interruptible=False`` lets it run in threads and workers, where signals cannot be installed.
    """
    gmsh = _load()
    with _ONE_AT_A_TIME:
        gmsh.initialize(interruptible=False)
        _ignore_closed_pipes()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            for source in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
                gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
            gmsh.option.setNumber("Mesh.LcIntegrationPrecision", PLACED)
            gmsh.model.add(name)
            yield gmsh
        finally:
            gmsh.finalize()


def _ignore_closed_pipes() -> None:
    """As Python does: gmsh undoes that, and then a reader who leaves would end this process without a word."""
    if sys.platform != "win32" and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGPIPE, signal.getsignal(signal.SIGPIPE))


def _load() -> Any:
    try:
        import gmsh
    except ModuleNotFoundError as failure:
        raise GmshMissing(str(failure), "pip install gmsh") from failure
    except (ImportError, OSError) as failure:
        raise GmshMissing(str(failure).splitlines()[0]) from failure
    return gmsh
