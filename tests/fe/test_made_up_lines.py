"""Marches of waves along a line that are made up: the truth is known, and how their steps err, also by chance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fe_contact.assembly.forms import Array
from fe_contact.budget.variation import SAFETY
from fe_contact.dynamics.march import Motion, Sample
from fe_contact.waves.line import AWAY, UNSHOWN, Line, Run, _ended_later
from fe_contact.waves.line_reading import (
    CLEAR,
    DEPTH,
    FORCE,
    RINGING,
    TIME,
    VELOCITY,
    Ending,
    RodReading,
    _bar_ended,
    _cleaned,
    _contact,
    _rod_ended,
    _undented,
    read_bar,
    read_rod,
    stopped,
    with_fronts,
)
from fe_contact.waves.targets._block import plan
from lumped import Scene
from lumped.result.score import distance

END = 1e-6  # s: no step, no front and no rounding may count in seconds
MASS, SPEED, PUSH = 2.0, 3.0, 5.0
GAP = 0.25  # of END, between two contacts


def reading(rows: Array) -> RodReading:
    """What these rows say; the force is all that moves the mass."""
    time, force = rows[TIME], rows[FORCE]
    impulse = float(np.trapezoid(force, time))
    quantities = {
        "peak_force": float(force.max()),
        "peak_time": float(time[force.argmax()]),
        "peak_depth": float(rows[1].max()),
        "duration": float(time[-1]),
        "restitution": float(-rows[2, -1] / SPEED),
        "impulse": impulse,
        "history_l2": 0.0,
    }
    return RodReading(rows, MASS, True, quantities)


def pushed(time: Array, force: Array) -> Run:
    """A march that ends with its one contact."""
    passed = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (force[1:] + force[:-1]))])
    speed = SPEED - passed / MASS
    depth = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (speed[1:] + speed[:-1]))])
    rows = np.array([time, depth, speed, force, np.zeros_like(time)])
    return Run(reading(rows), {}, time.size - 1, time.size, ({"start": 0.0, "duration": END},))


def swelling(error: Callable[[Array], Array] = np.zeros_like) -> Run:
    """A smooth push, wrong by so much at shares of its time."""
    share = np.linspace(0.0, 1.0, 401)
    return pushed(END * share, PUSH * (np.sin(np.pi * share) + error(share)))


def falling(late: float) -> Run:
    """A push that stops between two rows of one time, a share of the end too ``late``, and goes on by half."""
    share = np.array([0.0, 0.2, 0.5 + late, 0.5 + late, 0.8, 1.0])
    return pushed(END * share, PUSH * np.array([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]))


def line(fine: Run, half: Run, quarter: Run, **others: Run) -> Line:
    """Judged as those of a scene whose contact radius is fixed."""
    scene = Scene.load("bar-impact")
    return Line(scene, plan(scene, {}).numerics, fine, {"time_step": half, **others}, quarter)


def test_the_band_holds_an_error_that_halves_with_the_steps() -> None:
    """Wherever it is, and no wider than its safety asks for."""
    for place in (0.02, 0.3, 0.7, 0.98):

        def error(size: float, place: float = place) -> Run:
            return swelling(lambda share: size * np.exp(-(((share - place) / 0.01) ** 2)))

        history = line(error(0.01), error(0.02), error(0.04)).history()
        exact = np.interp(history.time, swelling().reading.rows[TIME], swelling().reading.rows[FORCE])
        assert np.all(np.abs(history.force - exact) <= history.force_error * (1.0 + 1e-9))
        assert history.force_error.max() <= 1.001 * SAFETY * 0.01 * PUSH
        far = np.abs(history.time / END - place) > 0.05 + AWAY
        assert history.force_error[far].max() <= 1e-6 * PUSH


@pytest.mark.parametrize("late", [1e-6, 1e-4])
def test_the_band_holds_a_jump_however_little_it_is_displaced(late: float) -> None:
    history = line(falling(late), falling(2.0 * late), falling(4.0 * late)).history()
    near = np.abs(history.time / END - 0.5) < 0.5 * AWAY
    assert near.any()
    assert history.force_error[near].min() >= 0.5 * PUSH
    assert history.force_error[~near & (np.abs(history.time / END - 0.5) > 2.0 * AWAY)].max(initial=0.0) <= 1e-9 * PUSH


def test_the_band_at_the_end_holds_what_goes_on_in_the_other_march() -> None:
    fine = falling(0.0)
    longer = pushed(END * np.array([0.0, 0.5, 0.5, 1.0, 1.1]), PUSH * np.array([1.0, 1.0, 0.5, 0.5, 2.0]))
    assert line(fine, longer, longer).history().force_error[-1] >= 1.5 * PUSH


def test_steps_that_agree_by_chance_make_no_bar_too_small() -> None:
    """Half the steps change nothing, a quarter does: half of that is the bar. Another cause is not to blame for it."""
    fine, wrong = falling(0.0), falling(0.1)
    late = Run(replace(wrong.reading, quantities={**wrong.reading.quantities, "duration": 1.2 * END}), {}, 5, 5)
    found = line(fine, fine, late, mesh=fine)
    assert 0.1 * END <= found.error("duration", "time_step") <= SAFETY * 0.1 * END * (1.0 + 1e-6)
    assert found.error("duration", "mesh") <= 1e-6 * END


def test_what_a_quarter_of_the_steps_changes_counts_beside_what_half_of_them_do_nearby() -> None:
    """Peaks of half the steps agree by chance, and nearly so about them: a quarter of them tells of the error."""
    found = line(swelling(), swelling(lambda share: 1e-4 * (share - 0.5)), swelling(lambda share: 0.1 + 0.0 * share))
    assert found.error("peak_force", "time_step") >= 0.05 * PUSH
    assert found.error("restitution", "time_step") >= 0.05 * PUSH * END / (MASS * SPEED)


def test_another_method_that_agrees_at_one_instant_makes_no_bar_too_small() -> None:
    """Two histories cross at the top: about it they do not."""
    crossing = swelling(lambda share: 0.05 * (share - 0.5))
    found = line(swelling(), swelling(), swelling(), mesh=crossing)
    assert abs((crossing.reading.quantities["peak_force"] or 0.0) - PUSH) < 1e-3 * PUSH
    assert found.error("peak_force", "mesh") >= 3e-3 * PUSH


def bouncing(gap: float) -> Run:
    """Two contacts; between them a surface ``gap`` m away at most."""
    share = np.linspace(0.0, 2.0 + GAP, 901)
    flown = np.clip((share - 1.0) / GAP, 0.0, 1.0)
    inside = np.where(share <= 1.0, share, np.maximum(share - 1.0 - GAP, 0.0))
    force = PUSH * np.sin(np.pi * inside)
    speed = np.interp(share, [0.0, 1.0, 1.0 + GAP, 2.0 + GAP], [SPEED, -SPEED, SPEED, -SPEED])
    rows = np.array([END * share, np.zeros_like(share), speed, force, -4.0 * gap * flown * (1.0 - flown)])
    contacts = tuple({"start": start * END, "duration": END} for start in (0.0, 1.0 + GAP))
    return Run(reading(rows), {}, share.size - 1, share.size, contacts)


def test_a_contact_may_go_on_while_the_gap_is_smaller_than_its_error() -> None:
    """The gap 4 h x (1 - x) of one march is half of the other's where the other's change is as large: all the way."""
    found = line(bouncing(1e-3), bouncing(1.5e-3), bouncing(2e-3), mesh=bouncing(2.5e-3))
    assert found.error("duration", "time_step") <= 1e-6 * END
    assert found.error("duration", "mesh") >= 0.5 * GAP * END
    assert found.quantities["duration"].error == pytest.approx(
        found.error("duration", "mesh") + found.error("duration", "time_step")
    )


def thrown_back(moved: float, lower: float) -> Run:
    """Two contacts in units of END, a flight between them in which gravity turns the mass, at twice its speed over END.

    The first ends so much ``moved``, and the gap of the flight is so much ``lower``, m.
    """
    time = END * np.linspace(0.0, 3.0, 3001)
    flown = np.clip(time - END, 0.0, END)
    speed, gap = 2.0 * SPEED * flown / END - SPEED, SPEED * flown * (1.0 - flown / END)
    rows = np.array([time, np.zeros_like(time), speed, np.zeros_like(time), lower - gap])
    contacts = {"start": 0.0, "duration": END * (1.0 + moved)}, {"start": 2.0 * END, "duration": END}
    return Run(reading(rows), {}, time.size - 1, time.size, contacts)


@pytest.mark.parametrize(("half", "quarter"), [(0.0, 0.1), (0.04, 0.02), (0.02, 0.1)])
def test_contacts_move_by_what_half_the_steps_move_them_or_half_of_what_a_quarter_does(
    half: float, quarter: float
) -> None:
    """Two marches may agree by chance, of three with an order of one neither is off by more."""
    fine = thrown_back(0.0, 0.0)
    first, second = fine.contacts
    later = [replace(fine, contacts=(first, second | {"start": (2.0 + by) * END})) for by in (half, quarter)]
    assert line(fine, *later).moved == pytest.approx(max(half, 0.5 * abs(quarter - half)) * END)


@pytest.mark.parametrize(("half", "quarter"), [(1.5, 4.0), (1.9, 2.0), (1.0, 3.0)])
def test_a_norm_knows_a_touch_by_the_root_of_how_far_it_moves(half: float, quarter: float) -> None:
    """A second contact begins late, by less than twice as much with half the steps: touches fall anywhere in a step."""
    time, late = END * np.linspace(0.0, 4.0, 4001), 0.02 * END

    def touching(by: float) -> Run:
        force = PUSH * ((time < END) | ((time > 2.0 * END + by) & (time < 3.0 * END)))
        rows = np.array([time, np.zeros_like(time), np.full_like(time, SPEED), force, -force])
        contacts = tuple({"start": start, "duration": END} for start in (0.0, 2.0 * END + by))
        return Run(reading(rows), {}, time.size - 1, time.size, contacts)

    exact, fine = touching(0.0), touching(late)
    found = line(fine, touching(half * late), touching(quarter * late)).quantities["history_l2"].error
    missed = distance(fine.reading.force_at, exact.reading.force_at, time)
    assert missed <= (found or 0.0) < 4.0 * missed


def test_gravity_changes_the_speed_for_as_long_as_a_first_contact_may_end_later() -> None:
    """By what the steps move its end, over a safety that does not count here, or by how long it may faintly go on."""
    fine, moved, lower = thrown_back(0.0, 0.0), 0.03, 0.02 * SPEED * END
    by_steps = _ended_later(fine, thrown_back(moved, 0.0))
    assert by_steps["duration"] == pytest.approx(0.0, abs=2e-3 * END)
    assert by_steps["restitution"] == pytest.approx(2.0 * moved / UNSHOWN, rel=1e-6)
    faintly = _ended_later(fine, thrown_back(0.0, lower))
    later = 0.5 - np.sqrt(0.25 - SAFETY * 0.02)  # the gap is still as small as its error
    assert faintly["duration"] == pytest.approx(later * END, rel=0.06)
    assert faintly["restitution"] == pytest.approx(2.0 * faintly["duration"] / END)


@pytest.mark.parametrize("falls", [True, False])
@pytest.mark.parametrize("steps", [1, RINGING, 2 * (RINGING + CLEAR) - 1, 2 * (RINGING + CLEAR)])
def test_what_rings_at_both_ends_of_a_contact_is_the_line_beside_it_that_jumps_from_nothing(
    steps: int, falls: bool
) -> None:
    """Two contacts, in units of a step, of a force that falls to nothing amid the last ringing or rises amid the first.

    One too short to have anything beside its ends stays as it is.
    """
    spans, time = [(9.5, 9.5 + steps), (69.5, 69.5 + steps)], np.arange(80.0 + steps)

    def line(time: Array) -> Array:
        return np.asarray(0.05 * PUSH * np.maximum(65.5 + steps - time if falls else time - 13.5, 0.0))

    inside = [(time > start) & (time < end) for start, end in spans]
    near = [np.minimum(np.abs(time - start), np.abs(time - end)) < RINGING for start, end in spans]
    pressed, rings = np.any(inside, axis=0), np.any(np.logical_and(inside, near), axis=0)
    force = np.where(pressed, line(time), 0.0)
    rows = np.array([time, 3.0 * time, np.ones_like(time), force + 0.3 * PUSH * rings * (time % 2.0), -time])
    found, blurred = _cleaned(rows, spans, 1e3)
    if steps < 2 * (RINGING + CLEAR):
        np.testing.assert_array_equal(found, rows)
        assert not blurred
        return
    touched, parted = 9.5 + RINGING, 9.5 + steps - RINGING
    assert blurred[0] == (9.5, pytest.approx(touched, abs=1.0))
    assert blurred[1] == (pytest.approx(parted, abs=1.0), 9.5 + steps)
    assert len(blurred) == 2 * len(spans)
    np.testing.assert_allclose(found[DEPTH], 3.0 * found[TIME], rtol=1e-12)
    jumps = np.array([spans[0][0], spans[0][1], spans[1][0]])  # where the last contact ends is told elsewhere
    np.testing.assert_array_equal(found[TIME], np.sort(np.concatenate([time, jumps, jumps])))
    first = np.searchsorted(found[TIME], jumps)
    rises = np.array([True, False, True])
    np.testing.assert_allclose(found[FORCE, first], np.where(rises, 0.0, line(jumps)), atol=1e-9)
    np.testing.assert_allclose(found[FORCE, first + 1], np.where(rises, line(jumps), 0.0), atol=1e-9)
    np.testing.assert_allclose(found[FORCE, np.isin(found[TIME], time)], force, atol=1e-9)


@pytest.mark.parametrize("after", [1, 12])
def test_forces_of_a_contact_that_opens_beside_its_ends_are_no_line_through_nothing(after: int) -> None:
    """It presses for eleven steps, is open for twenty, and presses for some more: what the march says is told."""
    time = np.arange(80.0)
    again = 41.5 + after
    force = PUSH * np.where(((time > 9.5) & (time < 20.5)) | ((time > 41.5) & (time < again)), 1.0, 0.0)
    rows = np.array([time, time, np.ones_like(time), force, -time])
    found, blurred = _cleaned(rows, [(9.5, again)], 1e3)
    np.testing.assert_array_equal(found[FORCE], force)
    assert not blurred


def test_what_rings_at_fronts_within_a_first_contact_is_the_lines_before_and_behind() -> None:
    """A force that jumps up by PUSH at every echo: longer rings the one that came twice, and one near the end stays."""
    echo, time, span = 100.0, np.arange(320.0), (0.0, 305.5)
    level = PUSH * (1.0 + np.floor(time / echo)) * (time < span[1])
    rings = [(time >= echo * k) & (time < echo * k + RINGING + RINGING // 2 * k) for k in (1, 2)]
    rows = np.array([time, time, np.ones_like(time), level + 0.3 * PUSH * np.any(rings, axis=0) * (time % 2.0), -time])
    found, _ = _cleaned(rows, [span], echo)
    force = found[FORCE]
    assert force[found[TIME] < 250.0].max() == pytest.approx(3.0 * PUSH)
    for times in (1, 2):
        at = np.flatnonzero(found[TIME] == echo * times)
        assert at.size == 3, "before, behind, and the row of the march"
        np.testing.assert_allclose(force[at], PUSH * (times + np.array([0.0, 1.0, 1.0])), rtol=1e-9)
    assert np.sum(found[TIME] == 3.0 * echo) == 1


@pytest.mark.parametrize(("forces", "end", "drop"), [
    ([4.0, 4.0, 4.0, 4.0, 2.0, 0.0], 4.0, 4.0),  # the mean of before and behind: a front came with that row
    ([4.5, 4.0, 3.5, 3.0, 1.25, 0.0], 4.0, 2.5),  # the same of one that falls
    ([4.0, 4.0, 4.0, 4.0, 4.0, 0.0], 4.7, 4.0),  # a front came between two rows
    ([5.0, 4.0, 3.0, 2.0, 1.0, 0.0], 4.9, None),  # comes to nothing by itself
])  # fmt: skip
@pytest.mark.parametrize("unit", [1e-3, 1.0])
def test_a_contact_ends_with_the_front_that_takes_its_force(
    forces: list[float], end: float, drop: float | None, unit: float
) -> None:
    """Two rows of that time where it drops, from where it was going; in units of a step, one before it has left."""
    time, pushed = np.arange(6.0), unit * np.array(forces)
    rows, found = _bar_ended(np.array([time, 2.0 * time, -time, pushed, 3.0 * time]), 4.7 if drop else end)
    assert found == end
    np.testing.assert_allclose(rows[DEPTH], 2.0 * rows[TIME], rtol=1e-12)
    kept = int(np.ceil(end))
    ends = [end] if drop is None else [end, end]
    np.testing.assert_allclose(rows[TIME], [*time[:kept], *ends], rtol=1e-12)
    np.testing.assert_allclose(rows[FORCE], [*pushed[:kept], *([] if drop is None else [unit * drop]), 0.0], atol=1e-12)


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_a_rod_that_has_left_is_told_where_and_as_fast_as_it_was_when_it_left(gravity: float) -> None:
    """Back along its free flight from the last row, which lies beyond the end; nothing presses or is dented there."""
    end, time = 2.3, np.arange(4.0)
    path, speed = 0.7 - 1.5 * (time - end) + 0.5 * gravity * (time - end) ** 2, -1.5 + gravity * (time - end)
    rows = np.array([time, path, speed, [1.0, 5.0, 2.0, 9.0], [0.1, 0.5, 0.2, 0.9]])
    found = _rod_ended(rows, end, gravity)
    np.testing.assert_array_equal(found[:, :-1], rows[:, :3])
    assert found[:, -1] == pytest.approx([end, 0.7, -1.5, 0.0, 0.0])
    np.testing.assert_array_equal(rows[TIME], time)


@pytest.mark.parametrize("spoiled", [0, 2])
def test_forces_before_and_behind_a_front_are_read_off_the_steps_beside_it(spoiled: int) -> None:
    """Parabolas from front to front, the second of which would come to pull: nothing does. Behind a front in its own
    step the march has the mean, and in those that are spoiled anything.
    """
    time, fronts = np.arange(30.0), np.array([0, 10, 20])
    pieces = [lambda t: 9.0 - 0.3 * t + 0.01 * t**2, lambda t: 6.0 - 0.05 * (t - 9.0) ** 2, lambda t: 2.0 + 0.1 * t]
    force = np.concatenate([piece(time[10 * k : 10 * k + 10]) for k, piece in enumerate(pieces)])
    for front in fronts:
        force[front : front + spoiled + 1] = 99.0
    force[-1] = 0.0
    rows = np.array([time, 2.0 * time, -time, force, 3.0 * time])
    found = with_fronts(rows, fronts, spoiled)
    times, forces = list[float](), list[float]()
    for k, piece in enumerate(pieces):
        inside = [10.0 * k, *np.arange(10.0 * k + spoiled + 1.0, 10.0 * k + 10.0)] + [10.0 * k + 10.0] * (k < 2)
        times += inside
        forces += [max(float(piece(at)), 0.0) for at in inside]
    forces[-1] = 0.0
    assert found[TIME].tolist() == times
    assert found[FORCE] == pytest.approx(np.array(forces), abs=1e-9)
    assert found[DEPTH] == pytest.approx(2.0 * found[TIME])
    assert min(forces[:-1]) == 0.0


@pytest.mark.parametrize(("end", "kept"), [(3.4, 4), (3.0, 3), (7.0, 6)])
def test_rows_are_told_up_to_an_end_within_the_last_step_or_as_far_as_the_march_went(end: float, kept: int) -> None:
    time = np.arange(6.0)
    rows = np.array([time, time**2, -time, 5.0 * time, 3.0 * time])
    found = stopped(rows, end)
    np.testing.assert_array_equal(found[:, :kept], rows[:, :kept])
    assert found.shape[1] == kept + (end < 5.0)
    if end < 5.0:
        line = np.interp(end, time, time**2)
        assert found[:, -1] == pytest.approx([end, line, -end, 5.0 * end, 3.0 * end])


@pytest.mark.parametrize(
    ("gone", "again", "read"), [(0.3, 9.0, 0.3), (0.95, 9.0, 0.95), (0.3, 0.8, 0.3), (1.7, 9.0, 1.0), (-0.2, 9.0, 1.0)]
)
def test_a_dent_comes_to_nothing_where_its_parabola_first_does_within_a_step_of_what_still_presses(
    gone: float, again: float, read: float
) -> None:
    """In steps of any length, from the last row that is pressed, the one before the last; else a step after it."""
    time = 0.2 * np.arange(7.0)
    dent = 1e-3 * (time - time[-2] - 0.2 * gone) * (time - time[-2] - 0.2 * again)
    assert _undented(np.array([*np.zeros((1, 7)) + time, *np.zeros((3, 7)), dent])) == pytest.approx(
        time[-2] + 0.2 * read, rel=1e-9
    )


@pytest.mark.parametrize("gravity", [0.0, 0.4])
def test_a_contact_is_told_by_its_own_rows_and_by_the_impulse_of_its_own_force(gravity: float) -> None:
    """An even force over three units of time, between two that are none of its own; by hand."""
    start, end, came, force = 2.0, 5.0, 1.5, 2.0
    time = np.linspace(0.0, 7.0, 71)
    own = (time >= start) & (time <= end)
    rows = np.array([time, 0.3 - 0.1 * (time - 3.0) ** 2, np.full(71, came), 2.5 * force * ~own + force * own, time])
    impulses = 7.0 + force * np.clip(time - start, 0.0, end - start)
    found = _contact(rows, time, impulses, (start, end), MASS, gravity)
    left = came + gravity * 3.0 - force * 3.0 / MASS
    assert found == {
        "start": start,
        "duration": 3.0,
        "velocity": pytest.approx(came),
        "restitution": pytest.approx(-left / came, rel=1e-9),
        "peak_force": force,
        "peak_time": start,
        "peak_depth": pytest.approx(0.3),
    }
    rows[VELOCITY] = 2.0 * time
    assert _contact(rows, time, impulses, (start, end), MASS, gravity)["velocity"] == pytest.approx(2.0 * start)


@pytest.mark.parametrize("impacts", [1, 2])
def test_contacts_are_over_when_the_last_of_them_is_open_for_longer_than_a_pause(impacts: int) -> None:
    """One that opens for less is the same contact: of 1 pressed to 3, 4 to 6, and from 9 on to 10, in pauses of 1.5."""
    pressed = [1, 2, 3, 4, 5, 6, 9, 10]
    ending = Ending(impacts, pause=1.5)
    told = list[int]()
    for time in range(14):
        sample: Any = SimpleNamespace(time=float(time) + 0.3 * (time in (4, 5)), force=float(time in pressed))
        told += [time] * ending(sample)
    assert told == ([8] if impacts == 1 else [12, 13])


def test_a_bar_that_touches_twice_is_told_by_both_contacts_without_their_ringing() -> None:
    """Even forces but for the steps at their ends; between them it flies, as gravity has it."""
    time, spans, gravity = np.arange(103.0), [(1.0, 40.0), (61.0, 100.0)], 0.1
    pressed = np.any([(time >= start) & (time <= end) for start, end in spans], axis=0)
    near = np.min([np.minimum(np.abs(time - start), np.abs(time - end)) for start, end in spans], axis=0) < RINGING
    force = pressed * (1.0 + 0.3 * near * (time % 2.0))
    passed = sum(np.clip(time - start, 0.0, end - start) for start, end in spans)
    velocity, none = SPEED + gravity * time - passed / 10.0, None
    samples = tuple(
        Sample(at, push, given, np.array([0.0 if push else -1.0]), np.ones(1), np.array([1e-9 if push else -1.0]),
               np.array([0.1 * at]), np.array([speed]), none, 1)
        for at, push, given, speed in zip(time, force, np.diff(passed, prepend=0.0), velocity, strict=True)
    )  # fmt: skip
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=2), gravity=gravity, end_time=200.0)
    found, contacts = read_bar(Motion(samples, none, 1), 10.0, scene, 5.0, 1e3, None, 1.0)
    assert found.separated
    assert found.rows[FORCE].max() == pytest.approx(1.0)
    assert found.quantities["impulse"] == pytest.approx(78.0)
    for one, (start, end) in zip(contacts, spans, strict=True):
        came = np.interp(start, time, velocity)
        left = came + 39.0 * gravity - 3.9
        told = {"start": start, "duration": 39.0, "velocity": came, "restitution": -left / came, "peak_force": 1.0}
        assert {name: one[name] for name in told} == pytest.approx(told, rel=1e-7)
        assert start <= (one["peak_time"] or 0.0) < end
    first = {name: contacts[0][name] for name in ("duration", "restitution", "peak_force", "peak_depth")}
    assert {name: found.quantities[name] for name in first} == first


@pytest.mark.parametrize("shape", ["punch", "sphere"])
@pytest.mark.parametrize("separated", [True, False])
@pytest.mark.parametrize("gravity", [0.0, 50.0])
def test_an_impact_on_a_rod_is_read_off_its_steps_as_an_even_force_moves_a_mass(
    gravity: float, separated: bool, shape: str
) -> None:
    """By hand: it presses for six steps and a half, and no front comes back meanwhile; it ends in the seventh, or
    in the sixth where the scene does. A flat end is met as hard at touch by a rod of that impedance.
    """
    step, last = 1e-4, 7.0 if separated else 5.4
    changes = {"striker.shape": shape, "model.gravity": gravity, "motion.end_time": last * step}
    known = Scene.load("rod", {**changes, "model.profile": "parabola"})
    mass, time, end = known.reduced_mass, step * np.arange(np.ceil(last) + 1.0), 6.5 * step
    impedance, modulus = 1.7 * mass / end, known.geometry.material.uniaxial_modulus().glassy
    density = (impedance / known.to_dict()["target"]["area"]) ** 2 / modulus
    scene = Scene.load("rod", {**changes, "model.profile": "parabola", "target.material.density": density})
    force = impedance * scene.velocity
    for_so_long = np.minimum(time, end)
    velocity = scene.velocity + gravity * time - force / mass * for_so_long
    depth = (scene.velocity + 0.5 * gravity * time) * time - force / mass * for_so_long * (time - 0.5 * for_so_long)
    none: Any = None
    samples = tuple(
        Sample(at, force * (at < end), 0.0, np.array([1e-3 * (end - at) / step]), np.zeros(1), np.array([end - at]),
               np.array([deep]), np.array([speed]), none, 1)
        for at, deep, speed in zip(time, depth, velocity, strict=True)
    )  # fmt: skip
    found = read_rod(Motion(samples, none, 1), scene, 40, separated)
    until = end if separated else last * step
    left = scene.velocity + gravity * until - force / mass * until
    values = dict(found.quantities)
    assert values["impulse"] == pytest.approx(force * until, rel=1e-9)
    assert values["peak_force"] == pytest.approx(force)
    assert values["duration"] == (pytest.approx(end) if separated else None)
    assert values["restitution"] == (pytest.approx(-left / scene.velocity) if separated else None)
    assert values["peak_depth"] == pytest.approx(0.5 * scene.velocity**2 / (force / mass - gravity), rel=1e-3)
    assert found.force_at(np.array([2.5 * step])) == pytest.approx(force)
