"""The result of a diagnosis, and its files: diagnosis.json, diagnosis.nc and extended.toml."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

import xarray as xr

from wedgesweep.errors import InputError
from wedgesweep.files import json_object, read_bytes, read_text, write_text
from wedgesweep.sweep import dataset

JSON, DATASET, EXTENDED = "diagnosis.json", "diagnosis.nc", "extended.toml"
# The base model with the force that it lacks, and the table of that force.
FORCE_CONFIG, FORCE_TABLE = "empirical.toml", "empirical-force.csv"
# Dataset of the tests of one kind among several.
PARTS = {kind: f"diagnosis-{kind}.nc" for kind in ("steady", "transient", "loop")}
VERDICTS = ("nothing-missing", "named", "consistent-with", "tied", "data-insufficient", "none-of-mine")


class Reason(StrEnum):
    """Why a diagnosis has its verdict; diagnosis.json has the numbers beside it."""

    ONLY_NOISE = "the base model leaves noise only"
    ALONE = "no other explanation leaves noise only"
    EQUALLY_GOOD = "other explanations fit as well"
    WEAK_EXCESS = "small excess over noise"
    LEAVES_MORE = "more than noise in the tests that show the cause"
    VARIES = "a parameter that differs from test to test"
    OTHERS_ADEQUATE = "other explanations leave noise only"
    PAIR_LEAVES_LESS = "a pair leaves less"
    UNCONFIRMED = "not confirmed on held-out tests"
    UNCHECKED = "ended before all rivals and held-out tests were tried"
    UNSEARCHED = "ended before all effects were tried"
    AT_LIMIT = "an uncertain number far from what is stated"
    MORE_ACCURATE = "by far the most accurate explanation, though above the noise"
    FEW_TESTS = "too few tests"
    CONFOUNDED = "two effects that another parameter may imitate"
    COMPONENT_SUFFICES = "one effect of the pair nearly suffices"
    NEARLY_TOLERABLE = "hardly better than the base model"
    NO_SIGNAL = "noise as large as the response"
    UNEXPLAINED = "no explanation leaves noise only"

    @property
    def code(self) -> str:
        """The reason in diagnosis.json."""
        return self.name.lower().replace("_", "-")


# Status of candidates whose fit gave no meaningful parameters.
FAILED, NO_BETTER = "failed", "no better"
KEYS = (
    *("verdict", "causes", "rivals", "misfit", "gain", "detectable", "not_testable", "next_test"),
    *("title", "model", "version", "created", "method", "candidates"),
)
# Variables of the dataset, by the kind of the tests.
OF_STEADY = (
    *("measured_harmonics", "noise_std", "simulated_harmonics", "measured_waveform", "simulated_waveform"),
    *("waveform_noise", "frequency", "amplitude", "measured_peak_to_peak", "simulated_peak_to_peak"),
    *("measured_energy", "simulated_energy", "measured_plateau", "simulated_plateau", "leftover_force"),
    *("q", "dof"),
)
OF_LOOPS = ("displacement", "velocity", "measured_force", "simulated_force", "force_noise", "q", "dof")
OF_TRANSIENTS = ("time", "measured", "simulated", "sample_noise", "q", "dof")
OF_ALL_KINDS = ("q", "dof")
VARIABLES = {"steady": OF_STEADY, "transient": OF_TRANSIENTS, "loop": OF_LOOPS, "mixed": OF_ALL_KINDS}


@dataclass(frozen=True, eq=False)
class DiagnosisResult:
    """The result of a diagnosis.

    Attributes
    ----------
    document : dict
        Content of diagnosis.json; units are part of its keys (mm, Hz).
    data : xarray.Dataset
        Content of diagnosis.nc: what was measured and simulated in each test, in SI units.
    extended_toml : str
        The base model with the effects found, as a config that runs the measured tests.
    parts : mapping of str to xarray.Dataset
        Where tests of several kinds were measured: content of diagnosis-KIND.nc, by kind.
    force_files : mapping of str to str
        Where a force was offered that no name explains: content of empirical.toml and its table, by file.
    """

    document: dict[str, Any]
    data: xr.Dataset
    extended_toml: str = ""
    parts: Mapping[str, xr.Dataset] = field(default_factory=dict)
    force_files: Mapping[str, str] = field(default_factory=dict)

    def of_kind(self, kind: str) -> "DiagnosisResult":
        """The result with the tests of one kind only."""
        if kind not in self.parts:
            return self
        misfit = self.document["misfit"]
        tests = [each for each in misfit["tests"] if each["kind"] == kind]
        document = {**self.document, "kind": kind, "misfit": {**misfit, "tests": tests}}
        return replace(self, document=document, data=self.parts[kind], parts={})

    @property
    def verdict(self) -> str:
        return self.document["verdict"]

    @property
    def reason(self) -> Reason | None:
        """Why it is this verdict; None in results of versions that did not store it."""
        stored = self.document.get("reason", {}).get("code")
        return next((each for each in Reason if each.code == stored), None)

    @property
    def causes(self) -> list[dict[str, Any]]:
        """Effects that the verdict names, with their numbers and intervals."""
        return self.document["causes"]

    def to_json(self) -> str:
        """Return the content of diagnosis.json."""
        return json.dumps(self.document, indent=2, allow_nan=False) + "\n"

    def write(self, directory: str | Path) -> None:
        """Write the three files into a directory, each of them complete or not at all."""
        directory, text = Path(directory), self.to_json()
        directory.mkdir(parents=True, exist_ok=True)
        # First of all, so that an interrupted write leaves no old verdict beside new data.
        (directory / JSON).unlink(missing_ok=True)
        for file in (*PARTS.values(), FORCE_CONFIG, FORCE_TABLE):
            (directory / file).unlink(missing_ok=True)
        datasets = {DATASET: self.data, **{PARTS[kind]: own for kind, own in self.parts.items()}}
        for file, data in datasets.items():
            dataset.write(data, directory / file)
        for file, content in {EXTENDED: self.extended_toml, **self.force_files, JSON: text}.items():
            write_text(directory / file, content)

    @property
    def added(self) -> tuple[str, ...]:
        """Effects that the extended model adds to the base model.

        If the verdict names no cause, the extended model is the best attempt: the candidate that leaves the
        misfit of the extended model.
        """
        if self.causes:
            return tuple(cause["effect"] for cause in self.causes)
        q = self.document["misfit"]["chi2_extended"]
        attempts = [each["effects"] for each in self.document["candidates"] if each["q"] == q]
        return tuple(attempts[0]) if attempts else ()

    @property
    def gain(self) -> dict[str, Any] | None:
        """The gain on held-out tests, None where nothing was held out."""
        gain = self.document["gain"]
        return gain if gain and gain.get("held_out") != [] else None

    @property
    def models(self) -> tuple[str, ...]:
        """Models to show: base, and extended where something was added."""
        return ("base", "extended") if self.added else ("base",)

    def test_index(self, test: int | str) -> int:
        """Return the index of a test that is given by its index or its name."""
        return test if isinstance(test, int) else self.data["test"].values.tolist().index(test)


def read(directory: Path) -> DiagnosisResult:
    """Read the result of a diagnosis.

    Parameters
    ----------
    directory : pathlib.Path
        Directory that ``wedgesweep diagnose`` wrote.

    Returns
    -------
    DiagnosisResult

    Raises
    ------
    InputError
        A file is missing or lacks something.
    SweepError
        The dataset is damaged.
    """
    for name in (JSON, DATASET):
        if not (directory / name).is_file():
            raise InputError(
                [f"{directory / name}: no such file; 'wedgesweep diagnose ... -o {directory}' makes it"]
            )
    document = _document(directory / JSON)
    data = dataset.read(directory / DATASET)
    kind = document.get("kind", "steady")
    _require(data, kind, directory / DATASET)
    parts = {}
    for part in PARTS if kind == "mixed" else ():
        if (directory / PARTS[part]).is_file():
            parts[part] = dataset.read(directory / PARTS[part])
            _require(parts[part], part, directory / PARTS[part])
    extended = directory / EXTENDED
    return DiagnosisResult(document, data, read_text(extended) if extended.exists() else "", parts)


def _require(data: xr.Dataset, kind: str, file: Path) -> None:
    missing = [name for name in VARIABLES[kind] if name not in data]
    if missing:
        raise InputError([f"{file}: has no {', '.join(missing)}"])


def _document(file: Path) -> dict[str, Any]:
    try:
        document = json_object(read_bytes(file))
    except ValueError as error:
        raise InputError([f"{file}: not the JSON of a diagnosis ({error})"]) from error
    problems = [f"{file}: {key}: missing" for key in KEYS if key not in document]
    if not problems and document["verdict"] not in VERDICTS:
        valid = ", ".join(VERDICTS)
        problems = [f"{file}: verdict: '{document['verdict']}' is none of {valid}"]
    if problems:
        raise InputError(problems)
    return document
