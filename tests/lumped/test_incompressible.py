"""nu = 0.5: every law and the ledger at the limit, by other routes, and what has no finite answer refused by name."""

from __future__ import annotations

import json
import math
import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from lumped import Material, Relaxation, Scene, laws, simulate
from lumped.errors import BadInput, FeContactError
from lumped.indentation import indent
from lumped.load_curves.layer import deficit
from lumped.load_curves.ring import compliances
from lumped.paper import table1
from lumped.paper.table1 import Elastic
from lumped.result.model_ledger import Peak, model_ledger
from lumped.scene.indenter import Indenter
from lumped.schema.files import SCENES

Array = NDArray[np.float64]
PARTS = ("striker", "target")
PEAK = Peak(force=1.0, depth=1e-5, contact_radius=1e-3, duration=1e-3)


def at(nu: float, name: str, changes: dict[str, Any] | None = None) -> Scene:
    """A packaged scene, all its materials with this Poisson's ratio."""
    own = Scene.load(name).to_dict()
    materials = {f"{part}.material.nu": nu for part in PARTS if "material" in own.get(part, {})}
    return Scene.load(name, {**materials, **(changes or {})})


def heavy(name: str) -> dict[str, Any]:
    """A density for the bodies of a packaged scene whose nu is constant; with inertia they have one."""
    scene = Scene.load(name)
    alike = scene.has_geometry and scene.geometry.material.constant == "poisson"
    parts = scene.geometry.yielding if alike and not scene.model.inertia else []
    return {f"{part}.material.density": 1e3 for part, _ in parts}


def test_hertz_on_an_incompressible_half_space() -> None:
    """F = (16/9) E sqrt(R) d^(3/2): m v^2/2 = (2/5) (16/9) E sqrt(R) d^(5/2) at the turn."""
    scene = at(0.5, "steel-ball", {"model.profile": "parabola"})
    young, radius = scene.geometry.material.young.relaxed, scene.geometry.shape.tip_radius or 0.0
    stiffness = 16.0 / 9.0 * young * math.sqrt(radius)
    depth = (0.5 * scene.mass * scene.velocity**2 * 2.5 / stiffness) ** 0.4
    for name in ("hertz", "ting", "correspondence", "mdr"):
        found = simulate(laws.get(name).of(scene), scene, 1e-5).quantities
        for quantity, exact in (("peak_force", stiffness * depth**1.5), ("peak_depth", depth)):
            one = found[quantity]
            assert one.value is not None
            assert abs(one.value - exact) <= (one.error or 0.0) + 1e-12 * exact, (name, quantity)


@pytest.mark.family
@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("polymer-sphere", "mdr"),
        ("polymer-sphere", "ting"),
        ("polymer-cone", "ting"),
        ("polymer-punch", "correspondence"),
        ("polymer-half-plane", "ting"),
        ("two-spheres", "ting"),
        ("polymer-layer", "ting"),
        ("polymer-layer-sliding", "ting"),
        ("polymer-layer-line", "ting"),
        ("rod-in-ring", "correspondence"),
    ],
)
def test_a_law_reaches_its_limit_at_first_order(name: str, law: str) -> None:
    """Ten times nearer to 0.5, ten times nearer to the answer there, which is no jump."""

    def peak(nu: float) -> float:
        scene = at(nu, name)
        return simulate(laws.get(law).of(scene), scene, 1e-6).quantities["peak_force"].value or math.nan

    limit = peak(0.5)
    apart = [abs(peak(0.5 - slack) / limit - 1.0) for slack in (1e-2, 1e-3)]
    assert apart[0] > 1e-3
    assert math.log10(apart[0] / apart[1]) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_the_layers_kernel_is_that_of_an_incompressible_layer(base: str) -> None:
    """(u, w, shear, normal) of a wave k through the thickness, by the matrix exponential: w' = -k u, no bulk modulus.

    With shear modulus one E* is 4, and a pressure cos(k x) moves the surface by 2 L/(4 k).
    """
    for k in (0.05, 0.5, 2.0, 7.0):
        slopes = np.array([[0.0, k, 1.0, 0.0], [-k, 0.0, 0.0, 0.0], [4.0 * k * k, 0.0, 0.0, k], [0.0, 0.0, -k, 0.0]])
        free = [2, 3] if base == "bonded" else [0, 3]  # what the base leaves open
        through = expm(slopes)[:, free]
        moved = through[1] @ np.linalg.solve(through[2:], [0.0, -1.0])
        assert 1.0 + 2.0 * k * moved == pytest.approx(float(deficit(0.5, base, np.array([k]))[0]), abs=1e-11)


def test_the_rings_compliances_are_those_of_an_incompressible_ring() -> None:
    """The same of a wave n around the ring over ln r: (u, v, r shear, r normal); it cannot be widened as a whole."""
    ratio = 0.6
    own = compliances(0.5, ratio)
    assert own[0] == 0.0
    for n in (1, 2, 3, 8):
        slopes = np.array([[-1, -n, 0, 0], [n, 1, 1, 0], [4 * n, 4 * n * n, -1, n], [4, 4 * n, -n, 1]], dtype=float)
        through = expm(slopes * math.log(1.0 / ratio))  # from the inner circle, radius one, to the held outer one
        held = np.linalg.solve(through[:2, :2], through[:2, 3])  # under the inner pressure: shear 0, normal -1
        assert held[0] == pytest.approx(own[n] / 4.0, rel=1e-9)  # (inner radius/E*) c_n with E* = 4 G


def test_a_fluid_of_constant_bulk_modulus_has_a_shear_modulus_of_a_third() -> None:
    """nu tells G = E/(2(1 + nu)) alone where the bulk modulus is given; a solid has none to keep."""
    young, bulk = Relaxation(0.0, (9e5,), (0.01,)), 2e6
    modulus = Material(young, 0.5, constant="bulk", bulk_modulus=bulk).contact_modulus()
    shear = 3e5
    assert modulus.glassy == pytest.approx(4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear), rel=1e-12)
    with pytest.raises(BadInput, match=r"^polymer-sphere\.toml: target\.material\.nu: 0\.5: no finite bulk modulus"):
        at(0.5, "polymer-sphere", {"target.material.constant": "bulk"})


def test_what_cannot_yield_is_refused_by_name() -> None:
    """A block between walls, in an impact, pressed slowly, and in the table."""
    told = r"material(\.|: )nu: 0\.5: held sideways, an incompressible body does not yield"
    changes = {"striker.sides": "confined", "striker.material.nu": 0.5}
    with pytest.raises(BadInput, match=rf"^polymer-prism\.toml: striker\.{told}"):
        Scene.load("polymer-prism", changes)
    with pytest.raises(BadInput, match=rf"^polymer-prism\.toml: striker\.{told}"):
        indent(Indenter.load("polymer-prism", changes), (1e-5,), "ting")
    finite = {}
    for row in table1.ROWS.values():
        bodies = (Elastic(2e6, 0.5), Elastic(3e6, 0.5))[: row.bodies]
        try:
            finite[row.name] = math.isfinite(row.modulus(*bodies)) and math.isfinite(row.printed_modulus(*bodies))
        except BadInput as refused:
            finite[row.name] = re.search(told, str(refused)) is None
    assert [name for name, is_finite in finite.items() if not is_finite] == ["plate"]


@pytest.mark.family
@pytest.mark.parametrize("name", SCENES.names)
def test_every_scene_has_an_answer_or_a_named_refusal(name: str) -> None:
    """By every law, and its ledger is finite."""
    if name.endswith("-bulk"):
        with pytest.raises(BadInput, match=r"-bulk\.toml: target\.material\.nu: 0\.5"):
            at(0.5, name)
        return
    scene = at(0.5, name, heavy(name))
    answers = 0
    for law in laws.available():
        try:
            found = simulate(laws.get(law).of(scene), scene, 1e-2)
        except FeContactError:
            continue
        assert json.dumps([one.to_json(1e-3) for one in found.model_ledger], allow_nan=False)
        assert math.isfinite(found.quantities["peak_force"].value or math.inf)
        answers += 1
    assert answers > 0 or scene.target.name not in ("half_space", "layer", "ring", "rod")


@pytest.mark.parametrize("name", [name for name in SCENES.names if heavy(name)])
def test_the_ledger_does_not_jump_at_the_limit(name: str) -> None:
    """Estimates at 0.5 and next to it agree."""
    first, second = ([one.size for one in model_ledger(at(nu, name, heavy(name)), PEAK)] for nu in (0.5 - 1e-8, 0.5))
    assert first == pytest.approx(second, rel=1e-2, abs=1e-6)
