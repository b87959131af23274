"""One impact on a body with inertia: from the moving body and settings to the motion, and to the record of a march.

When a contact with waves ends: read from the last steps in which something presses.

Lengths of the steps of an impact with waves: short about an early peak of the force, doubled ever again later.
"""

from __future__ import annotations

import math

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import half_width
from fe_contact.budget.plan import EARLY_PEAK
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.march import Choices, Motion, Sample, march
from fe_contact.dynamics.pressed import Enforced
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.errors import MemoryTooSmall
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.steppers.march import March, Work
from fe_contact.waves.moving import Moving
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
    (_, last), separated = found.seen[-1], left(found.samples[-1])
    pressed = found.samples[:-1] if separated else found.samples
    end, spread = _parting(found, scene.profile.exponent_of_force, last) if separated else (pressed[-1].time, 0.0)
    time = np.append([s.time for s in pressed], end) if separated else np.array([s.time for s in pressed])
    depth, speed = np.array([(float(s.displacement[0]), float(s.velocity[0])) for s in found.samples]).T
    momentum = scene.reduced_mass * (scene.velocity - speed + scene.gravity * found.time)
    if separated:  # nothing presses any more between the end and the last sample
        late = found.samples[-1].time - end
        depth[-1] -= late * (speed[-1] - 0.5 * scene.gravity * late)
    touched = [s for s in pressed if s.force > 0.0]
    return March(
        time=time,
        depth=depth,
        impulse=momentum,
        radius_time=np.array([s.time for s in touched]),
        radius=np.array([_radius(moving, s) for s in touched]),
        separated=separated,
        photograph=tuple,
        energy=energies(moving, found, scene),
        end_spread=spread,
        first_force=0.0,
        work=Work(len(found.samples) - 1, len(found.samples) - 1, sum(s.iterations for s in found.samples)),
    )


def _parting(found: Motion, exponent: float, last: float) -> tuple[float, float]:
    """When contact ends, s, and how well that is read: the ``last`` to a step where too few of them tell."""
    return parting(found.time, found.force, exponent) or (last, found.time[-1] - found.time[-2])


def _radius(moving: Moving, sample: Sample) -> float:
    radius = half_width(moving.places, sample.signed_pressure, -sample.signed_pressure)
    if not np.isfinite(radius):
        raise MemoryTooSmall(moving.places[-1])
    return radius


def energies(moving: Moving, found: Motion, scene: Scene) -> dict[str, float]:
    """Terms in J at the end. What waves in an endless elastic body hold without a load never comes back: radiated.

    Of a viscoelastic one its motion alone is counted so: its strain has still to relax. What a striker that yields
    holds beside the motion of its centre of mass is stored.
    """
    last = found.samples[-1].energies
    out = 0.5 * scene.reduced_mass * float(found.samples[-1].velocity[0]) ** 2
    waves = 0.0
    if moving.endless:
        swift, strained = moving.in_striker(found.final)
        gone = scene.geometry.material.young.is_elastic and left(found.samples[-1])
        waves = last.rigid + last.deformable - swift + (last.strain - strained if gone else 0.0)
    terms = {
        "in": last.work,
        "out": out,
        "stored": last.rigid + last.deformable + last.strain - out - waves,
        "viscous": last.viscous,
        "radiated": last.radiated + waves,
        "contact": last.contact,
        "numerical": last.numerical,
    }
    terms["residual"] = 2 * terms["in"] - sum(terms.values())
    return terms


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


def graded(numerics: Numerics) -> tuple[float, tuple[float, ...]]:
    """First step, s, and the times, s, from which steps are twice as long as before.

    From a share of the contact on at which a force may well peak there are ``steps`` to the contact time; half that
    time before they are half as long, down to the time of the peak.
    """
    octaves = max(math.ceil(math.log2(EARLY_PEAK / numerics.peak_share)), 0)
    times = [EARLY_PEAK * numerics.contact_time / 2**earlier for earlier in range(octaves)]
    return numerics.contact_time / numerics.steps / 2**octaves, tuple(reversed(times))
