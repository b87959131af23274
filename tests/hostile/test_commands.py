"""Command lines with options unknown, doubled, of other commands and without their values, and with any text."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

COMMANDS = 500
SEED = 20260514
NAMES = ("run", "indent", "plan", "compare", "tradeoff", "fit", "ptmd", "paper", "scenes", "laws", "restitution", "rum")
# What asks for nothing that takes long: the others are here with words that they refuse.
WORDS = (
    "steel-ball", "steel-bal", "pounding-steel-jankowski", "paper", "", ".", "/", "/dev/null", "/dev/zero", "no.toml",
    "\x1b[2J", "\u202etxet", "a\nb", "\udcff", "-1", "--", "-", "nan", "9" * 5000, "a" * 50_000, "\0",
)  # fmt: skip
OPTIONS = (
    "--method", "--tolerance", "--set", "--out", "--depths", "--law", "--scene", "--free", "--fix", "--bounds",
    "--laws", "--measured", "--opensees", "--jobs", "--json", "--quiet", "--instant", "--fields", "--peak", "--quick",
    "--hlep", "--meth", "-x", "--\x1b[31m",
)  # fmt: skip
VALUES = (
    "hertz", "cheapes", "1e-3", "1e400", "x", "striker.radius=1", "striker.radius", "=", "a.b.c=[[[[1]]]]",
    "a" + ".a" * 500 + "=1", "striker.mass=" + "[" * 5000, "striker.mass=" + "9" * 5000, "striker.mass=0x" + "9" * 9000,
    "striker.shape=\x1b[2J", "\x1b]0;x\x07=1", "striker.mass=1\nmodel.gravity=2", "name=\udcff", "numerics.steps=1e400",
    "/proc/out", "/dev/null", "", "k=1:2", "k=2:1", "k=nan", "k", *WORDS,
)  # fmt: skip
QUICK = {"run": ("--method", "hertz"), "indent": ("--method", "mdr", "--depths", "1e-6")}
LONG = ("compare", "tradeoff", "paper", "restitution")  # these never run: an unknown option goes with them


def command_line(rng: random.Random) -> list[str]:
    name = rng.choice(NAMES)
    line = [name, *rng.choices(WORDS, k=rng.choice((0, 1, 1, 1, 2)))]
    for _ in range(rng.randrange(4)):
        line += [rng.choice(OPTIONS), *rng.choices(VALUES, k=rng.choice((0, 1, 1, 1)))]
    line += QUICK.get(name, ()) if rng.random() < 0.7 else ("--unknown",)
    return [*line, "--unknown"] if name in LONG else line


def test_any_command_line_ends_with_one_line_a_fault(
    campaign_size: Callable[[int], int], run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    rng, wrong = random.Random(SEED), []
    for _ in range(campaign_size(COMMANDS)):
        ended = run(command_line(rng))
        wrong += faults_of(ended, r"fe-contact[\w -]*: .*--help$|--\w+: |[^:]*: ")
    assert not wrong, "\n".join(wrong)


@pytest.mark.family
@pytest.mark.parametrize(
    "command", ["run", "compare", "tradeoff", "indent", "fit", "ptmd", "pound", "paper", "ring", "table1"]
)
@pytest.mark.parametrize("out", ["/proc/none", "/dev/null/x", "a\x1b[31mb"])
def test_a_folder_that_cannot_be_written_is_refused_before_the_work(
    tmp_path: Path, command: str, out: str, run: Callable[[Sequence[str]], Any]
) -> None:
    curve = tmp_path / "curve.csv"
    curve.write_text("time_s,force_N\n0,0\n1,1\n2,0\n")
    own = {
        "fit": [str(curve), "--law", "hertz", "--scene", "steel-ball"],
        "indent": ["steel-ball", "--depths", "1e-6"],
        "pound": ["two-frames"],
    }
    scene = [] if command in ("ptmd", "paper", "ring", "table1") else ["steel-ball"]
    ended = run([command, *own.get(command, scene), "--out", out])
    assert ended.code == 2
    assert len(ended.said) == 1
    assert ended.said[0].startswith("--out: ")
    assert ended.cpu < 5.0, "nothing is solved before"
