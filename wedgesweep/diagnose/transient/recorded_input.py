"""The recorded input of a transient: what acts in a simulation, and how its noise reaches the response."""

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi

import numpy as np
from scipy import signal

from wedgesweep.diagnose.noise_bins import noise_of_record
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum, white_noise
from wedgesweep.diagnose.smoothing import SETTLING, derivative
from wedgesweep.diagnose.transient.input_noise import InputNoise
from wedgesweep.periodogram import power_of
from wedgesweep.sampled_input import INTEGRATED, SampledInput, from_samples

# Cut-off of the input over the highest frequency that stands out in it: what lies above is noise, whose
# acceleration would shake a mass loose that sticks. Order of the low-pass filter.
KEPT, ORDER = 1.4, 8
# Cut-off (cycles a sample) from which on the input is not filtered, and samples that are kept in a period of
# the cut-off.
HIGHEST, SAMPLED = 0.4, 8.0
# Both ends of a record are at rest if END samples at each lie within REST standard deviations of white noise:
# the range of twice as many normal variables is smaller in 99 % of all cases.
END, REST = 16, 6.0
# Share of the range of an input at which it begins to act.
BEGINS = 0.05
# Largest rms of the input's noise over that of the input: where all that moves the base looks like noise,
# most of it is not.
LARGEST_NOISE = 0.05
# Bins over which the spectrum of the input is averaged, as a share of all.
AVERAGED = 0.01


@dataclass(frozen=True, eq=False)
class RecordedInput:
    """A recorded input: ``samples`` (n,) of a ``quantity`` (SI) at a ``rate`` (Hz), and their noise."""

    samples: np.ndarray
    quantity: str
    rate: float

    @cached_property
    def noise(self) -> NoiseSpectrum:
        return noise_of_record(self._centred)

    @cached_property
    def _centred(self) -> np.ndarray:
        """Samples (n,) for spectra: shifted in a circle, the largest to the middle, if both ends are at rest.

        A Hann window hides what happens near an end, such as a hit at the beginning.
        """
        ends = np.r_[self.samples[:END], self.samples[-END:]]
        if np.ptp(ends) > REST * white_noise(self.samples):
            return self.samples
        largest = int(np.argmax(np.abs(self.samples - ends.mean())))
        return np.roll(self.samples, self.samples.size // 2 - largest)

    @cached_property
    def size(self) -> float:
        """Largest value of the input about its mean."""
        return float(np.abs(self.samples - self.samples.mean()).max())

    @property
    def begins(self) -> int:
        """Number of the sample at which the input begins to act."""
        return int(np.argmax(np.abs(self.samples - self.samples[0]) > BEGINS * np.ptp(self.samples)))

    @property
    def _cutoff(self) -> float:
        """Cut-off of the input in cycles a sample."""
        return KEPT * self.noise.highest / (2.0 * pi)

    @property
    def settling(self) -> int:
        """Samples at either end of the record at which the filter has not settled."""
        return ceil(SETTLING / self._cutoff) if self._cutoff < HIGHEST else 0

    @cached_property
    def acting(self) -> SampledInput:
        """The input as it acts in simulations, low-passed; its time counts from the first sample."""
        cutoff, smooth, stride = self._cutoff, self.samples, 1
        if cutoff < HIGHEST:
            sections = signal.butter(ORDER, cutoff, fs=1.0, output="sos")
            smooth = signal.sosfiltfilt(sections, self.samples)
            stride = max(int(1.0 / (SAMPLED * cutoff)), 1)
        values, step = smooth[::stride], stride / self.rate
        if self.quantity in ("displacement", "force"):
            return from_samples(values, step, self.quantity)
        # The base is taken to come back to where it was: its start and its mean velocity leave no trend.
        drifting = from_samples(values, step, self.quantity)
        times = step * np.arange(values.size)
        slope, start = np.polyfit(times, drifting(times), 1)
        velocity = -slope if self.quantity == "acceleration" else 0.0
        return from_samples(values, step, self.quantity, start=(-start, velocity))

    @property
    def displacement(self) -> np.ndarray:
        """Displacement (m) of the base at the samples."""
        if self.quantity == "displacement":
            return self.samples
        return self.acting(np.arange(self.samples.size) / self.rate)

    def derivative(self, order: int) -> np.ndarray:
        """Displacement (m) of the base at the samples, or its derivative of an order up to 2 (SI)."""
        if order == 0:
            return self.displacement
        if order == 1:
            return derivative(self.displacement, self.rate)
        return self.acting(np.arange(self.samples.size) / self.rate, 2)

    @cached_property
    def noise_power(self) -> np.ndarray:
        """Power (f,) of the noise of a sample by frequency, from 0 to half the sampling rate."""
        given = _power(self._centred)
        noise = np.minimum(self.noise(np.linspace(0.0, pi, given.size)), given)
        return noise * min(LARGEST_NOISE**2 * given.sum() / max(noise.sum(), 1e-300), 1.0)

    def input_noise(self, shares: tuple[float, ...]) -> InputNoise:
        """The noise as it acts; ``shares`` (C,): of the base's displacement in each channel."""
        cutoff = 2.0 * pi * min(self._cutoff, 0.5)
        return InputNoise(self.noise_power, INTEGRATED[self.quantity], cutoff, shares)


def starting_at(given: SampledInput, start: float) -> SampledInput:
    """The input for a simulation that starts at a time (s) of it."""
    return replace(given, begin=given.begin - start)


def no_input(span: float) -> SampledInput:
    """An input that is zero for some time (s)."""
    return from_samples(np.zeros(2), span)


def _power(samples: np.ndarray) -> np.ndarray:
    """Power (n // 2 + 1,) of samples (n,) by frequency, averaged over neighbours."""
    found = power_of(samples - samples.mean())
    kernel = np.ones(2 * max(int(AVERAGED * found.size), 3) + 1)
    return np.convolve(found, kernel, mode="same") / np.convolve(np.ones(found.size), kernel, mode="same")
