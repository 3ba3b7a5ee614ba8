"""The goals of a campaign and what was reached."""

from collections.abc import Callable, Sequence
from statistics import median
from typing import Any, NamedTuple

from validation import empirical, judge
from validation.judge import Record, Share, share
from validation.time_records import FORCE, HIDDEN_FORCE, TIME_KINDS, WORSE
from wedgesweep.effects import EFFECTS

# Excess chi-squared from which an effect is strong, and from which it shows at all.
STRONG, WEAK = 800.0, 100.0
# A single effect must come out exactly or in a tie in this share of its sets.
EVERY_EFFECT = 0.75
Test = Callable[[Any], bool]


class Sets(NamedTuple):
    """Records by what they were made for.

    An effect whose excess is below WEAK does not show (a friction level a bit lower, for instance, where
    nothing sticks). Such sets are listed, but no goal counts them.
    """

    all: list[Record]
    failures: list[Record]

    def of(self, kind: str) -> list[Record]:
        return [record for record in self.all if record["kind"] == kind and _shows(record)]

    @property
    def not_showing(self) -> list[Record]:
        return [record for record in self.all if not _shows(record)]

    @property
    def singles(self) -> list[Record]:
        """Sets with one effect; what is strong or weak depends on the excess that the diagnosis reports."""
        return [record for record in self.all if record["kind"] in ("strong", "weak")]

    @property
    def strong(self) -> list[Record]:
        return [record for record in self.singles if judge.excess(record) >= STRONG]

    @property
    def weak(self) -> list[Record]:
        return [record for record in self.singles if WEAK <= judge.excess(record) < STRONG]

    @property
    def exact_singles(self) -> list[Record]:
        return [record for record in self.singles if judge.exact(record)]


def _shows(record: Record) -> bool:
    return not record["truth"] or judge.excess(record) >= WEAK


class Goal(NamedTuple):
    """One line of the table; ``satisfied`` is None without any sets, or if nothing is ``required`` ("")."""

    what: str
    required: str
    reached: str
    satisfied: bool | None

    @property
    def has_sets(self) -> bool:
        return self.satisfied is not None or not (self.required or self.reached == str(Share(0, 0)))

    def __str__(self) -> str:
        outcome = {None: "", True: "met", False: "missed"}[self.satisfied]
        return f"{self.what:52} {self.required:18} {self.reached:28} {outcome}".rstrip()


def _at_least(what: str, records: Sequence[Any], passes: Test, least: float) -> Goal:
    found = share(records, passes)
    return Goal(what, f">= {least:.0%}", str(found), found.value >= least if found.n else None)


def _at_most(what: str, records: Sequence[Any], passes: Test, most: float) -> Goal:
    found = share(records, passes)
    return Goal(what, f"<= {most:.0%}", str(found), found.value <= most if found.n else None)


def _listed(what: str, records: Sequence[Any], passes: Test) -> Goal:
    """A line that nothing is required of."""
    return Goal(what, "", str(share(records, passes)), None)


def goals(sets: Sets) -> list[Goal]:
    """All lines of the table."""
    clean = share(sets.of("clean"), judge.names_any)
    unknown, two, three = sets.of("unknown"), sets.of("poor"), sets.of("added")
    imperfect, errors, worse = sets.of("imperfect"), sets.of("errors-only"), sets.of(WORSE)
    return [
        Goal("nothing hidden: a cause named", "at most 1", str(clean), clean.hits <= 1 if clean.n else None),
        _at_least("one effect, excess >= 800: right family", sets.strong, judge.right_family, 0.95),
        _at_least("  exact, or in a tie that contains it", sets.strong, judge.exact_or_tied, 0.95),
        _at_least("  exact", sets.strong, judge.exact, 0.85),
        _every_effect(sets.strong),
        _at_least("one effect, excess 100 to 800: truth reported", sets.weak, judge.reported, 0.85),
        _at_most("  wrong `named`", sets.weak, judge.wrongly_named, 0.02),
        _at_least("two effects: exact pair", sets.of("pair"), judge.exact, 0.85),
        _at_least("effect that is no candidate: abstains", unknown, judge.abstains, 0.90),
        _at_most("  wrong `named`", unknown, judge.wrongly_named, 0.05),
        _at_least("the paper's two tests: abstains, recommends a test", two, judge.asks_for_test, 0.95),
        _at_least("these and the recommended test: truth named", three, judge.exact, 0.80),
        _at_least("small errors, one effect: it leads the ladder", imperfect, judge.leads_ladder, 0.90),
        _at_least("  named, alone or with errors that are there", imperfect, judge.names_cause, 0.80),
        _listed("  named alone", imperfect, judge.exact),
        _at_most("  wrong `named`", imperfect, judge.names_another_cause, 0.03),
        _at_least("small errors only: nothing missing", errors, judge.nothing_missing, 0.90),
        _listed("  an error that is there named", errors, judge.names_what_is_there),
        _listed("  they leave more than is allowed for", errors, judge.errs_by_more),
        _at_least("rig of any size: exact or in a tie", sets.of("random-rig"), judge.exact_or_tied, 0.95),
        _at_least("oscillator: exact or in a tie", sets.of("oscillator"), judge.exact_or_tied, 0.95),
        _at_least("constant damping: exact or in a tie", sets.of("constant"), judge.exact_or_tied, 0.95),
        _at_least("load recorded: preload or friction", sets.of("load"), judge.tells_load_from_friction, 1.0),
        _at_least("  exact", sets.of("load"), judge.exact, 0.95),
        _listed("  without the load", sets.of("no-load"), judge.tells_load_from_friction),
        *(line for kind in TIME_KINDS if kind != FORCE for line in _of_time_records(kind, sets.of(kind))),
        *_of_hidden_forces(sets.of(FORCE)),
        _coverage(f"{WORSE}: 95 % intervals cover", [r for r in worse if r["truth"] and judge.exact(r)]),
        _coverage("95 % intervals (single effects, exact) cover", sets.exact_singles),
        *_gain(sets.exact_singles),
    ]


def _of_time_records(kind: str, records: Sequence[Record]) -> list[Goal]:
    """Lines for sets of one kind of test, some of which hide nothing."""
    clean = [record for record in records if not record["truth"]]
    hidden = [record for record in records if record["truth"]]
    strong = [record for record in hidden if judge.excess(record) >= STRONG]
    return [
        _at_least(f"{kind}, excess >= 800: exact or in a tie", strong, judge.exact_or_tied, 0.95),
        _at_most("  wrong `named`", hidden, judge.wrongly_named, 0.03),
        _at_most("  nothing hidden: a cause", clean, judge.names_any, 0.0),
    ]


def _of_hidden_forces(records: Sequence[Record]) -> list[Goal]:
    """Lines for sets that hide a force which is no candidate, and for those beside them."""
    hidden = [record for record in records if record["truth"] == [HIDDEN_FORCE]]
    strong = [record for record in hidden if judge.excess(record) >= STRONG]
    others = [record for record in records if record["truth"] != [HIDDEN_FORCE]]
    return [
        _at_least("force without a name: model within 1.5 noises", strong, empirical.extends, 0.80),
        _at_least("  its shape in the band where data are dense", strong, empirical.shows_shape, 0.80),
        _at_most("  wrong `named`", hidden, judge.wrongly_named, 0.0),
        _at_least("known effect or none: no force is offered", others, empirical.not_offered, 0.95),
        _at_least("at most twice the work with the force", records, empirical.cheap, 1.0),
    ]


def _every_effect(strong: Sequence[Record]) -> Goal:
    by_effect = {
        name: share([r for r in strong if r["truth"] == [name]], judge.exact_or_tied) for name in EFFECTS
    }
    below = {name: found for name, found in by_effect.items() if found.n and found.value < EVERY_EFFECT}
    reached = ", ".join(f"{name} {found.hits}/{found.n}" for name, found in below.items()) or "none below"
    return Goal("  every effect, exact or in a tie", ">= 3 of 4", reached, not below if strong else None)


def _coverage(what: str, right: Sequence[Record]) -> Goal:
    found = share([each for record in right for each in judge.coverage(record)], lambda each: each[1])
    satisfied = 0.90 <= found.value <= 0.98 if found.n else None
    return Goal(what, "90 to 98 %", str(found), satisfied)


def _gain(right: Sequence[Record]) -> list[Goal]:
    gains = [record for record in right if record["gain"] and record["gain"]["excess_removed"] is not None]
    if not gains:
        return [Goal("held-out tests (single effects, exact)", ">= 80 %", "no sets", None)]
    removed = median(record["gain"]["excess_removed"] for record in gains)
    with_interval = [r for r in gains if r["gain"]["ci95"] and r["gain_in_truth"] is not None]
    return [
        Goal("held-out tests: median excess removed", ">= 80 %", f"{removed:.1%}", removed >= 0.8),
        _at_least("  its interval covers the gain without noise", with_interval, judge.gain_covered, 0.90),
    ]
