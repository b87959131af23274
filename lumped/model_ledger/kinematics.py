"""What a model leaves out by its kinematics: small displacements, a parabola, plane strain."""

from __future__ import annotations

from numpy.polynomial import Polynomial

from lumped.model_ledger.peak import Peak
from lumped.scene_tables import Model
from lumped.shapes.base import Shape
from lumped.sufficiency import LedgerEntry
from lumped.targets.base import Target

# c1 (1 - nu)^2, cubic in nu, of elastic energies with finite strains; tests/fe/test_finite_strain.py finds it again.
FIRST_ORDER = {
    "St Venant-Kirchhoff": Polynomial([-0.106722, -0.244066, 0.549732, -0.354504]),
    "neo-Hooke": Polynomial([0.247781, -0.830110, 0.390577, 0.426889]),
    "Hencky": Polynomial([0.425033, -1.477636, 1.302120, -0.093957]),
}
IN_AN_IMPACT = 0.5  # of the change at one depth: W = (2/5) k d^(5/2) + (1/3) k c1 d^3/sqrt(R) is what was brought
PROFILE = "model.profile = 'exact'"


def profile(shape: Shape, model: Model, peak: Peak) -> LedgerEntry:
    """The load curves of sphere and parabola at the peak depth; in plane strain their heights at its edge."""
    effect = "parabola against true profile"
    if model.profile == "exact":
        return LedgerEntry(effect, "true profile", 0.0)
    if shape.plane:
        heights = [float(shape.resolved(name).height(peak.contact_radius)) for name in ("exact", "parabola")]
        estimate = abs(heights[1] / heights[0] - 1.0) if heights[0] > 0.0 else 0.0
        return LedgerEntry(effect, "parabola", estimate, key=PROFILE)
    exact = float(shape.resolved("exact").load_curve.force(peak.depth))
    parabola = float(shape.resolved("parabola").load_curve.force(peak.depth))
    return LedgerEntry(effect, "parabola", abs(parabola / exact - 1.0), key=PROFILE)


def finite_strain(nu: float, height: float | None, peak: Peak, share: float = 1.0) -> LedgerEntry:
    """From small displacements to large ones a sphere's force at a depth becomes F (1 + c1 depth/a) to first order.

    c1 is the work of the cubic terms of an elastic energy, and of the profile met by a surface that moves inward, in
    Hertz's field: energies with the same E and nu differ in it, in sign too. Other profiles count with their own
    depth/a; what is flattened as a whole by the share of the depth in its `height`, m, where that is more. In an
    impact the work is given and the depth gives way: a `share` of it.
    """
    found = {name: share * peak.steepness * float(at(nu)) / (1.0 - nu) ** 2 for name, at in FIRST_ORDER.items()}
    lowest, highest = (of(found, key=lambda name: found[name]) for of in (min, max))
    spread, note = (found[lowest], found[highest]), f"{lowest} to {highest}: the scene gives no law of large strains"
    effect, treated, sizes = "finite strain", "small displacements", [abs(change) for change in spread]
    if height is not None and peak.depth > max(sizes) * height:
        return LedgerEntry(effect, treated, peak.depth / height, "order of magnitude: depth over what is pressed")
    least = min(sizes) if spread[0] * spread[1] > 0.0 else None
    return LedgerEntry(effect, treated, least, note, spread=spread)


def ends(shape: Shape, target: Target, nu: float) -> LedgerEntry:
    """Plane strain against a finite length l: at an end E stands for E/(1 - nu^2), about as far in as the body is deep.

    An order of magnitude: nu^2 times the share 2 h/l of the length.
    """
    effect, treated, depth = "finite length", "plane strain", target.body_depth
    if depth is None:
        return LedgerEntry(effect, treated, None, "how far the ends reach in is known of a layer or a ring only")
    estimate = nu**2 * min(1.0, 2.0 * depth / shape.total)
    return LedgerEntry(effect, treated, estimate, "order of magnitude: nu^2 2 h/l")
