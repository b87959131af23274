"""The contract of a row of Table 1."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.materials import Material, Relaxation
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.schema.key_table import check_fields
from lumped.schema.keys import Key
from lumped.shapes import Shape
from lumped.targets import Target


class Elastic(NamedTuple):
    """Young's modulus, Pa, and Poisson's ratio of one body."""

    young: float
    nu: float


class TableRow(ABC):
    """F = D E* depth^alpha for one geometry; lengths in m, areas in m^2. Raises BadInput for a length out of range.

    `number` is the row's place, `case` what the paper calls it, `printed` its D and E* as printed and `corrected`
    as they should be, `validity` where the row holds; `correction` says what is wrong and why, empty where nothing
    is. `length_name` names the length which depths are compared with, empty where the geometry has none. `single`:
    whether the half-space has one D at all. `bodies`: how many of them deform. `block`: whether
    it presses a block between two faces.
    """

    number: ClassVar[int]
    name: ClassVar[str]
    case: ClassVar[str]
    printed: ClassVar[tuple[str, str]]
    corrected: ClassVar[tuple[str, str]]
    length_name: ClassVar[str]
    alpha: ClassVar[float]
    validity: ClassVar[str]
    correction: ClassVar[str] = ""
    single: ClassVar[bool] = True
    bodies: ClassVar[int] = 1
    block: ClassVar[bool] = False
    keys: ClassVar[Mapping[str, Key]]

    def __post_init__(self) -> None:
        check_fields(self.name, self, self.keys)

    @property
    @abstractmethod
    def factor(self) -> float:
        """D as printed, m^(2-alpha)."""

    @property
    @abstractmethod
    def length(self) -> float:
        """The length which depths are compared with, m."""

    def modulus(self, *bodies: Elastic) -> float:
        """E* as it should be, Pa: of half-spaces in series, so E/(1-nu^2) of one alone, unless a row says otherwise."""
        return contact_modulus(*bodies)

    def printed_modulus(self, *bodies: Elastic) -> float:
        """E* as printed, Pa: the right one unless a row says otherwise."""
        return self.modulus(*bodies)

    @abstractmethod
    def scene(self, *bodies: Elastic) -> Indenter:
        """The slow indentation that puts the row on trial."""

    def whole_scene(self, *bodies: Elastic) -> Indenter:
        """The same with bodies of their true size, where the row takes them for half-spaces."""
        return self.scene(*bodies)

    def force(self, depth: ArrayLike, *bodies: Elastic) -> Any:
        """D E* depth^alpha with the corrected E*, N; depths below zero count as zero. Raises BadInput."""
        if len(bodies) != self.bodies:
            raise BadInput(Fault(self.name, "bodies", f"accepted {self.bodies}, got {len(bodies)}"))
        return self.factor * self.modulus(*bodies) * np.maximum(depth, 0.0) ** self.alpha

    def to_dict(self) -> dict[str, Any]:
        """The geometry, by the names of its lengths."""
        return {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type]


def pressed(name: str, shape: Shape, target: Target, *bodies: Elastic, profile: str = "exact") -> Indenter:
    """A shape pressed into a target, of the one body that deforms, or of striker and target. Raises BadInput."""
    first, *others = (Material(Relaxation(body.young), body.nu) for body in bodies)
    return Indenter(
        shape,
        others[0] if others else first,
        target,
        striker_material=first if others else None,
        model=Model(profile=profile),
        name=f"table1-{name}",
    )


def contact_modulus(*bodies: Elastic) -> float:
    """1/E* = sum of (1-nu^2)/E over the bodies that deform, Pa: of half-spaces in series (Hertz 1882)."""
    return 1.0 / sum((1.0 - nu**2) / young for young, nu in bodies)
