"""The rod, struck flat or dented."""

from __future__ import annotations

from types import ModuleType

from fe_contact.validation.waves import _rod
from lumped.scene import Scene


def of(scene: Scene) -> ModuleType:
    """Steps and elements are one."""
    return _rod
