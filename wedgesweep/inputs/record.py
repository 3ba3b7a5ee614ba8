"""A recorded input: a column of a CSV file, sampled at an even rate.

A displacement counts from its first sample; displacement and velocity of the base are 0 at the first sample
of a recorded velocity or acceleration. ``detrend`` subtracts the mean of what was recorded.
"""

from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.errors import ConfigError
from wedgesweep.files import read_bytes
from wedgesweep.hints import shortened
from wedgesweep.inputs.sampled import Input
from wedgesweep.inputs.units import RECORDED
from wedgesweep.readers import ReadError, text

# Distances between samples may differ by this share.
EVEN = 1e-3


def digest(file: Path) -> str:
    """sha256 (hex) of a file; raises ConfigError."""
    try:
        return sha256(read_bytes(file)).hexdigest()
    except OSError as error:
        raise ConfigError(
            [f"input.file: {shortened(file)}: {error.strerror}; give the path of a CSV file"]
        ) from error


def columns(given: Mapping[str, Any]) -> tuple[np.ndarray, float]:
    """Samples (SI units) and step (s) of the file of a table [input]; raises ConfigError."""
    wanted = {"input": given["column"]} | ({"time": given["time"]} if "time" in given else {})
    try:
        table = text.read(Path(given["file"]), tuple(wanted.values()))
    except ReadError as error:
        raise ConfigError([f"input: {problem}" for problem in error.problems]) from error
    found = {key: table.channels[name].values for key, name in wanted.items()}
    for key, samples in found.items():
        if not np.isfinite(samples).all():
            place = table.where(int(np.argmin(np.isfinite(samples))))
            raise ConfigError([f"input: {place}: {wanted[key]} is not a finite number; write one"])
    values = found["input"] * RECORDED[given["quantity"]][given["unit"]]
    if values.size < 2:
        raise ConfigError([f"input.file: {given['file']}: holds {values.size} samples; it must be 2 or more"])
    return values, _step(given, found)


def _step(given: Mapping[str, Any], found: Mapping[str, np.ndarray]) -> float:
    if "time" not in found:
        return 1.0 / given["sampling_hz"]
    steps = np.diff(found["time"])
    step = float(found["time"][-1] - found["time"][0]) / steps.size
    uneven = np.abs(steps - step) > EVEN * abs(step)
    if step <= 0.0 or uneven.any():
        row = int(np.argmax(uneven))
        fault = f"{steps[row]:g} s after sample {row + 1}, {step:g} s on average"
        raise ConfigError([f"input.time: {given['file']}: not sampled at an even rate: {fault}; resample it"])
    return step


def made(given: Mapping[str, Any], natural: float) -> Input:
    """The input of a table [input]."""
    if digest(Path(given["file"])) != given["sha256"]:
        raise ConfigError(
            [f"input.sha256: {given['file']} has changed since; remove sha256 to read it as it is now"]
        )
    values, step = columns(given)
    if given["quantity"] == "displacement":
        values = values - values[0]
    if given["detrend"]:
        values = values - values.mean()
    return Input(given["quantity"], values, step, 0.0)
