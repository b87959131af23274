"""Equilibrium of a body that yields, under a striker: one stiffness serves several depths, flow is a load.

With the stiffness K of a body as it answered once, a displacement u is in balance where

    K u + p(u) = h ,    h = K u - f(u) ,

f what the body answers and p what the striker presses with. For a guess of h the rest is a contact on a linear body,
solved exactly at its surface alone, behind which K is eliminated. Its end tells another h, and Anderson's mixing closes
in, as it does for a body in motion (:mod:`fe_contact.dynamics.flow`). On a mesh that grows with the contact all steps
are nearly alike, so that K serves several of them. Where guesses close in slowly, K is made anew: the tangent at that
of least energy, of which the first guess is Newton's step, shortened until the energy falls.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.assembly.interior import Eliminated, elimination_order
from fe_contact.dynamics.flow import Mixing
from fe_contact.solids.base import PointAnswer, State
from fe_contact.solids.bulk import CoredBody, Loaded, Pattern
from fe_contact.solids.contact import Points, Skin
from lumped.errors import NotReached
from lumped.materials.plasticity import PlasticStep, Yielding

SETTLED = 1e-5  # measured: out of balance, of the forces that press; with 1e-7 the largest force changes by 3e-6
FAR = 0.3  # work: of the same, from where a stiffness is made anew at once
WORTH = 7.0  # work: guesses to go for which it is: as dear as that, on coarse meshes and on fine ones
GUESSES, RENEWED = 12, 60  # work: at most, of one stiffness, and of these; a step that needs more is made in halves
LOWER = 1e-12  # rounding: of the energy
SHORTEST = 1e-3  # share of Newton's step below which the energy stands still
CLOSED = 1e-11  # rounding: of the energy of a contact on a linear body, which is a small part of what it is told by
MOST_CLOSINGS = 60  # work: two or three are usual
ENOUGH = 1e-4  # share of what the slope promises that a step has to lessen that energy by


class FlowUnsettled(NotReached):
    """No equilibrium was found."""

    def __init__(self) -> None:
        super().__init__("the flow did not settle")


class Springs(NamedTuple):
    """The penalty between a striker and the points (n,) of a skin: how far it overlaps these where nothing is
    displaced, and the stiffness of every point's spring.
    """

    overlap: Array
    stiffness: Array

    def within(self, rise: Array) -> Array:
        """How far points that rose (n,) are inside the striker, (n,); below zero outside."""
        return self.overlap + rise

    def pressed(self, rise: Array) -> Array:
        """Forces at these points, (n,)."""
        return np.asarray(self.stiffness * np.maximum(self.within(rise), 0.0))

    def energy(self, rise: Array) -> float:
        """Of the springs."""
        return 0.5 * float(self.pressed(rise) @ np.maximum(self.within(rise), 0.0))


@dataclass(frozen=True, eq=False)
class Deformation:
    """A body displaced by (2 N,): what has ``flowed``, the ``forces`` (free,) that it answers with, how far the points
    of its skin rose (n,), the ``energy`` of body and springs.
    """

    displacement: Array
    flowed: PlasticStep
    forces: Array
    rise: Array
    energy: float


@dataclass(frozen=True, eq=False)
class Stiffness:
    """Of a body by its free degrees of freedom, and what is left of it at its surface."""

    matrix: Matrix
    eliminated: Eliminated


class FlowEquilibrium(NamedTuple):
    """Equilibrium ``at`` a displacement, found in so many ``guesses``; the ``stiffness`` it was found with."""

    at: Deformation
    guesses: int
    stiffness: Stiffness


@dataclass(frozen=True, eq=False)
class YieldingBody:
    """A body with a core that yields, whose ``skin`` a striker meets along the vertical.

    The last m of its free degrees of freedom are those of its surface along that: ``reach`` (n, m) tells by them how
    far the n points of the skin rise. ``pattern`` of the body's matrix.
    """

    cored: CoredBody
    skin: Skin
    yielding: Yielding
    reach: Array
    pattern: Pattern

    @classmethod
    def of(cls, body: CoredBody, skin: Skin, yielding: Yielding) -> YieldingBody:
        """Raises nothing: makes the pattern, its rows in the order of their elimination."""
        along = skin.dofs[:, 1::2]
        surface = np.unique(along)
        blocks = [body.core.dofs, body.rim[None]]
        inner = np.setdiff1d(body.free, surface)
        order = elimination_order(Pattern.of(blocks, inner, body.core.size).definite)
        free = np.concatenate([inner[order], surface])
        reach = np.zeros((*skin.weights.shape, surface.size))
        facets, points = np.ogrid[: along.shape[0], : skin.weights.shape[1]]
        reach[facets[..., None], points[..., None], np.searchsorted(surface, along)[:, None]] = skin.trace
        pattern = Pattern.of(blocks, free, body.core.size)
        return cls(replace(body, free=free), skin, yielding, reach.reshape(-1, surface.size), pattern)

    def displaced(self, displacement: Array, springs: Springs, state: State) -> Deformation:
        """By (2 N,), after ``state``."""
        body, core = self.cored, self.cored.core
        flowed = self.yielding.flowed(core.gradient(displacement), *state)
        loaded = Loaded(core, PointAnswer(flowed.stress, np.zeros((5, 5)), flowed.energy))
        pulled = np.zeros(core.size)
        pulled[body.rim] = body.rest @ displacement[body.rim]
        rise = self.reach @ displacement[body.free[-self.reach.shape[1] :]]
        energy = loaded.energy + 0.5 * float(displacement @ pulled) + springs.energy(rise)
        return Deformation(displacement, flowed, (loaded.forces + pulled)[body.free], rise, energy)

    def stiffness(self, here: Deformation) -> Stiffness:
        """The tangent of a body."""
        return self._tangent(here.flowed)

    def _tangent(self, flowed: PlasticStep) -> Stiffness:
        body = self.cored
        loaded = Loaded(body.core, PointAnswer(flowed.stress, flowed.tangent, flowed.energy))
        matrix = self.pattern.matrix([loaded.matrices(), body.rest[None]])
        return Stiffness(matrix, Eliminated.of(matrix, self.reach.shape[1]))

    @cached_property
    def elastic(self) -> Stiffness:
        """Of a body in which nothing flows: no tangent is stiffer, so that steps with it always lessen the energy."""
        none = np.zeros((5, *self.cored.core.weight.shape))
        return self._tangent(self.yielding.flowed(none, none[:4], none[0]))

    def settled(
        self,
        start: Array,
        springs: Springs,
        state: State,
        touching: Points,
        stiffness: Stiffness | None = None,
    ) -> FlowEquilibrium:
        """From a displacement (2 N,) and points (n,) that touch to begin with. Raises FlowUnsettled.

        A tangent of points that flow without hardening may lead so far that no part of its way does: then the body's
        elastic stiffness goes on.
        """
        here, guesses = self.displaced(start, springs, state), 0
        for _ in range(RENEWED):
            known = stiffness or self.stiffness(here)
            flow = Guesses(self, known, springs, state, anew=stiffness is None)
            try:
                here, more, balanced = flow.closed_in(here, touching if guesses == 0 else None)
            except FlowUnsettled:
                if stiffness is not None:
                    raise
                stiffness, guesses = self.elastic, guesses + 1
                continue
            guesses += more
            if balanced:
                return FlowEquilibrium(here, guesses, known)
            stiffness = None
        raise FlowUnsettled


@dataclass(frozen=True, eq=False)
class Guesses:
    """Guesses of what a body holds beside one ``stiffness``, under a striker; ``anew``: that is the tangent where they
    begin.
    """

    body: YieldingBody
    stiffness: Stiffness
    springs: Springs
    state: State
    anew: bool

    def closed_in(self, here: Deformation, touching: Points | None) -> tuple[Deformation, int, bool]:
        """Where guesses from ``here`` led, how many they were, and whether it is in balance there; if not, it is the
        one of least energy.
        """
        free, matrix = self.body.cored.free, self.stiffness.matrix
        guess, mixing = matrix @ here.displacement[free] - here.forces, Mixing()
        best, missed = here, list[float]()
        for number in range(1, GUESSES + 1):
            there = self._under(guess, here, touching if number == 1 else None)
            if self.anew and number == 1 and not there.energy <= here.energy + LOWER * abs(here.energy):
                return self._shorter(here, there), number, False
            pressing = self.body.reach.T @ self.springs.pressed(there.rise)
            missing = matrix @ there.displacement[free] - there.forces - guess
            missed.append(float(np.linalg.norm(missing)) / max(float(np.linalg.norm(pressing)), np.finfo(float).tiny))
            if missed[-1] <= SETTLED:
                return there, number, True
            here = there
            if number == 1 or there.energy < best.energy:
                best = there
            if slow(missed):
                break
            guess = mixing.next(guess, missing)
        return best, number, False

    def _under(self, guess: Array, here: Deformation, touching: Points | None) -> Deformation:
        """A linear body that holds a guess (free,), and the striker; it closes from ``here``."""
        free, reach, solve = self.body.cored.free, self.body.reach, self.stiffness.eliminated.solve
        surface = reach.shape[1]
        closed = self._closed(solve(guess)[-surface:], here.displacement[free[-surface:]], touching)
        load = guess.copy()
        load[-surface:] -= reach.T @ self.springs.pressed(reach @ closed)
        displacement = np.zeros_like(here.displacement)
        displacement[free] = solve(load)
        return self.body.displaced(displacement, self.springs, self.state)

    def _closed(self, alone: Array, begin: Array, touching: Points | None) -> Array:
        """The surface (m,) that is ``alone`` (m,) without the striker, under it: Newton's steps, by falling energy.

        They begin with points (n,) that touch, or without these from a surface (m,). A tangent that flows gives way so
        far without the striker that the gap of :func:`fe_contact.contact.problem.solve`, a difference from there, would
        keep two digits; a surface that is mended step by step keeps all.
        """
        schur, reach, springs = self.stiffness.eliminated.schur, self.body.reach, self.springs

        def touched(touching: Points) -> tuple[Array, Array]:
            """How k points rise with the surface, (k, m), and that times their stiffness."""
            moved = reach[touching]
            return moved, springs.stiffness[touching, None] * moved

        def energy(surface: Array) -> float:
            moved = surface - alone
            return 0.5 * float(moved @ schur @ moved) + springs.energy(reach @ surface)

        surface = begin
        if touching is not None:
            touching = touching & np.isfinite(springs.overlap)
            moved, stiff = touched(touching)
            load = schur @ alone - stiff.T @ springs.overlap[touching]
            surface = np.asarray(np.linalg.solve(schur + moved.T @ stiff, load), dtype=float)
        here = energy(surface)
        for _ in range(MOST_CLOSINGS):
            rise = reach @ surface
            within = springs.within(rise) > 0.0
            slope = schur @ (surface - alone) + reach.T @ springs.pressed(rise)
            moved, stiff = touched(within)
            step = -np.asarray(np.linalg.solve(schur + moved.T @ stiff, slope), dtype=float)
            share = 1.0
            there = energy(surface + step)
            while there > here + ENOUGH * share * float(slope @ step) + CLOSED * abs(here) and share > SHORTEST:
                share *= 0.5
                there = energy(surface + share * step)
            surface, here = surface + share * step, there
            if share == 1.0 and np.array_equal(springs.within(reach @ surface) > 0.0, within):
                return surface
        raise FlowUnsettled

    def _shorter(self, here: Deformation, there: Deformation) -> Deformation:
        """The first half, quarter ... of the way at which the energy is lower. Raises FlowUnsettled."""
        way, share = there.displacement - here.displacement, 0.5
        while share > SHORTEST:
            there = self.body.displaced(here.displacement + share * way, self.springs, self.state)
            if there.energy <= here.energy + LOWER * abs(here.energy):
                return there
            share *= 0.5
        raise FlowUnsettled


def slow(missed: list[float]) -> bool:
    """Whether guesses that missed by these shares close in more slowly than a new stiffness is worth."""
    if missed[-1] > FAR:
        return True
    if len(missed) == 1:
        return False
    back = min(len(missed) - 1, 2)
    rate = (missed[-1] / missed[-1 - back]) ** (1.0 / back)
    return bool(rate >= 1.0 or np.log(SETTLED / missed[-1]) / np.log(rate) > WORTH)
