"""The gate before any fit: whether a measured curve can be an impact of a scene's bodies, and if not, what was done.

The impulse of one contact is J = m v (1 + e), 0 <= e <= 1, whatever the force law: units, calibration and lost rows
show there. The rest is seen in the curve alone. One fault is said, the first in the order of causes, after what is odd.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.numbers import Array
from lumped.result.curve_file import FORCE, TIME
from lumped.result.noise import memory
from lumped.result.score import Curve
from lumped.scene.geometry import stiffest_impact
from lumped.scene.scene import Scene

# The pulse is where the smoothed force is above this share of its peak, or above so many deviations of its noise.
LEVEL, DEVIATIONS = 0.1, 4.0
SMOOTHED = 0.1  # of the points above half of the peak: over these noise is averaged
NOISE_SHARE = 0.005  # of the peak: a smaller noise is not averaged out, for the rows may be uneven
ANOTHER = 0.2  # of the peak: as much force elsewhere is another contact
LEAST_ROWS, FEW_ROWS = 8, 20  # in the pulse: fewer tell no shape; fewer tell it badly
EVEN, HOLE, LOST = 0.05, 1.8, 0.05  # steps alike; a step over theirs that is a hole; share of the pulse that may lack
# A smooth peak in steps of 8 bits has up to 6 % of its rows on the highest step: more is a limit of the instrument.
CLIPPED, LEAST_CLIPPED = 0.08, 4
LEVEL_OFF, TAIL = 0.02, 0.5  # of the peak: a silence may stand as far from zero; of the pulse: where silence begins
OFF_A_LITTLE = 0.005  # of the peak: a silence so far from zero is worth a word
DECAYED = 0.8  # second half of a silence over its first: a force that creeps to its end falls faster
EARLY, LATE = 0.2, 0.45  # of the pulse: before zero and after it, where a force of a steep law seems to begin
SPARE, NEARLY = 0.05, 0.01  # of m v: mass, velocity and force are measured to some per cent; not worth a word
THOUSANDS = (1e3, 1e-3, 1e6, 1e-6)  # what a unit mistaken for another makes
ODD = 200.0  # a duration over that of the scene's material: steel's modulus over rubber's is 1e5, times 0.01 apart


@dataclass(frozen=True)
class Finding:
    """What is wrong with a curve, and whether it can be used all the same."""

    message: str
    fatal: bool = True


def check_curve(curve: Curve, scene: Scene, source: str, touch_at_zero: bool = True) -> tuple[str, ...]:
    """What to be warned of in a measured curve of a scene's impact; raises BadInput for one that cannot be one.

    `touch_at_zero`: whether what follows takes the curve's time zero, s, for the first touch. `source`: its file.
    """
    pulse = MeasuredPulse(curve.time, curve.force, curve.units)
    odd = list[str]()
    checks = (*OF_THE_CURVE, _impulse, _duration, *((_touch,) if touch_at_zero else ()))
    for check in checks:
        for finding in check(pulse, scene):
            if finding.fatal:
                read = f" ({'; '.join(curve.remarks)})" if curve.remarks else ""
                raise BadInput(Fault(source, "", said) for said in (*odd, finding.message + read))
            odd.append(finding.message)
    return tuple(f"{source}: {said}" for said in (*(["; ".join(curve.remarks)] if curve.remarks else []), *odd))


@dataclass(frozen=True, eq=False)
class MeasuredPulse:
    """A measured force, N, over time, s, both (n,), and where in it the one large pulse lies.

    `units`: of time and force in the file.
    """

    time: Array
    force: Array
    units: tuple[str, str] = ("s", "N")

    @cached_property
    def noise(self) -> float:
        """Standard deviation of what changes from row to row, N, from second differences: a median, blind to jumps."""
        if self.force.size < 5:
            return 0.0
        second = np.diff(self.force, 2) / math.sqrt(6.0)
        return float(np.median(np.abs(second))) / 0.6745

    @cached_property
    def smooth(self) -> Array:
        """The force, N, averaged over neighbours where it is noisy, (n,)."""
        return self.averaged(self.force)

    def averaged(self, force: Array) -> Array:
        """A force at the same rows, (n,), N, averaged as this one is."""
        if not self.noisy:
            return force
        return np.convolve(force, np.full(self.window, 1.0 / self.window), mode="same")

    @cached_property
    def window(self) -> int:
        """Rows over which noise is averaged."""
        return max(1, int(SMOOTHED * np.count_nonzero(self.force > 0.5 * self.force.max()))) | 1

    @property
    def noisy(self) -> bool:
        """Whether so much noise is there that it is averaged."""
        return self.noise >= NOISE_SHARE * float(np.abs(self.force).max())

    @property
    def scatter(self) -> float:
        """How far `smooth` may lie from the force by noise, N."""
        return DEVIATIONS * self.noise / math.sqrt(self.window if self.noisy else 1)

    @cached_property
    def peak(self) -> float:
        """The highest force without noise, N."""
        return float(self.smooth.max())

    @cached_property
    def level(self) -> float:
        """Above it the bodies press, N."""
        return max(LEVEL * self.peak, self.scatter)

    @cached_property
    def rows(self) -> slice:
        """The rows of the pulse around the peak."""
        top, low = int(np.argmax(self.smooth)), np.flatnonzero(self.smooth < self.level)
        first = low[low < top]
        last = low[low > top]
        return slice(int(first[-1]) + 1 if first.size else 0, int(last[0]) if last.size else self.time.size)

    @property
    def start(self) -> float:
        """Where the pulse begins, s."""
        return float(self.time[self.rows.start])

    @property
    def end(self) -> float:
        """Where it ends, s."""
        return float(self.time[self.rows.stop - 1])

    @cached_property
    def width(self) -> float:
        """How long it lasts, s."""
        return self.end - self.start or float(self.time[-1] - self.time[0]) / self.time.size

    @property
    def ended(self) -> bool:
        """Whether the force has gone before the record ends."""
        return bool(self.rows.stop < self.time.size)

    @cached_property
    def before(self) -> Array:
        """The silence before the pulse, N, shape (k,)."""
        return self.force[self.time < self.start - TAIL * self.width]

    @cached_property
    def after(self) -> Array:
        """The silence after the pulse, N, shape (k,)."""
        return self.force[self.time > self.end + TAIL * self.width] if self.ended else self.force[:0]

    def impulse(self, margin: float) -> tuple[float, float]:
        """Integral of the force over the pulse and a margin in widths, N s, and its standard deviation."""
        near = (self.time >= self.start - margin * self.width) & (self.time <= self.end + margin * self.width)
        time, force = self.time[near], self.force[near]
        return float(np.trapezoid(force, time)), self.noise * float(np.sqrt(np.sum(np.diff(time) ** 2)))

    def level_of(self, silence: Array) -> Silence:
        """The mean of a silence, N, and how far from zero chance may move it; zero and inf where it is too short.

        Noise is what is left of a line through it, so that a trend counts as none.
        """
        if silence.size < LEAST_ROWS:
            return Silence(0.0, math.inf, 0)
        rows = np.linspace(-1.0, 1.0, silence.size)
        noise = silence - silence.mean() - rows * float(rows @ silence) / float(rows @ rows)
        alone = silence.size / memory(noise)
        return Silence(float(silence.mean()), DEVIATIONS * float(noise.std()) / math.sqrt(alone), silence.size)


class Silence(NamedTuple):
    """The mean of so many ``rows`` of a silence, N, and how far ``chance`` may move it."""

    mean: float
    chance: float
    rows: int

    def off(self, floor: float) -> bool:
        """Whether it is another than zero, by more than a floor, N, and than chance."""
        return abs(self.mean) > max(floor, self.chance)

    def with_another(self, other: Silence) -> Silence:
        """Both silences as one."""
        rows = self.rows + other.rows
        mean = (self.rows * self.mean + other.rows * other.mean) / rows
        return Silence(mean, math.hypot(self.rows * self.chance, other.rows * other.chance) / rows, rows)


Check = Callable[[MeasuredPulse, Scene], Iterator[Finding]]


def _single(scene: Scene) -> bool:
    """Whether the force is one smooth pulse: waves hold a force still, let it go, and bring it back."""
    return scene.motion.impacts == 1 and not scene.model.inertia


def _contact(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    largest = float(np.abs(pulse.smooth).max())
    if largest < DEVIATIONS * pulse.noise:
        said = f"no contact: the force stays within {largest:.3g} N, and its noise is {pulse.noise:.3g} N"
        yield Finding(f"{said}; cure: a record that holds the impact")


def _sign(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    lowest, highest = float(pulse.smooth.min()), float(pulse.smooth.max())
    if -lowest > 2.0 * highest:
        yield Finding(f"sign: the force reaches {lowest:.4g} N; compression is positive; cure: multiply it by -1")


def _missing(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    """Holes in even rows, and rows that fell to zero amid the pulse."""
    steps = np.diff(pulse.time)
    usual = float(np.median(steps))
    inside = (pulse.time[1:] > pulse.start - pulse.width) & (pulse.time[:-1] < pulse.end + pulse.width)
    holes = inside & (steps > HOLE * usual)
    if holes.any() and np.mean(np.abs(steps - usual) <= EVEN * usual) > 1.0 - 2.0 * EVEN:
        lost = float((steps[holes] - usual).sum())
        where = float(pulse.time[int(np.argmax(holes))])
        count = round(lost / usual)
        said = f"samples are missing: {count} of them, the first after {where:.6g} s"
        yield Finding(f"{said}; cure: export the record whole, or measure again", lost > LOST * pulse.width)
    near = np.minimum(np.maximum.accumulate(pulse.force), np.maximum.accumulate(pulse.force[::-1])[::-1])
    fallen = (pulse.force == 0.0) & (near > ANOTHER * pulse.peak)
    first, last = (np.flatnonzero(fallen)[[0, -1]]) if fallen.any() else (0, 0)
    apart = float(pulse.time[last] - pulse.time[first])
    if fallen.any() and _single(scene) and apart < pulse.width:
        said = f"samples are missing: {fallen.sum()} rows are zero amid the contact"
        yield Finding(f"{said}, the first at {pulse.time[first]:.6g} s; cure: leave these rows out, or measure again")


def _rate(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    rows = pulse.rows.stop - pulse.rows.start
    if rows < FEW_ROWS and _single(scene):
        said = f"sample rate: rows while the bodies press: {rows}; accepted from {LEAST_ROWS}, better {10 * FEW_ROWS}"
        yield Finding(f"{said}; cure: above {FEW_ROWS / pulse.width:.3g} rows a second", rows < LEAST_ROWS)


def _clipped(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    """Rows on one highest value."""
    highest = float(pulse.force.max())
    rows = int(np.count_nonzero(pulse.force[pulse.rows] >= highest * (1.0 - 1e-9)))
    pressed = pulse.rows.stop - pulse.rows.start
    if rows >= max(LEAST_CLIPPED, CLIPPED * pressed) and _single(scene):
        said = f"the peak is clipped: {rows} rows stand at {highest:.6g} N, a limit of the instrument"
        yield Finding(f"{said}; cure: a larger range; for what is left, leave these rows out")


def _other_contact(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    floor = max(ANOTHER * pulse.peak, pulse.scatter)
    far = (pulse.time < pulse.start - TAIL * pulse.width) | (pulse.time > pulse.end + TAIL * pulse.width)
    again = far & (pulse.smooth > floor)
    if again.any() and pulse.ended and _single(scene):
        when = float(pulse.time[int(np.argmax(again))])
        said = f"there is another contact at {when:.6g} s, and the scene has one; is the pulse recorded twice?"
        yield Finding(f"{said} cure: cut the record to one, or set motion.impacts for compare")


def _zero(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    """A silence that is none: an offset where it stands alike before and after, else a drift; a small one is no bar.

    One silence alone does not tell them apart.
    """
    if not _single(scene):
        return
    before, after = pulse.level_of(pulse.before), pulse.level_of(pulse.after)
    if after.mean > 0.0 and (scene.gravity or not _lasts(pulse.after)):
        after = Silence(0.0, math.inf, 0)  # a weight at rest, or a slow end
    silences = [(one, when) for one, when in ((before, "before touch"), (after, "after the contact")) if one.rows]
    both = len(silences) > 1
    alike = both and abs(after.mean - before.mean) < max(0.5 * abs(before.mean), before.chance + after.chance)
    judged = [before.with_another(after)] if alike else [one for one, _ in silences]
    off = [abs(one.mean) for one in judged if one.off(OFF_A_LITTLE * pulse.peak)]
    if not off:
        return
    said = " and ".join(f"{one.mean:.3g} N {when}" for one, when in silences)
    told = f"the force is {said}, {100.0 * max(off) / pulse.peak:.2g} % of the peak"
    if alike:
        told = f"offset: {told}; cure: subtract it"
    elif both:
        told = f"drift: {told}; cure: subtract the line between; charge amplifiers: a longer time constant"
    else:
        told = f"offset or drift: {told}; cure: a record with silence on both sides tells which; then subtract it"
    yield Finding(told, max(off) > LEVEL_OFF * pulse.peak)


def _lasts(silence: Array) -> bool:
    half = silence.size // 2
    return half > 0 and bool(silence[half:].mean() > DECAYED * silence[:half].mean())


def _touch(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    if _single(scene) and not -EARLY * pulse.width <= pulse.start <= LATE * pulse.width:
        said = f"pre-trigger: the force begins before {pulse.start:.6g} s, and time zero has to be the first touch"
        cure = "identify, fit with touch in --free beside what is sought, or compare --touch S, as they find it"
        yield Finding(f"{said}; cure: {cure}")


def _impulse(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    """J = m v (1 + e), and m g more for every second."""
    mass = scene.reduced_mass + 3.0 * (scene.swinging_mass - scene.reduced_mass)  # a block's own mass counts whole
    momentum = mass * scene.velocity
    if not momentum or scene.motion.impacts > 1:
        return
    weight = mass * scene.gravity * pulse.width
    (least, chance), (most, _) = pulse.impulse(1.0), pulse.impulse(math.inf)
    low, high = (least - weight) / momentum, (max(least, most) - weight) / momentum
    spare = SPARE + 3.0 * chance / momentum
    if low > 2.0 + spare:
        yield Finding(_unit_of(pulse, scene, low) or _too_large(low))
    elif high < 1.0 - spare and pulse.ended and not scene.model.inertia:
        cure = "check mass, velocity and calibration, and whether rows were cut off"
        yield Finding(_unit_of(pulse, scene, high) or f"{_restitution(high)} < 0; cure: {cure}")
    elif low > 2.0 + NEARLY or (high < 1.0 - NEARLY and pulse.ended and not scene.model.inertia):
        yield Finding(f"{_restitution(high)}, a little outside 0 to 1; cure: check mass and velocity", False)


def _restitution(ratio: float) -> str:
    return f"the impulse is {ratio:.4g} times mass times velocity, a restitution of {ratio - 1.0:.3g}"


def _too_large(ratio: float) -> str:
    cure = "check mass, velocity and the calibration"
    if ratio < 4.0 * (1.0 + SPARE):
        cure = f"is it doubled, as two sensors added, or half of the mass or velocity given? else {cure}"
    return f"{_restitution(ratio)} > 1; cure: {cure}"


def _unit_of(pulse: MeasuredPulse, scene: Scene, ratio: float) -> str:
    """Units mistaken for others, of the force, of the time, or of both: the contact's duration tells which.

    Empty where none are.
    """
    span = _contact_times(scene)
    factors, most = (1.0, *THOUSANDS), 2.0 * (1.0 + SPARE)
    pairs = [(t, f) for t in factors for f in factors if t * f != 1.0 and 1.0 - SPARE <= ratio / (t * f) <= most]

    def odd(pair: tuple[float, float]) -> float:
        of_time = _beyond(pulse.width / pair[0], span) if span else 0.0
        return of_time + (math.log(ODD) if 1.0 not in pair else 0.0)  # one unit is mistaken more often than both

    if not pairs:
        return ""
    likely = min(map(odd, pairs))
    return f"{_restitution(ratio)}: {'; or '.join(_units(pulse.units, *pair) for pair in pairs if odd(pair) == likely)}"


def _units(units: tuple[str, str], of_time: float, of_force: float) -> str:
    """By what factors time and force are wrong beside a file's units, and the headers that say so."""
    said, cures = list[str](), list[str]()
    for quantity, dimension, unit, much, little, factor in (
        ("time", TIME, units[0], "long", "short", of_time), ("force", FORCE, units[1], "large", "small", of_force)
    ):  # fmt: skip
        if factor == 1.0:
            continue
        name, times = dimension.unit_of(dimension.units[unit] / factor), f"{max(factor, 1.0 / factor):g}"
        said.append(f"the {quantity} is {times} times too {much if factor > 1.0 else little}")
        if name:
            said[-1] += f": in {name} and read as {unit}"
        other = f"{quantity}s {'divided' if factor > 1.0 else 'multiplied'} by {times}"
        cures.append(f"a header {quantity}_{name}" if name else other)
    return f"{' and '.join(said)}? cure: {' and '.join(cures)}"


def _contact_times(scene: Scene) -> tuple[float, float] | None:
    """The shortest and the longest elastic contact time of the scene's material, s; None without one."""
    if not scene.has_geometry or scene.mass == 0.0:
        return None
    stiff = stiffest_impact(scene.profile, scene.contact_modulus, scene.reduced_mass, scene.velocity).duration
    return min(stiff, scene.elastic_contact_time), scene.elastic_contact_time


def _beyond(duration: float, span: tuple[float, float]) -> float:
    """How far a duration lies outside of a span, in logarithms; zero inside."""
    return max(math.log(span[0] / duration), math.log(duration / span[1]), 0.0)


def _duration(pulse: MeasuredPulse, scene: Scene) -> Iterator[Finding]:
    """Force and time both wrong by one factor leave the impulse right."""
    span = _contact_times(scene)
    if span is not None and _beyond(pulse.width, span) > math.log(ODD):
        said = f"the contact lasts {pulse.width:.3g} s, and {span[1]:.3g} s with the scene's material"
        factor = min(THOUSANDS, key=lambda factor: _beyond(pulse.width / factor, span))
        yield Finding(f"{said}; {_units(pulse.units, factor, 1.0 / factor)}; else the material is far off", False)


OF_THE_CURVE: tuple[Check, ...] = (_contact, _sign, _missing, _rate, _clipped, _other_contact, _zero)
