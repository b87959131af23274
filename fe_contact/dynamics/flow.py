"""Plastic flow of a body in motion: a load of its own, found together with the motion.

A body that yields answers by its linear stiffness, less what its plastic strain holds: nodal forces

    f = K u - h ,    h = integral of B^T 2G e_p ,

where the plastic strain e_p at the end of a step follows from the displacement there. So h is a fixed point: a step
under a guess of it is a linear one, whose factors serve all steps, and its end tells another h. By itself that closes
in slowly where a body flows freely, since every flow that no elastic strain opposes is found again only in part;
Anderson's mixing of the last guesses (1965, doi 10.1145/321296.321305; Walker and Ni 2011, doi 10.1137/10078356X) makes
of it a method as quick as GMRES is for a linear system. Where most of what strains flows, that is slow, too: there the
guess is of h - H u, H nearly all that h changes by with u, and the step is one of the softer stiffness K - H.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.errors import FlowNotSettled

SETTLED = 1e-4  # measured: what a step leaves out of balance, of the forces; a force moves by a third of that
# Work: guesses of a step, some ten are usual; each time that it is softened, and how often that is at most.
FIRST, LATER, AGAIN = 40, 10, 20
SOFTENED = 0.95  # safety: of what flow takes away of the stiffness; all of it would let a body flow away
MIXED = 12  # last guesses that are mixed: as many directions as flow takes in a step, about
DEPENDENT = 1e-8  # rounding: of the largest change of a guess, below which another one tells nothing new


class Flowed(NamedTuple):
    """Plastic flow of a body at an instant: ``strain`` (4, e, p) and its ``amount`` (e, p) at points that may yield,
    the nodal ``forces`` (N,) that it holds, N, and how these ``grew`` (N,) in the last step; J: elastic energy that it
    ``stores`` by itself, and the plastic work so far.
    """

    strain: Array
    amount: Array
    forces: Array
    grew: Array
    stores: float
    worked: float

    def elastic(self, displacement: Array) -> float:
        """What it adds to the elastic energy of a displacement (N,), J."""
        return self.stores - float(displacement @ self.forces)

    def spent(self, displacement: Array) -> float:
        """The same, and the plastic work so far, J."""
        return self.elastic(displacement) + self.worked


class Yields(Protocol):
    """What may flow in a body of N degrees of freedom."""

    @property
    def at_rest(self) -> Flowed:
        """Nothing has flowed yet."""

    def flowed(self, displacement: Array, before: Flowed) -> Flowed:
        """At the end of a step, displaced so (N,), after ``before``."""

    def softening(self, displacement: Array, before: Flowed) -> Matrix:
        """Derivative (N, N) of the forces by the displacement at the end of such a step."""

    def check(self, flowed: Flowed, time: float) -> None:
        """Raise NotReached where more flows than may, at a time, s."""


def flow_of_step(
    change_with: Callable[[Matrix | None], Callable[[Array], Array]],
    displacement: Array,
    yields: Yields,
    before: Flowed,
    time: float,
) -> tuple[Flowed, Array]:
    """A step's end with its flow, and the increment of the ``displacement`` (N,) in it. Raises FlowNotSettled, and what
    ``change_with`` does.

    That makes of a matrix H (N, N), None: none, what tells the increment d (N,) where the plastic strain holds H d and
    forces (N,) that are guessed. Where few guesses do not close in, H is how the flow last found changes what it holds.
    """
    softening, guess = None, before.forces + before.grew
    for guesses in (FIRST, *AGAIN * [LATER]):
        change_under, mixing = change_with(softening), Mixing()
        for _ in range(guesses):
            change = change_under(guess)
            found = yields.flowed(displacement + change, before)
            missing = found.forces - guess - (0.0 if softening is None else softening @ change)
            if np.linalg.norm(missing) <= SETTLED * np.linalg.norm(found.forces):
                yields.check(found, time)
                return found, change
            guess = mixing.next(guess, missing)
        softening = SOFTENED * yields.softening(displacement + change, before)
        guess = found.forces - softening @ change
    raise FlowNotSettled(time)


class Mixing:
    """Anderson's: the next guess is that of the last ones' mean which misses least."""

    def __init__(self) -> None:
        self._last: tuple[Array, Array] | None = None
        self._changes: list[tuple[Array, Array]] = []

    def next(self, guess: Array, missing: Array) -> Array:
        """After a guess (n,) and what it misses, (n,)."""
        if self._last is not None:
            self._changes.append((guess - self._last[0], missing - self._last[1]))
            del self._changes[:-MIXED]
        self._last = guess, missing
        if not self._changes:
            return guess + missing
        guesses, misses = (np.stack(column, axis=1) for column in zip(*self._changes, strict=True))
        shares = np.linalg.lstsq(misses, missing, rcond=DEPENDENT)[0]
        return np.asarray(guess + missing - (guesses + misses) @ shares)
