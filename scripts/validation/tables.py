"""The results of a campaign as text."""

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

from validation import judge
from validation.baselines import BASELINES
from validation.goals import Sets, goals
from validation.judge import Record, Share, share
from validation.time_records import TIME_KINDS
from wedgesweep.effects import EFFECTS

# Edges of the bins of excess chi-squared.
EDGES = (0.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0, 6400.0, 12_800.0, float("inf"))
ABSTENTIONS = ("nothing-missing", "tied", "data-insufficient", "none-of-mine")
# Whether a truth and an answer pass a test.
Comparison = Callable[[list[str], list[str]], bool]
METHODS: dict[str, Callable[[Record], bool]] = {
    "exact": judge.exact,
    "exact or tied": judge.exact_or_tied,
    "reported": judge.reported,
}


class Bin(NamedTuple):
    """Shares of single effects with the truth, by method, at an excess between ``low`` and ``high``."""

    low: float
    high: float
    shares: dict[str, Share]


def text(sets: Sets, heading: str, wanted: int) -> str:
    """All tables; ``wanted``: how many sets a whole campaign has."""
    finished = len(sets.all)
    parts = [
        f"{heading}: {finished} sets, {len(sets.failures)} failed.",
        *([f"Not complete: {wanted} sets were wanted."] if finished < wanted else []),
        *_not_showing(sets),
        *_steady_tests(sets),
        *_times(sets),
        f"\n{'':52} {'required':18} {'reached':28}",
        *(str(goal) for goal in goals(sets) if goal.has_sets),
        *(_of_the_bench(sets) if sets.singles or sets.of("clean") else []),
        "\nSets whose truth was not named; where an abstention is right, sets that do not abstain:",
        mistakes(sets),
    ]
    return "\n".join(parts) + "\n"


def _of_the_bench(sets: Sets) -> list[str]:
    """Tables of the ideal bench."""
    return [
        "\nThe diagnosis and simpler methods on the same files:",
        comparison(sets),
        "\nOne hidden effect (rows) and the effect that was named (columns). The last columns count several",
        "named effects and the verdicts nothing-missing, tied, data-insufficient and none-of-mine.",
        confusion(sets),
        "\nOne hidden effect: share of sets with the truth over the excess chi-squared of the base model:",
        _recovery(recovery(sets)),
    ]


def _not_showing(sets: Sets) -> list[str]:
    names = ", ".join(f"{record['name']} ({'+'.join(record['truth'])})" for record in sets.not_showing)
    return [f"Not counted, as the effect does not show (excess < 100): {names}."] if names else []


def _steady_tests(sets: Sets) -> list[str]:
    """How the sets of steady tests were measured."""
    steady = any(record["kind"] not in TIME_KINDS for record in sets.all)
    tests = "12 tests of 8 periods, 4 % noise of four kinds, three friction laws; " if steady else ""
    return [f"{tests}95 % Wilson intervals."]


def _times(sets: Sets) -> list[str]:
    if not sets.all:
        return []
    total = sum(sum(record["seconds"].values()) for record in sets.all) / 3600.0
    diagnoses = sorted(record["seconds"]["diagnose"] for record in sets.all)
    median, longest = diagnoses[len(diagnoses) // 2], diagnoses[-1]
    return [f"{total:.1f} core hours; a diagnosis takes {median:.0f} s (median), at most {longest:.0f} s."]


def confusion(sets: Sets) -> str:
    """Hidden effect against what was named; abstentions by verdict."""
    records = sets.singles + sets.of("clean")
    present = {name for record in records for name in (*record["truth"], *judge.answer(record))}
    names = [name for name in EFFECTS if name in present]
    numbers = "".join(f"{i:4d}" for i in range(1, len(names) + 1))
    lines = [f"{'hidden':28}{numbers} many nothing tied data none"]
    widths = [4] * len(names) + [5, 8, 5, 5, 5]
    for place, truth in enumerate(["(nothing)", *names]):
        own = [record for record in records if (record["truth"] or ["(nothing)"]) == [truth]]
        counts = Counter(_outcome(record) for record in own)
        cells = [counts[name] for name in (*names, "many", *ABSTENTIONS)]
        label = f"{place:2d} {truth}" if place else f"   {truth}"
        row = "".join(f"{cell or '.':>{width}}" for cell, width in zip(cells, widths, strict=True))
        lines.append(f"{label:28}{row}")
    return "\n".join(lines)


def _outcome(record: Record) -> str:
    found = judge.answer(record)
    if not found:
        return record["verdict"]
    return found[0] if len(found) == 1 else "many"


def _baselines(records: Sequence[Record]) -> list[str]:
    return [name for name in BASELINES if any(name in record.get("baselines", {}) for record in records)]


def _share_of_baseline(records: Sequence[Record], name: str, passes: Comparison) -> Share:
    """Share of the records with a baseline in which its truth and its answer pass a test."""
    ran = [record for record in records if name in record.get("baselines", {})]
    return share(ran, lambda record: passes(record["truth"], record["baselines"][name]))


def recovery(sets: Sets) -> list[Bin]:
    """Share of single effects in which the truth comes out, by excess."""
    baselines = _baselines(sets.singles)
    bins = []
    for low, high in pairwise(EDGES):
        # Noise may make an excess negative.
        inside = [record for record in sets.singles if low <= max(judge.excess(record), 0.0) < high]
        if inside:
            shares = {name: share(inside, passes) for name, passes in METHODS.items()}
            shares |= {name: _share_of_baseline(inside, name, _is_right) for name in baselines}
            bins.append(Bin(low, high, shares))
    return bins


def _recovery(bins: list[Bin]) -> str:
    if not bins:
        return "no sets"
    lines = [f"{'excess':16}" + "".join(f"{name:25}" for name in bins[0].shares)]
    for low, high, shares in bins:
        lines.append(f"{low:6.0f} to {high:<6.0f}" + "".join(f"{found!s:25}" for found in shares.values()))
    return "\n".join(map(str.rstrip, lines))


def _is_right(truth: list[str], found: list[str]) -> bool:
    return found == truth


def _names_something(truth: list[str], found: list[str]) -> bool:
    return bool(found)


def _names_wrongly(truth: list[str], found: list[str]) -> bool:
    return bool(found) and found != truth


def comparison(sets: Sets) -> str:
    """The diagnosis beside simpler methods, on the same files."""
    groups: dict[str, tuple[list[Record], Comparison]] = {
        "nothing hidden: something named": (sets.of("clean"), _names_something),
        "one effect, excess >= 800: exact": (sets.strong, _is_right),
        "one effect, 100 to 800: exact": (sets.weak, _is_right),
        "two effects: exact": (sets.of("pair"), _is_right),
        "no candidate: something named": (sets.of("unknown"), _names_something),
        "the paper's two tests: wrong name": (sets.of("poor"), _names_wrongly),
    }
    names = _baselines(sets.all)
    lines = [f"{'':36}{'diagnosis':26}" + "".join(f"{name:26}" for name in names)]
    for label, (records, passes) in groups.items():
        own = Share(sum(passes(record["truth"], judge.answer(record)) for record in records), len(records))
        others = [_share_of_baseline(records, name, passes) for name in names]
        lines.append(f"{label:36}" + "".join(f"{found!s:26}" for found in (own, *others)))
    return "\n".join(map(str.rstrip, lines))


def mistakes(sets: Sets) -> str:
    """One line for each set whose truth was not named."""
    lines = [_line(record) for record in sets.all if not _right(record)]
    lines += [f"{record['name']:12} FAILED: {record['failure'].strip()}" for record in sets.failures]
    return "\n".join(lines) or "none"


def _right(record: Record) -> bool:
    if record["kind"] in ("unknown", "poor"):
        return judge.abstains(record)
    if record["kind"] == "imperfect":
        return judge.names_cause(record)
    if record["kind"] == "errors-only":
        return judge.nothing_missing(record)
    return judge.exact(record) if record["truth"] else not record["causes"]


def _line(record: Record) -> str:
    how = f"{record['way']} {record['size']:g}" if "way" in record else record["noise"]
    made = f"{record['name']:12} {record['law']:15} {how:15} excess {judge.excess(record):9.0f}"
    rivals = "; ".join("+".join(rival["effects"]) for rival in record["rivals"][:3])
    tied = f" (rivals {rivals})" if rivals else ""
    return f"{made}  {outcome(record)}{tied}"


def outcome(record: Record) -> str:
    """Truth, verdict and causes of a set in a few words."""
    truth = "+".join(record["truth"]) or "nothing"
    return f"{truth}: {record['verdict']} {'+'.join(judge.causes(record))}".rstrip()
