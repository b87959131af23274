"""What the curves say: intervals over all valleys, the noise, whether the law explains them, what to be warned of."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.fit.profile import open_side
from lumped.identify.certainty import (
    LikelihoodProfile,
    Valley,
    correlation_of,
    growth_of_colours,
    posterior_of,
    quantile,
)
from lumped.identify.histories import RTOL, Histories, Noise
from lumped.identify.record import ByReference, FittedCurve, Identified, Interval, Posterior, ToldValley, hull
from lumped.laws import ting
from lumped.laws.base import simulate
from lumped.numbers import Array
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.noise import Whiteness, autocovariance, memory, whitened, whiteness
from lumped.result.result import LedgerEntry, percent

LEDGER_TOLERANCE = 1e-2  # of the impact that scales what is left out
CORRELATED = 0.95  # named in a warning
NONE = "none"
AT_END = 1e-3  # safety: of a place; a descent that a limit stops ends a little before it
ENOUGH = 100  # independent draws: five of them lie beyond either end of a band


def answer(
    histories: Histories,
    valleys: Sequence[Valley],
    names: Sequence[str],
    sample: int = 0,
    by_reference: ByReference | None = None,
) -> Identified:
    """At the most likely place, and in the other valleys; `names`: of the curves; `sample`: draws of the posterior."""
    sought = valleys[0].sought
    residuals = histories.whitened(histories.differences(sought))
    tested = whiteness(_judged(histories, sought, residuals))
    of_the_rest = 1.0 if tested.noise else max(map(memory, residuals))
    widened, growth = math.sqrt(of_the_rest), of_the_rest * growth_of_colours(histories, sought)
    bound, least = quantile(histories) * growth, histories.squares(sought)
    profiles, told = _apart([LikelihoodProfile(histories, one, least + bound, bound) for one in valleys], least)
    posterior, bands = posterior_of(histories, profiles, growth, sample) if sample else (None, None)
    parameters = {name: hull([one.parameters[name] for one in told]) for name in told[0].parameters}
    curves = tuple(_fitted(histories, sought, names, bands or [np.zeros(0)] * len(names)))
    table = histories.file.with_values(histories.keys, sought[: len(histories.keys)])
    ends = dict(_ends(histories, valleys[0]))
    warnings = (
        *_of_residuals(tested, widened, curves),
        *_of_the_model(histories, sought, parameters, by_reference is None),
        *(_of_end(name, end, parameters[name]) for name, end in ends.items()),
        *_warnings(parameters, told),
        *(() if histories.filtered else _of_a_low_pass(histories, sought, parameters)),
        *_of_the_sample(posterior, told),
        *_of_the_reference(by_reference, parameters),
    )
    source = histories.file.source
    found = (source, parameters, told, curves, tested, widened, table, warnings, posterior, by_reference)
    unneeded = tuple(name for name, end in ends.items() if end == NONE)
    return Identified(*found, beyond=tuple(name for name in ends if name not in unneeded), unneeded=unneeded)


def _apart(
    profiles: Sequence[LikelihoodProfile], least: float
) -> tuple[list[LikelihoodProfile], tuple[ToldValley, ...]]:
    """The valleys, and what they say of the keys, without those that lie within the intervals of one before."""
    apart, found = list[LikelihoodProfile](), list[ToldValley]()
    for one in profiles:
        sought, p = one.valley.sought, len(one.histories.keys)
        values = {key.name: key.at(place) for key, place in zip(one.histories.keys, sought.tolist(), strict=False)}
        if not any(before.holds(values) for before in found):
            growth = one.histories.squares(sought) - least
            found.append(ToldValley(one.intervals(), correlation_of(one.slopes)[:p, :p], growth))
            apart.append(one)
    return apart, tuple(found)


def _judged(histories: Histories, sought: Array, residuals: Sequence[Array]) -> list[Array]:
    """The rows during the contact, of curves that leave more than an impact's integration errs by.

    Where no force is, no law errs.
    """
    every = zip(histories.samples, histories.differences(sought), histories.pressed(sought), residuals, strict=True)
    return [
        column[pressed[-column.size :]]
        for one, left, pressed, column in every
        if np.linalg.norm(left) > RTOL * one.peak * math.sqrt(left.size)
    ]


def _fitted(histories: Histories, sought: Array, names: Sequence[str], bands: Sequence[Array]) -> Iterator[FittedCurve]:
    told = zip(names, histories.touches(sought), bands, strict=True)
    left_of, rows_of = histories.differences(sought), histories.pressed(sought)
    known = zip(histories.samples, histories.noises, left_of, rows_of, strict=True)
    for (name, touch, band), (one, noise, left, pressed) in zip(told, known, strict=True):
        deviation, error = _noise_and_error(left, pressed, noise.colour)
        found = (deviation, noise.colour, one.peak, error / one.peak, band)
        yield FittedCurve(name, one.time, one.force, one.force - left, touch, *found)


def _noise_and_error(left: Array, pressed: NDArray[np.bool_], colour: Array) -> tuple[float, float]:
    """Deviation of the noise, and what is left of the law's beside it, N.

    White noise is in the power of the rows alone, and not in what neighbours have alike; silence tells a coloured one.
    """
    (power, alike), silence = autocovariance(left[pressed], 1).tolist(), left[~pressed]
    noise = power - alike if not colour.size else float(np.mean(silence**2)) if silence.size else power
    return math.sqrt(min(noise, power)), math.sqrt(max(power - noise, 0.0))


def _ends(histories: Histories, valley: Valley) -> Iterator[tuple[str, str]]:
    """The keys that ran into the end of their search, and which end: of what a key accepts, none, or the search's."""
    for key, place, low, high in zip(histories.keys, valley.sought, *valley.limits, strict=False):
        if place - low <= AT_END:
            yield key.name, NONE if key.at(low) <= key.kind.low * (1.0 + AT_END) else "lower"
        elif high - place <= AT_END:
            yield key.name, "upper"


def _of_end(name: str, end: str, one: Interval) -> str:
    if end == NONE:
        return f"{name} ran into the end of its search, none: the curves do not need it; cure: a law without it"
    told = f"{name} ran into the {end} end of its search, {one.value:.3g} {one.unit}".rstrip()
    return f"{told}: it is not found; cure: hold it, or another first guess in the scene file"


def _warnings(parameters: Mapping[str, Interval], valleys: Sequence[ToldValley]) -> Iterator[str]:
    names, correlation = list(parameters), valleys[0].correlation
    open_ends = defaultdict[str, list[str]](list)
    for name, one in parameters.items():
        if one.unfound:
            yield f"{name}: the search for its {' and '.join(one.unfound)} end did not converge; hold another key"
        elif one.low is None and one.high is None:
            yield f"{name}: the curves do not tell it; hold it, or add a history at another velocity"
        elif side := open_side(one.low, one.high):
            open_ends[side].append(name)
    for side, which in open_ends.items():
        yield f"{', '.join(which)}: open {side}: no value there is excluded"
    for i, j in combinations(range(len(names)), 2):
        if abs(correlation[i, j]) > CORRELATED:
            told = f"{names[i]} and {names[j]} are correlated by {correlation[i, j]:+.3f}"
            yield f"{told}: hold one, or rely on both together"
    for other in valleys[1:]:
        values = ", ".join(f"{name} = {one.value:.4g}" for name, one in other.parameters.items())
        cure = "the intervals hold both, and a history at another velocity decides"
        yield f"{values} tell the curves about as well (sum of squares {other.growth:+.2g}): {cure}"


def _of_residuals(tested: Whiteness, widened: float, curves: Sequence[FittedCurve]) -> Iterator[str]:
    if tested.of_the_law:
        worst = max(curves, key=lambda curve: curve.error)
        told = f"the values found do not reproduce the curves (Ljung-Box, p = {tested.probability:.1g})"
        cause = f"{told}: the model errs by about {100.0 * worst.error:.2g} % of the peak, or a low pass changed the"
        rest = "curves, or the noise is coloured (--corner); values and intervals are not to be trusted, these"
        yield f"{cause} {rest} {widened:.2g} times as wide as those of noise"
    elif not tested.noise:
        told = f"neighbouring rows of what is left are opposed (Ljung-Box, p = {tested.probability:.1g})"
        cause = "no law's error is so, but noise of less memory than it was taken for"
        yield f"{told}: {cause}; the intervals are not to be trusted; cure: --corner of the instrument, or none"


def _of_the_model(
    histories: Histories, sought: Array, parameters: Mapping[str, Interval], by_law: bool
) -> Iterator[str]:
    """Effects that the law (``by_law``), or the scene's own model, leaves out, larger than the narrowest half interval.

    A number errs by about as large a share as the force does, and no residual shows it.
    """
    noises = [noise.deviation / one.peak for noise, one in zip(histories.noises, histories.samples, strict=True)]
    least = min((one.share for one in parameters.values() if one.share is not None), default=max(noises))
    largest = dict[str, LedgerEntry]()
    for one in histories.samples:
        scene = histories.file.scene(histories.keys, sought[: len(histories.keys)], one.own)
        found = simulate(ting.of(scene), scene, LEDGER_TOLERANCE)
        ledger = found.model_ledger if by_law else model_ledger(scene, Peak.of(found.quantities, found.history))
        for entry in ledger:
            before = largest.get(entry.effect, entry)
            largest[entry.effect] = max(before, entry, key=lambda one: one.size)
    left = sorted((entry for entry in largest.values() if entry.size > least), key=lambda entry: -entry.size)
    if left:
        said = ", ".join(f"{entry.effect} ({percent(entry.size)})" for entry in left)
        certain = sorted(left, key=lambda entry: not entry.exceeds(least))
        keyed = [entry for entry in certain if entry.key.startswith("model.")]
        cure = f"; cure for {keyed[0].effect}: --method fe --set {keyed[0].setting}" if keyed else ""
        yield f"left out, up to so much of the peak force: {said}; the intervals hold the noise alone{cure}"


def _of_a_low_pass(histories: Histories, sought: Array, parameters: Mapping[str, Interval]) -> Iterator[str]:
    """Whether what coloured the noise moves the likeliest place out of an interval if it filtered the force too.

    By the slopes there: how far is not told, for a low pass delays too, and the touch is far from where it would be.
    """
    changes = [
        _filtered_less(one.force - left, noise)
        for one, left, noise in zip(histories.samples, histories.differences(sought), histories.noises, strict=True)
    ]
    moved = sought + np.linalg.pinv(histories.slopes(sought)) @ np.concatenate(changes)
    told = [
        key.name
        for key, place in zip(histories.keys, moved.tolist(), strict=False)
        if not parameters[key.name].holds(key.at(place))
    ]
    if told:
        cause = "the noise is coloured as by a low pass; if that filtered the force too, the intervals of"
        yield f"{cause} {', '.join(told)} do not hold their values; cure: --low-pass HZ, or a faster instrument"


def _filtered_less(force: Array, noise: Noise) -> Array:
    """A force through the low pass that gives white noise this colour, less itself, as the residuals are seen.

    Zeros where the colour is none of a low pass. Seen so the filtered force is the force times 1 - sum a_k.
    """
    colour, total = noise.colour, float(noise.colour.sum())
    change = (1.0 - total) * force[colour.size :] - whitened(force, colour)
    return change / noise.deviation if 0.0 < total < 1.0 else np.zeros_like(change)


def _of_the_sample(posterior: Posterior | None, valleys: Sequence[ToldValley]) -> Iterator[str]:
    if posterior is not None and posterior.effective < ENOUGH:
        draws = len(posterior.values)
        more = f"{1.5 * draws * ENOUGH / posterior.effective:.1g}"
        told = f"{draws} draws tell as much as {posterior.effective:.0f} independent ones"
        yield f"{told}, and the ends of a band need {ENOUGH}; cure: --sample {float(more):.0f}"
    if posterior is not None and len(valleys) > 1:
        yield "walkers hardly pass from one valley to another: how many draws lie in each says nothing"


def _of_the_reference(found: ByReference | None, parameters: Mapping[str, Interval]) -> Iterator[str]:
    if found is None:
        return
    for name, one in found.parameters.items():
        known = parameters[name]
        if known.low is not None and known.high is not None and 2.0 * one.bar > known.high - known.low:
            moved = f"{name}: the finite elements' bars can move it by {one.bar:.2g}"
            yield f"{moved}, more than half of its interval; cure: a smaller --tolerance"
    if found.others:
        yield f"finite elements corrected the likeliest of {found.others + 1} valleys alone"
