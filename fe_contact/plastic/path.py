"""A body that yields, pressed step by step and released: forces along the way, and what is left.

Plastic flow is no function of where a contact is: every point comes under its edge and goes on inward, so that the
strains turn within a step. Backward Euler then errs by a tenth of the step (1.2 % of the force at 10 % in depth, thirty
times as deep as the first yield). Two stages of it err by the square of the step, and end where stress has come back to
yield: the diagonally implicit Runge-Kutta method of Alexander 1977 (doi 10.1137/0714068), gamma = 1 - 1/sqrt(2); after
the first one, what flowed flows on as much from the start of the step up to 1 - gamma. A release is all but elastic:
there backward Euler is exact.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.errors import MemoryTooSmall
from fe_contact.plastic.ground import GUARD, Ground
from fe_contact.plastic.settling import FlowUnsettled, Stiffness
from fe_contact.progress import Counted, uncounted
from fe_contact.solids.base import State
from lumped.errors import NotReached

GUESSED = 0.3  # of the pressure: where the one given is further off it is given again
GIVEN = 4  # times at most
GAMMA = 1.0 - math.sqrt(0.5)  # share of a step that each stage takes
HALVINGS = 4  # of a step that does not settle
ELASTIC_RATIO = 1.5  # of successive depths where nothing yields
MISFIT, FITTED = 0.01, 4  # of the mesh's scale by the contact radius: beyond, it is fitted again, so often at most
RELEASED = 0.015  # of what springs back: the last depth of a release before the surfaces part
FIRST_RELEASED = 0.02  # of the depth that would spring back under a flat end: the first step of a release


class PlasticFlowLost(NotReached):
    """No equilibrium was found at one depth."""

    def __init__(self, depth: float) -> None:
        cure = "raise numerics.steps, lower numerics.penalty, or a larger target.material.hardening_modulus"
        super().__init__(f"plastic flow at depth {depth:.3g} m did not settle", cure)


class PlasticZoneWide(NotReached):
    """The body flows further from the contact than it may."""

    def __init__(self, when: str, core: float) -> None:
        cure = "a lower striker.velocity or mass, or a higher target.material.yield_strength"
        super().__init__(f"at {when} flow reaches {GUARD * core:.2g} contact radii, further than is meshed", cure)


class PlasticFlowSlow(NotReached):
    """More guesses were taken than there is work for."""

    def __init__(self, depth: float, most: int) -> None:
        cure = "a lower striker.velocity or mass, or a larger target.material.hardening_modulus"
        super().__init__(f"plastic flow takes more than {most} guesses up to depth {depth:.3g} m", cure)


class Station(NamedTuple):
    """A body pressed ``depth`` deep: force, contact radius, in units of the ground; on its mesh, ``scale`` long in
    these units, displacement (2 N,) in units of the mesh, state, pressure (q,). ``worked``: plastic work so far, in
    units of the ground; ``middle``: the end of the first stage of the step that led here.
    """

    depth: float
    displacement: Array
    state: State
    force: float
    pressure: Array
    radius: float
    scale: float = 1.0
    worked: float = 0.0
    middle: Station | None = None


class Counts(NamedTuple):
    """Of contact problems, and guesses of what flows in them."""

    problems: int = 0
    iterations: int = 0

    def __add__(self, other: tuple[int, ...]) -> Counts:  # type: ignore[override]
        return Counts(self.problems + other[0], self.iterations + other[1])


@dataclass(eq=False)
class Presser:
    """Takes a ground from place to place; ``penalty`` in units of E* over contact radius; ``unit`` m, for words;
    ``spread``: the power of the depth that a contact radius is expected to grow with; ``most`` guesses in all;
    ``counted`` is told of every contact problem; ``known``: the stiffness that the last one was solved with.
    """

    ground: Ground
    penalty: float
    unit: float
    spread: float = 0.5
    most: int | None = None
    counted: Counted = uncounted
    counts: Counts = field(default_factory=Counts)
    known: Stiffness | None = None

    def settled(
        self, state: State, depth: float, displacement: Array, pressure: Array, radius: float, scale: float
    ) -> Station:
        """Equilibrium at a depth after ``state`` on a mesh ``scale`` long; the other three are guesses.

        The penalty only mends the pressure given: where that is far off, it is given again. Raises FlowUnsettled.
        """
        ground, stiffness = self.ground, self.penalty * scale / radius
        areas, touching = ground.body.skin.weights.ravel(), ground.points < radius / scale
        for number in range(GIVEN):
            last = number == GIVEN - 1
            springs = ground.springs(scale, depth / scale, stiffness, pressure)
            found = ground.body.settled(displacement, springs, state, touching, self.known)
            self._count(found.guesses, depth)
            within, forces = springs.within(found.at.rise), springs.pressed(found.at.rise)
            wrong = float(np.abs(forces - areas * pressure).sum()) > GUESSED * float(forces.sum())
            displacement, pressure, touching = found.at.displacement, forces / areas, within > 0.0
            self.known = found.stiffness
            if not wrong or last:
                break
        after, reached = (found.at.flowed.strain, found.at.flowed.amount), self._edge(within)
        if not np.isfinite(reached):
            raise MemoryTooSmall(self.unit * scale)
        if not ground.contained(after):
            raise PlasticZoneWide(f"depth {self.unit * depth:.3g} m", ground.core)
        return Station(depth, displacement, after, float(forces.sum()) * scale**2, pressure, reached * scale, scale)

    def _count(self, guesses: int, depth: float) -> None:
        self.counts += (1, guesses)
        self.counted(1.0)
        if self.most is not None and self.counts.iterations > self.most:
            raise PlasticFlowSlow(self.unit * depth, self.most)

    def _edge(self, within: Array) -> float:
        """Where the gap closes, by how far points are ``within`` the striker (q,).

        That is between the last point that touches and the next: the gap opens as the power 3/2 of the distance from
        there (Johnson, Contact Mechanics, 1985, 5.1), which two points tell.
        """
        if self.ground.rim:
            return 1.0
        points, inside = self.ground.points, np.flatnonzero(within > 0.0)
        last = int(inside[-1]) if inside.size else 0
        if last + 2 >= points.size:
            return np.inf
        first, second = np.maximum(-within[last + 1 : last + 3], 0.0) ** (2.0 / 3.0)
        back = first / (second - first) if second > first else np.inf
        return float(max(points[last + 1] - back * (points[last + 2] - points[last + 1]), points[last]))

    def loaded(self, before: Station, here: Station, depth: float, halvings: int = HALVINGS) -> Iterator[Station]:
        """End of the step from ``here`` to a depth, or ends of its halves where it does not settle.

        ``before``: the end of the step before, along which this one is guessed; ``here`` itself where there is none.
        Raises PlasticFlowLost.
        """
        try:
            yield self._stepped(before, here, depth)
            return
        except FlowUnsettled:
            if halvings == 0:
                raise PlasticFlowLost(self.unit * depth) from None
        last = here
        for found in self.loaded(before, here, 0.5 * (here.depth + depth), halvings - 1):
            before, last = last, found
            yield found
        yield from self.loaded(before, last, depth, halvings - 1)

    def _stepped(self, before: Station, here: Station, depth: float) -> Station:
        """Two stages. Raises FlowUnsettled."""
        stage, spread = here.depth + GAMMA * (depth - here.depth), self._spread_of(before, here)
        like = before.middle or before, here.middle or here
        middle, began = self._stage(here.state, like, here, stage, spread)
        on = (1.0 - GAMMA) / GAMMA
        state = tuple(start + on * (flowed - start) for start, flowed in zip(began, middle.state, strict=True))
        there, _ = self._stage(state, (before, here), middle, depth, spread)
        return self._worked(here, there._replace(middle=middle))

    def _worked(self, here: Station, there: Station) -> Station:
        """``there`` with the work of the step from ``here``: a mesh that has grown tells no more what was done when it
        was small.
        """
        ground, (strain, amount) = self.ground, here.state
        began = ground.carried((strain[:0], amount), there.scale / here.scale)  # work: no strain is asked for
        more = there.scale**3 * (ground.worked(there.state) - ground.worked(began))
        return there._replace(worked=here.worked + more)

    def _spread_of(self, before: Station, here: Station) -> float:
        """The power of the depth that the contact radius grows with now."""
        if before.radius == here.radius:
            return self.spread
        return math.log(here.radius / before.radius) / math.log(here.depth / before.depth)

    def _stage(
        self, state: State, like: tuple[Station, Station], here: Station, depth: float, spread: float
    ) -> tuple[Station, State]:
        """From ``here`` to a depth after ``state``, and that state on the mesh there.

        Guessed, in units of the mesh: it goes on as from one to the other end of two stages ``like`` it, those of the
        steps before; the contact radius as a power of the depth.
        """
        first, last = like
        on = math.log(depth / last.depth) / math.log(last.depth / first.depth) if last is not first else 0.0
        start = last.displacement + on * (last.displacement - first.displacement)
        pressure = np.maximum(last.pressure + on * (last.pressure - first.pressure), 0.0)
        ground, radius = self.ground, here.radius * (depth / here.depth) ** spread
        for _ in range(FITTED):
            scale = 1.0 if ground.rim else max(radius, here.scale)  # what has flowed in is not told again
            growth = scale / here.scale
            began = ground.carried(state, growth)
            found = self.settled(began, depth, start, pressure, scale, scale)
            radius = found.radius
            if abs(radius / scale - 1.0) < MISFIT or growth == 1.0:
                break
            start, pressure = found.displacement, found.pressure
        return found, began

    def first(self, depth: float, radius: float) -> Station:
        """From rest to a first depth at once, with a contact radius to expect. Raises PlasticFlowLost."""
        ground, body = self.ground, self.ground.body
        displacement, pressure = np.zeros(body.cored.core.size), np.zeros(body.skin.weights.size)
        for _ in range(FITTED):
            scale = radius
            found = self._projected(ground.rest, depth, displacement, pressure, radius, scale)
            displacement, pressure, radius = found.displacement, found.pressure, found.radius
            if abs(radius / scale - 1.0) < MISFIT:
                break
        return found._replace(worked=found.scale**3 * ground.worked(found.state))

    def _projected(
        self, state: State, depth: float, displacement: Array, pressure: Array, radius: float, scale: float
    ) -> Station:
        try:
            return self.settled(state, depth, displacement, pressure, radius, scale)
        except FlowUnsettled:
            raise PlasticFlowLost(self.unit * depth) from None

    def released(self, here: Station, steps: int, power: float) -> list[Station]:
        """Places of a release, ``here`` first, until hardly anything springs back; force ~ what is left^``power``."""
        found = [here, self._released(here, here, here.depth - FIRST_RELEASED * here.force / (2.0 * here.radius))]
        for number in range(1, steps + 1):
            ends = parting(found[-2], found[-1], power)
            whole = here.depth - ends
            left = max((1.0 - number / (steps + 1.0)) ** 1.5, RELEASED)
            depth = min(ends + left * whole, found[-1].depth - 0.25 * whole / steps)
            if depth <= ends + 0.5 * RELEASED * whole:
                break
            found += self._let_go(found[-2], found[-1], depth)
        return found

    def _let_go(self, before: Station, here: Station, depth: float, halvings: int = HALVINGS) -> list[Station]:
        """Ends of a step back, or of its halves where it does not settle. Raises PlasticFlowLost."""
        try:
            return [self._released(before, here, depth)]
        except PlasticFlowLost:
            if halvings == 0:
                raise
        first = self._let_go(before, here, 0.5 * (here.depth + depth), halvings - 1)
        return [*first, *self._let_go([here, *first][-2], first[-1], depth, halvings - 1)]

    def _released(self, before: Station, here: Station, depth: float) -> Station:
        """A step back, from a place reached by one from ``before``."""
        share = 1.0
        start = here.displacement
        if before is not here:
            way = (depth - here.depth) / (here.depth - before.depth)
            start = start + way * (here.displacement - before.displacement)
            share = max(1.0 + way * (1.0 - before.force / here.force), 0.05)
        radius = here.radius * (1.0 if self.ground.rim else share ** (1.0 / 3.0))
        pressure = _shrunk(self.ground.points, here, radius, share if self.ground.rim else share ** (1.0 / 3.0))
        return self._worked(here, self._projected(here.state, depth, start, pressure, radius, here.scale))


def _shrunk(points: Array, here: Station, radius: float, share: float) -> Array:
    """A ``share`` of the pressure of a place, on a smaller contact radius; radii of ``points`` of the mesh (n,)."""
    found = np.interp(points * (here.radius / radius), points, here.pressure)
    within = points < radius / here.scale
    return np.asarray(share * np.where(within, found, 0.0))


def parting(before: Station, here: Station, power: float) -> float:
    """Depth at which a release ends, by the line through two places of force^(1/power)."""
    first, second = before.force ** (1.0 / power), here.force ** (1.0 / power)
    return float(here.depth - second * (before.depth - here.depth) / (first - second))
