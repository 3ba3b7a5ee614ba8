"""A long swept record: time of the diagnosis, and of one fit beside scipy's least_squares over solve_ivp.

    python scripts/bench_transient.py [--seconds 25] [--rate 1000] [--scipy-seconds 5] [--wedge]

The base of an oscillator with dry friction is swept through its resonance and recorded. Radau makes the
record, which hides a damper; all effects are tried. The fit has five numbers: damping, friction, start and
zero. scipy gets a shorter record, as it would take minutes for the long one, friction that is smoothed over
2 mm/s, as solve_ivp does not know of sticking, and finite differences of one part in a thousand, without
which it does not move; the ratio is of the same short record. CPU times are those of all threads, of a second
call: the first one compiles. Wall times say something on an idle machine. With ``--wedge`` only the diagnosis
is timed, of a record of the paper's bench, which has five times as many natural periods.
"""

import argparse
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any, NamedTuple

import numpy as np
from scipy import signal
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

from wedgesweep import api
from wedgesweep.config import from_document
from wedgesweep.diagnose.diagnosis import data_of
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.model import Model
from wedgesweep.diagnose.search import Search
from wedgesweep.effects import EFFECTS
from wedgesweep.measured import Measurement, read
from wedgesweep.synthesize.campaign import synthesize
from wedgesweep.synthesize.options import Options
from wedgesweep.synthesize.plan import Plan, PlannedTest

MASS, STIFFNESS, DAMPING, FRICTION = 2.0, 500.0, 0.4, 0.3
RIG: dict[str, dict[str, Any]] = {
    "oscillator": {
        "mass_kg": MASS,
        "spring_N_per_mm": 1e-3 * STIFFNESS,
        "damping_N_s_per_m": DAMPING,
        "normal_force_N": 1.0,
    },
    "friction": {"static": FRICTION, "dynamic": FRICTION},
    "sweep": {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 1.0},
}
WEDGE: dict[str, dict[str, Any]] = {
    "suspension": {},
    "sweep": {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 0.1},
}
# Hidden damping (N s/m); amplitude (mm) of the base, frequencies of the sweep (Hz); those of the wedge.
HIDDEN, AMPLITUDE_MM, LOW_HZ, HIGH_HZ = 0.6, 4.0, 1.0, 5.0
WEDGE_HIDDEN, WEDGE_SWEEP = 4.0, (0.1, 4.0, 25.0)
# Noise of response and input over their rms.
NOISE, INPUT_NOISE = 0.005, 0.002
# Velocity (m/s) over which scipy's friction is smoothed, and cut-off (Hz) of its input.
SMOOTHED, CUTOFF_HZ = 2e-3, 15.0


class Spent(NamedTuple):
    """A result with the CPU and the wall time (s) that it took."""

    result: Any
    cpu: float
    wall: float


def measured(folder: Path, seconds: float, rate: float, wedge: bool = False) -> Measurement:
    """A sweep with more damping than the model has."""
    rig, damping, (amplitude, low, high) = RIG, HIDDEN, (AMPLITUDE_MM, LOW_HZ, HIGH_HZ)
    if wedge:
        rig, damping, (amplitude, low, high) = WEDGE, WEDGE_HIDDEN, WEDGE_SWEEP
    hidden = {"viscous_damping": {"coefficient_N_s_per_m": damping}}
    config = from_document({**rig, "effects": hidden})
    sweep = low, amplitude, "mm", 0.0, True, "transient", "sweep", seconds, high
    options = Options(level=NOISE, input_level=INPUT_NOISE, sampling_hz=rate, noise="white")
    out = folder / f"{seconds:g}"
    synthesize(config, "rig", Plan((PlannedTest(*sweep),), {}, "plan"), options, out, 1)
    return read(out / "measured.toml")


def timed(function: Callable[[], Any]) -> Spent:
    """A second call of a function: the first one compiles."""
    function()
    cpu, wall = process_time(), perf_counter()
    result = function()
    return Spent(result, process_time() - cpu, perf_counter() - wall)


def own_fit(model: Model) -> np.ndarray:
    """Damping and friction by the tool."""
    numbers = {"viscous_damping": {"coefficient_N_s_per_m": 0.1}, "friction_level": {"scale": 1.1}}
    fit = minimise(model, model.evaluate(model.start(None, model.hypothesis.at(numbers))))
    found = fit.values
    return np.array([found["viscous_damping"]["coefficient_N_s_per_m"], found["friction_level"]["scale"]])


def scipy_fit(measurement: Measurement) -> np.ndarray:
    """Damping and friction by least_squares over solve_ivp."""
    test = measurement.tests[0]
    assert test.displacement is not None
    assert test.input is not None
    recorded, time = test.displacement, test.time - test.time[0]
    sections = signal.butter(4, CUTOFF_HZ, fs=test.sampling_rate, output="sos")
    base = CubicSpline(time, signal.sosfiltfilt(sections, test.input)).derivative(2)

    def left(x: np.ndarray) -> np.ndarray:
        damping, level, place, speed, zero = x

        def rate(t: float, y: np.ndarray) -> list[float]:
            dry = level * FRICTION * np.tanh(y[1] / SMOOTHED)
            return [y[1], -(STIFFNESS * y[0] + (DAMPING + damping) * y[1] + dry) / MASS - base(t)]

        run = solve_ivp(rate, (0.0, time[-1]), [place, speed], t_eval=time, rtol=1e-6, atol=1e-8)
        return run.y[0] + zero - recorded

    start = np.array([0.1, 1.1, recorded[0], 0.0, 0.0])
    scale = [0.1, 0.1, 0.01, 0.1, 0.001]
    # A relative step of 0 would be none at all.
    start[3:] = 1e-3, 1e-5
    return least_squares(left, start, x_scale=scale, diff_step=1e-3).x[:2]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=25.0)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--scipy-seconds", type=float, default=5.0)
    parser.add_argument("--wedge", action="store_true")
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        long = measured(Path(folder), given.seconds, given.rate, given.wedge)
        seconds, rate, short_s = given.seconds, given.rate, given.scipy_seconds
        found = timed(lambda: api.diagnose_measurement(long, effects=list(EFFECTS), n_jobs=2))
        named = ", ".join(each["effect"] for each in found.result.causes)
        print(f"A sweep of {seconds:g} s at {rate:g} Hz with its input, all effects, 2 threads (goal: 60 s)")
        print(f"  {found.result.verdict}: {named}; {found.cpu:.1f} s of CPU, {found.wall:.1f} s of wall time")
        if given.wedge:
            return
        short = measured(Path(folder), given.scipy_seconds, given.rate)
        prepared = timed(lambda: Search.of(data_of(short), []).model("viscous_damping", "friction_level"))
        own, other = timed(lambda: own_fit(prepared.result)), timed(lambda: scipy_fit(short))
        print(f"One fit of {short_s:g} s of it        CPU [s]   damping  friction")
        for name, each in (("wedgesweep", own), ("scipy", other)):
            print(f"  {name:24} {each.cpu:8.2f}  {each.result[0]:8.4f}  {each.result[1]:8.4f}")
        print(f"  {'truth':24} {'':8}  {HIDDEN:8.4f}  {1.0:8.4f}")
        print(f"scipy takes {other.cpu / own.cpu:.0f} times as long; before the fit, wedgesweep takes")
        print(f"{prepared.cpu:.2f} s to estimate the noise and to cut the record into windows")


if __name__ == "__main__":
    main()
