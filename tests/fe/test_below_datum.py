"""Large strains of a half-plane, below its datum: small strains, their next order, every frame alike.

Potentials of the half-plane are witnessed by equilibrium, by the stress on its surface and by the closed curve.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fe_contact import run
from fe_contact.errors import ContactTooWide
from fe_contact.indentation import expected, indent, press, settings
from fe_contact.large_strains import depth_reached
from fe_contact.progress import uncounted
from fe_contact.settings import Numerics
from fe_contact.solids import newton
from fe_contact.solids.newton import Equilibrium, balanced
from fe_contact.solids.pressing import Solid, _pressed_on_meshes
from lumped import BadInput, NotReached, Scene
from lumped.load_curves.half_plane import HalfPlane
from lumped.load_curves.plane_contact import ParabolaProfile
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import energy_of
from lumped.numbers import Array
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes.cylinder import Cylinder
from lumped.targets import HalfSpace
from lumped.targets._half_plane_strains import Potentials, _buried_force, _hertz, half_plane_strains

ELEMENTS_LEAVE = 1.5e-5  # of a force, by these settings
LARGE = Model(kinematics="finite")


def cylinder(datum: float, energy: str = "neo_hooke", nu: float = 0.45) -> Indenter:
    """Of radius one."""
    return Indenter(
        Cylinder(1.0, 1.0), Material(Relaxation(1e6), nu, hyperelastic=energy), HalfSpace(datum), model=LARGE
    )


def meshed(pressed: Indenter, depths: tuple[float, ...]) -> tuple[Solid, Numerics, Array]:
    """A body for these depths, its settings and the radii expected."""
    numerics = settings({"tolerance": 1e-2}, pressed.shape, True)
    radii = expected(pressed, np.array(depths), numerics)
    return Solid.of(pressed.elastic(False), radii, numerics), numerics, radii


@pytest.mark.family
@pytest.mark.parametrize(
    ("datum", "energy", "nu"),
    [(2.0, "neo_hooke", 0.45), (2.0, "hencky", 0.45), (2.0, "neo_hooke", 0.2), (10.0, "st_venant_kirchhoff", 0.3)],
)
def test_slight_depths_leave_the_closed_curve_as_the_ledger_has_it(datum: float, energy: str, nu: float) -> None:
    """Two routes to the first order in strain: the forces, and cubic terms of closed fields with what the datum sinks.

    Nearly incompressible neo-Hooke's has no cubic terms in plane strain: most of it is by the datum.
    """
    pressed, depths = cylinder(datum, energy, nu), np.array([1e-3, 3e-3])
    fine = settings({"tolerance": 1e-3}, pressed.shape, True).varied(elements_per_contact=8.0, penalty=4000.0)
    force = press(pressed.elastic(False), depths, expected(pressed, depths, fine), fine).force
    curve = HalfPlane(pressed.shape.line_profile, datum, nu)
    change = force / np.array([float(curve.force(depth)) for depth in depths]) - 1.0
    radii = [float(curve.contact_radius(depth)) for depth in depths]
    told = [
        half_plane_strains(nu, float(depth), radius, datum).change(energy_of(energy))
        for depth, radius in zip(depths, radii, strict=True)
    ]
    near, far = change / told
    first = near + (near - far) * radii[0] / (radii[1] - radii[0])  # without what is of the next order, in half-widths
    assert first == pytest.approx(1.0, abs=0.05 + ELEMENTS_LEAVE / abs(told[0]))


def test_a_depth_below_the_datum_is_the_way_of_the_striker_less_that_of_the_datum() -> None:
    """With the datum held where it came to, the same body is in equilibrium on the same way, under the same force."""
    solid, numerics, radii = meshed(cylinder(1.5), (0.03, 0.1))
    stiffness, encounter = numerics.penalty * solid.unit / float(radii[-1]), solid.encounter
    found = solid.advanced(None, 0.1, stiffness)
    here = found.balance
    assert here.way > 1.1 * here.depth, "the datum goes down"
    held = balanced(encounter.held, np.zeros(encounter.skin.size), here.way, 0.1 * stiffness)
    held = balanced(encounter.held, held.balance.displacement, here.way, stiffness)
    assert held.balance.force == pytest.approx(here.force, rel=1e-7)
    sunk = float(encounter.body.datum @ held.balance.displacement)
    assert held.balance.way + sunk == pytest.approx(0.1 / solid.unit, rel=1e-7)


def test_rates_and_rigid_forces_are_those_at_a_depth_below_the_datum() -> None:
    """By the depth: differences of two equilibria. By the softness: a penalty ten times as stiff."""
    solid, numerics, radii = meshed(cylinder(1.5), (0.03, 0.1))
    stiffness = numerics.penalty * solid.unit / float(radii[-1])

    def at(depth: float, before: Equilibrium | None = None, stiffer: float = 1.0) -> Equilibrium:
        return solid.advanced(before, depth, stiffer * stiffness)

    here = at(0.1)
    ends = [at(depth, here) for depth in (0.0999, 0.1001)]
    rise = (ends[1].balance.displacement - ends[0].balance.displacement) / (0.0002 / solid.unit)
    assert here.rate == pytest.approx(rise, abs=5e-3 * float(np.abs(rise).max()))
    stiff = balanced(
        solid.encounter, here.balance.displacement, here.balance.depth, 10.0 * stiffness, here.balance.state
    )
    softness = here.rigid_force - here.balance.force
    assert stiff.balance.force - here.balance.force == pytest.approx(0.9 * softness, rel=0.05)
    assert stiff.rigid_force == pytest.approx(here.rigid_force, abs=0.05 * abs(softness))


def test_where_whole_steps_fail_ways_with_the_datum_held_lead_to_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """A penalty too stiff for whole steps from rest."""
    solid, numerics, radii = meshed(cylinder(1.5), (0.01, 0.1))
    stiffness, tried = 100.0 * numerics.penalty * solid.unit / float(radii[-1]), []
    plain = newton._with_held_datum

    def counted(*given: object) -> Equilibrium:
        tried.append(1)
        return plain(*given)  # type: ignore[arg-type]  # as it was called

    monkeypatch.setattr(newton, "_with_held_datum", counted)
    found = solid.advanced(None, 0.01, stiffness)
    assert tried
    loose = solid.advanced(None, 0.01, 0.1 * stiffness)
    assert found.rigid_force == pytest.approx(loose.rigid_force, rel=2e-3)
    assert found.balance.depth == pytest.approx(0.01 / solid.unit)


def test_a_slight_impact_is_that_of_small_strains_and_gives_back_all_of_it() -> None:
    scene = Scene(Cylinder(0.01, 1.0), 1.0, 0.02, Material(Relaxation(1e7), 0.4), target=HalfSpace(0.03))
    small, large = run(scene, tolerance=1e-3), run(replace(scene, model=LARGE), tolerance=3e-3)
    for name in ("peak_force", "peak_depth", "duration", "peak_time"):
        one, other = small.quantities[name], large.quantities[name]
        assert abs((one.value or 0.0) - (other.value or 0.0)) < (one.error or 0.0) + (other.error or 0.0), name
    assert large.quantities["restitution"].value == pytest.approx(1.0, abs=1e-6)
    assert large.converged


def test_the_deepest_depth_below_a_datum_is_where_the_striker_has_come_to_rest() -> None:
    """What the body takes up is the work along the depth, not along the striker's whole way."""
    scene = Scene(Cylinder(0.01, 1.0), 1.0, 3.0, Material(Relaxation(1e7), 0.4), target=HalfSpace(0.02), model=LARGE)
    peak = run(scene, tolerance=1e-2).quantities["peak_depth"]
    assert depth_reached(scene) == pytest.approx(peak.value, rel=0.01)


def test_a_datum_as_near_as_the_contact_is_wide_has_no_number() -> None:
    with pytest.raises((BadInput, NotReached), match=r"smaller depths|the datum's depth"):
        indent(cylinder(0.05), (0.02,), {"tolerance": 1e-2})


@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.49])
def test_potentials_balance_leave_the_surface_free_and_push_by_one(nu: float) -> None:
    random, step, place = np.random.default_rng(5), 1e-5, -2.5j
    z = random.uniform(-3.0, 3.0, 40) - 1j * random.uniform(0.05, 4.0, 40)

    def buried(points: Array) -> Potentials:
        return _buried_force(points, place, nu)

    for field in (_hertz, buried):

        def gradient(points: Array, field: object = field) -> Array:
            return field(points).gradient(nu)  # type: ignore[operator, no-any-return]  # one of two

        across, up = ((gradient(z + way) - gradient(z - way)) / (2.0 * step) for way in (step, 1j * step))
        size = np.abs(across).max() + np.abs(up).max()
        assert up[0] == pytest.approx(across[1], abs=1e-6 * size), "slopes of one displacement"
        assert up[2] == pytest.approx(across[3], abs=1e-6 * size)
        balance = stress_slopes(across, nu)[0] + stress_slopes(up, nu)[1]
        assert balance == pytest.approx(0.0, abs=1e-6 * size)
        lift = stress_slopes(across, nu)[1] + stress_slopes(up, nu)[2]
        assert lift == pytest.approx(0.0, abs=1e-6 * size)
    surface = np.linspace(-5.0, 5.0, 11) - 1e-12j
    assert stress_slopes(buried(surface).gradient(nu), nu)[1:] == pytest.approx(0.0, abs=1e-9)
    under = np.tan(0.5 * np.pi * np.linspace(-1.0, 1.0, 40001)[1:-1])
    pressed = stress_slopes(buried(under - 4.0j).gradient(nu), nu)[2] * (1.0 + under**2)
    assert 0.5 * np.pi * np.trapezoid(pressed, dx=2.0 / 40000) == pytest.approx(-1.0, rel=1e-4)


def stress_slopes(gradient: Array, nu: float) -> Array:
    """Stresses (rr, rz, zz) of a gradient at G = 1."""
    trace = 2.0 * nu / (1.0 - 2.0 * nu) * (gradient[0] + gradient[3])
    return np.stack([2.0 * gradient[0] + trace, gradient[1] + gradient[2], 2.0 * gradient[3] + trace])


@pytest.mark.parametrize(("nu", "datum"), [(0.0, 1.5), (0.3, 4.0), (0.45, 30.0), (-0.7, 8.0), (0.45, 1e9)])
def test_the_field_has_the_force_and_the_slope_of_the_closed_curve_of_a_parabola(nu: float, datum: float) -> None:
    """Energy and power of the depth, at a half-width of one."""
    curve = HalfPlane(ParabolaProfile(20.0), datum, nu)
    depth = float(curve.at(1.0).depth)
    here, field = curve.at(1.0), half_plane_strains(nu, depth, 1.0, datum)
    modulus = 2.0 / (1.0 - nu)
    assert field.power * field.energy == pytest.approx(modulus * here.force * depth, rel=2e-3)
    assert field.power == pytest.approx(1.0 + here.stiffness * depth / here.force, rel=2e-3)
    assert math.isfinite(field.change(energy_of("yeoh")))


def test_a_contact_that_outgrows_its_mesh_is_pressed_on_a_wider_one() -> None:
    """Beside a near datum large strains widen it by more than small ones tell; meshes as wide from the first agree."""
    pressed, depths = cylinder(1.0, nu=0.3), np.array([1e-3, 0.1])
    numerics = settings({"tolerance": 1e-2}, pressed.shape, True)
    radii = expected(pressed, depths, numerics)
    with pytest.raises(ContactTooWide):
        _pressed_on_meshes(pressed.elastic(False), depths, radii, numerics, None, uncounted)
    found = press(pressed.elastic(False), depths, radii, numerics)
    at_once = press(pressed.elastic(False), depths, 1.5 * radii, numerics)
    assert found.contact_radius[-1] > 1.15 * radii[-1]
    assert found.force == pytest.approx(at_once.force, rel=2e-3)


@pytest.mark.parametrize("datum", [30.0, 1e3, 1e8])
def test_a_datum_far_down_is_answered_or_refused_by_its_size(datum: float) -> None:
    scene = Scene(Cylinder(0.01, 1.0), 1.0, 0.5, Material(Relaxation(1e7), 0.45), target=HalfSpace(datum), model=LARGE)
    if datum < 100.0:
        assert run(scene, tolerance=1e-2).converged
    else:
        with pytest.raises(BadInput, match=r"target\.datum_depth: thickness over the largest contact"):
            run(scene, tolerance=1e-2)
