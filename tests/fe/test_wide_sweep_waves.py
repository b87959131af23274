"""The defaults with inertia over ten decades of stiffness and six of speed: a true bar, or a failure with a name.

Balls on half-spaces, strikers on rods, blocks on a plane. The truth is the exact law where there is one, else that
which one march with finer settings points at.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import pytest

from fe_contact.dynamics import march
from fe_contact.methods import simulate
from fe_contact.progress import silent
from fe_contact.reference import plan, with_waves
from fe_contact.settings import WaveNumerics
from fe_contact.waves.line import Doubling
from lumped import BadInput, FeContactError, Result, Scene
from lumped.laws import bar_waves, rod_waves

BALLS, RODS, BLOCKS = 40, 229, 231  # scenes of the whole campaign
FEW = {BALLS: 3, RODS: 5, BLOCKS: 8}  # of it that half a minute allows
CONVERGE = 0.95
LAWS = ("elastic", "sls", "prony", "maxwell", "kelvin_voigt")
QUANTITIES = ("peak_force", "peak_depth", "duration", "impulse", "restitution")
SEED = 11
FINER = 1.6  # times as many elements, steps and whatever else has the march that tells of the truth
ROUNDING = 1e-7  # of the exact laws


def material(rng: np.random.Generator, law: str, young: float, time: float) -> dict[str, Any]:
    """Relaxation from a hundredth of a time, s, to a hundred; branches from a hundredth of the spring to ten."""
    tau, branch = time * 10 ** rng.uniform(-2, 2), young * 10 ** rng.uniform(-2, 1)
    tables: dict[str, dict[str, Any]] = {
        "elastic": {"E": young},
        "sls": {"E1": young, "E2": branch, "C1": young * tau},
        "prony": {"E_inf": young, "E": [branch, 0.3 * branch], "tau": [tau, 30.0 * tau]},
        "maxwell": {"E": young, "eta": young * tau},
        "kelvin_voigt": {"E": young, "eta": 0.1 * young * tau},
    }
    return {"law": law, **tables[law]}


def medium(rng: np.random.Generator) -> tuple[float, float, float, float]:
    """Young's modulus, Pa, density, kg/m3, Poisson's ratio and the speed of the striker over that of shear waves."""
    return 10 ** rng.uniform(2, 12), 10 ** rng.uniform(2, 4.3), rng.uniform(-0.5, 0.499), 10 ** rng.uniform(-6, -1.7)


def ball(rng: np.random.Generator, number: int) -> dict[str, Any]:
    """A ball on a half-space: contact radius below 0.3 of its own, mass within two decades of the medium's ball."""
    steep = 1.0
    while steep >= 0.3:
        young, density, nu, share = medium(rng)
        speed, radius = share * math.sqrt(young / (2.0 * (1.0 + nu)) / density), 10 ** rng.uniform(-4, 0)
        mass = density * 4.0 / 3.0 * np.pi * radius**3 * 10 ** rng.uniform(-2, 2)
        depth = (15 / 16 * mass * speed**2 * (1 - nu**2) / (young * radius**0.5)) ** 0.4
        steep = math.sqrt(depth / radius)
    held = material(rng, LAWS[number % 5], young, 2.943275 * depth / speed) | {"nu": nu, "density": density}
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": speed}
    return {"striker": striker, "target": {"shape": "half_space", "material": held}}


def rod(rng: np.random.Generator, number: int) -> dict[str, Any]:
    """A mass, flat or round, on a rod that it is a tenth to a hundred times as heavy as."""
    young, density, nu, share = medium(rng)
    area, speed = 10 ** rng.uniform(-6, 0), math.sqrt(young / density)
    width = math.sqrt(area)
    length, law = width * 10 ** rng.uniform(0.3, 2.5), LAWS[number % 4]
    mass, end = density * area * length * 10 ** rng.uniform(-1, 2), ("fixed", "free", "absorbing")[rng.integers(3)]
    held = material(rng, law, young, 2.0 * length / speed) | {"nu": nu, "density": density}
    rounded = {"shape": "sphere", "radius": width * 10 ** rng.uniform(0, 1)}
    shape = rounded if rng.integers(2) else {"shape": "punch", "radius": width}
    motion = {}
    if end == "absorbing" and law != "elastic":
        end = "free"
    if end == "absorbing" or law == "maxwell":  # what flows or goes on for ever lets no flat striker go
        motion = {"motion": {"end_time": 4.0 * mass / (area * math.sqrt(young * density))}}
    target = {"shape": "rod", "area": area, "length": length, "end": end, "material": held}
    return {"striker": shape | {"mass": mass, "velocity": share * speed}, "target": target, **motion}


def block(rng: np.random.Generator, number: int) -> dict[str, Any]:
    """A bar, free or confined, with or without a mass on its far end."""
    young, density, nu, share = medium(rng)
    area, speed = 10 ** rng.uniform(-6, 0), math.sqrt(young / density)
    height = math.sqrt(area) * 10 ** rng.uniform(0, 2)
    held = material(rng, LAWS[number % 4], young, 2.0 * height / speed) | {"nu": nu, "density": density}
    mass = rng.integers(2) * density * area * height * 10 ** rng.uniform(-1, 2)
    sides = ("free", "confined")[rng.integers(2)]
    striker = {"shape": "prism", "area": area, "height": height, "sides": sides, "faces": "sliding", "mass": mass}
    return {"striker": striker | {"velocity": share * speed, "material": held}, "target": {"shape": "plane"}}


def truth(scene: Scene, found: Result) -> tuple[Mapping[str, float | None], float]:
    """Values nearer to the truth than those found, and how much farther from these the truth lies than they do.

    The exact waves of an elastic rod or bar are the truth; a march with more of everything is as far from it as order
    two says, by which steps converge: where the order is less the truth lies farther still.
    """
    for law in (rod_waves, bar_waves):
        with suppress(FeContactError):
            exact = law.of(scene).simulate(scene, 1e-7)
            return {name: quantity.value for name, quantity in exact.quantities.items()}, 1.0
    own = WaveNumerics(**found.numerics)
    steps = 4 * math.ceil(FINER * own.steps / 4)
    way = with_waves(scene).way(scene, plan(scene, {}), silent)
    if isinstance(way, Doubling):
        values = way.march(own.varied(steps=steps)).reading.quantities
    else:
        finer = {key: FINER * getattr(own, key) for key in ("elements_per_contact", "penalty", "far_radius")}
        values = way.runs.curve(0, own.varied(steps=steps, **finer)).quantities
    return values, 1.0 / (1.0 - FINER**-2)


def check(found: Result, known: Mapping[str, float | None], farther: float) -> None:
    """Every value lies within its bar of the truth, and none is without a number."""
    for name in QUANTITIES:
        one, true = found.quantities[name], known[name]
        if one.value is None or true is None:
            assert one.value is true, (name, found.scene)
            continue
        assert farther * abs(one.value - true) <= (one.error or 0.0) + ROUNDING * abs(true), (name, found.scene)
    for rows in (found.history.force, found.history.depth, found.history.force_error):
        assert np.isfinite(rows).all()
    assert abs(found.energy["residual"] or 0.0) < 1e-6 * (found.energy["in"] or 0.0)


@pytest.mark.tenth
@pytest.mark.parametrize(("drawn", "many"), [(ball, BALLS), (rod, RODS), (block, BLOCKS)])
def test_defaults_with_inertia_over_a_wide_range_of_scenes(
    drawn: Callable[[np.random.Generator, int], dict[str, Any]], many: int, campaign_size: Callable[[int], int]
) -> None:
    rng, converged = np.random.default_rng(SEED), list[bool]()
    whole = campaign_size(many) == many
    for number in range(many if whole else FEW[many]):
        table = drawn(rng, number) | {"model": {"inertia": True}}
        try:
            scene = Scene.from_dict(table)
            found = simulate(scene, "fe", {})
        except FeContactError:
            converged.append(False)
            continue
        converged.append(found.converged)
        if found.converged and (whole or drawn is not ball):
            check(found, *truth(scene, found))
    assert np.mean(converged) >= CONVERGE, f"{np.mean(converged):.1%} of {len(converged)} scenes"


@pytest.mark.parametrize(
    "changes",
    [{"striker.velocity": 8.0}, {"striker.mass": 1e3}, {"striker.velocity": 40.0, "striker.mass": 1e-4}],
)
def test_what_no_small_displacements_describe_is_refused_by_name(changes: dict[str, float]) -> None:
    """Faster than 0.3 of the shear waves, deeper than the ball is round."""
    with pytest.raises(BadInput, match=r"striker\.velocity"):
        simulate(Scene.load("polymer-sphere-waves", changes), "fe", {})


def test_a_contact_that_never_ends_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """The work has a bound: a flat mass on an endless rod slows down for ever."""
    monkeypatch.setattr(march, "MOST_STEPS", 200)
    with pytest.raises(FeContactError, match="200 steps"):
        simulate(Scene.load("rod-absorbing", {"motion.end_time": 1.0}), "fe", {})
