"""Slabs with waves: two rods that collide, against their echoes; momentum, energy, and the limit of stiff slabs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lumped.laws._force_law import ForceLaw, between_masses
from lumped.pounding import Gap, PoundingFrames, ShearFrame, Sine, simulate
from lumped.pounding.case_file import PoundingCase, read
from lumped.pounding.frames import Slab
from lumped.pounding.study import pounding
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice

MASSES, LENGTHS, MODULUS, DENSITY, SPEED = (3e4, 2e4), (21.0, 18.0), 3e10, 2500.0, 0.5
PASSAGES = [length * (DENSITY / MODULUS) ** 0.5 for length in LENGTHS]
IMPEDANCES = [mass / passage for mass, passage in zip(MASSES, PASSAGES, strict=True)]


def slabs(modes: int, stiffer: float = 1.0) -> dict[str, Slab]:
    return {
        side: Slab(side, 1, length, stiffer * MODULUS, DENSITY, modes=modes)
        for side, length in zip(("left", "right"), LENGTHS, strict=True)
    }


def spring(k: float) -> ForceLaw:
    law = LawChoice("linear_spring", {"k": k})
    return between_masses("linear_spring", Scene(None, mass=MASSES[0], velocity=SPEED, target_mass=MASSES[1], law=law))


def colliding(k: float, modes: int) -> PoundingCase:
    """Two rods without columns, one of them at rest."""
    table: dict[str, Any] = {
        "structure": {
            "left": {"mass": [MASSES[0]], "stiffness": [0.0], "velocity": [SPEED]},
            "right": {"mass": [MASSES[1]], "stiffness": [0.0]},
        },
        "gap": {"end": {"left": 1, "right": 1}},
        "slab": {name: vars(slab) for name, slab in slabs(modes).items()},
        "law": {"name": "linear_spring", "k": k},
        "motion": {"end_time": 4.5 * max(PASSAGES)},
    }
    return read(table)


def echoes(k: float, steps: int = 4200) -> dict[str, float]:
    """Peak force, impulse and duration by the method of steps: an end pushed by F moves at -(F + 2 sum F(t - j T))/Z.

    T is twice the passage. Between two times the echoes are straight lines, and the equation of F is solved exactly.
    """
    step = 2.0 * min(PASSAGES) / steps
    force, delays = np.zeros(40 * steps), [round(2.0 * passage / step) for passage in PASSAGES]

    def push(i: int) -> float:
        back = [2.0 * force[i % delay : i : delay].sum() / z for delay, z in zip(delays, IMPEDANCES, strict=True)]
        return k * (SPEED - sum(back))

    rate = k * sum(1.0 / z for z in IMPEDANCES)
    fallen = np.exp(-rate * step)
    constant = (1.0 - fallen) / rate
    rising, i = (step - constant) / rate, 0
    while force[i] >= 0.0:
        low, high = push(i), push(i + 1)
        force[i + 1], i = force[i] * fallen + low * constant + (high - low) / step * rising, i + 1
    end = i - 1 + force[i - 1] / (force[i - 1] - force[i])
    return {"peak_force": force.max(), "impulse": step * force[:i].sum(), "duration": step * end}


def test_the_echoes_begin_with_the_plateau_of_two_rods() -> None:
    plateau = SPEED / sum(1.0 / z for z in IMPEDANCES)
    assert echoes(1e13)["peak_force"] == pytest.approx(plateau, rel=1e-9)


@pytest.mark.family
@pytest.mark.parametrize("k", [3e8, 3e9])
def test_two_rods_collide_as_their_echoes_say_within_the_bars(k: float) -> None:
    """Soft and hard beside the rods, whose EA/length are 0.8e9 and 0.7e9 N/m."""
    case, exact = colliding(k, 16), echoes(k)
    found = pounding(case, case.laws())
    (contact,) = found.result.contacts
    for name in ("peak_force", "impulse"):
        assert abs(found.result.measures()[name] - exact[name]) <= found.errors[name] + 1e-6 * exact[name], name
    assert contact.impulse == pytest.approx(exact["impulse"], rel=1e-3)
    assert contact.end == pytest.approx(exact["duration"], rel=3e-3)
    speeds = found.result.motion.velocity[-1] - found.result.motion.velocity[0]
    assert speeds * MASSES == pytest.approx([-contact.impulse, contact.impulse], rel=1e-12)
    assert found.result.energy.open_share < 1e-12


def test_more_modes_converge_faster_than_their_number() -> None:
    exact = echoes(1e9)
    off = []
    for modes in (4, 16):
        case = colliding(1e9, modes)
        (contact,) = simulate(case.frames, case.laws(), end_time=case.end_time).contacts
        off.append([abs(contact.impulse / exact["impulse"] - 1.0), abs(contact.peak_force / exact["peak_force"] - 1.0)])
    assert off[1][0] < off[0][0] / 16.0
    assert off[1][1] < off[0][1] / 8.0


def test_stiff_slabs_are_the_storeys_masses_to_first_order() -> None:
    left, right = ShearFrame(MASSES[:1], (1e7,), velocity=(SPEED,)), ShearFrame(MASSES[1:], (1e7,))
    gaps, law = {"floor": Gap(1, 1)}, [spring(1e8)]

    def peak(stiffer: float | None) -> float:
        frames = PoundingFrames(left, right, gaps, slabs(4, stiffer) if stiffer else {})
        return simulate(frames, law, end_time=0.05).peak_force

    rigid = peak(None)
    soft, stiff = (1.0 - peak(stiffer) / rigid for stiffer in (4.0, 16.0))
    assert 0.0 < stiff < 3e-3
    assert soft / stiff == pytest.approx(4.0, rel=0.05)


def test_the_energy_of_shaken_damped_slabs_is_accounted_for() -> None:
    left = ShearFrame(MASSES, (1e7, 8e6), damping_ratio=0.03, velocity=(0.3, 0.5))
    frames = PoundingFrames(
        left,
        ShearFrame(MASSES[1:], (4e6,), rayleigh=(0.3, 1e-3)),
        {"floor": Gap(1, 1, 0.003)},
        {name: Slab(name, 1, 20.0, 3e10, DENSITY, 0.02) for name in ("left", "right")},
    )
    result = simulate(frames, [spring(1e9)], Sine(3.0, 2.0), 0.4)
    assert result.contacts
    assert result.energy.open_share < 1e-12
    assert result.motion.displacement.shape[1] == len(result.peaks) == 3
