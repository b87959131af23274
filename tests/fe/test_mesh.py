"""The mesh under a contact: the same every time, tagged all around, graded as asked, gmsh left closed."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from skfem import MeshTri

import meshes
from meshes import GmshMissing, MeshError
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


@pytest.mark.parametrize(("place", "value", "name"), [(0, 0.5, "elements"), (1, 2.0, "small"), (2, 0.0, "thick")])
def test_a_layer_outside_its_ranges_is_named(place: int, value: float, name: str) -> None:
    numbers = [8.0, 0.1, 1.0, 4.0]
    numbers[place] = value
    with pytest.raises(MeshError, match=f"{name}.*accepted"):
        meshes.layer(*numbers)


def test_a_worker_process_makes_the_same_mesh() -> None:
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        made = pool.submit(meshes.half_space, 2.0, 12.0).result()
    assert identical(made, meshes.half_space(2.0, 12.0))


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
    with pytest.raises(GmshMissing, match=r"apt-get install .*libglu1-mesa") as failure:
        meshes.half_space(2.0, 20.0)
    assert failure.value.exit_code == 2
