"""Who takes part in bench_solvers.py: ODE libraries, both Radaus, and the event-driven solver."""

from collections.abc import Callable
from typing import NamedTuple

import libraries
import numpy as np
import plain
import workload

from wedgesweep.simulate import Settings, respond
from wedgesweep.solvers import event_driven
from wedgesweep.sweep import batch, variables

LADDER = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9)
DECADES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
SAMPLES_PER_PERIOD = 64
ALL, FEW = slice(None), slice(1, None, 7)  # few of the cases for what takes a second a case
FEWEST = slice(1, None, 14)
COPIES = 10  # of the cases in a batch: it is then as large as those of a sweep
WITH_RADAU = ("coulomb", "static-dynamic")  # in the third law too it would take as long again
PLAIN, BATCH, LOOP = "plain Radau", "event-driven, to records", "event-driven, loop alone"


class Contender(NamedTuple):
    """``ratios(cases, rtol)``: amplitude ratios of records, shape (n,); ``copies`` of all are run at once."""

    ratios: Callable
    cases: slice
    ladder: tuple
    smoothed: bool
    copies: int = 1


def _settings(method, rtol):
    return Settings(
        method,
        rtol,
        kept_periods=workload.PERIODS_KEPT,
        samples_per_period=SAMPLES_PER_PERIOD,
        keep_waveforms=False,
    )


def loop_alone(cases, rtol):
    """event_driven.run_batch: the compiled loop, with one harmonic."""
    settings = _settings("event-driven", rtol)
    settle = settings.settling(cases["input"]["omega"])
    from_rest = event_driven.BatchSettings(settings.kept_periods, SAMPLES_PER_PERIOD, False, 0.0, 0)
    batch = event_driven.empty_batch(len(cases), 1, 0)
    event_driven.run_batch(cases, settle, from_rest, rtol, batch)
    return batch.numbers["amplitude_ratio"]


def to_records(cases, rtol):
    """batch.solve_batch: all that a sweep stores of a case."""
    sizes = {"phase": 0, "samples_per_period": SAMPLES_PER_PERIOD}
    dtype = variables.record_dtype({**sizes, "harmonic": variables.HARMONICS, "part": 2})
    settings = _settings("event-driven", rtol)
    return batch.solve_batch(cases, np.arange(len(cases)), settings, dtype)[0]["amplitude_ratio"]


def _our_radau(record, rtol):
    numbers = respond(record, _settings("radau", rtol), variables.HARMONICS)[0].numbers
    return numbers["amplitude_ratio"]


def one_by_one(solve, *arguments):
    """A solver of one case as a solver of many."""

    def ratios(cases, rtol):
        return np.array([solve(cases[i : i + 1], *arguments, rtol) for i in range(len(cases))])

    return ratios


our_radau = one_by_one(_our_radau)


def contenders(law):
    """All that take part in a law, by name."""
    smoothed, found = law == "coulomb", {}
    if law in WITH_RADAU:
        found[PLAIN] = Contender(one_by_one(plain.ratio, law), FEW, DECADES, smoothed)
        found["this project's Radau"] = Contender(our_radau, FEW, DECADES, False)
    for name, solve in libraries.installed()[0].items():
        found[name] = Contender(one_by_one(solve), ALL, LADDER, smoothed)
    found[BATCH] = Contender(to_records, ALL, LADDER, False, COPIES)
    found[LOOP] = Contender(loop_alone, ALL, LADDER, False, COPIES)
    return found
