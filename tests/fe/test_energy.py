"""The energy account of impacts without inertia, term by term, against a row of springs summed here.

Popov's row of springs holds at every instant what the half-space holds, branch by branch, since Abel's transform keeps
the work of one field on another. Its springs are summed from the exact law's path and edge: no finite element, no
march of the suite. Other bodies: what is lost in all is that of the exact law.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

import fe_contact
from fe_contact.march.impact import _crept, balanced, onwards
from lumped import Relaxation, Result, Scene, laws, simulate

Array = npt.NDArray[np.float64]
SCENES = 40
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4)
INSTANTS, SPRINGS = 6000, 400
WIDE = 10.0  # median of bar over error
OF_THE_TOLERANCE = 0.1  # what the account may leave open, over the energy in


def held(scene: Scene, exact: Result) -> tuple[float, float]:
    """Elastic energy in a half-space right at separation, J, and how much a row of half as many springs errs."""
    coarse, fine = (_held(scene, exact, INSTANTS * share, SPRINGS * share) for share in (1, 2))
    return fine, abs(fine - coarse)


def _held(scene: Scene, exact: Result, instants: int, springs: int) -> float:
    """Of springs at x that follow the striker from touch until the edge leaves them, and creep back freely since."""
    history, modulus, share = exact.history, scene.contact_modulus, np.linspace(0.0, 1.0, instants + 1)
    time = history.time[-1] * share**2 * (3.0 - 2.0 * share)  # crowded where contact begins and ends
    depth, edge = (np.interp(time, history.time, column) for column in (history.depth, history.contact_radius))
    x = history.contact_radius.max() * (np.arange(springs) + 0.5) / springs
    gap = scene.profile.load_curve.depth(x)
    moduli, taus = np.array(modulus.moduli)[:, None], np.array(modulus.times)[:, None]
    loose = np.ones_like(taus) @ (moduli / taus).T / (modulus.equilibrium + moduli.sum()) - np.diagflat(1.0 / taus)
    rates, modes = np.linalg.eig(loose)
    stretch, branches = np.zeros(springs), np.zeros((len(taus), springs))
    for number, step in enumerate(np.diff(time), start=1):
        pressed = x < edge[number]
        change = np.where(pressed, depth[number] - gap - stretch, 0.0)
        fade = np.exp(-step / taus)
        stiff = fade * branches + change * taus / step * (1.0 - fade)
        free = np.real(modes @ (np.exp(rates * step)[:, None] * np.linalg.solve(modes, branches)))
        crept = (moduli * (branches - free)).sum(axis=0) / modulus.equilibrium
        stretch = stretch + np.where(pressed, change, crept)
        branches = np.where(pressed, stiff, free)
    energy = modulus.equilibrium * stretch**2 + (moduli * branches**2).sum(axis=0)
    return float(energy.sum() * (x[1] - x[0]))


def drawn(random: np.random.Generator) -> Scene:
    """A ball or a cone on a solid with one branch or two, relaxation within three decades about the contact time."""
    scene = Scene.load(str(random.choice(["polymer-sphere", "polymer-cone"])))
    scene = replace(scene, model=replace(scene.model, profile="parabola"), velocity=float(10 ** random.uniform(-3, 0)))
    count, young = int(random.integers(1, 3)), float(10 ** random.uniform(5, 7))
    material = replace(scene.geometry.material, young=Relaxation(young))
    contact = replace(scene, material=material).elastic_contact_time
    times = tuple(float(contact * 10 ** random.uniform(-2, 1)) for _ in range(count))
    moduli = tuple(float(young * 10 ** random.uniform(-1, 1)) for _ in range(count))
    return replace(scene, material=replace(material, young=Relaxation(young, moduli, times)))


@pytest.mark.tenth
def test_every_term_of_the_account_is_true_within_its_bar(campaign_size: Callable[[int], int]) -> None:
    random, wide = np.random.default_rng(1123), []
    for _ in range(campaign_size(SCENES)):
        scene, tolerance = drawn(random), float(random.choice(TOLERANCES))
        exact = simulate(laws.ting.of(scene), scene, 1e-8)
        result = fe_contact.run(scene, tolerance)
        stored, coarse = held(scene, exact)
        given, out = exact.energy["in"] or 0.0, exact.energy["out"] or 0.0
        true = {"in": given, "out": out, "stored": stored, "viscous": given - out - stored, "contact": 0.0}
        for name, value in {**true, "numerical": 0.0}.items():
            error = abs((result.energy[name] or 0.0) - value)
            assert error <= result.energy_error[name] + coarse + 1e-7 * given, (scene, tolerance, name)
            if name in ("out", "stored", "viscous"):
                wide.append(result.energy_error[name] / (error + coarse))
        closes(result)
    assert np.median(wide) < WIDE


def closes(result: Result) -> None:
    """What is left open is a tenth of the tolerance, and the restitution is that of the energies."""
    energy = {name: value or 0.0 for name, value in result.energy.items()}
    assert abs(energy["residual"]) <= OF_THE_TOLERANCE * result.tolerance * energy["in"], result.scene.name
    restitution = result.quantities["restitution"]
    if result.separated and result.scene.gravity == 0.0:
        assert abs(np.sqrt(energy["out"] / energy["in"]) - (restitution.value or 0.0)) <= 1e-9


OTHER_BODIES = ("polymer-layer", "polymer-layer-line", "polymer-prism", "polymer-punch", "rod-in-ring")


@pytest.mark.tenth
@pytest.mark.parametrize("name", OTHER_BODIES)
def test_what_other_bodies_keep_and_lose_is_what_the_exact_law_loses(name: str) -> None:
    scene = Scene.load(name)
    exact, result = simulate(laws.ting.of(scene), scene, 1e-7), fe_contact.run(scene, 1e-3)
    energy, bars = result.energy, result.energy_error
    lost = (energy["stored"] or 0.0) + (energy["viscous"] or 0.0)
    allowed = bars["stored"] + bars["viscous"] + 2e-4 * (energy["in"] or 0.0) * (name == "rod-in-ring")
    assert abs(lost - (exact.energy["viscous"] or 0.0)) <= allowed
    closes(result)


@pytest.mark.parametrize(
    ("rate", "time", "heat"), [(0.5, 1e-6, 0.5e-6), (0.5, 1e6, 2.0), (0.0, 1.0, 0.0), (-1.0, 1.0, 0.0)]
)
def test_a_body_let_go_turns_into_heat_what_it_stores_and_no_more(rate: float, time: float, heat: float) -> None:
    """At first as fast as it did, in the end all of it; a body that stores nothing has nothing to lose."""
    assert _crept(2.0, rate, time) == pytest.approx(heat, rel=1e-6, abs=1e-15)
    assert _crept(0.0, rate, time) == 0.0


@pytest.mark.family
@pytest.mark.parametrize("name", ["polymer-sphere", "polymer-layer"])
def test_what_a_scheme_of_order_one_loses_is_told(name: str) -> None:
    """Six to thirteen per cent in forty steps: every joule stands in its place, and none is left over."""
    found = fe_contact.run(Scene.load(name), 1e-2, numerics={"scheme": "backward_euler", "steps": 40})
    assert found.energy["numerical"] > 0.05 * found.energy["in"]
    assert abs(found.energy["residual"]) < 1e-12 * found.energy["in"]


def test_an_account_carried_on_leaves_open_what_both_contacts_do() -> None:
    """It ends with what the later contact gives back and stores; what is lost adds up, the flight's heat with it."""
    terms = ("in", "out", "stored", "viscous", "radiated", "contact", "numerical")
    first, later = (
        balanced(dict(zip(terms, row, strict=True))) for row in np.random.default_rng(4).uniform(size=(2, 7))
    )
    found, heat = onwards(later, first, 0.3), 0.3
    assert found["residual"] == pytest.approx(first["residual"] + later["residual"])
    assert (found["out"], found["stored"]) == (later["out"], later["stored"])
    for name in ("radiated", "contact", "numerical"):
        assert found[name] == first[name] + later[name]
    assert found["viscous"] == pytest.approx(first["viscous"] + later["viscous"] + heat)
