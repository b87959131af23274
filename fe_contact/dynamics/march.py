"""The loop: from a body and the choices of a run to its motion.

First touch and separation within a step, from what is known at its ends. How many stages a step of central difference
needs: 2/omega_max, bounded without an eigenvalue.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.dynamics import ledger
from fe_contact.dynamics.body import BodyState, BodyWithMass, undeformed
from fe_contact.dynamics.ledger import Energies
from fe_contact.dynamics.schemes.base import Scheme
from fe_contact.dynamics.stepping import Enforced, ExplicitStepper, ImplicitStepper
from fe_contact.errors import ContactLost, MotionUnbounded, TooManySteps
from lumped.errors import BadInput, Fault

MOST_STEPS = 200_000  # of a small body: a minute and a half, nearly all of it beside the unknowns
MOST_WORK = 3e8  # unknowns times steps, of a large one: some eight minutes of one core
ROUNDING = 1e-9  # of times that are sums of steps
UNBOUNDED = 1e6  # multiple of the fastest that gravity and the start explain
JUST_SAFE = 1e-9  # rounding of a stage that just keeps the limit


@dataclass(frozen=True, eq=False)
class Choices:
    """How a motion is solved: scheme, enforcement, length of the steps, s, and the times, s, at which that doubles."""

    scheme: Scheme
    enforced: Enforced
    step: float
    doubled: tuple[float, ...] = ()

    def length(self, time: float) -> float:
        """Length of the step that begins at a time, s."""
        return float(self.step * 2 ** sum(time >= at * (1 - ROUNDING) for at in self.doubled))


class Moment(NamedTuple):
    """A body in motion at an instant, and its ledger so far."""

    state: BodyState
    energies: Energies


class Sample(NamedTuple):
    """What one step leaves behind, at its end: s, N, the step's share of the impulse, N s; overlaps, their rates and
    signed pressures (q,); displacement and velocity of the watched places (k,), energies, Newton iterations.
    """

    time: float
    force: float
    impulse: float
    overlap: Array
    closing: Array
    signed_pressure: Array
    displacement: Array
    velocity: Array
    energies: Energies
    iterations: int


@dataclass(frozen=True, eq=False)
class Motion:
    """A march from its first sample, at the start, to its last; ``final`` state; ``stages`` of every step."""

    samples: tuple[Sample, ...]
    final: BodyState
    stages: int

    @cached_property
    def time(self) -> Array:
        """(n,) s."""
        return np.array([sample.time for sample in self.samples])

    @cached_property
    def force(self) -> Array:
        """(n,) N."""
        return np.array([sample.force for sample in self.samples])

    @cached_property
    def contacts(self) -> tuple[tuple[float, float], ...]:
        """First touch and separation of every contact, s; the last may end with the march."""
        found, start = list[tuple[float, float]](), None
        touching = self.force > 0.0
        if touching[0]:
            start = self.samples[0].time
        for before, after, was, now in zip(self.samples, self.samples[1:], touching, touching[1:], strict=False):
            step = after.time - before.time
            if now and not was:
                start = touched(before.time, step, before.overlap, before.closing)
            elif was and not now and start is not None:
                end = parted(before.time, step, before.signed_pressure, after.signed_pressure)
                found.append((start, end))
                start = None
        return tuple(found if start is None else [*found, (start, self.samples[-1].time)])

    @property
    def seen(self) -> tuple[tuple[float, float], ...]:
        """The contacts, one at least; raises ContactLost where the only ones began and ended within a step."""
        if not self.contacts:
            raise ContactLost(self.samples[-1].time)
        return self.contacts


def touched(time: float, step: float, overlap: Array, closing: Array) -> float:
    """When the first open point closes, s, in a step from ``time`` that ends in touch; overlaps (q,) at its start."""
    coming = closing > 0.0
    if not coming.any():
        return time + step
    return time + float(np.clip(np.min(-overlap[coming] / closing[coming]), 0.0, step))


def parted(time: float, step: float, held: Array, open_: Array) -> float:
    """When the last point opened, s, in a step from ``time``: the signed pressures (q,) at its ends, along a line."""
    last, beyond = float(held.max()), float(open_.max())
    return time + step * last / (last - beyond)


def march(
    body: BodyWithMass,
    velocity: Array,
    choices: Choices,
    end_time: float,
    watch: Array,
    finished: Callable[[Sample], bool] = lambda sample: False,
) -> Motion:
    """Move an undeformed body with ``velocity`` (N,) until ``end_time``, s, or until a sample says it is finished.

    ``watch`` (k, N): weights of the displacements that are recorded.

    Raises ContactNotSettled, MotionUnbounded or TooManySteps; BadInput for a scheme that the body does not admit.
    """
    state = undeformed(body, velocity)
    return onwards(body, Moment(state, ledger.opened(body, state)), choices, end_time, watch, finished)


def onwards(
    body: BodyWithMass,
    begun: Moment,
    choices: Choices,
    end_time: float,
    watch: Array,
    finished: Callable[[Sample], bool],
) -> Motion:
    """The same from a moment on, with which another ``end_time``, s, and the lengths of the steps begin anew."""
    parts = stages(body, choices.enforced, choices.step) if choices.scheme.staged else 1
    stepper = _stepper(body, choices, choices.step / parts)
    state, energies, start = stepper.begun(begun.state), begun.energies, begun.state.time
    fastest = UNBOUNDED * (np.abs(state.velocity).max() + np.abs(body.gravity).max() * end_time)
    samples, most = [_sample(body, state, 0.0, watch, energies, 0)], min(MOST_STEPS, int(MOST_WORK / body.size))
    while state.time - start < end_time * (1 - ROUNDING):
        if (len(samples) - 1) * parts >= most:
            raise TooManySteps(most, state.time)
        length = choices.length(state.time - start) / parts
        if length != stepper.step:
            stepper = _stepper(body, choices, length)
        impulse, iterations = 0.0, 0
        for _ in range(parts):
            before = state
            state, found = stepper.advance(before)
            if not np.abs(state.velocity).max() <= fastest:  # nan is no less
                raise MotionUnbounded(state.time)
            energies = ledger.entered(energies, body, choices.scheme, before, state)
            impulse += _impulse(body, before, state)
            iterations += found.iterations
        samples.append(_sample(body, state, impulse, watch, energies, iterations))
        if finished(samples[-1]):
            break
    return Motion(tuple(samples), state, parts)


def _stepper(body: BodyWithMass, choices: Choices, step: float) -> ExplicitStepper | ImplicitStepper:
    kind: type[ExplicitStepper | ImplicitStepper] = ExplicitStepper if choices.scheme.explicit else ImplicitStepper
    return kind(body, choices.scheme, choices.enforced, step)


def _impulse(body: BodyWithMass, before: BodyState, after: BodyState) -> float:
    """N s from one state to the next, by the forces there."""
    return (after.time - before.time) * 0.5 * float(body.pressing.weights @ (before.pressure + after.pressure))


def _sample(
    body: BodyWithMass, state: BodyState, impulse: float, watch: Array, energies: Energies, iterations: int
) -> Sample:
    return Sample(
        time=state.time,
        force=float(body.pressing.weights @ state.pressure),
        impulse=impulse,
        overlap=body.pressing.overlap(state.displacement),
        closing=body.pressing.closing(state.velocity),
        signed_pressure=state.signed_pressure,
        displacement=watch @ state.displacement,
        velocity=watch @ state.velocity,
        energies=energies,
        iterations=iterations,
    )


def stages(body: BodyWithMass, enforced: Enforced, step: float) -> int:
    """Equal parts of a ``step``, s, none longer than :func:`safe_step`. Raises BadInput as that does."""
    return max(math.ceil(step / safe_step(body, enforced) * (1 - JUST_SAFE)), 1)


def safe_step(body: BodyWithMass, enforced: Enforced) -> float:
    """s, at most 2/omega_max, where omega_max^2 <= max_i sum_j |K_ij| / m_i (Gershgorin), K with every contact closed.

    A mass that couples its nodes stands for the diagonal m_i = M_ii - sum of |M_ij|, which it exceeds; degrees of
    freedom without mass are held, which stiffens the others. Raises BadInput where some m_i is not positive.
    """
    heavy = body.massive
    moduli = [part.relaxation.glassy * abs(part.stiffness.tocsr()[heavy][:, heavy]) for part in body.parts]
    pull = sum(_rows(modulus) for modulus in moduli)
    if enforced.is_law:
        seen = abs(sparse.csr_matrix(body.pressing.trace) @ body.pressing.push.T.tocsr()).tocsc()[:, heavy]
        pull = pull + seen.T @ (enforced.penalty * body.pressing.weights * _rows(seen))
    inertia = body.inertia.tocsr()[heavy][:, heavy]
    mass = 2 * inertia.diagonal() - _rows(abs(inertia))
    if mass.min() <= 0.0:
        reason = '"staged" needs a mass that hardly couples its nodes; accepted: lumped, redistributed, spread'
        raise BadInput(Fault("numerics", "mass", reason))
    return float(2.0 / np.sqrt(np.max(pull / mass)))


def _rows(matrix: Matrix) -> Array:
    """Sums of a sparse matrix's rows."""
    return np.asarray(matrix.sum(axis=1)).ravel()
