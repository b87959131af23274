"""Section 4.3: the concrete pole, Fig. 9 and 10, as far as dimensionless numbers and assumed radii reach."""

from __future__ import annotations

from lumped.paper.examples.concrete_impacts import TOLERANCE, cut_at_measured_peak, proposed
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Value, Values, closed, read

KILO = 1e-3


def peaks(examples: Examples) -> Values:
    """Peaks at the lower velocity, kN, one an assumed radius of the head."""
    concrete = examples.concrete
    velocity = min(concrete.velocities)
    return tuple(read(proposed(concrete, radius, velocity), "peak_force", KILO) for radius in concrete.radii)


def velocity_ratios(examples: Examples) -> Values:
    """From the lower velocity to the higher: Hertz's peak, v^(6/5), and duration, v^(-1/5), and a linear peak, v."""
    ratio = max(examples.concrete.velocities) / min(examples.concrete.velocities)
    return closed(ratio**1.2, ratio**-0.2, ratio)


def solid(examples: Examples) -> Values:
    """R1, E0 and the instantaneous modulus E2, Pa, of the printed springs, "(24)" and "(25)"."""
    concrete = examples.concrete
    return closed(concrete.E2 / concrete.E1, concrete.E1 * concrete.E2 / (concrete.E1 + concrete.E2), concrete.E2)


def memory(examples: Examples) -> Values:
    """R2 and tau = C1/(E1 + E2), s; tau over the contact time, and the restitution, smallest assumed radius."""
    concrete = examples.concrete
    R2, tau = closed(concrete.C1 / concrete.E1, concrete.C1 / (concrete.E1 + concrete.E2))
    impact = proposed(concrete, min(concrete.radii), min(concrete.velocities))
    return R2, tau, tau.over(read(impact, "duration")), read(impact, "restitution")


def peak_ratios(examples: Examples) -> Values:
    """Peak of the proposed model over Jankowski's, by both readings of an error of the peak.

    (model - experiment)/experiment, then model/experiment.
    """
    ours, theirs = examples.concrete.peak_error, examples.concrete.jankowski_peak_error
    return closed((1.0 + ours) / (1.0 + theirs), ours / theirs)


def plateau(examples: Examples) -> Values:
    """The force at the higher velocity cut at the experiment's peak: duration, impulse over those of the uncut one."""
    cut = cut_at_measured_peak(examples.concrete)
    # rows of the history are linear to its tolerance, and so are areas below them
    error = 2.0 * TOLERANCE
    return tuple(Value(after / before, error * after / before) for before, after in (cut.duration, cut.impulse))


MEMBER = {function.__name__: function for function in (peaks, velocity_ratios, solid, memory, peak_ratios, plateau)}
