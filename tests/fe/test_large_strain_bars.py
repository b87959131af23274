"""Bars of large strains: random scenes, pressed and struck, against runs to a quarter of the tolerance.

At least 95 % converge of those that stay within the range of their energy; the others say at which depth it ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from finer_runs import answered, compare_forces_with_finer

from fe_contact import run
from fe_contact.indentation import indent
from lumped import Scene
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import ENERGIES
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes import Sphere
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.power import PowerProfile
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace
from lumped.targets.layer import Layer
from lumped.targets.o_ring import ORing
from lumped.targets.plane import Plane
from lumped.targets.ring import Ring
from lumped.targets.washer import Washer

SCENES, TOLERANCE = 60, 1e-2
FINER = {"elements_per_contact": 3.0, "penalty": 2000.0}  # of the quarter: loose tolerances share the coarsest mesh
LEAST = 0.95  # share of them that converge


def scene(random: np.random.Generator) -> tuple[Indenter, tuple[float, ...]]:
    """A sphere of radius one, depths to 0.3 of it, on a half-space, or on a layer, to 0.4 of its thickness too."""
    nu = float(random.choice([random.uniform(0.2, 0.49), 0.4999 - 10.0 ** random.uniform(-4, -2)]))
    energy, deepest = str(random.choice(ENERGIES.names)), float(random.uniform(0.02, 0.3))
    target: HalfSpace | Layer = HalfSpace()
    if random.uniform() < 0.4:
        target = Layer(deepest / float(random.uniform(0.1, 0.4)), str(random.choice(["bonded", "sliding"])))
    material = Material(Relaxation(1e6), nu, hyperelastic=energy)
    pressed = Indenter(Sphere(1.0), material, target, model=Model(kinematics="finite"))
    return pressed, (0.4 * deepest, deepest)


def struck(random: np.random.Generator, branches: int) -> Scene:
    """The same, struck so fast that it would go as deep if it were relaxed; so many branches of a Prony series."""
    pressed, (_, deepest) = scene(random)
    curve = pressed.target.load_curve(pressed.shape, pressed.material.nu)
    return struck_with(random, pressed, pressed.modulus(False) * float(curve.energy(deepest)), branches)


def struck_with(random: np.random.Generator, pressed: Indenter, brought: float, branches: int) -> Scene:
    """A mass that has ``brought`` as many J."""
    fast = Scene(pressed.shape, 1.0, float(np.sqrt(2.0 * brought)), pressed.material, target=pressed.target,
                 model=pressed.model)  # fmt: skip
    times = fast.elastic_contact_time * 10.0 ** random.uniform(-1.5, 0.5, branches)
    moduli = 1e6 * random.uniform(0.2, 2.0, branches)
    network = Relaxation(1e6, tuple(moduli.tolist()), tuple(sorted(times.tolist())))
    return replace(fast, material=replace(pressed.material, young=network))


def pair(random: np.random.Generator, name: str) -> tuple[Indenter, float]:
    """Another striker or target, lengths about one, and the largest depth."""
    nu, deepest = float(random.uniform(0.2, 0.49)), float(random.uniform(0.03, 0.25))
    base = str(random.choice(["bonded", "sliding"]))
    layer = Layer(deepest / float(random.uniform(0.1, 0.3)), base)
    inner, section = float(random.uniform(0.3, 2.0)), float(random.uniform(0.2, 0.7))
    shape, target = {
        "cone": (Cone(float(random.uniform(3.0, 15.0))), HalfSpace()),
        "cone, layer": (Cone(float(random.uniform(3.0, 15.0))), layer),
        "power": (PowerProfile(0.3, float(random.uniform(1.5, 4.0))), layer),
        "line": (Cylinder(1.0, 1.0), layer),
        "line, datum": (Cylinder(1.0, 1.0), HalfSpace(float(random.uniform(10.0, 100.0)) * deepest)),
        "ring": (Cylinder(float(random.uniform(0.7, 0.95)), 1.0), Ring(1.0, deepest / 0.25)),
        "o_ring": (Punch(2.0), ORing(1.0, section)),
        "washer": (Punch(9.0), Washer(inner, inner + float(random.uniform(0.5, 2.0)), 1.0, base)),
        "block": (Prism(np.pi, float(random.uniform(0.5, 2.0)), "free", base), Plane()),
    }[name]
    material = Material(Relaxation(1e6), nu, hyperelastic=str(random.choice(ENERGIES.names)))
    deepest *= section if name == "o_ring" else 1.0
    return Indenter(shape, material, target, model=Model(kinematics="finite")), deepest


PAIRS = ("washer", "block", "o_ring", "ring", "line", "cone", "cone, layer", "power", "line, datum")


def compare_with_finer(
    one: Scene, uncovered: Callable[..., dict[str, float]], converged: list[bool], wrong: list[str]
) -> None:
    """Note whether an impact converged, and what lies outside its bars and those of a finer run."""
    loose = answered(partial(run, one, tolerance=TOLERANCE), converged)
    tight = loose and answered(partial(run, one, tolerance=0.25 * TOLERANCE, numerics=FINER), [])
    over = {} if loose is None or tight is None else uncovered(loose, tight)
    if over:
        wrong.append(f"{one.material} {one.geometry.shape} {one.target} {one.velocity:g}: {over}")


@pytest.mark.tenth
def test_finer_runs_lie_within_both_bars(campaign_size: Callable[..., int]) -> None:
    """All scenes with --full, else the first: each takes seconds."""
    count, random = campaign_size(SCENES), np.random.default_rng(18)
    converged, wrong = list[bool](), list[str]()
    for _ in range(count if count == SCENES else 1):
        compare_forces_with_finer(*scene(random), TOLERANCE, converged, wrong)
    assert not wrong
    assert np.mean(converged) >= LEAST


@pytest.mark.tenth
def test_finer_impacts_of_other_pairs_lie_within_both_bars(
    campaign_size: Callable[..., int], uncovered: Callable[..., dict[str, float]]
) -> None:
    """Three of every pair with --full, without a branch, with one, with two; else a washer without."""
    random, whole = np.random.default_rng(23), 3 * len(PAIRS)
    converged, wrong = list[bool](), list[str]()
    for number in range(whole if campaign_size(whole) == whole else 1):
        pressed, deepest = pair(random, PAIRS[number % len(PAIRS)])
        force = indent(replace(pressed, model=Model()), (deepest,), {"tolerance": TOLERANCE}).force[0]
        one = struck_with(random, pressed, 0.4 * float(force) * deepest, number // len(PAIRS))
        compare_with_finer(one, uncovered, converged, wrong)
    assert not wrong
    assert np.mean(converged) >= LEAST


def test_finer_impacts_lie_within_both_bars(
    campaign_size: Callable[..., int], uncovered: Callable[..., dict[str, float]]
) -> None:
    """Elastic, with one branch, with two; all with --full, else the first, which has none."""
    count, random = campaign_size(SCENES), np.random.default_rng(19)
    converged, wrong = list[bool](), list[str]()
    for number in range(count if count == SCENES else 1):
        one = struck(random, number % 3)
        compare_with_finer(one, uncovered, converged, wrong)
    assert not wrong
    assert np.mean(converged) >= LEAST
