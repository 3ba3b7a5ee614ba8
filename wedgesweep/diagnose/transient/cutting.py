"""Cut records into windows, so that errors of phase do not add up over a long one."""

from collections.abc import Sequence
from math import ceil, floor, pi
from typing import NamedTuple

import numpy as np

from wedgesweep.config import Config
from wedgesweep.diagnose.noise_spectrum import NoiseSpectrum
from wedgesweep.diagnose.sampled_data import LARGEST_BLOCK
from wedgesweep.diagnose.smoothing import HIGHEST, LowPass
from wedgesweep.diagnose.transient.recorded_input import RecordedInput, no_input, starting_at
from wedgesweep.diagnose.transient.window import Grid, RecordWindow
from wedgesweep.errors import InputError
from wedgesweep.measured.stationarity import median_frequency

# Natural periods of a window, and of what is simulated before it so that the start of bristles is forgotten;
# the latter under an input, which keeps lifting wedges off: they forget their start later.
WINDOW, LEAD, DRIVEN_LEAD = 10.0, 1.0, 1.5
# Share of a record under an input, at most, that is simulated before its first window; or in which the filter
# of the input settles, at either end.
LEAD_SHARE = 0.125
# A single record is cut into at least FEWEST windows, if each has SHORTEST natural periods. Friction ends
# many free motions after six to nine.
FEWEST, SHORTEST = 3, 2.0
# Highest frequency that is compared, over the natural frequency and over the highest that stands out.
HARMONICS, BEYOND = 8.0, 2.0
# Share of the record at its end whose mean is where the motion comes to rest.
REST = 0.1
# Fewest coefficients that are compared, and smallest motion in a window over that in the record.
FEWEST_COMPARED, SMALL = 8, 1e-3
# Fewest samples per natural period: a swing must show.
SLOWEST = 2.0


class Recorded(NamedTuple):
    """The record of a test before it is cut.

    ``channels`` (C, n) sampled at a ``rate`` (Hz); ``spectra``: noise of each; ``input``: None if it was not
    recorded; ``number``: index of the test. ``orders`` (C,): derivative of the displacement that each channel
    is; ``shares`` (C,): share of the base's motion that was added to each.
    """

    name: str
    channels: np.ndarray
    rate: float
    spectra: Sequence[NoiseSpectrum]
    input: RecordedInput | None
    number: int
    orders: tuple[int, ...]
    shares: tuple[float, ...]


def highest_compared(record: Recorded, model: Config) -> float:
    """Highest frequency (rad a sample) that is compared of a record."""
    own = HARMONICS * 2.0 * pi / _period(record, model)
    seen = [each.highest for each in record.spectra]
    if record.input is not None:
        seen.append(record.input.noise.highest)
    return max(own, BEYOND * min(seen))


class Cut(NamedTuple):
    """Samples of a window: its ``first`` one, those inside it, and the ``lead`` that is simulated before."""

    first: int
    inside: int
    lead: int


def cuts(samples: int, period: float, skipped: int, fewest: int, begins: int = 0) -> list[Cut]:
    """Windows of equal length, about WINDOW natural periods each.

    Parameters
    ----------
    samples : int
        Length of the record.
    period : float
        Natural period in samples.
    skipped : int
        Samples at either end in which the filter of the input has not settled; 0 without an input.
    fewest : int
        Number of windows to make at least, as far as each has SHORTEST natural periods.
    begins : int
        Sample at which the input begins to act. Until then nothing moves that has to be forgotten, and a hit
        in the lead would tell nothing: any start may take its place.
    """
    compared = samples - 2 * skipped
    lead = ceil((DRIVEN_LEAD if skipped else LEAD) * period)
    # The lead of the first window comes after what is skipped.
    first_lead = min(lead, int(LEAD_SHARE * compared)) if skipped else 0
    if skipped < begins < skipped + first_lead:
        first_lead = begins - skipped
    compared -= first_lead
    total = compared / period
    count = max(round(total / WINDOW), min(fewest, floor(total / SHORTEST)), 1)
    inside = compared // count
    firsts = [skipped + first_lead + place * inside for place in range(count)]
    return [Cut(first, inside, min(lead, first - skipped)) for first in firsts]


def windows(record: Recorded, model: Config, law: str, fewest: int = 1) -> list[RecordWindow]:
    """Windows of a record; ``fewest``: see ``cuts``."""
    rate, given = record.rate, record.input
    period, top = _period(record, model), highest_compared(record, model)
    if period < SLOWEST:
        fault = f"{period:.2g} samples per natural period of the model"
        raise InputError([f"{fault}; sample faster, or correct the unit of time"])
    displacement = _displacement(record, 2.0 * pi / period)
    rest, length = _extent(displacement)
    smooth = LowPass(min(top / (2.0 * pi), HIGHEST), 1.0)(displacement) - rest
    slope = np.gradient(smooth) * rate
    samples = record.channels.shape[1]
    skipped, begins = (min(given.settling, int(LEAD_SHARE * samples)), given.begins) if given else (0, 0)
    parts = cuts(samples, period, skipped, fewest, begins)
    input_noise = given.input_noise(record.shares) if given else None
    most = LARGEST_BLOCK if given else samples  # noise of an input reaches no more coefficients
    found = []
    for place, (first, inside, lead) in enumerate(parts, 1):
        start, end = first - lead, first + inside
        found.append(
            RecordWindow(
                name=record.name if len(parts) == 1 else f"{record.name} {place}",
                model=model,
                law=law,
                step=1.0 / rate,
                begins=first / rate,
                number=record.number,
                channels=record.channels[:, first:end],
                rms=record.channels.std(axis=1),
                spectra=tuple(record.spectra),
                coefficients=min(max(ceil(top * inside / pi), FEWEST_COMPARED), most, inside),
                grid=Grid(lead, inside, 2.0 * pi * rate / period),
                input=starting_at(given.acting, start / rate) if given else no_input((end - start) / rate),
                input_noise=input_noise,
                length=max(float(np.abs(displacement[start:end] - rest).max()), SMALL * length),
                guess=(float(smooth[start]), float(slope[start])),
                orders=record.orders,
            )
        )
    return found


def _displacement(record: Recorded, omega: float) -> np.ndarray:
    """Displacement (n,); where none was recorded, roughly that at which the spring accelerates the mass so.

    ``omega``: angular natural frequency in rad a sample.
    """
    if record.orders[0] == 0:
        return record.channels[0]
    last = record.channels[-1] / record.rate ** record.orders[-1]
    acceleration = last if record.orders[-1] > 1 else np.gradient(last)
    return -acceleration / omega**2


def _extent(displacement: np.ndarray) -> tuple[float, float]:
    """Displacement at which a motion (n,) comes to rest, and its largest distance from there."""
    rest = float(displacement[-max(int(REST * displacement.size), 1) :].mean())
    return rest, max(float(np.abs(displacement - rest).max()), 1e-300)


def _period(record: Recorded, model: Config) -> float:
    """Natural period of the model in samples; without a spring that of the input, or all of the record."""
    frequency = record.rate / record.channels.shape[1]
    if record.input is not None:
        frequency = max(frequency, median_frequency(record.input.samples, record.rate))
    length = _extent(record.channels[0])[1]
    return 2.0 * pi * model.natural_units(length, 2.0 * pi * frequency).time * record.rate
