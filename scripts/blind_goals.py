"""What must be reached, line by line, and what was."""

from collections.abc import Sequence
from statistics import median
from typing import Any, NamedTuple

import blind_judge as judge
from blind_statistics import Share, share

from wedgesweep.effects import EFFECTS

Record = dict[str, Any]
STRONG, WEAK = 800.0, 100.0


class Sets(NamedTuple):
    """Records by what they were made for; singles are sorted by the excess that the diagnosis reports.

    An effect whose excess is below the weakest level hides by chance of what else was drawn (a friction
    level a bit smaller, and nothing sticks): such sets are told, but no goal counts them.
    """

    all: list[Record]
    failures: list[Record]

    def of(self, kind: str) -> list[Record]:
        return [record for record in self.all if record["kind"] == kind and _shows(record)]

    @property
    def hiding(self) -> list[Record]:
        return [record for record in self.all if not _shows(record)]

    @property
    def singles(self) -> list[Record]:
        return [record for record in self.all if record["kind"] in ("strong", "weak")]

    @property
    def strong(self) -> list[Record]:
        return [record for record in self.singles if record["excess"] >= STRONG]

    @property
    def weak(self) -> list[Record]:
        return [record for record in self.singles if WEAK <= record["excess"] < STRONG]

    @property
    def right(self) -> list[Record]:
        return [record for record in self.singles if judge.exact(record)]


def _shows(record: Record) -> bool:
    return not record["truth"] or bool(record["excess"] >= WEAK)


class Goal(NamedTuple):
    """One line of the table: what was asked, what was reached."""

    what: str
    asked: str
    reached: str
    met: bool | None

    def __str__(self) -> str:
        verdict = "no sets" if self.met is None else "met" if self.met else "missed"
        return f"{self.what:52} {self.asked:18} {self.reached:28} {verdict}"


def _least(what: str, found: Share, least: float) -> Goal:
    return Goal(what, f">= {least:.0%}", str(found), found.value >= least if found.n else None)


def _most(what: str, found: Share, most: float) -> Goal:
    return Goal(what, f"<= {most:.0%}", str(found), found.value <= most if found.n else None)


def goals(sets: Sets) -> list[Goal]:
    """All lines of the table of what must be reached."""
    clean = share(sets.of("clean"), lambda record: bool(record["causes"]))
    lines = [Goal("clean: any cause named", "at most 1", str(clean), clean.hits <= 1 if clean.n else None)]
    lines += [
        _least("one effect, excess >= 800: right family", share(sets.strong, judge.right_family), 0.95),
        _least("  exact, or in a tie that holds it", share(sets.strong, judge.exact_or_tied), 0.95),
        _least("  exact", share(sets.strong, judge.exact), 0.85),
        _worst(sets.strong),
        _least("one effect, excess 100 to 800: truth reported", share(sets.weak, judge.reported), 0.85),
        _most("  wrong `named`", share(sets.weak, judge.wrongly_named), 0.02),
        _least("two effects: exact pair", share(sets.of("pair"), judge.exact), 0.85),
        _least("unknown effect: abstains", share(sets.of("unknown"), _abstains), 0.90),
        _most("  wrong `named`", share(sets.of("unknown"), judge.wrongly_named), 0.05),
        _least("the paper's two tests: abstains, with a next test", share(sets.of("poor"), _asks), 0.95),
        _least("the same and the recommended test: truth named", share(sets.of("added"), judge.exact), 0.80),
    ]
    return lines + _coverage(sets.right) + _gain(sets.right)


def _abstains(record: Record) -> bool:
    return record["verdict"] in judge.ABSTAINING


def _asks(record: Record) -> bool:
    return record["verdict"] in ("data-insufficient", "tied") and record["next_test"] is not None


def _worst(strong: Sequence[Record]) -> Goal:
    by_effect = {
        name: share([r for r in strong if r["truth"] == [name]], judge.exact_or_tied) for name in EFFECTS
    }
    below = {name: found for name, found in by_effect.items() if found.n and found.value < 0.75}
    told = ", ".join(f"{name} {found.hits}/{found.n}" for name, found in below.items()) or "none below"
    return Goal("  every effect, exact or in a tie", ">= 3 of 4", told, not below if strong else None)


def _coverage(right: Sequence[Record]) -> list[Goal]:
    inside = [each for record in right for each in judge.coverage(record)]
    found = share(inside, lambda each: each[1])
    met = 0.90 <= found.value <= 0.98 if found.n else None
    return [Goal("95 % intervals of parameters (right singles) cover", "90 to 98 %", str(found), met)]


def _gain(right: Sequence[Record]) -> list[Goal]:
    gains = [record for record in right if record["gain"] and record["gain"]["excess_removed"] is not None]
    if not gains:
        return [Goal("gain on held-out tests (right singles)", ">= 80 %", "no sets", None)]
    middle = median(record["gain"]["excess_removed"] for record in gains)
    with_interval = [r for r in gains if r["gain"]["ci95"] and r["gain_in_truth"] is not None]
    covers = share(
        with_interval, lambda r: r["gain"]["ci95"][0] <= r["gain_in_truth"] <= r["gain"]["ci95"][1]
    )
    removed = Goal("gain on held-out tests: median excess removed", ">= 80 %", f"{middle:.1%}", middle >= 0.8)
    return [removed, _least("  its interval covers the gain without noise", covers, 0.90)]
