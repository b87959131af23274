"""The rod, struck flat or dented: steps and elements are one."""

from __future__ import annotations

from fe_contact.studies.tradeoff.targets._rod import ROD
from fe_contact.studies.tradeoff.tried import TriedTarget

MEMBER = TriedTarget(lambda scene: ROD)
