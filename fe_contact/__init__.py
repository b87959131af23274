"""Finite-element reference histories of impact, with error bars; comparison with every lumped law.

>>> import fe_contact, lumped
>>> scene = lumped.Scene.load("polymer-sphere")
>>> reference = fe_contact.run(scene, tolerance=1e-3)      # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fe_contact.threads import one_thread

if TYPE_CHECKING:
    from fe_contact.studies.compare.study import Comparison
    from fe_contact.studies.sweep.table import SweepTable
    from fe_contact.studies.table1.study import Trial
    from fe_contact.studies.tradeoff.study import Tradeoff
    from fe_contact.studies.transfer.study import TransferStudy
    from fe_contact.studies.validate.base import Report
    from lumped import Fit, History, Result, Scene
    from lumped.indentation import Indentation
    from lumped.result.score import Curve
    from lumped.schema import Table

__all__ = ["compare", "fit", "indent", "plot", "run", "sweep", "table1", "tradeoff", "transfer", "validate"]
__version__ = "0.1.0"


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def run(
    scene: Scene | str | Path,
    tolerance: float | None = None,
    method: str | None = None,
    numerics: Mapping[str, Any] | None = None,
) -> Result:
    """One impact.

    Parameters
    ----------
    scene : a :class:`lumped.Scene`; or a scene file, whose ``[numerics]`` count too, or the name of a packaged one.
    tolerance : asked of every ruled quantity; None leaves it to ``numerics`` or the default 1e-3.
    method : ``fe``, ``cheapest`` or the name of a lumped law; None: the law the scene names, else ``fe``.
    numerics : settings to keep, as in the ``[numerics]`` table of a scene file. A :class:`lumped.Scene` is physics
        alone: the table of the file it was loaded from is not in it.

    Raises
    ------
    BadInput for what cannot be used, NotReached where no march came to an end.
    """
    from fe_contact.methods import simulate

    known, table = _read(scene)
    with one_thread:
        return simulate(known, method, {**table, **(numerics or {})}, tolerance)


def indent(
    scene: Scene | str | Path, depths: Sequence[float], tolerance: float | None = None, instant: bool = False
) -> Indentation:
    """Slow indentation by finite elements.

    Parameters
    ----------
    scene : as for :func:`run`; mass and velocity of a file may be missing.
    depths : m.
    tolerance : relative, asked of every force.
    instant : the material against a sudden indentation, not the relaxed one.

    Returns
    -------
    Indentation: ``depth`` m, ``force`` N, ``force_error`` N, ``contact_radius`` m, each (n,); from three depths on
    ``quantities`` with ``alpha`` and ``D``.

    Raises
    ------
    BadInput for depths and materials that cannot be, NotReached where contact does not settle.
    """
    from fe_contact.indentation import indent as press
    from fe_contact.indentation import indenter_of
    from fe_contact.methods import settings
    from lumped import Scene
    from lumped.scene.indenter import Indenter
    from lumped.scene.tables import load_indenter

    table: Table = {}
    if isinstance(scene, Scene):
        indenter = indenter_of(scene)
    else:
        indenter, table = load_indenter(Indenter, scene)
    return press(indenter, tuple(depths), settings(table, tolerance, indenter.source), instant)


def compare(
    scene: Scene | str | Path,
    laws: Sequence[str] = (),
    measured: str | Path | None = None,
    tolerance: float | None = None,
) -> Comparison:
    """The finite-element reference against lumped laws and a measured curve.

    Parameters
    ----------
    scene : as for :func:`run`.
    laws : names of lumped laws; none: all.
    measured : a CSV file with a time and a force.
    tolerance : of the reference, as for :func:`run`.

    Returns
    -------
    Comparison: ``reference`` and ``laws`` (results), ``judgements``, ``refused`` with the reasons.

    Raises
    ------
    BadInput for an unknown law or a spoiled curve, and what :func:`run` raises.
    """
    from fe_contact.methods import settings
    from fe_contact.studies.compare.study import compared
    from lumped.laws import available
    from lumped.result.curve_file import read_curve

    known, table = _read(scene)
    given = settings(table, tolerance, known.source)
    curve = None if measured is None else read_curve(Path(measured))
    with one_thread:
        return compared(known, given, tuple(laws) or available(), curve)


def fit(
    curve: str | Path | History | Curve,
    law: str,
    scene: Scene | str | Path,
    free: Sequence[str] | None = None,
    peak: bool = False,
) -> Fit:
    """Parameters of a law from a force history.

    Parameters
    ----------
    curve : a CSV file with a time and a force, or what has both.
    law : name of a lumped law.
    scene : as for :func:`run`: mass, velocity, geometry.
    free : parameters to find; None: stiffness and damping; ``touch``: when the bodies meet, s.
    peak : least error at equal peak force, as "(26)".

    Raises
    ------
    BadInput for a curve that cannot be one, NotReached where no search converges.
    """
    from lumped import fit as fit_law
    from lumped.result.curve_file import read_curve

    rows = read_curve(Path(curve)) if isinstance(curve, str | Path) else curve
    return fit_law(rows, law, _read(scene)[0], free, peak=peak)


def table1(out: str | Path | None = None, jobs: int = 2) -> tuple[Trial, ...]:
    """The paper's Table 1 on trial: one trial a row, each with its D, alpha and E* by finite elements, with bars.

    `out`: folder that keeps rows as they are found, None: a temporary one; `jobs`: processes. Raises NotReached.
    """
    from tempfile import TemporaryDirectory

    from fe_contact.studies.table1.study import table1 as study

    with TemporaryDirectory() as spare:
        return study(Path(out or spare), jobs=jobs)


def tradeoff(scene: Scene | str | Path, quick: bool = False, out: str | Path | None = None) -> Tradeoff:
    """What accuracy costs on a scene, by every method and by many settings.

    `scene`: as for :func:`run`; `quick`: a quarter of the settings; `out`: folder that keeps what was measured. The
    ``verdict`` says in words what to use. Raises BadInput and NotReached.
    """
    from tempfile import TemporaryDirectory

    from fe_contact.methods import settings
    from fe_contact.progress import silent
    from fe_contact.studies.tradeoff.study import tradeoff as study

    known, table = _read(scene)
    with TemporaryDirectory() as spare:
        return study(known, settings(table, None, known.source), quick, Path(out or spare), silent)


def plot(found: object, out: str | Path) -> tuple[Path, ...]:
    """Draw what a function here found, as its command does: charts in SVG and PNG.

    Parameters
    ----------
    found : a Result, Comparison, SweepTable, Tradeoff, TransferStudy, or the trials of Table 1.
    out : folder for the charts.

    Returns
    -------
    The files.

    Raises
    ------
    BadInput for anything else; a Result, History, Indentation or Fit has a ``plot()`` of its own, for a notebook.
    """
    from fe_contact.studies.compare.chart import plot_comparison
    from fe_contact.studies.compare.study import Comparison
    from fe_contact.studies.history_chart import plot_history
    from fe_contact.studies.sweep.chart import plot_sweep
    from fe_contact.studies.sweep.table import SweepTable
    from fe_contact.studies.table1.chart import plot_table1
    from fe_contact.studies.tradeoff.chart import plot_tradeoff
    from fe_contact.studies.tradeoff.study import Tradeoff
    from fe_contact.studies.transfer.chart import plot_transfer
    from fe_contact.studies.transfer.study import TransferStudy
    from lumped import BadInput, Fault, Result

    charts: Mapping[type, Callable[..., tuple[Path, ...]]] = {
        Result: plot_history,
        Comparison: plot_comparison,
        SweepTable: plot_sweep,
        Tradeoff: plot_tradeoff,
        TransferStudy: plot_transfer,
        tuple: plot_table1,
    }
    if type(found) not in charts:
        known = ", ".join(kind.__name__ for kind in charts)
        raise BadInput(Fault("plot", type(found).__name__, f"has no chart here; accepted: {known}"))
    Path(out).mkdir(parents=True, exist_ok=True)
    return charts[type(found)](found, Path(out))


def _read(scene: Scene | str | Path) -> tuple[Scene, Table]:
    """A scene, and the settings of its file. Raises BadInput."""
    from lumped import Scene
    from lumped.scene.tables import load

    return (scene, {}) if isinstance(scene, Scene) else load(Scene, scene)


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
    from tempfile import TemporaryDirectory

    from fe_contact.studies.sweep.cases import load
    from fe_contact.studies.sweep.study import run as run_sweep

    asked = load(source)
    with TemporaryDirectory() as spare:
        return run_sweep(asked, Path(out or spare) / "cases", jobs, dask, resume)


def transfer(
    scene: Scene | str | Path,
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
    scene : as for :func:`run`.
    laws : names of lumped laws; none: all.
    start : dotted keys of the scene file and their values at the state of calibration; what it leaves out is the
        scene's.
    over : keys and the values that each takes, alone; None: the velocity from a third to three times.
    calibrate : ``least_squares`` on the whole history, ``restitution``: that and the peak force alone, or ``modulus``:
        the restitution beside E*.
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

    values = {key: tuple(every) for key, every in (over or {}).items()}
    asked = Asked(tuple(laws), start or {}, values, calibrate, within, method)
    known, table = _read(scene)
    with one_thread:
        return run_transfer(known.changed, settings(table, tolerance, known.source), asked)


def validate(
    out: str | Path, quick: bool = False, jobs: int = 2, resume: bool = False, sections: Sequence[str] = ()
) -> Report:
    """Everything on the packaged scenes, in one report: ``index.html`` in the folder ``out``.

    Parameters
    ----------
    out : folder of the page, with a folder a section beside it.
    quick : fewer places, settings and scenes: minutes instead of a quarter of an hour.
    jobs : processes that answer, 1 for this one; more are as for :func:`sweep`.
    resume : take sections that ``out`` holds of this suite, and make the others alone.
    sections : names of the sections to make; none: all.

    Returns
    -------
    Report: ``headlines``, each a ``word`` (``verified`` only of what was held against an exact answer) and a ``text``;
    ``told``, section by section, with its ``failure`` where it has none; ``missed``, empty where all was reached.

    Raises
    ------
    BadInput for an unknown section, CannotWrite. A section that fails with a name is shown as failed.
    """
    from fe_contact.studies.validate._study import validate as run_validate
    from fe_contact.studies.workers import checked_jobs

    with one_thread:
        return run_validate(Path(out), quick, checked_jobs(jobs), resume, sections)
