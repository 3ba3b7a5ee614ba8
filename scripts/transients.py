"""Both solvers on random transients: python scripts/transients.py [count]; 100 of them take 3 minutes of CPU.

Oscillators and suspensions, all laws, effects, and kinds of input. Radau is the reference: every sample of
the displacement of both must agree to 1e-6 of the largest.
"""

import sys
from dataclasses import replace
from math import pi
from time import process_time
from typing import NamedTuple

import numpy as np

from wedgesweep import config, sampled_input, simulate
from wedgesweep.solvers import periodic
from wedgesweep.solvers.trajectory import CaseError
from wedgesweep.systems import state_count
from wedgesweep.systems.oscillator import parameters as oscillator
from wedgesweep.systems.suspension import parameters as suspension

CLOSE = 1e-6
EFFECTS = (
    {},
    {"cubic_stiffness": {"coefficient_N_per_mm3": 0.02}},
    {"viscous_damping": {"coefficient_N_s_per_m": 8.0}},
    {"presliding": {"length_mm": 0.05}},
    {"directional_friction": {"asymmetry": 0.3}},
    {"end_stop": {"clearance_mm": 3.0, "stiffness_N_per_mm": 8.0}},
)
KINDS = ("sine-sweep", "random", "release")


class Result(NamedTuple):
    """Largest difference of both displacements, over the largest displacement."""

    case: str
    difference: float
    status: str


def sine_and_samples(system):
    """Motion (m) under a sine, and under the same sine known by samples."""
    omega, periods, count = 20.0, 5, 64
    if system == "oscillator":
        body = {"mass": 1.0, "spring": 900.0, "damping": 1.0, "normal_force": 3.0}
        case = oscillator.record("static-dynamic", 3e-3, omega, body)
    else:
        omega *= 3.0
        case = suspension.record("static-dynamic", 3e-3, omega)
    rest = np.zeros((1, state_count()))
    sine = periodic.sampled(case, rest, 0, periods, count, 1e-9).x
    step = 2.0 * pi / omega / count
    given = sampled_input.from_samples(
        3e-3 * np.sin(omega * step * np.arange(2 * periods * count)), step, fastest=omega
    )
    sampled_input.set_sampled(case, given, 3e-3, omega, periods * 2.0 * pi / omega)
    return sine, periodic.sampled(case, rest, 0, 1, periods * count, 1e-9).x


def document(number):
    """Config of a case, as a mapping."""
    generator = np.random.default_rng(number)
    wedge, kind = number % 4 == 0, KINDS[generator.integers(len(KINDS))]
    natural = 13.585 if wedge else float(generator.uniform(2.0, 12.0))
    mass = float(generator.uniform(0.5, 4.0))
    own = {
        "mass_kg": mass,
        "spring_N_per_mm": mass * (2.0 * pi * natural) ** 2 / 1e3,
        "damping_N_s_per_m": float(generator.uniform(0.0, 4.0)),
        "normal_force_N": mass * float(generator.uniform(1.0, 8.0)),
        "contact": ("base", "ground")[generator.integers(2)],
    }
    laws = ("coulomb", "static-dynamic", "exponential")
    effects = EFFECTS[generator.integers(len(EFFECTS))] if generator.random() < 0.6 else {}
    return {
        **({} if wedge else {"oscillator": own}),
        "effects": effects,
        "friction": {"static": 0.32, "dynamic": float(generator.uniform(0.1, 0.32))},
        "input": _input(kind, natural, generator, wedge),
        "sweep": {"friction_law": laws[generator.integers(3)]},
        "solver": {"rtol": 1e-9},
    }


def _input(kind, natural, generator, wedge):
    """A table [input] of about six natural periods."""
    duration = 6.0 / natural
    if kind == "release":
        return {"kind": kind, "displacement_mm": float(generator.uniform(1.0, 8.0)), "duration_s": duration}
    size = "m_per_s2" if wedge or generator.random() < 0.7 else "N"
    level = float(generator.uniform(2.0, 8.0))
    band = {"start_hz": 0.3 * natural, "stop_hz": 2.0 * natural, "duration_s": duration}
    if kind == "sine-sweep":
        return {"kind": kind, f"amplitude_{size}": level, **band}
    return {"kind": "random", f"rms_{size}": level, "seed": int(generator.integers(1000)), **band}


def compared(number):
    """Both solvers on a case."""
    given = config.from_document(document(number))
    case, settings = given.records(), given.solver
    found, status = [], "ok"
    for method, rtol in (("radau", 1e-9), ("event-driven", 1e-10)):
        try:
            chosen = replace(settings, method=method, rtol=rtol, case_timeout=300.0)
            found.append(simulate.transient(case, settings.transient, 1.0, chosen).samples.x)
        except CaseError as error:
            status = error.status
    label = f"{number}: {given.system}, {given.document['sweep']['friction_law'][0]}, " + ", ".join(
        (given.document["input"]["kind"], *given.document["effects"])
    )
    if len(found) < 2:
        return Result(label, 0.0 if not found else np.inf, status)
    return Result(label, float(np.abs(found[0] - found[1]).max() / np.abs(found[0]).max()), status)


def main(count=100):
    """Run and report; whether all agree."""
    began, results = process_time(), []
    for number in range(count):
        results.append(compared(number))
        print(f"{results[-1].difference:9.2e}  {results[-1].status:8}  {results[-1].case}", flush=True)
    apart = [each for each in results if not each.difference < CLOSE]
    print(
        f"{count} transients: largest difference {max(each.difference for each in results):.2e} of the "
        f"displacement, median {np.median([each.difference for each in results]):.1e}; "
        f"{len(apart)} beyond {CLOSE:g}; {process_time() - began:.0f} s of CPU"
    )
    return not apart


if __name__ == "__main__":
    sys.exit(0 if main(*map(int, sys.argv[1:])) else 1)
