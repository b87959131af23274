"""Any scheme, mass and enforcement on rods and bars: a number within its bar, or a named failure with a cure."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
import pytest

from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.errors import RodTooLong
from fe_contact.methods import simulate
from lumped import BadInput, Scene, laws
from lumped.errors import NotReached
from lumped.result.result import UNITS

CASES = 30
ROUNDING = 1e-7  # of a number


def method(rng: np.random.Generator) -> dict[str, Any]:
    """Any way to solve, and a tolerance that most reach."""
    packages = {"scheme": WAVE_SCHEMES, "mass": MASSES, "enforcement": ENFORCEMENTS}
    drawn = {key: str(rng.choice(package.names)) for key, package in packages.items()}
    return {"tolerance": 0.1, "rho": rng.uniform(0.0, 1.0), **drawn}


def rod(rng: np.random.Generator, ratio: float, end: str) -> Scene:
    """A rod struck flat; ``ratio`` of its mass to the striker's."""
    length, area, modulus = rng.uniform(0.2, 3.0), 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(9, 11.3)
    material = {"law": "elastic", "E": modulus, "nu": rng.uniform(0.0, 0.45), "density": 2500.0}
    return Scene.from_dict(
        {
            "striker": {"shape": "punch", "radius": 0.1, "mass": area * length * 2500.0 / ratio, "velocity": 0.7},
            "target": {"shape": "rod", "area": area, "length": length, "end": end, "material": material},
            "model": {"inertia": True},
        }
    )


def check(scene: Scene, given: dict[str, Any], truth: dict[str, float | None]) -> None:
    """Every known number within its bar."""
    found = simulate(scene, "fe", given)
    for name, known in truth.items():
        quantity = found.quantities[name]
        if known is None or quantity.value is None:
            assert quantity.value is known, (name, given)
        elif np.isfinite(quantity.error or np.inf):
            assert abs(quantity.value - known) <= quantity.error + ROUNDING * abs(known), (name, given)


def exact(scene: Scene) -> dict[str, float | None]:
    quantities = laws.get("rod_waves").of(scene).simulate(scene, 1e-7).quantities
    return {name: quantities[name].value for name in UNITS if name not in ("peak_time", "history_l2")}


@pytest.mark.tenth
def test_another_method_knows_what_it_errs_by(campaign_size: Callable[..., int]) -> None:
    """Also where contact chatters: half the steps chatter alike, the usual method does not."""
    rng = np.random.default_rng(83)
    echo = {"peak_force": 300.0, "duration": 2.0 / 3.0, "restitution": 1.0, "impulse": 200.0, "peak_depth": 5.0 / 3.0}
    for _ in range(campaign_size(CASES, most=1)):
        struck = rod(rng, rng.uniform(0.3, 3.0), str(rng.choice(["fixed", "free"])))
        for scene, truth in ((struck, exact(struck)), (Scene.load("bar-impact"), echo)):
            given = method(rng)
            with suppress(NotReached):  # a failure with a name
                check(scene, given, truth)


@pytest.mark.family
@pytest.mark.parametrize(("end", "ratio"), [("fixed", 23.0), ("free", 31.0)])
def test_a_light_striker_stays_until_the_echo_comes(end: str, ratio: float) -> None:
    """Its force falls below rounding long before; what throws it back is the echo alone."""
    scene = rod(np.random.default_rng(84), ratio, end)
    check(scene, {"tolerance": 0.03}, exact(scene))


def test_steps_of_a_user_that_say_nothing_are_refused() -> None:
    """Half of them would make the same rod of one element, and no difference."""
    with pytest.raises(BadInput, match=r"numerics.steps: 8 in .*accepted: from \d+"):
        simulate(Scene.load("rod"), "fe", {"steps": 8, "tolerance": 0.1})


def test_a_rod_too_long_for_so_short_a_contact_has_a_name() -> None:
    with pytest.raises(RodTooLong, match="cure: a shorter one"):
        simulate(Scene.load("concrete-pole", {"striker.mass": 1e-6}), "fe", {})


@pytest.mark.tenth
def test_a_contact_within_one_step_has_a_name() -> None:
    """A penalty as stiff as many elements, in stages: touch and separation between two samples."""
    scene = rod(np.random.default_rng(85), 1.2, "fixed")
    given = {"scheme": "staged", "mass": "lumped", "enforcement": "penalty", "penalty": 1e6}
    with pytest.raises(NotReached, match="cure: "):
        simulate(scene, "fe", given)


def test_a_contact_that_goes_on_has_no_duration() -> None:
    found = simulate(Scene.load("bar-impact", {"motion.end_time": 0.1}), "fe", {})
    assert found.contacts[0]["duration"] is None
    assert found.contacts[0]["restitution"] is None
    assert found.quantities["duration"].value is None
