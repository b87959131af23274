"""What strikes a rigid plane: a block is a bar of line elements, a ball meshed whole."""

from __future__ import annotations

from fe_contact.studies.tradeoff.targets._block import BLOCK
from fe_contact.studies.tradeoff.targets._meshed import MESHED
from fe_contact.studies.tradeoff.tried import TriedTarget
from lumped.shapes._block import Block

MEMBER = TriedTarget(lambda scene: BLOCK if isinstance(scene.geometry.shape, Block) else MESHED)
