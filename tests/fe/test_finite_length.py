"""Free ends of bodies in plane strain: three-dimensional elements against exact states, the plane, and themselves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fe_contact.assembly.operators import ElasticBody, SolidMesh
from fe_contact.bodies.extruded import Pressable, extruded
from fe_contact.errors import BodyTooFine
from fe_contact.indentation import expected, settings
from fe_contact.studies import finite_length
from fe_contact.studies.finite_length import LOWER, Bodies, free_ends
from fe_contact.studies.larger_models import measure
from fe_contact.targets.base import TARGETS
from lumped import Scene
from lumped.scene.indenter import Indenter

THICK = 0.003  # m
KINDS = ("ring", "bonded", "sliding")
CAMPAIGN = 300


def body(kind: str, nu: float = 0.45, length: float = 3.0, radius: float = 4.0, fit: float = 0.6) -> Indenter:
    """A ring or a layer under a cylinder; lengths over its thickness, ``fit``: of a rod over its ring."""
    ring = kind == "ring"
    lengths = {"striker.radius": (fit if ring else 1.0) * radius * THICK, "striker.length": length * THICK}
    lengths |= {"target.thickness": THICK, "target.material.nu": nu}
    lengths |= {"target.inner_radius": radius * THICK} if ring else {"target.base": kind}
    scene = Scene.load("rod-in-ring" if ring else "polymer-layer-line", lengths)
    return Indenter(scene.profile, scene.geometry.material, scene.geometry.target)


def contact(indenter: Indenter, depth: float) -> float:
    """About its radius, m."""
    return float(expected(indenter, np.array([depth]), settings({}, indenter.shape))[0])


def mesh_of(indenter: Indenter, depth: float = 0.05 * THICK) -> SolidMesh:
    """A coarse section."""
    numerics = settings({"order": 2, "elements_per_contact": 1.0}, indenter.shape)
    make = TARGETS.get(indenter.target.name).solid
    assert make is not None
    return make(indenter, np.array([contact(indenter, depth)]), numerics)


@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.3, 0.49, 0.4999])
@pytest.mark.parametrize("held", [False, True])
def test_a_block_pressed_alike_all_over_is_strained_alike(nu: float, held: bool) -> None:
    """On a base that slides, its sides free: E of uniaxial stress with free ends, E/(1 - nu^2) = 1 between held ones."""
    mesh = mesh_of(body("sliding"))
    section: ElasticBody = mesh.body
    width, height = section.basis.mesh.p.max(axis=1)[0], -section.basis.mesh.p.min(axis=1)[1]
    whole = replace(section.surface, zone=width * (1.0 - 1e-9))
    block = replace(mesh, body=replace(section, surface=whole))
    pressed = extruded(block, nu, np.array([0.0, 0.3, 1.0, 1.2]), 2, held)
    sunk = np.linalg.solve(pressed.surface.stiffness, pressed.surface.trace.T @ pressed.surface.weights)
    np.testing.assert_allclose(sunk, height / (1.0 if held else 1.0 - nu**2), rtol=1e-7)
    assert pressed.pull.sum() == pytest.approx(2.0 * width, rel=1e-12)


@pytest.mark.parametrize("nu", [0.3, 0.4999])
@pytest.mark.parametrize("kind", KINDS)
def test_between_held_ends_it_is_in_plane_strain(kind: str, nu: float) -> None:
    """What the section alone says, which its own tests compare with exact laws."""
    indenter, depth = body(kind, nu), 0.05 * THICK
    mesh = mesh_of(indenter, depth)
    bodies = Bodies.of(indenter, contact(indenter, depth), LOWER)
    section = Pressable.plane(mesh.body.condensed(nu).operator)
    held = extruded(mesh, nu, np.array([0.0, 0.4, 1.0]), 3, held=True)
    alike = replace(bodies, unit=mesh.unit, section=section, drawn=held)
    assert alike.changes(np.array([0.5 * depth, depth])) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_without_poissons_ratio_ends_change_nothing(kind: str) -> None:
    found = free_ends(body(kind, 0.0), 0.1 * THICK)
    assert abs(found.change) <= 1e-9
    assert found.error <= 1e-8


@pytest.mark.parametrize("nu", [-0.2, 0.3, 0.49, 0.4999])
@pytest.mark.parametrize("kind", KINDS)
def test_a_slice_is_in_plane_stress(kind: str, nu: float) -> None:
    """Exactly: as in plane strain of nu/(1 + nu) and E* = E, by load curves without an element."""
    indenter, depth = body(kind, nu, length=0.01), 0.05 * THICK
    strain, stress = (
        float(indenter.target.load_curve(indenter.profile, one).force(depth)) for one in (nu, nu / (1.0 + nu))
    )
    found = free_ends(indenter, depth)
    print(kind, nu, found, (1.0 - nu**2) * stress / strain - 1.0)
    assert abs(found.change - ((1.0 - nu**2) * stress / strain - 1.0)) <= found.error < 0.04
