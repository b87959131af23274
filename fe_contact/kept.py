"""One store for meshes and what surfaces know of them: the last few, of all kinds together.

A cache of its own for every kind would hold as many of each, and a long session a gigabyte of bodies long gone.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import update_wrapper
from threading import Lock
from typing import Any, Generic, ParamSpec, TypeVar

KEPT = 16  # some 7 MB each; an impact on two bodies varies nine

_Arguments = ParamSpec("_Arguments")
_Answer = TypeVar("_Answer")
_store: dict[tuple[Hashable, ...], Any] = {}  # the last one used comes last
_one_at_a_time = Lock()


class kept(Generic[_Arguments, _Answer]):  # noqa: N801 - a decorator, written like functools.cache
    """A function of hashable arguments that answers anew only what it was not asked lately."""

    def __init__(self, make: Callable[_Arguments, _Answer]) -> None:
        self._make = make
        update_wrapper(self, make)

    def __call__(self, *arguments: _Arguments.args, **named: _Arguments.kwargs) -> _Answer:
        """The answer at hand, or a new one in place of that which was not asked for longest."""
        key = (self._make, *arguments, *named.items())
        with _one_at_a_time:
            known = [_store.pop(key)] if key in _store else []
        answer: _Answer = known[0] if known else self._make(*arguments, **named)
        with _one_at_a_time:
            _store[key] = answer
            while len(_store) > KEPT:
                del _store[next(iter(_store))]
        return answer

    def cache_clear(self) -> None:
        """Forget the answers of this function."""
        with _one_at_a_time:
            for key in [key for key in _store if key[0] is self._make]:
                del _store[key]
