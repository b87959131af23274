"""The cylinder struck by a parallel one, in plane strain: finite bodies."""

from __future__ import annotations

from fe_contact.targets import _round
from fe_contact.targets.base import MeshedTarget

MEMBER = MeshedTarget(_round.still, struck=_round.struck, relaxing=_round.relaxing, paired=True)
