"""The defaults over ten decades of stiffness and six of speed: a number with a true bar, or a failure with a name.

Hypothesis draws the scenes, its corners among them; those of the stated range are counted, and nearly all of them
have to converge.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import fe_contact
from lumped import FeContactError, Scene, laws, simulate

SCENES = 500
TOLERANCE = 1e-3
CONVERGE = 0.95
LAWS = ("elastic", "sls", "kelvin_voigt", "maxwell")
QUANTITIES = ("peak_force", "peak_depth", "duration", "impulse", "restitution")


def decades(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers between two powers of ten, evenly over the decades."""
    return st.floats(low, high).map(lambda power: 10.0**power)


@st.composite
def impacts(draw: st.DrawFn) -> Scene:
    """Sphere on half-space; the mass is what brings the contact radius, up to 0.3 striker radii, about."""
    radius, young, speed = draw(decades(-4, 0)), draw(decades(2, 12)), draw(decades(-4, 2))
    nu, share = draw(st.floats(-0.5, 0.499)), draw(decades(-3, np.log10(0.3)))
    depth = share**2 * radius
    mass = 16 / 15 * young / (1 - nu**2) * radius**0.5 * depth**2.5 / speed**2
    assume(1e-20 < mass < 1e12)  # kg, what a scene accepts
    relaxation = draw(decades(-2, 2)) * 2.943275 * depth / speed
    material = table(draw(st.sampled_from(LAWS)), young, relaxation, draw(decades(-2, 1)))
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": speed}
    target = {"shape": "half_space", "material": material | {"nu": nu}}
    return Scene.from_dict({"name": "wide", "striker": striker, "target": target})


def table(law: str, young: float, time: float, branch: float) -> dict[str, Any]:
    """A material table whose relaxed modulus (of a fluid: the instantaneous one) is ``young``, its time in s."""
    tables: dict[str, dict[str, Any]] = {
        "elastic": {"E": young},
        "sls": {"E1": young, "E2": branch * young, "C1": young * time},
        "kelvin_voigt": {"E": young, "eta": 0.1 * young * time},
        "maxwell": {"E": young, "eta": young * time},
    }
    return {"law": law, **tables[law]}


@pytest.mark.tenth
def test_defaults_over_a_wide_range_of_scenes(
    campaign_size: Callable[..., int], uncovered: Callable[..., dict[str, float]]
) -> None:
    converged: list[bool] = []

    @settings(max_examples=campaign_size(SCENES, most=25))
    @given(impacts())
    def sweep(scene: Scene) -> None:
        try:
            found = fe_contact.run(scene, TOLERANCE)
        except FeContactError:
            converged.append(False)
            return
        converged.append(found.converged)
        if found.converged:
            assert not uncovered(found, simulate(laws.ting.of(scene), scene, 1e-6), QUANTITIES)

    sweep()
    assert np.mean(converged) >= CONVERGE, f"{np.mean(converged):.1%} of {len(converged)} scenes"


@pytest.mark.parametrize("depth_share", [1.0, 2.0])
def test_a_striker_that_sinks_in_whole_is_a_named_failure(depth_share: float) -> None:
    """Depth past the equator, where the profile has no answer, ends with its name and no number."""
    radius, young, speed = 0.01, 1e6, 1.0
    mass = 16 / 15 * young / 0.91 * radius**0.5 * (depth_share * radius) ** 2.5 / speed**2
    striker = {"shape": "sphere", "radius": radius, "mass": 3 * mass, "velocity": speed}
    target = {"shape": "half_space", "material": {"law": "elastic", "E": young, "nu": 0.3}}
    with pytest.raises(FeContactError):
        fe_contact.run(Scene.from_dict({"name": "deep", "striker": striker, "target": target}), TOLERANCE)
