"""The data sets of a campaign. What a set hides depends on its seed, kind and index only."""

from dataclasses import dataclass, replace

import numpy as np

# Sets of each kind in a full campaign:
#   clean           nothing is hidden
#   strong, weak    one effect
#   pair            two effects of different families
#   unknown         an effect that is not among the candidates
#   poor            one effect, in the paper's two tests of unknown amplitude
#   added           a poor set with the test that its diagnosis recommends
#   imperfect       one effect, and small errors of everything; a model error is allowed for
#   errors-only     small errors of everything, and no effect
#   random-rig      one effect on a rig of any size
#   oscillator      one effect on a mass on a spring, whose input is recorded
#   transient       one effect, or none, in releases and a sweep; see time_records.py
#   loop            the same in hysteresis loops
#   mixed           the same in steady tests, releases and a loop together
SIZES = {
    **{"clean": 60, "strong": 84, "weak": 42, "pair": 30, "unknown": 30, "poor": 20, "added": 20},
    **{"imperfect": 60, "errors-only": 20, "random-rig": 40, "oscillator": 40},
    **{"transient": 40, "loop": 40, "mixed": 20},
}
KINDS = tuple(SIZES)
# Range of the excess chi-squared of the base model that a set is drawn for, log-uniformly. The excess that
# the diagnosis reports is the one that counts; the margins to its limits, 800 and 100, allow for noise.
TARGETS = {
    "strong": (1000.0, 30_000.0),
    "weak": (150.0, 700.0),
    "pair": (1100.0, 30_000.0),
    "unknown": (1000.0, 30_000.0),
    "poor": (150.0, 5000.0),
    "imperfect": (1000.0, 30_000.0),
    "random-rig": (1000.0, 30_000.0),
    "oscillator": (1000.0, 30_000.0),
}


@dataclass(frozen=True)
class DataSet:
    """One data set of a campaign."""

    kind: str
    index: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.kind}-{self.index:03d}"

    @property
    def original(self) -> "DataSet":
        """The poor set that an ``added`` set extends; every other set itself."""
        return replace(self, kind="poor") if self.kind == "added" else self

    def random(self, attempt: int = 0) -> np.random.Generator:
        """A generator of its own, so that a campaign of another size draws the same sets."""
        return np.random.default_rng([self.seed, KINDS.index(self.original.kind), self.index, attempt])

    @property
    def noise_seed(self) -> int:
        return int(self.random().integers(2**31))

    def draw_target(self, random: np.random.Generator) -> float:
        """Draw the excess chi-squared that the set should have."""
        low, high = np.log(TARGETS[self.kind])
        return float(np.exp(random.uniform(low, high)))


def chains(seed: int, size: float, only: tuple[str, ...] = ()) -> list[list[DataSet]]:
    """Lists of sets to be run one after the other, as an ``added`` set needs its poor set.

    The kinds alternate, so that an interrupted campaign is a sample of all of them.
    """
    kinds = only or KINDS
    wanted = {kind: max(1, round(SIZES[kind] * size)) for kind in kinds}
    if "added" in kinds:
        wanted["poor"] = max(wanted.get("poor", 0), wanted["added"])
    placed = []
    for kind, count in wanted.items():
        for index in range(count if kind != "added" else 0):
            chain = [DataSet(kind, index, seed)]
            if kind == "poor" and index < wanted.get("added", 0):
                chain.append(DataSet("added", index, seed))
            placed.append(((index + 0.5) / count, chain))
    return [chain for _, chain in sorted(placed, key=lambda each: each[0])]
