"""The infinite half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.half_plane import HalfPlane
from lumped.schema.keys import Key, Number, Part
from lumped.shapes.base import Shape
from lumped.targets._half_plane_strains import half_plane_strains
from lumped.targets._strains import StrainField
from lumped.targets.base import Target


@dataclass(frozen=True)
class HalfSpace(Target):
    """Everything below a plane; values are those of the infinite body.

    `datum_depth`, m: in plane strain depth is measured relative to the point so far below; None otherwise.
    """

    datum_depth: Annotated[float | None, Key(Number(1e-9, 1e9, "m"), "how far below touch the datum lies")] = None
    name: ClassVar[str] = "half_space"
    has_inertia: ClassVar[bool] = True
    large_strains: ClassVar[bool] = True
    endless: ClassVar[bool] = True

    @property
    def has_length(self) -> bool:
        """Only the datum's depth."""
        return self.datum_depth is not None

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """The shape's own; of a cylinder, relative to the datum."""
        if shape.plane:
            return HalfPlane(shape.line_profile, self.datum_depth or 0.0, nu)
        return shape.load_curve

    def waves_under(self, shape: Shape) -> bool:
        """Not in plane strain."""
        return super().waves_under(shape) and not shape.plane

    def rings_on(self, shape: Shape) -> bool:
        """No wave comes back."""
        return False

    def steady_waves(self, shape: Shape) -> bool:
        """By its far field."""
        return True

    def strains(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> StrainField:
        """Of a half-plane, below the datum."""
        if self.datum_depth is None:
            return super().strains(shape, nu, depth, contact_radius)
        return half_plane_strains(nu, depth, contact_radius, self.datum_depth)

    def yielding_faults(self, source: str, shape: Shape, inertia: bool) -> list[Fault]:
        """Only a whole body with inertia: else one E* of both tells all, and a target of shape sphere knows it."""
        if inertia and shape.whole_mass(1.0) is not None:
            return []
        reason = 'target.shape = "half_space" is struck by a rigid body in this version, or by a sphere with inertia'
        return [Fault(source, "striker.material", f"{reason}; leave it out, or set model.inertia = true")]

    def check_striker(self, source: str, shape: Shape) -> None:
        """A half-plane has no finite compliance of its own: plane strain needs a datum, and only that."""
        super().check_striker(source, shape)
        if shape.plane and self.datum_depth is None:
            reason = (
                "missing; in plane strain the half-plane has no finite compliance; accepted: a depth, m, relative to "
                'which the indentation is measured, or target.shape = "layer"'
            )
            raise BadInput(Fault(source, "target.datum_depth", reason))
        if not shape.plane and self.datum_depth is not None:
            raise BadInput(Fault(source, "target.datum_depth", "only for a cylinder; accepted: leave it out"))

    def check_contact(self, contact_radius: float) -> str:
        """Narrower than the datum is deep: the point to which depth refers must lie below the contact."""
        if self.datum_depth is None or contact_radius < self.datum_depth:
            return ""
        return f"contact {contact_radius:.3g} m wide; accepted below the datum's depth {self.datum_depth:g} m"


MEMBER = Part(HalfSpace)
