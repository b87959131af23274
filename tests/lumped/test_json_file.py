"""Dataclasses as plain data and back: every digit, every kind, and what is given by its place."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from lumped import Scene, laws, simulate
from lumped.paper.table1 import ROWS, PunchRow, TableRow
from lumped.result.result import Quantity, Result
from lumped.schema.json_file import decoded, encoded


class Pair(NamedTuple):
    first: float
    second: str


@dataclass(frozen=True, eq=False)
class Leaf:
    name: str
    values: NDArray[np.float64]
    pair: Pair
    flag: bool


@dataclass(frozen=True, eq=False)
class Tree:
    number: float
    perhaps: float | None
    leaf: Leaf | None
    leaves: tuple[Leaf, ...]
    both: tuple[int, str]
    by_number: Mapping[float, Quantity]
    by_name: Mapping[str, Mapping[str, float | None]]
    anything: Mapping[str, Any]


NUMBERS = st.floats()  # NaN, infinities, -0.0 and subnormals too
PLAIN = st.recursive(st.none() | st.booleans() | st.integers() | NUMBERS | st.text(), st.lists, max_leaves=5)
LEAVES = st.builds(Leaf, st.text(), st.lists(NUMBERS).map(np.array), st.builds(Pair, NUMBERS, st.text()), st.booleans())
TREES = st.builds(
    Tree,
    NUMBERS,
    st.none() | NUMBERS,
    st.none() | LEAVES,
    st.lists(LEAVES, max_size=3).map(tuple),
    st.tuples(st.integers(), st.text()),
    st.dictionaries(st.floats(allow_nan=False), st.builds(Quantity, st.none() | NUMBERS, NUMBERS, st.text())),
    st.dictionaries(st.text(), st.dictionaries(st.text(), st.none() | NUMBERS)),
    st.dictionaries(st.text(), PLAIN),
)


def same(one: Any, other: Any) -> bool:
    """Of one kind and, to the bit, of one value."""
    if type(one) is not type(other):
        return False
    if isinstance(one, Tree | Leaf | Quantity | Result):
        return same(vars(one), vars(other))
    if isinstance(one, np.ndarray):
        return same(one.tolist(), other.tolist())
    if isinstance(one, dict):
        return same(list(one.items()), list(other.items()))
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float):
        return one.hex() == other.hex()
    return bool(one == other)


def back(kind: Any, value: Any, *arguments: Any) -> Any:
    return decoded(kind, json.loads(json.dumps(encoded(value, arguments))), arguments)


@pytest.mark.tenth
@given(TREES)
def test_what_is_kept_comes_back_to_the_bit(tree: Tree) -> None:
    assert same(back(Tree, tree), tree)


def test_numbers_of_numpy_come_back_as_pythons() -> None:
    """With all their digits, as keys too."""
    found = back(Mapping[float, Any], {np.float64(0.1): [np.float64(1 / 3), np.int64(3), np.bool_(True)]})
    assert same(found, {0.1: [1 / 3, 3, True]})


def test_what_was_given_is_not_kept_but_taken() -> None:
    """By its value: another one of its kind is no argument."""
    row, other = ROWS["punch"], PunchRow(radius=0.02)
    content = encoded({"row": row, "other": other}, (1.0, row))
    assert content["other"] == {"radius": 0.02}
    assert decoded(Mapping[str, TableRow], {"row": content["row"]}, (1.0, row))["row"] is row


def test_a_result_comes_back_whole() -> None:
    """A scene is what it is of; what is written of it is the same."""
    scene = Scene.load("polymer-sphere")
    result = simulate(laws.ting.of(scene), scene, 1e-3)
    again = back(Result, result, scene)
    assert again.scene is scene
    assert again.to_json() == result.to_json()
    np.testing.assert_array_equal(again.history.force, result.history.force)


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, -0.0, 5e-324])
def test_no_number_is_too_odd(number: float) -> None:
    assert same(back(float, number), number)
