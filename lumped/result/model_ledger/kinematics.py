"""What a model leaves out by its kinematics: small displacements, a parabola, plane strain."""

from __future__ import annotations

import math
from dataclasses import replace

from numpy.polynomial import Polynomial

from lumped.result.model_ledger.peak import Peak
from lumped.result.sufficiency import LedgerEntry
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes.base import Shape
from lumped.targets.base import Target
from lumped.targets.rod import Rod

# c1 (1 - nu)^2, cubic in nu, of elastic energies with finite strains; tests/fe/test_finite_strain.py finds it again.
FIRST_ORDER = {
    "St Venant-Kirchhoff": Polynomial([-0.106722, -0.244066, 0.549732, -0.354504]),
    "neo-Hooke": Polynomial([0.247781, -0.830110, 0.390577, 0.426889]),
    "Hencky": Polynomial([0.425033, -1.477636, 1.302120, -0.093957]),
}
# By how much less a rod's end comes in than a half-space, its uniform shortening apart, over F/(E* b), b the rod's
# radius: 0.61 at nu = -0.5 to 0.66 at 0.5; tests/fe/test_rod_end.py finds it again.
ROD_END = 0.65
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


def of_dent(scene: Scene, peak: Peak) -> Peak:
    """With the depth of the dent in a rod's end, which goes as a^(1/(n - 1)), in place of the striker's way."""
    shape, stiffness = scene.profile, _stiffness(scene)
    known = shape.hertz_impact(stiffness, scene.reduced_mass, scene.velocity)
    share = peak.contact_radius / known.contact_radius
    return replace(peak, depth=known.depth * share ** (1.0 / (shape.exponent_of_force - 1.0)))


def rod_end(scene: Scene, peak: Peak) -> LedgerEntry:
    """A rod's end comes in less than a half-space of its material, by k F/(E* b), b the rod's radius.

    What a half-space stores too much, k F^2/(2 E* b), is left to others, where the force goes as energy^(n/(n + 1)): to
    the dent alone, whose energy is F d/(n + 1), or to all that the striker brought. The geometric mean of both.
    """
    assert isinstance(scene.target, Rod)
    radius, n = math.sqrt(scene.target.area / math.pi), scene.profile.exponent_of_force
    stored = 0.5 * ROD_END * peak.force**2 / (_stiffness(scene) * radius)
    dented, brought = peak.force * peak.depth / (n + 1.0), 0.5 * scene.reduced_mass * scene.velocity**2
    estimate = n / (n + 1.0) * stored / math.sqrt(dented * brought)
    note = f"the contact over the rod's radius is {peak.contact_radius / radius:.2g}"
    return LedgerEntry("dent of the rod's end", "a half-space's closed form", estimate, note)


def _stiffness(scene: Scene) -> float:
    """E*, Pa: relaxed, or that of a fluid at once."""
    return scene.contact_modulus.relaxed or scene.contact_modulus.glassy


def ends(shape: Shape, target: Target, nu: float) -> LedgerEntry:
    """Plane strain against a finite length l: at an end E stands for E/(1 - nu^2), about as far in as the body is deep.

    An order of magnitude: nu^2 times the share 2 h/l of the length.
    """
    effect, treated, depth = "finite length", "plane strain", target.body_depth
    if depth is None:
        return LedgerEntry(effect, treated, None, "how far the ends reach in is known of a layer or a ring only")
    estimate = nu**2 * min(1.0, 2.0 * depth / shape.total)
    return LedgerEntry(effect, treated, estimate, "order of magnitude: nu^2 2 h/l")
