"""The tables of a campaign as text."""

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import blind_judge as judge
from blind_baselines import BASELINES
from blind_goals import Sets
from blind_statistics import Share, share

from wedgesweep.effects import EFFECTS

Record = dict[str, Any]
# Edges of the bins of excess chi-squared in which recovery is told.
BINS = (0.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0, 6400.0, 12_800.0, float("inf"))
VERDICTS = ("nothing-missing", "tied", "data-insufficient", "none-of-mine")


def confusion(sets: Sets) -> str:
    """Hidden effect against what was named; abstentions by verdict."""
    rows = sets.singles + sets.of("clean")
    names = list(EFFECTS)
    numbers = "".join(f"{i:4d}" for i in range(1, len(names) + 1))
    lines = [f"{'hidden':28}{numbers} many nothing tied data none"]
    for place, truth in enumerate(["(nothing)", *names]):
        mine = [record for record in rows if (record["truth"] or ["(nothing)"]) == [truth]]
        counts = Counter(_answer(record) for record in mine)
        cells = [counts[name] for name in (*names, "many", *VERDICTS)]
        label = f"{place:2d} {truth}" if place else f"   {truth}"
        widths = [4] * len(names) + [5, 8, 5, 5, 5]
        cells_text = "".join(f"{c or '.':>{w}}" for c, w in zip(cells, widths, strict=True))
        lines.append(f"{label:28}{cells_text}")
    return "\n".join(lines)


def _answer(record: Record) -> str:
    if record["verdict"] not in judge.NAMING:
        return record["verdict"]
    found = judge.causes(record)
    return found[0] if len(found) == 1 else "many"


def baselines_of(records: Sequence[Record]) -> list[str]:
    return [name for name in BASELINES if any(name in record.get("baselines", {}) for record in records)]


def _by_baseline(records: Sequence[Record], name: str, test: Callable[[Any, Any], bool]) -> Share:
    """Share of the records with a baseline in which this passes a test of truth and answer."""
    ran = [record for record in records if name in record.get("baselines", {})]
    return share(ran, lambda record: test(record["truth"], record["baselines"][name]))


def recovery(sets: Sets) -> list[tuple[float, float, dict[str, Share]]]:
    """Share of singles in which the truth comes out, per bin of excess: (from, to, by method)."""
    methods: dict[str, Callable[[Record], bool]] = {
        "exact": judge.exact,
        "exact or tied": judge.exact_or_tied,
        "reported": judge.reported,
    }
    names = baselines_of(sets.singles)
    rows = []
    for low, high in pairwise(BINS):
        inside = [r for r in sets.singles if low <= r["excess"] < high or (low == 0.0 and r["excess"] < 0.0)]
        if inside:
            found = {name: share(inside, test) for name, test in methods.items()}
            found |= {
                name: _by_baseline(inside, name, lambda truth, answer: truth == answer) for name in names
            }
            rows.append((low, high, found))
    return rows


def compared(sets: Sets) -> str:
    """The diagnosis beside simpler methods, on the same files."""
    groups = {
        "clean: something named": (sets.of("clean"), lambda truth, found: bool(found)),
        "one effect >= 800: exact": (sets.strong, lambda truth, found: found == truth),
        "one effect 100 to 800: exact": (sets.weak, lambda truth, found: found == truth),
        "two effects: exact": (sets.of("pair"), lambda truth, found: found == truth),
        "unknown effect: something named": (sets.of("unknown"), lambda truth, found: bool(found)),
        "the paper's two tests: wrong name": (
            sets.of("poor"),
            lambda truth, found: bool(found) and found != truth,
        ),
    }
    names = baselines_of(sets.all)
    lines = [f"{'':36}{'diagnosis':26}" + "".join(f"{name:26}" for name in names)]
    for label, (records, test) in groups.items():
        # A tie names nobody for sure.
        own = share(
            records,
            lambda r, test=test: test(r["truth"], judge.causes(r) if r["verdict"] in judge.NAMING else []),
        )
        others = [_by_baseline(records, name, test) for name in names]
        lines.append(f"{label:36}" + "".join(f"{found!s:26}" for found in (own, *others)))
    return "\n".join(lines)


def mistakes(sets: Sets) -> str:
    """One line for each set whose truth was not named."""
    lines = []
    for record in sets.all:
        right = judge.exact(record) if record["truth"] else not record["causes"]
        if record["kind"] in ("unknown", "poor"):
            right = record["verdict"] in judge.ABSTAINING
        if not right:
            lines.append(_line(record))
    lines += [f"{record['name']:12} FAILED: {record['failure'].strip()}" for record in sets.failures]
    return "\n".join(lines) or "none"


def _line(record: Record) -> str:
    made = f"{record['name']:12} {record['law']:15} {record['noise']:15} excess {record['excess']:9.0f}"
    truth, named = "+".join(record["truth"]) or "nothing", "+".join(judge.causes(record))
    rivals = "; ".join("+".join(rival["effects"]) for rival in record["rivals"][:3])
    return f"{made}  {truth}: {record['verdict']} {named}{f' (rivals {rivals})' if rivals else ''}"
