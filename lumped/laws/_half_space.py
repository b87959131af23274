"""What the laws of the viscoelastic half-space share: all they need is the scene's geometry and material."""

from __future__ import annotations

from collections.abc import Mapping

from lumped.errors import BadInput, Fault
from lumped.keys import Key
from lumped.scene import Scene

KEYS: Mapping[str, Key] = {}


def check(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry, and for several impacts, which need a memory between them."""
    check_geometry(scene, name)
    scene.check_half_space(name)
    scene.check_single(name)


def check_geometry(scene: Scene, name: str) -> None:
    """Raise BadInput for a scene without geometry."""
    if not scene.has_geometry:
        reason = f"missing; the law {name} follows from the striker's shape and the target's material"
        raise BadInput(Fault(scene.source, "striker.shape", reason))
