"""What a model of impact or slow indentation leaves out, each effect estimated relative to peak force."""

from __future__ import annotations

import math
from dataclasses import dataclass

from lumped.errors import FeContactError
from lumped.indenter import Indenter
from lumped.radiation import Pulse
from lumped.result import LedgerEntry
from lumped.scene import Scene
from lumped.scene_tables import Model
from lumped.shapes.base import Shape
from lumped.targets.base import Target

GRAVITY = 9.81
# Hertz: the first yield lies below the surface, where the peak pressure is 1.6 Y (Johnson, ISBN
# 978-0-521-34796-9).
FIRST_YIELD = 1.6


@dataclass(frozen=True)
class Peak:
    """Scales of an impact: N, m, m, s. `duration` may be twice the time of the peak."""

    force: float
    depth: float
    contact_radius: float
    duration: float

    @property
    def steepness(self) -> float:
        """depth/a: for a sphere a/R."""
        return self.depth / self.contact_radius if self.contact_radius > 0.0 else 0.0


def model_ledger(scene: Scene, peak: Peak, model: Model | None = None) -> tuple[LedgerEntry, ...]:
    """The ledger of a scene under `model` (default: the scene's own), with the scales of its impact."""
    resolved = model or scene.model
    if not scene.has_geometry:
        return (_gravity(scene, resolved, peak),)
    entries = [
        _inertia(scene, resolved, peak),
        _profile(scene.geometry.shape, resolved, peak),
        _finite_strain(scene.geometry.target.pressed_height(scene.geometry.shape), peak),
        _deformed_gap(scene.geometry.material.nu, peak),
        _sideways(scene, peak),
        _series(scene, peak),
        LedgerEntry("striker compliance", "rigid", None, "the scene gives the striker no material"),
        _gravity(scene, resolved, peak),
        _plasticity(scene, peak),
        _adhesion(scene, peak),
    ]
    if scene.geometry.shape.plane:
        entries.append(ends(scene.geometry.shape, scene.geometry.target, scene.geometry.material.nu))
    return tuple(entries)


def ledger_at_rest(indenter: Indenter, peak: Peak) -> tuple[LedgerEntry, ...]:
    """The same of a slow indentation at its deepest, which has neither inertia nor time."""
    shape, target, nu = indenter.shape, indenter.target, indenter.material.nu
    entries = [_finite_strain(target.pressed_height(shape), peak)]
    if target.fixed_radius(shape) is None:
        entries += [_profile(shape, indenter.model, peak), _deformed_gap(nu, peak)]
    return (*entries, ends(shape, target, nu)) if shape.plane else tuple(entries)


def ends(shape: Shape, target: Target, nu: float) -> LedgerEntry:
    """Plane strain against a finite length l: at an end E stands for E/(1 - nu^2), about as far in as the body is deep.

    An order of magnitude: nu^2 times the share 2 h/l of the length.
    """
    effect, treated, depth = "finite length", "plane strain", target.body_depth
    if depth is None:
        return LedgerEntry(effect, treated, None, "how far the ends reach in is known of a layer or a ring only")
    estimate = nu**2 * min(1.0, 2.0 * depth / shape.total)
    return LedgerEntry(effect, treated, estimate, "order of magnitude: nu^2 2 h/l; striker.length")


def _inertia(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """As the target knows it."""
    effect = "target inertia"
    if model.inertia:
        return LedgerEntry(effect, "included", 0.0)
    energy = 0.5 * scene.reduced_mass * scene.velocity**2
    pulse = Pulse(peak.force, peak.duration, energy)
    return LedgerEntry(effect, "neglected", *scene.target.inertia_left_out(scene.geometry.material, pulse))


def _profile(shape: Shape, model: Model, peak: Peak) -> LedgerEntry:
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


def _finite_strain(height: float | None, peak: Peak) -> LedgerEntry:
    """Stresses err by the order of the strain, Tabor's 0.2 a/R (1951, ISBN 978-0-19-850776-5), a/R = depth/a.

    Where more, by the share of the depth in the `height`, m, of what is flattened as a whole.
    """
    effect, treated, local = "finite strain", "small displacements", 0.2 * peak.steepness
    if height is not None and peak.depth > local * height:
        return LedgerEntry(effect, treated, peak.depth / height, "order of magnitude: depth over what is pressed")
    return LedgerEntry(effect, treated, local, "order of magnitude: Tabor's representative strain 0.2 depth/a")


def _deformed_gap(nu: float, peak: Peak) -> LedgerEntry:
    """The surface moves inward while the gap is measured where it was.

    Inside Hertz's contact u_r = -(1-2nu)/(1-nu) (2/3pi) (a^2/R) (a/r) [1-(1-r^2/a^2)^(3/2)] (Johnson, eq.
    3.41b), near the axis -r times k = (1-2nu)/(1-nu) a/(pi R). The profile is met at r(1+k), as if 1/R were
    (1+2k)/R, and F ~ sqrt(R) changes by k. Other profiles count with depth/a for a/R.
    """
    estimate = (1.0 - 2.0 * nu) / (1.0 - nu) * peak.steepness / math.pi
    return LedgerEntry("deformed-gap kinematics", "small displacements", estimate, "(1-2nu)/(1-nu) depth/(pi a)")


def _sideways(scene: Scene, peak: Peak) -> LedgerEntry:
    """At most what the instantaneous stiffness changes by, to the power 2/5 of a peak force.

    That of the half-space by 4G(3K+G)/(3K+4G) over 2G/(1-nu); a body with lengths confines, in thin layers most.
    """
    effect, material = "constant nu against constant bulk modulus", scene.geometry.material
    treated = "constant nu" if material.constant == "poisson" else "constant bulk modulus"
    if material.young.is_elastic:
        return LedgerEntry(effect, treated, 0.0, "elastic: the same")
    if material.young.viscosity > 0.0 or material.young.relaxed == 0.0:
        return LedgerEntry(effect, treated, None, "no bound for a fluid or a dashpot in parallel")
    shear, bulk = material.young.glassy / (2.0 * (1.0 + material.nu)), material.bulk
    softer = 2.0 * (1.0 - material.nu) * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
    if scene.target.has_length:
        confined = _confined(scene, (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)), peak.depth)
        if confined is None:
            return LedgerEntry(effect, treated, None, "no load curve tells it; run both of target.material.constant")
        softer *= confined
    return LedgerEntry(effect, treated, 1.0 - softer**0.4, "bound; target.material.constant")


def _confined(scene: Scene, nu: float, depth: float) -> float | None:
    """Force of unit modulus with another Poisson's ratio, over that with the scene's own; None where none is known."""
    forces = []
    for poisson in (nu, scene.geometry.material.nu):
        try:
            forces.append(float(scene.target.load_curve(scene.profile, poisson).force(depth)))
        except FeContactError:  # no load curve, or one that ends before this depth
            return None
    return forces[0] / forces[1] if forces[1] > 0.0 else None


def _series(scene: Scene, peak: Peak) -> LedgerEntry:
    """How far a Prony series may be from the modulus which it was fitted to."""
    effect, fidelity = "material series", scene.geometry.material.young.fidelity
    if fidelity is None:
        return LedgerEntry(effect, "the material itself", 0.0)
    shortest, longest = fidelity.window
    treated = f"fitted to {fidelity.inside:.2g} over {shortest:.3g} to {longest:.3g} s"
    bound = fidelity.of_force(peak.duration)
    return LedgerEntry(effect, treated, bound if math.isfinite(bound) else None, "bound until the contact recedes")


def _gravity(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """The weight of the striker."""
    if scene.target_mass is not None:
        return LedgerEntry("gravity", "none between two free bodies", 0.0)
    if model.gravity != 0.0:
        return LedgerEntry("gravity", "included", 0.0)
    return LedgerEntry("gravity", "neglected", GRAVITY * scene.mass / peak.force, "m g; model.gravity")


def _plasticity(scene: Scene, peak: Peak) -> LedgerEntry:
    """Pressure capped at p_y = 1.6 Y: at the same depth F falls by 1 - (3q - q^3)/2, q = p_y/p_0.

    Thornton 1997, doi 10.1115/1.2787319: F = F_y + pi R p_y (depth - depth_y) beyond the yield depth.
    """
    effect, strength = "plasticity", scene.geometry.material.yield_strength
    if strength is None:
        return LedgerEntry(effect, "neglected", None, "needs target.material.yield_strength")
    if peak.contact_radius == 0.0:
        return LedgerEntry(effect, "neglected", 0.0)
    pressure = 1.5 * peak.force / (math.pi * peak.contact_radius**2)
    share = min(FIRST_YIELD * strength / pressure, 1.0)
    note = f"p0/(1.6 Y) = {pressure / (FIRST_YIELD * strength):.3g}"
    return LedgerEntry(effect, "neglected", 1.0 - 0.5 * share * (3.0 - share**2), note)


def _adhesion(scene: Scene, peak: Peak) -> LedgerEntry:
    """The pull-off force (3/2) pi w R of Johnson, Kendall and Roberts 1971, doi 10.1098/rspa.1971.0141."""
    work = scene.geometry.material.work_of_adhesion
    if work is None:
        return LedgerEntry("adhesion", "neglected", None, "needs target.material.work_of_adhesion")
    radius = scene.geometry.shape.tip_radius
    if radius is None:
        return LedgerEntry("adhesion", "neglected", None, "the pull-off force is known for a round tip only")
    return LedgerEntry("adhesion", "neglected", 1.5 * math.pi * work * radius / peak.force, "JKR pull-off force")
