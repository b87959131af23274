"""Results change all at once or not at all: killed at any call of the system, side by side, on full disks."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumped.errors import CannotWrite
from lumped.result import folder as result_folder
from lumped.result.folder import HIDDEN, LOCK, checksum, publish
from lumped.schema.json_file import write_json

SCHEMA = "fe-contact/test/1"
OLDER = {"history.csv": "older", "plot.svg": "older, which the newer run does not draw"}
NEWER = {"history.csv": "newer", "fields.vtu": "newer, which the older run did not have"}


def writer(files: dict[str, str], record: str = "result.json") -> Callable[[Path], None]:
    def write(folder: Path) -> None:
        for name, text in files.items():
            (folder / name).write_text(text)
        write_json(folder / record, {"schema": SCHEMA, "made": "-".join(files)})

    return write


def content(folder: Path) -> dict[str, str]:
    """Every file with a name of its own, and its text; None of a run's own hidden names."""
    return {path.name: path.read_text() for path in folder.iterdir() if path.exists() and path.name[0] != "."}


def is_whole(folder: Path, files: dict[str, str]) -> bool:
    """The files are there, nothing else is, and the record names them all truly."""
    found = content(folder)
    record = json.loads(found.pop("result.json"))
    return found == files and record["files"] == {name: checksum(folder / name) for name in files}


def test_the_newer_files_replace_the_older_and_the_record_names_them(tmp_path: Path) -> None:
    where = tmp_path / "deep" / "results"
    publish(where, writer(OLDER))
    assert is_whole(where, OLDER)
    told = publish(where, writer(NEWER))
    assert is_whole(where, NEWER)
    assert told == json.loads((where / "result.json").read_text())
    assert {path.name for path in where.iterdir()} == {*NEWER, "result.json"}
    assert not any(path.is_symlink() for path in where.iterdir())


def test_another_commands_files_go_and_a_users_stay(tmp_path: Path) -> None:
    """Removed is only what a record of ours names, inside the folder, as it was written."""
    publish(tmp_path / "results", writer(OLDER | {"notes.txt": "ours"}))
    results, outside = tmp_path / "results", tmp_path / "outside.txt"
    outside.write_text("elsewhere")
    (results / "mine.txt").write_text("mine")
    (results / "mine.json").write_text('{"files": {"mine.txt": "x"}}')
    (results / "notes.txt").write_text("ours, and then somebody added a line")
    record = json.loads((results / "result.json").read_text())
    record["files"]["../outside.txt"] = checksum(outside)
    write_json(results / "result.json", record)
    publish(results, writer({"table1.csv": "rows"}, "table1.json"), "table1.json")
    assert set(content(results)) == {"table1.csv", "table1.json", "mine.txt", "mine.json", "notes.txt"}
    assert outside.read_text() == "elsewhere"


FULL = OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("failure", [FULL, KeyboardInterrupt(), ValueError()])
def test_what_fails_while_it_writes_leaves_the_older_result(tmp_path: Path, failure: BaseException) -> None:
    def broken(folder: Path) -> None:
        (folder / "history.csv").write_text("half a hist")
        raise failure

    publish(tmp_path, writer(OLDER))
    with pytest.raises(CannotWrite if isinstance(failure, OSError) else type(failure)):
        publish(tmp_path, broken)
    assert is_whole(tmp_path, OLDER)
    assert {path.name for path in tmp_path.iterdir()} == {*OLDER, "result.json"}


def test_a_folder_that_was_not_there_is_not_left_behind(tmp_path: Path) -> None:
    def full(folder: Path) -> None:
        raise FULL

    with pytest.raises(CannotWrite, match="No space left"):
        publish(tmp_path / "new", full)
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_is_a_folder_is_refused_before_anything_changes(tmp_path: Path) -> None:
    publish(tmp_path, writer({"plot.svg": "older"}))
    (tmp_path / "history.csv").mkdir()
    with pytest.raises(CannotWrite, match=r"history\.csv is a folder"):
        publish(tmp_path, writer(NEWER))
    assert (tmp_path / "plot.svg").read_text() == "older"


def test_without_links_files_are_replaced_one_by_one_the_record_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    publish(tmp_path, writer(OLDER))
    replaced: list[str] = []

    def refused(*_: object) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    own = os.replace
    monkeypatch.setattr(os, "link", refused)
    monkeypatch.setattr(os, "replace", lambda a, b: (replaced.append(Path(b).name), own(a, b)))
    publish(tmp_path, writer(NEWER))
    monkeypatch.undo()
    assert is_whole(tmp_path, NEWER)
    assert replaced[-1] == "result.json"


def test_a_run_that_keeps_the_lock_is_waited_for_and_then_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    publish(tmp_path, writer(OLDER))
    monkeypatch.setattr(result_folder, "WAIT", 0.1)
    with result_folder._alone(tmp_path), pytest.raises(CannotWrite, match="another run"):
        publish(tmp_path, writer(NEWER))
    assert is_whole(tmp_path, OLDER)
    (tmp_path / LOCK).write_text("")  # of an owner that was killed: nobody holds it
    publish(tmp_path, writer(NEWER))
    assert is_whole(tmp_path, NEWER)


# One process that forks: each child is killed at its k-th call of the operating system, until one comes through.
KILLED_AT_EVERY_CALL = """
import os, signal, sys
from pathlib import Path
sys.path[:0] = [sys.argv[2], sys.argv[3]]
from test_result_folder import NEWER, OLDER, content, is_whole, writer
from lumped.result.folder import publish

CALLS = ("mkdir", "link", "symlink", "replace", "unlink", "fsync", "rmdir", "open", "scandir", "readlink")

def killed_at(call):
    count = 0
    def counted(own):
        def stand_in(*arguments, **named):
            nonlocal count
            count += 1
            if count == call:
                os.kill(os.getpid(), signal.SIGKILL)
            return own(*arguments, **named)
        return stand_in
    for name in CALLS:
        setattr(os, name, counted(getattr(os, name)))

root, call, seen = Path(sys.argv[1]), 0, set()
while True:
    call += 1
    where = root / str(call)
    publish(where, writer(OLDER))
    child = os.fork()
    if child == 0:
        killed_at(call)
        publish(where, writer(NEWER))
        os._exit(0)
    _, status = os.waitpid(child, 0)
    older, newer = is_whole(where, OLDER), is_whole(where, NEWER)
    assert older != newer, (call, content(where))
    seen.add(newer)
    publish(where, writer({"other.csv": "a third"}))
    assert is_whole(where, {"other.csv": "a third"}), (call, content(where))
    assert {path.name for path in where.iterdir()} == {"other.csv", "result.json"}, call
    if status == 0:
        break
assert seen == {False, True}
print(call)
"""


@pytest.mark.tenth
def test_killed_at_any_call_it_leaves_one_result_whole_and_the_next_run_tidies_up(tmp_path: Path) -> None:
    own = Path(__file__).resolve()
    arguments = [str(tmp_path), str(own.parent), str(own.parents[2])]
    command = [sys.executable, "-c", KILLED_AT_EVERY_CALL, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 40  # so many calls there were


SIDE_BY_SIDE = """
import sys
from pathlib import Path
from lumped.schema.json_file import write_json
from lumped.result.folder import publish

own, rounds = sys.argv[2], int(sys.argv[3])

def write(folder):
    for name in ("history.csv", f"only-{own}.csv"):
        (folder / name).write_text(own * 100_000)
    write_json(folder / "result.json", {"schema": "fe-contact/test/1", "own": own})

for _ in range(rounds):
    publish(Path(sys.argv[1]), write)
"""


@pytest.mark.tenth
def test_eight_runs_into_one_folder_leave_one_of_them_whole(
    tmp_path: Path, campaign_size: Callable[[int], int]
) -> None:
    root, rounds = Path(__file__).resolve().parents[2], str(campaign_size(20))
    command = [sys.executable, "-c", SIDE_BY_SIDE, str(tmp_path)]
    runs = [subprocess.Popen([*command, str(own), rounds], cwd=root, stderr=subprocess.PIPE) for own in range(8)]
    assert [run.wait(timeout=300) for run in runs] == [0] * 8, [run.stderr and run.stderr.read() for run in runs]
    for run in runs:
        assert run.stderr is not None
        run.stderr.close()
    own = json.loads((tmp_path / "result.json").read_text())["own"]
    assert is_whole(tmp_path, dict.fromkeys(("history.csv", f"only-{own}.csv"), own * 100_000))
    assert not list(tmp_path.glob(f"{HIDDEN}*"))


def test_no_two_changes_of_the_command_line_share_a_default_folder() -> None:
    from fe_contact.commands.base import LONGEST, _part_of_a_name

    rng = np.random.default_rng(12)
    letters = [*"ab=.-_ /\\\n\0äé\x1b", "0.1", "striker.velocity"]
    texts = {"".join(rng.choice(letters, size=rng.integers(1, 60))) for _ in range(2000)}
    parts = {_part_of_a_name(text) for text in texts}
    assert len(parts) == len(texts)
    assert all(len(part) <= LONGEST + 9 and not set(part) & set("/\\\n\0\x1b ") for part in parts)
    assert _part_of_a_name("-striker.velocity=0.03") == "-striker.velocity=0.03"
