"""The most likely parameters, and all valleys of the likelihood that count; corrected where a nearer law says more.

One history can be told by a fast relaxation as well as by a slow one: searches begin from both, and an interval holds
every valley in which the curves are about as likely.

The cheap law is corrected near the most likely place by a method that is nearer to the truth, as finite elements. What
the reference's force is beyond the law's changes slowly with the parameters: taken at one place it is added to the
law's force everywhere, the least squares go on from there by the law's own slopes, and it is taken anew where they end,
until they stay. A history of the reference is asked for every curve in every round, no more.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault, NotReached
from lumped.fit.profile import REACHED
from lumped.identify.certainty import Valley, quantile, untold
from lumped.identify.histories import Correction, Histories, Noise, Samples
from lumped.identify.keys import FREE, FreeKey, SceneFile, free_keys, starting_places
from lumped.identify.record import ByReference, Shift
from lumped.laws import ting
from lumped.laws._hereditary import problem_of
from lumped.laws.base import check_mass
from lumped.numbers import Array
from lumped.result.history import History
from lumped.result.noise import colour_of, colour_of_corner, whitened
from lumped.result.score import Curve
from lumped.scene.scene import Scene

TOLERANCE, MOST_STEPS = 1e-6, 60  # of the least squares: relative changes that end it; work
SCOUTED = 1e-3  # the same of the searches that look for valleys
NEAR = 5.0  # safety: a valley that was scouted so many times the bound above the likeliest is looked at again
TIMES = (0.03, 1.0, 10.0)  # relaxation times of the starts, over the pulse's width
EARLIEST, LATEST, SHIFTS = -0.6, 0.3, 91  # where a touch is looked for first, in widths from where the pulse begins
FARTHEST = 1.5  # safety: of a touch from there, in widths
POWER = 2.5  # a peak grows as the modulus to the power 2/5, of Hertz's law; others are near
GUESSED = 0.02  # of the peak: a noise to begin with
REWEIGHED = 2  # times that the noise is told from the residuals and the search goes on from there
SILENT = 40  # rows that tell a noise's colour
ROUNDS = 6  # work: each asks the reference for every curve
STAYS = 0.1  # of half an interval, or of the reference's bars: a place that moves less has been found

# The history of a scene by another method, with bars. Raises BadInput, NotReached.
Reference = Callable[[Scene], History]


def search(
    curves: Mapping[str, Curve],
    file: SceneFile,
    free: Sequence[str],
    own: Mapping[str, Mapping[str, object]],
    corner: float | None,
    low_pass: bool,
) -> tuple[Histories, tuple[Valley, ...]]:
    """The valleys of the likelihood, the likeliest first, see :func:`lumped.identify`. Raises BadInput, NotReached."""
    keys = free_keys(file, free)
    _check_own(keys, own)
    samples = tuple(Samples.of(curve, own.get(name, {})) for name, curve in curves.items())
    for one in samples:  # what no law of the scene can answer is said before anything is sought
        scene = file.scene(keys, starting_places(keys), one.own)
        check_mass(scene)
        ting.of(scene)
        problem_of(scene)
    if low_pass and any(one.step is None for one in samples):
        raise BadInput(Fault("low_pass", "", "not known of rows in uneven steps; accepted: equal steps"))
    noises = tuple(Noise(GUESSED * one.peak, _colour(one, (), corner)) for one in samples)
    begun = Histories(file, keys, samples, noises, low_pass)
    if begun.freedom <= 0:
        reason = f"{begun.rows} rows for {begun.size} numbers; accepted: more rows than numbers sought"
        raise BadInput(Fault(next(iter(curves)), "", reason))
    return _most_likely(begun, corner)


def _check_own(keys: Sequence[FreeKey], own: Mapping[str, Mapping[str, object]]) -> None:
    both = {name for one in own.values() for name in one} & {one.key for one in keys}
    if both:
        raise BadInput(Fault(FREE, name, "free, and a curve's own; accepted: one of them") for name in sorted(both))


def _colour(one: Samples, silences: Sequence[Array], corner: float | None) -> Array:
    """The colour by the corner of a low pass, Hz, or by silences, N, each (n,); none where neither tells it."""
    if one.step is not None and corner is not None:
        return colour_of_corner(corner, one.step)
    return colour_of(*silences)


def _silences(one: Samples, left: Array, pressed: NDArray[np.bool_], corner: float | None) -> tuple[Array, ...]:
    """What is left before touch and after the contact, N, each (n,), where that alone tells the colour."""
    if one.step is None or corner is not None:
        return ()
    before, _, after = np.split(left, (pressed.argmax(), pressed.size - pressed[::-1].argmax()))
    return (before, after) if before.size + after.size >= SILENT else ()


def _most_likely(histories: Histories, corner: float | None) -> tuple[Histories, tuple[Valley, ...]]:
    """The valleys where the searches end, the likeliest first, those alone that an interval may hold.

    The noise is told from the residuals of the likeliest. Raises NotReached.
    """
    starts = _starts(histories)
    if not starts:
        raise NotReached("no impact of the scene is near the curves", "nearer values in the scene file")
    if names := untold(histories, starts):
        reason = f"the force of this scene tells only a combination of {', '.join(names)}"
        raise BadInput(Fault(FREE, "", f"{reason}; accepted: one of them held, or a geometry that tells them apart"))
    scouted = [descended(histories, start, _limits(histories, start), SCOUTED) for start in starts]
    scouted.sort(key=lambda one: histories.squares(one.sought))
    best, *near = _distinct(histories, scouted, NEAR * histories.squares(scouted[0].sought) / histories.freedom)
    for _ in range(REWEIGHED):
        histories = reweighed(histories, best.sought, corner)
        best = descended(histories, best.sought, best.limits, SCOUTED)
    softer, moved = _softened(reweighed(histories, best.sought, corner), best.sought)
    ended = [descended(softer, one.sought, one.limits) for one in map(moved, (best, *near))]
    ended.sort(key=lambda one: softer.squares(one.sought))
    return softer, tuple(_distinct(softer, ended, 1.0 - REACHED))


def _distinct(histories: Histories, ended: Sequence[Valley], share: float) -> Iterator[Valley]:
    """The first, and those within the bound above it, times a share, that lie as far from it by the slopes there."""
    best, bound = ended[0].sought, share * quantile(histories)
    least, slopes = histories.squares(best), histories.slopes(best)
    yield ended[0]
    for one in ended[1:]:
        away = float(np.sum((slopes @ (one.sought - best)) ** 2))
        if histories.squares(one.sought) - least < bound < away:
            yield one


def _softened(histories: Histories, sought: Array) -> tuple[Histories, Callable[[Valley], Valley]]:
    """The same where a branch without a modulus is near, and what moves a valley there."""
    p, one = len(histories.keys), histories.samples[0]
    scene = histories.file.scene(histories.keys, sought[:p], one.own)
    keys = tuple(key.softened(scene.contact_modulus.glassy, one.width) for key in histories.keys)

    def moved(places: Array) -> Array:
        pairs = zip(histories.keys, keys, places[:p].tolist(), strict=True)
        return np.append([new.to_place(old.at(place)) for old, new, place in pairs], places[p:])

    def valley(old: Valley) -> Valley:
        low, high = map(moved, old.limits)
        low[:p] = [key.to_place(key.kind.low) if key.beside else end for key, end in zip(keys, low, strict=False)]
        return Valley(moved(old.sought), np.array([low, high]))

    return replace(histories, keys=keys, known={}), valley


def reweighed(histories: Histories, sought: Array, corner: float | None) -> Histories:
    """The same with the noise that these residuals tell of every curve."""
    noises = list[Noise]()
    every = zip(histories.samples, histories.differences(sought), histories.pressed(sought), strict=True)
    for one, left, pressed in every:
        silences = _silences(one, left, pressed, corner)
        colour = _colour(one, silences, corner)
        new = whitened(left, colour)
        share = histories.size * one.time.size / histories.rows / len(histories.samples)  # of what is sought
        freedom = max(new.size - share, 1.0)
        deviation = math.sqrt(float(new @ new) / freedom)
        noises.append(Noise(max(deviation, 1e-12 * one.peak), colour, silences))  # rounding: a computed curve has none
    return replace(histories, noises=tuple(noises))


def _starts(histories: Histories) -> list[Array]:
    """First guesses, the nearest to the curves first: that one, and those of the fastest and the slowest relaxation."""
    own = starting_places(histories.keys)
    with_times = any(one.is_time for one in histories.keys)
    guesses = [own, *(_with_times(histories, own, share) for share in TIMES if with_times)]
    every = [_with_touches(histories, _with_peak(histories, guess)) for guess in guesses]
    there = [start for start in every if start is not None]
    nearest = sorted(there, key=histories.squares)[:1]
    return nearest + [start for start in (every[1:2] + every[-1:]) if start is not None and start is not nearest[0]]


def _with_times(histories: Histories, places: Array, share: float) -> Array:
    """The places with the times, on average in logarithms, at this share of the pulse's width."""
    width = math.log(share * histories.samples[0].width)
    scene = histories.file.scene(histories.keys, places, histories.samples[0].own)
    times = scene.contact_modulus.times
    if not times:
        return places
    shift = width - float(np.mean(np.log(times)))
    return places + shift * np.array([float(one.is_time) for one in histories.keys])


def _with_peak(histories: Histories, places: Array) -> Array:
    """The places with all moduli scaled together so that the first curve's peak is about right."""
    moduli = np.array([float(one.is_modulus) for one in histories.keys])
    for _ in range(2 if moduli.any() else 0):
        impacts = histories.impacts(places)
        if impacts is None:
            return places
        one, impact = histories.samples[0], impacts[0]
        peak = float(impact.force(np.linspace(0.0, impact.end, SHIFTS)).max())
        places = places + moduli * POWER * math.log(one.peak / peak)
    return places


def _with_touches(histories: Histories, places: Array) -> Array | None:
    """The places and the touches at which the computed forces lie best; None where there is no impact."""
    impacts = histories.impacts(places)
    if impacts is None:
        return None
    shares = np.linspace(EARLIEST, LATEST, SHIFTS)
    best = []
    for one, impact in zip(histories.samples, impacts, strict=True):
        grid = np.linspace(0.0, impact.end, 4 * SHIFTS)
        force = impact.force(grid)
        left = [
            one.force - np.interp(one.time - one.start - share * one.width, grid, force, 0.0, 0.0) for share in shares
        ]
        best.append(float(shares[int(np.argmin([column @ column for column in left]))]))
    return np.append(places, best)


def _limits(histories: Histories, around: Array) -> Array:
    """Least and largest place of all that is sought, (2, size)."""
    limits = [one.limits(one.at(place)) for one, place in zip(histories.keys, around.tolist(), strict=False)]
    return np.array([*limits, *[(-FARTHEST, FARTHEST)] * len(histories.samples)]).T


def descended(histories: Histories, start: Array, limits: Array, tolerance: float = TOLERANCE) -> Valley:
    """Where least squares end from a start, (size,), within the limits, (2, size)."""
    from scipy.optimize import least_squares

    low, high = limits
    found = least_squares(
        histories.residuals,
        np.clip(start, low + TOLERANCE, high - TOLERANCE),
        histories.slopes,
        bounds=(low, high),
        xtol=tolerance,
        ftol=tolerance,
        gtol=None,
        max_nfev=MOST_STEPS,
    )
    return Valley(np.asarray(found.x), limits)


@dataclass(frozen=True, eq=False)
class Corrected:
    """The histories with the corrections, the most likely place with them, and what is said of both."""

    histories: Histories
    valley: Valley
    told: ByReference


def correct(histories: Histories, valleys: Sequence[Valley], corner: float | None, reference: Reference) -> Corrected:
    """The likeliest valley with a law that the reference has corrected there. Raises NotReached where it moves on."""
    valley = valleys[0]
    for runs in range(1, ROUNDS + 1):
        there, found = _round(histories, valley, corner, reference)
        step, bars = np.abs(found.sought - valley.sought), _bars(there, found.sought)
        valley = found
        if runs > 1 and np.all(step <= STAYS * np.maximum(bars, _half_widths(there, found.sought))):
            told = _told(histories, valleys, there, found, bars, runs * len(there.samples))
            return Corrected(there, found, told)
    reason = f"the parameters still move after {ROUNDS} rounds of reference histories"
    raise NotReached(reason, "fewer free keys, or a curve that tells them better")


def _round(
    histories: Histories, valley: Valley, corner: float | None, reference: Reference
) -> tuple[Histories, Valley]:
    """The histories with what the reference says in a valley, and where their least squares end."""
    places = valley.sought[: len(histories.keys)]
    pairs = zip(histories.scenes(places), histories.impacts(places) or (), strict=True)
    corrections = tuple(Correction.of(reference(scene), impact) for scene, impact in pairs)
    there = replace(histories, corrections=corrections, known={})
    found = descended(there, valley.sought, valley.limits)
    there = reweighed(there, found.sought, corner)
    return there, descended(there, found.sought, valley.limits)


def _bars(histories: Histories, sought: Array) -> Array:
    """How far the reference's bars can move what is sought, (size,): sum_k |(J^T J)^-1 J^T|_ik bar_k, no less."""
    bars = list[Array]()
    every = zip(histories.samples, histories.noises, histories.corrections, histories.touches(sought), strict=True)
    for one, noise, by, touch in every:
        bar = np.interp(one.time - touch, by.time, by.bar, 0.0, 0.0)
        bars.append(_largest(histories.seen(bar, noise), noise.colour) / noise.deviation)
    return np.asarray(np.abs(np.linalg.pinv(histories.slopes(sought))) @ np.concatenate(bars))


def _largest(bar: Array, colour: Array) -> Array:
    """The most that is new in every row of a column within its bar, as :func:`lumped.result.noise.whitened` sees it."""
    rows = bar.size - colour.size
    found = bar[colour.size :].copy()
    for lag, a in enumerate(colour.tolist(), start=1):
        found += abs(a) * bar[colour.size - lag : colour.size - lag + rows]
    return found


def _half_widths(histories: Histories, sought: Array) -> Array:
    """Of the intervals, by the linearized residuals, (size,)."""
    spread = np.linalg.pinv(histories.slopes(sought))
    return np.asarray(math.sqrt(quantile(histories)) * np.linalg.norm(spread, axis=1))


def _told(
    histories: Histories, valleys: Sequence[Valley], there: Histories, found: Valley, bars: Array, runs: int
) -> ByReference:
    keys, before, after = histories.keys, valleys[0].sought.tolist(), found.sought.tolist()
    moved = {
        key.name: Shift(key.at(old), key.at(new), 0.5 * (key.at(new + bar) - key.at(new - bar)))
        for key, old, new, bar in zip(keys, before, after, bars.tolist(), strict=False)
    }
    pairs = zip(there.corrections, there.samples, strict=True)
    error = max(float(np.abs(by.force).max()) / one.peak for by, one in pairs)
    return ByReference(moved, error, runs, len(valleys) - 1)
