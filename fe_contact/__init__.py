"""Finite-element reference histories of impact, with error bars; comparison with every lumped law.

>>> import fe_contact, lumped
>>> scene = lumped.Scene.load("polymer-sphere")
>>> reference = fe_contact.run(scene, tolerance=1e-3)      # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from fe_contact.studies.sweep.table import SweepTable
    from fe_contact.studies.transfer.study import TransferStudy
    from lumped import Result, Scene

__all__ = ["run", "sweep", "transfer"]
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


def transfer(
    scene: Scene,
    laws: Sequence[str] = (),
    start: Mapping[str, float] | None = None,
    over: Mapping[str, Sequence[float]] | None = None,
    calibrate: str = "least_squares",
    tolerance: float | None = None,
    method: str | None = None,
    within: float = 0.05,
) -> TransferStudy:
    """Laws calibrated at one state of a scene and used at others.

    Parameters
    ----------
    scene : a :class:`lumped.Scene`.
    laws : names of lumped laws; none: all.
    start : dotted keys of the scene file and their values at the state of calibration; what it leaves out is the
        scene's.
    over : keys and the values that each takes, alone; None: the velocity from a third to three times.
    calibrate : ``least_squares`` on the whole history, or ``restitution``: that and the peak force alone.
    tolerance, method : of the references, as for :func:`run`.
    within : tolerance of the verdict ``within``, relative, of the restitution absolute.

    Returns
    -------
    TransferStudy: ``rows`` (law, key, value, quantity, predicted, reference, reference_error, deviation, verdict),
    ``states`` with their references, ``calibrations``, ``refused``, ``sentences``; ``write(folder)`` writes
    ``transfer.csv`` and ``transfer.json``.

    Raises
    ------
    BadInput for a state that is no scene, and what :func:`run` raises at the state of calibration. A law or a reference
    that fails elsewhere is refused there.
    """
    from fe_contact.methods import settings
    from fe_contact.studies.transfer.study import Asked
    from fe_contact.studies.transfer.study import transfer as run_transfer
    from fe_contact.threads import one_thread

    values = {key: tuple(every) for key, every in (over or {}).items()}
    asked = Asked(tuple(laws), start or {}, values, calibrate, within, method)
    with one_thread:
        return run_transfer(scene.changed, settings({}, tolerance, scene.source), asked)
