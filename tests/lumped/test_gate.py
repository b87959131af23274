"""The gate before any fit: forty spoiled curves, each named by its fault, and two hundred sound ones that pass."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from lumped import BadInput, FeContactError, Scene, laws, simulate
from lumped.numbers import Array
from lumped.result.curve_file import read_curve
from lumped.result.gate import check_curve
from lumped.result.score import Curve
from lumped.schema.files import SCENES

Made = tuple[Array, Array]
Spoil = Callable[[Array, Array], Made]
SEED = 20261125
ROWS, NOISE = 400, 0.01


def made(name: str, lead: float = 0.0, noise: float = NOISE, rows: int = ROWS, seed: int = 1) -> Made:
    """A measurement of the scene's impact by its exact law: silence before, in durations, the pulse, silence after."""
    scene = Scene.load(name)
    history = simulate(laws.get(scene.law.name if scene.law else "ting").of(scene), scene, 1e-4).history
    last = float(history.time[-1])
    time = np.linspace(-lead * last, 2.5 * last, rows)
    rng = np.random.default_rng(seed)
    return time, history.force_at(time) + noise * history.force.max() * rng.normal(size=time.size)


def scaled(of_time: float, of_force: float) -> Spoil:
    return lambda time, force: (of_time * time, of_force * force)


def clipped(share: float) -> Spoil:
    return lambda time, force: (time, np.minimum(force, share * force.max()))


def hole(begin: float, end: float) -> Spoil:
    """Rows lacking, in shares of the time from zero on."""

    def spoil(time: Array, force: Array) -> Made:
        kept = (time < begin * time[-1]) | (time > end * time[-1])
        return time[kept], force[kept]

    return spoil


def dropped(time: Array, force: Array) -> Made:
    top = int(np.argmax(force))
    return time, np.where(np.abs(np.arange(time.size) - top) < 2, 0.0, force)


def twice(time: Array, force: Array) -> Made:
    step = time[-1] - time[-2]
    return np.append(time, time + time[-1] + step), np.append(force, force)


def drift(time: Array, force: Array) -> Made:
    return time, force + 0.12 * force.max() * (time - time[0]) / (time[-1] - time[0])


SPOILED: tuple[tuple[str, Spoil, float, str], ...] = (
    ("force in mN", scaled(1.0, 1e3), 0.0, "force is 1000 times too large"),
    ("force in kN", scaled(1.0, 1e-3), 0.0, "force is 1000 times too small"),
    ("time in ms", scaled(1e3, 1.0), 0.0, "time is 1000 times too long"),
    ("time in us", scaled(1e6, 1.0), 0.0, "time is 1e\\+06 times too long"),
    ("time in ks", scaled(1e-3, 1.0), 0.0, "time is 1000 times too short"),
    (
        "ms and kN, touch long past",
        lambda time, force: (1e3 * time + 9e9 * time[-1], 1e-3 * force),
        0.0,
        "time is 1000 times too long.* and the force is 1000 times too small(.|\\n)*pre-trigger",
    ),
    ("ms and mN", scaled(1e3, 1e3), 0.0, "time_ms and a header force_mN"),
    ("sign", scaled(1.0, -1.0), 0.0, "sign|never above zero"),
    ("touch late", lambda time, force: (time - time[0], force), 1.0, "pre-trigger"),
    ("touch long past", lambda time, force: (time - 5.0 * time[-1], force), 0.0, "pre-trigger"),
    ("clipped at 95 %", clipped(0.95), 0.0, "peak is clipped"),
    ("clipped at 70 %", clipped(0.7), 0.0, "peak is clipped"),
    ("two sensors added", scaled(1.0, 2.0), 0.0, "doubled"),
    ("recorded twice", twice, 0.0, "another contact"),
    ("a hole", hole(0.15, 0.2), 0.0, "samples are missing"),
    ("a dropout", dropped, 0.0, "samples are missing"),
    ("half a hertz", lambda time, force: (time[::40], force[::40]), 0.0, "sample rate"),
    ("offset", lambda time, force: (time, force + 0.08 * force.max()), 1.0, "offset"),
    ("drift", drift, 1.0, "drift"),
    ("silence", lambda time, force: (time[time.size // 2 :], force[time.size // 2 :]), 0.0, "no contact"),
    ("a heavier striker", scaled(1.0, 0.3), 0.0, "< 0"),
)
SPOILED_SCENES = ("steel-ball-sls", "polymer-layer")


@pytest.mark.parametrize("name", SPOILED_SCENES)
@pytest.mark.parametrize(("says", "spoil", "lead", "message"), SPOILED, ids=[one[0] for one in SPOILED])
def test_a_spoiled_curve_is_named(name: str, says: str, spoil: Spoil, lead: float, message: str) -> None:
    time, force = made(name, lead)
    scene = Scene.load(name)
    assert check_curve(Curve(time, force), scene, "curve") == ()
    with pytest.raises(BadInput, match=message) as refused:
        check_curve(Curve(*spoil(time, force)), scene, "curve")
    assert len(refused.value.faults) == 1 + ("kN, touch" in says)
    assert "cure: " in str(refused.value)


@pytest.mark.parametrize("tail", [1.5, 10.0, 30.0])
@pytest.mark.parametrize(("lead", "said"), [(0.0, "offset or drift"), (1.0, "drift")])
def test_a_drift_is_seen_however_long_the_silence_is(tail: float, lead: float, said: str) -> None:
    scene = Scene.load("polymer-layer")
    history = simulate(laws.get("ting").of(scene), scene, 1e-4).history
    last = float(history.time[-1])
    time = np.linspace(-lead * last, (1.0 + tail) * last, round(120 * (1.0 + lead + tail)))
    force = history.force_at(time) + 0.01 * history.force.max() * np.random.default_rng(1).normal(size=time.size)
    with pytest.raises(BadInput, match=rf"curve: {said}: the force is .* after the contact"):
        check_curve(Curve(*drift(time, force)), scene, "curve")
    assert check_curve(Curve(time, force), scene, "curve") == ()


@pytest.mark.parametrize("share", [0.01, 0.015])
def test_a_small_offset_is_told_and_no_bar(share: float) -> None:
    """Beside the same curve without it, of which nothing is said."""
    (time, force), scene = made("polymer-layer", 1.0, 0.005), Scene.load("polymer-layer")
    assert check_curve(Curve(time, force), scene, "curve") == ()
    (said,) = check_curve(Curve(time, force + share * force.max()), scene, "curve")
    found = re.search(r"offset: the force is .* N before touch.*, (\S+) % of the peak; cure: subtract it", said)
    assert found is not None
    assert float(found[1]) == pytest.approx(100.0 * share, rel=0.05)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_s,force_N\n0,1,0,5\n0,2,1,5\n", "commas separate the columns and the decimals too"),
        ("time_s,force_N\n0,1\n1,\n2,3\n", "samples are missing, the first in row 2"),
        ("time_s;pressure_Pa\n0;1\n1;2\n", "force_N: missing column"),
        (
            "Logger 3000\ntime,force\nms,dyn\n0,1\n1,2\n",
            re.escape("force_N: missing column, with a header of 'time [ms],force [dyn]'; ")
            + ".* in N, kN, .* lbf, kip",
        ),
        ("t,left [N],right [N]\n0,1,2\n1,2,3\n", "which is meant"),
        ("time [ms],acceleration [g]\n0,1\n1,2\n", "cure: a column of the force, mass times acceleration"),
        ("time [ms],a [m/s2]\n0,1\n1,2\n", "cure: a column of the force, mass times acceleration"),
        ("-3.0,0.1\n-2.9,0.2\n", "cure: a first line that names the columns, as time_s,force_N"),
        (
            "Time (ms) Force (N)\n0 1\n1 2\n",
            r"'Time \(ms\) Force \(N\)' has not as many words .*; cure: ",
        ),
        ("time_s force_N\n0,1\n1,2\n", "'time_s force_N' has not as many words as the row below has numbers"),
        ("Data of a good gauge\n1,2\n3,4\n", r"time_s: missing column, .* us, ns\n"),
    ],
)
def test_a_spoiled_file_is_named(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "curve.csv").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=message):
        read_curve(tmp_path / "curve.csv")


@pytest.mark.parametrize(
    ("header", "of_time", "of_force", "says"),
    [
        ("t [ms];F [kN]", 1e3, 1.0, "force is 1000 times too large: in N and read as kN? cure: a header force_N"),
        ("t [ms];F [N]", 1e3, 1e-3, "force is 1000 times too small: in kN and read as N? cure: a header force_kN"),
        ("t [s];F [N]", 1e3, 1.0, "time is 1000 times too long: in ms and read as s? cure: a header time_ms"),
        ("t [ms];F [N]", 1.0, 1.0, "time is 1000 times too short: in s and read as ms? cure: a header time_s"),
    ],
)
def test_the_cure_of_a_wrong_header_is_the_right_one(
    header: str, of_time: float, of_force: float, says: str, tmp_path: Path
) -> None:
    """The values as they are, under a header that names another unit; under that of the cure they are taken."""
    path, scene, (time, force) = tmp_path / "curve.csv", Scene.load("steel-ball-sls"), made("steel-ball-sls", 0.0)
    rows = "".join(f"{t:.12g};{f:.12g}\n" for t, f in zip(of_time * time, of_force * force, strict=True))
    path.write_text(f"{header}\n{rows}", encoding="utf-8")
    with pytest.raises(BadInput, match=re.escape(says)):
        check_curve(read_curve(path), scene, "curve")
    quantity, cure = says.split()[0], says.rpartition(" ")[2]
    old = {"time": header.partition(";")[0], "force": header.partition(";")[2]}[quantity]
    path.write_text(f"{header.replace(old, cure)}\n{rows}", encoding="utf-8")
    check_curve(read_curve(path), scene, "curve")


@pytest.mark.parametrize(
    ("header", "separator", "comma", "of_time", "of_force", "remarks"),
    [
        ("time_s,force_N", ",", False, 1.0, 1.0, 0),
        ("channel,force_N,time_s", ",", False, 1.0, 1.0, 0),
        ("time_ms,force_kN", ",", False, 1e3, 1e-3, 2),
        ("t [ms];F [kN]", ";", True, 1e3, 1e-3, 4),
        ("Zeit/µs\tKraft/mN", "\t", True, 1e6, 1e3, 3),
        ("Time (s);Load (N)", ";", False, 1.0, 1.0, 3),
        ("# time_s,force_N", ",", False, 1.0, 1.0, 0),
        ("Logger 7\n\nTime,Force\n(ms),(N)", ",", False, 1e3, 1.0, 2),
        ("t,F", ",", False, 1.0, 1.0, 2),
        ("time_s force_N", " ", False, 1.0, 1.0, 1),
        ("Impact of May 4\nt_ms F_kN", " ", True, 1e3, 1e-3, 4),
        ("force over time\nmeasured on Monday\ntime_s,force_N", ",", False, 1.0, 1.0, 0),
    ],
)
def test_a_header_is_read_as_it_is_meant(
    header: str, separator: str, comma: bool, of_time: float, of_force: float, remarks: int, tmp_path: Path
) -> None:
    """The same curve in every dress, and every guess is said."""
    time, force = made("steel-ball-sls")
    places = [cell.strip() for cell in header.splitlines()[-1].split(separator)]
    columns = {"time": of_time * time, "force": of_force * force}
    order = ["time", "force"] if len(places) == 2 else ["time", "force", "time"]
    rows = [separator.join(f"{columns[one][i]:.12g}" for one in order) for i in range(time.size)]
    text = header + "\n" + "\n".join(row.replace(".", ",") if comma else row for row in rows)
    (tmp_path / "curve.csv").write_text(text, encoding="utf-8")
    curve = read_curve(tmp_path / "curve.csv")
    assert curve.time == pytest.approx(time, rel=1e-9, abs=1e-15)
    assert curve.force == pytest.approx(force, rel=1e-9)
    assert len(curve.remarks) == remarks


def test_a_curve_is_read_as_numpy_writes_it(tmp_path: Path) -> None:
    rows = np.array([[0.0, 0.0], [0.5, 2.0], [1.0, 0.0]])
    np.savetxt(tmp_path / "curve.txt", rows, header="time_s force_N")
    curve = read_curve(tmp_path / "curve.txt")
    assert np.array_equal(np.column_stack([curve.time, curve.force]), rows)


@pytest.mark.parametrize(
    ("encoding", "mark"), [("cp1252", ""), ("utf-8-sig", ""), ("utf-16", ""), ("utf-8-sig", "sep=;\r\n")]
)
def test_a_curve_is_read_as_windows_writes_it(encoding: str, mark: str, tmp_path: Path) -> None:
    """Semicolons, decimal commas, carriage returns, a micro sign: in any of the encodings that Excel exports."""
    time, force = made("steel-ball-sls")
    rows = [f"{1e6 * t:.12g};{f:.12g};".replace(".", ",") for t, f in zip(time, force, strict=True)]
    text = f"{mark}Zeit [µs];Kraft [N];Größe\r\n" + "\r\n".join(rows) + "\r\n;;\r\n"
    (tmp_path / "curve.csv").write_bytes(text.encode(encoding))
    curve = read_curve(tmp_path / "curve.csv")
    assert curve.time == pytest.approx(time, rel=1e-9, abs=1e-15)
    assert curve.force == pytest.approx(force, rel=1e-9)
    assert curve.remarks[0] == "Zeit [µs] is read as the time, in µs"


def sound(rng: np.random.Generator) -> Iterator[tuple[Scene, Curve]]:
    """Random packaged scenes by any law they have, at any rate that tells a pulse, with noise up to 5 %."""
    while True:
        scene = Scene.load(str(rng.choice(SCENES.names)))
        name = scene.law.name if scene.law else str(rng.choice(laws.available()))
        rows, noise = int(rng.integers(200, 3000)), 0.05 * rng.random()
        before, after = rng.random(2) * 2.0 * (rng.random(2) < 0.7)
        try:
            history = simulate(laws.get(name).of(scene), scene, 1e-3).history
        except FeContactError:
            continue
        last = float(history.time[-1])
        time = np.linspace(-before * last, (1.0 + after) * last, rows)
        told = history.force_at(time)
        if told.max() < 0.5 * history.force.max():  # between two rows lies the whole pulse
            continue
        force = told + noise * history.force.max() * rng.normal(size=rows)
        yield scene, Curve(time, force)


def test_sound_curves_pass(campaign_size: Callable[..., int]) -> None:
    curves, refused = sound(np.random.default_rng(SEED)), []
    for _ in range(campaign_size(200, 8)):
        scene, curve = next(curves)
        try:
            check_curve(curve, scene, scene.name)
        except BadInput as bad:
            refused.append(str(bad))
    assert refused == []
