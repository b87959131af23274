"""The loop: from a body and the choices of a run to its motion.

First touch and separation within a step, from what is known at its ends. How many stages a step of central difference
needs: 2/omega_max, bounded without an eigenvalue.

Where the energy goes, step by step, every term computed on its own; what is left over is the residual.

Displacements are linear within a step: heat, radiation and work follow. What the scheme adds to that is its own
numerical loss, by its own numbers: with dx the change over a step, <x> the mean of its ends,

    dt (1 - alpha_m - gamma) <v>.M da + dt^2 (beta - gamma/2) da.M [<a> + (1/2 - alpha_m) da]      inertia,
    du . (f_(1 - alpha_f) - average of f)                                                  stress and damping,
    (work of the contact at 1 - alpha_f) - (change of what its springs hold)                          contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.cache import Store
from fe_contact.assembly.forms import Array, Matrix
from fe_contact.dynamics.body import BodyState, BodyWithMass, undeformed
from fe_contact.dynamics.schemes.base import Scheme
from fe_contact.dynamics.stepping import Enforced, ExplicitStepper, ImplicitStepper
from fe_contact.errors import ContactLost, MotionUnbounded, TooManySteps
from fe_contact.progress import Counted, uncounted
from lumped.errors import BadInput, Fault

MOST_STEPS = 200_000  # of a small body: a minute and a half, nearly all of it beside the unknowns
MOST_WORK = 3e8  # unknowns times steps, of a large one: some eight minutes of one core
ROUNDING = 1e-9  # of times that are sums of steps
UNBOUNDED = 1e6  # multiple of the fastest that gravity and the start explain
KEPT = 8  # lengths of step whose factors are kept, some 10 MB each
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
    """A body in motion at an instant, and its account of energy so far."""

    state: BodyState
    energies: Energies


class Sample(NamedTuple):
    """What one step leaves behind, at its end: s, N, the step's share of the impulse, N s; overlaps, their rates and
    signed pressures (q,); displacement and velocity of the watched places (k,), energies, Newton iterations, contact
    ``problems``: more than one where flow is found together with the motion.
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
    problems: int = 1


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
    counted: Counted = uncounted,
) -> Motion:
    """Move an undeformed body with ``velocity`` (N,) until ``end_time``, s, or until a sample says it is finished.

    ``watch`` (k, N): weights of the displacements that are recorded; ``counted`` is told of every step.

    Raises ContactNotSettled, MotionUnbounded or TooManySteps; BadInput for a scheme that the body does not admit.
    """
    state = undeformed(body, velocity)
    steppers = Steppers(body, choices.enforced)
    begun = Moment(state, account_at_start(body, state))
    return onwards(steppers, begun, choices, end_time, watch, finished, counted)


class Steppers:
    """Steppers of one ``body`` by the contact ``enforced`` there, ``made`` so many; those used last are kept."""

    def __init__(self, body: BodyWithMass, enforced: Enforced) -> None:
        self.body, self.enforced, self.made = body, enforced, 0
        self._kept = Store(KEPT)

    def of(self, scheme: Scheme, step: float) -> ExplicitStepper | ImplicitStepper:
        """One for steps of a length, s, at hand or new."""
        return self._kept.find((scheme, step), lambda: self.new(scheme, step))

    def new(self, scheme: Scheme, step: float) -> ExplicitStepper | ImplicitStepper:
        """One for a length that does not come again, s."""
        self.made += 1
        kind: type[ExplicitStepper | ImplicitStepper] = ExplicitStepper if scheme.explicit else ImplicitStepper
        return kind(self.body, scheme, self.enforced, step)


def onwards(
    steppers: Steppers,
    begun: Moment,
    choices: Choices,
    end_time: float,
    watch: Array,
    finished: Callable[[Sample], bool],
    counted: Counted = uncounted,
) -> Motion:
    """The same from a moment on, with which another ``end_time``, s, and the lengths of the steps begin anew."""
    body, scheme = steppers.body, choices.scheme
    parts = stages(body, choices.enforced, choices.step) if scheme.staged else 1
    stepper = steppers.of(scheme, choices.step / parts)
    state, energies, start = stepper.begun(begun.state), begun.energies, begun.state.time
    fastest = UNBOUNDED * (np.abs(state.velocity).max() + np.abs(body.gravity).max() * end_time)
    samples, most = [_sample(body, state, 0.0, watch, energies, 0)], min(MOST_STEPS, int(MOST_WORK / body.size))
    while state.time - start < end_time * (1 - ROUNDING):
        if (len(samples) - 1) * parts >= most:
            raise TooManySteps(most, state.time)
        length = choices.length(state.time - start) / parts
        if length != stepper.step:
            stepper = steppers.of(scheme, length)
        impulse, iterations, problems = 0.0, 0, 1
        for _ in range(parts):
            before = state
            state, found = stepper.advance(before)
            if not np.abs(state.velocity).max() <= fastest:  # nan is no less
                raise MotionUnbounded(state.time)
            energies = account_after(energies, stepper, before, state)
            impulse += _impulse(body, before, state)
            iterations += found.iterations
            problems = max(problems, found.problems)
        samples.append(_sample(body, state, impulse, watch, energies, iterations, problems))
        counted(1.0)
        if finished(samples[-1]):
            break
    return Motion(tuple(samples), state, parts)


def _impulse(body: BodyWithMass, before: BodyState, after: BodyState) -> float:
    """N s from one state to the next, by the forces there."""
    return (after.time - before.time) * 0.5 * float(body.pressing.weights @ (before.pressure + after.pressure))


def _sample(
    body: BodyWithMass,
    state: BodyState,
    impulse: float,
    watch: Array,
    energies: Energies,
    iterations: int,
    problems: int = 1,
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
        problems=problems,
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


class Energies(NamedTuple):
    """J: ``work`` done so far by gravity, with the kinetic energy at the start; what stands in motion of ``rigid`` and
    ``deformable`` bodies, in ``strain`` and in the ``contact``'s springs; what was lost so far.
    """

    work: float
    rigid: float
    deformable: float
    strain: float
    contact: float
    viscous: float
    radiated: float
    numerical: float
    plastic: float = 0.0

    @property
    def total(self) -> float:
        """Kinetic, strain and contact energy."""
        return self.rigid + self.deformable + self.strain + self.contact

    @property
    def residual(self) -> float:
        """What no term accounts for."""
        return self.work - self.total - self.viscous - self.plastic - self.radiated - self.numerical


def account_at_start(body: BodyWithMass, state: BodyState) -> Energies:
    """The account of energy of a body about to move."""
    standing = _standing(body, state)
    return Energies(sum(standing), *standing, 0.0, 0.0, 0.0)


def account_after(
    account: Energies, stepper: ExplicitStepper | ImplicitStepper, before: BodyState, after: BodyState
) -> Energies:
    """The account one step later."""
    body, scheme, step = stepper.body, stepper.scheme, stepper.step
    change = after.displacement - before.displacement
    standing, pulled = _standing(body, after), [late[0] - early[0] for early, late in _pulls(before, after)]
    heats = [
        part.heat(step, change, pull, own, pulls[1:])
        for part, pull, own, pulls in zip(body.parts, pulled, before.branches, before.pulls, strict=True)
    ]
    pressed = _contact_work(body, scheme, before, after, change) - (standing[-1] - account.contact)
    numerical = _of_inertia(scheme, before, after, step) + _of_stress(stepper, before, after, change)
    return Energies(
        account.work + float(body.weight @ change),
        *standing,
        account.viscous + sum(heats),
        account.radiated + _radiated(body, before, after, step, change),
        account.numerical + numerical + pressed,
        0.0 if after.flowed is None else after.flowed.worked,
    )


def _pulls(before: BodyState, after: BodyState) -> zip[tuple[Array, Array]]:
    """Of every part, at both ends of a step."""
    return zip(before.pulls, after.pulls, strict=True)


def _standing(body: BodyWithMass, state: BodyState) -> tuple[float, float, float, float]:
    """Energy in rigid and deformable motion, strain, contact."""
    v = state.velocity
    overlap = np.maximum(body.pressing.overlap(state.displacement), 0.0)
    springs = 0.5 * float((body.pressing.weights * state.pressure) @ overlap)
    parts = zip(body.parts, state.branches, state.pulls, strict=True)
    strain = sum(part.stored(state.displacement, own, pulls) for part, own, pulls in parts)
    if state.flowed is not None:
        strain += state.flowed.elastic(state.displacement)
    moving = state.pushed[1] - body.rigid * v
    return 0.5 * float(body.rigid @ v**2), 0.5 * float(v @ moving), strain, springs


def _radiated(body: BodyWithMass, before: BodyState, after: BodyState, step: float, change: Array) -> float:
    """What dashpots carry away: of all damping, what no parallel viscosity of a material does."""
    if body.dashpots is None:
        return 0.0
    forces = after.damped[0] - before.damped[0]
    for part, (early, late) in zip(body.parts, _pulls(before, after), strict=True):
        forces = forces - part.relaxation.viscosity * (late[0] - early[0])
    return float(change @ forces) / step


def _of_inertia(scheme: Scheme, before: BodyState, after: BodyState, step: float) -> float:
    """Loss by the balance of inertia."""
    alpha_m, _, beta, gamma, _ = scheme
    change, mean = after.acceleration - before.acceleration, (after.acceleration + before.acceleration) / 2
    pushed = after.pushed[2] - before.pushed[2]
    swift = (before.velocity + after.velocity) / 2
    first = step * (1 - alpha_m - gamma) * float(swift @ pushed)
    return first + step**2 * (beta - gamma / 2) * float(pushed @ (mean + (0.5 - alpha_m) * change))


def _of_stress(stepper: ExplicitStepper | ImplicitStepper, before: BodyState, after: BodyState, change: Array) -> float:
    """Loss by stress and damping that are not averages over the step."""
    scheme, late, early = stepper.scheme, 1 - stepper.scheme.alpha_f, stepper.scheme.alpha_f
    lost = 0.0
    for part, law, (start, end) in zip(stepper.body.parts, stepper.laws, _pulls(before, after), strict=True):
        start, end = start @ change, end @ change  # all of it is linear in them
        held = late * part.stressed(end[0], end[1:]) + early * part.stressed(start[0], start[1:])
        lost += float(held - part.averaged(law, start[0], end[0] - start[0], start[1:]))
        if not scheme.explicit:
            lost += float(law.late @ (end[1:] - start[1:]))
    if stepper.body.damping is not None:
        begun, ended = before.damped[:2] @ change, after.damped[:2] @ change
        lost += float(late * ended[1] + early * begun[1] - (ended[0] - begun[0]) / stepper.step)
    if before.flowed is not None and after.flowed is not None:
        taken = after.flowed.spent(after.displacement) - before.flowed.spent(before.displacement)
        lost -= float(change @ (late * after.flowed.forces + early * before.flowed.forces)) + taken
    return lost


def _contact_work(body: BodyWithMass, scheme: Scheme, before: BodyState, after: BodyState, change: Array) -> float:
    """Work that the contact takes from the bodies."""
    pressure = (1 - scheme.alpha_f) * after.pressure + scheme.alpha_f * before.pressure
    return -float(change @ body.pressing.load(pressure))
