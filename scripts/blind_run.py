"""One data set: the command line makes and diagnoses it; its record compares the verdict with the truth."""

import json
import os
import re
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path
from shutil import rmtree
from time import perf_counter
from typing import Any

import blind_bench as bench
import blind_outside_files as outside
from blind_baselines import BASELINES, SLOW
from blind_bench import Test
from blind_draft import LEVEL, Draft, draw
from blind_judge import gain_in_truth
from blind_sets import BlindSet
from blind_strength import TONE

from wedgesweep.compiled import source_digest
from wedgesweep.config import toml
from wedgesweep.sweep.provenance import git_commit

ROOT = Path(__file__).parent.parent
RECORD, DRAFT, TRUTH = "record.json", "draft.json", "truth.json"
DATA, RESULT = "data", "diagnosis"
# Relative std with which the amplitude of a recommended test is known.
ADDED_SPREAD = 0.01
# Periods within which a response is steady; one next to breakaway takes long.
SETTLE_PERIODS = 400
# Where the bolster sticks the input is raised by this factor, so many times at the most.
RAISE, RAISES = 1.1, 8
STUCK = re.compile(r"test\[(\d+)\] \(.*: .*(?:sticks|progress)")


class Failed(Exception):
    """A set that did not come to a verdict."""


def run_chain(chain: list[BlindSet], out: Path, aic_every: int) -> list[dict[str, Any]]:
    """Records of sets that need one another; finished ones are kept. A failure is a record, too."""
    return [record_of(one, out, aic_every) for one in chain]


def record_of(one: BlindSet, out: Path, aic_every: int) -> dict[str, Any]:
    directory = out / one.name
    try:
        record = _kept(directory) or _run(one, out, directory)
        record = _compared(record, directory, aic_every > 0 and one.index % aic_every == 0)
    except Exception as error:  # whatever it is, the other sets go on
        # No record file: the next run tries again.
        failure = f"{type(error).__name__}: {error}"
        return {"name": one.name, "kind": one.kind, "index": one.index, "failure": failure}
    write(directory / RECORD, record)
    return record


def _kept(directory: Path) -> dict[str, Any] | None:
    """The record of a set that is finished; what there is of another is thrown away."""
    if (directory / RECORD).exists():
        return json.loads((directory / RECORD).read_text())
    rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    return None


def _compared(record: dict[str, Any], directory: Path, slowly: bool) -> dict[str, Any]:
    """A record with what simpler methods name; that of a set made elsewhere, or copied, stays as it is."""
    found = dict(record.get("baselines", {}))
    wanted = [name for name in BASELINES if name not in found and (slowly or name != SLOW)]
    if not wanted or not (directory / DRAFT).exists():
        return record
    began = perf_counter()
    candidates = tuple(json.loads((directory / DRAFT).read_text())["candidates"])
    for name in wanted:
        found[name] = BASELINES[name](directory / DATA / "measured.toml", directory / RESULT, candidates)
    seconds = {**record["seconds"], "baselines": round(perf_counter() - began, 1)}
    return {**record, "baselines": found, "seconds": seconds}


def write(file: Path, document: Any) -> None:
    """Write a JSON file whole or not at all."""
    partial = file.with_suffix(".partial")
    partial.write_text(json.dumps(document, indent=1) + "\n")
    os.replace(partial, file)


def _run(one: BlindSet, out: Path, directory: Path) -> dict[str, Any]:
    took = {}
    began = perf_counter()
    if one.kind == "added" and (poor := _poor(one, out))["next_test"] is None:
        # Nothing to add: the verdict on the poor set stands.
        return {**poor, "name": one.name, "kind": one.kind}
    draft, plan = _draft(one, out)
    write(directory / DRAFT, asdict(draft))
    took["draw"], began = perf_counter() - began, perf_counter()
    if draft.foreign:
        outside.make(draft, LEVEL, one.number, directory / DATA)
    else:
        _synthesize(one, draft, plan, directory)
    # Out of the reach of the diagnosis.
    (directory / DATA / TRUTH).rename(directory / TRUTH)
    took["synthesize"], began = perf_counter() - began, perf_counter()
    limit = ["--effects", ",".join(draft.candidates)] if one.kind == "unknown" else []
    files = [directory / DATA / "measured.toml", "-o", directory / RESULT]
    _wedgesweep("diagnose", *files, "--no-report", "--n-jobs", 1, *limit)
    took["diagnose"] = perf_counter() - began
    found = json.loads((directory / RESULT / "diagnosis.json").read_text())
    if found["gain"]:
        del found["gain"]["held_out"]  # test by test: too long for a record
    record = {
        "name": one.name,
        "kind": one.kind,
        "index": one.index,
        "seed": one.seed,
        "code": git_commit() or source_digest(),
        "truth": sorted(draft.hidden) or ([draft.foreign["name"]] if draft.foreign else []),
        "numbers": draft.hidden,
        **{key: getattr(draft, key) for key in ("law", "lean", "noise", "spread", "uncertain", "expected")},
        **{key: found[key] for key in ("verdict", "causes", "rivals", "gain", "next_test")},
        "excess": found["misfit"]["excess_base"],
        **{key: found["misfit"][key] for key in ("p_extended", "p_constant")},
        "gain_in_truth": gain_in_truth(draft, found),
    }
    return {**record, "seconds": {key: round(value, 1) for key, value in took.items()}}


def _draft(one: BlindSet, out: Path) -> tuple[Draft, list[dict[str, Any]]]:
    """What a set is made from, and its tests as ``synthesize`` reads them."""
    draft = draw(one.partner)
    plan = [_planned(test, draft.spread) for test in draft.tests]
    if one.kind == "added":
        following = _poor(one, out)["next_test"]
        draft.tests.append(Test(following["frequency_hz"], following["amplitude_mm"]))
        plan.append(_planned(draft.tests[-1], ADDED_SPREAD))
    return draft, plan


def _poor(one: BlindSet, out: Path) -> dict[str, Any]:
    """Record of the set that a test is added to."""
    file = out / one.partner.name / RECORD
    if not file.exists():
        message = f"{one.name}: {one.partner.name} did not come to a verdict"
        raise Failed(message)
    return json.loads(file.read_text())


def _planned(test: Test, spread: float | None) -> dict[str, Any]:
    known = {"known": False} if spread is None else {"amplitude_std": spread}
    return {"frequency_hz": test.frequency_hz, "amplitude_mm": test.amplitude_mm, **known}


def _synthesize(one: BlindSet, draft: Draft, plan: list[dict[str, Any]], directory: Path) -> None:
    """Make the data; a test at which the bolster sticks, or all but does, gets more input, as at a bench."""
    (directory / "true.toml").write_text(bench.model(draft.law, draft.lean, draft.hidden))
    options = ["--noise", draft.noise, "--level", LEVEL, "--seed", one.number, "--n-jobs", 1]
    if TONE not in draft.hidden:  # under a tone nothing is ever steady, and all these periods are run
        options += ["--settle-periods", SETTLE_PERIODS]
    files = [directory / "true.toml", "--tests", directory / "tests.toml", "-o", directory / DATA]
    for _ in range(RAISES):
        (directory / "tests.toml").write_text(toml.dumps({"uncertain": draft.uncertain, "test": plan}))
        try:
            return _wedgesweep("synthesize", *files, *options)
        except Failed as failed:
            said, stuck = failed, [int(number) for number in STUCK.findall(str(failed))]
            if not stuck:
                raise
        for i in stuck:
            plan[i]["amplitude_mm"] = round(RAISE * plan[i]["amplitude_mm"], 6)
            draft.tests[i] = draft.tests[i]._replace(amplitude_mm=plan[i]["amplitude_mm"])
        write(directory / DRAFT, asdict(draft))
    message = f"{one.name}: even with its input raised {RAISES} times: {said}"
    raise Failed(message)


def _wedgesweep(*arguments: Any) -> None:
    """Run the command line as a user would."""
    command = [sys.executable, "-m", "wedgesweep", *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        message = f"{' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr[-2000:]}"
        raise Failed(message)
