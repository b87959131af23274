"""Known geometries on disk: the same bits, no mesh, and nothing that spoils, kills or fills the folder is ever seen."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import fe_contact
from fe_contact import threads
from fe_contact.assembly import cache, disk_cache
from fe_contact.assembly.cache import BODIES, Store
from fe_contact.assembly.disk_cache import BOUND, OFF, PLACE, entries
from fe_contact.cli import main
from fe_contact.targets import half_space
from lumped import Result, Scene

ASKED = (0.3, 1.0, 2, 5.0)  # of a coarse half-space, meshed in milliseconds
PROBE = """
import sys, fe_contact
from lumped import Scene
found = fe_contact.run(Scene.load(sys.argv[1]), 1e-2)
print(found.history.force.tobytes().hex())
print(*sorted({"skfem", "gmsh", "scipy.sparse.linalg"} & set(sys.modules)))
"""
WRITER = """
from fe_contact.assembly import disk_cache
from fe_contact.targets import half_space
read, disk_cache._read = disk_cache._read, lambda path: None
while True:
    half_space._operator(0.3, 1.0, 2, 5.0)
    print("written", flush=True)
"""


@pytest.fixture
def disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder of answers."""
    monkeypatch.setenv(PLACE, str(tmp_path / "disk"))
    return tmp_path / "disk"


def forgotten(name: str) -> Result:
    """A run by a process that remembers nothing."""
    cache._BODIES = Store(BODIES)
    return fe_contact.run(Scene.load(name), 1e-2)


def in_a_process(name: str) -> tuple[str, str]:
    """Bytes of the force, and what was loaded of all that a known geometry needs none of."""
    done = subprocess.run([sys.executable, "-c", PROBE, name], capture_output=True, text=True, check=True)
    force, loaded = done.stdout.split("\n")[:2]
    return force, loaded


def bits(found: Result) -> list[object]:
    history = found.history
    columns = [column.tobytes() for column in (history.time, history.depth, history.force, history.contact_radius)]
    return [*columns, found.quantities, found.error_budget, found.energy, found.work]


@pytest.mark.family
@pytest.mark.parametrize(
    "name",
    [
        *("polymer-sphere", "polymer-layer", "rod-in-ring", "polymer-punch", "polymer-half-plane"),
        pytest.param("polymer-o-ring", marks=pytest.mark.full),
    ],
)
def test_numbers_with_and_without_are_the_same_to_the_bit(name: str, disk: Path) -> None:
    cold, files = forgotten(name), entries(disk)
    warm = forgotten(name)
    assert files
    assert {path for _, _, path in entries(disk)} == {path for _, _, path in files}, "nothing new was made"
    with disk_cache.without_disk():
        without = forgotten(name)
    assert bits(cold) == bits(warm) == bits(without)


@pytest.mark.tenth
def test_a_body_of_constant_bulk_modulus_is_known_too(disk: Path) -> None:
    scene = Scene.load("polymer-layer", {"target.material.constant": "bulk"})
    found = []
    for _ in range(2):
        cache._BODIES = Store(BODIES)
        found.append(bits(fe_contact.run(scene, 1e-2)))
        files = len(entries(disk))
    assert found[0] == found[1]
    assert files > 0


@pytest.mark.family
@pytest.mark.parametrize(
    ("name", "needed"),
    [
        ("polymer-sphere", ""),
        ("polymer-layer", ""),
        pytest.param("rod-in-ring", "scipy.sparse.linalg", marks=pytest.mark.full),  # a part of scipy.optimize
    ],
)
def test_a_known_geometry_loads_no_mesher_and_no_sparse_solver(name: str, needed: str, disk: Path) -> None:
    (force, loaded), (again, loaded_again) = in_a_process(name), in_a_process(name)
    assert force == again
    assert loaded == "gmsh scipy.sparse.linalg skfem"
    assert loaded_again == needed


def only(disk: Path) -> Path:
    (_, _, path), *others = entries(disk)
    assert not others
    return path


@pytest.mark.parametrize("spoil", ["flip", "cut", "empty"])
def test_a_spoiled_file_is_no_answer_and_is_written_anew(spoil: str, disk: Path) -> None:
    expected = half_space._operator(*ASKED)
    path = only(disk)
    whole = path.read_bytes()
    rng = random.Random(20261125)
    for _ in range(5):
        place = rng.randrange(len(whole))
        flipped = whole[:place] + bytes([whole[place] ^ (1 << rng.randrange(8))]) + whole[place + 1 :]
        path.write_bytes({"flip": flipped, "cut": whole[:place], "empty": b""}[spoil])
        found = half_space._operator(*ASKED)
        assert found.response.tobytes() == expected.response.tobytes()
        assert path.read_bytes() == whole


def test_a_killed_writer_leaves_whole_answers_or_none(disk: Path) -> None:
    with disk_cache.without_disk():
        expected = half_space._operator(*ASKED)
    rng = random.Random(20261125)
    for _ in range(3):
        writer = subprocess.Popen([sys.executable, "-c", WRITER], stdout=subprocess.PIPE, text=True)
        assert writer.stdout is not None
        assert writer.stdout.readline() == "written\n"
        for _ in range(7):
            time.sleep(rng.uniform(0.0, 0.02))
            os.kill(writer.pid, signal.SIGSTOP)
            for _, _, path in entries(disk):
                assert path.suffix != ".npz" or disk_cache._read(path) is not None
            os.kill(writer.pid, signal.SIGCONT)
        writer.kill()
        writer.wait()
        writer.stdout.close()
        assert half_space._operator(*ASKED).response.tobytes() == expected.response.tobytes()
    assert main(["cache", "--clear"]) == 0
    assert not list(disk.iterdir()), "what was begun has gone too"


@pytest.mark.tenth
def test_processes_may_share_the_folder(disk: Path) -> None:
    writers = [subprocess.Popen([sys.executable, "-c", PROBE, "polymer-punch"], stdout=subprocess.PIPE, text=True)]
    writers += [subprocess.Popen([sys.executable, "-c", PROBE, "polymer-punch"], stdout=subprocess.PIPE, text=True)]
    told = {writer.communicate()[0].split("\n")[0] for writer in writers}
    assert len(told) == 1
    assert all(path.suffix == ".npz" and disk_cache._read(path) for _, _, path in entries(disk))


def test_the_folder_keeps_its_bound_and_the_last_used(disk: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    half_space._operator(*ASKED)
    first = only(disk)
    size = first.stat().st_size
    monkeypatch.setenv(BOUND, str(3.5 * size / 2**20))
    for age, nu in enumerate((0.1, 0.2, 0.4, 0.45)):
        for older, _, path in entries(disk):
            os.utime(path, (older - 10.0, older - 10.0))
        half_space._operator(*ASKED)  # used, hence young
        half_space._operator(nu, *ASKED[1:])
        files = entries(disk)
        assert sum(size for _, size, _ in files) <= 3.5 * size
        assert len(files) == min(age + 2, 3)
        assert first in [path for _, _, path in files]
    monkeypatch.setenv(BOUND, "0")
    half_space._operator(0.05, *ASKED[1:])
    assert len(entries(disk)) == 3, "what has no room is not written"


def test_a_bound_that_is_none_is_bad_input(
    disk: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(BOUND, "much")
    assert main(["cache"]) == 2
    assert BOUND in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_nothing_to_talk_about(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(PLACE, str(tmp_path / "file" / "disk"))
    assert half_space._operator(*ASKED).order == 2
    monkeypatch.setenv(PLACE, "/proc/self/no")
    assert half_space._operator(*ASKED).order == 2


def test_another_version_is_another_question(disk: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib.metadata

    half_space._operator(*ASKED)
    known, version = entries(disk), importlib.metadata.version
    for package in ("fe-contact", "numpy", "scipy", "scikit-fem", "gmsh"):
        other = {package: "0.0.1"}
        monkeypatch.setattr(importlib.metadata, "version", lambda name, other=other: other.get(name) or version(name))
        disk_cache._maker.cache_clear()
        half_space._operator(*ASKED)
        assert len(entries(disk)) == len(known) + 1
        known = entries(disk)
    monkeypatch.undo()
    disk_cache._maker.cache_clear()


def test_another_processor_is_another_question(disk: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    half_space._operator(*ASKED)
    assert threads.blas()
    monkeypatch.setattr(disk_cache, "blas", lambda: ["openblas 0.0 Z80"])
    half_space._operator(*ASKED)
    assert len(entries(disk)) == 2


@pytest.mark.family
@pytest.mark.parametrize("way", ["environment", "option"])
def test_it_is_off_with_one_key(way: str, disk: Path, empty: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if way == "environment":
        monkeypatch.setenv(PLACE, OFF)
    cache._BODIES = Store(BODIES)
    arguments = ["run", "polymer-punch", "--tolerance", "1e-2", "--quiet", "--out", str(empty / "out")]
    assert main([*arguments, *(["--no-cache"] if way == "option" else [])]) == 0
    assert not disk.exists()
    assert os.environ[PLACE] == (OFF if way == "environment" else str(disk))


def test_the_users_cache_folder_is_the_platforms(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(PLACE, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "local"))
    for platform, where in (("linux", "xdg"), ("darwin", "Library/Caches"), ("win32", "local")):
        monkeypatch.setattr(sys, "platform", platform)
        assert disk_cache.folder() == tmp_path / where / "fe-contact"
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", "not/absolute")
    assert disk_cache.folder() == tmp_path / ".cache" / "fe-contact"


def test_the_command_shows_and_clears_its_own_alone(disk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    half_space._operator(*ASKED)
    (disk / "mine.npz").write_text("not ours")
    size = only(disk).stat().st_size
    assert main(["cache", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told == {"folder": str(disk), "entries": 1, "bytes": size, "most_bytes": 512 * 2**20}
    assert main(["cache", "--clear"]) == 0
    assert "0 entries" in capsys.readouterr().out
    assert [path.name for path in disk.iterdir()] == ["mine.npz"]
