"""What is kept: asked twice and made once, the least recent forgotten first, never more than there is room for."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np

from fe_contact.assembly.cache import BODIES, UNKNOWNS, Store, cached, cached_by_unknowns


class Thing:
    """Can be watched while it lives."""


def counted(store: Store, size: float = 1.0) -> tuple[Callable[[int], Thing], list[int]]:
    """Answers of a store, and the keys for which one had to be made."""
    made: list[int] = []

    def new(key: int) -> Thing:
        made.append(key)
        return Thing()

    return lambda key: store.find((key,), lambda: new(key), lambda _: size), made


def test_the_last_ones_asked_for_are_made_once() -> None:
    """Against the rule itself, on random questions: an answer is made anew if three others were asked for since."""
    find, made = counted(Store(3.0))
    asked = np.random.default_rng(5).integers(0, 6, 200).tolist()
    expected, recent = [], list[int]()
    for key in asked:
        find(key)
        if key not in recent:
            expected.append(key)
        recent = [*(other for other in recent if other != key), key][-3:]
    assert made == expected


def test_what_is_forgotten_is_freed_and_large_answers_leave_room_for_fewer() -> None:
    find, made = counted(Store(10.0), size=4.0)
    alive = [weakref.ref(find(key)) for key in range(5)]
    gc.collect()
    assert [thing() is not None for thing in alive] == [False, False, False, True, True]
    find(4)
    assert made == [0, 1, 2, 3, 4]


def test_an_answer_larger_than_the_room_is_kept_alone() -> None:
    find, made = counted(Store(1.0), size=7.0)
    assert find(0) is find(0)
    assert find(1) is not find(0)
    assert made == [0, 1, 0]


def test_large_bodies_are_few() -> None:
    @cached_by_unknowns
    def body(number: int) -> SimpleNamespace:
        return SimpleNamespace(unknowns=UNKNOWNS * BODIES // 2, number=number)

    alive = [body(number) for number in range(3)]
    assert [body(number) is alive[number] for number in (2, 1, 0)] == [True, True, False]


def test_functions_share_one_store_and_forget_their_own() -> None:
    made: list[str] = []

    @cached
    def first(number: int, name: str = "") -> Thing:
        made.append(f"first {number}{name}")
        return Thing()

    @cached
    def second(number: int) -> Thing:
        made.append(f"second {number}")
        return Thing()

    assert first(1) is first(1)
    assert first(1) is not first(1, name="x")
    assert second(1) is second(1)
    first.cache_clear()
    first(1)
    second(1)
    assert made == ["first 1", "first 1x", "second 1", "first 1"]
    for number in range(BODIES):
        first(number)
    second(1)
    assert made[-1] == "second 1", "as many bodies of one kind leave no room for another"
