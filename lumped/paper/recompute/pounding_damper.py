"""Section 5.2: structure and pounding tuned mass damper, Fig. 13 and 14; SI units, changes relative."""

from __future__ import annotations

import math

from lumped.paper.examples.free_vibration import measure, with_ring, without_damper, without_ring
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Value, Values, closed
from lumped.ptmd import Measures

POUND = 0.45359237  # kg
PERCENT, MILLI = 100.0, 1e3


def first_frequency(examples: Examples) -> Values:
    """sqrt(k1/m1)/(2 pi), Hz."""
    return closed(_frequency(examples.ptmd.k1, examples.ptmd.m1))


def damping_ratio(examples: Examples) -> Values:
    """c1/(2 sqrt(k1 m1)), %."""
    ptmd = examples.ptmd
    return closed(PERCENT * ptmd.c1 / (2.0 * math.sqrt(ptmd.k1 * ptmd.m1)))


def damper_mass(examples: Examples) -> Values:
    """The damper's mass in kg from that in pounds."""
    return closed(POUND * examples.ptmd.damper_pounds)


def structure_stiffness(examples: Examples) -> Values:
    """k1 = m1 (2 pi f1)^2, N/m."""
    ptmd = examples.ptmd
    return closed(ptmd.m1 * (2.0 * math.pi * ptmd.frequency) ** 2)


def structure_dashpot(examples: Examples) -> Values:
    """c1 = 2 zeta sqrt(k1 m1), N s/m."""
    ptmd = examples.ptmd
    return closed(2.0 * ptmd.damping_ratio * math.sqrt(ptmd.k1 * ptmd.m1))


def damper_dashpot(examples: Examples) -> Values:
    """c2 = 2 zeta sqrt(k2 m2), N s/m, with m2 as printed."""
    ptmd = examples.ptmd
    return closed(2.0 * ptmd.damping_ratio * math.sqrt(ptmd.k2 * ptmd.m2))


def mass_in_dashpot(examples: Examples) -> Values:
    """The m2 = (c2/(2 zeta))^2/k2, kg, which the printed c2 and k2 hold."""
    return closed(_mass_in_dashpot(examples))


def damper_frequencies(examples: Examples) -> Values:
    """sqrt(k2/m2)/(2 pi), Hz, with m2 as printed and with that which c2 holds."""
    ptmd = examples.ptmd
    return closed(_frequency(ptmd.k2, ptmd.m2), _frequency(ptmd.k2, _mass_in_dashpot(examples)))


def first_penetration(examples: Examples) -> Values:
    """How deep inside the ring the damper stands when the structure alone is displaced, m."""
    return closed(examples.ptmd.displacement - examples.ptmd.gap)


def decay_changes(examples: Examples) -> Values:
    """From no damper to the pounding one, both masses displaced: changes of t50, t10 and of the RMS displacement."""
    pairs = zip(_decay(_pounding(examples, "both")), _decay(without_damper(examples.ptmd)), strict=True)
    return tuple(after.change_from(before) for after, before in pairs)


def decay(examples: Examples) -> Values:
    """t50 and t10, s, RMS displacement, mm: with the pounding damper, then without any."""
    both = _pounding(examples, "both"), without_damper(examples.ptmd)
    return tuple(value for measures in both for value in _decay(measures))


def pounding_against_plain(examples: Examples) -> Values:
    """RMS displacement of the plain tuned mass damper, mm, and change from it to the pounding one."""
    plain = measure(without_ring(examples.ptmd, "both"), "rms_displacement")
    change = measure(_pounding(examples, "both"), "rms_displacement").change_from(plain)
    return plain.times(MILLI), change


def acceleration_change(examples: Examples) -> Values:
    """From no damper to the pounding one, both masses displaced: change of the largest acceleration."""
    return (_acceleration_change(examples, "both"),)


def acceleration_change_structure(examples: Examples) -> Values:
    """The same with the structure alone displaced."""
    return (_acceleration_change(examples, "structure"),)


def largest_accelerations(examples: Examples) -> Values:
    """Largest acceleration, m/s2: without a damper, with the pounding one by both starts."""
    measured = (without_damper(examples.ptmd), _pounding(examples, "both"), _pounding(examples, "structure"))
    return tuple(measure(measures, "max_acceleration") for measures in measured)


def quiet_share(examples: Examples) -> Values:
    """The share of the vibration after the last contact."""
    last = measure(_pounding(examples, "both"), "last_contact")
    return (Value(1.0).minus(last.times(1.0 / examples.ptmd.end_time)),)


def contacts(examples: Examples) -> Values:
    """Number of contacts, end of the last, s, largest force, N, and penetration, mm; both masses displaced."""
    found = _pounding(examples, "both")
    depth = measure(found, "peak_depth").times(MILLI)
    return Value(float(found.contacts)), measure(found, "last_contact"), measure(found, "peak_force"), depth


def _pounding(examples: Examples, start: str) -> Measures:
    return with_ring(examples.ptmd, examples.ring, start, examples.ring.nu)


def _decay(measures: Measures) -> Values:
    return measure(measures, "t50"), measure(measures, "t10"), measure(measures, "rms_displacement").times(MILLI)


def _acceleration_change(examples: Examples, start: str) -> Value:
    before = measure(without_damper(examples.ptmd), "max_acceleration")
    return measure(_pounding(examples, start), "max_acceleration").change_from(before)


def _frequency(stiffness: float, mass: float) -> float:
    return math.sqrt(stiffness / mass) / (2.0 * math.pi)


def _mass_in_dashpot(examples: Examples) -> float:
    ptmd = examples.ptmd
    return (ptmd.c2 / (2.0 * ptmd.damping_ratio)) ** 2 / ptmd.k2


MEMBER = {
    function.__name__: function
    for function in (
        first_frequency, damping_ratio, damper_mass, structure_stiffness, structure_dashpot, damper_dashpot,
        mass_in_dashpot, damper_frequencies, first_penetration, decay_changes, decay, pounding_against_plain,
        acceleration_change, acceleration_change_structure, largest_accelerations, quiet_share, contacts,
    )
}  # fmt: skip
