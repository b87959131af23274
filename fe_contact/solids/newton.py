"""Equilibrium of a body that is not linear under a striker: Newton's method with a line search on the energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.interior import elimination_order, factorized
from fe_contact.solids.base import State, elliptic
from fe_contact.solids.bulk import CoredBody, Loaded, Pattern
from fe_contact.solids.contact import Obstacle, Points, Skin, Touch
from lumped.errors import NotReached
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.shapes import Shape

HASTY = 8  # work: whole steps before giving them up
ASTRAY = 2  # work: whole steps in a row that promise more than the one before, which lead nowhere
MOST_ITERATIONS = 60  # work: a step that needs more is made in halves
SETTLED = 1e-9  # of the energy: the step that changes it by no more is the last one
ENOUGH = 1e-4  # share of what the slope promises that a step has to lessen the energy by
ROUNDING = 1e-14  # of the energy: a trial may be higher by so much
BLUNT = 0.05  # work: a share of Newton's step that is shorter says that its tangent is no guide
FALLING = ((False, False), (True, False), (True, True))  # models of a body: convex, at rest
MODELS = (FALLING, FALLING, FALLING[2:])  # to begin with, after one blunt step and after two
WAYS = 20  # work: of the striker, tried for a depth below a datum
NEAR_WAY = 1e-3  # of a depth: ways that differ by less have their ends by whole steps
LEAST_DEEPENED = 1e-3  # rounding: of a way, what it adds to the depth
SHORTEST = 1e-4  # share of a Newton step below which the energy stands still


class EquilibriumLost(NotReached):
    """Newton's method found no equilibrium: the body folds, or strain left the range of its material.

    ``owner``: the table of a scene file that the material stands in; ``less``: what strains it less.
    """

    def __init__(self, reason: str, owner: str = "target", less: str = "smaller depths") -> None:
        super().__init__(reason, f"{less}, or another {owner}.material.hyperelastic")

    def of(self, owner: str, less: str) -> EquilibriumLost:
        """The same of the material in another table."""
        return EquilibriumLost(self.reason, owner, less)


class BeyondRange(EquilibriumLost):
    """In equilibrium at this ``depth`` waves of some direction have no speed in the material: here it ends."""

    def __init__(self, depth: float, owner: str = "target", less: str = "smaller depths") -> None:
        reason = f"from a depth of {depth:.3g} m on the material softens so that strains gather in bands"
        super().__init__(reason, owner, less)
        self.depth = depth

    def of(self, owner: str, less: str) -> BeyondRange:
        """The same of the material in another table."""
        return BeyondRange(self.depth, owner, less)


@contextmanager
def material_of(pressed: Indenter | Scene) -> Iterator[None]:
    """Inside, what is lost names the material that is ``pressed``, and what strains it less: under a tip no depth does.

    Raises EquilibriumLost.
    """
    try:
        yield
    except EquilibriumLost as lost:
        less = "a blunter striker" if has_tip(pressed.profile) else "smaller depths"
        raise lost.of(pressed.target.owner, less) from lost


def has_tip(profile: Shape) -> bool:
    """Whether strains grow without bound towards the axis, at any depth alike."""
    return float(profile.slope(np.zeros(()))) > 0.0


@dataclass(frozen=True, eq=False)
class Encounter:
    """A body whose ``skin`` a striker meets; its matrix has one ``pattern``; ``covered``: all of the skin at once."""

    body: CoredBody
    skin: Skin
    pattern: Pattern
    obstacle: Obstacle
    covered: bool = False

    @classmethod
    def of(cls, body: CoredBody, skin: Skin, obstacle: Obstacle) -> Encounter:
        """Raises nothing: makes the pattern, its rows in the order of their elimination."""
        blocks = [body.core.dofs, skin.dofs, body.rim[None]]
        first = Pattern.of(blocks, body.free, body.core.size)
        ordered = replace(body, free=body.free[elimination_order(first.definite)])
        return cls(ordered, skin, Pattern.of(blocks, ordered.free, body.core.size), obstacle)

    @property
    def follows(self) -> bool:
        """Whether the striker follows a datum that moves with the body: then no energy is least in equilibrium."""
        return bool(self.body.datum.any())

    @property
    def held(self) -> Encounter:
        """The same with the datum held where it is."""
        return replace(self, body=replace(self.body, datum=np.zeros_like(self.body.datum)))

    def at(
        self, displacement: Array, depth: float, stiffness: float, state: State = (), touching: Points | None = None
    ) -> Balance:
        """Body and striker with the mesh displaced so, (2 N,), after ``state``; ``touching`` as of a skin."""
        loaded = self.body.core.answered(displacement, self.body.response, state)
        way = depth - float(self.body.datum @ displacement)
        touch = self.skin.pressed(displacement, self.obstacle, way, stiffness, touching)
        return Balance(self, displacement, depth, state, loaded, touch)


@dataclass(frozen=True, eq=False)
class Balance:
    """Energy, its derivative and second derivative by the free degrees of freedom, at a ``depth`` below the datum."""

    encounter: Encounter
    displacement: Array
    depth: float
    state: State
    loaded: Loaded
    touch: Touch

    @cached_property
    def energy(self) -> float:
        """Of core and rest, and of the penalty, J."""
        body = self.encounter.body
        rim = self.displacement[body.rim]
        return self.loaded.energy + float(rim @ (0.5 * body.rest @ rim + body.pull)) + self.touch.energy

    @property
    def way(self) -> float:
        """Of the striker: where a datum goes down with the body, longer than the depth."""
        return self.depth - float(self.encounter.body.datum @ self.displacement)

    @property
    def taken(self) -> float:
        """Energy that the striker brought along the depth: a datum, far below, moves in proportion to the force."""
        return self.energy - 0.5 * self.force * (self.way - self.depth)

    @property
    def force(self) -> float:
        """On the striker."""
        return self.touch.force

    @cached_property
    def residual(self) -> Array:
        """Forces that are not balanced, (free,)."""
        body = self.encounter.body
        return (body.forces(self.loaded, self.displacement) + self.touch.forces)[body.free]

    def factors(
        self,
        convex: bool = False,
        unstrained: bool = False,
        pulls: Array | None = None,
        meets: Points | None = None,
    ) -> Callable[[Array], Array]:
        """Back-substitution (free,) for the tangent. Raises EquilibriumLost where a point is to touch a striker that
        ends before.

        ``convex``: without what the striker's bend takes; ``unstrained``: of a body at rest; ``pulls`` (2, elements,
        points) in place of the body's own; ``meets``: points that count as touching too.
        """
        with np.errstate(invalid="ignore"):
            loaded = self._at_rest if unstrained else self.loaded if pulls is None else self.loaded.under(pulls)
            touch = self.touch if meets is None else replace(self.touch, touching=self.touch.touching | meets)
            blocks = [loaded.matrices(), touch.matrices(convex), self.encounter.body.rest[None]]
            tangent = self.encounter.pattern.matrix(blocks)
        if not np.isfinite(tangent.data).all():
            raise EquilibriumLost(f"the contact is as wide as the striker at depth {self.depth:.3g}")
        return self._below_datum(factorized(tangent, ordered=True), touch)

    def _below_datum(self, solve: Callable[[Array], Array], touch: Touch) -> Callable[[Array], Array]:
        """Back-substitution at the same depth, by that at the same way: as the datum comes up, so does the striker."""
        if not self.encounter.follows:
            return solve
        body = self.encounter.body
        datum = body.datum[body.free]
        follows = solve(touch.stiffening[body.free])
        share = follows / (1.0 - datum @ follows)

        def solved(forces: Array) -> Array:
            found = solve(forces)
            return np.asarray(found + share * (datum @ found))

        return solved

    @property
    def _at_rest(self) -> Loaded:
        body = self.encounter.body
        return body.core.answered(np.zeros_like(self.displacement), body.response, self.state)


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A ``balance`` found in so many ``iterations``.

    ``rate`` (2 N,): its displacement by the depth, and ``softened`` (2 N,) what the penalty's softness takes from it,
    to first order, both by the last factors, which are those of a place next to it.
    """

    balance: Balance
    rate: Array
    softened: Array
    iterations: int

    def predicted(self, depth: float) -> Array:
        """Displacement to begin another depth with, (2 N,)."""
        return self.balance.displacement + (depth - self.balance.depth) * self.rate

    def foreseen(self, depth: float) -> Array | None:
        """The body's pulls there, (2, elements, points)."""
        return self.balance.loaded.foreseen(self.predicted(depth) - self.balance.displacement)

    def elliptic(self, depth: float) -> bool:
        """Whether the material bears waves of every direction everywhere, here and as it goes on to a ``depth``."""
        here, body = self.balance, self.balance.encounter.body
        onwards = body.core.answered(self.predicted(depth), body.response, here.state)
        known = [here.loaded] if np.isinf(onwards.energy) else [here.loaded, onwards]
        return all(elliptic(loaded.answer.tangent) for loaded in known)

    @property
    def rigid_force(self) -> float:
        """On the striker if the penalty were rigid, to first order in its softness.

        Along the same way it is the slope of the energy; what a datum gives way to that lengthens the way.
        """
        touch, datum = self.balance.touch, self.balance.encounter.body.datum
        by_way = 1.0 - datum @ self.rate
        given_way = self.stiffness / by_way * (datum @ self.softened)
        return float(2.0 * touch.force + touch.forces @ self.rate / by_way - given_way)

    @property
    def stiffness(self) -> float:
        """Of the force, by the depth."""
        stiffening, datum = self.balance.touch.stiffening, self.balance.encounter.body.datum
        return float(stiffening[1::2].sum() * (1.0 - datum @ self.rate) + stiffening @ self.rate)

    @property
    def rigid(self) -> tuple[Array, Loaded]:
        """Displacement (2 N,) and core if the penalty were rigid, to first order in its softness.

        As they are where that would turn an element inside out.
        """
        here, body = self.balance, self.balance.encounter.body
        displacement = here.displacement + self.softened
        loaded = body.core.answered(displacement, body.response, here.state)
        return (displacement, loaded) if np.isfinite(loaded.energy) else (here.displacement, here.loaded)

    @property
    def error(self) -> float:
        """What another iteration would change of the force, of it."""
        balance = self.balance
        left = float(self.rate[balance.encounter.body.free] @ balance.residual)
        return abs(left) / max(balance.force, np.finfo(float).tiny)


def balanced(
    encounter: Encounter,
    start: Array,
    depth: float,
    stiffness: float,
    state: State = (),
    touching: Points | None = None,
    settled: float = SETTLED,
    foreseen: Array | None = None,
    hasty: bool = False,
) -> Equilibrium:
    """From a displacement (2 N,) to begin with. Raises EquilibriumLost.

    ``touching``: points (facets, points) that are to touch in the first iteration; ``settled``: of the energy, what the
    last one still changes; ``foreseen``: the body's pulls there, as of :meth:`Loaded.foreseen`; ``hasty``: whether to
    give up where no whole steps lead there.
    """

    def at(displacement: Array) -> Balance:
        return encounter.at(displacement, depth, stiffness, state)

    here = at(start)
    if not np.isfinite(here.energy):
        raise EquilibriumLost("an element is inverted")
    if touching is not None:
        guess = encounter.at(start, depth, stiffness, state, touching)
        change = _whole(guess, guess.factors(pulls=foreseen)(-guess.residual))
        guided = at(start + change)
        if np.isfinite(guided.energy):
            here, foreseen = guided, guess.loaded.foreseen(change)
    found = _hastened(here, at, settled, foreseen)
    if found is not None:
        return found
    if hasty:
        raise EquilibriumLost(f"no equilibrium in {HASTY} whole steps")
    return _with_held_datum(here, at, settled) if encounter.follows else _descending(here, at, settled)


def _hastened(
    here: Balance, at: Callable[[Array], Balance], settled: float, foreseen: Array | None
) -> Equilibrium | None:
    """By whole steps, each with a tangent by the pulls that the one before foresaw; None where they do not lead there.

    A step errs by its square, which a nearly incompressible body answers by a pressure that means nothing: as a part of
    the tangent it spoils the next step (the mixed integration points of Magisano, Leonetti and Garcea 2017).
    """
    known: Callable[[Array], Array] | None = None
    before, grown = np.inf, 0
    for iteration in range(1, HASTY + 1):
        step = None if known is None else known(-here.residual)
        if known is None or step is None or abs(here.residual @ step) > settled * abs(here.energy):
            known = here.factors(pulls=foreseen)
            step = known(-here.residual)
        change = _whole(here, step)
        there = at(here.displacement + change)
        if not np.isfinite(there.energy):
            return None
        promised = abs(float(here.residual @ step))
        if promised <= settled * abs(here.energy):
            return _equilibrium(there, known, iteration)
        before, grown = promised, grown + 1 if promised > before else 0
        if grown == ASTRAY:
            return None
        foreseen = here.loaded.foreseen(change)
        if not np.array_equal(here.touch.touching, there.touch.touching):
            known = None
        here = there
    return None


def _with_held_datum(here: Balance, at: Callable[[Array], Balance], settled: float) -> Equilibrium:
    """By ways of the striker, each with the datum held, where an energy is least. Raises EquilibriumLost."""
    encounter, datum, depth, way = here.encounter, here.encounter.body.datum, here.depth, here.way
    for _ in range(WAYS):
        held = balanced(encounter.held, here.displacement, way, here.touch.stiffness, here.state, settled=settled)
        here = at(held.balance.displacement)
        if abs(here.way - way) <= NEAR_WAY * depth:
            found = _hastened(here, at, settled, None)
            if found is not None:
                return found
        longer = (here.way - way) / max(1.0 + float(datum @ held.rate), LEAST_DEEPENED)
        way += float(np.clip(longer, -0.5 * way, way))
    raise EquilibriumLost(f"no way of the striker ends at this depth below the datum in {WAYS} tries")


def _descending(here: Balance, at: Callable[[Array], Balance], settled: float) -> Equilibrium:
    """By steps that lessen the energy. Raises EquilibriumLost.

    After a blunt one the next counts as touching what that one meets, after two it is of a body at rest, too.
    """
    blunt, none = 0, np.zeros_like(here.touch.touching)
    meets = none
    for iteration in range(1, MOST_ITERATIONS + 1):
        solve, step = _step(here, MODELS[min(blunt, 2)], meets)
        slope = float(here.residual @ step)
        if not blunt and -slope <= settled * abs(here.energy):
            return _equilibrium(at(here.displacement + _whole(here, step)), solve, iteration)
        found = _descended(here, step, slope, at)
        if found.share == 0.0 and blunt >= 2 and not np.any(found.meets & ~meets):
            raise EquilibriumLost("the energy has no descent")
        here = found.balance
        blunt, meets = (blunt + 1, meets | found.meets) if found.share < BLUNT else (0, none)
    raise EquilibriumLost(f"no equilibrium in {MOST_ITERATIONS} iterations")


def _equilibrium(there: Balance, solve: Callable[[Array], Array], iterations: int) -> Equilibrium:
    """With what depth and penalty change of it, by factors from next to it."""
    free = there.encounter.body.free
    rate, softened = (_whole(there, solve(-by[free])) for by in (there.touch.stiffening, there.touch.forces))
    return Equilibrium(there, rate, softened, iterations)


def _step(
    here: Balance, models: tuple[tuple[bool, bool], ...], meets: Points
) -> tuple[Callable[[Array], Array], Array]:
    """Factors and Newton's step (free,) by the first of some models, convex or at rest, by which energy falls."""
    for convex, unstrained in models:
        solve = here.factors(convex, unstrained, meets=meets)
        step = solve(-here.residual)
        if here.residual @ step <= 0.0:
            return solve, step
    raise EquilibriumLost("the body is not stable")


def _whole(here: Balance, free: Array) -> Array:
    """Of all degrees of freedom (2 N,)."""
    found = np.zeros_like(here.displacement)
    found[here.encounter.body.free] = free
    return found


class Descent(NamedTuple):
    """A ``balance`` at a ``share`` of a step, 0 for none; ``meets``: points that touch a little further on."""

    balance: Balance
    share: float
    meets: Points


def _descended(here: Balance, step: Array, slope: float, at: Callable[[Array], Balance]) -> Descent:
    """The end of the step, or the nearest place towards it of less energy."""
    whole, share = _whole(here, step), 1.0
    there = beyond = at(here.displacement + whole)
    while not there.energy <= here.energy + ENOUGH * share * slope + ROUNDING * abs(here.energy):
        share *= 0.5
        if share <= SHORTEST:
            return Descent(here, 0.0, there.touch.touching)
        there, beyond = at(here.displacement + share * whole), there
    return Descent(there, share, beyond.touch.touching)
