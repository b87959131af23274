"""Sweeps: every fault at once, cases in order, seeded draws, and a table that no interruption changes."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from multiprocessing import active_children
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.stats import spearmanr

import fe_contact
from fe_contact.cli import main
from fe_contact.studies import style
from fe_contact.studies.sweep import study
from fe_contact.studies.sweep.cases import load
from fe_contact.studies.sweep.chart import plot_sweep
from fe_contact.studies.sweep.table import SweepTable
from lumped import Scene
from lumped.errors import BadInput
from lumped.result.result import UNITS
from lumped.scene.tables import Known

SPEED, DASHPOT = "striker.velocity", "target.material.C1"
TEN_TO_SIX = {"linear": [0.1, 1.0], "count": 10**6}
UNIT = {"uniform": [0.1, 1.0]}
ORPHAN = 30.0  # s: a process that outlives its sweep by so much stays
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
MANY = """
name = "many"
scene = "polymer-sphere"
methods = ["hertz", "ting"]
[axes]
"striker.velocity" = { log = [0.005, 0.5], count = 10 }
"target.material.C1" = { log = [1e3, 1e5], count = 5 }
"""


def tables(methods: tuple[str, ...] = ("hertz",), **others: object) -> dict[str, object]:
    """A sweep of the polymer sphere."""
    return {"name": "spheres", "scene": "polymer-sphere", "methods": list(methods), **others}


def rows(table: SweepTable, where: Path) -> list[dict[str, str]]:
    """The rows of a table's file."""
    table.write(where, 0.0)
    with (where / "table.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def begun(*arguments: object) -> subprocess.Popen[str]:
    """The command on its own, leader of a group, as from a terminal."""
    command = [sys.executable, "-m", "fe_contact", "sweep", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)


# the file


def test_every_fault_is_said_at_once_and_nothing_is_written(empty: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (empty / "faulty.toml").write_text(
        """
scene = "polymer-sphre"
methods = ["tng"]
tolerance = 3.0
jbs = 2
[axes]
"striker.velocity" = { log = [0.0, 0.5], count = 0 }
"striker.mass" = []
[zipped]
"striker.mass" = [0.1, 0.2]
"striker.radius" = [0.1]
[draws]
count = 0
"target.material.nu" = { gaussian = [0.3, 0.1] }
correlation = [["striker.mass", "striker.mass", 2.0]]
"""
    )
    assert main(["sweep", "faulty.toml"]) == 2
    said = capfd.readouterr().err.splitlines()
    for key, cure in {
        "jbs": "methods",  # the nearest or all accepted keys
        "scene": "'polymer-sphre': no such file, nor a packaged scene; did you mean polymer-sphere?",
        "methods": "did you mean ting?",
        "tolerance": "0.1",
        "axes.striker.velocity.log": "0 excluded",
        "axes.striker.velocity.count": "from 1",
        "axes.striker.mass": "a list of values",
        "zipped": "one length",
        "draws.seed": "missing",
        "draws.count": "from 1",
        "draws.target.material.nu": "{ gaussian = [0.3, 0.1] }; accepted: { uniform = ",
        "draws.correlation": "between -1 and 1",
    }.items():
        assert [line for line in said if f"faulty.toml: {key}: " in line and cure in line], (key, said)
    assert [path.name for path in empty.iterdir()] == ["faulty.toml"]


def test_tables_where_one_belongs_are_shown_as_written(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (empty / "rows.toml").write_text('scene = "polymer-sphere"\n[[axes]]\nkey = "striker.mass"\n')
    assert main(["sweep", "rows.toml"]) == 2
    assert "axes: [{ key = 'striker.mass' }] is not accepted; accepted: a table" in capsys.readouterr().err


@pytest.mark.family
@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"axes": {"striker.velocty": [1.0]}}, "did you mean velocity?"),
        ({"axes": {"strikr.velocity": [1.0]}}, "^sweep: strikr.velocity: unknown key; .* did you mean striker?"),
        ({"axes": {SPEED: [-1.0], DASHPOT: [1e3, 1e4]}}, "-1.0"),
        ({"axes": {SPEED: [0.1]}, "zipped": {SPEED: [0.1]}}, "varies twice"),
        ({}, "missing; accepted: [axes]"),
        ({"axes": {SPEED: TEN_TO_SIX, DASHPOT: [1e3] * 11}}, "more than 10000000 cases"),
        ({"axes": {SPEED: TEN_TO_SIX, DASHPOT: TEN_TO_SIX}}, "more than 1000000 values in all"),
        ({"axes": {SPEED: TEN_TO_SIX | {"count": 10**7}}}, "from 1 to 1000000"),
        (
            {"draws": {"count": 600_000, "seed": 1, SPEED: UNIT, DASHPOT: UNIT}},
            "draws: more than 1000000 values in all",
        ),
        ({"axes": {"numerics.tolerance": [7.0]}}, "7.0"),
    ],
)
def test_what_no_case_can_be_run_with_is_a_fault_of_the_file(changed: dict[str, object], said: str) -> None:
    with pytest.raises(BadInput, match=said.replace("[", r"\[").replace("?", r"\?")):
        load(tables(**changed))


@pytest.mark.parametrize("jobs", ["0", "1025", "two", "1.5", ""])
def test_so_many_processes_are_refused(jobs: str, empty: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (empty / "many.toml").write_text(MANY)
    assert main(["sweep", "many.toml", f"--jobs={jobs}"]) == 2
    assert "accepted a whole number from 1 to 1024" in capfd.readouterr().err
    assert len(list(empty.iterdir())) == 1


def test_the_manual_shows_a_sweep_file(tmp_path: Path) -> None:
    manual = Path(fe_contact.__file__).with_name("manual") / "sweeps.md"
    (tmp_path / "sweep.toml").write_text(manual.read_text(encoding="utf-8").split("```toml")[1].partition("```")[0])
    assert load(tmp_path / "sweep.toml").count == 10 * 3 * 2 * 20


# cases


def test_cases_are_the_product_in_the_order_written_the_last_axis_fastest(tmp_path: Path) -> None:
    axes = {SPEED: {"linear": [0.01, 0.03], "count": 3}, DASHPOT: [1e3, 1e4]}
    both = {"striker.mass": [0.01, 0.02], "striker.radius": [0.005, 0.006]}
    table = fe_contact.sweep(tables(("hertz", "ting"), axes=axes, zipped=both))
    found = rows(table, tmp_path)
    keys = [(row[SPEED], row[DASHPOT], row["striker.mass"], row["striker.radius"], row["method"]) for row in found]
    assert keys == [
        (speed, dashpot, *mass, method)
        for speed in ("0.01", "0.02", "0.03")
        for dashpot in ("1000.0", "10000.0")
        for mass in (("0.01", "0.005"), ("0.02", "0.006"))
        for method in ("hertz", "ting")
    ]
    assert [row["case"] for row in found] == [str(1 + place // 2) for place in range(24)]
    assert list(found[0])[:8] == ["case", *table.sweep.keys, "method", "converged", "reason"]
    assert list(found[0])[8:12] == ["peak_force_N", "peak_force_error_N", "peak_time_s", "peak_time_error_s"]
    assert {"restitution", "restitution_error", "impulse_N_s"} <= found[0].keys()


def test_values_are_those_of_single_runs(tmp_path: Path) -> None:
    speeds, methods = [0.01, 0.3], ("fe", "ting", "cheapest")
    table = fe_contact.sweep(tables(methods, axes={SPEED: speeds}, tolerance=5e-3), tmp_path)
    assert table.converged.all()
    for place in np.ndindex(2, 3):
        scene = Scene.load("polymer-sphere", {SPEED: speeds[place[0]]})
        alone = fe_contact.run(scene, 5e-3, methods[place[1]])
        expected = [(alone.quantities[name].value, alone.quantities[name].error) for name in UNITS]
        assert np.array_equal(np.stack([table.values[place], table.errors[place]], axis=-1), np.array(expected, float))
    assert [path.name for path in tmp_path.iterdir()] == ["cases"]


def test_a_case_without_enough_memory_is_a_row_with_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(scene: Scene, *_: Any) -> Any:
        yield from ()
        if scene.velocity > 0.1:
            raise MemoryError
        return fe_contact.run(scene, 1e-2, "hertz")

    monkeypatch.setattr(study, "simulation", refused)
    table = fe_contact.sweep(tables(axes={SPEED: [0.2, 0.05]}))
    assert table.converged.tolist() == [[False], [True]]
    assert not table.refused.any()
    assert "out of memory" in table.reasons[0, 0]


def test_what_no_case_changes_is_read_once_and_a_fault_told_of_every_case() -> None:
    base, known = load(tables(axes={SPEED: [0.1]})).base, Known()
    (one, _), (other, _) = (base.read({SPEED: speed}, known) for speed in (0.1, 0.2))
    assert one.material is other.material
    changes: list[dict[str, object]] = [
        {SPEED: 0.3, DASHPOT: 1e4},
        {"striker.radius": 0.01},
        {"model.gravity": 9.81},
        {DASHPOT: 1.8e4},
    ]
    for overrides in changes:
        assert base.read(overrides, known) == base.read(overrides)
    faulty: list[dict[str, object]] = [{"target.material.nu": 7}, {"target.mass": -1}, {"target.material.nu": 7}]
    for overrides in faulty:
        said = []
        for parts in (known, None):
            with pytest.raises(BadInput) as refused:
                base.read(overrides, parts)
            said.append(str(refused.value))
        assert said[0] == said[1]


def test_the_tolerance_may_be_an_axis() -> None:
    asked = [1e-2, 1e-4]
    table = fe_contact.sweep(tables(("fe",), axes={"numerics.tolerance": asked}, tolerance=5e-2))
    bars = table.errors[:, 0, 0] / table.values[:, 0, 0]
    assert table.converged.all()
    assert np.all(bars <= asked)
    assert bars[1] < bars[0]


# draws


def drawn(count: int, seed: int, **others: object) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Values of two keys, (count, 2)."""
    keys = {SPEED: {"log_uniform": [0.01, 1.0]}, "striker.mass": {"normal": [0.05, 0.001]}}
    sweep = load(tables(draws={"count": count, "seed": seed, **keys, **others}))
    return np.array([list(sweep.overrides(case).values()) for case in range(sweep.count)])


def test_draws_are_seeded_and_go_on_where_fewer_ended() -> None:
    assert np.array_equal(drawn(50, 7), drawn(50, 7))
    assert not np.any(drawn(50, 7) == drawn(50, 8))
    assert np.array_equal(drawn(80, 7)[:50], drawn(50, 7))


def test_draws_follow_their_distributions_and_correlations() -> None:
    count = 4000
    free, bound = drawn(count, 1), drawn(count, 1, correlation=[[SPEED, "striker.mass", -0.8]])
    five = 5.0 / np.sqrt(count)  # standard errors
    for column in (free[:, 1], bound[:, 1]):
        assert abs(np.mean((column - 0.05) / 0.001)) < five
        assert abs(np.std((column - 0.05) / 0.001) - 1.0) < five
    assert np.all((free[:, 0] >= 0.01) & (free[:, 0] <= 1.0))
    assert abs(np.mean(free[:, 0] < 0.1) - 0.5) < five
    assert abs(spearmanr(*free.T).statistic) < five
    assert abs(spearmanr(*bound.T).statistic - 6 / np.pi * np.arcsin(-0.4)) < five  # of normal variables


def asked(words: list[tuple[str, float, float]]) -> float:
    """Of how many rows progress heard."""
    return max((total for _, _, total in words), default=0)


def test_one_worker_says_a_word_after_every_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And not after two of them, each of some seconds."""
    events, answer = list[str](), study.answer
    monkeypatch.setattr(study, "answer", lambda *batch: [events.append("asked"), answer(*batch)][1])
    study.run(load(tables(axes={SPEED: [0.1, 0.2, 0.3]})), tmp_path, progress=lambda *_: events.append("told"))
    assert events == ["asked", "told"] * 3


def test_a_sweep_that_has_grown_asks_only_for_the_rest(tmp_path: Path) -> None:
    totals = []
    for count in (20, 50, 50):
        keys = {"count": count, "seed": 7, SPEED: {"log_uniform": [0.01, 1.0]}}
        words = list[tuple[str, float, float]]()
        study.run(load(tables(draws=keys)), tmp_path, resume=True, progress=lambda *said: words.append(said))  # noqa: B023
        totals.append(asked(words))
    assert totals == [20, 30, 0]


def test_a_file_that_the_scene_names_is_part_of_the_question(empty: Path) -> None:
    (empty / "rubber.toml").write_text(
        '[striker]\nshape = "sphere"\nradius = 0.006\nmass = 0.05\nvelocity = 0.02\n'
        '[target]\nshape = "half_space"\n[target.material]\nlaw = "measured"\nfile = "moduli.csv"\nnu = 0.45\n'
    )
    sweep = {"scene": "rubber.toml", "methods": ["ting"], "axes": {SPEED: [0.02]}}
    forces = []
    for stiffness in (1.0, 4.0, 1.0):
        frequency = np.geomspace(1e-2, 1e4, 30)
        branch = 1j * frequency * 0.01 * 2 * np.pi
        modulus = stiffness * 1e6 * (1.0 + branch / (1.0 + branch))
        lines = [f"{f},{m.real},{m.imag}" for f, m in zip(frequency, modulus, strict=True)]
        (empty / "moduli.csv").write_text("\n".join(["frequency_Hz,storage_Pa,loss_Pa", *lines]))
        forces.append(fe_contact.sweep(sweep, empty, resume=True).values[0, 0, 0])
    assert forces[0] == forces[2]
    assert forces[1] > 1.5 * forces[0]


# how cases end


def test_values_out_of_their_range_are_refusals_by_name(empty: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (empty / "edge.toml").write_text(
        'scene = "polymer-sphere"\nmethods = ["ting"]\n[axes]\n"target.material.nu" = [0.3, 0.45, 0.7]\n'
    )
    assert main(["sweep", "edge.toml", "--jobs=1", "--parquet"]) == 0
    where = empty / "fe-contact-out" / "sweep-edge"
    record = json.loads((where / "sweep.json").read_text())
    assert record["answers"] == {"converged": 2, "refused": 1, "not_converged": 0}
    with (where / "table.csv").open(newline="") as file:
        *_, last = csv.DictReader(file)
    assert last["converged"] == "False"
    assert "target.material.nu: 0.7 is not accepted" in last["reason"]
    assert last["peak_force_N"] == last["restitution_error"] == ""
    assert {"table.csv", "table.parquet", "sweep.svg", "sweep.png"} == record["files"].keys()
    assert "2 converged, 1 refused, 0 not converged" in capfd.readouterr().out

    from pyarrow import parquet

    columns = parquet.read_table(where / "table.parquet").to_pydict()
    assert columns["target.material.nu"] == [0.3, 0.45, 0.7]
    assert columns["peak_force_N"][2] is None
    assert repr(columns["peak_force_N"][0]) in (where / "table.csv").read_text()


@pytest.mark.tenth
def test_what_did_not_converge_is_said_with_exit_3(empty: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (empty / "hard.toml").write_text(
        'scene = "polymer-sphere"\ntolerance = 1e-5\n[axes]\n"numerics.steps" = [8]\n"striker.velocity" = [0.1]\n'
    )
    assert main(["sweep", "hard.toml", "--json"]) == 3
    said = capfd.readouterr()
    assert json.loads(said.out)["answers"]["not_converged"] == 1
    assert "1 of 1 answers did not converge; case 1 by fe: " in said.err


# charts


@pytest.mark.family
@pytest.mark.parametrize(
    ("changed", "drawn"),
    [
        ({"axes": {SPEED: {"log": [0.01, 1.0], "count": 5}}}, True),
        ({"axes": {SPEED: [0.01, 0.1, 0.2], DASHPOT: {"log": [1e3, 1e5], "count": 3}}}, True),
        ({"axes": {SPEED: [-1.0, -2.0, 1.0], "striker.mass": [-1.0, 0.1]}}, True),
        ({"axes": {SPEED: [0.1, 0.2], DASHPOT: [1e3, 1e4], "striker.mass": [0.1, 0.2]}}, True),
        ({"draws": {"count": 9, "seed": 1, SPEED: {"uniform": [0.1, 1.0]}}}, True),
        ({"axes": {"model.profile": ["exact", "parabola"]}}, False),
        ({"axes": {SPEED: [0.1]}}, False),
    ],
)
def test_there_is_a_chart_where_a_number_varies(changed: dict[str, object], drawn: bool, tmp_path: Path) -> None:
    paths = plot_sweep(fe_contact.sweep(tables(("hertz", "ting"), **changed)), tmp_path)
    assert [path.name for path in paths] == ["sweep.svg", "sweep.png"] * drawn
    assert all(path.stat().st_size > 10_000 for path in paths)


def test_no_method_is_named_over_the_bars(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many methods their names stand above all panels, whose bars leave no place."""
    drawn = list[Figure]()
    monkeypatch.setattr(style, "save", lambda figure, where, name: drawn.append(figure))
    methods = ("hertz", "ting", "kelvin", "mdr", "jankowski", "linear_spring", "mahmoud")
    plot_sweep(fe_contact.sweep(tables(methods, draws={"count": 9, "seed": 1, SPEED: {"uniform": [0.1, 1]}})), tmp_path)
    (figure,) = drawn
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == list(methods)
    renderer = FigureCanvasAgg(figure).get_renderer()
    below = max(axes.get_tightbbox(renderer).y1 for axes in figure.axes)
    above = min(text.get_window_extent(renderer).y0 for text in figure.texts)
    assert below < legend.get_window_extent(renderer).y0
    assert legend.get_window_extent(renderer).y1 < above


def test_ranks_say_which_key_moves_what() -> None:
    keys = {SPEED: {"log_uniform": [0.01, 1.0]}, "striker.mass": {"uniform": [0.0499, 0.0501]}}
    table = fe_contact.sweep(tables(draws={"count": 40, "seed": 3, **keys}))
    force, restitution = (list(UNITS).index(name) for name in ("peak_force", "restitution"))
    ranks = table.ranks(0, force)
    assert ranks[SPEED] > 0.99
    assert abs(ranks["striker.mass"]) < 0.5
    assert table.ranks(0, restitution) == {}  # Hertz gives back all
    assert ranks[SPEED] == pytest.approx(
        spearmanr(table.numbers[SPEED], table.values[:, 0, force]).statistic, rel=1e-12
    )
    often = fe_contact.sweep(tables(axes={SPEED: [0.1, 0.2, 0.4], "striker.mass": [0.01, 0.05, 0.1]}))  # equal values
    assert often.ranks(0, force)[SPEED] == pytest.approx(
        spearmanr(often.numbers[SPEED], often.values[:, 0, force]).statistic, rel=1e-12
    )


# processes


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The table of the many, by one process that nobody interrupted."""
    folder = tmp_path_factory.mktemp("whole")
    file = folder / "many.toml"
    file.write_text(MANY)
    fe_contact.sweep(file).write(folder, 0.0)
    return (folder / "table.csv").read_bytes()


@pytest.mark.tenth
def test_a_killed_sweep_resumes_byte_by_byte(tmp_path: Path, whole: bytes, campaign_size: Callable[..., int]) -> None:
    """By a signal some time after some batches; no process stays, and no row that was kept is asked for again."""
    rng = np.random.default_rng(5)
    (tmp_path / "many.toml").write_text(MANY)
    for place in range(campaign_size(42, least=3, most=3)):
        out = tmp_path / f"out-{place // len(SIGNALS)}"
        arguments = tmp_path / "many.toml", "--jobs", 2, "--resume", "--out", out
        process, wanted = begun(*arguments), len(files(out)) + int(rng.integers(1, 4))
        while process.poll() is None and len(files(out)) < wanted:
            time.sleep(0.002)
        time.sleep(rng.uniform(0.0, 0.1))
        sent = SIGNALS[place % len(SIGNALS)]
        if sent is signal.SIGINT:
            os.killpg(process.pid, sent)  # as ^C: every process of the sweep gets it
        else:
            process.send_signal(sent)
        said, complained = process.communicate(timeout=ORPHAN)  # all its processes hold these
        if sent is signal.SIGINT and "written to" not in said:
            assert (process.returncode, complained) == (130, "fe-contact: interrupted\n")
            assert files(out)
        if place % len(SIGNALS) == len(SIGNALS) - 1:
            before = {path: path.read_bytes() for path in files(out)}
            assert main(["sweep", *map(str, arguments)]) == 0
            assert (out / "table.csv").read_bytes() == whole
            assert before.items() <= {path: path.read_bytes() for path in files(out)}.items()
            assert not list((out / "cases").glob("*.part"))


def files(out: Path) -> list[Path]:
    """Batches in a folder of results."""
    return sorted((out / "cases").glob("*.jsonl"))


def test_a_spoiled_batch_is_asked_for_again(tmp_path: Path) -> None:
    source = tables(("ting",), axes={SPEED: {"log": [0.01, 1.0], "count": 16}})
    table, rng = fe_contact.sweep(source, tmp_path), np.random.default_rng(3)
    for content in (b"", b"[]\n", b'{"digest": 3}\n', b"\xff\xfe", None, None, None):
        file = files(tmp_path)[int(rng.integers(len(files(tmp_path))))]
        text = file.read_bytes()
        file.write_bytes(text[: int(rng.integers(len(text) + 1))] if content is None else content)
        again = fe_contact.sweep(source, tmp_path, resume=True)
        assert np.array_equal(again.values, table.values, equal_nan=True)
        assert np.array_equal(again.errors, table.errors, equal_nan=True)


@pytest.mark.tenth
def test_a_process_that_is_killed_is_replaced(tmp_path: Path) -> None:
    source, killed = tables(("ting",), axes={SPEED: {"log": [0.01, 1.0], "count": 40}}), list[int | None]()

    def kill(message: str, done: float = 0, total: float = 0) -> None:
        if not killed and done < total / 2:
            victim = active_children()[0]
            victim.kill()
            killed.append(victim.pid)

    table = study.run(load(source), tmp_path, jobs=2, progress=kill)
    assert killed
    assert table.converged.all()
    assert not active_children()
    assert np.array_equal(table.values, fe_contact.sweep(source).values)


@pytest.mark.family
@pytest.mark.parametrize("options", [(), ("--dask", "local")], ids=["processes", "dask"])
def test_two_processes_and_dask_give_the_same_table(options: tuple[str, ...], tmp_path: Path, whole: bytes) -> None:
    (tmp_path / "many.toml").write_text(MANY)
    process = begun(tmp_path / "many.toml", "--out", tmp_path / "out", "--jobs", 2, *options)
    said, complained = process.communicate()
    assert (process.returncode, complained) == (0, "")
    assert f"written to {tmp_path / 'out'}" in said
    assert (tmp_path / "out" / "table.csv").read_bytes() == whole


def test_no_scheduler_at_an_address_is_said(empty: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (empty / "many.toml").write_text(MANY)
    assert main(["sweep", "many.toml", "--dask", "nonsense://nowhere"]) == 2
    assert "--dask: nonsense://nowhere: " in capfd.readouterr().err


@pytest.mark.parametrize(("option", "package"), [("--dask=local", "distributed"), ("--parquet", "pyarrow")])
def test_a_missing_extra_names_what_installs_it(
    option: str, package: str, empty: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    for module in (package, f"{package}.parquet"):
        monkeypatch.setitem(sys.modules, module, None)
    (empty / "many.toml").write_text(MANY)
    assert main(["sweep", "many.toml", option]) == 2
    extra = option.strip("-").partition("=")[0]
    assert f"{package} is missing; cure: pip install 'fe-contact[{extra}]'" in capfd.readouterr().err
