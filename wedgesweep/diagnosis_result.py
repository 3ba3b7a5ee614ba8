"""The result of a diagnosis, and its files: diagnosis.json, diagnosis.nc and extended.toml."""

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from wedgesweep.errors import InputError
from wedgesweep.sweep import dataset

JSON, DATASET, EXTENDED = "diagnosis.json", "diagnosis.nc", "extended.toml"
VERDICTS = ("nothing-missing", "named", "consistent-with", "tied", "data-insufficient", "none-of-mine")
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
VARIABLES = {"steady": OF_STEADY, "transient": OF_TRANSIENTS, "loop": OF_LOOPS}


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
    """

    document: dict[str, Any]
    data: xr.Dataset
    extended_toml: str = ""

    @property
    def verdict(self) -> str:
        return self.document["verdict"]

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
        partial = directory / f".{DATASET}.partial"
        self.data.to_netcdf(partial)
        partial.replace(directory / DATASET)
        _write_text(directory / EXTENDED, self.extended_toml)
        _write_text(directory / JSON, text)

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
            message = f"{directory / name}: no such file; 'wedgesweep diagnose ... -o {directory}' makes it"
            raise InputError([message])
    document = _document(directory / JSON)
    data = dataset.read(directory / DATASET)
    missing = [name for name in VARIABLES[document.get("kind", "steady")] if name not in data]
    if missing:
        raise InputError([f"{directory / DATASET}: has no {', '.join(missing)}"])
    extended = directory / EXTENDED
    return DiagnosisResult(document, data, extended.read_text(encoding="utf-8") if extended.exists() else "")


def _write_text(file: Path, text: str) -> None:
    partial = file.with_name(f".{file.name}.partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, file)


def _document(file: Path) -> dict[str, Any]:
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError([f"{file}: not JSON ({error})"]) from error
    if not isinstance(document, dict):
        raise InputError([f"{file}: must hold an object with the keys {', '.join(KEYS)}"])
    problems = [f"{file}: {key}: missing" for key in KEYS if key not in document]
    if not problems and document["verdict"] not in VERDICTS:
        valid = ", ".join(VERDICTS)
        problems = [f"{file}: verdict: '{document['verdict']}' is none of {valid}"]
    if problems:
        raise InputError(problems)
    return document
