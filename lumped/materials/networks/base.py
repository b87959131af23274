"""The contract of a network, and the quantities which the networks share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

from lumped.materials.material import MODULUS
from lumped.materials.relaxation import Relaxation
from lumped.schema.keys import Key, Number, Sets, keys_of, made

MODULUS_OR_ZERO = Number(0.0, 1e16, "Pa")
TIME = Number(1e-15, 1e15, "s")
VISCOSITY = Number(1e-15, 1e25, "Pa s")
Modulus = Annotated[float, Key(MODULUS, "modulus of a spring")]
Viscosity = Annotated[float, Key(VISCOSITY, "viscosity of a dashpot")]


@dataclass(frozen=True)
class Network:
    """A member of this folder: the `ways` to make its relaxation modulus, each of other keys, those of its arguments.

    A way raises ValueError, with a message, or BadInput for values which make none.
    """

    ways: tuple[Callable[..., Relaxation], ...]

    @property
    def sets(self) -> Sets:
        """One a way."""
        return tuple(keys_of(way) for way in self.ways)

    def of(self, **values: object) -> Relaxation:
        """E(t) by the way that has these keys."""
        way = next(way for way, keys in zip(self.ways, self.sets, strict=True) if values.keys() <= keys.keys())
        return made(way, values)
