"""The noise of each channel of transients, from all that their records show of it.

A sensor has noise of one shape in all tests; its level may differ. It shows above the motion's frequencies,
and at them in the quiet end or beginning of a record and in what two channels do not share. Repeats of a test
tell it by themselves.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from wedgesweep.diagnose.noise_bins import FEWEST, ROUNDS, OwnNoise, noise_bins, quiet_bins
from wedgesweep.diagnose.noise_spectrum import (
    BEST_FIT,
    COLOURED,
    FROM_REPEATS,
    MOST_NOISE,
    NoiseBins,
    NoiseSpectrum,
    fit_spectra,
    of_noise,
    repeat_differences,
    repeat_groups,
)
from wedgesweep.diagnose.smoothing import continuous
from wedgesweep.diagnose.transient.channel_differences import Difference, differences
from wedgesweep.measured import TestRecord
from wedgesweep.measured.declarations import MOTIONS

# Order of an acceleration, whose jumps are no noise: derivative of the displacement.
ACCELERATION = MOTIONS.index("acceleration")
# Sampling rates that differ by less than this are the same.
SAME_RATE = 1e-3
# Bins reach down to the motion if at least FEWEST of them lie below NEAR times its frequency.
NEAR = 4.0

# Channels (n,) of a test, by the order of the derivative of the displacement that each is.
Channels = Mapping[int, np.ndarray]
# A test, and the order of one of its channels. The noise of each.
Key = tuple[int, int]
Spectra = dict[Key, NoiseSpectrum]


@dataclass(frozen=True, eq=False)
class NoiseEvidence:
    """What tests of one sampling rate (Hz) show of the noise of their channels.

    ``tests``: channels of each test, by its number; ``of``: the motion that the channel of each order shows.
    """

    tests: Mapping[int, Channels]
    of: Mapping[int, str]
    rate: float

    @cached_property
    def own(self) -> dict[Key, OwnNoise]:
        """Bins above the motion; jumps of an acceleration would be there, too."""
        return {
            (t, order): noise_bins(continuous(each) if order == ACCELERATION else each)
            for t, its in self.tests.items()
            for order, each in its.items()
        }

    @cached_property
    def quiet(self) -> dict[Key, NoiseBins]:
        """Bins of the quiet part of a record that has one."""
        found = {(t, order): quiet_bins(self.tests[t][order]) for t, order in self.own}
        return {key: bins for key, bins in found.items() if bins is not None}

    @cached_property
    def shared(self) -> dict[int, list[tuple[int, int, Difference]]]:
        """Differences of channels that follow one another, with the orders of both, by test."""
        found: dict[int, list[tuple[int, int, Difference]]] = {t: [] for t in self.tests}
        orders = sorted(self.of)
        for lower, higher in pairwise(orders):
            both = [t for t, its in self.tests.items() if lower in its and higher in its]
            if not both or self.of[lower] != self.of[higher]:
                continue
            pairs = [(self.tests[t][lower], self.tests[t][higher]) for t in both]
            for t, each in zip(both, differences(pairs, higher - lower, self.rate), strict=True):
                found[t].append((lower, higher, each))
        return found

    def others(self, key: Key, first: float, known: Spectra) -> list[NoiseBins]:
        """Bins of noise of a channel below a frequency (rad a sample), from other sources than its own bins.

        These are the quiet part of its record, and differences to channels whose noise is ``known``.
        """
        t, order = key
        found = [self.quiet[key]] if key in self.quiet else []
        for lower, higher, each in self.shared[t]:
            if order == higher and (t, lower) in known:
                found.append(each.of_higher(known[t, lower]))
            elif order == lower and (t, higher) in known:
                found.append(each.of_lower(known[t, higher]))
        return [each.up_to(first) for each in found]

    def fitted(self, own: Mapping[Key, OwnNoise], known: Spectra, loss: float) -> Spectra:
        """Noise of one channel in all tests, from its ``own`` bins and from other sources."""
        bins = [[its.bins, *self.others(key, its.first, known)] for key, its in own.items()]
        coloured = COLOURED if _near_the_motion(bins, own.values()) else 0.0
        both = zip(own, fit_spectra(bins, loss, coloured), strict=True)
        return {key: each.up_to(own[key].highest) for key, each in both}

    @property
    def most(self) -> Spectra:
        """The most noise of each channel that its records allow beside the best fit of the others."""
        own = [{key: each for key, each in self.own.items() if key[1] == order} for order in self.of]
        best: Spectra = {}
        for _ in range(ROUNDS):
            for each in own:
                best |= self.fitted(each, best, BEST_FIT)
        return {key: one for each in own for key, one in self.fitted(each, best, MOST_NOISE).items()}


def _near_the_motion(tests: Sequence[Sequence[NoiseBins]], own: Iterable[OwnNoise]) -> bool:
    """Whether bins of several tests reach down to the frequency of the motion.

    If not, noise that is white above the motion may be red at it.
    """
    pairs = zip(tests, own, strict=True)
    return sum(each.up_to(NEAR * its.main).frequency.size for bins, its in pairs for each in bins) >= FEWEST


def noise_of_channels(tests: Sequence[Channels], of: Mapping[int, str], rates: Sequence[float]) -> Spectra:
    """The noise of each channel of each test; tests that were sampled alike are looked at together.

    Parameters
    ----------
    tests : sequence of mapping of int to ndarray, shape (n,)
        Samples of each channel, by the order of the derivative of the displacement that it is.
    of : mapping of int to str
        The motion that each channel shows.
    rates : sequence of float
        Sampling rates (Hz).
    """
    found: Spectra = {}
    for rows in _sampled_alike(rates):
        alike = {t: tests[t] for t in rows}
        orders = sorted({order for its in alike.values() for order in its})
        found |= NoiseEvidence(alike, {order: of[order] for order in orders}, rates[rows[0]]).most
    return found


def _sampled_alike(rates: Sequence[float]) -> list[list[int]]:
    """Places of rates that are the same but for their last digits."""
    groups: dict[float, list[int]] = {}
    for place, rate in enumerate(rates):
        alike = next((each for each in groups if abs(rate - each) < SAME_RATE * each), rate)
        groups.setdefault(alike, []).append(place)
    return list(groups.values())


def from_repeats(tests: Sequence[TestRecord], channels: Sequence[Channels]) -> Spectra:
    """Noise of tests that were run more than once, by what does not repeat."""
    found: Spectra = {}
    for rows in repeat_groups(tests):
        for order in channels[rows[0]]:
            left = repeat_differences([channels[row][order] for row in rows])
            noise = of_noise(left, FROM_REPEATS)
            found |= {(row, order): noise for row in rows}
    return found
