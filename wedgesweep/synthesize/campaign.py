"""Makes a directory of measured data from a config and a plan of tests."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import joblib
import numpy as np

from wedgesweep import formatting
from wedgesweep.config import Config
from wedgesweep.errors import InputError
from wedgesweep.measured.declarations import LOOP, STEADY
from wedgesweep.measured.kinds import FEWEST
from wedgesweep.measured.model import with_law
from wedgesweep.measured.steadiness import FEWEST_SAMPLES as FEWEST_PER_PERIOD
from wedgesweep.simulate import Settings
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.sweep.backend import in_order
from wedgesweep.sweep.cases import compile_once
from wedgesweep.synthesize import files, noise, other_tables
from wedgesweep.synthesize.files import Table
from wedgesweep.synthesize.motion import Motion, NoMotion, sines, steady
from wedgesweep.synthesize.options import FORCE, QUANTITIES, Options
from wedgesweep.synthesize.plan import Plan
from wedgesweep.synthesize.truth import STRAY, TrueTest, Truth, draw
from wedgesweep.systems import kits

# A mass that moves less than this share of the input counts as stuck.
STUCK = 1e-3
# Records of more samples would not fit into memory.
MOST_SAMPLES = 5_000_000


class SynthesisError(InputError):
    """The data cannot be made."""


def synthesize(
    config: Config, source: str, plan: Plan, options: Options, directory: Path, n_jobs: int
) -> list[str]:
    """Make measured data of the system of a config that was read from ``source``; return remarks on them.

    Raises
    ------
    InputError
        If the config has several laws, a test cannot be simulated or the directory is not empty; then
        nothing is written.
    """
    directory = directory.absolute()
    files.require_free(directory)
    problems: list[str] = []
    _, law = with_law(config, source, problems)
    problems += _unit_faults(config, source, plan, options.record_input)
    if options.normal_force is not None and (config.system == "oscillator" or options.record_input):
        problems.append("--normal-force: only a wedge has a column, and it is recorded beside stated inputs")
    if problems:
        raise SynthesisError(problems)
    options = _with_recorded_input(config, plan, options)
    truth = draw(config, law, plan, options.amplitude_error, options.sampling_hz, options.seed)
    if problems := _length_faults(truth, plan, options):
        raise SynthesisError(problems)
    steady = replace(truth, tests=tuple(test for test in truth.tests if test.plan.kind == STEADY))
    motions = _motions(steady, options, n_jobs, plan.source) if steady.tests else []
    found = iter([_table(steady, *each, options) for each in zip(steady.tests, motions, strict=True)])
    tables = [
        next(found) if test.plan.kind == STEADY else _other_table(truth, i, options, plan.source)
        for i, test in enumerate(truth.tests)
    ]
    model = Config(config.document | {"effects": {}, "title": "model on trial"})
    measured = files.measured(directory.name, config, plan, options)
    solution = files.truth_document(truth, steady, motions, options)
    files.write(directory, measured, model, tables, solution)
    return [
        f"{_name(i, test)}: not steady after "
        f"{formatting.counted(options.settle_periods, 'period')}; raise --settle-periods"
        for i, (test, motion) in enumerate(zip(steady.tests, motions, strict=True))
        if test.stray_phase_deg is None and motion.settle_periods == options.settle_periods
    ]


def _other_table(truth: Truth, i: int, options: Options, source: str) -> Table:
    """Channels of a test that is not steady; raises SynthesisError where the case has no answer."""
    try:
        return other_tables.table(truth, truth.tests[i], options)
    except NoMotion as error:
        kind = f"test[{i}] ({truth.tests[i].plan.kind})"
        raise SynthesisError([f"{source}: {kind}: {error}"]) from error


def _with_recorded_input(config: Config, plan: Plan, options: Options) -> Options:
    """The options; the input of a transient is recorded in any case."""
    if options.record_input is not None or not any(test.driven for test in plan.tests):
        return options
    return replace(options, record_input=FORCE if config.forced else QUANTITIES[0])


def _unit_faults(config: Config, source: str, plan: Plan, recorded: str | None) -> list[str]:
    """Amplitudes and recorded inputs of another excitation than the config's, and joints of another kind."""
    unit = config.amplitude_unit.unit
    if config.opens and any(test.kind == LOOP for test in plan.tests):
        return [f"{source}: joints that lift off are not simulated in tests of kind {LOOP}"]
    excited = f'{source} has excitation = "{config.excitation}"'
    faults = [
        f"{plan.source}: test[{i}].amplitude_{test.unit}: {excited}; write amplitude_{unit}"
        for i, test in enumerate(plan.tests)
        if test.unit != unit and (test.kind == STEADY or test.driven)
    ]
    if recorded is not None and (recorded == FORCE) != config.forced:
        valid = FORCE if config.forced else "displacement, velocity or acceleration"
        faults.append(f"--record-input {recorded}: {excited}; record {valid}")
    return faults


def _length_faults(truth: Truth, plan: Plan, options: Options) -> list[str]:
    """Records with fewer samples than a diagnosis takes, or with more than fit into memory."""
    faults = [(i, _length_fault(test, options)) for i, test in enumerate(truth.tests)]
    return [f"{plan.source}: test[{i}]{fault}" for i, fault in faults if fault]


def _length_fault(test: TrueTest, options: Options) -> str | None:
    """Fault of the length of one record, behind the name of its test."""
    if test.plan.kind != STEADY:
        count: float = other_tables.sample_count(test, options)
        if count < FEWEST:
            length = f"{test.plan.duration_s:g} s have {formatting.counted(int(count), 'sample')}"
            return f".duration_s: {length}; at least {FEWEST} make a record"
    else:
        per_period = test.sampling_hz / test.plan.frequency_hz
        count = options.periods * per_period
        if per_period < FEWEST_PER_PERIOD:
            needed = f"at least {FEWEST_PER_PERIOD} are needed"
            return f": {per_period:.3g} samples per period, {needed}; raise --sampling-hz"
    if count <= MOST_SAMPLES:
        return None
    return f": {count:.3g} samples, at most {MOST_SAMPLES} fit into memory; sample less often, or record less"


def _name(i: int, test: TrueTest) -> str:
    return f"test[{i}] ({test.plan.frequency_hz:g} Hz, {test.plan.amplitude:g} {test.plan.unit})"


def _motions(truth: Truth, options: Options, n_jobs: int, source: str) -> list[Motion]:
    """Simulate the tests; raises SynthesisError with every test of the plan's file that fails."""
    compile_once(Settings("radau"), int(kits(truth.record(truth.tests[0]))[0]), truth.config.system)
    more = 2 if options.noise == "differentiated" else 0
    jobs = (
        joblib.delayed(_motion)(
            truth.record(test),
            test.clock(options.periods, more),
            options.settle_periods,
            STRAY not in truth.config.effects,
            truth.effects,
            options.normal_force is not None,
        )
        for test in truth.tests
    )
    found = in_order(jobs, n_jobs)
    faults = [_fault(truth, test, motion) for test, motion in zip(truth.tests, found, strict=True)]
    problems = [
        f"{source}: {_name(i, test)}: {fault}"
        for i, (test, fault) in enumerate(zip(truth.tests, faults, strict=True))
        if fault
    ]
    if problems:
        raise SynthesisError(problems)
    return found


def _motion(record: np.ndarray, *arguments: Any) -> Motion | str:
    """Return the motion of a test, or why there is none."""
    try:
        return steady(record, *arguments)
    except (CaseError, NoMotion) as error:
        return str(error)


def _fault(truth: Truth, test: TrueTest, motion: Motion | str) -> str | None:
    """Why a test cannot be made, or None."""
    if isinstance(motion, str):
        return motion
    deflection = truth.config.deflection(2.0 * np.pi * test.plan.frequency_hz)
    if np.ptp(motion.displacement) >= STUCK * deflection * truth.record(test)["input"]["amplitude"][0]:
        return None
    return "the mass sticks all the time and there is nothing to measure; raise the amplitude"


def _table(truth: Truth, test: TrueTest, motion: Motion, options: Options) -> Table:
    """Channels with offset and noise, as in the CSV file; time starts at 0."""
    displacement = motion.displacement + test.offset * motion.displacement.std()
    channels = (displacement, motion.velocity)
    step = 1.0 / test.sampling_hz
    displacement, velocity = noise.NOISES[options.noise](channels, options.level, step, test.random)
    time = step * np.arange(displacement.size)
    given = _input(truth, test, time, options)
    return Table(time, displacement * 1e3, velocity * 1e3, given, load=_load(motion, test, options))


def _load(motion: Motion, test: TrueTest, options: Options) -> np.ndarray | None:
    """The recorded load of the column (N), with white noise and an error of its zero."""
    if motion.load is None or options.normal_force is None:
        return None
    zero = options.normal_force * test.random.normal()
    # Differences lose a sample at either end.
    load = motion.load[1:-1] if options.noise == "differentiated" else motion.load
    return load + zero + options.level * load.std() * test.random.normal(size=load.size)


def _input(truth: Truth, test: TrueTest, time: np.ndarray, options: Options) -> np.ndarray | None:
    """The recorded input in its SI unit, with white noise."""
    if options.record_input is None:
        return None
    # Differences lose a sample at either end.
    first = int(options.noise == "differentiated")
    clock = test.clock(options.periods, 0)
    exact = _recorded(truth.record(test), clock.start + first * clock.step + time, options.record_input)
    return exact + options.input_level * exact.std() * test.random.normal(size=exact.size)


def _recorded(record: np.ndarray, time: np.ndarray, quantity: str) -> np.ndarray:
    """Base motion of a parameter record, shape (1,), at times (n,) from phase 0, without noise (SI units).

    A force has the shape of the displacement.
    """
    given, distortion, stray = (record[each][0] for each in ("input", "input_distortion", "stray_vibration"))
    a, omega = given["amplitude"], given["omega"]
    waves = [
        (a, omega, 0.0),
        (a * distortion["second"], 2.0 * omega, distortion["second_phase"]),
        (a * distortion["third"], 3.0 * omega, distortion["third_phase"]),
    ]
    if stray["acceleration"] != 0.0:
        tone = 2.0 * pi * stray["frequency"]
        waves.append((-stray["acceleration"] / tone**2, tone, stray["phase"]))
    return sines(waves, time, 0 if quantity == FORCE else QUANTITIES.index(quantity))
