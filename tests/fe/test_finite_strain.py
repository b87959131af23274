"""What finite strains change of a sphere's force to first order: energies and the gap, worked out in Hertz's field."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from skfem import (
    Basis,
    BilinearForm,
    ElementTriP3,
    ElementVector,
    FacetBasis,
    LinearForm,
    condense,
    solve,
)

import meshes
from lumped.materials.energies.base import ENERGIES, energy_of, strained
from lumped.numbers import Array
from lumped.result.model_ledger import ENERGY_NAMES, FIRST_ORDER

RNG = np.random.default_rng(13)


def gradient(u: Any, r: Any) -> Any:
    """Of an axisymmetric displacement, shape (3, 3, ...), the hoop last."""
    found = np.zeros((3, 3, *r.shape))
    found[:2, :2], found[2, 2] = u.grad, u[0] / r
    return found


@BilinearForm
def stiffness(u: Any, v: Any, w: Any) -> Any:
    """Of a body with G = 1."""
    first, second = (gradient(one, w.x[0]) for one in (u, v))
    traces = np.einsum("ii...", first) * np.einsum("ii...", second)
    strains = 0.5 * (first + np.swapaxes(first, 0, 1))
    return (w.lame * traces + 2.0 * np.einsum("ij...,ij...", strains, second)) * w.x[0]


def pressure(r: Any) -> Any:
    """Hertz's, one in the middle of a contact of radius one."""
    return np.sqrt(np.maximum(1.0 - r**2, 0.0))


@LinearForm
def load(v: Any, w: Any) -> Any:
    return -pressure(w.x[0]) * v[1] * w.x[0]


WAYS = np.array([[1, 0, 0], [1, 1, 1], [1, -1, 0.5], [0.3, -0.7, 1], [-0.5, 0.2, 0.9], [1, 1, 0]])
STEP = 2e-3  # of the strain along them


def cubic(name: str, lame: float) -> Array:
    """Coefficients of tr E^3, tr E tr E^2 and tr(E^3) in an energy with G = 1, from odd differences; all of its third
    order, since lambda/2 (tr E)^2 + G E:E is its second.
    """

    def odd(step: float) -> Array:
        stretches = [np.sqrt(1.0 + 2.0 * sign * step * WAYS.T) - 1.0 for sign in (1, -1)]
        none = np.zeros(len(WAYS))
        ends = [np.stack([along[0], none, none, along[1], along[2]]) for along in stretches]
        above, below = (strained(energy_of(name), end, 1.0, lame).energy for end in ends)
        return np.asarray(0.5 * (above - below) / step**3)

    terms = np.stack([WAYS.sum(axis=1) ** 3, WAYS.sum(axis=1) * (WAYS**2).sum(axis=1), (WAYS**3).sum(axis=1)], axis=1)
    third = (4.0 * odd(STEP) - odd(2.0 * STEP)) / 3.0
    found, *_ = np.linalg.lstsq(terms, third)
    assert terms @ found == pytest.approx(third, abs=1e-4 * (1.0 + lame))  # it is isotropic
    return np.asarray(found)


def first_order(nu: float) -> dict[str, float]:
    """c1 of each energy: its cubic terms and the work against the gap, over (4/9) E* d^3, and that of the gap alone.

    E = (H + H^T + H^T H)/2: lambda/2 (tr E)^2 + G E:E, in which all energies begin, has cubic terms in H.
    """
    mesh, element, lame = meshes.half_space(8.0, 400.0), ElementVector(ElementTriP3()), 2.0 * nu / (1.0 - 2.0 * nu)
    body = Basis(mesh, element, intorder=7)
    surface = FacetBasis(mesh, element, facets=mesh.boundaries["surface"], intorder=12)
    held = np.concatenate([body.get_dofs("far").all(), body.get_dofs("axis").all(["u^1"])])
    u = solve(*condense(stiffness.assemble(body, lame=lame), load.assemble(surface), D=np.unique(held)))
    r = np.asarray(body.global_coordinates())[0]
    rise, volume = gradient(body.interpolate(u), r), body.dx * r
    strain = 0.5 * (rise + np.swapaxes(rise, 0, 1))
    turned = np.einsum("ki...,kj...->ij...", rise, rise)
    trace, square = np.einsum("ii...", strain), np.einsum("ij...,jk...->ik...", strain, strain)
    powers = trace**3, trace * np.einsum("ii...", square), np.einsum("ij...,ji...", square, strain)
    cubes = np.array([np.sum(power * volume) for power in powers])
    kirchhoff = 0.5 * lame * np.sum(trace * np.einsum("ii...", turned) * volume)
    kirchhoff += np.sum(np.einsum("ij...,ij...", strain, turned) * volume)
    at = np.asarray(surface.global_coordinates())[0]
    modulus = 2.0 / (1.0 - nu)
    depth = 0.5 * math.pi / modulus  # a^2/R with a = 1 where Hertz's pressure is one
    gap = -np.sum(pressure(at) * np.asarray(surface.interpolate(u))[0] * at * depth * surface.dx * at)
    works = {"gap": gap}
    for name in ENERGIES.names:
        works[ENERGY_NAMES[name]] = gap + kirchhoff + cubic(name, lame) @ cubes
    return {name: float(2.0 * math.pi * work / (4.0 / 9.0 * modulus * depth**3)) for name, work in works.items()}


@pytest.mark.family
@pytest.mark.parametrize("nu", [-0.6, 0.0, 0.3, 0.49, *RNG.uniform(-0.5, 0.48, 2)])
def test_the_ledgers_polynomials_are_what_finite_elements_find(nu: float) -> None:
    """Of every energy. Gap alone: (1-2nu)/((1-nu) pi) by Johnson's (3.41b), ISBN 978-0-521-34796-9."""
    found = first_order(nu)
    assert found.pop("gap") == pytest.approx((1.0 - 2.0 * nu) / (1.0 - nu) / math.pi, abs=2e-4)
    for name, change in found.items():
        assert change == pytest.approx(float(FIRST_ORDER[name](nu)) / (1.0 - nu) ** 2, abs=2e-4), name
