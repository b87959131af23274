"""Finite-element reference histories of impact, with error bars; comparison with every lumped law.

>>> import fe_contact, lumped
>>> scene = lumped.Scene.load("polymer-sphere")
>>> reference = fe_contact.run(scene, tolerance=1e-3)      # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from fe_contact.studies.sweep.table import SweepTable
    from lumped import Result, Scene

__all__ = ["run", "sweep"]
__version__ = "0.1.0"


def run(
    scene: Scene,
    tolerance: float | None = None,
    method: str | None = None,
    numerics: Mapping[str, Any] | None = None,
) -> Result:
    """One impact.

    Parameters
    ----------
    scene : a :class:`lumped.Scene`.
    tolerance : asked of every ruled quantity; None leaves it to ``numerics`` or the default 1e-3.
    method : ``fe``, ``cheapest`` or the name of a lumped law; None: the law the scene names, else ``fe``.
    numerics : settings to keep, as in the ``[numerics]`` table of a scene file. A scene is physics alone: the table of
        the file it was loaded from is read by the command line only, and has to be given here.

    Raises
    ------
    BadInput for what cannot be used, NotReached where no march came to an end.
    """
    from fe_contact.methods import simulate
    from fe_contact.threads import one_thread

    with one_thread:
        return simulate(scene, method, numerics or {}, tolerance)


def sweep(
    source: str | Path | Mapping[str, Any],
    out: str | Path | None = None,
    jobs: int = 1,
    dask: str | None = None,
    resume: bool = False,
) -> SweepTable:
    """Many scenes from one file, by one method or several.

    Parameters
    ----------
    source : path of a sweep file, or its tables; a scene is then looked for from the working folder.
    out : folder whose ``cases/`` keeps all rows as they are found; None: a temporary one.
    jobs : processes that answer, 1 for this one. More are new interpreters, which import the main script: that has to
        call this under ``if __name__ == "__main__"``.
    dask : address of a scheduler of Dask, whose workers answer instead; ``local``: one of ``jobs`` processes.
    resume : take rows that ``out`` keeps, and ask only for the others.

    Returns
    -------
    SweepTable: ``values`` and ``errors`` (cases, methods, quantities) in SI units, ``converged`` and ``refused``
    (cases, methods), ``reasons``; ``write(folder, wall)`` writes the files of the command.

    Raises
    ------
    BadInput with every fault of the file; ExtraMissing where Dask is not installed; WorkerLost where processes that
    answer die again and again. What fails with a name in one case is no error, but that case's ``reasons``.
    """
    from pathlib import Path
    from tempfile import TemporaryDirectory

    from fe_contact.studies.sweep.cases import load
    from fe_contact.studies.sweep.study import run as run_sweep

    asked = load(source)
    with TemporaryDirectory() as spare:
        return run_sweep(asked, Path(out or spare) / "cases", jobs, dask, resume)
