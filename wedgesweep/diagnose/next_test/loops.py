"""Hysteresis loops under imposed sines, to choose a next test from."""

from dataclasses import replace
from math import pi
from typing import NamedTuple

import numpy as np

from wedgesweep.diagnose.fit_parameters import Values
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.loop.recording import Recording, at_rest, moving_mass
from wedgesweep.diagnose.model import Fit
from wedgesweep.diagnose.next_test.designs import SIZES, Design
from wedgesweep.diagnose.next_test.sensors import Sensors
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.smoothing import LowPass, Motion, highest_cutoff, noise_of_motion
from wedgesweep.measured.declarations import LOOP

# Frequencies over the measured one or, where no loop was measured, over the natural one.
FREQUENCIES, OF_NATURAL = np.array([0.25, 0.5, 1.0, 2.0, 4.0]), np.array([0.1, 0.2, 0.4, 0.8])
# Highest frequency over the cut-off.
HIGHEST = 0.1
# Largest number of samples in a cycle; lower frequencies are not offered.
MOST_SAMPLES = 40_000
# Cycles of a loop, and the number of its forces that are simulated and compared.
CYCLES, COMPARED = 3.0, 240


class _ForceSensor(NamedTuple):
    """The filter in which forces are compared, and their noise.

    ``variance`` (N^2): of a compared force in a test whose force has an ``rms`` (N). Without a measured loop
    noise is a share of the force: ``variance`` is that for an rms of 1 N, and ``rms`` is None.
    """

    low_pass: LowPass
    variance: float
    rms: float | None

    def noise(self, rms: float) -> float:
        """Variance (N^2) of a compared force in a test whose force has an rms (N)."""
        return self.variance * (rms**2 if self.rms is None else max(1.0, rms / self.rms) ** 2)


def loops(best: Fit, known: Sensors, measured: LoopData | None) -> Design:
    """Loops on a grid of amplitudes and frequencies, with the noise of measured loops if there are any."""
    sensor = _assumed_sensor(best, known) if measured is None else _sensor_of(measured)
    frequencies = _frequencies(known, measured, sensor.low_pass)
    amplitude, frequency = (
        each.ravel() for each in np.meshgrid(SIZES * known.travel, frequencies, indexing="ij")
    )
    values = best.model.values(best.x)
    tests = [_recording(known, sensor, values, *each) for each in zip(amplitude, frequency, strict=True)]
    own = best.model.data
    chosen = tuple((i, 0) for i in range(len(tests)))
    data = LoopData(tuple(tests), chosen, dict(own.uncertain), own.model_error)
    numbers = [
        {"frequency_hz": f, "amplitude_mm": 1e3 * a, "duration_s": CYCLES / f}
        for a, f in zip(amplitude, frequency, strict=True)
    ]
    return Design(LOOP, None, data, numbers, (SIZES.size, frequencies.size))


def _frequencies(known: Sensors, measured: LoopData | None, low_pass: LowPass) -> np.ndarray:
    """Frequencies (Hz) whose loops the low-pass leaves as they are."""
    wanted = OF_NATURAL * known.omega / (2.0 * pi)
    if measured is not None:
        speed = max(float(np.abs(own.motion.velocity).max()) for own in measured.recordings)
        wanted = FREQUENCIES * speed / (2.0 * pi * known.travel)
    possible = wanted[(wanted <= HIGHEST * low_pass.cutoff) & (wanted >= known.rate / MOST_SAMPLES)]
    return possible if possible.size else wanted[:1]


def _sensor_of(data: LoopData) -> _ForceSensor:
    """The force sensor of the measured loops, as noisy as in the test with the most noise."""
    own = max(data.recordings, key=lambda each: each.noise)
    return _ForceSensor(own.low_pass, float(own.spectrum(np.zeros(1))[0]), float(own.force.std()))


def _assumed_sensor(best: Fit, known: Sensors) -> _ForceSensor:
    """A force sensor with as large a share of noise as that of the displacement."""
    own = best.model.data
    mass, std = moving_mass(own.model, own.law), known.displacement_noise
    force = mass * known.omega**2 * known.displacement_rms
    low_pass = LowPass(highest_cutoff(std, force, mass, known.rate), known.rate)
    return _ForceSensor(low_pass, low_pass.noise(known.share) ** 2, None)


def _recording(
    known: Sensors, sensor: _ForceSensor, values: Values, amplitude: float, frequency: float
) -> Recording:
    """A loop that was not recorded; its force is the one under the values of the best explanation."""
    low_pass, std = sensor.low_pass, known.displacement_noise
    ends, omega = low_pass.settling, 2.0 * pi * frequency
    time = np.arange(round(CYCLES / frequency * known.rate) + 2 * ends) / known.rate
    motion = Motion(
        amplitude * np.sin(omega * time),
        amplitude * omega * np.cos(omega * time),
        -amplitude * omega**2 * np.sin(omega * time),
        noise_of_motion(std, low_pass),
    )
    step = max(low_pass.stride, (time.size - 2 * ends) // COMPARED)
    places = np.arange(ends, time.size - ends, step)
    empty = Recording(
        name="",
        model=known.model,
        law=known.law,
        low_pass=low_pass,
        motion=motion,
        noise_of_displacement=std,
        places=places,
        force=np.zeros(places.size),
        known=~at_rest(motion, low_pass)[places],
        blocks=(slice(0, places.size),),
        passed_on=np.zeros((1, places.size)),
    )
    force = np.nan_to_num(empty.simulated([dict(values)], np.zeros((1, 1)))[0])
    rms = float(force[empty.known].std()) if empty.known.any() else 0.0
    # Each compared number stands for all those between it and the next.
    variance = sensor.noise(rms) * low_pass.stride / step
    noisy = empty.with_noise_of_motion(dict(values), np.zeros(1))
    return replace(noisy, force=force, spectrum=NoiseSpectrum(0.0, 0.0, variance))
