"""What the tests at hand show of tests to come: noise of the sensors, sampling, size of the motion."""

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum

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


def beside_signal(noise: NoiseSpectrum, rms: float, measured: float) -> NoiseSpectrum:
    """The noise beside a signal of some ``rms``, if it was measured beside one of rms ``measured``.

    Larger signals take sensors of a larger range, whose noise is larger in proportion.
    """
    return noise.amplified(max(1.0, rms / max(measured, 1e-300)))


def median_test(tests: tuple[Each, ...], share: Callable[[Each], float]) -> Each:
    """The test whose share of noise is the median one."""
    order = np.argsort([share(each) for each in tests])
    return tests[int(order[len(tests) // 2])]
