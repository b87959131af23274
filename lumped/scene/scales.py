"""Scales of an impact on a material with memory: its stiffest answer, its relaxed one, and a depth beyond both."""

from __future__ import annotations

from lumped.load_curves import HertzImpact
from lumped.materials import Relaxation
from lumped.shapes import Shape


def dashpot_as_spring(shape: Shape, viscosity: float, mass: float, velocity: float) -> float:
    """The contact modulus eta/T, Pa, of the spring whose own Hertz contact lasts T; viscosity eta in Pa s.

    T grows as modulus^(-2/5), so T = T_1^(5/3) with T_1 that of the modulus which is eta in number.
    """
    unit = shape.hertz_impact(viscosity, mass, velocity).duration
    return float(viscosity / unit ** (5.0 / 3.0))


def stiffest_impact(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> HertzImpact:
    """The Hertz impact on the stiffest answer of the material, glassy springs or dashpot: the shallowest."""
    springs = [modulus.glassy] if modulus.glassy else []
    if modulus.viscosity:
        springs.append(dashpot_as_spring(shape, modulus.viscosity, mass, velocity))
    return shape.hertz_impact(max(springs), mass, velocity)


def relaxed_impact(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> HertzImpact:
    """The Hertz impact with the relaxed modulus; of a fluid with the glassy one, or that of its dashpot."""
    spring = modulus.relaxed or modulus.glassy
    return shape.hertz_impact(spring, mass, velocity) if spring else stiffest_impact(shape, modulus, mass, velocity)


def absurd_depth(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> str:
    """What to say where even the stiffest answer lets a round striker sink in deeper than it is round; else empty."""
    impact = stiffest_impact(shape, modulus, mass, velocity)
    if shape.tip_radius is None or impact.contact_radius > impact.depth:
        return ""
    return (
        f"the striker sinks in by {impact.depth:.3g} m, deeper than its radius: no small-displacement theory "
        "holds; accepted: a lower velocity or mass, or a stiffer material"
    )
