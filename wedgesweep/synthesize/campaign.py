"""Makes a directory of measured data from a config and a plan of tests."""

from dataclasses import replace
from pathlib import Path

import joblib

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
from wedgesweep.synthesize import files, tables
from wedgesweep.synthesize.files import Table
from wedgesweep.synthesize.motion import NoMotion
from wedgesweep.synthesize.options import FORCE, QUANTITIES, Options
from wedgesweep.synthesize.plan import Plan
from wedgesweep.synthesize.truth import TrueTest, Truth, draw
from wedgesweep.systems import kits

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
    made = _tables(truth, options, n_jobs, plan.source)
    model = Config(config.document | {"effects": {}, "title": "model on trial"})
    measured = files.measured(directory.name, config, plan, options)
    files.write(directory, measured, model, made, files.truth_document(truth, made, options))
    return [
        f"{_name(i, test)}: not steady after "
        f"{formatting.counted(options.settle_periods, 'period')}; raise --settle-periods"
        for i, (test, table) in enumerate(zip(truth.tests, made, strict=True))
        if test.stray_phase_deg is None and table.settle_periods == options.settle_periods
    ]


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
        count: float = tables.sample_count(test, options)
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
    if test.plan.kind != STEADY:
        return f"test[{i}] ({test.plan.kind})"
    return f"test[{i}] ({test.plan.frequency_hz:g} Hz, {test.plan.amplitude:g} {test.plan.unit})"


def _tables(truth: Truth, options: Options, n_jobs: int, source: str) -> list[Table]:
    """Simulate and record the tests; raises SynthesisError with every test of the plan's file that fails."""
    if any(test.plan.kind != LOOP for test in truth.tests):
        record = truth.config.record_with(truth.effects, truth.law)
        compile_once(Settings("radau"), int(kits(record)[0]), truth.config.system)
    found = in_order((joblib.delayed(_table)(truth, test, options) for test in truth.tests), n_jobs)
    problems = [
        f"{source}: {_name(i, test)}: {fault}"
        for i, (test, fault) in enumerate(zip(truth.tests, found, strict=True))
        if isinstance(fault, str)
    ]
    if problems:
        raise SynthesisError(problems)
    return found


def _table(truth: Truth, test: TrueTest, options: Options) -> Table | str:
    """The record of a test, or why there is none."""
    try:
        return tables.table(truth, test, options)
    except (CaseError, NoMotion) as error:
        return str(error)
