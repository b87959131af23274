"""The verdict of a trade-off, in words: what to use, how far the defaults lie from the front, whether bars cover."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from fe_contact.methods import spell
from fe_contact.settings import RANGES
from fe_contact.studies.tradeoff.point import REFERENCE, Point

NEAR = 1.5  # a default that costs at most this multiple of the cheapest setting that does as well is near the front
WIDEST = RANGES["tolerance"][1]  # the loosest tolerance that is accepted
ALWAYS = ("order", "elements_per_contact", "steps")  # settings that are said of every choice; others where they differ
WORDS = {"elements_per_contact": "elements"}

Measure = Callable[[Point], float]


def verdict(points: Sequence[Point], tolerance: float) -> tuple[str, ...]:
    """Advice first; then a sentence a default, what errors are measured from, whether bars cover."""
    tried = finite_elements(points)
    sentences = [distance(point, points) for point in tried if point.default_for is not None]
    return (advice(points, tolerance), *sentences, known(points), *([covered(tried, points)] if tried else []))


def advice(points: Sequence[Point], tolerance: float) -> str:
    """The cheapest method that serves a tolerance, and the cheapest settings of finite elements that do."""
    serving = sorted((p for p in points if serves(p, points, tolerance)), key=lambda p: p.cpu)
    elements = next((point for point in serving if point.method == "fe"), None)
    if elements is None:
        tried = any(point.method == "fe" for point in points)
        instead = f"no finite elements tried meet {tolerance:g}" if tried else "finite elements need a geometry"
    else:
        instead = settings_of(elements, points)
    if not serving:
        return f"nothing that was tried meets {tolerance:g}"
    if serving[0] is elements:
        return f"use finite elements: {instead}"
    law = serving[0]
    start = f"use {law.method} ({spell(law.cpu)}, {brief(law.bar or 0.0)})"
    return f"{start}; if finite elements: {instead}" if elements else f"{start}; {instead}"


def serves(point: Point, points: Iterable[Point], tolerance: float) -> bool:
    """Whether a method claims the tolerance for the scene's model, and rightly as far as errors are known."""
    if point.failure or point.leaves_out or point.method == REFERENCE or point.bar is None:
        return False
    return point.bar <= tolerance and point.error <= point.bar + known_to(points)


def settings_of(point: Point, points: Iterable[Point]) -> str:
    """A choice of settings in words, with what differs from the default's, its time and its bar."""
    default = next((p for p in points if p.method == "fe" and p.default_for is not None), point)
    differing = [
        key
        for key in ("enforcement", "penalty", "far_radius", "scheme", "mass")
        if point.settings.get(key) != default.settings.get(key)
    ]
    said = []
    for key in (*ALWAYS, *differing):
        word, value = WORDS.get(key, key.replace("_", " ")), point.settings[key]
        text = f"{value:.3g}" if isinstance(value, float) else str(value).replace("_", " ")
        said.append(f"{text} {word}" if key in ALWAYS[1:] else f"{word} {text}")
    return f"{', '.join(said)}, {spell(point.cpu)}, bar {brief(point.bar or 0.0)}"


def brief(number: float) -> str:
    """A small number to one digit: 2e-4."""
    digits, _, power = f"{number:.0e}".partition("e")
    return f"{digits}e{int(power)}"


def distance(point: Point, points: Sequence[Point]) -> str:
    """What a default costs beside the cheapest finite elements that do as well."""
    assert point.default_for is not None
    tolerance, tried = point.default_for, finite_elements(points)
    start = f"default for {tolerance:g}: error {brief(point.error)}, bar {brief(point.bar or 0.0)}"
    if (point.bar or 0.0) > tolerance:
        return f"{start}; misses the tolerance"
    times = excess(point, [other for other in tried if serves(other, points, tolerance)])
    if times == 1.0:
        return f"{start}; on the front: nothing tried meets the tolerance for less"
    place = f"within {NEAR:g} of the front" if times <= NEAR else "off the front"
    return f"{start}; {times:.2f} times the cheapest whose bar meets the tolerance: {place}"


def excess(point: Point, others: Iterable[Point]) -> float:
    """Processor time of a point over the least of it and of others."""
    return point.cpu / min([point.cpu, *(other.cpu for other in others)])


def finite_elements(points: Iterable[Point]) -> tuple[Point, ...]:
    """The finite-element points that have an answer."""
    return tuple(point for point in points if point.method == "fe" and not point.failure)


def judged(points: Iterable[Point]) -> tuple[Point, ...]:
    """All points that have an answer, but for the one that errors are measured from."""
    return tuple(point for point in points if point.method != REFERENCE and not point.failure)


def front(points: Iterable[Point], cost: Measure, merit: Measure) -> tuple[Point, ...]:
    """Points than which none is at once cheaper and better, the cheapest first."""
    best, found = np.inf, []
    for point in sorted(points, key=lambda p: (cost(p), merit(p))):
        if merit(point) < best:
            best = merit(point)
            found.append(point)
    return tuple(found)


def known_to(points: Iterable[Point]) -> float:
    """The bar of what errors are measured from, the widest of several."""
    return max((point.bar or 0.0 for point in points if point.method == REFERENCE), default=0.0)


def known(points: Iterable[Point]) -> str:
    """What errors are measured from, and how well that is known."""
    said = [f"{p.settings['from']}, known to {brief(p.bar or 0.0)}" for p in points if p.method == REFERENCE]
    return f"errors are measured from {'; from '.join(said)}"


def covered(tried: Sequence[Point], points: Sequence[Point]) -> str:
    """Of the settings that claim anything: a bar beyond every accepted tolerance says that nothing is known."""
    claiming = [point for point in tried if (point.bar or 0.0) <= WIDEST]
    covered = sum(point.error <= (point.bar or 0.0) + known_to(points) for point in claiming)
    said = f"the claimed bar covers the error in {covered} of {len(claiming)} settings of finite elements"
    silent = len(tried) - len(claiming)
    return f"{said}; {silent} claim nothing below {WIDEST:g}" if silent else said
