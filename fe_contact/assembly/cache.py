"""What is dear to make is kept while there is room: the last few answers, whatever they are to.

Meshes of all kinds and what surfaces know of them share one store: a cache of its own for every kind would hold as
many of each, and a long session a gigabyte of bodies long gone.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import update_wrapper
from threading import Lock
from typing import Any, Generic, ParamSpec, Protocol, TypeVar

BODIES = 12  # some 7 MB each; an impact on two bodies varies nine
SURFACE = 0.25  # of that takes what a surface knows of a body: a sweep asks for those of some dozen meshes by turns
UNKNOWNS = 20_000  # of a body that waves go through: one of more takes the room of several

_Arguments = ParamSpec("_Arguments")
_Answer = TypeVar("_Answer")


def _alike(answer: Any) -> float:
    return 1.0


class Store:
    """Answers by their keys, the last ones used, as many as have ``room`` together."""

    def __init__(self, room: float) -> None:
        self._room, self._taken, self._lock = room, 0.0, Lock()
        self._held: dict[tuple[Hashable, ...], tuple[float, Any]] = {}

    def find(
        self, key: tuple[Hashable, ...], make: Callable[[], _Answer], size: Callable[[_Answer], float] = _alike
    ) -> _Answer:
        """What is at hand, or made now, and takes the place of what was not asked for longest."""
        with self._lock:
            known = self._held.pop(key, None)
            if known is not None:
                self._held[key] = known
                found: _Answer = known[1]
                return found
        answer = make()
        with self._lock:
            self._taken += size(answer) - self._held.pop(key, (0.0, None))[0]
            self._held[key] = (size(answer), answer)
            while self._taken > self._room and len(self._held) > 1:
                self._taken -= self._held.pop(next(iter(self._held)))[0]
        return answer

    def forget(self, first: Hashable = None) -> None:
        """Drop all keys that begin so, or all of them."""
        with self._lock:
            for key in [key for key in self._held if first in (None, key[0])]:
                self._taken -= self._held.pop(key)[0]


_BODIES = Store(BODIES)


def forget() -> None:
    """Whatever is at hand: what is asked next is made anew."""
    _BODIES.forget()


@dataclass(frozen=True)
class Recipe(Generic[_Answer]):
    """What a function would answer to hashable arguments: two that ask alike are equal, before either is followed."""

    make: Callable[..., _Answer]
    arguments: tuple[Hashable, ...]

    def follow(self) -> _Answer:
        """The answer."""
        return self.make(*self.arguments)


class cached(Generic[_Arguments, _Answer]):  # noqa: N801 - a decorator, written like functools.cache
    """A function of hashable arguments that answers anew only what it was not asked lately."""

    def __init__(self, make: Callable[_Arguments, _Answer]) -> None:
        update_wrapper(self, make)  # takes over what a decorator below has, so it comes first
        self._make = make

    def __call__(self, *arguments: _Arguments.args, **named: _Arguments.kwargs) -> _Answer:
        """The answer at hand, or a new one."""
        key = (self._make, *arguments, *named.items())
        return _BODIES.find(key, lambda: self._make(*arguments, **named), self.size)

    def recipe(self, *arguments: _Arguments.args, **named: _Arguments.kwargs) -> Recipe[_Answer]:
        """The question, to be asked where the answer is needed; by places alone."""
        assert not named
        return Recipe(self, arguments)

    def size(self, answer: _Answer) -> float:
        """Of an answer, in bodies."""
        return 1.0

    def cache_clear(self) -> None:
        """Forget the answers of this function."""
        _BODIES.forget(self._make)


class cached_surface(cached[_Arguments, _Answer]):  # noqa: N801 - a decorator too
    """The same of an answer without its inside, which takes little room."""

    def size(self, answer: _Answer) -> float:
        """The same of all."""
        return SURFACE


class HasUnknowns(Protocol):
    """Tells how large it is."""

    @property
    def unknowns(self) -> int: ...


_Sized = TypeVar("_Sized", bound=HasUnknowns)


class cached_by_unknowns(cached[_Arguments, _Sized]):  # noqa: N801 - a decorator too
    """The same of a body that may be large: a few of those would be a gigabyte."""

    def size(self, answer: _Sized) -> float:
        """Of a large one as of so many others."""
        return max(answer.unknowns / UNKNOWNS, 1.0)
