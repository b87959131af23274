"""Frames that pound: against an independent integration, against one impact, against the linear answer; energies."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

from lumped import Scene, laws
from lumped import simulate as simulate_impact
from lumped.errors import BadInput, NotReached
from lumped.laws._force_law import ForceLaw, between_masses
from lumped.pounding import STILL, Gap, GroundRecord, PoundingFrames, ShearFrame, Sine, march, simulate
from lumped.pounding.case_file import load
from lumped.pounding.gap_laws import force_of
from lumped.pounding.ground import GroundMotion
from lumped.scene.tables import LawChoice

Array = np.ndarray[Any, np.dtype[np.float64]]
FINE = 1e-12  # step tolerance where the other side is as good
# Every law between two masses, with numbers of its own; with k and e for storeys of some tons.
LAWS: dict[str, dict[str, Any]] = {
    "linear_spring": {"k": 1e8},
    "kelvin": {"k": 1e8, "e": 0.6},
    "hertz": {"k": 2e9},
    "jankowski": {"k": 2e9, "e": 0.6},
    "hunt_crossley": {"k": 2e9, "e": 0.6},
    "hertzdamp": {"k": 2e9, "e": 0.6},
    "khatiwada": {"k": 2e9, "e": 0.6},
    "kuwabara_kono": {"k": 2e9, "e": 0.6},
    "mahmoud": {"k": 1e8, "e": 0.6},
    "tsuji": {"k": 2e9, "e": 0.6},
    "impact_bilinear": {"k": 2e9, "e": 0.6},
}


def law_of(name: str, left: float, right: float | None, velocity: float = 0.3, **values: Any) -> ForceLaw:
    scene = Scene(None, mass=left, velocity=velocity, target_mass=right, law=LawChoice(name, values))
    return between_masses(name, scene)


def laws_of(frames: PoundingFrames, name: str, **values: Any) -> list[ForceLaw]:
    return [law_of(name, *frames.masses_at(gap), **(LAWS[name] | values)) for gap in frames.gaps.values()]


# an independent integration: DOP853 from event to event, the laws by their own formulas


@dataclass
class Formula:
    """A law written anew: force of depth and rate, whether it approaches, and the speed at touch.

    `pushes`: of the rate and the speed at touch, what is above zero where it pushes, beside the depth.
    """

    force: Callable[[float, float, bool, float], float]
    by_force: bool = False
    pushes: Callable[[float, float], float] = lambda rate, speed: np.inf


FORMULAS = {
    "linear_spring": lambda law: Formula(lambda d, r, inward, v: law.k * d),
    "hertz": lambda law: Formula(lambda d, r, inward, v: law.k * d**1.5),
    "kelvin": lambda law: Formula(lambda d, r, inward, v: law.k * d + law.c * r, law.exit == "force"),
    "jankowski": lambda law: Formula(lambda d, r, inward, v: law.k * d**1.5 + (law.c * d**0.25 * r if inward else 0.0)),
    "hertzdamp": lambda law: Formula(
        lambda d, r, inward, v: law.k * d**1.5 * (1.0 + law.xi * r / v), pushes=lambda r, v: 1.0 + law.xi * r / v
    ),
}


@dataclass
class Independent:
    """Contacts of frames, found by an adaptive method of high order that knows nothing of ours."""

    frames: PoundingFrames
    laws: Sequence[ForceLaw]
    ground: GroundMotion

    def contacts(self, end_time: float) -> list[tuple[int, float, float, float]]:
        """Gap, start, end and peak force of every contact that ends."""
        frames, n = self.frames, self.frames.mass.size
        mass, stiffness, damping, rows = frames.mass, frames.stiffness, frames.damping, frames.rows
        formulas = [FORMULAS[law.name](law) for law in self.laws]
        # apart, in, out, leaving: what every gap does; its speed at touch; its open contact
        modes, speeds = ["apart"] * len(formulas), [0.0] * len(formulas)
        opened, found = {}, []

        def force(i: int, y: Array) -> float:
            depth = rows[i] @ y[:n] - frames.distances[i]
            if modes[i] not in ("in", "out") or depth < 0.0:
                return 0.0
            return formulas[i].force(depth, rows[i] @ y[n:], modes[i] == "in", speeds[i])

        def rates(t: float, y: Array) -> Array:
            push = sum(force(i, y) * rows[i] for i in range(len(formulas)))
            shaken = float(self.ground.acceleration(np.array([t]))[0])
            return np.concatenate([y[n:], -(stiffness @ y[:n] + damping @ y[n:] + push) / mass - shaken])

        def event(i: int) -> Callable[[float, Array], float]:
            depth = lambda y: rows[i] @ y[:n] - frames.distances[i]  # noqa: E731 - read in place
            if modes[i] == "apart":
                return lambda t, y: -depth(y)
            if modes[i] == "in":
                return lambda t, y: rows[i] @ y[n:]
            if modes[i] == "out" and formulas[i].by_force:
                return lambda t, y: formulas[i].force(depth(y), rows[i] @ y[n:], False, speeds[i])
            if modes[i] == "out":
                return lambda t, y: min(depth(y), formulas[i].pushes(rows[i] @ y[n:], speeds[i]))
            return lambda t, y: depth(y)

        time, y = 0.0, frames.start
        kinks = [*self.ground.kinks[(self.ground.kinks > 0.0) & (self.ground.kinks < end_time)], end_time]
        while time < end_time:
            until = next(kink for kink in kinks if kink > time)
            events = [event(i) for i in range(len(formulas))]
            for one in events:
                one.terminal, one.direction = True, -1  # type: ignore[attr-defined]
            pressed = any(mode in ("in", "out") for mode in modes)
            step = 2e-4 if pressed else 5e-3
            run = solve_ivp(
                rates, (time, until), y, "DOP853", events=events, rtol=1e-12, atol=1e-14, max_step=step,
                dense_output=pressed,
            )  # fmt: skip
            for i, one in opened.items():
                between = np.interp(np.linspace(0.0, run.t.size - 1, 8 * run.t.size), np.arange(run.t.size), run.t)
                values = [force(i, state) for state in run.sol(between).T]
                one["peak"] = max(one["peak"], *values)
            time, y = float(run.t[-1]), run.y[:, -1]
            for i, times in enumerate(run.t_events):
                if not times.size:
                    continue
                rate = float(rows[i] @ y[n:])
                if modes[i] == "apart":
                    modes[i], speeds[i] = "in", rate
                    opened[i] = {"start": time, "peak": force(i, y)}
                elif modes[i] == "in":
                    modes[i] = "out"
                    opened[i]["peak"] = max(opened[i]["peak"], force(i, y))
                else:
                    if modes[i] == "out":
                        one = opened.pop(i)
                        found.append((i, one["start"], time, one["peak"]))
                    left = modes[i] == "out" and rows[i] @ y[:n] - frames.distances[i] > 1e-12
                    modes[i] = "leaving" if left else "apart"
        return found


def shaking(seed: int = 3, end_time: float = 6.0) -> GroundRecord:
    times = np.arange(0.0, end_time, 0.02)
    rng = np.random.default_rng(seed)
    tones = [(1.1, 2.5, 0.3), (2.3, 1.5, 1.0), (4.1, 1.0, 2.0)]
    value = sum(a * np.sin(2 * np.pi * f * times + p) for f, a, p in tones)
    return GroundRecord(times, (value + 0.3 * rng.standard_normal(times.size)) * np.minimum(1.0, times))


TWO = PoundingFrames(
    ShearFrame((3e4, 2.5e4), (3e7, 2e7), damping_ratio=0.04),
    ShearFrame((3e4, 3e4), (8e6, 6e6), rayleigh=(0.3, 1e-3)),
    {"second": Gap(2, 2, 0.012), "first": Gap(1, 1, 0.012)},
)
THREE = PoundingFrames(
    ShearFrame((3e4, 3e4, 2e4), (3e7, 2.5e7, 2e7), dashpot=(2e5, 1.5e5, 1e5)),
    ShearFrame((4e4, 3e4, 3e4), (9e6, 8e6, 6e6), damping_ratio=0.05),
    {"third": Gap(3, 3, 0.015), "second": Gap(2, 2, 0.012), "floor to roof": Gap(1, 2, 0.02)},
)
WALL = PoundingFrames(
    ShearFrame((2e4, 2e4, 1e4), (1e7, 1e7, 8e6), damping_ratio=0.02), None, {"wall": Gap(2, None, 0.01)}
)
CASES = [
    (TWO, "kelvin", {}),
    pytest.param(TWO, "hertz", {}, marks=pytest.mark.full),
    (THREE, "jankowski", {}),
    (THREE, "kelvin", {"exit": "depth"}),
    (WALL, "hertzdamp", {}),
    pytest.param(WALL, "linear_spring", {}, marks=pytest.mark.full),
]


@pytest.mark.family
@pytest.mark.parametrize(("frames", "name", "values"), CASES)
def test_ten_contacts_are_those_of_an_independent_integration(
    frames: PoundingFrames, name: str, values: dict[str, Any]
) -> None:
    ground, models = shaking(), laws_of(frames, name, **values)
    ours = [contact for contact in simulate(frames, models, ground, 6.0).contacts if contact.end is not None][:10]
    assert len(ours) == 10
    until = max(contact.end or 0.0 for contact in ours) + 0.05
    theirs = sorted(Independent(frames, models, ground).contacts(until), key=lambda one: one[1])[:10]
    gaps = list(frames.gaps)
    assert [contact.gap for contact in ours] == [gaps[one[0]] for one in theirs]
    for contact, (_, start, end, peak) in zip(ours, theirs, strict=True):
        assert contact.start == pytest.approx(start, abs=1e-6)
        assert contact.end == pytest.approx(end, abs=1e-6)
        assert contact.peak_force == pytest.approx(peak, rel=1e-4)


# published: a mass and a stop, of code_aster's verification manual


def test_the_published_release_is_half_a_wave_against_the_stop_and_half_a_wave_on_the_spring() -> None:
    """SDND101, in closed form: the mass leaves as fast as it came, again and again."""
    case = load("published-release")
    (mass,), (column,), (law,) = case.frames.left.mass, case.frames.left.stiffness, case.laws()
    pressed, free = np.sqrt((column + law.k) / mass), np.sqrt(column / mass)  # type: ignore[attr-defined] # a spring
    contacts = simulate(case.frames, [law], case.ground, case.end_time).contacts
    assert len(contacts) == 1 + int(case.end_time / (np.pi / pressed + np.pi / free))
    for turn, contact in enumerate(contacts):
        start = turn * (np.pi / pressed + np.pi / free)
        assert contact.start == pytest.approx(start, abs=1e-12)
        assert contact.end == pytest.approx(start + np.pi / pressed, abs=1e-12)
        assert contact.peak_force == pytest.approx(law.k / pressed, rel=1e-12)  # type: ignore[attr-defined]


def test_the_published_stop_is_struck_as_an_independent_integration_says() -> None:
    """SDND121: contacts of 0.4 ms, between which the sine drives the mass for much longer."""
    case = load("published-stop")
    ours = simulate(case.frames, case.laws(), case.ground, 0.5).contacts
    theirs = Independent(case.frames, case.laws(), case.ground).contacts(0.5)
    assert len(ours) == len(theirs) > 7
    for contact, (_, start, end, peak) in zip(ours, theirs, strict=True):
        assert contact.start == pytest.approx(start, abs=1e-8)
        assert contact.end == pytest.approx(end, abs=1e-8)
        assert contact.peak_force == pytest.approx(peak, rel=1e-4)


@pytest.mark.parametrize("exit", ["force", "depth"])
def test_frames_pull_each_other_only_where_their_law_ends_with_the_depth(exit: str) -> None:
    """Columns draw heavily damped storeys apart faster than their law rebounds."""
    keys = {"law.name": "hertzdamp", "law.k": 2.7e9, "law.e": 0.1, "law.exit": exit, "motion.end_time": 6.0}
    case = load("two-frames", keys)
    force = simulate(case.frames, case.laws(), case.ground, case.end_time).motion.force
    pull = -float(force.min()) / float(force.max())
    assert pull > 1e-3 if exit == "depth" else pull < 1e-8


# limits


@pytest.mark.family
@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("right", [2e4, None])
def test_one_storey_on_no_columns_is_the_impact_of_its_law(name: str, right: float | None) -> None:
    law = law_of(name, 1e4, right, 0.3, **LAWS[name])
    scene = Scene(None, mass=1e4, velocity=0.3, target_mass=right, law=LawChoice(name, LAWS[name]))
    impact = simulate_impact(law, scene, 1e-9).quantities
    other = None if right is None else ShearFrame((right,), (0.0,))
    frames = PoundingFrames(ShearFrame((1e4,), (0.0,), velocity=(0.3,)), other, {"gap": Gap(1, other and 1)})
    result = simulate(frames, [law], STILL, 1.0, FINE)
    (contact,) = result.contacts
    assert contact.start == 0.0
    for ours, theirs in (
        (contact.end, "duration"), (contact.peak_force, "peak_force"), (contact.impulse, "impulse"),
        (contact.restitution, "restitution"),
    ):  # fmt: skip
        assert ours == pytest.approx(impact[theirs].value, rel=1e-9)
    assert result.energy.open_share < 1e-12


@pytest.mark.family
@pytest.mark.parametrize(
    ("name", "values"), [("ball-bouncing", {}), ("pounding-wall-kelvin", {"motion.impacts": 2, "law.exit": "force"})]
)
def test_gravity_brings_a_storey_back_to_the_dent_that_it_left(name: str, values: dict[str, Any]) -> None:
    """A ground that falls away as fast is a weight: impacts in a row of laws that leave a dent, by another march."""
    scene = Scene.load(name, values)
    law = force_of(scene.law.name if scene.law else "correspondence", scene)
    contacts = law.simulate(scene, 1e-6).contacts
    end_time = float(contacts[-1]["start"] or 0.0) + 1.5 * float(contacts[0]["duration"] or 0.0)
    falling = GroundRecord(np.array([0.0, 2.0 * end_time]), np.full(2, -scene.gravity))
    frames = PoundingFrames(ShearFrame((scene.mass,), (0.0,), velocity=(scene.velocity,)), None, {"dent": Gap(1)})
    found = simulate(frames, [law], falling, end_time).contacts
    assert len(found) == len(contacts) > 1
    for ours, theirs in zip(found, contacts, strict=True):
        assert ours.start == pytest.approx(theirs["start"], rel=1e-7)
        assert ours.peak_force == pytest.approx(theirs["peak_force"], rel=1e-7)
        assert ours.restitution == pytest.approx(theirs["restitution"], rel=1e-7)


@pytest.mark.parametrize("ground", [shaking(), Sine(3.0, 1.7), Sine(4.0, 1.25, 0.5)])
def test_a_gap_that_never_closes_leaves_the_modal_answer(ground: GroundMotion) -> None:
    """Every mode by itself, its ground motion integrated to rounding."""
    frame = THREE.left
    far = PoundingFrames(
        ShearFrame(frame.mass, frame.stiffness, damping_ratio=0.04), None, {"wall": Gap(3, None, 10.0)}
    )
    result = simulate(far, laws_of(far, "hertz"), ground, 4.0)
    assert result.contacts == ()
    root = np.sqrt(np.array(frame.mass))
    squares, shapes = np.linalg.eigh(far.stiffness / np.outer(root, root))
    modes, n = shapes / root[:, None], root.size
    place, speed, at = np.zeros(n), np.zeros(n), 0.0
    times = result.motion.time
    expected = [np.zeros(n)]
    for until in times[1:]:
        low, high = ground.acceleration(np.array([at, until * (1.0 - 1e-15)]))
        for mode in range(n):
            w = np.sqrt(squares[mode])
            part = modes[:, mode] @ np.array(frame.mass)
            if isinstance(ground, GroundRecord):
                carried = [low, (high - low) / (until - at)]
                shake = np.array([[0.0, 1.0], [0.0, 0.0]])
            else:
                on = at < ground._end
                w0 = ground.fastest
                carried = [on * ground.amplitude * np.sin(w0 * at), on * ground.amplitude * w0 * np.cos(w0 * at)]
                shake = np.array([[0.0, 1.0], [-(w0**2), 0.0]])
            matrix = np.zeros((4, 4))
            matrix[:2, :2] = [[0.0, 1.0], [-w * w, -2 * 0.04 * w]]
            matrix[1, 2], matrix[2:, 2:] = -part, shake
            place[mode], speed[mode] = (expm(matrix * (until - at)) @ [place[mode], speed[mode], *carried])[:2]
        expected.append(modes @ place)
        at = float(until)
    assert result.motion.displacement == pytest.approx(np.array(expected), rel=1e-9, abs=1e-12)


def top_of(frame: ShearFrame, end_time: float) -> float:
    """The highest place of the second storey in free vibration, m: by matrix exponentials and a search."""
    mass, n = np.array(frame.mass), frame.size
    still = np.hstack([np.zeros((n, n)), np.eye(n)])
    matrix = np.vstack([still, -np.hstack([frame.stiffness_matrix, frame.damping_matrix]) / mass[:, None]])
    start = np.concatenate([np.zeros(n), frame.velocity or ()])

    def low(time: float) -> float:
        return -float((expm(matrix * time) @ start)[1])

    times = np.linspace(0.0, end_time, 400)
    best = times[int(np.argmin([low(time) for time in times]))]
    found = minimize_scalar(low, bounds=(best - times[1], best + times[1]), method="bounded", options={"xatol": 1e-12})
    return -float(found.fun)


@pytest.mark.parametrize("apart", [1e-6, 1e-9, 1e-12])
def test_a_grazing_contact_is_found_and_a_near_miss_is_none(apart: float) -> None:
    frame = ShearFrame((2e4, 1e4), (1e7, 8e6), damping_ratio=0.02, velocity=(0.2, 0.5))
    top = top_of(frame, 0.3)
    for sign, count in ((-1, 1), (1, 0)):
        close = PoundingFrames(frame, None, {"wall": Gap(2, None, top * (1.0 + sign * apart))})
        found = simulate(close, laws_of(close, "linear_spring"), STILL, 0.3).contacts
        assert len(found) == count


@pytest.mark.family
@pytest.mark.parametrize("memory", ["recovering", "reset", "continuous"])
def test_no_contact_begins_before_the_storeys_meet(memory: str) -> None:
    """Struck again while the dent creeps back; and where all but rounding of it has crept back on the way."""
    scene = Scene.load("polymer-sphere", {"law": {"name": "correspondence", "memory": memory}})
    law = force_of("correspondence", scene)
    for columns, end, deeper in ((200.0, 0.6, memory != "reset"), (5.5, 2.0, False)):
        frame = ShearFrame((0.05,), (columns,), damping_ratio=0.01, velocity=(0.02,))
        result = simulate(PoundingFrames(frame, None, {"wall": Gap(1, None, 5e-5)}), [law], STILL, end)
        place = dict(zip(result.motion.time.tolist(), result.motion.displacement[:, 0].tolist(), strict=True))
        met = np.array([place[contact.start] for contact in result.contacts]) - 5e-5
        assert met.size > 3
        assert met.min() > -1e-15
        assert (met.max() > 1e-9) == deeper
        assert result.energy.open_share < 1e-12


def test_equal_frames_that_touch_never_pound() -> None:
    frame = THREE.left
    frames = PoundingFrames(frame, frame, {f"gap {i}": Gap(i, i, 0.0) for i in (1, 2, 3)})
    assert simulate(frames, laws_of(frames, "hertz"), shaking(), 3.0).contacts == ()


def test_frames_that_touch_at_rest_press_as_soon_as_they_part_ways() -> None:
    frames = PoundingFrames(TWO.left, TWO.right, {"second": Gap(2, 2, 0.0)})
    result = simulate(frames, laws_of(frames, "kelvin"), shaking(), 2.0)
    assert result.contacts[0].closing < 1e-3
    assert len(result.contacts) > 3
    assert result.energy.open_share < 1e-8


# balances


def random_case(rng: np.random.Generator) -> tuple[PoundingFrames, str, GroundMotion]:
    """One or two frames of up to four storeys, gaps at some of them, any law, any ground."""

    def frame() -> ShearFrame:
        n = int(rng.integers(1, 5))
        mass = tuple(rng.uniform(1e4, 5e4, n))
        stiffness = tuple(rng.uniform(4e6, 4e7, n))
        kind = int(rng.integers(4))
        damping: list[dict[str, Any]] = [
            {}, {"damping_ratio": float(rng.uniform(0.0, 0.2))}, {"rayleigh": (0.3, 1e-3)},
            {"dashpot": tuple(rng.uniform(0.0, 5e5, n))},
        ]  # fmt: skip
        return ShearFrame(mass, stiffness, **damping[kind], velocity=tuple(rng.uniform(-0.3, 0.3, n)))

    left, right = frame(), frame() if rng.random() < 0.8 else None
    count = min(left.size, right.size) if right else left.size
    gaps = {
        f"gap {i}": Gap(
            i, None if right is None else int(rng.integers(1, right.size + 1)), float(rng.uniform(0.0, 0.02))
        )
        for i in range(1, count + 1)
    }
    grounds = [STILL, shaking(int(rng.integers(1000)), 2.0), Sine(3.0, float(rng.uniform(0.5, 4.0)))]
    return PoundingFrames(left, right, gaps), str(rng.choice(list(LAWS))), grounds[int(rng.integers(3))]


@pytest.mark.parametrize("phase", np.linspace(0.4, 3.1, 60))
def test_a_peak_just_after_the_end_of_a_step_is_found(phase: float) -> None:
    """Of free vibration, in closed form: where in a row its peaks lie does not matter."""
    omega = 7.0
    start = {"displacement": (-math.cos(phase),), "velocity": (omega * math.sin(phase),)}
    frames = PoundingFrames(ShearFrame((2.0,), (2.0 * omega**2,), **start))
    (peaks,) = simulate(frames, end_time=0.9 * math.pi / omega).peaks
    assert peaks.displacement == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize("ratio", [1e-6, 1e-5, 1e-4, 1e-3])
def test_the_highest_of_many_peaks_nearly_as_high_is_the_peak(ratio: float) -> None:
    """Of a vibration that hardly dies away the first one, in closed form, wherever the points of the rows lie."""
    omega = 7.0
    frames = PoundingFrames(ShearFrame((2.0,), (2.0 * omega**2,), damping_ratio=ratio, velocity=(omega,)))
    (peaks,) = simulate(frames, end_time=20.0).peaks
    first = math.exp(-ratio * math.acos(ratio) / math.sqrt(1.0 - ratio**2))
    assert peaks.displacement == pytest.approx(first, rel=1e-9)


@pytest.mark.parametrize("seed", [3, 11, 17])
def test_two_gaps_of_the_same_storeys_turn_at_once(seed: int) -> None:
    """A storey and a wall that meet at two places: both contacts turn where an independent integration does."""
    rng, k, chi = np.random.default_rng(seed), 1e3, 0.3
    speed, ahead = float(rng.uniform(0.5, 2.0)), float(rng.uniform(0.001, 0.05))
    frames = PoundingFrames(
        ShearFrame((1.0,), (1.0,), velocity=(speed,)), None, {"a": Gap(1, None, 0.1), "b": Gap(1, None, 0.1 + ahead)}
    )
    law = law_of("hunt_crossley", 1.0, None, k=k, alpha=1.5, chi=chi)
    found = simulate(frames, [law, law], end_time=20.0, tolerance=1e-8).motion

    def moving(_: float, state: Array) -> list[float]:
        depths = np.maximum(state[0] - np.array([0.1, 0.1 + ahead]), 0.0)
        return [state[1], -state[0] - float((k * depths**1.5).sum()) * (1.0 + chi * state[1])]

    def turning(_: float, state: Array) -> float:
        return float(state[1])

    turning.terminal = True  # type: ignore[attr-defined]
    solved = solve_ivp(moving, (0.0, 0.55), (0.0, speed), events=turning, rtol=1e-10, atol=1e-12, max_step=1e-2)
    first = found.displacement[found.time < 0.55].max()
    assert first == pytest.approx(solved.y[0, -1], rel=1e-8)


@pytest.mark.tenth
def test_energy_balances_in_random_frames(campaign_size: Callable[..., int]) -> None:
    rng, touched = np.random.default_rng(16), 0
    for _ in range(campaign_size(600, least=6, most=10)):
        frames, name, ground = random_case(rng)
        result = simulate(frames, laws_of(frames, name), ground, 2.0)
        touched += bool(result.contacts)
        assert result.energy.open_share < 1e-8, name
        assert result.energy.contact >= -1e-9 * (result.energy.initial + abs(result.energy.input)), name
        for contact in result.contacts:
            assert contact.impulse > 0.0
            if contact.end is not None:
                assert contact.impulse < contact.peak_force * (contact.end - contact.start) * (1.0 + 1e-9)
    assert touched > 2


def test_every_contact_takes_its_impulse_from_one_floating_frame_and_gives_it_to_the_other(
    campaign_size: Callable[..., int],
) -> None:
    """Without columns to the ground a frame changes its momentum in contacts alone."""
    rng = np.random.default_rng(17)
    for _ in range(campaign_size(300, least=4)):
        sizes = rng.integers(2, 5, 2).tolist()
        left, right = (
            ShearFrame(
                tuple(rng.uniform(1e4, 5e4, n)), (0.0, *rng.uniform(4e6, 4e7, n - 1)),
                dashpot=(0.0, *rng.uniform(0.0, 2e5, n - 1)), velocity=(speed,) * n,
            )
            for n, speed in zip(sizes, (0.4, -0.3), strict=True)
        )  # fmt: skip
        frames = PoundingFrames(left, right, {"gap": Gap(sizes[0], sizes[1], 0.01)})
        result = simulate(frames, laws_of(frames, str(rng.choice(list(LAWS)))), STILL, 1.0)
        momentum = [
            result.motion.velocity[:, side] @ frames.mass[side]
            for side in (slice(sizes[0]), slice(sizes[0], None))
        ]  # fmt: skip
        assert result.contacts
        for contact in result.contacts:
            ends = np.searchsorted(result.motion.time, [contact.start, contact.end or 1.0])
            lost, won = (float(np.diff(one[ends])[0]) for one in momentum)
            assert -lost == pytest.approx(contact.impulse, rel=1e-9)
            assert won == pytest.approx(contact.impulse, rel=1e-9)


@given(st.floats(0.05, 2.0), st.floats(1e3, 1e6), st.floats(1e3, 1e6), st.sampled_from(sorted(LAWS)))
def test_a_contact_passes_on_the_momentum_that_both_masses_change_by(
    speed: float, left: float, right: float, name: str
) -> None:
    frames = PoundingFrames(
        ShearFrame((left,), (0.0,), velocity=(speed,)), ShearFrame((right,), (0.0,)), {"gap": Gap(1, 1, 0.01)}
    )
    result = simulate(frames, laws_of(frames, name), STILL, 0.01 / speed + 3.0)
    (contact,) = result.contacts
    assert contact.start == pytest.approx(0.01 / speed, rel=1e-10)
    one, other = (result.motion.displacement[-1] - result.motion.displacement[-2]) / np.diff(result.motion.time[-2:])
    assert left * (speed - one) == pytest.approx(contact.impulse, rel=1e-6)
    assert right * other == pytest.approx(contact.impulse, rel=1e-6)
    assert other - one == pytest.approx((contact.restitution or 0.0) * speed, rel=1e-6)


# work


@pytest.mark.tenth
def test_the_work_of_contacts_grows_with_contacts_and_not_with_time() -> None:
    short, long = (simulate(WALL, laws_of(WALL, "hertz"), Sine(2.0, 1.5, 3.0), until) for until in (3.0, 8.0))
    ended = [contact for contact in long.contacts if contact.start < 3.0]
    assert len(ended) == len(short.contacts)
    assert long.pressed_steps - short.pressed_steps <= 60 * (len(long.contacts) - len(short.contacts))
    assert short.pressed_steps <= 60 * len(short.contacts)


@pytest.mark.tenth
def test_finer_steps_take_little_more_and_change_little() -> None:
    coarse, fine = (simulate(TWO, laws_of(TWO, "hertz"), shaking(), 2.5, tolerance) for tolerance in (1e-6, 1e-12))
    assert coarse.pressed_steps < fine.pressed_steps < 10 * coarse.pressed_steps
    for one, other in zip(coarse.contacts[:10], fine.contacts[:10], strict=True):
        assert one.start == pytest.approx(other.start, abs=1e-8)
        assert one.peak_force == pytest.approx(other.peak_force, rel=1e-5)


# refusals


def test_what_cannot_be_followed_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(BadInput, match="end_time"):
        simulate(WALL, laws_of(WALL, "hertz"), STILL, 1e7)
    with pytest.raises(BadInput, match="one for each of 1 gaps"):
        simulate(WALL, (), STILL, 1.0)
    monkeypatch.setattr(march, "MOST_STEPS", 3)
    with pytest.raises(NotReached, match="end_time"):
        simulate(WALL, laws_of(WALL, "hertz"), Sine(5.0, 1.5), 4.0)


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: ShearFrame((1.0, 1.0), (1.0,)), "stiffness"),
        (lambda: ShearFrame((1.0,), (1.0,), damping_ratio=0.1, rayleigh=(0.1, 0.1)), "rayleigh"),
        (lambda: ShearFrame((1.0,), (1.0,), dashpot=(1.0, 1.0)), "dashpot"),
        (lambda: ShearFrame((0.0,), (1.0,)), "mass"),
        (lambda: PoundingFrames(WALL.left, None, {"a": Gap(4, None, 0.1)}), "gap.a.left"),
        (lambda: PoundingFrames(WALL.left, None, {"a": Gap(1, 1, 0.1)}), "gap.a.right"),
        (lambda: PoundingFrames(WALL.left, TWO.right, {"a": Gap(1, None, 0.1)}), "gap.a.right"),
        (
            lambda: PoundingFrames(ShearFrame((1.0,), (1.0,), displacement=(0.2,)), None, {"a": Gap(1)}),
            "gap.a.distance",
        ),
    ],
)
def test_faulty_structures_are_named(make: Callable[[], object], named: str) -> None:
    with pytest.raises(BadInput, match=named):
        make()


def test_laws_that_are_no_force_between_two_masses_are_refused_by_name() -> None:
    """All others are tested here, and the paper's own with its memory."""
    others = set(laws.available()) - set(LAWS) - {"correspondence"}
    assert others == {"ting", "mdr", "rod_waves", "bar_waves"}
    for name in others - {"rod_waves", "bar_waves"}:  # which refuse the scene itself
        with pytest.raises(BadInput, match=f"{name} is no force between two masses"):
            force_of(name, Scene.load("polymer-sphere"))
