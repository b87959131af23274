"""What strikes a rigid plane: a block, or a ball."""

from __future__ import annotations

from types import ModuleType

from fe_contact.studies.tradeoff.targets import _block, _meshed
from lumped.scene.scene import Scene
from lumped.shapes._block import Block


def of(scene: Scene) -> ModuleType:
    """A block is a bar of line elements, a ball meshed whole."""
    return _block if isinstance(scene.geometry.shape, Block) else _meshed
