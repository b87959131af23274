"""What condensing a body to its contact surface took, counted: factorizations and back-substitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.bodies.modes import Modes


class Condensed:
    """Condensed once, on one mesh."""

    if TYPE_CHECKING:  # members have it as a field or as a property

        @property
        def operator(self) -> SurfaceOperator: ...

    @property
    def factorizations(self) -> int:
        """One for one mesh."""
        return 1

    @property
    def solves(self) -> int:
        """One a node of the contact zone."""
        return len(self.operator.stiffness)


class ByModes:
    """Condensed at every ratio of the moduli that its modes were made for, whatever the steps."""

    modes: Modes

    @property
    def factorizations(self) -> int:
        """One a ratio."""
        return self.modes.ratios

    @property
    def solves(self) -> int:
        """Those of the modes."""
        return self.modes.solves
