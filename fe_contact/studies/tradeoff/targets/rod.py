"""The rod, struck flat or dented."""

from __future__ import annotations

from types import ModuleType

from fe_contact.studies.tradeoff.targets import _rod
from lumped.scene.scene import Scene


def of(scene: Scene) -> ModuleType:
    """Steps and elements are one."""
    return _rod
