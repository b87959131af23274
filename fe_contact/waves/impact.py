"""An impact on a body with inertia: from the moving body and settings to its motion, contact for contact.

End of contact: read from the last steps in which something presses.

Flight between two contacts: the striker falls, waves leave, what the body remembers fades. Nothing presses, and what
still moves does so the more slowly the longer ago the separation is: steps grow with that time, and the longest flight
takes no more of them than its logarithm asks for. A step in which the surfaces meet is taken back and halved, down to
that of the contacts, within which the touch is located and stepped to. The striker's depth is convex in time: between
two open ends of a step only a surface could meet it that comes and goes within it, and that is past while steps are
still short.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.interior import factorized
from fe_contact.bodies.pressing import half_width
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.body import BodyState, BodyWithMass, undeformed
from fe_contact.dynamics.flow import Flowed
from fe_contact.dynamics.march import (
    MOST_WORK,
    Choices,
    Moment,
    Motion,
    Sample,
    Steppers,
    account_after,
    account_at_start,
    march,
    onwards,
    touched,
)
from fe_contact.dynamics.schemes import generalised_alpha
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced, ExplicitStepper, ImplicitStepper
from fe_contact.errors import MemoryTooSmall, TooManySteps
from fe_contact.march.impact import balanced
from fe_contact.march.impacts import Grounded
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import WaveNumerics
from fe_contact.steppers.steps import March, Strike, Work
from fe_contact.waves.moving import Moving
from fe_contact.waves.plan import MARCHES, graded
from lumped.scene.scene import Scene

READ, STRAIGHT = 5, 3  # last steps asked, by a parabola and by a line
SOONEST = 0.05  # steps after the last one in which something presses


def motion(moving: Moving, scene: Scene, numerics: WaveNumerics) -> Motion:
    """March from first touch until the striker has left, or to the scene's end time.

    Raises the named failures of :mod:`fe_contact.errors`.
    """
    return march(moving.body, moving.velocity, choices_of(scene, numerics), scene.end_time, moving.watch, left)


def choices_of(scene: Scene, numerics: WaveNumerics) -> Choices:
    """How the march is solved."""
    penalty = numerics.penalty * _stiffness(scene, numerics) / numerics.contact_radius
    step, doubled = graded(numerics)
    return Choices(
        scheme=WAVE_SCHEMES.get(numerics.scheme).of(numerics.rho),
        enforced=Enforced(ENFORCEMENTS.get(numerics.enforcement), penalty),
        step=step,
        doubled=doubled,
    )


def _stiffness(scene: Scene, numerics: WaveNumerics) -> float:
    """Of the first answer until the force peaks, Pa: at once, and what a dashpot in parallel adds."""
    modulus = scene.contact_modulus
    return modulus.glassy + modulus.viscosity / (numerics.peak_share * numerics.contact_time)


def left(sample: Sample, slow: float = 0.0) -> bool:
    """Whether nothing presses on a striker that moves back, or from which the surface moves on; faster than ``slow``,
    m/s.
    """
    return sample.force <= 0.0 and min(float(sample.velocity[0]), float(sample.closing.max())) < -slow


def record(moving: Moving, found: Motion, scene: Scene) -> March:
    """The history from touch to separation as of any march; forces are what the striker's momentum says."""
    (_, last), separated, flowed = found.seen[-1], left(found.samples[-1]), found.final.flowed
    rest = left_behind(moving.body, flowed) if separated and flowed is not None else None
    pressed = found.samples[:-1] if separated else found.samples
    end, spread = pressed[-1].time, 0.0
    if separated:  # where too few steps tell when, it is the last touch, known to a step
        read = parting(found.time, found.force, scene.profile.exponent_of_force)
        end, spread = read or (last, found.time[-1] - found.time[-2])
    time = np.append([s.time for s in pressed], end) if separated else np.array([s.time for s in pressed])
    depth, speed = np.array([(float(s.displacement[0]), float(s.velocity[0])) for s in found.samples]).T
    momentum = scene.reduced_mass * (scene.velocity - speed + scene.gravity * found.time)
    late = found.samples[-1].time - end  # in which nothing presses any more
    fallen = late * float(speed[-1] - 0.5 * scene.gravity * late)
    depth[-1] -= fallen
    touched = [s for s in pressed if s.force > 0.0]
    return March(
        time=time,
        depth=depth,
        impulse=momentum,
        radius_time=np.array([s.time for s in touched]),
        radius=np.array([_radius(moving, s) for s in touched]),
        separated=separated,
        photograph=tuple,
        energy=account_before(energies(moving, found, scene, rest), fallen, scene.reduced_mass * scene.gravity),
        end_spread=spread,
        first_force=0.0,
        work=Work(
            len(found.samples) - 1,
            sum(sample.problems for sample in found.samples[1:]),
            sum(sample.iterations for sample in found.samples),
        ),
        dent=None if rest is None else rest.dent,
    )


def account_before(account: dict[str, float], fallen: float, weight: float) -> dict[str, float]:
    """The account, J, before the striker has ``fallen`` by so much, m, under a ``weight``, N, and nothing else."""
    given = weight * fallen
    return balanced({**account, "in": account["in"] - given, "out": account["out"] - given})


def _radius(moving: Moving, sample: Sample) -> float:
    radius = half_width(moving.places, sample.signed_pressure, -sample.signed_pressure)
    if not np.isfinite(radius):
        raise MemoryTooSmall(moving.places[-1])
    return radius


def energies(moving: Moving, found: Motion, scene: Scene, rest: LeftBehind | None = None) -> dict[str, float]:
    """Terms in J at the end. What waves in an endless elastic body hold without a load never comes back: radiated.

    Of a viscoelastic one, and under a load, motion alone is counted so: strain has still to relax. It is half of what
    waves hold, of those too that have left the mesh since the touch. What a striker that yields holds beside the motion
    of its centre of mass is stored, and what stays at ``rest`` where a body has flowed.
    """
    last, waves = found.samples[-1].energies, 0.0
    if moving.endless:
        swift, strained = moving.in_striker(found.final)
        gone = scene.geometry.material.young.is_elastic and left(found.samples[-1])
        stays = strained if rest is None else rest.energy
        leaving = last.radiated - found.samples[0].energies.radiated
        still = last.strain - stays if gone else -0.5 * leaving
        waves = last.rigid + last.deformable - swift + still
    return account(found, scene.reduced_mass, waves)


def account(found: Motion, mass: float, waves: float = 0.0) -> dict[str, float]:
    """Terms in J at the end, of a ``mass``, kg, that moves as what is watched; ``waves`` that never come back."""
    last, out = found.samples[-1].energies, 0.5 * mass * float(found.samples[-1].velocity[0]) ** 2
    flowed = {} if found.final.flowed is None else {"plastic": last.plastic}
    return balanced({
        "in": last.work,
        "out": out,
        "stored": last.rigid + last.deformable + last.strain - out - waves,
        "viscous": last.viscous,
        "radiated": last.radiated + waves,
        "contact": last.contact,
        "numerical": last.numerical,
        **flowed,
    })  # fmt: skip


class LeftBehind(NamedTuple):
    """A body at rest in which something has flowed: elastic ``energy``, J, and how deep the striker then touches, m."""

    energy: float
    dent: float


def left_behind(body: BodyWithMass, flowed: Flowed) -> LeftBehind:
    """What is left for ever, once all waves are gone."""
    stiffness = sum(part.relaxation.equilibrium * part.stiffness for part in body.parts).tocsc()
    held = np.flatnonzero(stiffness.diagonal() > 0.0)  # a rigid striker is not
    displacement = np.zeros(body.size)
    displacement[held] = factorized(stiffness[held][:, held])(flowed.forces[held])
    strain = 0.5 * float(displacement @ flowed.forces)
    return LeftBehind(strain + flowed.elastic(displacement), -float(body.pressing.overlap(displacement).max()))


def parting(time: Array, force: Array, exponent: float) -> tuple[float, float] | None:
    """When contact ends, s, and how well that is read, s: a force depth^n falls to zero as (time left)^n.

    Only near its end: where the edge recedes faster than waves run, the last thousandth of the force falls otherwise,
    and under a dashpot almost the whole contact is a faint tail. None where too few steps follow the peak.

    ``time`` (n,), s, equidistant, and ``force`` (n,), N, zero at last; ``exponent`` n.
    """
    last, step = int(np.flatnonzero(force > 0.0)[-1]), float(time[-1] - time[-2])
    late = slice(last + 1 - READ, last + 1)
    if late.start <= force.argmax() or not (force[late] > 0.0).all():
        return None
    x, root = (time[late] - time[last]) / step, force[late] ** (1.0 / exponent)
    slope, start = np.polyfit(x[-STRAIGHT:], root[-STRAIGHT:], 1)
    straight = -float(start / slope)
    ends = [float(zero.real) for zero in np.roots(np.polyfit(x, root, 2)) if zero.imag == 0.0]
    curved = min(ends, key=lambda end: abs(end - straight), default=straight)
    end = min(max(curved, SOONEST), 1.0)
    apart = min(abs(curved - straight) + abs(curved - end), 1.0) if ends else 1.0
    return float(time[last]) + step * end, step * apart


LONGEST = 12.0  # planned contact times after which one of several contacts counts as swinging on its weight
PATIENCE = 0.1  # of the steps along a contact that a flight takes before they double
DAMPED = generalised_alpha.of(0.5)  # waves that no step follows any more die away, by half a step
LOCATED = 1e-6  # of a step: a touch sooner than that is now


class WaveBouncer:
    """A striker on a body with inertia, from the first touch of a ``scene`` on; steps ``counted``.

    ``flights``: what they took.
    """

    def __init__(self, moving: Moving, scene: Scene, numerics: WaveNumerics, counted: Counted = uncounted) -> None:
        self._moving, self._scene, self._counted = moving, scene, counted
        self._choices, self._longest = choices_of(scene, numerics), LONGEST * numerics.contact_time
        self.steppers = Steppers(moving.body, self._choices.enforced)
        patience = max(round(PATIENCE * numerics.steps), 2)
        self.flights = Flights(self.steppers, self._choices.step, patience, counted)
        still = undeformed(moving.body, moving.velocity)
        self._moment = Moment(still, account_at_start(moving.body, still))
        self._steps = 0

    def contact(self, strike: Strike) -> March:
        """The next contact, by the clock of its touch; one of several that swings for long takes too many steps."""
        several = self._scene.motion.impacts > 1
        until = min(self._longest, strike.end_time) if several else strike.end_time

        def finished(sample: Sample) -> bool:
            self._counted(1.0)
            return left(sample)

        found = onwards(self.steppers, self._moment, self._choices, until, self._moving.watch, finished)
        if until < strike.end_time and not left(found.samples[-1]):
            raise TooManySteps(len(found.samples) - 1, found.final.time)
        clocked = tuple(sample._replace(time=sample.time - strike.touched_at) for sample in found.samples)
        march = record(self._moving, replace(found, samples=clocked), replace(self._scene, velocity=strike.velocity))
        self._moment, self._steps = Moment(found.final, found.samples[-1].energies), self._steps + march.work.steps
        return march

    def touch(self, strike: Strike, march: March) -> Strike | Grounded:
        """Where the flight ends on what still moves."""
        scene, body = self._scene, self._moving.body
        if (self.flights.steps + self._steps) * body.size > MOST_WORK / MARCHES:
            return Grounded.MANY
        if scene.gravity <= 0.0:
            return Grounded.NO_GRAVITY
        try:
            touch = self.flights.landing(self._moment, scene.end_time)
        except TooManySteps:
            return Grounded.MANY
        if touch is None:
            return Grounded.LATE
        self._moment, state = touch, touch.state
        depth, velocity = (float((self._moving.watch @ of)[0]) for of in (state.displacement, state.velocity))
        return strike.again(state.time - strike.touched_at, depth, velocity)


class Flights:
    """Flights of one body, their first ``step``, s, as long as those of the contacts; every ``patience`` of them they
    double. ``steps`` taken so far, which are ``counted``.
    """

    def __init__(self, steppers: Steppers, step: float, patience: int, counted: Counted = uncounted) -> None:
        self._steppers, self._step, self._patience, self._counted = steppers, step, patience, counted
        self._body, self._most = steppers.body, MOST_WORK / steppers.body.size
        self.steps = 0

    def landing(self, parted: Moment, until: float) -> Moment | None:
        """The touch that follows a separation; None where ``until``, s, comes before. Raises TooManySteps."""
        moment, level, highest, taken = parted, 0, np.inf, 0
        while moment.state.time < until:
            stepper = self._steppers.of(DAMPED, 2.0**level * self._step)
            state = self._flown(moment, stepper)
            if state.signed_pressure.max() <= 0.0:  # the surfaces do not overlap
                moment, taken = _entered(moment, stepper, state), taken + 1
                if taken >= self._patience and level < highest:
                    level, taken = level + 1, 0
            elif level:
                highest = level = level - 1
            else:
                return self._touched(moment)
        return None

    def _touched(self, moment: Moment) -> Moment:
        """The touch within the next of the shortest steps; nothing presses yet, though a rounding may overlap."""
        state, pressing, step = moment.state, self._body.pressing, self._step
        overlap, closing = pressing.overlap(state.displacement), pressing.closing(state.velocity)
        left = touched(state.time, step, overlap, closing) - state.time
        if left <= LOCATED * step:
            return moment
        stepper = self._steppers.new(DAMPED, left)
        touch = self._flown(moment, stepper)
        open_yet = np.minimum(touch.signed_pressure, 0.0)
        return _entered(moment, stepper, touch._replace(signed_pressure=open_yet))

    def _flown(self, moment: Moment, stepper: ExplicitStepper | ImplicitStepper) -> BodyState:
        """A step later, whether or not anything meets in it. Raises TooManySteps."""
        assert isinstance(stepper, ImplicitStepper)
        if self.steps >= self._most:
            raise TooManySteps(self.steps, moment.state.time)
        self.steps += 1
        self._counted(1.0)
        return stepper.flown(moment.state)


def _entered(moment: Moment, stepper: ExplicitStepper | ImplicitStepper, state: BodyState) -> Moment:
    """A step further in the account of energy too."""
    return Moment(state, account_after(moment.energies, stepper, moment.state, state))
