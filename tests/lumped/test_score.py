"""Scores: (20)-(21) as norm over norm, features, and measured curves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumped import BadInput, History, score
from lumped.result.curve_file import read_curve
from lumped.result.score import Curve, normalized_error


def half_sine(peak: float, duration: float, rebound: float = 1.0) -> History:
    t = np.linspace(0.0, duration, 2001)
    wave = np.sin(np.pi * t / duration)
    wave[-1] = 0.0
    velocity = np.linspace(1.0, -rebound, t.size)
    return History(t, wave, velocity, peak * wave, wave, 0.0 * t)


def test_equal_curves_score_nothing() -> None:
    found = score(half_sine(2.0, 1.0), half_sine(2.0, 1.0))
    assert found.normalized_error == 0.0
    assert (found.peak_force, found.duration, found.restitution, found.impulse) == (0.0, 0.0, 0.0, 0.0)


def test_features_are_relative_and_restitution_is_not() -> None:
    found = score(half_sine(2.0, 1.0, 0.8), half_sine(3.0, 1.1, 0.5))
    assert found.peak_force == pytest.approx(0.5)
    assert found.duration == pytest.approx(0.1)
    assert found.impulse == pytest.approx(1.5 * 1.1 - 1.0)
    assert found.restitution == pytest.approx(-0.3)


def sunk(force_share: float, time_share: float = 1.0) -> History:
    """A half sine of depth; the force k depth on the way in and `force_share` of it on the way out."""
    t = np.linspace(0.0, 1.0, 4001)
    depth = np.sin(np.pi * t) + 0.0
    depth[-1] = 0.0
    force = 3.0 * depth * np.where(t <= 0.5, 1.0, force_share)
    return History(time_share * t, depth, np.cos(np.pi * t), force, depth, 0.0 * t)


def test_work_and_loss_are_those_of_the_loop() -> None:
    """In: 3/2 J on the way; out: the rebound's share of it."""
    found = score(sunk(1.0), sunk(0.4))
    assert found.work == pytest.approx(0.0, abs=1e-12)
    assert found.loss == pytest.approx(0.6, abs=1e-6)
    assert score(sunk(0.4), sunk(0.4)).loss == 0.0


def test_shape_knows_neither_height_nor_duration() -> None:
    found = score(half_sine(2.0, 1.0), half_sine(3.0, 1.7))
    assert found.normalized_error > 0.5
    assert found.shape == pytest.approx(0.0, abs=1e-6)
    assert found.peak_shift == pytest.approx(0.0, abs=1e-6)


def test_a_skewed_pulse_has_another_shape_and_a_shifted_peak() -> None:
    """(t/T)^2 in the sine: its peak at sqrt(1/2), and the error of the two pulses by quadrature."""
    t = np.linspace(0.0, 1.0, 20001)
    force = np.sin(np.pi * t**2)
    force[-1] = 0.0
    found = score(half_sine(1.0, 1.0), History(t, t, 1.0 - 2.0 * t, force, t, 0.0 * t))
    assert found.peak_shift == pytest.approx(np.sqrt(0.5) - 0.5, abs=1e-6)
    expected = np.sqrt(np.trapezoid((force - np.sin(np.pi * t)) ** 2, t) / 0.5)
    assert found.shape == pytest.approx(expected, rel=1e-4)


def test_normalized_error_pads_the_shorter_curve_with_zero() -> None:
    # two half sines, the second of twice the duration: int (s1-s2)^2 / int s1^2 over (0, 2)
    error = normalized_error(half_sine(1.0, 1.0), half_sine(1.0, 2.0))
    cross = np.trapezoid(np.sin(np.pi * (t := np.linspace(0, 1, 10001))) * np.sin(np.pi * t / 2), t)
    assert error == pytest.approx(np.sqrt((0.5 + 1.0 - 2.0 * cross) / 0.5), rel=1e-4)
    scaled = normalized_error(half_sine(1.0, 1.0), half_sine(1.3, 1.0))
    assert scaled == pytest.approx(0.3, rel=1e-9)


def test_an_error_is_the_same_by_a_clock_that_began_long_before() -> None:
    """A recorder's zero is not the touch."""
    own, other = half_sine(2.0, 1.0), half_sine(1.9, 1.1)
    late = (replace(curve, time=curve.time + 50.0) for curve in (own, other))
    assert normalized_error(*late) == pytest.approx(normalized_error(own, other), rel=1e-9)


def test_contact_that_does_not_end_has_no_duration() -> None:
    t = np.linspace(0.0, 1.0, 301)
    stuck = History(t, t, 1.0 - t, t, t, 0.0 * t)
    found = score(half_sine(2.0, 1.0), stuck)
    assert (found.duration, found.restitution, found.loss, found.shape, found.peak_shift) == (None,) * 5


def test_measured_curve_is_read_and_scored(tmp_path: Path) -> None:
    path = tmp_path / "curve.csv"
    t = np.linspace(0.0, 1.0, 101)
    rows = "\n".join(f"{a},x,{b}" for a, b in zip(t, 2.0 * np.sin(np.pi * t), strict=True))
    path.write_text("time_s,comment,force_N\n" + rows + "\n")
    found = score(read_curve(path), half_sine(2.0, 1.0))
    assert found.normalized_error < 1e-3
    assert found.peak_force == pytest.approx(0.0, abs=1e-6)
    assert (found.peak_depth, found.restitution, found.work, found.loss) == (None,) * 4
    assert found.shape == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "missing column"),
        ("time_s,push\n0,1\n1,2\n", "force_N: missing column"),
        ("time_s,force_N\n0,1\n1,x\n", "no number"),
        ("time_s,force_N\n0,1\n", "at least two rows"),
        ("time_s,force_N\n0,1\n1,nan\n", "finite"),
        ("time_s,force_N\n1,1\n0,2\n", "decreases"),
        ("time_s,force_N\n0,-1\n1,-2\n", "never above zero.*cure: multiply it by -1"),
        ("time_s,force_N\n0,0\n1,0\n", "never above zero.*cure: a column in which"),
    ],
)
def test_bad_measured_curves_are_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(BadInput, match=message):
        read_curve(path)
    with pytest.raises(BadInput, match="cannot be read"):
        read_curve(tmp_path / "nowhere.csv")


def test_reference_without_force_is_refused() -> None:
    silent = Curve(np.array([0.0, 1.0]), np.array([0.0, 0.0]))
    with pytest.raises(BadInput):
        score(silent, half_sine(1.0, 1.0))
