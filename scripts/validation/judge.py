"""Compares a verdict with the truth, and counts how often it is right."""

from collections.abc import Callable, Sequence
from math import inf, nan
from typing import Any, NamedTuple

from scipy.stats import binomtest

from validation import imperfect
from wedgesweep.effects import EFFECTS

# What a campaign keeps of a data set: its truth, how it was made, and what the diagnosis said.
Record = dict[str, Any]
NAMING = ("named", "consistent-with")
ABSTAINING = ("tied", "data-insufficient", "none-of-mine")


def excess(record: Record) -> float:
    """Excess chi-squared of the base model; infinite where that has no steady response."""
    return inf if record["excess"] is None else float(record["excess"])


def causes(record: Record) -> list[str]:
    """Effects that are listed as the cause, be it alone or tied with others."""
    return sorted(cause["effect"] for cause in record["causes"])


def names_any(record: Record) -> bool:
    """Whether any cause is listed."""
    return bool(record["causes"])


def answer(record: Record) -> list[str]:
    """Effects that the verdict names; none where it abstains."""
    return causes(record) if record["verdict"] in NAMING else []


def exact(record: Record) -> bool:
    """Whether the verdict names the truth."""
    return record["verdict"] in NAMING and causes(record) == record["truth"]


def wrongly_named(record: Record) -> bool:
    """Whether the verdict is certain and wrong, the worst outcome."""
    return record["verdict"] == "named" and causes(record) != record["truth"]


def reported(record: Record) -> bool:
    """Whether the truth is the cause or one of its rivals."""
    return record["truth"] in [causes(record), *(sorted(rival["effects"]) for rival in record["rivals"])]


def exact_or_tied(record: Record) -> bool:
    """Whether the verdict names the truth, or ties it with others."""
    return exact(record) or (record["verdict"] == "tied" and reported(record))


def tells_load_from_friction(record: Record) -> bool:
    """Whether of preload and friction level the right one is reported and the other one is not."""
    listed = [causes(record), *(sorted(rival["effects"]) for rival in record["rivals"])]
    return [each for each in (["preload"], ["friction_level"]) if each in listed] == [record["truth"]]


def leads_ladder(record: Record) -> bool:
    """Whether the truth is the most accurate single effect, or part of the most accurate pair."""
    levels = [level["effects"] for level in record["ladder"]]
    return any(
        level == record["truth"] or (len(level) == 2 and {*record["truth"]} <= {*level}) for level in levels
    )


def names_cause(record: Record) -> bool:
    """Whether a verdict on an imperfect bench names its cause, alone or with errors that are there too."""
    further = {*answer(record)} - {*record["truth"]}
    return {*record["truth"]} <= {*answer(record)} and further <= {*imperfect.EFFECTS}


def names_what_is_there(record: Record) -> bool:
    """Whether a verdict on a bench with errors only names some of them, and nothing else."""
    return bool(answer(record)) and {*answer(record)} <= {*imperfect.EFFECTS}


def errs_by_more(record: Record) -> bool:
    """Whether the base model is off by more than the model error that is allowed for."""
    accuracy = record["ladder"][0]["accuracy"]
    return accuracy is None or bool(accuracy > imperfect.MODEL_ERROR)


def names_another_cause(record: Record) -> bool:
    """Whether a verdict on an imperfect bench is certain and wrong."""
    return record["verdict"] == "named" and not names_cause(record)


def nothing_missing(record: Record) -> bool:
    """Whether the verdict is that the model is right."""
    return bool(record["verdict"] == "nothing-missing")


def abstains(record: Record) -> bool:
    """Whether the verdict names nothing although something is wrong."""
    return record["verdict"] in ABSTAINING


def asks_for_test(record: Record) -> bool:
    """Whether the verdict abstains for want of data and recommends a test."""
    return record["verdict"] in ("data-insufficient", "tied") and record["next_test"] is not None


def families(names: list[str]) -> list[str]:
    """Families of some effects."""
    return sorted({EFFECTS[name].family if name in EFFECTS else "unmodelled" for name in names})


def right_family(record: Record) -> bool:
    """Whether the causes are of the families of the truth."""
    return bool(causes(record)) and families(causes(record)) == families(record["truth"])


def gain_covered(record: Record) -> bool:
    """Whether the 95 % interval of the gain on held-out tests contains the gain without noise."""
    low, high = record["gain"]["ci95"]
    return bool(low <= record["gain_in_truth"] <= high)


def coverage(record: Record) -> list[tuple[str, bool]]:
    """Whether the 95 % interval of each parameter of a right cause contains the true value."""
    found = []
    for cause in record["causes"]:
        true = record["numbers"][cause["effect"]]
        quantities = {each.key: each for each in EFFECTS[cause["effect"]].quantities}
        for key, estimate in cause["parameters"].items():
            if key not in true:
                continue
            low, high = estimate["ci95"]
            covers = low is not None and high is not None
            covers = covers and low <= quantities[key].nearest(true[key], 0.5 * (low + high)) <= high
            found.append((f"{cause['effect']}.{key}", covers))
    return found


class Share(NamedTuple):
    """``hits`` out of ``n``."""

    hits: int
    n: int

    @property
    def value(self) -> float:
        return self.hits / self.n if self.n else nan

    @property
    def wilson(self) -> tuple[float, float]:
        """95 % interval (Wilson, 1927)."""
        if not self.n:
            return 0.0, 1.0
        interval = binomtest(self.hits, self.n).proportion_ci(0.95, "wilson")
        return interval.low, interval.high

    def __str__(self) -> str:
        if not self.n:
            return "no sets"
        low, high = self.wilson
        return f"{self.hits:3d}/{self.n:<3d} {self.value:4.0%} [{low:.0%}, {high:.0%}]"


def share(records: Sequence[Any], passes: Callable[[Any], bool]) -> Share:
    """Share of the records that pass a test."""
    return Share(sum(map(passes, records)), len(records))
