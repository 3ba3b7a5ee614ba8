#!/usr/bin/env python3
"""Diagnose the published recordings of a frame that rubs on a wall, and predict one from the other.

Marino and Cicirello (2023) shook a single-storey frame whose plate a brass disc of 250 g or 450 g presses on.
The linear frame is on trial; ``docs/real-data.md`` has the numbers that this script prints.
"""

import argparse
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import wedgesweep as ws

# As stated, in SI units.
MASS, STIFFNESS, DAMPING = 3.0799, 1191.0, 0.669
MODEL = """
title = "single-storey frame"
[oscillator]
mass_kg = {mass}
spring_N_per_mm = {spring}
damping_N_s_per_m = {damping}
normal_force_N = {normal_force}
contact = "ground"
[friction]
dynamic = {coefficient}
static = {coefficient}
[sweep]
friction_law = "coulomb"
frequency_hz = 1.0
amplitude_mm = 1.8
"""
MEASURED = """
[measurement]
title = "{title}"
model = "model.toml"
model_error = {model_error}
[measurement.columns]
time = {{ column = "time_s", unit = "s" }}
displacement = {{ column = "plate_mm", unit = "mm", of = "absolute" }}
input = {{ column = "base_mm", unit = "mm", quantity = "displacement" }}
"""
TEST = """
[[measurement.test]]
file = "{recording}-{grams}g.csv"
frequency_hz = 1.0
model = {{ "oscillator.normal_force_N" = {normal_force} }}
"""
GRAVITY = 9.80665
DISCS = (250, 450)
# Of the input (Hz), and the highest of its harmonics that are compared.
FREQUENCY, EVEN_HARMONICS = 1.0, 16
# Model error at which the force is fitted, close to what the ladder says: at the noise of the record alone, a
# few harmonics would decide.
MODEL_ERROR = 0.1
# With stiffness and damping fitted as well the frame is better than that.
MODEL_ERROR_DAMPED = 0.05
# The recordings as they are, and without even harmonics of the base motion.
AS_RECORDED, ODD = "frame", "odd"
# Numbers of the frame that are fitted beside others, with what is known of them (relative std).
LEVEL = {"friction_level": 0.2}
LEVEL_AND_STIFFNESS = {**LEVEL, "bolster_stiffness": 0.1}
# What may be missing beside friction on the wall.
FURTHER = ("viscous_damping", "presliding", "input_distortion")


def weight(grams: int) -> float:
    """Weight (N) of a disc."""
    return 1e-3 * grams * GRAVITY


class Frame(NamedTuple):
    """Numbers of a frame in SI units: linear, and as stated unless given."""

    stiffness: float = STIFFNESS
    damping: float = DAMPING
    friction: float = 0.0
    cubic: float = 0.0

    def under(self, ratio: float) -> "Frame":
        """The frame under a disc that is so many times as heavy."""
        return self._replace(friction=ratio * self.friction)

    def model(self, grams: int) -> str:
        """Config of the frame under a disc, whose coefficient of friction makes the force."""
        text = MODEL.format(
            mass=MASS,
            spring=1e-3 * self.stiffness,
            damping=self.damping,
            normal_force=weight(grams),
            coefficient=self.friction / weight(grams),
        )
        if self.cubic:
            text += f"[effects.cubic_stiffness]\ncoefficient_N_per_mm3 = {1e-9 * self.cubic}\n"
        return text


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


class Fitted(NamedTuple):
    """A frame that was fitted, and its accuracy."""

    frame: Frame
    accuracy: float


class Rubbing(NamedTuple):
    """Frames with friction on the wall: with nothing else fitted, and with stiffness and damping as well."""

    friction: Fitted
    with_damping: Fitted


class Extension(NamedTuple):
    """Accuracy of an explanation of both recordings, and of what it predicts of one from the other."""

    accuracy: float
    held_out: float


def diagnose(
    folder: Path,
    frame: Frame,
    recording: str,
    discs: Sequence[int],
    effects: Sequence[str] | None = None,
    uncertain: Mapping[str, float] | None = None,
    model_error: float = MODEL_ERROR,
) -> Any:
    """Diagnose recordings with a frame on trial, whose friction is in proportion to the disc's weight."""
    (folder / "model.toml").write_text(frame.model(discs[0]))
    text = MEASURED.format(title=recording, model_error=model_error)
    if uncertain:
        text += "[measurement.uncertain]\n" + "".join(f"{name} = {std}\n" for name, std in uncertain.items())
    for grams in discs:
        text += TEST.format(recording=recording, grams=grams, normal_force=weight(grams))
    measured = folder / "measured.toml"
    measured.write_text(text)
    return ws.diagnose_measurement(ws.read_measurement(measured), effects=effects)


def linear(folder: Path, recording: str, grams: int) -> Linear:
    """What is wrong with a linear frame."""
    found = diagnose(folder, Frame(), recording, [grams])
    none, one = found.document["ladder"][:2]
    rival = one["rivals"][0]
    fitted = _parameters(found, "guide_friction")["guide_friction.force_N"]
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


def _parameters(found: Any, effect: str) -> dict[str, Any]:
    (cause,) = (each for each in found.document["candidates"] if each["effects"] == [effect])
    return cause["parameters"]


def rubbing(folder: Path, recording: str, grams: int, force: float) -> Rubbing:
    """Put the frame with friction on trial, from a force (N): the input's noise depends on the response."""
    start = Frame(friction=force)
    alone = diagnose(folder, start, recording, [grams], ["viscous_damping"], LEVEL)
    level = alone.document["uncertain"]["friction_level"]["scale"]
    none = alone.document["ladder"][0]
    both = diagnose(
        folder, start, recording, [grams], ["viscous_damping"], LEVEL_AND_STIFFNESS, MODEL_ERROR_DAMPED
    )
    scales = {name: each["scale"] for name, each in both.document["uncertain"].items()}
    damper = _parameters(both, "viscous_damping")["viscous_damping.coefficient_N_s_per_m"]["value"]
    damped = Frame(
        scales["bolster_stiffness"] * STIFFNESS, DAMPING + damper, scales["friction_level"] * force
    )
    return Rubbing(
        Fitted(start._replace(friction=level * force), none["accuracy"]),
        Fitted(damped, both.document["ladder"][1]["accuracy"]),
    )


def extensions(folder: Path, recording: str, force: float) -> dict[str, Extension]:
    """What makes a frame that rubs explain both recordings better; ``force`` (N) under the lighter disc."""
    found = {}
    for effect in FURTHER:
        document = diagnose(folder, Frame(friction=force), recording, DISCS, [effect], LEVEL).document
        for level in document["ladder"]:
            found["+".join(level["effects"])] = Extension(level["accuracy"], level["accuracy_held_out"])
    return found


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


def evaluated(folder: Path, frame: Frame, recording: str, grams: int) -> tuple[float, float]:
    """Accuracy and rms error of a frame as it is."""
    found = diagnose(folder, frame, recording, [grams], effects=["viscous_damping"])
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


class Recording(NamedTuple):
    """What was found in one recording: (accuracy, rms error) where it is a prediction."""

    linear: Linear
    predicted: tuple[float, float]
    rubbing: Rubbing
    without_even: Linear
    rubbing_without_even: Rubbing


def copy(data: Path, output: Path) -> None:
    """Put the recordings, and those without even harmonics of the base motion, into a folder."""
    output.mkdir(parents=True, exist_ok=True)
    for grams in DISCS:
        file = output / f"{AS_RECORDED}-{grams}g.csv"
        shutil.copy(data / file.name, file)
        write_without_even_harmonics(file, output / f"{ODD}-{grams}g.csv")


def run(data: Path, output: Path) -> dict[int, Recording]:
    """Diagnose both recordings, and predict each from the other's coefficient of friction."""
    copy(data, output)
    found = {grams: linear(output, AS_RECORDED, grams) for grams in DISCS}
    recordings = {}
    for grams, other in (DISCS, DISCS[::-1]):
        foreseen = Frame(friction=found[other].force).under(grams / other)
        odd = linear(output, ODD, grams)
        recordings[grams] = Recording(
            found[grams],
            evaluated(output, foreseen, AS_RECORDED, grams),
            rubbing(output, AS_RECORDED, grams, found[grams].force),
            odd,
            rubbing(output, ODD, grams, odd.force),
        )
    return recordings


def parsed(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """The folders of the recordings and of what is made of them; ends if a recording is missing."""
    parser.add_argument("data", type=Path, help="folder of frame-250g.csv and frame-450g.csv")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/frame"))
    options = parser.parse_args()
    for grams in DISCS:
        if not (options.data / f"{AS_RECORDED}-{grams}g.csv").is_file():
            parser.error(f"{options.data} is not the folder of the recordings: no {AS_RECORDED}-{grams}g.csv")
    return options


def main() -> None:
    """Print what the diagnosis says."""
    options = parsed(argparse.ArgumentParser(description=__doc__))
    found = run(options.data, options.output)
    for grams, each in found.items():
        print(f"disc of {grams} g")
        report(each.linear, each.rubbing, grams)
        accuracy, error = each.predicted
        print(f"  predicted by the other recording: accuracy {accuracy:.1%}, rms error {error:.1%}")
        print("  without even harmonics of the recorded base motion:")
        report(each.without_even, each.rubbing_without_even, grams)
    for recording in (AS_RECORDED, ODD):
        print(f"both recordings ({recording}), friction in proportion to weight, and beside it")
        for effects, (own, held_out) in extensions(
            options.output, recording, found[250].linear.force
        ).items():
            print(f"  {effects or 'nothing'}: accuracy {own:.1%}, of the one left out {held_out:.1%}")


def report(found: Linear, rubbing: Rubbing, grams: int) -> None:
    """Print the results for one input."""
    low, high = found.interval
    print(f"  linear frame: accuracy {found.accuracy:.1%}, rms error {found.errors[0]:.1%}")
    print(f"  {found.leading}: accuracy {found.leading_accuracy:.1%}, rms error {found.errors[1]:.1%}")
    print(f"  second harmonic {found.second[0]:.3f} mm, simulated {found.second[1]:.3f} mm")
    print(f"  next best, {found.next_best}: accuracy {found.next_accuracy:.1%}")
    print(f"  wall friction {found.force:.3f} N (95 % {low:.3f} to {high:.3f}),", end=" ")
    print(f"{found.force / weight(grams):.3f} of the disc's weight")
    for name, each in zip(("friction", "friction, stiffness, damping"), rubbing, strict=True):
        print(f"  frame that rubs, {name} fitted: accuracy {each.accuracy:.1%}, {each.frame}")


if __name__ == "__main__":
    main()
