"""What the laws of the half-space share: all they need is the scene's geometry and material."""

from __future__ import annotations

from collections.abc import Mapping

from lumped.errors import BadInput, Fault
from lumped.scene.scene import Scene
from lumped.schema.keys import Key
from lumped.targets import HalfSpace

KEYS: Mapping[str, Key] = {}


def check(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry, and for several impacts, which need a memory between them."""
    check_geometry(scene, name)
    check_half_space(scene, name)
    scene.check_single(name)


def check_geometry(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry."""
    if not scene.has_geometry:
        reason = f"missing; the law {name} follows from the striker's shape and the target's material"
        raise BadInput(Fault(scene.source, "striker.shape", reason))


def check_half_space(scene: Scene, name: str) -> None:
    """Raise BadInput for a geometry which is not that of a half-space under an axisymmetric profile."""
    if scene.shape is not None and (not isinstance(scene.target, HalfSpace) or scene.shape.plane):
        reason = f"{scene.target.name}: {name} is for the half-space; accepted: half_space, or another method"
        raise BadInput(Fault(scene.source, "target.shape", reason))
