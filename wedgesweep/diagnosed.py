"""What a diagnosis left behind, read again: diagnosis.json and diagnosis.nc of one directory."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from wedgesweep.errors import InputError
from wedgesweep.sweep import dataset

JSON, DATASET = "diagnosis.json", "diagnosis.nc"
VERDICTS = ("nothing-missing", "named", "consistent-with", "tied", "data-insufficient", "none-of-mine")
# Candidates whose fit ended without numbers that mean anything.
FAILED, NO_BETTER = "failed", "no better"
KEYS = (
    *("verdict", "causes", "rivals", "misfit", "gain", "detectable", "not_testable", "next_test"),
    *("title", "model", "version", "created", "method", "candidates"),
)
VARIABLES = (
    *("measured_harmonics", "noise_std", "simulated_harmonics", "measured_waveform", "simulated_waveform"),
    *("waveform_noise", "frequency", "amplitude", "measured_peak_to_peak", "simulated_peak_to_peak"),
    *("measured_energy", "simulated_energy", "measured_plateau", "simulated_plateau", "leftover_force"),
    *("q", "dof"),
)


@dataclass(frozen=True, eq=False)
class Diagnosed:
    """The two files of a diagnosis: ``document`` in key units (mm, Hz), ``data`` in SI units."""

    document: dict[str, Any]
    data: xr.Dataset

    @property
    def verdict(self) -> str:
        return self.document["verdict"]

    @property
    def added(self) -> tuple[str, ...]:
        """Effects that the extended model has over the base model.

        Where the verdict names no cause it is the best attempt, which the document shows by its misfit.
        """
        if self.document["causes"]:
            return tuple(cause["effect"] for cause in self.document["causes"])
        left = self.document["misfit"]["chi2_extended"]
        attempts = [each["effects"] for each in self.document["candidates"] if each["q"] == left]
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

    def place(self, test: int | str) -> int:
        """Index of a test that is given by its index or its name."""
        return test if isinstance(test, int) else self.data["test"].values.tolist().index(test)


def read(directory: Path) -> Diagnosed:
    """Read both files; raises InputError, or SweepError for a damaged dataset."""
    for name in (JSON, DATASET):
        if not (directory / name).is_file():
            message = f"{directory / name}: no such file; 'wedgesweep diagnose ... -o {directory}' makes it"
            raise InputError([message])
    document = _document(directory / JSON)
    data = dataset.read(directory / DATASET)
    missing = [name for name in VARIABLES if name not in data]
    if missing:
        raise InputError([f"{directory / DATASET}: has no {', '.join(missing)}"])
    return Diagnosed(document, data)


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
