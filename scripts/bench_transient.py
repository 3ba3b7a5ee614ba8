"""A long ring-down: CPU time of the whole diagnosis, and of one fit beside scipy's over solve_ivp.

    python scripts/bench_transient.py [--seconds 25] [--rate 1000] [--scipy-seconds 5]

The record is made by Radau. The fit has five numbers: friction, damping, start and zero. scipy gets a shorter
record, as it would take minutes for the long one, and friction that is smoothed over a hundredth of the
largest velocity, as solve_ivp does not know of sticking; the ratio is of the same short record.
"""

import argparse
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from wedgesweep import api
from wedgesweep.config import from_document, toml
from wedgesweep.diagnose.diagnosis import data_of
from wedgesweep.diagnose.least_squares import minimise
from wedgesweep.diagnose.search import Search
from wedgesweep.effects import EFFECTS
from wedgesweep.measured import Measurement, read
from wedgesweep.synthesize.campaign import Options, synthesize
from wedgesweep.synthesize.plan import Plan, PlannedTest

MASS, STIFFNESS, DAMPING, FRICTION = 2.0, 500.0, 0.4, 0.3
RIG = {
    "oscillator": {
        "mass_kg": MASS,
        "spring_N_per_mm": 1e-3 * STIFFNESS,
        "damping_N_s_per_m": DAMPING,
        "normal_force_N": 1.0,
    },
    "friction": {"static": FRICTION, "dynamic": FRICTION},
    "sweep": {"friction_law": "coulomb", "beta": 1.0, "amplitude_mm": 1.0},
}
START_MM, HIDDEN = 60.0, 0.3
SMOOTHED = 0.01


def measured(folder: Path, seconds: float, rate: float) -> Measurement:
    """A release with more damping than the model has."""
    hidden = {"viscous_damping": {"coefficient_N_s_per_m": HIDDEN}}
    config = from_document({**RIG, "effects": hidden})
    test = PlannedTest(0.0, 0.0, "mm", 0.0, True, "transient", "release", seconds, None, START_MM)
    options = Options(level=0.005, sampling_hz=rate, noise="white")
    out = folder / f"{seconds:g}"
    synthesize(config, "rig", Plan((test,), {}, "plan"), options, out, 1)
    (folder / "model.toml").write_text(toml.dumps(RIG))
    return read(out / "measured.toml")


def timed(function: Callable[[], Any]) -> tuple[Any, float]:
    """Result and CPU time (s), of the second call: the first one compiles."""
    function()
    begun = process_time()
    return function(), process_time() - begun


def own_fit(measurement: Measurement) -> np.ndarray:
    """Damping and friction by the tool."""
    model = Search.of(data_of(measurement), []).model("viscous_damping", "friction_level")
    numbers = {"viscous_damping": {"coefficient_N_s_per_m": 0.1}, "friction_level": {"scale": 1.1}}
    fit = minimise(model, model.evaluate(model.start(None, model.hypothesis.at(numbers))))
    found = fit.values
    return np.array([found["viscous_damping"]["coefficient_N_s_per_m"], found["friction_level"]["scale"]])


def scipy_fit(measurement: Measurement) -> np.ndarray:
    """Damping and friction by least_squares over solve_ivp."""
    test = measurement.tests[0]
    assert test.displacement is not None
    recorded, time = test.displacement, test.time - test.time[0]
    soft = SMOOTHED * 1e-3 * START_MM * np.sqrt(STIFFNESS / MASS)

    def left(x: np.ndarray) -> np.ndarray:
        damping, level, place, speed, zero = x

        def rate(t: float, y: np.ndarray) -> list[float]:
            dry = level * FRICTION * np.tanh(y[1] / soft)
            return [y[1], -(STIFFNESS * y[0] + (DAMPING + damping) * y[1] + dry) / MASS]

        run = solve_ivp(rate, (0.0, time[-1]), [place, speed], t_eval=time, rtol=1e-6, atol=1e-8)
        return run.y[0] + zero - recorded

    start = np.array([0.1, 1.1, recorded[0], 0.0, 0.0])
    return least_squares(left, start, x_scale=[0.1, 0.1, 0.01, 0.1, 0.001]).x[:2]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=25.0)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--scipy-seconds", type=float, default=5.0)
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        long = measured(Path(folder), given.seconds, given.rate)
        short = measured(Path(folder), given.scipy_seconds, given.rate)
        names = list(EFFECTS)
        found, spent = timed(lambda: api.diagnose_measurement(long, effects=names, n_jobs=1))
        print(f"{given.seconds:g} s at {given.rate:g} Hz, all effects: {found.verdict}, {spent:.1f} s of CPU")
        own, mine = timed(lambda: own_fit(short))
        other, its = timed(lambda: scipy_fit(short))
        print(f"one fit of {given.scipy_seconds:g} s ({'damping':>8} {'friction':>8})")
        print(f"  truth                  {HIDDEN:8.4f} {1.0:8.4f}")
        print(f"  wedgesweep  {mine:8.2f} s {own[0]:8.4f} {own[1]:8.4f}")
        print(f"  scipy       {its:8.2f} s {other[0]:8.4f} {other[1]:8.4f}   {its / mine:.0f} times as long")


if __name__ == "__main__":
    main()
