"""What each stage of a diagnosis is worth: ``PYTHONPATH=scripts python -m validation.ablation``.

Diagnoses data sets that a campaign has made, once whole and then without each stage that changed something
there. Results stay in the output directory; the same command resumes it, and prints the table.
"""

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import wedgesweep
from validation.run import DATA, DRAFT, write
from wedgesweep.ablation import without

# Steps of a diagnosis, whose stages are not counted twice.
STEPS = (
    *("single effects", "refinement of single effects", "pairs", "intervals", "held-out tests", "accuracy"),
)
# Steps that change no verdict; where a verdict is compared they are left out to save time.
ASIDE = ("scores", "next test")
WHOLE = "whole"
# A stage may matter if it takes this much off the misfit of a fit: less is within the gap of a tie.
MATTERS = 10.0
Outcome = dict[str, Any]


def main(given: Sequence[str] | None = None) -> None:
    """Diagnose sets without stages, or print the table of what was diagnosed."""
    parser = argparse.ArgumentParser(prog="python -m validation.ablation", description=__doc__)
    parser.add_argument("sets", nargs="*", type=Path, help="directories of sets, each with measured.toml")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/ablation"))
    parser.add_argument("--without", action="append", default=[], help="only this stage; repeatable")
    parser.add_argument("--whole", action="store_true", help="only whole diagnoses")
    options = parser.parse_args(given)
    for one in options.sets:
        whole = outcome(one, options.output)
        print(f"{one.name}: {_told(whole)}", flush=True)
        for stage in [] if options.whole else _to_leave_out(whole, options.without):
            print(f"  without {stage}: {_told(outcome(one, options.output, stage))}", flush=True)


def outcome(one: Path, out: Path, stage: str = "") -> Outcome:
    """What is kept of the diagnosis of a set without a stage."""
    file = out / one.name / f"{stage or WHOLE}.json"
    if file.exists():
        return json.loads(file.read_text())
    measured = one / DATA / "measured.toml"
    measurement = wedgesweep.read_measurement(measured if measured.exists() else one / "measured.toml")
    draft = json.loads((one / DRAFT).read_text()) if (one / DRAFT).exists() else {}
    candidates = draft.get("candidates")
    with without(*ASIDE, *([stage] if stage else [])):
        found = wedgesweep.diagnose_measurement(measurement, effects=candidates, n_jobs=1).document
    kept = {key: found[key] for key in ("verdict", "reason", "causes", "rivals", "stages", "ladder")}
    file.parent.mkdir(parents=True, exist_ok=True)
    write(file, kept)
    return kept


def _to_leave_out(whole: Outcome, only: Sequence[str]) -> Iterator[str]:
    """Stages that may have changed the verdict."""
    for each in whole["stages"]:
        gained = each["most_gained"]
        if each["stage"] in only or (not only and gained is not None and gained > MATTERS):
            yield each["stage"]


def _told(found: Outcome) -> str:
    causes = "+".join(each["effect"] for each in found["causes"])
    rivals = "; ".join("+".join(each["effects"]) for each in found["rivals"])
    return f"{found['verdict']} {causes} (rivals {rivals}; work {_work(found):.0f})"


def _work(found: Outcome) -> float:
    return sum(each["work"] for each in found["stages"] if each["stage"] in STEPS)


if __name__ == "__main__":
    main()
