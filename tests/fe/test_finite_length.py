"""Free ends of bodies in plane strain: three-dimensional elements against exact states, the plane, and themselves."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SolidMesh
from fe_contact.cli import main
from fe_contact.errors import SolidTooLarge
from fe_contact.indentation import expected, settings
from fe_contact.studies.finite_length import Bodies, Pressable, _length, _stiffness, extruded, free_ends
from fe_contact.studies.larger_models import MeasuredEffect, measure
from fe_contact.targets.base import TARGETS
from lumped import Scene
from lumped.result.model_ledger import Peak, ends
from lumped.result.result import percent
from lumped.scene.indenter import Indenter

THICK = 0.003  # m
KINDS = ("ring", "bonded", "sliding")
CAMPAIGN = 40
LARGE = 20_000_000  # matrix entries of what tells whether a bar was right


def body(kind: str, nu: float = 0.45, length: float = 3.0, radius: float = 4.0, fit: float = 0.6) -> Indenter:
    """A ring or a layer under a cylinder; lengths over its thickness, ``fit``: of a rod over its ring."""
    ring = kind == "ring"
    lengths: dict[str, object] = {"striker.length": length * THICK}
    lengths |= {"striker.radius": (fit if ring else 1.0) * radius * THICK}
    lengths |= {"target.thickness": THICK, "target.material.nu": nu}
    lengths |= {"target.inner_radius": radius * THICK} if ring else {"target.base": kind}
    return Indenter.load("rod-in-ring" if ring else "polymer-layer-line", lengths)


def contact(indenter: Indenter, depth: float) -> float:
    """About its radius, m."""
    return float(expected(indenter, np.array([depth]), settings({}, indenter.shape))[0])


def mesh_of(indenter: Indenter, depth: float = 0.05 * THICK, order: int = 2) -> SolidMesh:
    """A coarse section."""
    numerics = settings({"order": order, "elements_per_contact": 1.0}, indenter.shape)
    make = TARGETS.get(indenter.target.name).solid
    assert make is not None
    return make(indenter, np.array([contact(indenter, depth)]), numerics)


@pytest.mark.family
@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.3, 0.49, 0.4999])
@pytest.mark.parametrize("held", [False, True])
def test_a_block_pressed_alike_all_over_is_strained_alike(nu: float, held: bool) -> None:
    """On a base that slides, its sides free: E under uniaxial stress, between held ends E/(1 - nu^2) = 1."""
    mesh = mesh_of(body("sliding"))
    section = mesh.body
    width, height = section.basis.mesh.p.max(axis=1)[0], -section.basis.mesh.p.min(axis=1)[1]
    whole = replace(section.surface, zone=width * (1.0 - 1e-9))
    block = replace(mesh, body=replace(section, surface=whole))
    pressed = extruded(block, nu, np.array([0.0, 0.3, 1.0, 1.2]), 2, held)
    sunk = np.linalg.solve(pressed.surface.stiffness, pressed.surface.trace.T @ pressed.surface.weights)
    np.testing.assert_allclose(sunk, height / (1.0 if held else 1.0 - nu**2), rtol=1e-7)
    assert pressed.pull.sum() == pytest.approx(2.0 * width, rel=1e-12)


@pytest.mark.parametrize("kind", ["ring", "bonded"])
def test_a_body_that_turns_is_not_strained(kind: str) -> None:
    """About all three axes: a ring laid flat has its arcs in the strains along its length, too."""
    mesh = mesh_of(body(kind, radius=2.0), order=4)
    basis, corners = mesh.body.basis, np.array([0.0, 0.3, 1.0])
    x, up = basis.doflocs
    sine, cosine, across, height = 0.0 * x, 0.0 * x + 1.0, x, up
    if mesh.inner_radius is not None:  # up is inwards; measured from the ring's axis
        sine, cosine = np.sin(x / mesh.inner_radius), np.cos(x / mesh.inner_radius)
        across, height = (mesh.inner_radius - up) * sine, (up - mesh.inner_radius) * cosine
    y, none = _places(corners, 2)[:, None], 0.0 * x
    turned = {
        "the length": (height + 0.0 * y, -across + 0.0 * y, none + 0.0 * y),
        "the horizontal": (none + 0.0 * y, y + none, -height + 0.0 * y),
        "the motion": (y + none, none + 0.0 * y, -across + 0.0 * y),
    }
    matrix = _stiffness(mesh, 0.3, _length(corners, 2))
    size = float(abs(matrix).max())
    for axis, (sideways, upwards, along) in turned.items():
        moved = np.stack([cosine * sideways + sine * upwards, cosine * upwards - sine * sideways, along], axis=-1)
        assert abs(matrix @ moved.ravel()).max() <= 1e-5 * size * abs(moved).max(), axis


def _places(corners: Array, order: int) -> Array:
    """Of the nodes along a length."""
    inner = [np.linspace(*ends, order + 1)[1:] for ends in pairwise(corners)]
    return np.concatenate([corners[:1], *inner])


@pytest.mark.family
@pytest.mark.parametrize("nu", [0.3, 0.4999])
@pytest.mark.parametrize("kind", KINDS)
def test_between_held_ends_it_is_in_plane_strain(kind: str, nu: float) -> None:
    """What the section alone says, which its own tests compare with exact laws."""
    indenter, depth = body(kind, nu), 0.05 * THICK
    mesh = mesh_of(indenter, depth)
    bodies = Bodies.of(indenter, contact(indenter, depth), 2)
    section = Pressable.plane(mesh.body.condensed(nu).operator)
    held = extruded(mesh, nu, np.array([0.0, 0.4, 1.0]), 3, held=True)
    alike = replace(bodies, unit=mesh.unit, section=section, drawn=held)
    assert alike.changes(np.array([0.5 * depth, depth])) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.family
@pytest.mark.parametrize("kind", KINDS)
def test_without_poissons_ratio_ends_change_nothing(kind: str) -> None:
    found = free_ends(body(kind, 0.0), 0.1 * THICK)
    assert abs(found.change) <= 1e-9
    assert found.error <= 1e-8


@pytest.mark.family
@pytest.mark.parametrize("nu", [0.4999, -0.2, 0.3, 0.49])
@pytest.mark.parametrize("kind", KINDS)
def test_a_slice_is_in_plane_stress(kind: str, nu: float) -> None:
    """Exactly: as in plane strain of nu/(1 + nu) and E* = E, by load curves without an element."""
    indenter, depth = body(kind, nu, length=0.02), 0.05 * THICK
    strain, stress = (
        float(indenter.target.load_curve(indenter.profile, one).force(depth)) for one in (nu, nu / (1.0 + nu))
    )
    found = free_ends(indenter, depth)
    assert abs(found.change - ((1.0 - nu**2) * stress / strain - 1.0)) <= found.error < 0.04


@pytest.mark.tenth
@pytest.mark.parametrize("kind", [pytest.param("ring", marks=pytest.mark.full), "bonded"])
def test_long_bodies_tend_to_plane_strain_as_one_over_their_length(kind: str) -> None:
    """So does no sliding layer: what its ends shift along it grows as the logarithm of the length."""
    depth = 0.05 * THICK
    short, longer = (free_ends(body(kind, 0.4, length=length), depth) for length in (8.0, 16.0))
    apart = abs(16.0 * longer.change - 8.0 * short.change)
    assert apart <= 0.02 * 8.0 * abs(short.change), "from one mesh: errors are alike"
    assert short.change < longer.change < 0.0


def drawn(rng: np.random.Generator) -> tuple[Indenter, float]:
    """A body and a depth, m."""
    kind, nu = str(rng.choice(KINDS)), float(rng.choice([rng.uniform(0.2, 0.49), 0.499, 0.4999]))
    length, radius = 10.0 ** rng.uniform(math.log10(0.3), 1.0), 10.0 ** rng.uniform(-0.3, 1.3)
    indenter = body(kind, nu, length, radius, fit=float(rng.uniform(0.3, 0.9)))
    deepest = min(0.35 * THICK, 0.5 * (indenter.shape.tip_radius or math.inf))
    return indenter, deepest * 10.0 ** rng.uniform(-1.5, 0.0)


@pytest.mark.tenth
def test_bars_hold_what_finer_meshes_find_and_the_ledger_is_right(
    campaign_size: Callable[..., int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The ledger within a factor of two. Finer: twice as many elements across and along, penalty times four."""
    rng = np.random.default_rng(18)
    outside, wrong = list[str](), list[str]()
    for _ in range(campaign_size(CAMPAIGN, most=2)):
        indenter, depth = drawn(rng)
        found, radius = free_ends(indenter, depth), contact(indenter, depth)
        with monkeypatch.context() as patch:
            patch.setattr("fe_contact.studies.finite_length.MOST_ENTRIES", LARGE)
            finer = Bodies.of(indenter, radius, 4, elements=2.0, first=0.5, far=1.5)
        apart = abs(float(finer.changes(np.array([depth]), 4.0)[0]) - found.change)
        what = f"{indenter.target} {indenter.shape} nu {indenter.material.nu} depth {depth}: {found}"
        outside += [f"{what}, off by {apart}"] if apart > found.error else []
        estimate = ends(indenter.geometry, Peak(1.0, depth, radius, math.inf)).estimate or 0.0
        wrong += [f"{what}, estimated {estimate}"] if not 0.5 < -estimate / found.change < 2.0 else []
    assert not outside
    assert not wrong


def test_a_body_too_large_for_memory_is_refused_by_name() -> None:
    with pytest.raises(SolidTooLarge, match=r"accepted up to 4e[+]06; cure: a shorter striker, or a body thicker"):
        free_ends(body("ring", length=3.0, radius=100.0), 0.3 * THICK)


@pytest.mark.tenth
def test_a_plan_tells_what_is_measured_beside_the_estimate(capsys: pytest.CaptureFixture[str]) -> None:
    """At the depth that it expects, at small strains, whatever the scene's kinematics; without a key."""
    assert main(["plan", "rod-in-ring-finite", "--tolerance", "0.1", "--measure", "--json"]) == 0
    (told,) = json.loads(capsys.readouterr().out)["measured"]
    assert told["effect"] == "finite length"
    assert told["setting"] == ""
    assert told["error"] == pytest.approx(sum(told["budget"].values()), rel=1e-3)
    assert set(told["budget"]) == {"penalty", "order", "section", "length"}
    assert 0.5 * told["estimate"] < -told["change"] < 2.0 * told["estimate"]
    line = str(MeasuredEffect(**told))
    assert line.startswith(f"finite length: estimate {percent(told['estimate'])} | measured -1")
    assert line.endswith(", of the force at the peak depth, at small strains")


def test_what_does_not_end_with_its_striker_is_not_measured() -> None:
    assert measure(Scene.load("polymer-half-plane"), {"tolerance": 0.1}) == ()
