"""What the tests at hand show of tests to come: noise of the sensors, sampling, size of the motion."""

from collections.abc import Callable
from dataclasses import replace
from functools import singledispatch
from typing import NamedTuple, TypeVar

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.fit_data import FitData
from wedgesweep.diagnose.loop.loop_data import LoopData
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData
from wedgesweep.diagnose.transient.transient_data import TransientData

Each = TypeVar("Each")


class Sensors(NamedTuple):
    """The C channels of a typical test, and the size of motions and inputs in all tests.

    ``rate`` (Hz) of sampling; ``spectra``: noise of the channels; ``rms`` (C,) of these (m, m/s, m/s^2);
    ``travel`` (m): the largest displacement of all tests; ``orders`` (C,): the derivative of the displacement
    that each channel is; ``drive`` (m): the largest recorded input as a displacement, 0 for none.
    """

    model: Config
    law: str
    rate: float
    spectra: tuple[NoiseSpectrum, ...]
    rms: np.ndarray
    travel: float
    orders: tuple[int, ...]
    drive: float = 0.0

    @property
    def share(self) -> float:
        """Noise of the first channel over its rms."""
        return self.spectra[0].std / float(self.rms[0])

    @property
    def displacement_rms(self) -> float:
        """Rms (m) of the displacement, from the first channel at the natural frequency."""
        return float(self.rms[0]) / self.omega ** self.orders[0]

    @property
    def displacement_noise(self) -> float:
        """Standard deviation (m) of a displacement with as large a share of noise as the first channel."""
        return self.share * self.displacement_rms

    @property
    def omega(self) -> float:
        """Angular natural frequency (rad/s) of the model."""
        return 1.0 / self.model.natural_units(self.travel).time


def amplified(noise: NoiseSpectrum, factor: float) -> NoiseSpectrum:
    """Spectrum of noise whose samples are larger by a factor."""
    likewise = tuple(amplified(each, factor) for each in noise.likewise)
    return replace(noise, red=factor**2 * noise.red, white=factor**2 * noise.white, likewise=likewise)


def beside_signal(noise: NoiseSpectrum, rms: float, measured: float) -> NoiseSpectrum:
    """The noise beside a signal of some ``rms``, if it was measured beside one of rms ``measured``.

    Larger signals take sensors of a larger range, whose noise is larger in proportion.
    """
    return amplified(noise, max(1.0, rms / max(measured, 1e-300)))


@singledispatch
def sensors(data: FitData) -> Sensors:
    """The sensors of the test whose share of noise is the median of all tests."""
    raise NotImplementedError(type(data).__name__)


@sensors.register
def _(data: TransientData) -> Sensors:
    own = _median(data.windows, lambda each: each.spectra[0].std / max(float(each.rms[0]), 1e-300))
    travel = max(each.length for each in data.windows)
    drive = 0.0
    for each in data.windows:
        if each.driven:
            times = np.arange(each.grid.samples) * each.step
            drive = max(drive, 0.5 * float(np.ptp(each.input(times))))
    drive /= data.units.mass / data.units.time**2 if data.model.forced else 1.0
    return Sensors(data.model, data.law, 1.0 / own.step, own.spectra, own.rms, travel, own.orders, drive)


@sensors.register
def _(data: LoopData) -> Sensors:
    own = _median(
        data.recordings, lambda each: each.noise_of_displacement / float(each.motion.displacement.std())
    )
    rms = np.array([own.motion.displacement.std()])
    travel = max(0.5 * float(np.ptp(each.motion.displacement)) for each in data.recordings)
    noise = NoiseSpectrum(0.0, 0.0, max(own.noise_of_displacement, 1e-9 * travel) ** 2)
    return Sensors(data.model, data.law, own.low_pass.rate, (noise,), rms, travel, (0,))


@sensors.register
def _(data: HarmonicData) -> Sensors:
    rms = [np.sqrt(0.5 * (np.abs(each.mean) ** 2).sum(axis=1)) for each in data.spectra]
    share = [float(s.sample_noise[0] / size[0]) for s, size in zip(data.spectra, rms, strict=True)]
    place = int(np.argsort(share)[len(share) // 2])
    own = data.spectra[place]
    spectra = tuple(NoiseSpectrum(0.0, 0.0, float(std) ** 2) for std in own.sample_noise[:2])
    travel = max(float(np.abs(each.mean[0]).sum()) for each in data.spectra)
    orders = tuple(range(len(spectra)))
    return Sensors(data.model, data.law, 1.0 / own.interval, spectra, rms[place][:2], travel, orders)


def _median(tests: tuple[Each, ...], share: Callable[[Each], float]) -> Each:
    """The test whose share of noise is the median one."""
    order = np.argsort([share(each) for each in tests])
    return tests[int(order[len(tests) // 2])]
