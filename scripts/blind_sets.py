"""Which sets of hidden effects a blind campaign has; each depends on seed, kind and place only."""

from typing import NamedTuple

import numpy as np

# Sets of each kind at full size; ``strong`` and ``weak`` hide one effect, ``added`` is ``poor`` and a test.
SIZES = {"clean": 60, "strong": 84, "weak": 42, "pair": 30, "unknown": 30, "poor": 20, "added": 20}
KINDS = tuple(SIZES)
# Excess chi-squared of the base model that a set is made to have, drawn evenly in its logarithm. The
# diagnosis reports the excess that counts; these stay clear of the limits, 800 and 100, by its noise.
TARGETS = {
    "strong": (1000.0, 30_000.0),
    "weak": (150.0, 700.0),
    "pair": (1100.0, 30_000.0),
    "unknown": (1000.0, 30_000.0),
    "poor": (150.0, 5000.0),
}


class BlindSet(NamedTuple):
    """One data set of a campaign."""

    kind: str
    index: int
    seed: int

    @property
    def name(self) -> str:
        return f"{self.kind}-{self.index:03d}"

    @property
    def partner(self) -> "BlindSet":
        """The set that this one adds a test to (its own self but for ``added``)."""
        return self._replace(kind="poor") if self.kind == "added" else self

    def random(self, attempt: int = 0) -> np.random.Generator:
        """A source of its own: campaigns of another size draw the same sets."""
        return np.random.default_rng([self.seed, KINDS.index(self.partner.kind), self.index, attempt])

    @property
    def number(self) -> int:
        """Seed of the noise."""
        return int(self.random().integers(2**31))

    def target(self, random: np.random.Generator) -> float:
        low, high = TARGETS[self.kind]
        return float(np.exp(random.uniform(np.log(low), np.log(high))))


def chains(seed: int, size: float, only: tuple[str, ...] = ()) -> list[list[BlindSet]]:
    """Chains of sets that need one another; kinds take turns, so that a campaign cut short is a sample."""
    kinds = only or KINDS
    wanted = {kind: max(1, round(SIZES[kind] * size)) for kind in kinds}
    if "added" in kinds:
        wanted["poor"] = max(wanted.get("poor", 0), wanted["added"])
    placed = []
    for kind, count in wanted.items():
        for index in range(count):
            if kind == "added":
                continue
            chain = [BlindSet(kind, index, seed)]
            if kind == "poor" and index < wanted.get("added", 0):
                chain.append(BlindSet("added", index, seed))
            placed.append(((index + 0.5) / count, chain))
    return [chain for _, chain in sorted(placed, key=lambda each: each[0])]
