"""The dent of a rod's end, by elements of the end itself: Hertz's but for what the ledger says."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

import meshes
from fe_contact.assembly.operators import ElasticBody, basis_on
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import held
from fe_contact.methods import simulate
from lumped import Scene, laws
from lumped.result.model_ledger import ROD_END
from lumped.solvers.rod import TippedImpact, Waves

LONG = 3.0  # radii of the rod, behind which its section moves as one
FINE = 16.0  # elements along the contact radius
CASES = 60
ROWS = 4001  # of a history, where its peak is looked for
EFFECT = "dent of the rod's end"


class End(NamedTuple):
    """A rod's end under Hertz's pressure of contact radius 1, E* = 1, divided by that of a half-space.

    ``curvature`` of the surface within the contact; ``less``: by how much less it comes in, the rod's uniform
    shortening taken off, times E* b/F.
    """

    curvature: float
    less: float


def end(nu: float, radius: float, elements: float = FINE) -> End:
    """Of a rod of this radius, its far end on rollers; displacement in the work of the pressure."""
    basis = basis_on(meshes.layer(elements, 1.0, LONG * radius, radius - 1.1), 4)
    fixed = held(basis, along=("axis",), across=("base",))
    operator = ElasticBody.alone(basis, fixed, flat(basis)).condensed(nu).operator
    pressure = np.sqrt(np.maximum(1.0 - operator.points**2, 0.0))
    weighed = operator.weights * pressure
    displacement = operator.trace @ operator.compliance @ (operator.trace.T @ weighed)
    force = float(weighed.sum())
    shortening = force * LONG / ((1.0 - nu**2) * math.pi * radius)
    hertz = 0.25 * math.pi * (2.0 - operator.points**2)
    slope = np.polyfit(operator.points**2, displacement, 1, w=np.sqrt(weighed))[0]
    less = radius * float(weighed @ (hertz + shortening - displacement)) / force**2
    return End(float(slope) / (-0.25 * math.pi), less)


def drawn(rng: np.random.Generator) -> Scene:
    """A ball, a cone or a power on a rod with a contact a twentieth to a third of its radius; rods soft and stiff."""
    radius, modulus, density = 0.02, 10 ** rng.uniform(7, 11), 2500.0
    width = radius * 10 ** rng.uniform(-1.3, -0.5)
    nu, length = float(rng.uniform(-0.3, 0.44)), radius * 10 ** rng.uniform(0.7, 2.5)
    depth = width * 10 ** rng.uniform(-3.0, -1.0)
    shape = rng.choice(["sphere", "cone", "power"])
    striker = {
        "sphere": {"shape": "sphere", "radius": width**2 / depth},
        "cone": {"shape": "cone", "angle": math.degrees(2.0 / math.pi * depth / width)},
        "power": {"shape": "power", "coefficient": 0.5 * depth / width**4.0, "exponent": 4.0},
    }[shape]
    mass = math.pi * radius**2 * length * density * 10 ** rng.uniform(-1.5, 1.0)
    speed = math.sqrt(0.8 * modulus / (1.0 - nu**2) * width * depth**2 / mass)
    return Scene.from_dict(
        {
            "striker": striker | {"mass": mass, "velocity": speed},
            "target": {
                "shape": "rod",
                "area": math.pi * radius**2,
                "length": length,
                "end": str(rng.choice(["fixed", "free", "absorbing"])),
                "material": {"law": "elastic", "E": modulus, "nu": nu, "density": density},
            },
            "model": {"inertia": True, "profile": "parabola" if shape == "sphere" else "exact"},
        }
    )


def peak(scene: Scene, less: float) -> float:
    """Greatest force, N, before the first echo or after, of a dent that comes in ``less`` F/(E* b) short of Hertz."""
    shape, mass, velocity = scene.profile, scene.reduced_mass, scene.velocity
    modulus, radius = scene.contact_modulus.relaxed, math.sqrt(scene.target.area / math.pi)
    known = shape.hertz_impact(modulus, mass, velocity)
    depths = 2.0 * known.depth * np.linspace(0.0, 1.0, 4001) ** 2
    forces = modulus * shape.load_curve.force(depths)
    short = depths - less * forces / (modulus * radius)
    impact = TippedImpact(
        waves=Waves.of(scene),
        force=lambda dent: np.interp(dent, short, forces),
        mass=mass,
        velocity=velocity,
        gravity=0.0,
        until=3.0 * known.duration,
        depth=known.depth,
        time=known.duration,
        rtol=1e-7,
    )
    times = np.linspace(0.0, impact.pieces[1], ROWS)
    return float(impact.columns(times)[2].max())


@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.4999])
def test_a_rods_end_comes_in_less_than_a_half_space(nu: float) -> None:
    """In proportion to the force, whatever the contact's radius: the far field that a rod has not."""
    near, far = end(nu, 4.0), end(nu, 8.0)
    assert near.less == pytest.approx(far.less, rel=0.02)
    assert far.less == pytest.approx(ROD_END, rel=0.08)


@pytest.mark.parametrize("share", [0.05, 0.15])
def test_the_dent_that_presses_is_that_of_the_rods_end(share: float) -> None:
    """Force over contact radius of an impact by elements of the rod's end: uniform displacements change neither."""
    radius, nu = 0.05, 0.3
    target = {"shape": "rod", "area": math.pi * radius**2, "length": 2.0, "end": "free"}
    material = {"law": "elastic", "E": 1e9, "nu": nu, "density": 1e3}
    depth = (share * radius) ** 2 / 0.2
    speed = math.sqrt(16.0 / 15.0 * 1e9 / (1.0 - nu**2) * math.sqrt(0.2) * depth**2.5 / 0.5)
    striker = {"shape": "sphere", "radius": 0.2, "mass": 0.5, "velocity": speed}
    model = {"inertia": True, "profile": "parabola"}
    scene = Scene.from_dict({"striker": striker, "target": target | {"material": material}, "model": model})
    found = simulate(scene, "fe", {})
    row = int(np.argmax(found.history.force))
    force, contact = found.history.force[row], found.history.contact_radius[row]
    assert contact == pytest.approx(share * radius, rel=0.3)
    # Hertz's pressure makes the parabola 1/R with p0 = E* a curvature/R times 2/pi: F = 4/3 E* a^3/R over the curvature
    pressed = 4.0 / 3.0 * 1e9 / (1.0 - nu**2) * contact**3 / 0.2 / end(nu, radius / contact).curvature
    assert force == pytest.approx(pressed, rel=0.01)


def test_the_ledger_says_how_far_a_half_space_is_from_a_rods_end(campaign_size: Callable[[int], int]) -> None:
    """Within a factor of three, over strikers, contacts, soft and stiff rods: by the waves under a dent by elements."""
    rng, measured = np.random.default_rng(8), {}
    for _ in range(campaign_size(CASES)):
        scene = drawn(rng)
        nu = round(scene.geometry.material.nu, 1)
        less = measured.setdefault(nu, end(nu, 8.0, 8.0).less)
        change = peak(scene, less) / peak(scene, 0.0) - 1.0
        result = laws.get("rod_waves").of(scene).simulate(scene, 1e-3)
        (entry,) = [one for one in result.model_ledger if one.effect == EFFECT]
        assert entry.estimate is not None
        assert 1.0 / 3.0 < entry.estimate / change < 3.0, (change, entry, scene)


def test_result_json_says_where_the_dent_comes_from() -> None:
    """By elements and by the law alike, no more than of a dent that takes all energy; a flat end dents nothing."""
    scene = Scene.load("concrete-pole")
    for result in (simulate(scene, "fe", {}), laws.get("rod_waves").of(scene).simulate(scene, 1e-6)):
        (entry,) = [one for one in result.to_json()["model_ledger"] if one["effect"] == EFFECT]
        assert entry["treated"] == "a half-space's closed form"
        share = result.history.contact_radius.max() / math.sqrt(0.0625 / math.pi)
        assert f"{share:.2g}" in entry["note"]
        assert 0.3 * ROD_END * share < entry["estimate"] < ROD_END * share
    flat_end = simulate(Scene.load("rod"), "fe", {"tolerance": 0.1})
    assert EFFECT not in [one.effect for one in flat_end.model_ledger]
