"""Options, profiles and fixtures of every test."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg  # noqa: F401 - brings its own BLAS
from hypothesis import settings
from threadpoolctl import threadpool_limits

from lumped import Result

TENTH = 10
DIFFERING = ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse")

settings.register_profile("tenth", derandomize=True, deadline=None, max_examples=100)
settings.register_profile("full", derandomize=True, deadline=None, max_examples=100 * TENTH)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="run the random campaigns whole, not a seeded tenth")
    parser.addoption("--opensees", action="store_true", help="compare with openseespy too, which has to be installed")


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("full" if config.getoption("--full") else "tenth")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Tests of what only another program can say are there when asked for."""
    return True if collection_path.name == "test_openseespy.py" and not config.getoption("--opensees") else None


@pytest.fixture(scope="session")
def campaign_size(request: pytest.FixtureRequest) -> Callable[[int], int]:
    """How many of a campaign's n cases to run: all with --full, else a tenth, rounded up.

    A campaign draws its cases one after the other from one seeded generator, so the tenth is the first
    part of the whole and the same every day.
    """
    full: bool = request.config.getoption("--full")
    return lambda n: n if full else -(-n // TENTH)


@pytest.fixture(scope="session", autouse=True)
def one_blas_thread() -> Iterator[None]:
    """Tests also call what stands behind the front doors, and only these give BLAS one thread."""
    with threadpool_limits(1, user_api="blas"):
        yield


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


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
