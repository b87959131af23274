"""Table 1: eight rows as printed and corrected, against exact load curves, and the scenes that try them."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from lumped.errors import BadInput
from lumped.load_curves import ConeCurve, Hertz, PunchCurve
from lumped.paper.table1 import (
    ROWS,
    ConeRow,
    CylinderRow,
    Elastic,
    PlateRow,
    PrismRow,
    PunchRow,
    SphereRow,
    TableRow,
    TwoCylinders,
    TwoSpheres,
    contact_modulus,
)

STEEL = Elastic(2.0e11, 0.23)
SOFT = Elastic(1.0e6, 0.45)


def bodies(row: TableRow) -> tuple[Elastic, ...]:
    return (STEEL, SOFT)[: row.bodies]


def test_eight_rows_in_their_order() -> None:
    assert [row.number for row in ROWS.values()] == list(range(1, 9))
    assert [row.alpha for row in ROWS.values()] == [1.0, 1.0, 1.0, 1.5, 1.0, 2.0, 1.5, 1.0]
    assert [row.bodies for row in ROWS.values()] == [1, 1, 1, 1, 1, 1, 2, 2]


@pytest.mark.parametrize("row", ROWS.values(), ids=lambda row: row.name)
def test_depths_are_compared_with_the_length_that_is_named(row: TableRow) -> None:
    """Two bodies: the radius of the gap between them, 1/R = 1/R1 + 1/R2; where nothing is named a metre."""
    own = row.to_dict()
    if row.bodies == 2:
        curvature = sum(1.0 / size for name, size in own.items() if "radius" in name)
        assert row.length == pytest.approx(1.0 / curvature, rel=1e-14)
    elif row.length_name:
        assert row.length == own[row.length_name]
    else:
        assert row.length == 1.0


@pytest.mark.parametrize("row", ROWS.values(), ids=lambda row: row.name)
def test_a_correction_is_explained_and_nothing_else_is(row: TableRow) -> None:
    assert bool(row.correction) == (row.printed != row.corrected)
    assert row.validity


@pytest.mark.parametrize(
    ("row", "curve"),
    [
        (SphereRow(0.02), Hertz(0.02)),
        (ConeRow(30.0), ConeCurve(30.0)),
        (PunchRow(0.03), PunchCurve(0.03)),
    ],
    ids=["sphere", "cone", "punch"],
)
def test_corrected_rows_are_the_exact_load_curves(row: TableRow, curve: Hertz | ConeCurve | PunchCurve) -> None:
    depth = np.array([-1e-4, 0.0, 1e-5, 1e-3])
    modulus = STEEL.young / (1.0 - STEEL.nu**2)
    assert row.force(depth, STEEL) == pytest.approx(modulus * np.asarray(curve.force(depth)), rel=1e-13)


def test_forces_of_the_table_are_those_of_its_words() -> None:
    """By hand, in lengths that are none of them one; spheres and cylinders side by side count as one of the gap."""
    depth, young, nu = 2e-5, SOFT.young, SOFT.nu
    half = young / (1.0 - nu**2)
    alone = {
        PrismRow(3e-4, 0.02): 3e-4 / 0.02 * young * depth,
        PlateRow(3e-4, 0.02): 3e-4 / 0.02 * young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) * depth,
        PunchRow(0.03): 0.06 * half * depth,
        SphereRow(0.03): 4.0 / 3.0 * 0.03**0.5 * half * depth**1.5,
        CylinderRow(0.03, 0.4): 0.1 * pi * half * depth,
        ConeRow(45.0): 2.0 / pi * half * depth**2,
    }
    for row, force in alone.items():
        assert row.force(depth, SOFT) == pytest.approx(force, rel=1e-12, abs=0.0), row.name
        assert row.force(-depth, SOFT) == 0.0
    both = 1.0 / ((1.0 - STEEL.nu**2) / STEEL.young + 1.0 / half)
    spheres, cylinders = TwoSpheres(0.03, 0.06), TwoCylinders(0.03, 0.06, 0.4)
    assert (spheres.length, cylinders.length) == pytest.approx((0.02, 0.02), rel=1e-12)
    force = spheres.force(depth, STEEL, SOFT)
    assert force == pytest.approx(4.0 / 3.0 * 0.02**0.5 * both * depth**1.5, rel=1e-12, abs=0.0)
    assert cylinders.force(depth, STEEL, SOFT) == pytest.approx(0.1 * pi * both * depth, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("row", ROWS.values(), ids=lambda row: row.name)
def test_the_scene_has_the_corrected_modulus_and_the_exponent(row: TableRow) -> None:
    """Two routes to E*: the row's formula, and the materials of the scene that is pressed."""
    for scene in (row.scene(*bodies(row)), row.whole_scene(*bodies(row))):
        assert scene.modulus(instant=False) == pytest.approx(row.modulus(*bodies(row)), rel=1e-12)
        assert scene.shape.exponent_of_force == row.alpha


def test_the_cone_lacks_one_minus_nu_squared() -> None:
    """5.3 % for steel, 25 % when incompressible."""
    row = ROWS["cone"]
    for nu, short in ((0.23, 0.0529), (0.5, 0.25)):
        body = Elastic(1.0, nu)
        assert 1.0 - row.printed_modulus(body) / row.modulus(body) == pytest.approx(short, abs=1e-12)


def test_two_bodies_of_steel_have_the_modulus_of_23() -> None:
    assert contact_modulus(STEEL, STEEL) == pytest.approx(STEEL.young / (2.0 * (1.0 - STEEL.nu**2)), rel=1e-14)
    assert contact_modulus(STEEL, STEEL) == pytest.approx(1.055855e11, rel=1e-6)


def test_a_sphere_on_one_far_larger_and_stiffer_is_a_rigid_sphere_on_a_plane() -> None:
    rigid = Elastic(1e20, 0.3)
    pair = TwoSpheres(1e-3, 1e4)
    assert pair.force(1e-5, rigid, SOFT) == pytest.approx(SphereRow(1e-3).force(1e-5, SOFT), rel=1e-6)


def test_a_confined_plate_is_a_prism_without_poisson() -> None:
    """At nu = 0 all moduli of the table are Young's."""
    for row in ROWS.values():
        loose = tuple(Elastic(1e9, 0.0) for _ in range(row.bodies))
        assert row.modulus(*loose) == pytest.approx(row.printed_modulus(*loose), rel=1e-14)
        assert row.modulus(*loose) == pytest.approx(1e9 / row.bodies, rel=1e-14)


def test_line_contact_has_no_d_of_its_own() -> None:
    lines = [row for row in ROWS.values() if not row.single]
    assert [row.number for row in lines] == [5, 8]
    for row in lines:
        assert row.factor == pytest.approx(0.25 * pi * 0.01, rel=1e-14)
        assert row.corrected[0].startswith("none")


def test_impossible_geometry_names_its_key() -> None:
    with pytest.raises(BadInput, match="angle"):
        ConeRow(90.0)
    with pytest.raises(BadInput, match="height"):
        replace(ROWS["prism"], height=0.0)


def test_the_number_of_bodies_is_checked() -> None:
    with pytest.raises(BadInput, match="accepted 2, got 1"):
        ROWS["two_spheres"].force(1e-5, STEEL)
