"""The most likely parameters, their intervals by profile likelihood, and whether the law explains the curves.

An end of an interval is the farthest value of a parameter at which all others, the touches too, can still be chosen so
that the sum of squares stays within its bound (Venzon and Moolgavkar, doi 10.2307/2347496). On the linearized residuals
that has an answer in closed form; it is repeated around the answer until it stays.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault, NotReached
from lumped.fit.noise import Whiteness, autocovariance, colour_of, colour_of_corner, memory, whitened, whiteness
from lumped.identify.histories import Histories, Impact, Noise, Samples
from lumped.identify.keys import FREE, FreeKey, SceneFile, free_keys, starting_places
from lumped.identify.record import LEVEL, FittedCurve, Identified, Interval
from lumped.laws import ting
from lumped.laws._hereditary import problem_of
from lumped.laws.base import check_mass
from lumped.numbers import Array
from lumped.result.score import Curve

TOLERANCE, MOST_STEPS = 1e-6, 60  # of the least squares: relative changes that end it; work
# Work: of the starts, the nearest to the curves first; two are enough where the last leaves noise alone: a first can
# end in a valley of its own that noise hides.
FOLLOWED = 3
TIMES = (0.1, 1.0, 10.0)  # relaxation times of the starts, over the pulse's width
EARLIEST, LATEST, SHIFTS = -0.6, 0.3, 91  # where a touch is looked for first, in widths from where the pulse begins
FARTHEST = 1.5  # safety: of a touch from there, in widths
POWER = 2.5  # a peak grows as the modulus to the power 2/5, of Hertz's law; others are near
GUESSED = 0.02  # of the peak: a noise to begin with
REWEIGHED = 2  # times that the noise is told from the residuals and the search goes on from there
SILENT, MARGIN = 40, 0.1  # rows that tell a noise's colour; of the width, before touch and after the end left out
REACHED, LONGEST, MOST_ENDS = 0.02, 0.7, 60  # of the bound; of a step in logarithms; work
# Rounding: differences tell the slopes to about 1e-4; what is told worse than the best by that is not told. Safety: the
# share of a parameter in such a combination that counts.
ALIKE, MIXED = 1e4, 0.03
CORRELATED = 0.95  # named in a warning


def search(
    curves: Mapping[str, Curve],
    file: SceneFile,
    free: Sequence[str],
    own: Mapping[str, Mapping[str, object]],
    corner: float | None,
) -> Identified:
    """See :func:`lumped.identify`."""
    keys = free_keys(file, free)
    _check_own(keys, own)
    samples = tuple(Samples.of(curve, own.get(name, {})) for name, curve in curves.items())
    for one in samples:  # what no law of the scene can answer is said before anything is sought
        scene = file.scene(keys, starting_places(keys), one.own)
        check_mass(scene)
        ting.of(scene)
        problem_of(scene)
    begun = Histories(file, keys, samples, tuple(_first_noise(one, corner) for one in samples))
    if begun.rows <= begun.size:
        reason = f"{begun.rows} rows for {begun.size} numbers; accepted: more rows than numbers sought"
        raise BadInput(Fault(next(iter(curves)), "", reason))
    histories, sought, limits = _most_likely(begun, corner)
    return _told(histories, sought, limits, tuple(curves))


def _check_own(keys: Sequence[FreeKey], own: Mapping[str, Mapping[str, object]]) -> None:
    both = {name for one in own.values() for name in one} & {one.key for one in keys}
    if both:
        raise BadInput(Fault(FREE, name, "free, and a curve's own; accepted: one of them") for name in sorted(both))


def _first_noise(one: Samples, corner: float | None) -> Noise:
    return Noise(GUESSED * one.peak, _colour(one, None, corner))


def _colour(one: Samples, silent: Array | None, corner: float | None) -> Array:
    """The colour by the corner of a low pass, Hz, or by the silence, N; none where neither tells it."""
    if one.step is None:
        return np.zeros(0)
    if corner is not None:
        return colour_of_corner(corner, one.step)
    return np.zeros(0) if silent is None or silent.size < SILENT else colour_of(silent)


def _most_likely(histories: Histories, corner: float | None) -> tuple[Histories, Array, Array]:
    """The best of the searches, the noise told from its own residuals; the limits of the search. Raises NotReached."""
    ended = list[tuple[float, Array, Array]]()
    for start in _starts(histories)[:FOLLOWED]:
        limits = _limits(histories, start)
        sought = _descended(histories, start, limits)
        ended.append((float(np.sum(histories.residuals(sought) ** 2)), sought, limits))
        if len(ended) > 1 and whiteness(histories.whitened(histories.differences(sought))).noise:
            break
    if not ended:
        raise NotReached("no impact of the scene is near the curves; cure: nearer values in the scene file")
    _, sought, limits = min(ended, key=lambda found: found[0])
    for _ in range(REWEIGHED):
        histories = _reweighed(histories, sought, corner)
        sought = _descended(histories, sought, limits)
    return _softened(_reweighed(histories, sought, corner), sought, limits)


def _softened(histories: Histories, sought: Array, limits: Array) -> tuple[Histories, Array, Array]:
    """The same where a branch without a modulus is near: the likeliest place, and limits as they were."""
    p, one = len(histories.keys), histories.samples[0]
    scene = histories.file.scene(histories.keys, sought[:p], one.own)
    keys = tuple(key.softened(scene.contact_modulus.glassy, one.width) for key in histories.keys)
    softer = replace(histories, keys=keys, known={})

    def moved(places: Array) -> Array:
        pairs = zip(histories.keys, keys, places[:p].tolist(), strict=True)
        return np.append([new.to_place(old.at(place)) for old, new, place in pairs], places[p:])

    low, high = map(moved, limits)
    low[:p] = [key.to_place(key.kind.low) if key.beside else end for key, end in zip(keys, low, strict=False)]
    ends = np.array([low, high])
    return softer, _descended(softer, moved(sought), ends), ends


def _reweighed(histories: Histories, sought: Array, corner: float | None) -> Histories:
    """The same with the noise that these residuals tell of every curve."""
    noises = list[Noise]()
    impacts = histories.impacts(sought[: len(histories.keys)]) or ()
    every = zip(histories.samples, histories.differences(sought), histories.touches(sought), impacts, strict=True)
    for one, left, touch, impact in every:
        colour = _colour(one, left[~_pressed(one, touch, impact)], corner)
        new = whitened(left, colour)
        share = histories.size * one.time.size / histories.rows / len(histories.samples)  # of what is sought
        freedom = max(new.size - share, 1.0)
        deviation = math.sqrt(float(new @ new) / freedom)
        noises.append(Noise(max(deviation, 1e-12 * one.peak), colour))  # rounding: a computed curve has none
    return replace(histories, noises=tuple(noises))


def _pressed(one: Samples, touch: float, impact: Impact) -> NDArray[np.bool_]:
    """Which rows lie in the contact, or nearly, (n,): in the others is silence."""
    since, margin = one.time - touch, MARGIN * one.width
    return (since >= -margin) & (since <= impact.end + margin)


def _starts(histories: Histories) -> list[Array]:
    """First guesses, the nearest to the curves first."""
    own = starting_places(histories.keys)
    guesses = [own, *(_with_times(histories, own, share) for share in TIMES)]
    if not any(one.is_time for one in histories.keys):
        guesses = guesses[:1]
    every = (_with_touches(histories, _with_peak(histories, guess)) for guess in guesses)
    there = [start for start in every if start is not None]
    return sorted(there, key=lambda start: float(np.sum(histories.residuals(start) ** 2)))


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


def _descended(histories: Histories, start: Array, limits: Array) -> Array:
    """Where least squares end from a start, (size,)."""
    from scipy.optimize import least_squares

    low, high = limits
    found = least_squares(
        histories.residuals,
        np.clip(start, low + TOLERANCE, high - TOLERANCE),
        histories.slopes,
        bounds=(low, high),
        xtol=TOLERANCE,
        ftol=TOLERANCE,
        gtol=None,
        max_nfev=MOST_STEPS,
    )
    return np.asarray(found.x)


def _told(histories: Histories, sought: Array, limits: Array, names: Sequence[str]) -> Identified:
    """Everything that the curves say at the most likely place."""
    p = len(histories.keys)
    left = histories.differences(sought)
    tested = whiteness(_inside(histories, sought, histories.whitened(left)))
    widened = 1.0 if tested.noise else max(map(memory, histories.whitened(left)))
    bound = _quantile(histories) * widened
    parameters = dict(_intervals(histories, sought, limits, bound))
    correlation = _correlation(histories.slopes(sought))[:p, :p]
    curves = tuple(_fitted(histories, sought, i, name) for i, name in enumerate(names))
    table = histories.file.with_values(histories.keys, sought[:p])
    warnings = (*_warnings(parameters, correlation), *_of_residuals(tested, widened, curves))
    return Identified(histories.file.source, parameters, correlation, curves, tested, widened, table, warnings)


def _inside(histories: Histories, sought: Array, columns: Sequence[Array]) -> list[Array]:
    """The rows during the contact: where no force is, no law errs."""
    impacts = histories.impacts(sought[: len(histories.keys)]) or ()
    every = zip(histories.samples, histories.touches(sought), impacts, columns, strict=True)
    return [column[_pressed(one, touch, impact)[-column.size :]] for one, touch, impact, column in every]


def _quantile(histories: Histories) -> float:
    """By how much the sum of squares over the noise may grow within an interval: Fisher's F(1, n - p), squared t."""
    from scipy.special import stdtrit

    return float(stdtrit(histories.rows - histories.size, 0.5 + 0.5 * LEVEL)) ** 2


def _intervals(histories: Histories, sought: Array, limits: Array, bound: float) -> Iterator[tuple[str, Interval]]:
    slopes = histories.slopes(sought)
    for i, one in enumerate(histories.keys):
        ends = [_end(histories, sought, slopes, limits, i, side, bound) for side in (-1.0, 1.0)]
        low, high = (None if end is None else one.at(end) for end in ends)
        yield one.name, Interval(one.at(float(sought[i])), low, high, LEVEL, one.kind.unit)


def _end(
    histories: Histories, best: Array, slopes: Array, limits: Array, i: int, side: float, bound: float
) -> float | None:
    """The farthest place of parameter i on a side within the bound of the sum of squares; None: there is none.

    The slopes follow the steps (Broyden); where these end, slopes anew have to confirm it.
    """
    sought, residuals, fresh = best, histories.residuals(best), True
    least = float(residuals @ residuals)
    if _step_to_end(residuals, slopes, i, side, least + bound) is None:
        return None
    for _ in range(MOST_ENDS):
        step = _step_inside(residuals, slopes, i, side, least + bound, sought, limits)
        if step is None:
            return None
        there = np.clip(sought + step * min(1.0, LONGEST / float(np.abs(step).max())), *limits)
        gone, before = there - sought, residuals
        sought, residuals = there, histories.residuals(there)
        excess = float(residuals @ residuals) - least - bound
        if there[i] in limits[:, i] and excess < 0.0:
            return None
        ended = abs(gone[i]) <= REACHED * abs(there[i] - best[i]) and abs(excess) <= REACHED * bound
        if ended and fresh:
            return float(there[i])
        fresh = ended
        if ended:
            slopes = histories.slopes(there)
        elif gone.any():
            slopes = slopes + np.outer(residuals - before - slopes @ gone, gone) / float(gone @ gone)
    return None


def _step_inside(
    residuals: Array, slopes: Array, i: int, side: float, most: float, sought: Array, limits: Array
) -> Array | None:
    """The step to the end, without what stands at a limit and would leave it; None where there is none."""
    held = np.zeros(sought.size, dtype=bool)
    while True:
        moving = np.flatnonzero(~held)
        part = _step_to_end(residuals, slopes[:, moving], int(np.searchsorted(moving, i)), side, most)
        if part is None:
            return None
        step = np.zeros(sought.size)
        step[moving] = part
        leaving = ((sought <= limits[0]) & (step < 0.0)) | ((sought >= limits[1]) & (step > 0.0))
        leaving[i] = False
        if not leaving.any():
            return step
        held |= leaving


def _step_to_end(residuals: Array, slopes: Array, i: int, side: float, most: float) -> Array | None:
    """max side d_i with |r + J d|^2 <= most: from the least squares on along C e_i, C = (J^T J)^-1.

    None where J does not tell d_i from others.
    """
    left, singular, axes = np.linalg.svd(slopes, full_matrices=False)
    told = singular * ALIKE > singular[0]
    if np.abs(axes[~told, i]).max(initial=0.0) > MIXED:
        return None
    left, singular, axes = left[:, told], singular[told], axes[told]
    to_least = -axes.T @ ((left.T @ residuals) / singular)
    along = axes.T @ (axes[:, i] / singular**2)
    remaining = most - float(np.sum((residuals + slopes @ to_least) ** 2))
    return np.asarray(to_least + side * math.sqrt(max(remaining, 0.0) / float(along[i])) * along)


def _correlation(slopes: Array) -> Array:
    """Of all that is sought, by the linearized residuals, (size, size)."""
    covariance = np.linalg.pinv(slopes.T @ slopes, hermitian=True)
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))  # rounding: of what nothing tells
    return np.asarray(np.clip(covariance / np.outer(spread, spread), -1.0, 1.0))


def _fitted(histories: Histories, sought: Array, i: int, name: str) -> FittedCurve:
    one, colour, touch = histories.samples[i], histories.noises[i].colour, histories.touches(sought)[i]
    left = histories.differences(sought)[i]
    impacts = histories.impacts(sought[: len(histories.keys)]) or ()
    pressed = _pressed(one, touch, impacts[i])
    (power, alike), silence = autocovariance(left[pressed], 1).tolist(), left[~pressed]
    # white noise is in the power of the rows alone, and not in what neighbours have alike; silence tells a coloured one
    noise = power - alike if not colour.size else float(np.mean(silence**2)) if silence.size else power
    error, deviation = math.sqrt(max(power - noise, 0.0)), math.sqrt(min(noise, power))
    return FittedCurve(
        name, one.time, one.force, one.force - left, touch, deviation, colour, one.peak, error / one.peak
    )


def _warnings(parameters: Mapping[str, Interval], correlation: Array) -> Iterator[str]:
    names = list(parameters)
    for name, one in parameters.items():
        if one.low is None and one.high is None:
            yield f"{name}: the curves do not tell it; hold it, or add a history at another velocity"
        elif one.low is None or one.high is None:
            side = "below" if one.low is None else "above"
            yield f"{name}: its interval is open {side}: no value there is excluded"
    for i, j in combinations(range(len(names)), 2):
        if abs(correlation[i, j]) > CORRELATED:
            told = f"{names[i]} and {names[j]} are correlated by {correlation[i, j]:+.3f}"
            yield f"{told}: hold one, or rely on both together"


def _of_residuals(tested: Whiteness, widened: float, curves: Sequence[FittedCurve]) -> Iterator[str]:
    if not tested.noise:
        worst = max(curves, key=lambda curve: curve.error)
        told = f"what is left is no noise (Ljung-Box, p = {tested.probability:.1g}): the model errs by about"
        cause = f"{told} {100.0 * worst.error:.2g} % of the peak, or the noise is coloured (--corner)"
        yield f"{cause}; the intervals are {math.sqrt(widened):.2g} times as wide, and not to be trusted"
