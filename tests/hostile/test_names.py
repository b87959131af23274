"""Whoever refuses, a part, a mesh or a fit: the line names the file and the key, or the option, of the user."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

MANY = "9" * 9000
REFUSED = [
    ("plan polymer-washer --set target.inner_radius=1", "--set: target.inner_radius: 1: accepted below"),
    ("plan polymer-o-ring --set target.section_radius=1", "--set: target.section_radius: 1: accepted"),
    ("plan rod-in-ring --set target.thickness=1e-9", "--set: target.thickness: 1e-09: accepted from"),
    ("plan polymer-layer --set striker.velocity=2", "--set: striker.velocity: a depth of"),
    ("indent polymer-layer --method ting --depths 1", "--depths: 1: accepted below the layer's thickness"),
    ("run polymer-prism --set striker.height=1e4", "--set: striker.area, striker.height: half of the"),
    ("run polymer-prism --set striker.height=1e-9", "--set: striker.area, striker.height: half of the"),
    ("run rod --method ting", "rod.toml: target.shape: no exact load curve"),
    ("run polymer-half-plane --method mdr", "polymer-half-plane.toml: target.shape: "),
    ("run polymer-prism --set striker.faces=bonded --method ting", "--set: striker.faces: bonded: no"),
    ("run polymer-sphere --tolerance 5", "--tolerance: 5.0: accepted a number from 1e-06 to 0.1"),
    ("plan rod --set model.inertia=false", "--set: model.inertia: missing or false"),
    (f"plan steel-ball --set striker.radius=0x{MANY}", "--set: striker.radius: a number of thousands"),
    (f"plan steel-ball --set striker.radius={MANY}", "--set: striker.radius: a number has thousands of digits"),
    (f"plan steel-ball --set numerics.steps=1{'0' * 400}", "--set: numerics.steps: 1000"),
    (f"plan steel-ball --set striker.radius={'[' * 500}", "--set: striker.radius: nested too deep"),
    (f"plan steel-ball --set a{'.a' * 500}=1", "--set: a.a.a"),
    ("fit CURVE --scene steel-ball --law hert", "--law: 'hert' is not known"),
    ("fit CURVE --scene steel-ball --law hertz --free q", "--free: q: unknown parameter"),
    ("fit CURVE --scene steel-ball --law hertz --fix alpha=-1", "--fix: alpha: -1.0 is not accepted"),
    ("fit CURVE --scene steel-ball --law hertz --bounds k=2:1", "--bounds: k: 2:1 is empty"),
    ("fit CURVE --scene steel-ball --law correspondence --free R1", "--free: R2: missing"),
    ("fit CURVE --scene bar-impact --law hertz", "bar-impact.toml: striker.mass: 0: a lumped law moves"),
    ("ptmd --set motion.end_time=1e9", "--set: motion.end_time: more than 100000 rows"),
    ("pound two-frames --set motion.end_time=1e9", "--set: motion.end_time: more than 100000 rows"),
    ("pound two-frames --set gap.first.left=4", "--set: gap.first.left: 4; accepted: 1 to 3"),
    ("pound two-frames --set law.e=0", "--set: law.e: 0 is not accepted"),
    ("ptmd --set motion.displacement=0", "--set: motion.displacement: nothing moves"),
]
# What once was a defect of ours: a surface drawn out by its weight, depths near the least number there is.
ANSWERED = (
    "plan two-spheres --set model.gravity=-1e5",
    "run two-spheres --set model.gravity=-1e6 --method ting",
    "run polymer-sphere --set model.gravity=-1e6 --method cheapest",
)


@pytest.fixture
def curve(tmp_path: Path) -> str:
    path = tmp_path / "curve.csv"
    rows = (f"{i}e-6,{15.0 * math.sin(math.pi * i / 40.0) ** 1.5}" for i in range(41))  # of a restitution below one
    path.write_text("\n".join(["time_s,force_N", *rows]))
    return str(path)


@pytest.mark.parametrize(("command", "named"), REFUSED, ids=[command[:60] for command, _ in REFUSED])
def test_who_refuses_names_what_the_user_wrote(
    command: str, named: str, curve: str, run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    ended = run([curve if word == "CURVE" else word for word in command.split()])
    assert not faults_of(ended, re.escape(named))
    assert ended.code == 2


@pytest.mark.parametrize("command", ANSWERED)
def test_extremes_end_with_an_answer_or_a_named_failure(
    command: str, run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    ended = run(command.split())
    assert not faults_of(ended, ".")
    assert ended.code in (0, 3)
