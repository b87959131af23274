"""Measured curves with columns, separators, numbers and rows that no measurement has."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumped import laws

CURVES = 4_000
FITTED = [name for name in laws.available() if name != "mdr"]  # which fits what ting does at a hundred times the cost
SEED = 20260513
LINES_OF_FITS = r"--law: |steel-ball\.toml: |.*curve\.csv: "
CELLS = ("", "nan", "inf", "-inf", "x", "1e400", "-1", "0", "1_0", "0x1", "\x1b[31m", "1;2", '"', "\u0661", "9" * 5000)
HEADERS = ("force_N,time_s", "time_s;force_N", "t,F", "", "time_s,force_N,time_s", "TIME_S,FORCE_N", "\ufefftime_s")


def pulse(rng: random.Random) -> tuple[list[list[str]], str]:
    """Rows of a half sine, of an impact's length or any other, and its header."""
    rows = rng.choice((0, 1, 2, 3, 20, 60))
    length, peak = 10.0 ** rng.uniform(-9, 3), 10.0 ** rng.uniform(-12, 12)
    if rng.random() < 0.7:
        length, peak = 6e-5, 13.0  # of a restitution that is one
    time = np.linspace(0.0, length, rows)
    force = peak * np.maximum(np.sin(np.pi * time / (0.9 * length)), 0.0)
    return [[repr(float(t)), repr(float(f))] for t, f in zip(time, force, strict=True)], "time_s,force_N"


def spoiled(rng: random.Random) -> bytes:
    """A curve changed in up to three ways."""
    rows, header = pulse(rng)
    text = ""
    for _ in range(rng.randrange(4)):
        way = rng.randrange(9)
        if way == 0:
            header = rng.choice(HEADERS)
        elif way == 1 and rows:
            row = rng.choice(rows)
            row[rng.randrange(len(row))] = rng.choice(CELLS)
        elif way == 2:
            rows.reverse()
        elif way == 3:
            rows = [[*row, "7"] for row in rows]
        elif way == 4 and rows:
            del rng.choice(rows)[1:]
        elif way == 5:
            rows = [[row[0], "-" + row[-1].lstrip("-")] for row in rows]
        elif way == 6:
            rows = rows[:1] * len(rows)
        elif way == 7:
            text = rng.choice(("\0", "\r", '"', "\n\n\n", "# no comment\n", ",,,,\n"))
        elif way == 8:
            rows = [[rng.choice(CELLS) for _ in row] for row in rows]
    separator = rng.choice((",", ",", ",", ",", ";", "\t", " "))
    content = (header + "\n" + text + "\n".join(separator.join(row) for row in rows)).encode("utf-8")
    bare = rng.random()
    if bare < 0.03:
        return rng.randbytes(300)
    if bare < 0.06:
        return content.decode("utf-8").encode("utf-16")
    return content[: rng.randrange(len(content) + 1)] if bare < 0.1 else content


@pytest.mark.tenth
def test_a_spoiled_curve_is_fitted_or_refused_by_name(
    tmp_path: Path,
    hundredth: Callable[[int], int],
    run: Callable[[Sequence[str]], Any],
    faults_of: Callable[..., list[str]],
) -> None:
    rng, wrong, codes = random.Random(SEED), [], set()
    curve = tmp_path / "curve.csv"
    for _ in range(hundredth(CURVES)):
        content = spoiled(rng)
        curve.write_bytes(content)
        command = ["fit", str(curve), "--law", rng.choice(FITTED), "--scene", "steel-ball"]
        ended = run(command)
        wrong += [f"{fault}\n{content[:300]!r}" for fault in faults_of(ended, LINES_OF_FITS, solves=True)]
        codes.add(ended.code)
    assert not wrong, "\n".join(wrong)
    assert codes >= {0, 2}, "both what is fitted and what is refused is among them"


@pytest.mark.tenth
def test_many_rows_are_thinned_with_a_word(tmp_path: Path, run: Callable[[Sequence[str]], Any]) -> None:
    """The means of neighbours tell the same parameter as all rows, to what the noise of the rows leaves open."""
    time = np.linspace(0.0, 6e-5, 20_000)
    force = 15.0 * np.maximum(np.sin(np.pi * time / 5.5e-5), 0.0) ** 1.5
    found = []
    for every in (1, 20):
        curve = tmp_path / f"curve{every}.csv"
        rows = np.column_stack([time, force])[::every]
        np.savetxt(curve, rows, delimiter=",", header="time_s,force_N", comments="")
        where = tmp_path / f"out{every}"
        ended = run(["fit", str(curve), "--law", "hertz", "--scene", "steel-ball", "--out", str(where)])
        assert ended.code == 0, ended
        found.append((ended.said, float((where / "parameters.csv").read_text().splitlines()[1].split(",")[1])))
    (thinned, many), (whole, few) = found
    assert any("each the mean of 10 neighbouring rows" in line for line in thinned)
    assert not any("neighbouring rows" in line and "mean" in line for line in whole)
    assert abs(many / few - 1.0) < 1e-3, "spacings of a thousandth of the contact"


def test_rows_without_end_are_refused_by_their_number(tmp_path: Path, run: Callable[[Sequence[str]], Any]) -> None:
    curve = tmp_path / "curve.csv"
    curve.write_text("time_s,force_N\n" + "1,1\n" * 1_000_001)
    ended = run(["fit", str(curve), "--law", "hertz", "--scene", "steel-ball"])
    assert (ended.code, ended.written) == (2, [])
    assert "more than 1000000 rows" in ended.said[0]
    assert ended.memory < 5e8
