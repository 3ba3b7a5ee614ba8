"""Signs and delays of channels that no passive system explains, told from power and correlation alone."""

from collections.abc import Callable, Sequence
from functools import partial
from math import log, nan, sqrt

import numpy as np
from scipy.optimize import nnls
from scipy.signal import butter, sosfiltfilt

from wedgesweep.measured.cycles import cut
from wedgesweep.measured.declarations import INPUT, RELATIVE, STEADY, TRANSIENT
from wedgesweep.measured.frequency import FEWEST_CYCLES, estimate_frequency
from wedgesweep.measured.measurement import Measurement, TestRecord
from wedgesweep.measured.stationarity import median_frequency

# A force gives out energy if it correlates with velocity by less than this, or by at least a LITTLE and SURE
# standard errors of the power in BLOCKS parts of the record.
GIVES_OUT, SURE, LITTLE, BLOCKS = -0.3, 4.0, 0.02, 8
# Motion and force are compared up to HIGHEST times the frequency of the motion, in transients within a factor
# of BAND of the median frequency, after SHARE of the record at either end, where the filter of ORDER settles.
HIGHEST, BAND, SHARE, ORDER, FEWEST = 12.0, 2.0, 0.05, 4, 64
# Longest delay over a period and shortest over a sampling interval that is told; number of delays that are
# tried in each of ROUNDS; residual with the delay over that without, and over the force, that tell it.
LONGEST, SHORTEST, TRIED, ROUNDS, GAIN, MOST_LEFT = 0.12, 0.5, 40, 2, 0.6, 0.1
# Residual without a delay, over the force, below which there is nothing to explain; numbers to compare from
# which mass, spring, damper, friction and delay may be told apart, two of each steady test.
LEAST, FEWEST_ROWS = 1e-3, 8
TINY = 1e-300
# Standard error of a second harmonic over its size; distance of frequencies (in logarithm) within which
# shapes are alike, how alike (cosine) they must be once their signs are right, and to how many other tests.
CLEAR, ALIKE, SUPPORT, OTHERS = 0.25, 0.15, 0.5, 1.2


def warnings(measurement: Measurement) -> list[str]:
    """What signs or delays of channels to look at, as "file: what; how to mend it"."""
    driven, turned = _driven(measurement), negated(measurement)
    everywhere = len(turned) == sum(map(_periodic, driven))
    found = [] if everywhere else _delay_warnings(driven, measurement)
    if not found:
        found = _sign_warnings(turned, everywhere)
        found += _delay_warnings([test for test in driven if test not in turned], measurement)
    return found + _shape_warnings(
        [test for test in measurement.tests if test.kind == STEADY and test.input is None]
    )


def negated(measurement: Measurement) -> list[TestRecord]:
    """Tests in which the force gives out energy, but for transients: these give back energy as well."""
    return [test for test in _driven(measurement) if _periodic(test) and _gives_out(test, measurement)]


def _driven(measurement: Measurement) -> list[TestRecord]:
    """Tests with a recorded force on a passive system."""
    if measurement.model.system == "oscillator" and measurement.model.oscillator["contact"] == "belt":
        return []  # a belt gives out energy
    return [test for test in measurement.tests if _force(test, measurement) is not None]


def _periodic(test: TestRecord) -> bool:
    return test.kind != TRANSIENT


def _force(test: TestRecord, measurement: Measurement) -> np.ndarray | None:
    """The recorded force on the mass (n,), if there is one and a motion that it moves."""
    force = test.force if test.force is not None else test.input if measurement.model.forced else None
    return force if test.displacement is not None or test.velocity is not None else None


def _motion(test: TestRecord, measurement: Measurement) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity (n,) of the mass in the direction of the force."""
    name = "displacement" if test.displacement is not None else "velocity"
    relative = measurement.motion_of(name) == RELATIVE
    sign = -1.0 if measurement.model.system == "suspension" and relative else 1.0
    step = 1.0 / test.sampling_rate
    if test.displacement is None:
        assert test.velocity is not None
        return sign * step * np.cumsum(test.velocity - test.velocity.mean()), sign * test.velocity
    measured = test.velocity is not None and not measurement.derived_velocity
    velocity = test.velocity if measured else np.gradient(test.displacement, step)
    assert velocity is not None
    return sign * test.displacement, sign * velocity


def _gives_out(test: TestRecord, measurement: Measurement) -> bool:
    """Whether the force, less that of a spring, takes energy out of the motion."""
    displacement, velocity = _motion(test, measurement)
    force = _force(test, measurement)
    assert force is not None
    spring = np.column_stack([np.ones(force.size), displacement])
    left = force - spring @ np.linalg.lstsq(spring, force, rcond=None)[0]
    power = left * velocity
    correlation = power.mean() / max(float(left.std() * velocity.std()), TINY)
    parts = np.array([part.mean() for part in np.array_split(power, BLOCKS)])
    surely = parts.mean() < -SURE * parts.std(ddof=1) / np.sqrt(BLOCKS)
    return bool(correlation < GIVES_OUT or (surely and correlation < -LITTLE))


def _sign_warnings(negated: Sequence[TestRecord], everywhere: bool) -> list[str]:
    """Tests in which the force gives out energy; ``everywhere``: whether it does so in all tests."""
    if not negated:
        return []
    name = "force" if negated[0].force is not None else INPUT
    fault = f"{name} gives out energy, which a passive system takes in: its sign is the other one"
    where = f"sign = -1 at {name} in [measurement.columns]"
    mend = where if everywhere else f"columns.{name}.sign = -1 in [[measurement.test]]"
    files = ", ".join(test.file for test in negated)
    return [f"{files}: {fault}, or that of the motion; write {mend}"]


def _delay_warnings(tests: Sequence[TestRecord], measurement: Measurement) -> list[str]:
    """The delay of the force at which one mass, spring, damper and friction fit all tests much better."""
    fits = [_delayed_force(test, measurement) for test in tests if not test.model]
    pairs = [fit for fit in fits if fit is not None]
    if sum(rows(0.0)[1].size for rows, _ in pairs) < FEWEST_ROWS:
        return []
    longest = LONGEST * min(period for _, period in pairs)
    delay, reach = 0.0, longest
    for _ in range(ROUNDS):
        delays = delay + np.linspace(-reach, reach, TRIED + 1)
        left = np.array([_unexplained([rows(each) for rows, _ in pairs]) for each in delays])
        delay, least, reach = float(delays[left.argmin()]), float(left.min()), 2.0 * reach / TRIED
    without = _unexplained([rows(0.0) for rows, _ in pairs])
    shortest = SHORTEST / max(test.sampling_rate for test in tests)
    if without < LEAST or least > min(GAIN * without, MOST_LEFT) or not shortest < abs(delay) < longest:
        return []
    name = "force" if tests[0].force is not None else INPUT
    late = f"{name} seems to be {'late' if delay > 0.0 else 'early'} by {1e3 * abs(delay):.3g} ms"
    fits_better = f"a mass, spring, damper and friction then leave {100.0 * least:.2g} % of it"
    mend = f"if it was the recorder and no presliding or play, write delay_ms = {1e3 * delay:.3g} at {name}"
    return [f"{late}: {fits_better}, without a delay {100.0 * without:.2g} %; {mend}"]


# Parts (m, 4) of a force by mass, spring, damper and friction, and the force (m,), over its rms.
Rows = tuple[np.ndarray, np.ndarray]


def _delayed_force(
    test: TestRecord, measurement: Measurement
) -> tuple[Callable[[float], Rows], float] | None:
    """Parts and force of a test as they are without a delay (s) of the force, and the period (s)."""
    displacement, velocity = _motion(test, measurement)
    force = _force(test, measurement)
    assert force is not None
    if test.kind == STEADY:
        frequency = test.refined_frequency
        pair = [complex(cut(test.time, each, frequency).harmonics[:, 0].mean()) for each in (velocity, force)]
        if not min(map(abs, pair)) > TINY:
            return None
        return partial(_of_fundamental, 2.0 * np.pi * frequency, pair[0], pair[1]), 1.0 / frequency
    frequency = _frequency(test, displacement)
    if not frequency > 0.0 or 5.0 * frequency > test.sampling_rate or test.time.size < FEWEST:
        return None
    filtered = partial(sosfiltfilt, _filter(test, frequency))
    parts = np.array(
        [np.gradient(filtered(velocity), 1.0 / test.sampling_rate), *map(filtered, (displacement, velocity))]
    )
    parts = np.vstack([parts, filtered(np.sign(parts[2]))])
    return partial(_of_samples, test.time, parts, filtered(force), 1.0 / frequency), 1.0 / frequency


def _frequency(test: TestRecord, displacement: np.ndarray) -> float:
    """Frequency (Hz) of a loop, or the median one of a transient; NaN of few periods, which anything fits."""
    if _periodic(test):
        return estimate_frequency(test.time, displacement)
    found = median_frequency(displacement, test.sampling_rate)
    return found if found * test.duration >= FEWEST_CYCLES else nan


def _filter(test: TestRecord, frequency: float) -> np.ndarray:
    """Sections of a low-pass filter, or of a band-pass: a transient has noise and drift beside its motion."""
    rate = test.sampling_rate
    if _periodic(test):
        return butter(ORDER, min(HIGHEST * frequency, 0.4 * rate), fs=rate, output="sos")
    return butter(ORDER, (frequency / BAND, BAND * frequency), "bandpass", fs=rate, output="sos")


def _of_fundamental(omega: float, velocity: complex, force: complex, delay: float) -> Rows:
    """Real and imaginary part of the force's fundamental in the phase of the velocity."""
    turned = force * np.exp(1j * omega * delay) * np.conj(velocity) / abs(velocity) / abs(force)
    size, none = abs(velocity) / abs(force), 0.0
    in_phase = [none, none, size, 1.0 / abs(force)]
    across = [omega * size, -size / omega, none, none]
    return np.array([in_phase, across]), np.array([turned.real, turned.imag])


def _of_samples(time: np.ndarray, parts: np.ndarray, force: np.ndarray, period: float, delay: float) -> Rows:
    """Samples of parts and force away from the ends, where a filter settles."""
    edge = SHARE * (time[-1] - time[0]) + LONGEST * period
    kept = (time > time[0] + edge) & (time < time[-1] - edge)
    weight = 1.0 / (max(float(force.std()), TINY) * sqrt(max(int(kept.sum()), 1)))
    late, inside = np.interp(time[kept] + delay, time, force), parts[:, kept]
    return weight * (inside - inside.mean(axis=1, keepdims=True)).T, weight * (late - late.mean())


def _unexplained(rows: Sequence[Rows]) -> float:
    """Share (rms) of forces that a mass, spring, damper and friction leave; a negative mass is a delay."""
    design, force = np.vstack([row[0] for row in rows]), np.concatenate([row[1] for row in rows])
    _, left = nnls(design / np.maximum(np.linalg.norm(design, axis=0), TINY), force)
    return float(left / max(float(np.linalg.norm(force)), TINY))


def _shape_warnings(tests: Sequence[TestRecord]) -> list[str]:
    """Tests whose second harmonic has the other sign than in tests of about the same frequency."""
    phases, logs, used = [], [], []
    for test in tests:
        cycles = cut(test.time, list(test.responses.values())[-1], test.refined_frequency)
        mean, count = cycles.harmonics.mean(axis=0), len(cycles.times)
        if mean.size < 2 or count < 4:
            continue
        error = cycles.harmonics[:, 1].std() / np.sqrt(count)
        if error < CLEAR * abs(mean[1]):
            phases.append(np.angle(mean[1] / mean[0] ** 2))
            logs.append(log(test.refined_frequency))
            used.append(test)
    if not used:
        return []
    near = np.exp(-((np.subtract.outer(logs, logs) / ALIKE) ** 2)) - np.eye(len(used))
    alike = near * np.cos(np.subtract.outer(phases, phases))
    signs = np.ones(len(used))
    for _ in used:
        gains = -signs * (alike @ signs)
        if gains.max() <= 0.0:
            break
        signs[gains.argmax()] *= -1.0
    odd = signs == (-1.0 if signs.sum() >= 0.0 else 1.0)
    others = near.sum(axis=1)
    clear = (others > OTHERS) & (signs * (alike @ signs) > SUPPORT * others)
    files = [test.file for test, told in zip(used, odd & clear, strict=True) if told]
    if not files:
        return []
    fault = "the second harmonic has the other sign than in the other tests, as if the sensor were turned"
    return [f"{', '.join(files)}: {fault}; if it was, write sign = -1 at its channels in these tests"]
