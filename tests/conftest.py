"""Options, profiles and fixtures of every test."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg  # noqa: F401 - brings its own BLAS
from crowded import crowded
from hypothesis import settings
from matplotlib.figure import Figure
from threadpoolctl import threadpool_limits
from told import told_columns, untold

from fe_contact.assembly.disk_cache import without_disk
from fe_contact.cli import main
from fe_contact.studies import files, style
from lumped import Result

TENTH = 10
DIFFERING = ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse")

settings.register_profile("plain", derandomize=True, deadline=None, max_examples=TENTH)
settings.register_profile("tenth", derandomize=True, deadline=None, max_examples=TENTH**2)
settings.register_profile("full", derandomize=True, deadline=None, max_examples=TENTH**3)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--tenth", action="store_true", help="run all but the dearest, the random campaigns by a tenth")
    parser.addoption("--full", action="store_true", help="run every test, the random campaigns whole")
    parser.addoption("--after-plain", action="store_true", help="leave out what a plain run has just run to the letter")
    parser.addoption("--opensees", action="store_true", help="compare with openseespy too, which has to be installed")


def size_of(config: pytest.Config) -> str:
    """plain: one case of every slow family; tenth; full."""
    return "full" if config.getoption("--full") else "tenth" if config.getoption("--tenth") else "plain"


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "family: slow; a plain run takes its first case only")
    config.addinivalue_line("markers", "tenth: slow; a plain run leaves it out")
    config.addinivalue_line("markers", "full: slower still, and others say nearly the same; --full alone runs it")
    settings.load_profile(size_of(config))


def pytest_report_header(config: pytest.Config) -> str:
    return f"size: {size_of(config)}"


def in_plain_run(items: Iterable[pytest.Item]) -> set[pytest.Item]:
    """Every family once, nothing that takes long."""
    chosen, families = set[pytest.Item](), set[str]()
    for item in items:
        family = item.nodeid.partition("[")[0] if item.get_closest_marker("family") else ""
        if not (item.get_closest_marker("tenth") or item.get_closest_marker("full")) and family not in families:
            chosen.add(item)
            families |= {family} - {""}
    return chosen


def grows_with_size(item: pytest.Item) -> bool:
    """Whether a larger size draws more cases within the test: by hypothesis or by `campaign_size`."""
    drawn = isinstance(item, pytest.Function) and getattr(item.obj, "is_hypothesis_test", False)
    return drawn or "campaign_size" in getattr(item, "fixturenames", ())


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """The part of this size, less what a plain run has run where the same is said of it."""
    if size_of(config) == "full":
        return
    plain = in_plain_run(items)
    chosen = plain if size_of(config) == "plain" else {item for item in items if not item.get_closest_marker("full")}
    if size_of(config) == "tenth" and config.getoption("--after-plain"):
        chosen -= {item for item in plain if not grows_with_size(item)}
    config.hook.pytest_deselected(items=[item for item in items if item not in chosen])
    items[:] = [item for item in items if item in chosen]


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Tests of what only another program can say are there when asked for."""
    return True if collection_path.name == "test_openseespy.py" and not config.getoption("--opensees") else None


@pytest.fixture(scope="session")
def campaign_size(request: pytest.FixtureRequest) -> Callable[..., int]:
    """How many of a campaign's n cases to run: all with --full, a tenth with --tenth, else a hundredth, rounded up.

    `least`: as many as it takes to find what the campaign has to find; `most`: as many as a part of a dear one may
    cost. A campaign draws its cases one after the other from one seeded generator, so a part is the first of the whole
    and the same every day.
    """
    part = {"full": 1, "tenth": TENTH, "plain": TENTH**2}[size_of(request.config)]

    def size(n: int, least: int = 1, most: int | None = None) -> int:
        return n if part == 1 else min(max(-(-n // part), min(n, least)), most or n)

    return size


@pytest.fixture(scope="session", autouse=True)
def one_blas_thread() -> Iterator[None]:
    """Tests also call what stands behind the front doors, and only these give BLAS one thread."""
    with threadpool_limits(1, user_api="blas"):
        yield


@pytest.fixture(scope="session", autouse=True)
def cold() -> Iterator[None]:
    """Every test and every process that it starts computes for itself; those of the disk cache name a folder."""
    with without_disk():
        yield


@pytest.fixture(scope="session", autouse=True)
def charts_that_can_be_read(request: pytest.FixtureRequest) -> Iterator[None]:
    """No chart that a test draws has texts over each other or beyond its page; of a plain run the first of each."""
    saved, seen, plain = style.save, set[str](), size_of(request.config) == "plain"

    def looked_at(figure: Figure, where: Path, name: str) -> None:
        if not (plain and name in seen):
            seen.add(name)
            assert not (found := crowded(figure)), (name, found)
        saved(figure, where, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(style, "save", looked_at)
        yield


@pytest.fixture(scope="session", autouse=True)
def tables_that_are_told() -> Iterator[None]:
    """No table of a study that a test writes, and the manual's page of tables names, has a column which it does not."""
    written = files.write_csv

    def looked_at(path: Path, header: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
        columns = list(header)
        assert not (told_columns(path.name) and untold(path.name, columns)), (path.name, untold(path.name, columns))
        written(path, columns, rows)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(files, "write_csv", looked_at)
        yield


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def refused(empty: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., list[str]]:
    """The faults of a command line that is bad input, a line each: nothing else is said, and nothing is written."""

    def faults(*words: str) -> list[str]:
        assert main(list(words)) == 2
        said = capsys.readouterr()
        assert not said.out
        assert not list(empty.iterdir())
        return said.err.splitlines()

    return faults


@pytest.fixture(scope="session")
def uncovered() -> Callable[..., dict[str, float]]:
    """Of two results of one impact: what they differ by over the sum of both bars, by quantity, where that is above 1.

    Of these names, or of all that two results can differ by; what only one of them has counts as infinite.
    """

    def differences(one: Result, other: Result, names: Iterable[str] = DIFFERING) -> dict[str, float]:
        over = {}
        for name in names:
            first, second = one.quantities[name], other.quantities[name]
            if first.value is not None and second.value is not None:
                apart, bars = abs(first.value - second.value), (first.error or 0.0) + (second.error or 0.0)
                over[name] = 0.0 if apart <= bars else apart / bars if bars > 0.0 else np.inf
            elif first.value is not second.value:
                over[name] = np.inf
        return {name: ratio for name, ratio in over.items() if not ratio <= 1.0}

    return differences
