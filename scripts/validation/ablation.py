"""What each stage of a diagnosis is worth: ``PYTHONPATH=scripts python -m validation.ablation DIR ...``.

Diagnoses data sets that a campaign has made (or that have a truth.json), once whole and then without each
stage that changed something there, and prints a table. Results stay in the output directory: the same command
resumes it. To save time, candidates are the hidden effects and some that are easily taken for them.
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import wedgesweep
from validation import judge
from validation.run import DATA, DRAFT, TRUTH, write
from wedgesweep.ablation import without
from wedgesweep.effects import candidates

LOOK_ALIKES = (
    *("friction_level", "preload", "viscous_damping", "bolster_stiffness", "guide_friction"),
    "displacement_gain",
)
# Steps that change no verdict, and those whose work is compared; stages are parts of the latter.
ASIDE = ("scores", "next test")
STEPS = (
    *("single effects", "refinement of single effects", "pairs", "intervals", "held-out tests", "accuracy"),
)
WHOLE = "whole"
# A stage may matter if it takes this much off the misfit of a fit: less is within the gap of a tie.
MATTERS = 10.0
# What is kept of a diagnosis: its truth and parts of its document.
Outcome = dict[str, Any]


def main(given: Sequence[str] | None = None) -> None:
    """Diagnose sets whole and without stages, and print the table."""
    parser = argparse.ArgumentParser(prog="python -m validation.ablation", description=__doc__)
    parser.add_argument("sets", nargs="*", type=Path, help="directories of sets")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/ablation"))
    parser.add_argument("--without", action="append", help="stage to leave out; default: all that matter")
    parser.add_argument("--whole", action="store_true", help="leave nothing out")
    options = parser.parse_args(given)
    wholes: list[Outcome] = []
    rows: dict[str, list[tuple[Outcome, Outcome]]] = {}
    for one in options.sets:
        whole = outcome(one, options.output)
        print(f"{one.name}: {_told(whole)}", flush=True)
        wholes.append(whole)
        that_matter = [each["stage"] for each in whole["stages"] if _matters(each)]
        left_out = options.without or [stage for stage in that_matter if stage not in STEPS]
        for stage in [] if options.whole else left_out:
            less = outcome(one, options.output, stage)
            print(f"  without {stage}: {_told(less)}", flush=True)
            rows.setdefault(stage, []).append((whole, less))
    print(table(wholes, rows), end="")


def outcome(one: Path, out: Path, stage: str = "") -> Outcome:
    """The diagnosis of a set without a stage: read if it is there, else made."""
    file = out / one.name / f"{stage or WHOLE}.json"
    if file.exists():
        return json.loads(file.read_text())
    truth, candidates = _truth(one)
    data = one / DATA if (one / DATA).exists() else one
    with without(*ASIDE, *([stage] if stage else [])):
        measurement = wedgesweep.read_measurement(data / "measured.toml")
        found = wedgesweep.diagnose_measurement(measurement, effects=candidates, n_jobs=1).document
    kept = {key: found[key] for key in ("verdict", "reason", "causes", "rivals", "stages")}
    file.parent.mkdir(parents=True, exist_ok=True)
    write(file, {"name": one.name, "truth": truth, **kept})
    return json.loads(file.read_text())


def _truth(one: Path) -> tuple[list[str], list[str]]:
    """The hidden effects, and the candidates."""
    if (one / DRAFT).exists():
        draft = json.loads((one / DRAFT).read_text())
        known = draft.get("candidates", list(candidates()))
        truth = sorted(draft["hidden"])
    else:
        truths = json.loads((one.parent / TRUTH).read_text())
        known, truth = list(candidates()), truths[one.name]["truth"]
        if truths[one.name]["kind"] == "unknown":
            known = [name for name in known if name not in truth]
    return truth, [name for name in dict.fromkeys([*truth, *LOOK_ALIKES]) if name in known]


def right(found: Outcome) -> bool:
    """Whether the verdict names or ties the truth or, where nothing is hidden, finds nothing missing."""
    return judge.exact_or_tied(found) if found["truth"] else judge.nothing_missing(found)


def wrong(found: Outcome) -> bool:
    """Whether the verdict names something else."""
    return bool(judge.answer(found)) and not right(found)


def table(wholes: Sequence[Outcome], left_out: dict[str, list[tuple[Outcome, Outcome]]]) -> str:
    """One line for each stage: what it did in whole diagnoses, and what diagnoses without it lost and won.

    Sets in which it was taken, and in which it took more than MATTERS off the misfit of a fit; its share of
    their work. Sets diagnosed without it, those whose verdict was worse and better, and the share of work.
    """
    rows: dict[str, list[tuple[Outcome, dict[str, Any]]]] = {}
    for whole in wholes:
        for each in whole["stages"]:
            rows.setdefault(each["stage"], []).append((whole, each))
    heads = ("taken", "better", "work", "without", "worse", "better", "work")
    lines = [f"{'stage':46}" + "".join(f"{head:>8}" for head in heads)]
    for stage, own in rows.items():
        better = sum(_matters(each) for _, each in own)
        share = sum(each["work"] for _, each in own) / sum(_work(whole) for whole, _ in own)
        lines.append(f"{stage:46}{len(own):8d}{better:8d}{share:8.2f}" + _without(left_out.get(stage, [])))
    return "\n".join(lines) + "\n"


def _without(pairs: Sequence[tuple[Outcome, Outcome]]) -> str:
    if not pairs:
        return ""
    worse = sum(_rank(whole) > _rank(less) for whole, less in pairs)
    better = sum(_rank(whole) < _rank(less) for whole, less in pairs)
    share = sum(_work(less) for _, less in pairs) / sum(_work(whole) for whole, _ in pairs)
    return f"{len(pairs):8d}{worse:8d}{better:8d}{share:8.2f}"


def _rank(found: Outcome) -> int:
    """2 for a right verdict, 1 for an abstention, 0 for a wrong name."""
    return 2 if right(found) else 0 if wrong(found) else 1


def _matters(stage: dict[str, Any]) -> bool:
    """Whether a stage improved some fit by what may decide a verdict."""
    most = stage["most_gained"]
    return stage["better"] > 0 and (most is None or most > MATTERS)


def _told(found: Outcome) -> str:
    rivals = "; ".join("+".join(each["effects"]) for each in found["rivals"])
    causes = "+".join(judge.causes(found))
    return f"{found['verdict']} {causes} (rivals {rivals or 'none'}; work {_work(found):.0f})"


def _work(found: Outcome) -> float:
    return sum(each["work"] for each in found["stages"] if each["stage"] in STEPS)


if __name__ == "__main__":
    main()
