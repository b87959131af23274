"""The mesh under a contact: the same every time, tagged all around, graded as asked, gmsh left closed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial

import numpy as np
import pytest
from skfem import MeshTri

import meshes
from fe_contact.studies.journal import measured
from meshes import GmshMissing, MeshError, triangles
from meshes.errors import MeshTooLarge
from meshes.session import session

RNG = np.random.default_rng(7)
ASKED = [(float(2 ** RNG.uniform(-1, 3.5)), float(10 ** RNG.uniform(0.5, 3))) for _ in range(6)]


def identical(first: MeshTri, second: MeshTri) -> bool:
    return np.array_equal(first.p, second.p) and np.array_equal(first.t, second.t)


def surface_facets(mesh: MeshTri) -> tuple[np.ndarray, np.ndarray]:
    """Inner ends and lengths of the facets of the surface, from the axis outwards."""
    ends = np.sort(mesh.p[0, mesh.facets[:, mesh.boundaries["surface"]]], axis=0)
    ends = ends[:, np.argsort(ends[0])]
    return ends[0], ends[1] - ends[0]


@pytest.mark.parametrize(("elements", "far_radius"), ASKED)
def test_the_same_numbers_give_the_same_mesh(elements: float, far_radius: float) -> None:
    assert identical(meshes.half_space(elements, far_radius), meshes.half_space(elements, far_radius))


@pytest.mark.parametrize(("elements", "far_radius"), ASKED)
def test_the_boundaries_partition_the_outline(elements: float, far_radius: float) -> None:
    mesh = meshes.half_space(elements, far_radius)
    parts = mesh.boundaries
    assert set(parts) == {"surface", "axis", "far"}
    together = np.concatenate([np.asarray(part) for part in parts.values()])
    assert np.array_equal(np.sort(together), np.sort(mesh.boundary_facets())), "every facet belongs to just one"
    middle = {name: mesh.p[:, mesh.facets[:, np.asarray(part)]] for name, part in parts.items()}
    assert np.all(middle["surface"][1] == 0.0)
    assert np.all(middle["axis"][0] == 0.0)
    np.testing.assert_allclose(np.hypot(*middle["far"]), far_radius, rtol=1e-12)


@pytest.mark.parametrize(("elements", "far_radius"), ASKED)
def test_the_quarter_disc_is_filled_by_well_shaped_triangles(elements: float, far_radius: float) -> None:
    mesh = meshes.half_space(elements, far_radius)
    corner = mesh.p[:, mesh.t]
    side = np.roll(corner, -1, axis=1) - corner
    length = np.hypot(*side)
    area = 0.5 * np.abs(side[0, 0] * side[1, 1] - side[1, 0] * side[0, 1])
    rim = np.sort(np.arctan2(-mesh.p[1], mesh.p[0])[np.hypot(*mesh.p) > far_radius * (1 - 1e-9)])
    polygon = 0.5 * far_radius**2 * np.sin(np.diff(rim)).sum()
    assert area.sum() == pytest.approx(polygon, rel=1e-10), "neither holes nor overlaps"
    smallest_angle = 2 * area / np.sort(length, axis=0)[1:].prod(axis=0)  # its sine
    assert smallest_angle.min() > np.sin(np.radians(10))


@pytest.mark.parametrize(("elements", "far_radius"), ASKED)
def test_the_contact_edge_is_a_node_in_the_finest_elements(elements: float, far_radius: float) -> None:
    mesh = meshes.half_space(elements, far_radius)
    assert np.any(np.all(mesh.p == [[1.0], [0.0]], axis=0))
    left, length = surface_facets(mesh)
    at_edge = [length[left < 1.0][-1], length[left >= 1.0][0]]
    assert max(at_edge) < 2 * length.min()
    assert max(at_edge) < 0.1 / elements


def test_elements_per_contact_scales_the_size_at_the_edge() -> None:
    sizes = [surface_facets(meshes.half_space(2.0**k, 20.0))[1].min() for k in range(6)]
    np.testing.assert_allclose(np.divide(sizes[:-1], sizes[1:]), 2, rtol=0.1)


def test_elements_per_contact_scales_every_size_of_a_fine_mesh() -> None:
    """Twice the number: half the size all along the surface, four times the triangles."""
    found = [meshes.half_space(elements, 20.0) for elements in (8.0, 16.0, 32.0)]
    lengths = [surface_facets(mesh) for mesh in found]
    along = [np.interp(np.linspace(0, 2, 41), left + 0.5 * size, size) for left, size in lengths]
    for coarse, fine in ((0, 1), (1, 2)):
        assert found[fine].nelements / found[coarse].nelements == pytest.approx(4, rel=0.1)
        assert np.median(along[coarse] / along[fine]) == pytest.approx(2, rel=0.1)
    left, size = lengths[2]
    assert size[left < 0.6].max() < 1.1 / 32


def test_the_far_radius_costs_little() -> None:
    """A graded mesh pays for distance by its logarithm: no decade costs much more than the one before."""
    sizes = [meshes.half_space(4.0, radius).nelements for radius in (10.0, 100.0, 1000.0, 10000.0)]
    decades = np.diff(sizes)
    assert np.all(decades[1:] < 1.2 * decades[:-1])


def test_threads_make_the_same_mesh() -> None:
    alone = [meshes.half_space(elements, 12.0) for elements in (1.0, 2.0, 3.0, 1.0)]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(meshes.half_space, (1.0, 2.0, 3.0, 1.0), [12.0] * 4))
    assert all(identical(one, other) for one, other in zip(alone, together, strict=True))


LAYERS = [(4.0, 0.1, 0.2, 3.0), (8.0, 0.02, 5.0, 40.0), (8.0, 1.0, 0.05, 0.5)]


@pytest.mark.parametrize(("elements", "smallest", "thickness", "width"), LAYERS)
def test_a_layer_is_as_fine_as_every_contact_asks(
    elements: float, smallest: float, thickness: float, width: float
) -> None:
    mesh = meshes.layer(elements, smallest, thickness, width)
    assert identical(mesh, meshes.layer(elements, smallest, thickness, width))
    together = np.concatenate([np.asarray(part) for part in mesh.boundaries.values()])
    assert np.array_equal(np.sort(together), np.sort(mesh.boundary_facets())), "every facet belongs to just one"
    start, length = surface_facets(mesh)
    within = start + length <= 1.1
    asked = np.minimum(np.maximum(start + length, smallest), 2.0 * thickness) / elements
    assert np.all(length[within] <= 1.6 * asked[within])
    twice = surface_facets(meshes.layer(2.0 * elements, smallest, thickness, width))
    assert np.sum(twice[0] < 1.1) == pytest.approx(2.0 * np.sum(within), rel=0.15)


@pytest.mark.parametrize("thickness", [0.1, 1.0, 30.0])
def test_under_a_rim_elements_shrink_with_their_distance(thickness: float) -> None:
    mesh = meshes.layer_under_rim(8.0, thickness, 4.0 * thickness)
    start, length = surface_facets(mesh)
    assert np.any(start == 1.0), "the rim is a node"
    distance = np.maximum(np.abs(start + 0.5 * length - 1.0), 1e-3 / 8.0)
    assert np.all(length <= 0.8 * distance + 1e-3)
    assert length[start == 1.0] < 1e-3


FLAT_ENDS: dict[str, Callable[[float, float, float], object]] = {
    "half_space": lambda elements, flat, beside: meshes.half_space_for_waves(
        elements / 2.0, 0.9, 10.0, 2.0, flat=flat, beside=beside
    ),
    "layer": lambda elements, flat, beside: meshes.layer(elements, 0.9, 2.0, 10.0, flat, beside),
}


@pytest.mark.parametrize("kind", FLAT_ENDS)
def test_beside_a_flat_end_contacts_are_resolved_alike(kind: str) -> None:
    """Half the distance from its rim to the nearest one asks for a few elements more, not for twice as many."""
    flat, beside = 0.9, 0.02
    mesh, nearer = (FLAT_ENDS[kind](8.0, flat, one) for one in (beside, 0.5 * beside))
    start, length = surface_facets(mesh)
    distance = np.minimum(np.abs(start - flat), np.abs(start + length - flat))
    assert np.all(length <= 1.6 * 5.0 / 8.0 * (beside + distance))
    more = surface_facets(nearer)[0].size - start.size
    assert 1 <= more <= 0.3 * start.size


@pytest.mark.parametrize(
    ("place", "value", "name"),
    [(0, 0.5, "elements"), (1, 2.0, "small"), (2, 0.0, "thick"), (4, 1.2, "flat"), (5, 0.0, "distance")],
)
def test_a_layer_outside_its_ranges_is_named(place: int, value: float, name: str) -> None:
    numbers = [8.0, 0.1, 1.0, 4.0, 0.5, 0.1]
    numbers[place] = value
    with pytest.raises(MeshError, match=f"{name}.*accepted"):
        meshes.layer(*numbers)


@pytest.mark.tenth
def test_a_worker_process_makes_the_same_mesh() -> None:
    asked = partial(meshes.half_space, 2.0, 12.0)
    for _, made in measured({"one": asked, "another": asked}, jobs=2):
        assert identical(made, asked())


def test_a_reader_who_leaves_is_an_error_after_meshing_too() -> None:
    """As in all of Python, and not the silent end of the process, which gmsh asks for."""
    probe = "import os, meshes; meshes.half_space(2.0, 12.0); out, to = os.pipe(); os.close(out); os.write(to, b' ')"
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr.splitlines()[-1]) == (1, "BrokenPipeError: [Errno 32] Broken pipe")


def broken_session() -> None:
    with session("broken") as gmsh:
        gmsh.model.geo.addPoint(0, 0, 0)
        raise ZeroDivisionError


def test_gmsh_is_closed_after_an_exception() -> None:
    before = meshes.half_space(1.0, 8.0)
    gmsh = sys.modules["gmsh"]
    with pytest.raises(ZeroDivisionError):
        broken_session()
    assert not gmsh.isInitialized()
    assert identical(meshes.half_space(1.0, 8.0), before), "nothing of the broken model is left"
    assert not gmsh.isInitialized()


@pytest.mark.parametrize("elements", [0.2, 65.0, 0.0, -1.0, float("nan"), float("inf")])
def test_elements_outside_their_range_are_named(elements: float) -> None:
    with pytest.raises(MeshError, match=r"elements_per_contact = .*accepted 0\.25 to 64"):
        meshes.half_space(elements, 20.0)


@pytest.mark.parametrize("far_radius", [1.9, 1.1e6, 0.0, -20.0, float("nan"), float("inf")])
def test_a_far_radius_outside_its_range_is_named(far_radius: float) -> None:
    with pytest.raises(MeshError, match=r"far_radius = .*accepted 2 to 1e6"):
        meshes.half_space(2.0, far_radius)


def test_a_missing_gmsh_names_the_cure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gmsh", None)
    with pytest.raises(GmshMissing, match="cure: pip install gmsh") as failure:
        meshes.half_space(2.0, 20.0)
    assert failure.value.exit_code == 2


def powers(random: np.random.Generator, *ranges: tuple[float, float]) -> tuple[float, ...]:
    """A number a range, evenly in its logarithm."""
    return tuple(float(np.exp(random.uniform(*np.log(ends)))) for ends in ranges)


def washer_of(random: np.random.Generator) -> tuple[object, ...]:
    inner, rim, outer = sorted(powers(random, *[(1e-3, 1e3)] * 3))
    return (*powers(random, (0.5, 200)), inner, outer, rim, bool(random.random() < 0.5))


ELEMENTS, SHARE, FINER = (1, 200), (1e-6, 1), (1, 16)
FLAT, BESIDE = (1e-3, 1), (1e-4, 1)
RANDOM: dict[str, Callable[[np.random.Generator], tuple[object, ...]]] = {
    "half_space": lambda random: powers(random, (0.25, 64), (2, 1e6), (1, 100), (0.1, 3)),
    "half_space_for_waves": lambda random: powers(random, ELEMENTS, (1e-3, 1), (2, 1e6), FINER, (0.1, 3), FLAT, BESIDE),
    "layer": lambda random: powers(random, ELEMENTS, SHARE, (1e-3, 1e6), (1e-3, 1e8), FLAT, BESIDE),
    "layer_for_waves": lambda random: powers(random, ELEMENTS, SHARE, (1e-3, 1e6), (1e-3, 1e8), FINER),
    "layer_under_rim": lambda random: powers(random, ELEMENTS, (1e-3, 1e6), (1e-3, 1e8)),
    "ring": lambda random: powers(random, ELEMENTS, SHARE, (1e-3, 1e6), (1.2, 1e6)),
    "sphere": lambda random: (*powers(random, ELEMENTS, SHARE, (1e-6, 1.4)), int(random.integers(1, 5))),
    "o_ring": lambda random: (*powers(random, ELEMENTS, SHARE, (1e-6, 1.4), (1, 1e9)), int(random.integers(1, 5))),
    "prism": lambda random: (*powers(random, (0.5, 200), (1e-4, 1e4)), bool(random.random() < 0.5)),
    "washer": washer_of,
}
HARMLESS = 500  # nodes: thrice as many take a tenth of a second, and steep or coarse meshes may be so far off
QUICK = 8_000  # nodes that a test lets gmsh make


@pytest.mark.family
@pytest.mark.parametrize("kind", RANDOM)
def test_the_nodes_of_a_mesh_are_estimated_before_it_is_made(
    kind: str, monkeypatch: pytest.MonkeyPatch, campaign_size: Callable[..., int]
) -> None:
    """Within a factor of three, over all that the numbers may be."""
    monkeypatch.setattr(triangles, "MOST_NODES", QUICK)
    random, estimates, most = np.random.default_rng(12), [0.0], 0
    estimate = triangles.expected_nodes
    monkeypatch.setattr(triangles, "expected_nodes", lambda *asked: estimates.append(estimate(*asked)) or estimates[-1])
    draws = campaign_size(100, least=10)
    while draws > 0 or most <= HARMLESS:  # until the estimate was tried
        draws -= 1
        numbers = RANDOM[kind](random)
        with suppress(MeshError):  # too large, or too small beside the body: refused by name
            nodes = getattr(meshes, kind)(*numbers).nvertices
            most = max(nodes, most)
            assert max(nodes, HARMLESS) / 3 <= max(estimates[-1], HARMLESS) <= 3 * max(nodes, HARMLESS), numbers


def test_a_long_thin_body_is_refused_before_gmsh_is_asked() -> None:
    """Nodes along its sides are what takes time: 30,000 in all, two thirds of them there, took half a minute."""
    with pytest.raises(MeshTooLarge, match="a quarter as many along its boundary"):
        meshes.washer(1.0, 0.0009, 0.001, 0.00095, True)
    assert triangles.expected_nodes("0.01", triangles.Outline((0, -1), (1, 0)), 4e4) < 2e4


def test_a_mesh_too_large_is_refused_before_gmsh_is_asked() -> None:
    with session("nothing is meshed") as gmsh:
        with pytest.raises(MeshTooLarge, match=r"40000 nodes, .* is not made; cure: "):
            triangles.triangulated(gmsh, "0.001", triangles.Outline((0, 0), (1, 1)))
        assert not gmsh.model.mesh.getNodes()[0].size
