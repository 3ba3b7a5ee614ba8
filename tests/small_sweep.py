"""A sweep of 24 fast cases, for tests of everything around the solving."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from wedgesweep import config
from wedgesweep.config.physics import BREAKAWAY
from wedgesweep.errors import ConfigError
from wedgesweep.sweep.run import Sweep

ROOT = Path(__file__).parent.parent
CONFIG = """\
title = "small"
[sweep]
friction_law = ["coulomb", "exponential"]
beta = [0.3, 1.1, 2.5]
amplitude_mm = [0.02, 0.2, 0.6, 1.2]
[solver]
settle_periods = 3
kept_periods = 2
samples_per_period = 32
"""
CASES = 24
FAST = CONFIG.replace("[solver]", '[solver]\nmethod = "event-driven"')
# Numbers of a locked case: its time, and what its model tells of rest.
KNOWN_OF_LOCKED = ("wall_time", *BREAKAWAY)
# Both cases lock: with this lean and friction the normal forces are not unique.
LOCKED = """\
title = "small"
[suspension]
column_angle_deg = -4.0
[friction]
dynamic = 0.5
static = 0.5
[sweep]
friction_law = ["coulomb", "exponential"]
beta = 1.1
amplitude_mm = 2.0
[solver]
settle_periods = 3
kept_periods = 2
samples_per_period = 32
"""


def sweep(directory: Path, text: str = CONFIG) -> Sweep:
    return Sweep(config.parse(text), directory / "small.nc")


def faults(text: str, source: str = "study.toml") -> list[str]:
    """Everything that is wrong with a config, a line each."""
    with pytest.raises(ConfigError) as caught:
        config.parse(text, source)
    assert str(caught.value).splitlines() == caught.value.problems
    return caught.value.problems


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "wedgesweep", *map(str, arguments)]


def start(*arguments: object, directory: Path) -> subprocess.Popen:
    """Start the command line in a process group of its own."""
    return _started(command(*arguments), directory)


def python(code: str, directory: Path) -> subprocess.Popen:
    """Start Python on some code in a process group of its own."""
    return _started([sys.executable, "-c", code], directory)


def _started(arguments: list[str], directory: Path) -> subprocess.Popen:
    return subprocess.Popen(
        arguments,
        cwd=directory,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
        preexec_fn=_default_signals,
    )


def _default_signals() -> None:
    """Tests that run in the background or under nohup ignore these signals, and would hand that on."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def ended(*words: str, directory: Path | None = None, **variables: str) -> subprocess.CompletedProcess:
    """Python with these words, in a process of its own, which must succeed."""
    done = subprocess.run(
        [sys.executable, *words],
        cwd=directory,
        env=environment(**variables),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr + done.stdout
    return done


def environment(**variables: str) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(ROOT)} | variables


def assert_same_numbers(found: xr.Dataset, expected: xr.Dataset) -> None:
    """Every variable but the wall time, bit for bit."""
    assert set(found.variables) == set(expected.variables)
    for name in set(expected.variables) - {"wall_time"}:
        here, there = found[name].values, expected[name].values
        if there.dtype.kind == "f":
            assert here.dtype == there.dtype
            assert np.array_equal(here, there, equal_nan=True), name
            assert np.array_equal(np.signbit(here), np.signbit(there)), name
        else:
            assert here.tolist() == there.tolist(), name
