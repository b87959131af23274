"""Bars of every kind of scene at every tolerance, against the exact law: none too small.

Draws are wide open: relaxation from 1e-6 to 1e6 contact times, branches up to 1e6 times the relaxed modulus, fluids,
dashpots, Poisson's ratios from -0.99 to 0.4999, layers of 0.01 to 20 contact radii, weights, early ends. What ends with
its name is a failure told, and counts against the share that has to converge. `pytest --full -s` prints the outcome.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

import fe_contact
from lumped import FeContactError, Material, Model, Relaxation, Result, Scene, Sphere, laws, simulate
from lumped.result.result import RULED_RELATIVE
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.power import PowerProfile
from lumped.targets.layer import Layer
from lumped.targets.ring import Ring

CASES = 10  # of a kind at a tolerance
TOLERANCES = (1e-1, 3e-2, 1e-2, 1e-3, 1e-4)
FINEST = 1e-5  # on half-spaces
CONVERGE = 0.95
EXACT = 1e-7
ROUNDING = 1e-9  # of a value
HONOURED = 300  # scenes of random tolerances; of a part every kind, the three first and quick ones twice
LEAST_BAND = 1e-6  # of the peak: what the exact law's own rows may err by
QUANTITIES = ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse")

Draw = Callable[[np.random.Generator], Scene]


class Outcome(NamedTuple):
    """One case: errors and bars by quantity, the band's among them, or why there are none."""

    said: str
    converged: bool
    errors: dict[str, float]
    bars: dict[str, float]


def decades(random: np.random.Generator, low: float, high: float) -> float:
    """A number between two powers of ten, evenly over the decades."""
    return float(10.0 ** random.uniform(low, high))


def viscoelastic(random: np.random.Generator, young: float, contact: float) -> Relaxation:
    """A relaxation about a relaxed modulus, Pa, and a contact time, s; one in ten has none."""
    kind = random.choice(["elastic", "branches", "branches", "branches", "dashpot", "fluid"])
    if kind == "elastic":
        return Relaxation(young)
    if kind == "dashpot":
        return Relaxation(young, viscosity=young * contact * decades(random, -3, 0.5))
    if kind == "fluid":
        return Relaxation(0.0, (young,), (contact * decades(random, -1, 6),))
    count = int(random.integers(1, 4))
    moduli = tuple(young * decades(random, -2, 6 if random.random() < 0.2 else 1) for _ in range(count))
    return Relaxation(young, moduli, tuple(contact * decades(random, -6, 6) for _ in range(count)))


def softened(random: np.random.Generator, scene: Scene) -> Scene:
    """The elastic scene with a material that remembers."""
    material = scene.geometry.material
    relaxation = viscoelastic(random, material.young.equilibrium, scene.elastic_contact_time)
    return replace(scene, material=replace(material, young=relaxation))


def poisson(random: np.random.Generator) -> float:
    return float(random.choice([random.uniform(-0.99, 0.4999), 0.499, 0.4999, 0.45]))


def ball(random: np.random.Generator) -> Scene:
    """A contact radius up to 0.3 of the ball's."""
    radius, young, velocity = decades(random, -4, -1), decades(random, 4, 11), decades(random, -3, 1)
    nu = poisson(random)
    depth = radius * decades(random, -4, 2 * np.log10(0.3))
    mass = 16 / 15 * young / (1 - nu**2) * radius**0.5 * depth**2.5 / velocity**2
    return softened(random, Scene(Sphere(radius), mass, velocity, Material(Relaxation(young), nu)))


def profile(random: np.random.Generator) -> Scene:
    """A cone or a power of the radius, 0.1 mm high at 1 mm."""
    exponent = float(random.uniform(1.2, 6.0))
    shape = random.choice([Cone(float(random.uniform(1.0, 20.0))), PowerProfile(1e-4 / 1e-3**exponent, exponent)])
    material = Material(Relaxation(decades(random, 5, 8)), poisson(random))
    return softened(random, Scene(shape, 0.05, decades(random, -2.5, -1.5), material))


def flat(random: np.random.Generator) -> Scene:
    """A block or a punch."""
    scene = Scene.load(str(random.choice(["polymer-prism", "polymer-punch"])))
    return softened(random, replace(scene, velocity=decades(random, -3, -1)))


def layer(random: np.random.Generator) -> Scene:
    """Spheres, cones and lines, the contact radius of a half-space 0.05 to 100 times the thickness."""
    shape = (Sphere(0.01), Cone(float(random.uniform(2.0, 8.0))), Cylinder(0.01, 0.02))[int(random.integers(3))]
    velocity, base = decades(random, -2.3, -1.3), str(random.choice(["bonded", "sliding"]))
    radius = shape.hertz_impact(1e6, 0.02, velocity).contact_radius
    nu = float(random.uniform(-0.9, 0.48))
    target = Layer(radius * decades(random, -1.3, 2.0), base)
    return softened(random, Scene(shape, 0.02, velocity, Material(Relaxation(1e6), nu), target=target))


def ring(random: np.random.Generator) -> Scene:
    """A rod of 12 mm in a polymer ring."""
    inner = 0.006 + decades(random, -3.3, -2.0)
    material = Material(Relaxation(0.6e6), float(random.uniform(0.2, 0.49)))
    target = Ring(inner, float(random.uniform(0.002, 0.006)))
    return softened(random, Scene(Cylinder(0.006, 0.03), 0.05, decades(random, -2.0, -1.0), material, target=target))


def drop(random: np.random.Generator) -> Scene:
    """A ball under its weight, from thrown to set down."""
    scene = ball(random)
    share = decades(random, -4, 1)  # of its deceleration
    gravity = share * scene.velocity / scene.elastic_contact_time
    return replace(scene, model=Model(gravity=min(gravity, 1e5)))


def early_end(random: np.random.Generator) -> Scene:
    """A ball or a cone that is left in mid contact, or just after."""
    scene = random.choice([ball, profile])(random)
    end = float(random.uniform(0.05, 1.3)) * scene.elastic_contact_time
    return replace(scene, motion=replace(scene.motion, end_time=end))


KINDS: dict[str, Draw] = {draw.__name__: draw for draw in (ball, profile, flat, layer, ring, drop, early_end)}
HALF_SPACES, MESHED = ("ball", "profile"), ("layer", "ring")
SLOW = [pytest.param(kind, marks=pytest.mark.tenth) if kind in MESHED else kind for kind in KINDS]


def tolerances(kind: str) -> tuple[float, ...]:
    return (*TOLERANCES, FINEST) if kind in HALF_SPACES else TOLERANCES


def exact_answer(scene: Scene) -> Result | None:
    """None where there is none, or none to the end."""
    try:
        exact = simulate(laws.ting.of(scene), scene, EXACT)
    except FeContactError:
        return None
    return None if "does not follow" in exact.message else exact  # it approaches again before it has left


def judged(scene: Scene, tolerance: float) -> Outcome | None:
    """None where no exact answer is reached."""
    exact = exact_answer(scene)
    if exact is None:
        return None
    try:
        found = fe_contact.run(scene, tolerance)
    except FeContactError as failure:
        return Outcome(str(failure), False, {}, {})
    return Outcome(found.message, found.converged, *compared(found, exact))


def compared(found: Result, exact: Result) -> tuple[dict[str, float], dict[str, float]]:
    """Errors and bars of all quantities that the exact answer knows, and of the force as long as it does."""
    errors, bars = {}, {}
    for name in QUANTITIES:
        value, true = found.quantities[name], exact.quantities[name]
        if true.value is None:  # of a weight that comes to rest
            continue
        known = np.nan if value.value is None else value.value
        errors[name] = abs(known - true.value)
        bars[name] = (value.error or 0.0) + (true.error or 0.0) + ROUNDING * abs(true.value)
    history = found.history
    rows = history.time < exact.history.time[-1] if not exact.separated else np.ones_like(history.time, dtype=bool)
    missed = np.abs(history.force - exact.history.force_at(history.time))[rows]
    band = (history.force_error + LEAST_BAND * history.force.max())[rows]
    worst = int(np.argmax(missed / band))
    return errors | {"band": float(missed[worst])}, bars | {"band": float(band[worst])}


@pytest.mark.family
@pytest.mark.parametrize("kind", SLOW)
def test_no_bar_is_too_small_and_nearly_all_converge(
    kind: str, campaign_size: Callable[[int], int], capsys: pytest.CaptureFixture[str]
) -> None:
    missed, lines, everything = [], [], list[Outcome]()
    for tolerance in tolerances(kind):
        random = np.random.default_rng([20261123, list(KINDS).index(kind), round(1 / tolerance)])
        found = [judged(KINDS[kind](random), tolerance) for _ in range(campaign_size(CASES))]
        outcomes = [one for one in found if one is not None]
        for number, one in enumerate(outcomes):
            over = {name: error / one.bars[name] for name, error in one.errors.items() if not error <= one.bars[name]}
            if over:
                missed.append((tolerance, number, "converged" if one.converged else "not converged", over))
        lines.append(told(kind, tolerance, outcomes))
        everything += outcomes
    with capsys.disabled():
        sys.stdout.write("\n".join(["", *lines, ""]))
    assert not missed
    assert np.mean([one.converged for one in everything]) >= CONVERGE


def test_the_plan_honours_random_tolerances(campaign_size: Callable[..., int]) -> None:
    """From 1e-2 to 1e-4: its bars meet nearly all of them, and where they do, it errs by no more than asked."""
    random, missed, converged = np.random.default_rng(20261127), [], []
    for number in range(campaign_size(HONOURED, most=len(KINDS) + 3)):
        kind = list(KINDS)[number % len(KINDS)]
        scene, tolerance = KINDS[kind](random), decades(random, -4, -2)
        exact = exact_answer(scene)
        if exact is not None:
            found = fe_contact.run(scene, tolerance)
            converged.append(found.converged)
            shares = {name: share / tolerance for name, share in errors(found, exact).items() if found.converged}
            missed += [(number, kind, name, share) for name, share in shares.items() if not share <= 1.0]
    assert not missed
    assert np.mean(converged) >= CONVERGE


def errors(found: Result, exact: Result) -> dict[str, float]:
    """Of all quantities that a tolerance rules and the exact answer knows, in terms of it."""
    off = {}
    for name in (*RULED_RELATIVE, "restitution"):
        value, true = found.quantities[name].value, exact.quantities[name].value
        if true is not None:
            apart = np.inf if value is None else abs(value - true)
            off[name] = apart / (1.0 if name == "restitution" else abs(true))
    return off


def ratios(outcomes: list[Outcome], name: str) -> list[float]:
    """Bars over errors of a quantity, errors that are zero but for rounding left out."""
    known = [one for one in outcomes if one.converged and one.errors.get(name, 0.0) > 0.0]
    return [one.bars[name] / one.errors[name] for one in known] or [1.0]


def told(kind: str, tolerance: float, outcomes: list[Outcome]) -> str:
    """One line: how many converged, and by quantity the worst error over its bar and the median bar over its error."""
    names = (*QUANTITIES, "band")
    worst = [max((1.0 / ratio for ratio in ratios(outcomes, name)), default=0.0) for name in names]
    middle = [np.median(ratios(outcomes, name)) for name in names]
    by_name = ", ".join(f"{name} {w:.2f} {m:.1f}" for name, w, m in zip(names, worst, middle, strict=True))
    return f"{kind} {tolerance:g}: {sum(one.converged for one in outcomes)} of {len(outcomes)} converged; {by_name}"
