"""The three assumptions of section 3 in numbers, for each example; ranges cover what is not printed."""

from __future__ import annotations

import math
from collections.abc import Iterable

from lumped.model_ledger.material import FIRST_YIELD
from lumped.paper.concrete_impacts import on_bar, proposed
from lumped.paper.examples import Examples
from lumped.paper.free_vibration import measure, with_ring
from lumped.paper.steel_impacts import hertz, solid
from lumped.paper.value import Value, Values, read
from lumped.radiation import pulse_energy
from lumped.result import Result

TABOR = 0.2  # of a/R: the representative strain of a sphere, ISBN 978-0-19-850776-5


def steel_strain(examples: Examples) -> Values:
    """0.2 a/R of the proposed model."""
    return (_strain(_steel(examples), examples.steel.radius),)


def steel_radiation(examples: Examples) -> Values:
    """Share of the kinetic energy which waves carry off: the elastic pulse, then the proposed model's."""
    steel = examples.steel
    return tuple(_radiated(examples, one) for one in (hertz(steel, steel.contact_modulus), _steel(examples)))


def steel_loss(examples: Examples) -> Values:
    """Energy radiated by the proposed model's pulse over the energy it loses by viscosity."""
    impact = _steel(examples)
    return (_radiated(examples, impact).over(_lost(impact)),)


def steel_yield(examples: Examples) -> Values:
    """p0/(1.6 Y) at the elastic peak: above one the steel yields."""
    steel = examples.steel
    impact = hertz(steel, steel.contact_modulus)
    return _overload(_pressure(impact, steel.radius), steel.yield_strength)


def concrete_strain(examples: Examples) -> Values:
    """0.2 a/R at the lower velocity, one an assumed radius."""
    concrete = examples.concrete
    velocity = min(concrete.velocities)
    return tuple(_strain(proposed(concrete, radius, velocity), radius) for radius in concrete.radii)


def concrete_radiation(examples: Examples) -> Values:
    """Share of the energy which an elastic striker leaves in the pole as waves, 1 - e^2, lower velocity."""
    return tuple(_square_loss(e) for _, _, e in _bars(examples))


def concrete_bars(examples: Examples) -> Values:
    """The same impacts: peak, kN, duration, ms, and restitution of the striker; ends of the assumed ranges."""
    return tuple(v for peak, end, e in _bars(examples) for v in (peak.times(1e-3), end.times(1e3), e))


def concrete_yield(examples: Examples) -> Values:
    """p0/(1.6 f) at the lower velocity, f the strength in compression, over both assumed ranges."""
    concrete = examples.concrete
    velocity = min(concrete.velocities)
    pressures = (_pressure(proposed(concrete, radius, velocity), radius) for radius in _ends(concrete.radii))
    return tuple(value for pressure in pressures for value in _overload(pressure, concrete.strength))


def ring_depth(examples: Examples) -> Values:
    """Deepest penetration over the lining's thickness, both masses displaced, over the assumed range."""
    depth = _vibration(examples, "peak_depth")
    return tuple(depth.times(1.0 / thickness) for thickness in examples.ring.thickness)


def ring_depth_over_rod(examples: Examples) -> Values:
    """The same over the radius of the rod."""
    return (_vibration(examples, "peak_depth").times(2.0 / examples.ring.rod_diameter),)


def ring_transit(examples: Examples) -> Values:
    """Time of the slowest axial wave through the lining over the first contact's, over the assumed ranges."""
    ring = examples.ring
    contact, glassy = _vibration(examples, "first_contact_duration"), ring.E0 * (1.0 + ring.R1)
    transits = (h * math.sqrt(rho / glassy) for h in ring.thickness for rho in ring.density)
    return tuple(Value(transit).over(contact) for transit in transits)


def _vibration(examples: Examples, name: str) -> Value:
    """A measure of the pounding damper, both masses displaced."""
    return measure(with_ring(examples.ptmd, examples.ring, "both", examples.ring.nu), name)


def _steel(examples: Examples) -> Result:
    return solid(examples.steel, examples.steel.R1, examples.steel.R2)


def _strain(impact: Result, radius: float) -> Value:
    """0.2 a/R with a = sqrt(R depth)."""
    depth = read(impact, "peak_depth")
    strain = TABOR * math.sqrt(depth.value / radius)
    return Value(strain, 0.5 * strain * depth.error / depth.value)


def _radiated(examples: Examples, impact: Result) -> Value:
    steel = examples.steel
    speed = math.sqrt(steel.young / (2.0 * (1.0 + steel.nu)) / steel.density)
    peak, duration = read(impact, "peak_force"), read(impact, "duration")
    energy = pulse_energy(steel.nu, steel.density, speed, peak.value, duration.value)
    share = energy / (0.5 * steel.mass * steel.velocity**2)
    return Value(share, share * (2.0 * peak.error / peak.value + duration.error / duration.value))


def _lost(impact: Result) -> Value:
    return _square_loss(read(impact, "restitution"))


def _square_loss(e: Value) -> Value:
    """1 - e^2."""
    return Value((1.0 - e.value) * (1.0 + e.value), 2.0 * e.error)


def _pressure(impact: Result, radius: float) -> Value:
    """Hertz's largest pressure 3 F/(2 pi a^2), a^2 = R depth, Pa."""
    force, depth = read(impact, "peak_force"), read(impact, "peak_depth")
    return force.over(depth).times(1.5 / (math.pi * radius))


def _overload(pressure: Value, strengths: Iterable[float]) -> Values:
    return tuple(pressure.times(1.0 / (FIRST_YIELD * strength)) for strength in strengths)


def _bars(examples: Examples) -> list[tuple[Value, Value, Value]]:
    concrete = examples.concrete
    velocity = min(concrete.velocities)
    return [on_bar(concrete, r, side, velocity) for side in concrete.sides for r in _ends(concrete.radii)]


def _ends(values: tuple[float, ...]) -> tuple[float, float]:
    return min(values), max(values)


RECOMPUTED = {
    function.__name__: function
    for function in (
        steel_strain, steel_radiation, steel_loss, steel_yield, concrete_strain, concrete_radiation, concrete_bars,
        concrete_yield, ring_depth, ring_depth_over_rod, ring_transit,
    )
}  # fmt: skip
