"""Runs one data set: the command line makes and diagnoses it, and its record is kept on disk."""

import json
import os
import re
import subprocess
import sys
import tomllib
from dataclasses import asdict
from pathlib import Path
from shutil import rmtree
from typing import Any

from validation import empirical, time_records, unmodelled_data, worse
from validation.baselines import BASELINES
from validation.draft import Draft
from validation.hiding import draw
from validation.judge import Record
from validation.response import TONE, Test
from validation.sets import DataSet
from validation.strength import LEVEL
from validation.time_records import TIME_KINDS
from wedgesweep import __version__, toml
from wedgesweep.effects import EFFECTS
from wedgesweep.files import write_text
from wedgesweep.sweep.provenance import git_commit

# What is kept of how a set was drawn, and the kinds that simpler methods are tried on.
KEPT = ("law", "column_angle_deg", "noise", "spread", "uncertain", "expected", "record_input", "size")
COMPARED = ("clean", "strong", "weak", "pair", "unknown", "poor", "added")
RECORD, DRAFT, TRUTH = "record.json", "draft.json", "truth.json"
# The generator that makes files worse: a number that no attempt at a draw has.
WORSENED = 1000
DATA, RESULT = "data", "diagnosis"
# Relative std with which the amplitude of a recommended test is known.
ADDED_SPREAD = 0.01
# Std (N) of the zero of a load cell: half a per cent of the load of the column.
LOAD_ZERO_STD = 0.005
# Periods after which a response counts as steady; close to breakaway it takes long.
SETTLE_PERIODS = 400
# Where the bolster sticks, or moves without getting steady, the input is raised by this factor, at most so
# many times. What ``synthesize`` and ``check`` say of such a test:
RAISE, RAISES = 1.1, 8
REFUSED = re.compile(r"test\[(\d+)\] \(.*: .*(?:sticks|progress)|test-(\d+)\.csv: not steady")


class CommandError(Exception):
    """A command that failed."""


def run_chain(chain: list[DataSet], out: Path) -> list[Record]:
    """Records of sets that depend on each other; finished ones are read. A failure is a record, too."""
    records = []
    for one in chain:
        try:
            records.append(record_of(one, out))
        except Exception as error:  # whatever it is, the other sets continue, and the next run tries again
            failure = f"{type(error).__name__}: {error}"
            records.append({"name": one.name, "kind": one.kind, "index": one.index, "failure": failure})
    return records


def record_of(one: DataSet, out: Path) -> Record:
    """Record of a set in its directory below ``out``: read if it is finished, else made anew."""
    directory = out / one.name
    if (directory / RECORD).exists():
        return json.loads((directory / RECORD).read_text())
    rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    record = _run(one, out)
    write(directory / RECORD, record)
    return record


def write(file: Path, document: Any) -> None:
    """Write a JSON file completely or not at all."""
    write_text(file, json.dumps(document, indent=1) + "\n")


class _Clock:
    """CPU seconds that each step took, with the commands that it ran."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.began = _cpu_time()

    def lap(self, step: str) -> None:
        now = _cpu_time()
        self.seconds[step], self.began = round(now - self.began, 1), now


def _cpu_time() -> float:
    """CPU time (s) of this process and of the commands that it has run."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _run(one: DataSet, out: Path) -> Record:
    if one.kind in TIME_KINDS:
        return _run_time_records(one, out / one.name)
    directory, clock = out / one.name, _Clock()
    draft = draw(one.original)
    draft.load_zero_std = LOAD_ZERO_STD if one.kind == "load" else None
    spreads = [draft.spread] * len(draft.tests)
    if one.kind == "added":
        original = record_of(one.original, out)
        added = original["next_test"]
        # Nothing to add, or a test that these rigs cannot make: the verdict stands.
        if added is None or added.get("kind", "steady") != "steady":
            return {**original, "name": one.name, "kind": one.kind}
        draft.tests.append(Test(added["frequency_hz"], added[draft.rig.amplitude_key]))
        spreads.append(ADDED_SPREAD)
    write(directory / DRAFT, asdict(draft))
    clock.lap("draw")
    if draft.unmodelled:
        unmodelled_data.make(draft, one.noise_seed, directory / DATA)
    else:
        _synthesize(draft, spreads, one.noise_seed, directory)
    write(directory / DRAFT, asdict(draft))
    limit = ["--effects", ",".join(draft.candidates)] if one.kind == "unknown" else []
    found = _diagnose(one, directory, clock, *limit)
    simpler = BASELINES if one.kind in COMPARED else {}
    named_by = {name: method(directory / RESULT) for name, method in simpler.items()}
    clock.lap("baselines")
    made = {key: getattr(draft, key) for key in KEPT}
    gain = gain_in_truth(draft, found["causes"])
    return _record(one, draft.truth, draft.hidden, made, found, gain) | {
        "baselines": named_by,
        "seconds": clock.seconds,
    }


def _run_time_records(one: DataSet, directory: Path) -> Record:
    """A set of tests that are not all steady."""
    clock, drawn = _Clock(), time_records.draw(one)
    write(directory / DRAFT, drawn)
    (directory / "true.toml").write_text(toml.dumps(drawn["document"]))
    (directory / "tests.toml").write_text(toml.dumps({"test": drawn["tests"]}))
    files = [directory / "true.toml", "--tests", directory / "tests.toml", "-o", directory / DATA]
    noise = ["--noise", drawn["noise"], "--level", drawn["level"], "--input-level", 0.5 * drawn["level"]]
    more = ["--sampling-hz", drawn["sampling_hz"], "--seed", one.noise_seed, "--n-jobs", 1]
    if time_records.HIDDEN_FORCE in drawn["hidden"]:
        more += ["--plugin", time_records.PLUGIN]
    wedgesweep("synthesize", *files, *noise, *more, "--settle-periods", SETTLE_PERIODS)
    made = {key: drawn[key] for key in ("law", "noise", "level")}
    if one.kind == time_records.WORSE:
        way, size, _ = worse.of(one.index)
        worse.worsen(directory / DATA, way, size, one.random(WORSENED))
        made |= {"way": way, "size": size}
    asked = ["--empirical-force"] if one.kind == time_records.FORCE else []
    found = _diagnose(one, directory, clock, *asked)
    record = _record(one, sorted(drawn["hidden"]), drawn["hidden"], made, found, None)
    if one.kind == time_records.FORCE:
        record["empirical_force"] = empirical.told(directory / RESULT, drawn["hidden"], drawn["level"])
    return record | {"baselines": {}, "seconds": clock.seconds}


def _diagnose(one: DataSet, directory: Path, clock: _Clock, *options: str) -> dict[str, Any]:
    """Diagnose the data of a directory; the truth is put out of the reach of the diagnosis."""
    (directory / DATA / TRUTH).rename(directory / TRUTH)
    clock.lap("synthesize")
    files = [directory / DATA / "measured.toml", "-o", directory / RESULT]
    module = ("validation.without", one.ablated) if one.ablated else ("wedgesweep",)
    wedgesweep("diagnose", *files, "--no-report", "--n-jobs", 1, *options, module=module)
    clock.lap("diagnose")
    return json.loads((directory / RESULT / "diagnosis.json").read_text())


def _record(
    one: DataSet,
    truth: list[str],
    hidden: dict[str, Any],
    made: dict[str, Any],
    found: dict[str, Any],
    gain_in_truth: float | None,
) -> Record:
    """What is kept of a set: its truth, how it was made, and the document of its diagnosis in short."""
    gain = found["gain"]
    # Test by test the gain is too long for a record.
    kept = {key: gain[key] for key in gain if key != "held_out"} if gain else gain
    levels = [{key: level[key] for key in ("effects", "accuracy", "distinct")} for level in found["ladder"]]
    return {
        **{"name": one.name, "kind": one.kind, "index": one.index, "seed": one.seed},
        "code": git_commit() or __version__,
        "truth": truth,
        "numbers": hidden,
        **made,
        **{key: found[key] for key in ("verdict", "causes", "rivals")},
        **{"gain": kept, "next_test": found["next_test"], "ladder": levels},
        "excess": found["misfit"]["excess_base"],
        **{key: found["misfit"][key] for key in ("p_extended", "p_constant")},
        "gain_in_truth": gain_in_truth,
    }


def gain_in_truth(draft: Draft, causes: list[dict[str, Any]]) -> float | None:
    """Share of the excess that the causes explain in responses without noise."""
    if not causes:
        return None
    known = {
        cause["effect"]: {
            quantity.key: cause["parameters"].get(quantity.key, {}).get("value", quantity.default)
            for quantity in EFFECTS[cause["effect"]].quantities
        }
        for cause in causes
    }
    base, extended = draft.true_excesses({}, known)
    return 1.0 - extended / base if base > 0.0 else None


def _synthesize(draft: Draft, spreads: list[float | None], seed: int, directory: Path) -> None:
    """Make the data. As on a test bench, a test that sticks or does not get steady gets more input."""
    true = draft.true_system
    (directory / "true.toml").write_text(toml.dumps(true.document()))
    options = ["--noise", draft.noise, "--level", LEVEL, "--seed", seed, "--n-jobs", 1]
    if TONE not in draft.hidden:  # with a tone nothing is ever steady, and all these periods would be run
        options += ["--settle-periods", SETTLE_PERIODS]
    if draft.load_zero_std is not None:
        options += ["--normal-force", draft.load_zero_std]
    if draft.record_input:
        options += ["--record-input", draft.record_input]
    # The errors of an imperfect bench are in its rig.
    uncertain = {} if draft.errors else draft.uncertain
    files = [directory / "true.toml", "--tests", directory / "tests.toml", "-o", directory / DATA]
    for attempt in range(RAISES):
        tests = [
            {**true.test_keys(test), **({"known": False} if spread is None else {"amplitude_std": spread})}
            for test, spread in zip(draft.tests, spreads, strict=True)
        ]
        (directory / "tests.toml").write_text(toml.dumps({"uncertain": uncertain, "test": tests}))
        rmtree(directory / DATA, ignore_errors=True)
        try:
            wedgesweep("synthesize", *files, *options)
            wedgesweep("check", directory / DATA / "measured.toml")
            break
        except CommandError as error:
            refused = [int(each[1] or each[2]) for each in REFUSED.finditer(str(error))]
            if not refused or attempt == RAISES - 1:
                raise
        for i in refused:
            amplitude = round(RAISE * draft.tests[i].amplitude, 6)
            draft.tests[i] = draft.tests[i]._replace(amplitude=amplitude)
    if draft.errors:
        _declare_errors(draft, directory / DATA)


def _declare_errors(draft: Draft, data: Path) -> None:
    """Put the model on trial in place of the true one, and say what is known of their difference."""
    (data / "model.toml").write_text(toml.dumps(draft.system({}).document()))
    file = data / "measured.toml"
    document = tomllib.loads(file.read_text())
    document["measurement"] |= {"uncertain": draft.uncertain, "model_error": draft.model_error}
    file.write_text(toml.dumps(document))


def wedgesweep(*arguments: Any, module: tuple[str, ...] = ("wedgesweep",)) -> None:
    """Run the command line as a user would, or another module that does so; raises CommandError."""
    command = [sys.executable, "-m", *module, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        said = f"{' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr[-2000:]}"
        raise CommandError(said)
