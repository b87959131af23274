"""Later contacts, on a half-space that has not recovered, against independent springs side by side.

The displacement w(x) of the dimensionality reduction (Popov and Hess 2015, doi:10.1007/978-3-642-53876-6) and the
pressure's own transform q(x) are tied point by point by E*(t), pressed or not, however often the edge comes and goes:

    q = E_0 w - sum_k E_k y_k ,    tau_k dy_k/dt = w - y_k ,    w = max(depth - g(x), sum_k E_k y_k / E_0) ,

a spring being either the striker's or free of stress. One set of differential equations holds in contact and flight.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fe_contact
import lumped

Array = np.ndarray
SCENES, SEED, IMPACTS = 20, 20261122, 3
REACH = 1.3  # contact radii of the elastic impact with the relaxed modulus, or the glassy one of a fluid
FLYING = 1e-4  # contact times after which the axis is surely free


class Bounce(NamedTuple):
    """One contact; times since the first touch."""

    start: float
    velocity: float
    duration: float
    restitution: float
    peak_force: float
    peak_depth: float


class Springs:
    """``count`` springs under a sphere."""

    def __init__(self, scene: lumped.Scene, count: int) -> None:
        self.scene, modulus = scene, scene.contact_modulus
        self.moduli, self.times, self.glassy = np.array(modulus.moduli), np.array(modulus.times), modulus.glassy
        elastic = scene.shape.hertz_impact(modulus.equilibrium or modulus.glassy, scene.mass, scene.velocity)
        x = np.linspace(0.0, REACH * elastic.contact_radius, count + 1)
        self.profile = x * np.arctanh(x / scene.shape.radius)  # x int_0^x h'(r)/sqrt(x^2 - r^2) dr of a sphere
        self.weights = np.full(x.size, x[1])
        self.weights[[0, -1]] /= 2.0
        self.precision = {"rtol": 1e-7, "atol": 1e-9 * elastic.depth}

    def places(self, state: Array) -> tuple[Array, Array, Array]:
        dashpots = state[2:].reshape(self.moduli.size, -1)
        free = self.moduli @ dashpots / self.glassy
        return dashpots, free, np.maximum(state[0] - self.profile, free)

    def force(self, state: Array) -> float:
        _, free, place = self.places(state)
        return float(2.0 * self.glassy * self.weights @ (place - free))

    def rate(self, _: float, state: Array) -> Array:
        dashpots, _, place = self.places(state)
        pull = self.scene.gravity - self.force(state) / self.scene.mass
        return np.concatenate([[state[1], pull], ((place - dashpots) / self.times[:, None]).ravel()])

    def until(self, start: float, state: Array, longest: float, turn: int, step: float) -> Any:
        """Until the axis is left (-1) or met (1), or for a time without either (0)."""

        def event(_: float, now: Array) -> float:
            return float(now[0] - self.places(now)[1][0])

        event.terminal, event.direction = True, turn
        events = {"events": event} if turn else {}
        span, how = (start, start + longest), self.precision | events
        return solve_ivp(self.rate, span, state, "DOP853", max_step=step, dense_output=True, **how)


def bounces(scene: lumped.Scene, number: int, count: int = 150) -> list[Bounce]:
    """The first contacts of a scene, each of which separates."""
    springs, time = Springs(scene, count), scene.elastic_contact_time
    state = np.concatenate([[0.0, scene.velocity], np.zeros(springs.moduli.size * springs.profile.size)])
    start, found = 0.0, list[Bounce]()
    while True:
        touch, contact = state[1], springs.until(start, state, 20.0 * time, -1, time / 40.0)
        end, state = contact.t[-1], contact.y[:, -1]
        passed = contact.sol(np.linspace(start, end, 1001)).T
        force = max(springs.force(one) for one in passed)
        found.append(Bounce(start, touch, end - start, -state[1] / touch, force, passed[:, 0].max()))
        if len(found) == number:
            return found
        parted = springs.until(end, state, FLYING * time, 0, np.inf)
        flight = springs.until(parted.t[-1], parted.y[:, -1], 1e3 * time, 1, np.inf)
        start, state = flight.t[-1], flight.y[:, -1]


def fallen(rng: np.random.Generator, number: int) -> lumped.Scene:
    """A ball on one or three Prony terms, or on a Maxwell fluid; flights of 3 to 30 elastic contact times."""
    radius, young, nu = 10 ** rng.uniform(-3, -1), 10 ** rng.uniform(5, 10), rng.uniform(0.0, 0.499)
    mass, depth = rng.uniform(0.5, 2.0) * 4e3 * radius**3, radius * 10 ** (2 * rng.uniform(-2.0, -0.8))
    velocity = np.sqrt(16 / 15 * young / (1 - nu**2) * np.sqrt(radius) * depth**2.5 / mass)
    time = 2.943275 * depth / velocity
    if number % 3 == 2:
        table = {"law": "maxwell", "E": young, "eta": young * time * 10 ** rng.uniform(0.2, 1.5)}
    else:
        terms = 1 + number % 3 * 2
        moduli = rng.uniform(0.2, 2.0) * young * rng.dirichlet(np.ones(terms))
        taus = time * 10 ** rng.uniform(-1.5, 1.0, terms)
        table = {"law": "prony", "E_inf": young, "E": moduli.tolist(), "tau": taus.tolist()}
    gravity = 2 * velocity / (time * 10 ** rng.uniform(0.5, 1.5))
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    return lumped.Scene.from_dict(
        {
            "name": f"fallen-{number}",
            "striker": striker,
            "target": {"shape": "half_space", "material": table | {"nu": nu}},
            "model": {"gravity": gravity},
            "motion": {"impacts": IMPACTS, "end_time": 1e3 * time},
        }
    )


@pytest.mark.tenth
def test_contacts_in_a_row_are_within_their_bars_of_springs_that_remember(campaign_size: Callable[[int], int]) -> None:
    rng, ratios, widths = np.random.default_rng(SEED), [], []
    for number in range(campaign_size(SCENES)):
        scene = fallen(rng, number)
        result = fe_contact.run(scene, tolerance=1e-3)
        told = [one for one in result.contacts if one["duration"] is not None]
        assert len(told) > 1, "a flight as short as that says nothing of a second contact"
        for exact, found in zip(bounces(scene, len(told)), told, strict=True):
            for name, value in exact._asdict().items():
                ratios.append(abs(found[name] - value) / (found[f"{name}_error"] + 1e-6 * value or 1.0))
            widths.append(found["restitution_error"])
    assert np.max(ratios) <= 1.0
    assert np.max(widths) < 2e-3, "bars that hold because they are wide hold nothing"


def test_the_dent_counts(scene_of: Callable[..., lumped.Scene]) -> None:
    """A second contact on a Maxwell fluid, which forgets no dent: stiffer than the first one by more than the bars."""
    scene = scene_of(
        {"law": "maxwell", "E": 3e6, "eta": 6e4},
        model={"gravity": 9.81},
        motion={"impacts": 2, "end_time": 1.0},
    )
    first, second = fe_contact.run(scene, tolerance=1e-3).contacts
    fresh = fe_contact.run(replace(scene, velocity=second["velocity"], motion=lumped.Motion()), tolerance=1e-3)
    again = fresh.quantities["duration"]
    assert second["start"] > first["duration"]
    assert second["duration"] < again.value - 10.0 * (again.error + second["duration_error"])
    exact = bounces(scene, 2)[1]
    assert second["duration"] == pytest.approx(exact.duration, abs=second["duration_error"] + 1e-6 * exact.duration)
