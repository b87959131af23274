"""The linear spring, "(3)": F = k depth, nothing is lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._parameters import COMMON, LINEAR_STIFFNESS, Parameters
from lumped.laws._power_law import Undamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class LinearSpring(Undamped):
    """The law with its stiffness k, N/m."""

    alpha: float = 1.0
    name: ClassVar[str] = "linear_spring"


def of(scene: Scene) -> LinearSpring:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, LinearSpring.name)
    return LinearSpring(k=given.stiffness(1.0), **given.common())


MEMBER = LawKind(of, __doc__, (LINEAR_STIFFNESS, COMMON))
