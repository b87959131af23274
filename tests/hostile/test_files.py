"""Files that are none, without end, too deep, too long, or written to move a terminal."""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

MOST_SCENE, MOST_CURVE = 100_000, 50_000_000
SOUND = '[striker]\nshape = "sphere"\nradius = 0.01\nmass = 0.02\nvelocity = 0.5\n[target]\nshape = "half_space"\n'
MEASURED = SOUND + '[target.material]\nlaw = "measured"\nfile = "{}"\nnu = 0.3\n'
DEEP, WIDE = 20_000, 40_000
TEXTS: dict[str, str] = {
    "empty": "",
    "blank": "\n" * MOST_SCENE,
    "too long": "#" * (MOST_SCENE + 1),
    "dots": "a" + ".a" * WIDE + " = 1",
    "dots in a header": "[a" + ".a" * WIDE + "]",
    "quoted dots": '"a"' + '."a"' * DEEP + " = 1",
    "spaced dots": "a" + " . a" * DEEP + " = 1",
    "dots after texts": "b = \"\\\" # # ''' [[\"\na" + ".a" * DEEP + " = 1",
    "brackets": "a = " + "[" * WIDE + "]" * WIDE,
    "open brackets": "a = " + "[" * WIDE,
    "closed, then open": "]" * WIDE + "[" * WIDE,
    "braces": "a = " + "{a=" * DEEP + "1" + "}" * DEEP,
    "open text": 'a = "' + '\\"' * WIDE,
    "open long text": 'a = """' + '\\"' * WIDE + "\\",
    "many quotes": "a = " + '"' * WIDE,
    "one long key": "a" * 90_000 + " = 1",
    "one long text": f'name = "{"a" * 90_000}"',
    "one long line": "a" * 90_000,
    "many keys": "".join(f"k{i} = 1\n" for i in range(9_000)),
    "many settings": SOUND + "[numerics]\n" + "".join(f"k{i} = 1\n" for i in range(8_000)),
    "many tables": "".join(f"[t{i}.b.c.d.e.f.g.h.i.j.k]\n" for i in range(3_000)),
    "many of one table": "[[a]]\n" * 15_000,
    "many numbers": f"{SOUND}[target.material]\nlaw = 'prony'\nE = {[1.0] * 15_000}\n",
    "digits": "[striker]\nradius = " + "9" * 90_000,
    "hexadecimal digits": "[striker]\nradius = 0x" + "9" * 90_000 + "\n",
    "steps of many digits": SOUND + "[numerics]\nsteps = 0x" + "f" * 9_000,
    "twice": "[striker]\nmass = 1\nmass = 2\n",
    "a table twice": "[striker]\n[striker]\n",
    "escapes": '"\\u001b[31mred\\u202e\\u0007" = 1\n[striker]\nshape = "\\u001b[2J"\nradius = "\\u009b\\n"\n',
    "escapes in a raw text": "[striker]\nshape = '\x9b2J\u2028'\n",
    "nulls": "\0" * 1000,
    "carriage returns": SOUND.replace("\n", "\r"),
    "a table for a number": SOUND.replace("0.01", "{a = {b = {c = 1}}}"),
    "no such material's file": MEASURED.format("none.csv"),
    "a device as a material": MEASURED.format("/dev/zero"),
    "memory as a material": MEASURED.format("/proc/self/mem"),
    "a folder as a material": MEASURED.format("."),
    "a name with a null": MEASURED.format("\\u0000"),
    "a name too long": MEASURED.format("a" * 5_000),
}
BYTES: dict[str, bytes] = {
    "utf-16": SOUND.encode("utf-16"),
    "utf-32": SOUND.encode("utf-32"),
    "latin-1": "name = 'Stoß'".encode("latin-1"),
    "surrogates": b"name = '\xed\xa0\x80'",
    "noise": random.Random(1).randbytes(MOST_SCENE),
    "a compressed file": b"\x1f\x8b\x08\x00" + random.Random(2).randbytes(900),
}
DEVICES = ("/dev/zero", "/dev/full", "/dev/stdin", "/dev/random")
PLACES = (*DEVICES, "/proc/self/mem", "/proc/kmsg", "/", "none.toml", "a\0b.toml")
NAMES = ("\x1b[31mred.toml", "a\nb.toml", "\u202egnp.toml", os.fsdecode(b"\xff\xfe.toml"), ".toml", "a" * 250 + ".toml")
LINE = r".+?: .+"


@pytest.mark.family
@pytest.mark.parametrize("name", [*TEXTS, *BYTES])
def test_a_hostile_scene_is_refused_by_name(
    tmp_path: Path, name: str, run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_bytes(BYTES[name] if name in BYTES else TEXTS[name].encode("utf-8"))
    for command in (["plan", str(scene)], ["ptmd", str(scene)], ["pound", str(scene)]):
        ended = run(command)
        assert not faults_of(ended, LINE)
        assert ended.code == 2
        assert ended.memory < 3e8


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("command", [["plan"], ["ptmd"], ["pound"], ["fit", "--law", "hertz", "--scene", "steel-ball"]])
def test_what_is_no_regular_file_is_refused(
    place: str, command: list[str], run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    ended = run([command[0], place, *command[1:]])
    assert not faults_of(ended, LINE)
    assert ended.code == 2


def test_a_pipe_is_not_waited_for(tmp_path: Path, run: Callable[[Sequence[str]], Any]) -> None:
    pipe = tmp_path / "scene.toml"
    os.mkfifo(pipe)
    for command in (["plan", str(pipe)], ["compare", "steel-ball", "--measured", str(pipe)]):
        ended = run(command)
        assert ended.code == 2
        assert "no regular file" in ended.said[0]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_moves_a_terminal_is_told_in_escapes(
    tmp_path: Path, name: str, run: Callable[[Sequence[str]], Any], faults_of: Callable[..., list[str]]
) -> None:
    scene = tmp_path / name
    scene.write_text(SOUND)
    for command in (["plan", str(scene)], ["run", str(scene), "--method", "hertz"], [str(scene)], ["plan", "-" + name]):
        ended = run(command)
        assert not faults_of(ended, LINE)
        assert ended.code == 2


def test_a_curve_larger_than_any_measurement_is_refused(tmp_path: Path, run: Callable[[Sequence[str]], Any]) -> None:
    curve = tmp_path / "curve.csv"
    with curve.open("wb") as file:
        file.truncate(10 * MOST_CURVE)  # of zeros, which take no room
    ended = run(["fit", str(curve), "--law", "hertz", "--scene", "steel-ball"])
    assert ended.code == 2
    assert "larger than" in ended.said[0]
    assert ended.memory < 3e8


def test_a_mark_before_the_text_is_no_part_of_it(tmp_path: Path, run: Callable[[Sequence[str]], Any]) -> None:
    """Editors on Windows write one."""
    scene = tmp_path / "scene.toml"
    scene.write_text(SOUND + '[target.material]\nlaw = "elastic"\nE = 1e6\nnu = 0.3\n', encoding="utf-8-sig")
    assert run(["plan", str(scene)]).code == 0
