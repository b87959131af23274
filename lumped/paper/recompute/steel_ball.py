"""Section 4.1: the steel ball, Fig. 6. Forces in N, times in us unless a unit is said."""

from __future__ import annotations

from lumped.paper.examples.given import Examples
from lumped.paper.examples.steel_impacts import R1_of_peak, damped_of_peak, elastic_of_peak, hertz, solid
from lumped.paper.examples.value import Value, Values, closed, read
from lumped.result.result import Result
from lumped.result.score import normalized_error

MICRO, MILLI, PERCENT = 1e6, 1e3, 100.0


def ball(examples: Examples) -> Values:
    """Radius, mm, and mass, kg."""
    return closed(examples.steel.radius * MILLI, examples.steel.mass)


def fall(examples: Examples) -> Values:
    """Velocity, m/s."""
    return closed(examples.steel.velocity)


def contact_modulus(examples: Examples) -> Values:
    """E_s/(2 (1 - nu_s^2)), "(23)", Pa."""
    return closed(_contact_modulus(examples))


def fitted_R1(examples: Examples) -> Values:
    """R1 of the proposed model at the measured peak, "(26)"."""
    return (R1_of_peak(examples.steel),)


def memory(examples: Examples) -> Values:
    """tau = R2/(1 + R1), ms, and tau over the contact time."""
    steel = examples.steel
    tau = Value(steel.R2 / (1.0 + steel.R1))
    return tau.times(MILLI), tau.over(read(_proposed(examples), "duration"))


def springs(examples: Examples) -> Values:
    """E1, E2, Pa, and C1, Pa s, from E0, R1, R2 by "(24)" and "(25)"."""
    steel = examples.steel
    series = steel.contact_modulus * (1.0 + steel.R1)
    return closed(series / steel.R1, series, steel.R2 * series / steel.R1)


def proposed_peak(examples: Examples) -> Values:
    """Peak force of the proposed model as printed."""
    return (read(_proposed(examples), "peak_force"),)


def proposed_peak_time(examples: Examples) -> Values:
    """Its peak's time."""
    return (read(_proposed(examples), "peak_time", MICRO),)


def proposed_duration(examples: Examples) -> Values:
    """Its duration."""
    return (read(_proposed(examples), "duration", MICRO),)


def theoretical_peak(examples: Examples) -> Values:
    """Peak of the nonlinear elastic model with E* as printed."""
    return (read(hertz(examples.steel, examples.steel.contact_modulus), "peak_force"),)


def theoretical_peak_exact(examples: Examples) -> Values:
    """The same with E* of "(23)"."""
    return (read(hertz(examples.steel, _contact_modulus(examples)), "peak_force"),)


def refitted_times(examples: Examples) -> Values:
    """Time of the peak and duration of the proposed model whose R1 gives the measured peak."""
    steel = examples.steel
    return _times(solid(steel, R1_of_peak(steel).value, steel.R2))


def hertz_times(examples: Examples) -> Values:
    """The same of the nonlinear elastic model at the measured peak."""
    return _times(elastic_of_peak(examples.steel, "hertz", examples.steel.measured_peak))


def linear_times(examples: Examples) -> Values:
    """The same of the linear spring at the measured peak."""
    return _times(elastic_of_peak(examples.steel, "linear_spring", examples.steel.measured_peak))


def kelvin_peak_times(examples: Examples) -> Values:
    """Times of the peak of the Kelvin family, one an assumed e."""
    return _peak_times(examples, "kelvin")


def jankowski_peak_times(examples: Examples) -> Values:
    """The same of the Jankowski family."""
    return _peak_times(examples, "jankowski")


def pulse_momenta(examples: Examples) -> Values:
    """m v of elastic pulses with the printed peaks and durations over the ball's: above one more leaves than came.

    F T/(m v) of a nonlinear elastic pulse is one number, whatever its stiffness.
    """
    steel = examples.steel
    pulse = hertz(steel, steel.contact_modulus)
    own = read(pulse, "peak_force").by(read(pulse, "duration"))
    printed = zip(steel.pulse_peaks, steel.pulse_durations, strict=True)
    return tuple(Value(force * time).over(own) for force, time in printed)


def modulus_ratio(examples: Examples) -> Values:
    """E* behind the theoretical peak over E0 behind the measured one with the printed R1, (1 + R1)(F/F')^(5/2).

    Mass, velocity and radius drop out, and the fitted solid is elastic: one material needs the ratio one.
    """
    steel = examples.steel
    return closed((1.0 + steel.R1) * (steel.theoretical_peak / steel.measured_peak) ** 2.5)


def pulse_distance(examples: Examples) -> Values:
    """Error "(20)" between the two nonlinear elastic pulses of equal impulse with the printed peaks, %.

    By the triangle inequality it lies between the difference and the sum of their errors against the experiment.
    """
    steel = examples.steel
    fitted = elastic_of_peak(steel, "hertz", steel.measured_peak)
    theoretical = elastic_of_peak(steel, "hertz", steel.theoretical_peak)
    distance = normalized_error(fitted.history, theoretical.history)
    errors = (read(result, "history_l2").error + result.tolerance for result in (fitted, theoretical))
    return (Value(distance, sum(errors)).times(PERCENT),)


def change_at_stiff_R2(examples: Examples) -> Values:
    """Relative changes of peak and duration from R2 without end to the threshold: fitted R1, then largest R1."""
    return tuple(change for R1 in _ratios(examples) for change in _from_elastic(examples, R1))


def _proposed(examples: Examples) -> Result:
    steel = examples.steel
    return solid(steel, steel.R1, steel.R2)


def _contact_modulus(examples: Examples) -> float:
    return examples.steel.young / (2.0 * (1.0 - examples.steel.nu**2))


def _times(result: Result) -> Values:
    return read(result, "peak_time", MICRO), read(result, "duration", MICRO)


def _peak_times(examples: Examples, law: str) -> Values:
    fitted = (damped_of_peak(examples.steel, law, e) for e in examples.steel.restitutions)
    return tuple(read(result, "peak_time", MICRO) for result in fitted)


def _ratios(examples: Examples) -> tuple[float, float]:
    return examples.steel.R1, max(examples.grids.fig7_R1)


def _from_elastic(examples: Examples, R1: float) -> Values:
    steel = examples.steel
    elastic, damped = hertz(steel, steel.contact_modulus * (1.0 + R1)), solid(steel, R1, examples.grids.stiff_R2)
    return tuple(read(damped, name).change_from(read(elastic, name)) for name in ("peak_force", "duration"))


MEMBER = {
    function.__name__: function
    for function in (
        ball, fall, contact_modulus, fitted_R1, memory, springs, proposed_peak, proposed_peak_time, proposed_duration,
        theoretical_peak, theoretical_peak_exact, refitted_times, hertz_times, linear_times, kelvin_peak_times,
        jankowski_peak_times, pulse_momenta, modulus_ratio, pulse_distance, change_at_stiff_R2,
    )
}  # fmt: skip
