#!/usr/bin/env python3
"""Diagnose the published recordings of a frame that rubs on a wall, and predict one from the other.

Marino and Cicirello (2023) shook a single-storey frame whose plate a brass disc of 250 g or 450 g presses on.
The linear frame is on trial; ``docs/real-data.md`` has the numbers that this script prints.
"""

import argparse
import shutil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import wedgesweep as ws

MODEL = """
title = "single-storey frame"
[oscillator]
mass_kg = 3.0799
spring_N_per_mm = 1.191
damping_N_s_per_m = 0.669
contact = "ground"
[sweep]
friction_law = "coulomb"
frequency_hz = 1.0
amplitude_mm = 1.8
"""
MEASURED = """
[measurement]
title = "{file}"
model = "{model}"
model_error = {model_error}
[measurement.columns]
time = {{ column = "time_s", unit = "s" }}
displacement = {{ column = "plate_mm", unit = "mm", of = "absolute" }}
input = {{ column = "base_mm", unit = "mm", quantity = "displacement" }}
[[measurement.test]]
file = "{file}"
frequency_hz = 1.0
"""
GRAVITY = 9.80665
DISCS = (250, 450)
# Of the input (Hz), and the highest of its harmonics that are compared.
FREQUENCY, EVEN_HARMONICS = 1.0, 16
# Model error at which the force is fitted, close to what the ladder says: at the noise of the record alone, a
# few harmonics would decide.
MODEL_ERROR = 0.1


class Linear(NamedTuple):
    """What the diagnosis of a linear frame says.

    ``errors``: rms over that of the response, before and after; ``second``: amplitude (mm) of the second
    harmonic, measured and simulated with friction.
    """

    accuracy: float
    leading: str
    leading_accuracy: float
    next_best: str
    next_accuracy: float
    force: float
    interval: tuple[float, float]
    errors: tuple[float, float]
    second: tuple[float, float]


def diagnose(folder: Path, file: str, force: float = 0.0, effects: list[str] | None = None) -> Any:
    """Diagnose a recording with a frame on trial that rubs with a force (N) on the wall."""
    model = "model.toml"
    friction = f"[effects.guide_friction]\nforce_N = {force!r}\n" if force else ""
    (folder / model).write_text(MODEL + friction)
    measured = folder / "measured.toml"
    measured.write_text(MEASURED.format(file=file, model=model, model_error=MODEL_ERROR))
    return ws.diagnose_measurement(ws.read_measurement(measured), effects=effects)


def linear(folder: Path, file: str) -> Linear:
    """What is wrong with a linear frame."""
    found = diagnose(folder, file)
    none, one = found.document["ladder"][:2]
    rival = one["rivals"][0]
    (cause,) = (each for each in found.document["candidates"] if each["effects"] == ["guide_friction"])
    fitted = cause["parameters"]["guide_friction.force_N"]
    return Linear(
        none["accuracy"],
        "+".join(one["effects"]),
        one["accuracy"],
        "+".join(rival["effects"]),
        rival["accuracy"],
        fitted["value"],
        tuple(fitted["ci95"]),
        tuple(waveform_errors(found.data)),
        (
            second_harmonic(found.data["measured_harmonics"]),
            second_harmonic(found.data["simulated_harmonics"]),
        ),
    )


def waveform_errors(data: xr.Dataset) -> np.ndarray:
    """Rms error of the simulated waveforms over the rms of the measured one, base model first."""
    measured = data["measured_waveform"] - data["measured_waveform"].mean("phase")
    simulated = data["simulated_waveform"] - data["simulated_waveform"].mean("phase")
    error = ((simulated - measured) ** 2).mean("phase") / (measured**2).mean("phase")
    return np.sqrt(error.isel(test=0, channel=0).values)


def second_harmonic(harmonics: xr.DataArray) -> float:
    """Amplitude (mm) of the second harmonic, of the last model."""
    last = harmonics.isel(model=-1) if "model" in harmonics.dims else harmonics
    return float(1e3 * np.hypot(*last.isel(test=0, channel=0).sel(harmonic=2).values))


def predicted(folder: Path, file: str, force: float) -> tuple[float, float]:
    """Accuracy and rms error of a prediction by a force (N) that this recording had no part in."""
    found = diagnose(folder, file, force, effects=["viscous_damping"])
    return found.document["ladder"][0]["accuracy"], waveform_errors(found.data)[0]


def write_without_even_harmonics(source: Path, target: Path) -> None:
    """Write a recording whose base motion has lost what repeats with 2, 4, 6... times the input frequency."""
    time, plate, base = np.genfromtxt(source, delimiter=",", skip_header=1).T
    angles = 2.0 * np.pi * FREQUENCY * time[:, None] * np.arange(2, EVEN_HARMONICS + 1, 2)
    waves = np.hstack([np.cos(angles), np.sin(angles)])
    centred = base - base.mean()
    even = waves @ np.linalg.lstsq(waves, centred, rcond=None)[0]
    columns = np.column_stack([time, plate, centred - even])
    np.savetxt(target, columns, "%.6g", delimiter=",", header="time_s,plate_mm,base_mm", comments="")


def weight(grams: int) -> float:
    """Weight (N) of a disc."""
    return 1e-3 * grams * GRAVITY


class Recording(NamedTuple):
    """What was found in one recording: (accuracy, rms error) where it is a prediction."""

    linear: Linear
    predicted: tuple[float, float]
    without_even: Linear


def run(data: Path, output: Path) -> dict[int, Recording]:
    """Diagnose both recordings, and predict each from the other's coefficient of friction."""
    output.mkdir(parents=True, exist_ok=True)
    for grams in DISCS:
        shutil.copy(data / f"frame-{grams}g.csv", output)
        write_without_even_harmonics(output / f"frame-{grams}g.csv", output / f"odd-{grams}g.csv")
    found = {grams: linear(output, f"frame-{grams}g.csv") for grams in DISCS}
    recordings = {}
    for grams, other in (DISCS, DISCS[::-1]):
        force = found[other].force / weight(other) * weight(grams)
        recordings[grams] = Recording(
            found[grams],
            predicted(output, f"frame-{grams}g.csv", force),
            linear(output, f"odd-{grams}g.csv"),
        )
    return recordings


def main() -> None:
    """Print what the diagnosis says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder of frame-250g.csv and frame-450g.csv")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/frame"))
    options = parser.parse_args()
    for grams, (found, (accuracy, error), odd) in run(options.data, options.output).items():
        print(f"disc of {grams} g")
        report(found, grams)
        print(f"  predicted by the other recording: accuracy {accuracy:.1%}, rms error {error:.1%}")
        print("  without even harmonics of the recorded base motion:")
        report(odd, grams)


def report(found: Linear, grams: int) -> None:
    """Print the results for one input."""
    low, high = found.interval
    print(f"  linear frame: accuracy {found.accuracy:.1%}, rms error {found.errors[0]:.1%}")
    print(f"  {found.leading}: accuracy {found.leading_accuracy:.1%}, rms error {found.errors[1]:.1%}")
    print(f"  second harmonic {found.second[0]:.3f} mm, simulated {found.second[1]:.3f} mm")
    print(f"  next best, {found.next_best}: accuracy {found.next_accuracy:.1%}")
    print(f"  wall friction {found.force:.3f} N (95 % {low:.3f} to {high:.3f}),", end=" ")
    print(f"{found.force / weight(grams):.3f} of the disc's weight")


if __name__ == "__main__":
    main()
