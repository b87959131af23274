"""Options, profiles and fixtures of every test."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

TENTH = 10

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
