"""The half-space, under a rigid or a deformable striker."""

from __future__ import annotations

from types import ModuleType

from fe_contact.studies.tradeoff.targets import _meshed
from lumped.scene.scene import Scene


def of(scene: Scene) -> ModuleType:
    """Mesh, steps, penalty, mass and scheme are apart from each other."""
    return _meshed
