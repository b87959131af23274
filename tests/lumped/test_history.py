"""Histories, what is read off them, and the files they are written to."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

from lumped import BadInput, History, Scene, laws, simulate
from lumped.numbers import Array, highest, local, peak
from lumped.result.history import COLUMNS, LEAST_ROWS, densified
from lumped.result.result import UNITS
from lumped.targets.rod import Rod

HEADER = "time_s,depth_m,velocity_m_per_s,force_N,contact_radius_m,force_error_N"


def half_sine(rows: int = 401) -> History:
    t = np.linspace(0.0, 1.0, rows)
    wave = np.sin(np.pi * t)
    return History(t, wave / np.pi, np.cos(np.pi * t), 3.0 * wave, np.sqrt(wave), 0.0 * t)


def test_written_history_reads_back_bit_by_bit(tmp_path: Path) -> None:
    history = half_sine()
    history.write_csv(tmp_path / "history.csv")
    assert (tmp_path / "history.csv").read_text().splitlines()[0] == HEADER
    again = History.read_csv(tmp_path / "history.csv")
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(again, name), getattr(history, name))


def test_impossible_histories_are_refused(tmp_path: Path) -> None:
    good = [np.linspace(0.0, 1.0, 5)] * 6
    for i, bad in enumerate([np.zeros((5, 1)), np.zeros(4), np.full(5, np.nan), np.array([0.0])]):
        with pytest.raises(BadInput):
            History(*good[:i], bad, *good[i + 1 :])
    with pytest.raises(BadInput, match="never decreases"):
        History(good[0][::-1], *good[1:])
    (tmp_path / "short.csv").write_text("time_s,force_N\n0,1\n")
    with pytest.raises(BadInput, match="depth_m"):
        History.read_csv(tmp_path / "short.csv")


def test_peaks_of_a_half_sine_are_its_own() -> None:
    history = half_sine()
    assert peak(history.time, history.force) == (pytest.approx(0.5, abs=1e-6), pytest.approx(3.0, rel=1e-9))
    assert peak(history.time, history.depth)[1] == pytest.approx(1.0 / np.pi, rel=1e-9)


@pytest.mark.parametrize("spread", ["evenly", "crowded", "twice"])
def test_a_jump_makes_no_peak(spread: str) -> None:
    """The peak of two branches is an end or a top of either, whatever rows stand at the jump between them."""
    generator = np.random.default_rng(5)
    even = np.linspace(0.0, 1.0, 102)
    for _ in range(60):
        jump, rise, bend, level = generator.uniform((0.2, -2.0, 0.5, -3.0), (0.8, 2.0, 2.0, 3.0))
        force = partial(two_branches, jump, rise, bend, level)
        rows = densified(even, force, 1e-2) if spread == "crowded" else even
        values = force(rows)
        if spread == "twice":
            place = int(np.searchsorted(rows, jump))
            rows, values = np.insert(rows, place, [jump, jump]), np.insert(values, place, force([jump, jump + 1e-15]))
        known = force(np.append(np.linspace(0.0, 1.0, 20_001), np.nextafter(jump, 1.0))).max()
        steepest = abs(rise) + 2.0 * bend  # within a branch: a row may stand as far below its end as a step of that
        assert known - 0.01 * steepest <= peak(rows, values)[1] <= known + 0.01 * steepest
        if spread != "evenly":
            assert peak(rows, values)[1] == pytest.approx(known, abs=1e-4)


def two_branches(jump: float, rise: float, bend: float, level: float, time: ArrayLike) -> Array:
    """5 + rise t - bend t^2, and `level` more after the jump."""
    t = np.asarray(time)
    return np.asarray(5.0 + rise * t - bend * t**2 + np.where(t > jump, level, 0.0))


def test_the_peak_of_a_rod_is_that_of_its_echo() -> None:
    """St Venant: a flat end meets the first echo of the fixed end with twice the first force, less what the mass lost.

    At t = 2 l/c the force jumps to its highest, rho c A v (2 + exp(-2 rho A l/m)).
    """
    scene = Scene.load("rod")
    history, rod, material = simulate(laws.rod_waves.of(scene), scene, 1e-6).history, scene.target, scene.material
    assert isinstance(rod, Rod)
    assert material is not None
    density = material.density or 0.0
    mass = density * rod.area * rod.length
    echo = density * np.sqrt(material.young.relaxed / density) * rod.area * scene.velocity
    assert peak(history.time, history.force)[1] == pytest.approx(echo * (2.0 + np.exp(-2.0 * mass / scene.mass)))


def test_local_interpolation_is_of_fourth_order() -> None:
    at = np.linspace(0.0, 1.0, 1001)
    errors = []
    for n in (21, 41, 81):
        x = np.linspace(0.0, 1.0, n) ** 1.2
        errors.append(np.abs(local(x, np.sin(5.0 * x), at) - np.sin(5.0 * at)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(rates > 3.5)


def test_peak_lies_between_the_rows() -> None:
    x = np.linspace(0.0, 1.0, 41)
    place, height = peak(x, np.sin(2.9 * x))
    assert (place, height) == (pytest.approx(np.pi / 5.8, abs=1e-5), pytest.approx(1.0, abs=1e-6))
    twice = np.insert(x, 22, np.nextafter(x[22], 0.0))
    shaken = np.sin(2.9 * twice) + 1e-15 * (np.arange(42.0) % 3.0)
    assert peak(twice, shaken) == (pytest.approx(place, abs=1e-12), pytest.approx(height, abs=1e-12))
    assert highest(lambda t: 1.0 - t, x) == (pytest.approx(0.0), pytest.approx(1.0))


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_densified_rows_interpolate_to_the_tolerance(tolerance: float) -> None:
    def force(t: np.ndarray) -> np.ndarray:
        return np.sqrt(t) * np.exp(-20.0 * t)

    rows = densified([0.0, 1.0], force, tolerance)
    assert rows.size >= LEAST_ROWS
    fine = np.sort(np.concatenate([rows[:-1] + s * np.diff(rows) for s in np.linspace(0.0, 1.0, 9)]))
    error = np.abs(np.interp(fine, rows, force(rows)) - force(fine)).max()
    assert error < tolerance * force(rows).max()


def test_even_a_straight_line_has_the_fewest_rows_there_are() -> None:
    assert densified([0.0, 1.0], lambda t: t, 1e-2).size >= 201, "what the contract promises of a history"


@pytest.mark.parametrize("height", [1.0, 3e-9])  # of a step, and of one barely above what may be missed
def test_densified_ends_at_a_step_soon(height: float) -> None:
    asked = list[int]()

    def force(t: np.ndarray) -> np.ndarray:
        asked.append(t.size)
        return 1.0 + height * (t > 0.3)

    rows = densified([0.0, 1.0], force, 1e-9)
    step = np.searchsorted(rows, 0.3, side="right")
    assert rows[step] - rows[step - 1] < 1e-15
    assert rows.size < 400
    assert len(asked) < 40


def test_result_files_hold_the_whole_schema_and_no_nan(tmp_path: Path) -> None:
    scene = Scene.load("polymer-sphere")
    result = simulate(laws.mdr.of(scene), scene, tolerance=1e-4)
    result.write(tmp_path / "out")
    text = (tmp_path / "out" / "result.json").read_text()
    assert "NaN" not in text
    assert "Infinity" not in text
    content = json.loads(text)
    assert content["schema"] == "fe-contact/result/1"
    assert set(content["quantities"]) == set(UNITS)
    assert all(set(q) == {"value", "error", "unit"} for q in content["quantities"].values())
    assert content["model"] == scene.to_dict()["model"]
    assert content["model_sufficient"] is False
    assert content["energy"]["in"] == pytest.approx(0.5 * 0.05 * 0.02**2)
    assert Scene.from_dict(content["scene"]).contact_modulus == scene.contact_modulus
    rows = History.read_csv(tmp_path / "out" / "history.csv")
    assert len(rows) >= LEAST_ROWS
    assert (rows.time[0], rows.depth[0], rows.velocity[0]) == (0.0, 0.0, 0.02)
    assert rows.time[-1] == pytest.approx(content["quantities"]["duration"]["value"], rel=1e-12)
