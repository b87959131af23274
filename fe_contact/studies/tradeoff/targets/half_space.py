"""The half-space, under a rigid or a deformable striker: mesh, steps, penalty, mass and scheme are apart."""

from __future__ import annotations

from fe_contact.studies.tradeoff.targets._meshed import MESHED
from fe_contact.studies.tradeoff.tried import TriedTarget

MEMBER = TriedTarget(lambda scene: MESHED)
