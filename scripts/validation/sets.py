"""The data sets of a campaign. What a set hides depends on its seed, kind and index only."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np


class Kind(NamedTuple):
    """Number of sets of a kind in a full campaign, and the excess chi-squared that they are drawn for.

    That of the base model, log-uniform. The excess that the diagnosis reports is the one that counts; the
    margins to its limits, 800 and 100, allow for noise.
    """

    size: int
    excess: tuple[float, float] | None = None


STRONG, WEAK = (1000.0, 30_000.0), (150.0, 700.0)
ALL = {
    "clean": Kind(60),  # nothing is hidden
    "strong": Kind(84, STRONG),  # one effect
    "weak": Kind(42, WEAK),  # one effect
    "pair": Kind(30, (1100.0, 30_000.0)),  # two effects of different families
    "unknown": Kind(30, STRONG),  # an effect that is not among the candidates
    "poor": Kind(20, (150.0, 5000.0)),  # one effect, in the paper's two tests of unknown amplitude
    "added": Kind(20),  # a poor set with the test that its diagnosis recommends
    "imperfect": Kind(60, STRONG),  # one effect, and small errors of everything, which are allowed for
    "errors-only": Kind(20),  # small errors of everything, and no effect
    "random-rig": Kind(40, STRONG),  # one effect on a rig of any size
    "oscillator": Kind(40, STRONG),  # one effect on a mass on a spring, whose input is recorded
    "transient": Kind(40),  # one effect, or none, in releases and a sweep; see time_records.py
    "loop": Kind(40),  # the same in hysteresis loops
    "mixed": Kind(20),  # the same in steady tests, releases and a loop together
    "worse": Kind(180),  # any of these three, made worse as recorders do; see worse.py
    "damper": Kind(40),  # one effect of a damper, or none, in its loops; see time_records.py
    "constant": Kind(12, STRONG),  # one effect on a bench with constant damping
    "load": Kind(10, WEAK),  # more preload or friction, in four tests that record the load of the column
    "no-load": Kind(10, WEAK),  # the same without that channel
    "warm": Kind(40),  # thermal drift, a neighbour of it or none, in loops at several temperatures
    "force": Kind(80),  # a force that is no candidate; a known effect or none in every fourth
}
KINDS = tuple(ALL)
SHARED = {"added": "poor", "no-load": "load"}


@dataclass(frozen=True)
class DataSet:
    """One data set of a campaign; ``ablated``: the stage that its diagnosis leaves out."""

    kind: str
    index: int
    seed: int
    ablated: str = ""

    @property
    def name(self) -> str:
        return f"{self.kind}-{self.index:03d}"

    @property
    def original(self) -> "DataSet":
        """The set whose draw an ``added`` or a ``no-load`` set shares; every other set itself."""
        return replace(self, kind=SHARED.get(self.kind, self.kind))

    def random(self, attempt: int = 0) -> np.random.Generator:
        """A generator of its own, so that a campaign of another size draws the same sets."""
        return np.random.default_rng([self.seed, KINDS.index(self.original.kind), self.index, attempt])

    @property
    def noise_seed(self) -> int:
        return int(self.random().integers(2**31))

    def draw_target(self, random: np.random.Generator) -> float:
        """Draw the excess chi-squared that the set should have."""
        limits = ALL[self.kind].excess
        assert limits is not None
        low, high = np.log(limits)
        return float(np.exp(random.uniform(low, high)))


def chains(seed: int, size: float, only: tuple[str, ...] = (), ablated: str = "") -> list[list[DataSet]]:
    """Lists of sets to be run one after the other, as an ``added`` set needs its poor set.

    The kinds alternate, so that an interrupted campaign is a sample of all of them.
    """
    kinds = only or KINDS
    wanted = {kind: max(1, round(ALL[kind].size * size)) for kind in kinds}
    if "added" in kinds:
        wanted["poor"] = max(wanted.get("poor", 0), wanted["added"])
    placed = []
    for kind, count in wanted.items():
        for index in range(count if kind != "added" else 0):
            chain = [DataSet(kind, index, seed, ablated)]
            if kind == "poor" and index < wanted.get("added", 0):
                chain.append(replace(chain[0], kind="added"))
            placed.append(((index + 0.5) / count, chain))
    return [chain for _, chain in sorted(placed, key=lambda each: each[0])]
