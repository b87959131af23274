"""Any settings that the keys accept, in any company: values within their bars alone and the force within its band.

Against the hereditary law, of which no finite element and no step of the suite's march knows. Not all of these
converge: a bar has to be true before it is small.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fe_contact.budget.certify import certify, other_mesh, other_setting
from fe_contact.budget.plan import plan
from fe_contact.budget.runs import Runs
from fe_contact.methods import simulate as fe
from fe_contact.settings import RANGES
from fe_contact.steppers.steps import Strike
from lumped import FeContactError, Relaxation, Result, Scene, laws, simulate

IMPACTS, SEED, END_TO_END = 60, 20261124, 0.95
TOLERANCES = (0.1, 0.03, 1e-2, 1e-3)
NAMES = ("polymer-sphere", "polymer-cone", "polymer-half-plane", "rod-in-ring", "polymer-layer")
POISSON = (0.0, 0.3, 0.45, 0.49, 0.499, 0.4999)
DRAWN: dict[str, tuple[Any, ...]] = {
    "scheme": ("galerkin", "backward_euler"),
    "order": (1, 2, 3, 4),
    "elements_per_contact": (1.0, 2.0, 4.0, 8.0),
    "steps": (8, 12, 16, 24, 36, 40, 80, 160),
    "penalty": (1.0, 10.0, 30.0, 100.0, 1e4, 1e6),
    "far_radius": (2.0, 4.0, 10.0, 100.0),
    "enforcement": ("penalty", "exact", "augmented", "corrected"),
}
OFTEN = 0.35  # a key is given
QUANTITIES = ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse")
EXACT = 1e-6  # relative, what the law may be off


def scene_of(name: str, young: Relaxation, nu: float | None = None) -> Scene:
    scene = Scene.load(name)
    material = scene.geometry.material
    return replace(scene, material=replace(material, young=young, nu=material.nu if nu is None else nu))


def drawn(rng: np.random.Generator, few: bool) -> tuple[Scene, dict[str, Any]]:
    """Moduli over decades, relaxations about the contact time; ``few``: on half-spaces, which are quick."""
    name, young = str(rng.choice(NAMES[:2] if few else NAMES)), 10 ** rng.uniform(5, 7)
    nu = float(rng.choice(POISSON)) if name in NAMES[:2] else None
    time = scene_of(name, Relaxation(young), nu).elastic_contact_time
    steep, late = 10 ** rng.uniform(-1, 1.5), time * 10 ** rng.uniform(-2, 1.5)
    branches = tuple(young * 10 ** rng.uniform(-1, 0.7, 3))
    times = tuple(np.sort(time * 10 ** rng.uniform(-2, 1, 3)))
    materials = (
        Relaxation(young),
        Relaxation(young, (young * steep,), (late,)),
        Relaxation(young, branches, times),
        Relaxation(young, viscosity=young * time * 10 ** rng.uniform(-2, 0)),
        Relaxation(0.0, (young,), (time * 10 ** rng.uniform(-0.5, 1.5),)),
    )
    given = {key: rng.choice(values).item() for key, values in DRAWN.items() if rng.random() < OFTEN}
    scene = scene_of(name, materials[rng.integers(len(materials))], nu)
    return scene, given | {"tolerance": float(rng.choice(TOLERANCES))}


def missed(found: Result, exact: Result) -> dict[str, float]:
    """Errors over the bars of finite elements alone, of values and of the force along the history, where above one."""
    over = {}
    for name in QUANTITIES:
        value, true = found.quantities[name], exact.quantities[name].value
        if value.value is None or true is None:
            over[name] = 0.0 if value.value is true else np.inf
        else:
            over[name] = abs(value.value - true) / ((value.error or 0.0) + EXACT * abs(true))
    history = found.history
    errors = np.abs(history.force - exact.history.force_at(history.time))
    over["band"] = float(np.max(errors / (history.force_error + EXACT * history.force.max())))
    return {name: ratio for name, ratio in over.items() if not ratio <= 1.0}


@pytest.mark.tenth
def test_values_lie_within_their_bars_whatever_is_set(campaign_size: Callable[[int], int]) -> None:
    rng, ended = np.random.default_rng(SEED), list[bool]()
    few = campaign_size(IMPACTS) < IMPACTS
    for _ in range(campaign_size(IMPACTS)):
        scene, given = drawn(rng, few)
        try:
            found = fe(scene, "fe", given)
        except FeContactError:  # a setting that cannot do, by name
            ended.append(False)
            continue
        ended.append(True)
        assert not missed(found, simulate(laws.ting.of(scene), scene, 1e-7)), (scene, given)
    assert few or np.mean(ended) >= END_TO_END


SLS = Relaxation(2.1e5, (6.65e6,), (1.24e-3,))
FOUND: dict[str, tuple[str, float | None, Relaxation, dict[str, Any]]] = {
    "where the path turns": ("polymer-sphere", 0.0, SLS, {"tolerance": 1e-3, "scheme": "backward_euler"}),
    "at the touch of a dashpot": (
        "polymer-cone",
        0.49,
        Relaxation(4.067e6, viscosity=2.5186e4),
        {"tolerance": 1e-2, "scheme": "backward_euler"},
    ),
    "a variation that fails": (
        "polymer-cone",
        0.499,
        Relaxation(5.526e6),
        {"tolerance": 0.1, "steps": 40, "far_radius": 10.0, "enforcement": "augmented"},
    ),
    "a soft penalty": (
        "polymer-sphere",
        0.45,
        Relaxation(1.29e5),
        {"tolerance": 1e-2, "steps": 80, "penalty": 30.0, "elements_per_contact": 2.0},
    ),
    "a near far field": (
        "polymer-sphere",
        0.49,
        Relaxation(1.008e6, viscosity=1916.0),
        {"tolerance": 0.1, "penalty": 30.0, "far_radius": 4.0, "enforcement": "augmented"},
    ),
    "locking": (
        "polymer-cone",
        0.4999,
        Relaxation(1e6),
        {"tolerance": 0.1, "order": 1, "elements_per_contact": 4.0, "steps": 40},
    ),
    "locking of order two": (
        "polymer-sphere",
        0.4999,
        Relaxation(1e6),
        {"tolerance": 0.1, "order": 2, "elements_per_contact": 2.0, "steps": 40},
    ),
    "locking in plane strain": (
        "polymer-half-plane",
        0.45,
        Relaxation(1e6),
        {"tolerance": 0.1, "order": 1, "elements_per_contact": 3.0},
    ),
}

DEAR = "where the path turns"


@pytest.mark.tenth
@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=pytest.mark.full) if kind == DEAR else kind for kind in FOUND]
)
def test_what_once_lay_outside_lies_within(kind: str) -> None:
    name, nu, young, given = FOUND[kind]
    scene = scene_of(name, young, nu)
    assert not missed(fe(scene, "fe", given), simulate(laws.ting.of(scene), scene, 1e-7))


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_no_setting_is_varied_to_itself(order: int) -> None:
    """At the ends of every range too: a change of nothing is a bar of zero."""
    numerics = plan(Scene.load("polymer-sphere"), {"order": order}).numerics
    for key in ("elements_per_contact", "penalty", "far_radius"):
        for value in RANGES[key]:
            changed, finer = other_setting(numerics.varied(**{key: value}), key)
            assert getattr(changed, key) >= 2.0 * value if finer else getattr(changed, key) == 0.5 * value
            assert getattr(changed, key) >= RANGES[key][0]
    mesh, _ = other_mesh(numerics)
    assert (mesh.order, mesh.elements_per_contact) != (order, numerics.elements_per_contact)


def test_where_a_variation_fails_the_force_is_known_to_no_more_than_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene.load("polymer-sphere")
    numerics, whole = plan(scene, {}).numerics, Runs.curve

    def curve(self: Runs, number: int, settings: Any) -> Any:
        return None if settings.penalty != numerics.penalty else whole(self, number, settings)

    monkeypatch.setattr(Runs, "curve", curve)
    found = certify(Strike.of(scene), scene.geometry, numerics)
    times = np.linspace(0.0, found.curve.duration, 50)
    assert found.force_error(times).min() >= found.curve.dense_force.max()
    assert np.isinf(found.total("peak_force"))


def test_a_contact_that_grows_by_whole_nodes_has_bars_that_hold_and_are_not_ten_times_as_wide() -> None:
    """Exact enforcement makes it so on a mesh that stays, which then agrees with another one by chance more often."""
    striker = {"shape": "sphere", "radius": 0.01, "mass": 0.02, "velocity": 0.0119}
    target = {"shape": "layer", "thickness": 9.49e-3, "base": "sliding"}
    material = {"law": "elastic", "E": 1e6, "nu": 0.073}
    scene = Scene.from_dict({"name": "by-nodes", "striker": striker, "target": target | {"material": material}})
    given = {"tolerance": 0.1, "enforcement": "exact", "elements_per_contact": 2.06, "steps": 80}
    found, exact = fe(scene, "fe", given).quantities, simulate(laws.ting.of(scene), scene, 1e-7).quantities
    for name in QUANTITIES:
        off = abs(found[name].value - exact[name].value)
        assert off <= found[name].error < 10.0 * off, name
