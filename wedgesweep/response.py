"""Numbers from the kept window of one run, with the paper's sign: displacement x - y = -z."""

from dataclasses import dataclass
from math import atan2, cos, inf, nan, pi, sin

import numpy as np

from wedgesweep import sensor
from wedgesweep.compiled import allocating, compiled, inner, term
from wedgesweep.effects.states import input_length
from wedgesweep.solvers.trajectory import Trajectory

# The numbers of a response (see variables.VARIABLES), a record.
NUMBERS = np.dtype(
    [
        (name, np.float64)
        for name in (
            "amplitude_ratio",
            "peak_to_peak",
            "peak_velocity",
            "mean_displacement",
            "stick_fraction",
            "stick_phases",
            "minimum_normal_force",
            "column_force_mean",
            "column_force_min",
            "column_force_max",
            "bolster_force_mean",
            "bolster_force_min",
            "bolster_force_max",
            "lift_off_fraction",
            "dissipated_energy",
            "supplied_energy",
            "phase_lag",
            "periodicity",
            "column_open_fraction",
            "bolster_open_fraction",
            "impacts",
            "largest_impulse",
            "impact_energy",
        )
    ]
)
# A fundamental below this share of the input amplitude has no meaningful phase.
NO_MOTION = 1e-9


@inner
def mean_period(signal, sign, out):
    """Write the mean of the periods of a signal times a sign, each as many samples as ``out`` holds."""
    for i in range(out.size):
        total = 0.0
        for k in range(i, signal.size, out.size):
            total += signal[k]
        out[i] = sign * total * (out.size / signal.size)


@inner
def fourier(first, second, out):
    """Write D_h, h = 1..n, of two signals = Re sum D_h exp(i h omega t); out: (2, n, 2), real, imaginary.

    The signals, shape (samples,), cover one forcing period on an even grid. Both share one rotation, and so
    do samples that lie as far before the end of the period as others do after its start.
    """
    samples = first.size
    for h in range(1, out.shape[1] + 1):
        turn_cos, turn_sin = cos(2.0 * pi * h / samples), sin(2.0 * pi * h / samples)
        c, s, real, imaginary, other_real, other_imaginary = 1.0, 0.0, first[0], 0.0, second[0], 0.0
        for i in range(1, (samples + 1) // 2):
            c, s = c * turn_cos - s * turn_sin, s * turn_cos + c * turn_sin
            real += (first[i] + first[samples - i]) * c
            imaginary -= (first[i] - first[samples - i]) * s
            other_real += (second[i] + second[samples - i]) * c
            other_imaginary -= (second[i] - second[samples - i]) * s
        if samples % 2 == 0:
            middle = 1.0 - 2.0 * (h % 2)
            real += middle * first[samples // 2]
            other_real += middle * second[samples // 2]
        out[0, h - 1, 0], out[0, h - 1, 1] = 2.0 * real / samples, 2.0 * imaginary / samples
        out[1, h - 1, 0], out[1, h - 1, 1] = 2.0 * other_real / samples, 2.0 * other_imaginary / samples


@inner
def _phase_lag(real, imaginary, amplitude):
    """Lag (rad, -pi to pi) of a fundamental behind u = a sin(omega t) = Re -i a exp(i omega t)."""
    if real * real + imaginary * imaginary < (NO_MOTION * amplitude) ** 2:
        return nan
    # The angle of -i / (real + i imaginary).
    return atan2(-real, -imaginary)


@inner
def _change(signal, periods):
    """Largest difference between the last period and the one before it."""
    samples = signal.size // periods
    largest = 0.0
    for i in range(signal.size - samples, signal.size):
        largest = max(largest, abs(signal[i] - signal[i - samples]))
    return largest


@term("lift_off", off="False")
def _opens(p):
    """Whether joints may lift off."""
    return p.lift_off.restitution >= 0.0


@inner
def _forces_on_faces(sums):
    """Mean, smallest and largest normal force (N) of each contact while it is determined; else NaN."""
    if sums.determined == 0.0:
        return nan, nan, nan, nan, nan, nan
    first, second = sums.first_sum / sums.determined, sums.second_sum / sums.determined
    return first, sums.first_least, sums.first_most, second, sums.second_least, sums.second_most


@allocating
def reduce(sums, x, velocity, periods, p, numbers, spectra):
    """Write the numbers, a record of ``NUMBERS``, and the spectra of displacement and velocity.

    ``x`` and ``velocity`` are the samples of the kept window; ``spectra`` has shape (2, n, 2): displacement
    or velocity, harmonic, real or imaginary part. Both are as the sensors show them.
    """
    mean = np.empty((2, x.size // periods))
    mean_period(x, -1.0, mean[0])
    mean_period(velocity, -1.0, mean[1])
    fourier(mean[0], mean[1], spectra)
    gain, amplitude = p.displacement_gain.scale, input_length(p)
    slipping_time = sums.time - (sums.stuck_time if p.friction.set_valued else 0.0)
    # The window closes on itself: sticking that runs over its end is one phase.
    onsets = sums.onsets - sums.began_stuck * sums.is_stuck
    numbers.peak_to_peak = (sums.highest - sums.lowest) * gain
    numbers.amplitude_ratio = 0.5 * numbers.peak_to_peak / amplitude
    numbers.peak_velocity = sums.peak_velocity
    numbers.mean_displacement = -sums.integral / sums.time * gain
    numbers.stick_fraction = sums.stuck_time / sums.time
    numbers.stick_phases = onsets / periods
    smallest = min(sums.first_least, sums.second_least)
    numbers.minimum_normal_force = smallest if smallest < inf else nan
    (
        numbers.column_force_mean,
        numbers.column_force_min,
        numbers.column_force_max,
        numbers.bolster_force_mean,
        numbers.bolster_force_min,
        numbers.bolster_force_max,
    ) = _forces_on_faces(sums)
    numbers.lift_off_fraction = sums.lifted_time / slipping_time if slipping_time > 0.0 else nan
    if _opens(p):
        numbers.lift_off_fraction = sums.either_open / sums.time
    numbers.dissipated_energy = sums.dissipated / periods
    numbers.supplied_energy = sums.supplied / periods
    numbers.phase_lag = _phase_lag(spectra[0, 0, 0], spectra[0, 0, 1], amplitude)
    numbers.periodicity = _change(x, periods) / amplitude
    numbers.column_open_fraction = sums.first_open / sums.time
    numbers.bolster_open_fraction = sums.second_open / sums.time
    numbers.impacts = sums.impacts / periods
    numbers.largest_impulse = sums.impulse
    numbers.impact_energy = sums.struck / periods
    sensor.apply_to_spectra(spectra, p)
    if p.velocity_lag.time > 0.0:
        numbers.peak_velocity = 0.0
        for seen in channels(x, velocity, periods, p)[1]:
            numbers.peak_velocity = max(numbers.peak_velocity, abs(seen))


@allocating
def channels(x, velocity, periods, p):
    """Deflection and velocity over whole periods of a kept window as the sensors show them."""
    return _sensed(x, velocity, 2.0 * pi / p.input.omega * periods / velocity.size, True, p)


@allocating
def _sensed(x, velocity, step, periodic, p):
    seen = np.empty(x.size)
    for i in range(x.size):
        seen[i] = p.displacement_gain.scale * x[i]
    return seen, sensor.lagged(velocity, step, periodic, p)


@compiled
def sensed(x, velocity, step, parameters):
    """Deflection and velocity, as ``channels``, of a motion that does not repeat; ``step`` (s) apart."""
    return _sensed(x, velocity, step, False, parameters[0])


@compiled
def _reduce_and_sense(sums, samples, periods, p, numbers, spectra):
    """``reduce`` and ``channels``; ``samples``: displacement and velocity."""
    reduce(sums[0], samples[0], samples[1], periods, p[0], numbers[0], spectra)
    return channels(samples[0], samples[1], periods, p[0])


@dataclass(frozen=True)
class Response:
    """What a run comes to: variables of variables.VARIABLES by name (SI units).

    ``spectra`` have shape (harmonics, 2), real and imaginary parts; ``waveforms`` shape (samples,).
    """

    numbers: dict[str, float]
    spectra: dict[str, np.ndarray]
    waveforms: dict[str, np.ndarray]


def evaluate(trajectory: Trajectory, parameters: np.ndarray, harmonics: int) -> Response:
    """Reduce a trajectory to its response."""
    samples = trajectory.samples
    numbers, spectra = np.zeros(1, NUMBERS), np.empty((2, harmonics, 2))
    motion = (samples.x, samples.velocity)
    x, velocity = _reduce_and_sense(trajectory.sums, motion, trajectory.periods, parameters, numbers, spectra)
    waveforms = {
        "displacement": -x,
        "velocity": -velocity,
        "normal_force_column": samples.normal[0],
        "normal_force_bolster": samples.normal[1],
        "stuck": samples.sticks,
    }
    return Response(
        {name: float(numbers[name][0]) for name in NUMBERS.names or ()},
        {"displacement_harmonics": spectra[0], "velocity_harmonics": spectra[1]},
        waveforms,
    )
