"""What the paper's three assumptions leave out of each example: the model ledger's estimates, over what is not printed.

Changes of the peak force, as `run` has them of the same bodies: from the least to the most where no law decides.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from lumped.materials import Material, Relaxation
from lumped.materials.networks import elastic, sls
from lumped.materials.radiation import Pulse
from lumped.paper.concrete_impacts import proposed
from lumped.paper.given import Concrete, Examples, Steel
from lumped.paper.ring_impacts import ROUNDING, measure, measures
from lumped.paper.value import Value, Values, read
from lumped.result.model_ledger import Peak, finite_strain, model_ledger
from lumped.result.result import Result
from lumped.scene.geometry import Geometry
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes.cylinder import Cylinder
from lumped.targets.ring import Ring
from lumped.targets.rod import Rod


def strained(impact: Result) -> Values:
    """By finite strain."""
    return _left_out("finite strain", impact)


def radiated(steel: Steel, impact: Result) -> Value:
    """By waves, which are those of steel, not of the equivalent E*."""
    medium = Material(Relaxation(steel.young), steel.nu, steel.density)
    (value,) = _left_out("target inertia", impact, replace(impact.scene, material=medium))
    return value


def radiated_into_pole(concrete: Concrete) -> Values:
    """Of an elastic striker on the end of a long pole, lower velocity; over both assumed ranges."""
    found, inertia = list[Value](), Model(inertia=True, profile="parabola")
    for side in concrete.sides:
        pole = Rod(side**2, length=1.0, end="absorbing")
        for one in at_lower_velocity(concrete):
            medium = replace(one.scene.geometry.material, young=elastic.of(concrete.E2), density=concrete.density)
            found += _left_out("target inertia", one, replace(one.scene, target=pole, material=medium, model=inertia))
    return tuple(found)


def yielded(impact: Result, strengths: Iterable[float]) -> Values:
    """By yielding, over an assumed range of strengths, Pa."""
    material = impact.scene.geometry.material
    bodies = [replace(impact.scene, material=replace(material, yield_strength=strength)) for strength in strengths]
    return tuple(value for one in bodies for value in _left_out("plasticity", impact, one))


def at_lower_velocity(concrete: Concrete) -> list[Result]:
    """Impacts of the concrete striker, one an assumed radius."""
    return [proposed(concrete, radius, min(concrete.velocities)) for radius in concrete.radii]


def ring_strained(examples: Examples) -> Values:
    """At the deepest penetration, both masses displaced, by every assumed thickness of the lining."""
    ring, peak = examples.ring, _ring_peak(examples)
    cylinder, material = Cylinder(0.5 * ring.rod_diameter, ring.width), Material(Relaxation(ring.E0), ring.nu)
    around = [Ring(cylinder.radius + examples.ptmd.gap, thickness) for thickness in ring.thickness]
    return _rounded(finite_strain(Geometry(cylinder, one, material), peak, struck=True).size for one in around)


def ring_moved(examples: Examples) -> Values:
    """By the lining that moves with the rod, over its assumed thickness and density."""
    ring, ptmd, peak = examples.ring, examples.ptmd, _ring_peak(examples)
    rod, young = 0.5 * ring.rod_diameter, sls.of_ratios(E0=ring.E0, R1=ring.R1, R2=ring.R2)
    mass, energy = 1.0 / (1.0 / ptmd.m1 + 1.0 / ptmd.m2), 0.5 * peak.force * peak.depth
    pulse = Pulse(peak.force, peak.duration, mass, energy, peak.contact_radius)
    estimates = [
        Ring(rod + ptmd.gap, thickness)
        .inertia_left_out(Cylinder(rod, ring.width), Material(young, ring.nu, density), pulse)
        .size
        for thickness in ring.thickness
        for density in ring.density
    ]
    return _rounded(estimate for estimate in estimates if estimate is not None)


def _ring_peak(examples: Examples) -> Peak:
    """Of the first contact with both masses displaced, which no rod touches wider than its radius."""
    found = measures(examples.ptmd, "both", examples.ring)
    numbers = [measure(found, name).value for name in ("peak_force", "peak_depth", "first_contact_duration")]
    return Peak(numbers[0], numbers[1], 0.5 * examples.ring.rod_diameter, numbers[2])


def _rounded(numbers: Iterable[float]) -> Values:
    """As well known as the damper's path."""
    return tuple(Value(number, ROUNDING * number) for number in numbers)


def _left_out(effect: str, impact: Result, scene: Scene | None = None) -> Values:
    """What the ledger of a scene, the impact's own by default, says of an effect: its size, or least and most.

    Every effect grows with force, depth and steepness, and with a shorter pulse: bars are what their bars add.
    """
    force, depth, duration = (read(impact, name) for name in ("peak_force", "peak_depth", "duration"))
    peak = Peak.of(impact.quantities, impact.history)
    narrower = peak.contact_radius * (1.0 - depth.error / depth.value)
    harder = Peak(force.value + force.error, depth.value + depth.error, narrower, duration.value - duration.error)
    ends = []
    for one in (peak, harder):
        ledger = model_ledger(scene or impact.scene, one, impact.model)
        (entry,) = (entry for entry in ledger if entry.effect == effect)
        ends.append([entry.estimate or 0.0, entry.size] if entry.spread else [entry.size])
    return tuple(Value(value, abs(more - value)) for value, more in zip(*ends, strict=True))
