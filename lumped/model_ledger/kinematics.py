"""What a model leaves out by its kinematics: small displacements, a parabola, plane strain."""

from __future__ import annotations

import math

from lumped.model_ledger.peak import Peak
from lumped.result import LedgerEntry
from lumped.scene_tables import Model
from lumped.shapes.base import Shape
from lumped.targets.base import Target


def profile(shape: Shape, model: Model, peak: Peak) -> LedgerEntry:
    """The load curves of sphere and parabola at the peak depth; in plane strain their heights at its edge."""
    effect = "parabola against true profile"
    if model.profile == "exact":
        return LedgerEntry(effect, "true profile", 0.0)
    if shape.plane:
        heights = [float(shape.resolved(name).height(peak.contact_radius)) for name in ("exact", "parabola")]
        estimate = abs(heights[1] / heights[0] - 1.0) if heights[0] > 0.0 else 0.0
        return LedgerEntry(effect, "parabola", estimate, "model.profile = 'exact'")
    exact = float(shape.resolved("exact").load_curve.force(peak.depth))
    parabola = float(shape.resolved("parabola").load_curve.force(peak.depth))
    return LedgerEntry(effect, "parabola", abs(parabola / exact - 1.0), "model.profile = 'exact'")


def finite_strain(height: float | None, peak: Peak) -> LedgerEntry:
    """Stresses err by the order of the strain, Tabor's 0.2 a/R (1951, ISBN 978-0-19-850776-5), a/R = depth/a.

    Where more, by the share of the depth in the `height`, m, of what is flattened as a whole.
    """
    effect, treated, local = "finite strain", "small displacements", 0.2 * peak.steepness
    if height is not None and peak.depth > local * height:
        return LedgerEntry(effect, treated, peak.depth / height, "order of magnitude: depth over what is pressed")
    return LedgerEntry(effect, treated, local, "order of magnitude: Tabor's representative strain 0.2 depth/a")


def deformed_gap(nu: float, peak: Peak) -> LedgerEntry:
    """The surface moves inward while the gap is measured where it was.

    Inside Hertz's contact u_r = -(1-2nu)/(1-nu) (2/3pi) (a^2/R) (a/r) [1-(1-r^2/a^2)^(3/2)] (Johnson, eq.
    3.41b), near the axis -r times k = (1-2nu)/(1-nu) a/(pi R). The profile is met at r(1+k), as if 1/R were
    (1+2k)/R, and F ~ sqrt(R) changes by k. Other profiles count with depth/a for a/R.
    """
    estimate = (1.0 - 2.0 * nu) / (1.0 - nu) * peak.steepness / math.pi
    return LedgerEntry("deformed-gap kinematics", "small displacements", estimate, "(1-2nu)/(1-nu) depth/(pi a)")


def ends(shape: Shape, target: Target, nu: float) -> LedgerEntry:
    """Plane strain against a finite length l: at an end E stands for E/(1 - nu^2), about as far in as the body is deep.

    An order of magnitude: nu^2 times the share 2 h/l of the length.
    """
    effect, treated, depth = "finite length", "plane strain", target.body_depth
    if depth is None:
        return LedgerEntry(effect, treated, None, "how far the ends reach in is known of a layer or a ring only")
    estimate = nu**2 * min(1.0, 2.0 * depth / shape.total)
    return LedgerEntry(effect, treated, estimate, "order of magnitude: nu^2 2 h/l; striker.length")
