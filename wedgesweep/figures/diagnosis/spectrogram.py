"""Which frequencies a motion has at which time: measured, and in what the models leave of it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from scipy.signal import spectrogram

from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.figures.diagnosis import marks, selection
from wedgesweep.figures.panels import Panels, Target, panels

NAME = "spectrogram"
DESCRIPTION = "frequencies over time of the measured motion, and of what the models leave"
TESTS = "transient"

RECORDS_SHOWN = 4  # records
FEWEST = 1024  # samples of a record
WINDOWS = 24  # of a record, side by side; they overlap
OVERLAP = 0.875
LEVELS = 60.0  # dB below the largest, unless the noise is above that
# Power of CLEAR times the noise stands out; frequencies above the highest such power are not shown.
CLEAR = 20.0
COLORS = colormaps["BuPu"]


class Record(NamedTuple):
    """A record: index of its first test, times (n,) in s, and signals (n,) in m, the measured one first.

    ``noise``: of a sample (m).
    """

    test: int
    time: np.ndarray
    signals: list[np.ndarray]
    noise: float


class Spectra(NamedTuple):
    """Times (s), frequencies (Hz), power (signals, frequencies, times), power of the noise (m^2/Hz)."""

    time: np.ndarray
    frequency: np.ndarray
    power: np.ndarray
    noise: float

    @property
    def largest(self) -> float:
        """Largest power of the measured motion."""
        return float(self.power[0].max()) or 1.0

    @property
    def lowest(self) -> float:
        """Level (dB below the largest) up to which all is pale: noise."""
        return max(-LEVELS, 10.0 * np.log10(max(CLEAR / 4.0 * self.noise / self.largest, 1e-30)))

    @property
    def highest(self) -> float:
        """Frequency (Hz) above which nothing stands out."""
        least = max(CLEAR * self.noise, 10.0 ** (-LEVELS / 10.0) * self.largest)
        places = np.flatnonzero((self.power > least).any(axis=(0, 2)))
        return float(self.frequency[min(1 + (places[-1] if places.size else 0), self.frequency.size - 1)])


def records(result: DiagnosisResult, tests: Sequence[int]) -> list[Record]:
    """Records of the tests; tests that follow one another without a gap are parts of one record."""
    found: list[Record] = []
    for test in sorted(tests):
        part = _part(result, test)
        if found and _follows(found[-1].time, part.time):
            first = found.pop()
            joined = [np.concatenate(both) for both in zip(first.signals, part.signals, strict=True)]
            part = Record(first.test, np.concatenate([first.time, part.time]), joined, first.noise)
        found.append(part)
    return found


def _long(result: DiagnosisResult, tests: Sequence[int] | None) -> list[Record]:
    """Records of the tests that are long enough."""
    chosen = list(range(result.data.sizes["test"]) if tests is None else tests)
    return [each for each in records(result, chosen) if each.time.size >= FEWEST]


def possible(result: DiagnosisResult) -> bool:
    """Whether a record of transients is long enough to be drawn."""
    return "measured" in result.data and bool(_long(result, None))


def _part(result: DiagnosisResult, test: int) -> Record:
    data = result.data.isel(test=test, channel=0)
    measured = data["measured"].values
    there = np.isfinite(measured)
    left = [_left(data, model)[there] for model in result.models]
    noise = float(data["sample_noise"])
    return Record(test, data["time"].values[there], [measured[there], *left], noise)


def _left(data: xr.Dataset, model: str) -> np.ndarray:
    return np.nan_to_num((data["measured"] - data["simulated"].sel(model=model)).values)


def _follows(before: np.ndarray, after: np.ndarray) -> bool:
    step = before[1] - before[0]
    return bool(abs(after[0] - before[-1] - step) < 0.5 * step)


def spectra(record: Record) -> Spectra:
    """Power of the measured motion and of what each model leaves."""
    count = record.time.size
    # A power of two that gives about WINDOWS windows.
    size = 1 << int(np.log2(count / WINDOWS))
    rate = (count - 1) / (record.time[-1] - record.time[0])
    frequency, middle, power = spectrogram(
        np.array(record.signals), rate, "hann", size, int(OVERLAP * size), detrend="linear"
    )
    return Spectra(record.time[0] + middle, frequency, power, 2.0 * record.noise**2 / rate)


def _draw(ax: Axes, of: Spectra, place: int, lowest: float) -> None:
    ax.grid(visible=False)
    level = 10.0 * np.log10(np.maximum(of.power[place] / of.largest, 1e-30))
    ax.pcolormesh(of.time, of.frequency, level, cmap=COLORS, vmin=lowest, vmax=0.0, rasterized=True)
    ax.set_ylim(0.0, of.highest)


def draw(target: Target, result: DiagnosisResult, tests: Sequence[int] | None = None) -> Panels:
    """Draw a row per record (default: four): the measured motion, then what each model leaves of it.

    To see: dark is strong. A line that rises is a sweep. What the base model leaves along the strongest
    line of the measured motion is a wrong amplitude or phase, what it leaves at multiples of it is
    friction, a stop or play.
    """
    long = _long(result, tests)[:RECORDS_SHOWN]
    if not long:
        raise ValueError(f"no record has {FEWEST} samples or more")
    titles = ["measured", *(f"left by {name}" for name in marks.names(result).values())]
    columns = len(titles)
    made = panels(target, columns * len(long), columns=columns, size=(3.0, 2.1), share=False)
    drawn = [spectra(record) for record in long]
    lowest = min(of.lowest for of in drawn)
    for row, (record, of) in enumerate(zip(long, drawn, strict=True)):
        for place, ax in enumerate(made.axes[row * columns : (row + 1) * columns]):
            _draw(ax, of, place, lowest)
            ax.set_xlabel("time [s]", fontsize=8.5)
            name = f"{selection.label(result.data, record.test)}\n" if not place else ""
            ax.set_title(f"{name}{titles[place]}", fontsize=8.5)
        made.axes[row * columns].set_ylabel("frequency [Hz]", fontsize=8.5)
    made.colorbar(ScalarMappable(Normalize(lowest, 0.0), COLORS), "power below the largest [dB]")
    made.title("Frequencies of the motion over time, and of what the models leave")
    return made
