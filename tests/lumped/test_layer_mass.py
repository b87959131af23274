"""The mass of a layer that moves with what presses it, in the limits that are known in closed form."""

from __future__ import annotations

import math

import pytest

from lumped import Scene, laws
from lumped.result.model_ledger import Peak, model_ledger
from lumped.targets.layer import THICK, moving_share


@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_what_is_not_squeezed_sideways_moves_alone(base: str, plane: bool) -> None:
    for breadth in (0.0, 0.3, 10.0):
        assert moving_share(0.0, base, breadth, 20.0, plane) == THICK


def test_a_film_of_constant_volume_flows_out_as_a_parabola() -> None:
    # mean u_r = r/(2 h), 6/5 of its square: 6/5 (a/h)^2/8; in plane strain x/h: 6/5 (a/h)^2/3
    for plane, share in ((False, 0.15), (True, 0.4)):
        grown = moving_share(0.5, "bonded", 9.0, 0.0, plane) - moving_share(0.5, "bonded", 0.0, 0.0, plane)
        assert grown == pytest.approx(share * 81.0)


def test_a_compressible_film_flows_out_at_its_edge_alone() -> None:
    """From there on the share falls as h/a."""
    shares = [moving_share(0.3, "bonded", breadth, 0.0, False) for breadth in (0.0, 50.0, 100.0)]
    assert (shares[1] - shares[0]) / (shares[2] - shares[0]) == pytest.approx(2.0, rel=0.05)


def test_waves_that_have_gone_further_make_a_sliding_layer_heavier() -> None:
    near, far = (moving_share(0.4, "sliding", 2.0, way, False) for way in (2.0, 6.0))
    s2 = (0.4 / 0.6) ** 2
    assert far - near == pytest.approx(s2 * 4.0 * 0.5 * math.log(2.0))


def test_the_estimate_is_in_proportion_to_density_and_never_above_the_half_spaces() -> None:
    still = {"model.inertia": False}
    peak, losses = Peak(0.2, 1e-4, 1e-3, 0.016), []
    for density in (10.0, 1000.0):
        (found, *_) = model_ledger(
            Scene.load("polymer-layer-waves", {**still, "target.material.density": density}), peak
        )
        losses.append(found.estimate or 0.0)
    assert losses[1] == pytest.approx(100.0 * losses[0])
    deep, endless = ({**still, "target.thickness": 10.0}, "polymer-layer-waves"), (still, "polymer-sphere-waves")
    first, second = (model_ledger(Scene.load(name, changes), peak)[0].estimate for changes, name in (deep, endless))
    assert first == second


def test_scales_are_found_though_long_steps_would_go_through_the_layer() -> None:
    material = {"law": "elastic", "E": 1e6, "nu": 0.05, "density": 1000.0}
    table = {"shape": "layer", "thickness": 3.3e-4, "base": "bonded", "material": material}
    striker = {"shape": "sphere", "radius": 0.01, "mass": 4e-3, "velocity": 0.03}
    for thickness in (2e-4, 3e-4, 5e-4, 8e-4):
        scene = Scene.from_dict({"striker": striker, "target": table | {"thickness": thickness}})
        exact = laws.get("ting").of(scene).simulate(scene, 1e-4).quantities["peak_depth"].value
        assert laws.correspondence.estimate(scene).peak_depth == pytest.approx(exact, rel=1e-2)


def test_before_an_echo_is_back_a_layer_is_a_half_space() -> None:
    """Nu = 0: density 1000, modulus 1e6, so that 0.1 s of a pulse's half go through 1.58 m and back."""
    material = {"law": "elastic", "E": 1e6, "nu": 0.0, "density": 1000.0}
    striker = {"shape": "cylinder", "radius": 1.0, "length": 1.0, "mass": 1e4, "velocity": 0.1}
    told = []
    for thickness in (1.5, 1.65, 3.0):
        target = {"shape": "layer", "thickness": thickness, "base": "bonded", "material": material}
        scene = Scene.from_dict({"striker": striker, "target": target})
        told.append(model_ledger(scene, Peak(1e4, 0.02, 0.02, 0.2))[0])
    assert "moves with it" in told[0].note
    assert told[1].estimate == told[2].estimate
    assert "radiates" in told[1].note
