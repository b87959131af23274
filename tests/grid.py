"""Whether the plan keeps its word: error, bar and cost of random impacts against a grid of settings. A script, no test.

    python tests/grid.py FOLDER [--kinds KIND ...] [--scenes N] [--seed N] [--seconds S] [--dear S]

Draws N scenes of every kind, each with a tolerance. The truth is the exact law of the scene's model where one answers,
else finite elements at a quarter of the tolerance, known to their bar. The cost is processor time in one process, one
thread, from nothing but loaded modules: every operator is built again, error bars included. What the default costs
stands beside the cheapest of a grid about the settings with which it ended, orders {2, 3, 4} x half, once and twice the
elements x half, once and twice the steps, all fixed, bars included: of all whose error is within the tolerance, and of
those whose bar says so too. A setting that takes longer than the cheapest of the latter so far is given up. Scenes
whose default takes longer than ``--dear`` tell error and bar alone, and count in no share of the cost.

A line a scene is kept in the folder, so that a run that was broken off goes on where it stood. Prints shares by kind,
and draws the ratios.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import math
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from fe_contact.methods import exact_laws
from fe_contact.settings import Given, Numerics, WaveNumerics
from fe_contact.studies import style
from fe_contact.studies.tradeoff.point import Answer, Truth
from fe_contact.studies.tradeoff.tried import by_elements, by_law, fixed
from lumped import BadInput, FeContactError, Scene
from lumped.result.result import RULED_RELATIVE
from lumped.shapes._block import Block
from lumped.targets.rod import Rod

sys.path.insert(0, str(Path(__file__).parent / "fe"))
import test_bars_everywhere as everywhere
import test_flat_impacts as flat_ends
import test_layer_waves as layer_waves
import test_pair_impacts as pairs
import test_wide_sweep_waves as waves

Draw = Callable[[np.random.Generator], Scene]
Line = dict[str, Any]

SEED, SCENES = 20261127, 25
TOLERANCES = {False: (1e-4, 1e-2), True: (1e-3, 1e-2)}  # with inertia: tighter ones take minutes
EXACT, KNOWN = 1e-7, 0.1  # asked of laws; share of the tolerance to which a truth has to be known
FINER = 0.25  # of the tolerance, where no law is exact
ORDERS, SHARES = (4, 3, 2), (0.5, 1.0, 2.0)
BRIEF, REPEATS = 0.4, 3  # s; what takes less is run so often where it counts, and the least time is taken
SLACK = 1.05  # of the cheapest so far, before a setting is given up
HOPELESS = 20.0  # times the default's cost, where that misses the tolerance
GOAL = 2.0  # times the cheapest of the grid
HEIGHT = 3.2  # of the chart's panel, in


def seeded(draw: Callable[[int], Scene]) -> Draw:
    return lambda rng: draw(int(rng.integers(2**31)))


def waving(draw: Callable[[np.random.Generator, int], Mapping[str, Any]]) -> Draw:
    return lambda rng: Scene.from_dict({**draw(rng, int(rng.integers(60))), "model": {"inertia": True}})


def bulk(rng: np.random.Generator) -> Scene:
    """A layer or a ring of constant bulk modulus, which a fluid does not have."""
    while True:
        scene = (everywhere.layer, everywhere.ring)[rng.integers(2)](rng)
        material = scene.geometry.material
        if material.young.equilibrium > 0.0:
            with suppress(BadInput):
                return replace(scene, material=replace(material, nu=float(rng.uniform(0.3, 0.49)), constant="bulk"))


def waving_layer(rng: np.random.Generator) -> Scene:
    return layer_waves.random_layer(rng, str(rng.choice(["elastic", "prony"])))


KINDS: dict[str, Draw] = {
    **everywhere.KINDS,
    "flat end": seeded(flat_ends.random_scene),
    "spheres": seeded(pairs.random_spheres),
    "half-plane": seeded(pairs.random_half_plane),
    "true size": seeded(pairs.random_true_size),
    "bulk": bulk,
    "waves: ball": waving(waves.ball),
    "waves: rod": waving(waves.rod),
    "waves: block": waving(waves.block),
    "waves: layer": waving_layer,
}


@dataclass(frozen=True)
class Tried:
    """Settings and what came of them: ``cpu``, s, largest ``error`` and ``bar`` that a tolerance rules, in terms of it.

    ``of``: the quantity that errs most; ``why``: there is no answer; ``operations`` counted.
    """

    order: int
    elements: float
    steps: int
    cpu: float
    error: float = math.inf
    bar: float = math.inf
    of: str = ""
    why: str = ""
    operations: float = math.inf

    def meets(self, tolerance: float) -> bool:
        """Whether the error does."""
        return self.error <= tolerance

    def says(self, tolerance: float) -> bool:
        """Whether the bar does too."""
        return self.error <= tolerance and self.bar <= tolerance

    @property
    def settings(self) -> str:
        """In short."""
        return f"o{self.order} e{self.elements:.2f} n{self.steps}"


class TooLong(BaseException):
    """What runs has taken its processor time: no failure that anybody answers for."""


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Raises TooLong after so much processor time."""

    def stop(*_: object) -> None:
        raise TooLong

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds if math.isfinite(seconds) else 0.0)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


class Attempt(NamedTuple):
    """What finite elements answer, processor time, s, and why they do not."""

    answer: Answer | None
    cpu: float
    why: str = ""


def attempt(scene: Scene, given: Given, most: float = math.inf, repeats: int = 1) -> Attempt:
    """Once, or several times where that is brief; given up after so many seconds."""
    spent = list[float]()
    while len(spent) < repeats and sum(spent) < repeats * BRIEF:
        start = time.process_time()
        try:
            with at_most(SLACK * most):
                answer = by_elements(scene, given)
        except (FeContactError, TooLong, ctypes.ArgumentError) as failure:  # which it is where gmsh is called
            return Attempt(None, time.process_time() - start, str(failure) or "dearer")
        spent.append(time.process_time() - start)
    return Attempt(answer, min(spent))


@dataclass(frozen=True)
class Judge:
    """A scene's ``tolerance`` and its ``truth``, by a law of this ``name`` or by finite elements."""

    scene: Scene
    tolerance: float
    name: str
    truth: Truth

    @classmethod
    def of(cls, scene: Scene, tolerance: float) -> Judge:
        """By the cheapest exact law that has an answer, else finer finite elements. Raises FeContactError."""
        for name in exact_laws(scene):
            with suppress(FeContactError):
                answer = by_law(scene, name, {"tolerance": EXACT})
                if (answer.bar or 0.0) < KNOWN * tolerance:
                    return cls(scene, tolerance, name, Truth.of(answer))
        return cls(scene, tolerance, "fe", Truth.of(by_elements(scene, {"tolerance": FINER * tolerance})))

    def tried(self, settings: Given, found: Attempt) -> Tried:
        """What came of settings, less what the truth may be off."""
        order, elements, steps = (settings[key] for key in ("order", "elements_per_contact", "steps"))
        answer = found.answer
        if answer is None:
            return Tried(order, elements, steps, found.cpu, why=found.why)
        errors = self.errors(answer)
        of = max(errors, key=lambda name: errors[name])
        error = max(errors[of] - self.truth.bar, 0.0)
        return Tried(order, elements, steps, found.cpu, error, answer.bar or 0.0, of, "", answer.work["operations"])

    def errors(self, answer: Answer) -> dict[str, float]:
        """Of every quantity that a tolerance rules and that the truth knows."""
        found = {}
        for name in (*RULED_RELATIVE, "restitution"):
            true, value = self.truth.values[name], answer.values[name]
            if true is not None:
                off = math.inf if value is None else abs(value - true)
                found[name] = off / (1.0 if name == "restitution" else abs(true))
        return found | {"history_l2": self.truth.errors(answer, not self.scene.model.inertia)["history"]}


def grid(scene: Scene, base: Numerics) -> Iterator[Given]:
    """Fixed settings about those of a default; on a line, of which a wave crosses one element in a step, the steps."""
    on_a_line = scene.model.inertia and (isinstance(scene.target, Rod) or isinstance(scene.shape, Block))
    orders, shares = ((base.order,), (1.0,)) if on_a_line else (ORDERS, SHARES)
    found = []
    for order, share, longer in product(orders, shares, SHARES):
        steps, elements = max(4 * round(base.steps * longer / 4), 8), max(share * base.elements_per_contact, 1.0)
        found.append(base.varied(order=order, steps=steps, elements_per_contact=elements))
    return map(fixed, dict.fromkeys(found))


def measured(kind: str, number: int, seed: int, dear: float) -> Line:
    """One scene: its line."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind), number])
    scene = KINDS[kind](rng)
    tolerance = float(np.exp(rng.uniform(*np.log(TOLERANCES[scene.model.inertia]))))
    line = {"kind": kind, "number": number, "seed": seed, "tolerance": tolerance}
    found = attempt(scene, {"tolerance": tolerance}, repeats=REPEATS)
    if found.answer is None:
        return line | {"why": found.why}
    try:
        judge = Judge.of(scene, tolerance)
    except FeContactError as failure:
        return line | {"why": f"no truth: {failure}"}
    default = judge.tried(found.answer.settings, found)
    base = (WaveNumerics if scene.model.inertia else Numerics)(**found.answer.settings)
    others = [asdict(one) for one in around(judge, default, base)] if found.cpu <= dear else []
    return line | {"truth": judge.name, "known": judge.truth.bar, "default": asdict(default), "grid": others}


def around(judge: Judge, default: Tried, base: Numerics) -> list[Tried]:
    """The grid; what is cheapest of it is timed again."""
    found, given = list[Tried](), list(grid(judge.scene, base))
    least = default.cpu if default.says(judge.tolerance) else HOPELESS * default.cpu
    for settings in given:
        found.append(judge.tried(settings, attempt(judge.scene, settings, least)))
        if found[-1].says(judge.tolerance):
            least = min(least, found[-1].cpu)
    for serves in (Tried.meets, Tried.says):
        serving = [place for place, one in enumerate(found) if serves(one, judge.tolerance)]
        for place in sorted(serving, key=lambda place: found[place].cpu)[:1]:
            again = attempt(judge.scene, given[place], repeats=REPEATS - 1)
            found[place] = replace(found[place], cpu=min(again.cpu, found[place].cpu))
    return found


class Verdict(NamedTuple):
    """A line judged: error and bar over the tolerance, cost over the cheapest that meets it by error, and by bar.

    Not a number where no grid was tried.
    """

    kind: str
    error: float
    bar: float
    by_error: float
    by_bar: float


def verdict(line: Line) -> Verdict | None:
    """None without an answer or without a truth."""
    if "default" not in line:
        return None
    tolerance, default = line["tolerance"], Tried(**line["default"])
    tried = [default, *(Tried(**one) for one in line["grid"])]
    least = [
        min((one.cpu for one in tried if line["grid"] and serves(one, tolerance)), default=math.nan)
        for serves in (Tried.meets, Tried.says)
    ]
    return Verdict(
        line["kind"], default.error / tolerance, default.bar / tolerance, *(default.cpu / one for one in least)
    )


def said(line: Line) -> str:
    """A line in words."""
    start, judged = f"{line['kind']:12} {line['number']:3} at {line['tolerance']:.1e}", verdict(line)
    if judged is None:
        return f"{start}: {line['why']}"
    tolerance, default = line["tolerance"], Tried(**line["default"])
    tried = [default, *(Tried(**one) for one in line["grid"])]
    best = min((one for one in tried if one.says(tolerance)), key=lambda one: one.cpu, default=default)
    return (
        f"{start} by {line['truth']}: error {judged.error:.3f} and bar {judged.bar:.3f} of it, {default.cpu:.3f} s, "
        f"{judged.by_error:.2f} and {judged.by_bar:.2f} times the cheapest; {default.settings}, best {best.settings}"
    )


def table(lines: list[Line]) -> str:
    """Shares by kind: error and bar within the tolerance, cost within the goal by error and by bar, and its median."""
    rows = [
        "| kind | scenes | error met | bar met | cost by error | cost by bar | median |\n|---|---|---|---|---|---|---|"
    ]
    for kind in (*KINDS, "all"):
        alike = [line for line in lines if kind in (line["kind"], "all")]
        found = [one for one in map(verdict, alike) if one is not None]
        if found:
            tried = [one for one in map(verdict, (line for line in alike if line.get("grid"))) if one is not None]
            shares = (
                f"{sum(which)} of {len(which)}"
                for which in (
                    [one.error <= 1.0 for one in found],
                    [one.bar <= 1.0 for one in found],
                    [one.by_error <= GOAL for one in tried],
                    [one.by_bar <= GOAL for one in tried],
                )
            )
            median = np.nanmedian([one.by_bar for one in found])
            rows.append(f"| {kind} | {len(alike)} | {' | '.join(shares)} | {median:.2f} |")
    return "\n".join(rows) + "\n"


def draw(lines: list[Line], where: Path) -> None:
    """The cost over the cheapest of the grid, sorted within every kind."""
    found = [one for one in map(verdict, lines) if one is not None]
    kinds = [kind for kind in KINDS if any(one.kind == kind for one in found)]
    words = [
        "Processor time of the default over that of the cheapest of the grid that meets the tolerance, bars included."
    ]
    with style.sheet(where, "grid", "What the plan costs", words, HEIGHT, width=120, below=0.9) as sheet:
        (axes,) = sheet.panels(1, 1, 0.08, 0.98)
        for place, kind in enumerate(kinds):
            for name, colour in (("by_error", style.ORANGE), ("by_bar", style.BLUE)):
                ratios = np.sort([getattr(one, name) for one in found if one.kind == kind])
                across = place + 0.8 * (np.arange(ratios.size) + 0.5) / ratios.size - 0.4
                said = {"by_error": "by its error", "by_bar": "by its bar"}[name] if place == 0 else None
                axes.plot(across, ratios, "o", ms=2.5, color=colour, label=said)
        axes.axhline(GOAL, color=style.GREY, lw=0.8)
        axes.set(yscale="log", ylabel="cost over the cheapest")
        axes.set_xticks(range(len(kinds)), kinds, rotation=40, ha="right")
        style.plain_numbers(axes.yaxis)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--kinds", nargs="*", choices=list(KINDS), default=list(KINDS), metavar="KIND")
    parser.add_argument("--scenes", type=int, default=SCENES, help="of every kind")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--seconds", type=float, default=math.inf, help="by the clock, after which no scene is begun")
    parser.add_argument("--dear", type=float, default=math.inf, help="of the default, beyond which no grid is tried")
    asked = parser.parse_args()
    os.environ["FE_CONTACT_CACHE"] = "off"
    asked.folder.mkdir(parents=True, exist_ok=True)
    file, end, warm = asked.folder / "grid.jsonl", time.monotonic() + asked.seconds, set[str]()
    lines = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []
    known = {(line["kind"], line["number"], line["seed"]) for line in lines}
    left = [one for one in product(range(asked.scenes), asked.kinds) if (one[1], one[0], asked.seed) not in known]
    with threadpool_limits(1):
        for number, kind in left:
            if time.monotonic() > end:
                break
            if kind not in warm:  # what it imports is loaded
                attempt(KINDS[kind](np.random.default_rng(0)), {"tolerance": TOLERANCES[False][1]})
                warm.add(kind)
            lines.append(measured(kind, number, asked.seed, asked.dear))
            with file.open("a", encoding="utf-8") as out:
                out.write(json.dumps(lines[-1]) + "\n")
            sys.stdout.write(said(lines[-1]) + "\n")
            sys.stdout.flush()
    sys.stdout.write(table(lines))
    draw(lines, asked.folder)


if __name__ == "__main__":
    main()
