"""Measured signals to the harmonics that are fitted."""

from dataclasses import replace

import numpy as np

from wedgesweep.diagnose.fit_data import INPUT_GAIN
from wedgesweep.diagnose.steady import column_load, simulation, tone
from wedgesweep.diagnose.steady.column_load import ColumnLoad
from wedgesweep.diagnose.steady.harmonic_data import HarmonicData, stated
from wedgesweep.diagnose.steady.recorded_input import (
    InputHarmonics,
    RecordedInputData,
    input_harmonics,
    motion_factor,
    without_noise,
)
from wedgesweep.diagnose.steady.spectra import Spectrum, fitted, spectrum
from wedgesweep.effects import acting
from wedgesweep.effects.channel_delay import NAME as DELAY
from wedgesweep.measured import Measurement, TestRecord
from wedgesweep.natural_units import FREQUENCY

# Effects that only a sensor of this channel can show, of the motion that is simulated.
OF_SENSORS = {"displacement_gain": "displacement", "velocity_lag": "velocity"}


def harmonic_data(measurement: Measurement) -> HarmonicData:
    """Spectra of all tests; a spurious tone is that of the base model, or it is looked for."""
    if measurement.recorded_input is not None:
        return _under_recorded_input(measurement)
    tests = measurement.tests
    found, spectra = _with_tone(measurement)
    std = [test.amplitude_std if test.amplitude is not None else np.inf for test in tests]
    data = HarmonicData(
        model=measurement.model,
        law=measurement.law,
        names=tuple(test.name for test in tests),
        spectra=spectra,
        amplitude=np.array([test.amplitude if test.amplitude else np.nan for test in tests]),
        amplitude_std=np.array(std),
        uncertain=dict(measurement.uncertain),
        tone=found.frequency if found else None,
        tone_std=found.std if found else 0.0,
        models=_models(measurement),
        model_error=measurement.model_error,
        harmonics_std=measurement.input_harmonics_std,
    )
    data = replace(data, loads=_loads(measurement, data))
    return data.with_covariance(stated(data))


def column_load_of(test: TestRecord) -> ColumnLoad | None:
    """The load of the column in a test, None if it was not recorded."""
    if test.normal_force is None:
        return None
    return column_load.measured(test.time, test.normal_force, test.refined_frequency, test.zero_std)


def _loads(measurement: Measurement, data: HarmonicData) -> tuple[ColumnLoad | None, ...]:
    """Loads of the column of all tests; none where the base model sticks, which leaves them undetermined."""
    loads = [column_load_of(test) for test in measurement.tests]
    if not any(loads):
        return ()
    sticks = simulation.sticks(data.records(stated(data)))
    return tuple(None if stuck else load for load, stuck in zip(loads, sticks, strict=True))


def recorded_spectra(measurement: Measurement) -> tuple[Spectrum, ...]:
    """Spectra of the compared responses of all tests, in the units of the records."""
    if measurement.recorded_input is None:
        return _with_tone(measurement)[1]
    signals = [[test.responses[name] for name in measurement.compared(test)] for test in measurement.tests]
    both = zip(measurement.tests, signals, strict=True)
    return tuple(fitted(test.time, np.array(own), test.refined_frequency) for test, own in both)


def _with_tone(measurement: Measurement) -> tuple[tone.Tone | None, tuple[Spectrum, ...]]:
    """The spurious tone under stated inputs, and the spectra of all tests; beside loads none is sought."""
    records = [
        (test.time, _channels(test, measurement.derived_velocity), test.refined_frequency)
        for test in measurement.tests
    ]
    lowest = tone.LOWEST * measurement.model.natural_units().ratio(FREQUENCY)
    found = tone.of(acting(measurement.model.effects))
    if all(test.normal_force is None for test in measurement.tests):
        found = found or tone.find([fitted(*each) for each in records], lowest)
    return found, tuple(spectrum(*each, found.frequency if found else None) for each in records)


def _models(measurement: Measurement) -> tuple | None:
    """The base model of each test, None if all have the same."""
    if not any(test.model for test in measurement.tests):
        return None
    return tuple(measurement.model_of(test) for test in measurement.tests)


def _channels(test: TestRecord, derived_velocity: bool) -> np.ndarray:
    """Displacement and, if it was measured by itself, velocity, (C, n)."""
    assert test.displacement is not None
    if test.velocity is None or derived_velocity:
        return test.displacement[None]
    return np.array([test.displacement, test.velocity])


def _under_recorded_input(measurement: Measurement) -> RecordedInputData:
    """Harmonics of responses, as displacement and velocity relative to the base, and those of the input."""
    quantity = measurement.recorded_input
    assert quantity is not None
    named = _converted(measurement)
    motions = [measurement.factors_of(name) for name, _ in named]
    read = [_read_test(test, named, motions, quantity) for test in measurement.tests]
    spectra = tuple(each[0] for each in read)
    orders = max(each[1].displacement.shape[1] for each in read)
    inputs = InputHarmonics(
        *(
            np.concatenate([_wider(part, orders) for part in parts])
            for parts in zip(*(each[1] for each in read), strict=True)
        )
    )
    as_measured = {
        name for (name, slot), (_, share) in zip(named, motions, strict=True) if name == slot and not share
    }
    gain = {INPUT_GAIN: measurement.input_gain_std} if measurement.input_gain_std else {}
    data = RecordedInputData(
        model=measurement.model,
        law=measurement.law,
        names=tuple(test.name for test in measurement.tests),
        spectra=spectra,
        amplitude=inputs.amplitude,
        amplitude_std=np.zeros(len(spectra)),
        uncertain=measurement.uncertain_of_records | gain,
        models=_models(measurement),
        input_phase=inputs.phase,
        inputs=inputs,
        model_error=measurement.model_error,
        hidden=_hidden_effects(as_measured, any(share for _, share in motions)),
    )
    return data.with_covariance(stated(data))


def _hidden_effects(as_measured: set[str], converted: bool) -> tuple[str, ...]:
    """Effects that the channels cannot show.

    ``as_measured``: channels that are compared without conversion; ``converted``: whether the input
    was added to any channel.
    """
    found = [effect for effect, channel in OF_SENSORS.items() if channel not in as_measured]
    return (*found, "fixture_resonance", DELAY) if converted else tuple(found)


# Quantity that a channel measures, and the one that it is compared as.
Channel = tuple[str, str]


def _converted(measurement: Measurement) -> list[Channel]:
    """The compared channels: the first one is compared as a displacement, a second one as a velocity."""
    slots = ("displacement", "velocity")
    names = measurement.compared(measurement.tests[0])
    return list(zip(names, slots, strict=False))


def _read_test(
    test: TestRecord, named: list[Channel], motions: list[tuple[float, float]], quantity: str
) -> tuple[Spectrum, InputHarmonics]:
    """Spectrum of the responses of a test, and harmonics of its input.

    ``motions``: see ``Measurement.factors_of``.
    """
    frequency = test.refined_frequency
    signals = np.array(
        [sign * getattr(test, name) for (name, _), (sign, _) in zip(named, motions, strict=True)]
    )
    assert test.input is not None
    found = fitted(test.time, signals, frequency)
    recorded = fitted(test.time, test.input[None], frequency)
    measured, noise = input_harmonics(recorded, quantity)
    displacement, variance = without_noise(measured, noise)
    coherence = np.array(
        [fitted(test.time, np.array([test.input, each]), frequency).coherence for each in signals]
    )[: len(found.mean)]
    found, conversion = _as_motion(found, named, [share for _, share in motions], displacement)
    # The noise is that of channels and input as recorded, and turns as their harmonics are converted. Of that
    # of the input a harmonic keeps the share that it counts by, and none if it is left out.
    turn = _direction(motion_factor(recorded, quantity))
    kept = np.where(displacement != 0.0, np.sqrt(variance / np.maximum(noise, 1e-300)), 0.0)
    channel_turns = np.array([_direction(_slot_factor(found, each)) for each in named])[: len(found.mean)]
    shared = coherence[:, None] * channel_turns * (turn.conj() * kept)[None]
    return found, InputHarmonics(displacement[None], variance[None], conversion[None], shared[None])


def _as_motion(
    found: Spectrum, named: list[Channel], shares: list[float], displacement: np.ndarray
) -> tuple[Spectrum, np.ndarray]:
    """The spectrum converted to what solvers record, and the factor (C, N) of the input in each channel."""
    mean, variance = found.mean.copy(), found.variance.copy()
    conversion = np.zeros(mean.shape, complex)
    scaled = False
    for i, (name, slot) in enumerate(named[: len(mean)]):
        factor = _slot_factor(found, named[i])
        scaled = scaled or name != slot
        mean[i] *= factor
        variance[i] *= np.abs(factor) ** 2
        conversion[i] = shares[i] / motion_factor(found, slot)
        mean[i] += conversion[i] * displacement[: mean.shape[1]]
    alias_map = None if scaled else found.alias_map
    return replace(found, mean=mean, variance=variance, alias_map=alias_map), conversion


def _slot_factor(found: Spectrum, channel: Channel) -> np.ndarray:
    """Factor (N,) that turns a channel's harmonics into those of the quantity that it is compared as."""
    name, slot = channel
    return motion_factor(found, name) / motion_factor(found, slot)


def _direction(factors: np.ndarray) -> np.ndarray:
    """Complex factors over their magnitudes."""
    return factors / np.abs(factors)


def _wider(part: np.ndarray, orders: int) -> np.ndarray:
    """An array (..., N) padded with zeros to a number of ``orders``."""
    return np.pad(part, [(0, 0)] * (part.ndim - 1) + [(0, orders - part.shape[-1])])
