"""Histories, what is read off them, and the files they are written to."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from lumped import BadInput, History, Scene, laws, simulate
from lumped.numbers import highest, local, peak
from lumped.result.history import COLUMNS, LEAST_ROWS, densified
from lumped.result.result import UNITS

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


def test_densified_ends_at_a_step() -> None:
    rows = densified([0.0, 1.0], lambda t: (t > 0.3) * 1.0, 1e-9)
    assert rows.size < 400


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
    assert content["model"] == {"inertia": False, "profile": "exact", "gravity": 0.0, "direction": "unsaid"}
    assert content["model_sufficient"] is False
    assert content["energy"]["in"] == pytest.approx(0.5 * 0.05 * 0.02**2)
    assert Scene.from_dict(content["scene"]).contact_modulus == scene.contact_modulus
    rows = History.read_csv(tmp_path / "out" / "history.csv")
    assert len(rows) >= LEAST_ROWS
    assert (rows.time[0], rows.depth[0], rows.velocity[0]) == (0.0, 0.0, 0.02)
    assert rows.time[-1] == pytest.approx(content["quantities"]["duration"]["value"], rel=1e-12)
