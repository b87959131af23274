"""What a model leaves out of the materials: a rigid striker, sideways motion, a fit, yielding, adhesion."""

from __future__ import annotations

import math

from lumped.errors import FeContactError
from lumped.result.model_ledger.peak import Peak
from lumped.result.sufficiency import LedgerEntry
from lumped.scene.scene import Scene

# Hertz: the first yield, below the surface, is where the peak pressure is 1.6 Y (Johnson, ISBN 978-0-521-34796-9).
FIRST_YIELD = 1.6


def striker(scene: Scene) -> LedgerEntry:
    """Unknown without a material of its own; nothing where it yields beside the target, or alone on a rigid one."""
    effect = "striker compliance"
    if scene.geometry.striking is not None:
        return LedgerEntry(effect, "included", 0.0)
    return LedgerEntry(effect, "rigid", None, "the scene gives the striker no material")


def sideways(scene: Scene, peak: Peak) -> LedgerEntry:
    """At most what the instantaneous stiffness changes by, to the power 2/5 of a peak force.

    That of the half-space by 4G(3K+G)/(3K+4G) over 2G/(1-nu); a body with lengths confines, in thin layers most.
    """
    effect, material = "constant nu against constant bulk modulus", scene.geometry.material
    treated = "constant nu" if material.constant == "poisson" else "constant bulk modulus"
    if material.young.is_elastic or math.isinf(material.bulk):
        return LedgerEntry(effect, treated, 0.0, "elastic or incompressible: the same")
    if material.young.viscosity > 0.0 or material.young.relaxed == 0.0:
        return LedgerEntry(effect, treated, None, "no bound for a fluid or a dashpot in parallel")
    shear, bulk = material.young.glassy / (2.0 * (1.0 + material.nu)), material.bulk
    softer = 2.0 * (1.0 - material.nu) * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
    if scene.target.has_length:
        confined = _confined(scene, (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)), peak.depth)
        if confined is None:
            return LedgerEntry(effect, treated, None, "no load curve tells it; run both of target.material.constant")
        softer *= confined
    return LedgerEntry(effect, treated, 1.0 - softer**0.4, "bound", "target.material.constant")


def _confined(scene: Scene, nu: float, depth: float) -> float | None:
    """Force of unit modulus with another Poisson's ratio, over that with the scene's own; None where none is known."""
    forces = []
    for poisson in (nu, scene.geometry.material.nu):
        try:
            forces.append(float(scene.target.load_curve(scene.profile, poisson).force(depth)))
        except FeContactError:  # no load curve, or one that ends before this depth
            return None
    return forces[0] / forces[1] if forces[1] > 0.0 else None


def series(scene: Scene, peak: Peak) -> LedgerEntry:
    """How far a Prony series may be from the modulus which it was fitted to."""
    effect, fidelity = "material series", scene.geometry.material.young.fidelity
    if fidelity is None:
        return LedgerEntry(effect, "the material itself", 0.0)
    shortest, longest = fidelity.window
    treated = f"fitted to {fidelity.inside:.2g} over {shortest:.3g} to {longest:.3g} s"
    bound = fidelity.of_force(peak.duration)
    return LedgerEntry(effect, treated, bound if math.isfinite(bound) else None, "bound until the contact recedes")


def plasticity(scene: Scene, peak: Peak) -> LedgerEntry:
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


def adhesion(scene: Scene, peak: Peak) -> LedgerEntry:
    """The pull-off force (3/2) pi w R of Johnson, Kendall and Roberts 1971, doi 10.1098/rspa.1971.0141."""
    work = scene.geometry.material.work_of_adhesion
    if work is None:
        return LedgerEntry("adhesion", "neglected", None, "needs target.material.work_of_adhesion")
    radius = scene.geometry.shape.tip_radius
    if radius is None:
        return LedgerEntry("adhesion", "neglected", None, "the pull-off force is known for a round tip only")
    return LedgerEntry("adhesion", "neglected", 1.5 * math.pi * work * radius / peak.force, "JKR pull-off force")
