"""Adding a thing is adding a file: every member of every folder keeps its contract; and imports stay light."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumped import BadInput, Relaxation, Scene, laws, simulate
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE, UNITS
from lumped.scene.tables import Model, Motion
from lumped.schema.keys import keys_of
from lumped.shapes import SHAPES as SHAPE_KINDS
from lumped.shapes import Shape
from lumped.targets import TARGETS as TARGET_KINDS
from lumped.targets import Target

WAVES = {"rod_waves", "bar_waves"}
SAMPLES: dict[str, list[dict[str, Any]]] = {
    "elastic": [{"E": 1e6}],
    "kelvin_voigt": [{"E": 1e6, "eta": 1e3}],
    "maxwell": [{"E": 1e6, "eta": 1e3}],
    "sls": [{"E1": 1e6, "E2": 1e6, "C1": 1e3}, {"E0": 1e6, "R1": 0.5, "R2": 0.01}],
    "prony": [{"E_inf": 1e6, "E": (1e6,), "tau": (1e-3,)}],
    "operators": [{"p": (1.0, 1e-3), "q": (1e6, 2e3)}],
    "fractional_zener": [{"E_inf": 1e6, "E_glass": 1e7, "tau": 1e-2, "alpha": 0.5}],
    "measured": [{"file": Path(__file__).parent / "moduli.csv"}],
}
SHAPES = {
    "sphere": {"radius": 0.01},
    "cone": {"angle": 10.0},
    "power": {"coefficient": 100.0, "exponent": 3.0},
    "punch": {"radius": 0.01},
    "cylinder": {"radius": 0.01, "length": 0.02},
    "prism": {"area": 1e-4, "height": 0.02, "sides": "free", "faces": "bonded"},
    "sphere_cone": {"radius": 0.001, "angle": 20.0},
    "rounded_punch": {"flat_radius": 0.002, "edge_radius": 0.01},
    "profile": {"r": [0.0, 1e-3, 2e-3], "height": [0.0, 1e-5, 4e-5]},
    "plate": {"area": 1e-4, "thickness": 0.002, "sides": "confined", "faces": "sliding"},
}
TARGETS: dict[str, dict[str, object]] = {
    "half_space": {},
    "layer": {"thickness": 0.01, "base": "bonded"},
    "ring": {"inner_radius": 0.02, "thickness": 0.005},
    "plane": {},
    "sphere": {"radius": 0.02},
    "cylinder": {"radius": 0.02, "support": "held"},
    "o_ring": {"mean_radius": 0.02, "section_radius": 0.002},
    "rod": {"area": 1e-4, "length": 0.5, "end": "fixed"},
    "washer": {"inner_radius": 0.01, "outer_radius": 0.02, "height": 0.005, "base": "sliding"},
}


def test_samples_cover_every_member() -> None:
    assert set(SAMPLES) == set(NETWORKS.names)
    assert set(SHAPES) == set(SHAPE_KINDS.names)
    assert set(TARGETS) == set(TARGET_KINDS.names)
    assert {"hertz", "correspondence", "ting", "mdr"} <= set(laws.available())


def test_every_key_stands_beside_what_it_fills_and_says_what_it_means() -> None:
    kinds = [*SHAPE_KINDS.members.values(), *TARGET_KINDS.members.values(), *NETWORKS.members.values()]
    sets = [keys for kind in (*kinds, *map(laws.get, laws.available())) for keys in kind.sets]
    for keys in (*sets, *map(keys_of, (Scene, Material, Model, Motion))):
        assert all(key.meaning and key.kind.accepted for key in keys.values())
    assert not any(key.required for name in laws.available() for key in laws.get(name).keys.values())


@pytest.mark.parametrize("name", SAMPLES)
def test_network_makes_a_relaxation_of_each_set_of_keys(name: str) -> None:
    network = NETWORKS.get(name)
    for keys, values in zip(network.sets, SAMPLES[name], strict=True):
        assert {key for key in keys if keys[key].required} <= set(values) <= set(keys)
        assert isinstance(network.of(**values), Relaxation)
        assert all(
            keys[key].kind.read(list(value) if isinstance(value, tuple) else value) == value
            for key, value in values.items()
        )


@pytest.mark.parametrize("name", SHAPES)
def test_shape_is_frozen_and_named_like_its_file(name: str) -> None:
    shape = SHAPE_KINDS.get(name).of(**SHAPES[name])
    assert isinstance(shape, Shape)
    assert shape.name == name
    assert shape.to_dict() == {"shape": name, **SHAPES[name]}
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(shape, dataclasses.fields(shape)[0].name, 1.0)


@pytest.mark.parametrize("name", TARGETS)
def test_target_is_named_like_its_file(name: str) -> None:
    target = TARGET_KINDS.get(name).of(**TARGETS[name])
    assert isinstance(target, Target)
    assert target.to_dict() == {"shape": name, **TARGETS[name]}


@pytest.mark.parametrize("name", sorted(set(laws.available()) - WAVES))  # on no half-space
def test_law_simulates_what_it_claims(name: str, impact: Callable[..., Scene]) -> None:
    scene = impact(0.5, (0.5,), (1.0,))
    law = laws.get(name).of(scene)
    assert law.name == name
    assert dataclasses.is_dataclass(law)
    result = simulate(law, scene, tolerance=1e-4)
    assert result.converged
    assert result.separated
    assert result.method == name
    assert set(result.quantities) == set(UNITS)
    for key in (*RULED_RELATIVE, *RULED_ABSOLUTE):
        quantity = result.quantities[key]
        assert quantity.value is not None
        assert quantity.error is not None
        assert quantity.error <= 1e-4 * (abs(quantity.value) if key in RULED_RELATIVE else 1.0)
    assert result.energy["residual"] == pytest.approx(0.0, abs=1e-5 * result.energy["in"])
    assert result.history.force.min() >= 0.0
    assert result.work


@pytest.mark.parametrize(("name", "meant"), [("corespondence", "correspondence"), ("TING", "ting")])
def test_unknown_law_names_the_nearest(name: str, meant: str) -> None:
    with pytest.raises(BadInput, match=f"did you mean {meant}"):
        laws.get(name)


def run(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.strip()


def test_scenes_and_the_spring_row_need_numpy_alone() -> None:
    code = (
        "import sys, lumped; scene = lumped.Scene.load('steel-ball-sls'); lumped.laws.mdr.estimate(scene, 32);"
        "lumped.simulate(lumped.laws.mdr.of(scene), scene, 1e-4);"
        "print([m for m in ('scipy', 'skfem', 'gmsh', 'meshio', 'matplotlib') if m in sys.modules])"
    )
    assert run(code) == "[]"
