"""What is tried of a body that moves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from fe_contact.settings import WaveNumerics
from fe_contact.studies.tradeoff.design import Settings
from fe_contact.studies.tradeoff.truth import Truth
from lumped.scene.scene import Scene
from lumped.schema.members import Folder


@dataclass(frozen=True)
class TriedBody:
    """``variations(base, quick)``: settings around the default's; ``exact(scene)``: the truth in closed form, or
    None; ``operations(work)``: the leading terms of the arithmetic behind the counted work; ``forget()`` drops
    what is kept from one impact to the next.
    """

    variations: Callable[[WaveNumerics, bool], Iterator[Settings]]
    exact: Callable[[Scene], Truth | None]
    operations: Callable[[Mapping[str, float]], float]
    forget: Callable[[], None]


@dataclass(frozen=True)
class TriedTarget:
    """``of(scene)``: what is tried of its body."""

    of: Callable[[Scene], TriedBody]


TRIED = Folder[TriedTarget]("fe_contact.studies.tradeoff.targets", "numerics", "target")
