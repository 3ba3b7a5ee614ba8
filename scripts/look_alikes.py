"""Recordings like those that people have, made by scipy, and what a diagnosis says of them.

Free swings of a pendulum, an oscillator under a random force without any friction, loops of a damper and of a
spring with play or stiffening, each with a sensor whose zero is somewhere. Prints a table; ``--only NAME``
runs one of them.
"""

import argparse
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from wedgesweep import api
from wedgesweep.diagnosis_result import DiagnosisResult
from wedgesweep.measured import read

GRAVITY = 9.81
# Velocity (m/s) over which dry friction changes its sign in these simulations, and their tolerances.
SMOOTH, RTOL, ATOL = 1e-4, 1e-8, 1e-10
COLUMNS = {
    "swing": 'displacement = { column = "x", unit = "mm", of = "absolute" }\n',
    "random": 'displacement = { column = "x", unit = "mm", of = "absolute" }\n'
    'input = { column = "F", unit = "N", quantity = "force" }\n',
    "loop": 'displacement = { column = "x", unit = "mm" }\nforce = { column = "F", unit = "N" }\n',
}
TESTS = {"swing": 'kind = "transient"\nundriven = true\n', "random": 'kind = "transient"\n'}

# Force (N) of spring and damper at a displacement (m) and a velocity (m/s).
Resistance = Callable[[float, float], float]


@dataclass(frozen=True)
class LookAlike:
    """A measurement: kind of its tests, the model on trial, and columns of each test, time first."""

    kind: str
    model: str
    tests: Sequence[np.ndarray]

    def write(self, folder: Path) -> Path:
        """Write its files; returns the path of measured.toml."""
        (folder / "model.toml").write_text(self.model)
        names = ["t", "x"] if self.kind == "swing" else ["t", "x", "F"]
        text = '[measurement]\nmodel = "model.toml"\n[measurement.columns]\n'
        text += 'time = { column = "t", unit = "s" }\n' + COLUMNS[self.kind]
        for i, table in enumerate(self.tests):
            np.savetxt(folder / f"{i}.csv", table, "%.8g", ",", header=",".join(names), comments="")
            text += f'[[measurement.test]]\nfile = "{i}.csv"\n' + TESTS.get(self.kind, 'kind = "loop"\n')
        (folder / "measured.toml").write_text(text)
        return folder / "measured.toml"


def oscillator(mass: float, stiffness: float, damping: float, friction: float = 0.0) -> str:
    """Config of a mass on a spring over the ground (SI)."""
    return f"""
[oscillator]
mass_kg = {mass}
spring_N_per_mm = {1e-3 * stiffness}
damping_N_s_per_m = {damping}
normal_force_N = {friction}
contact = "ground"
[friction]
dynamic = 1.0
static = 1.0
[sweep]
friction_law = "coulomb"
excitation = "force"
frequency_hz = 1.0
amplitude_N = 1.0
"""


def swing(
    angles_deg: Sequence[float], damping: float, drag: float = 0.0, friction: float = 0.0, noise: float = 5e-3
) -> LookAlike:
    """A pendulum of 0.4 m let go at some angles; damping ratio, drag, and dry friction as an angle."""
    length, mass, rng = 0.4, 0.3, np.random.default_rng(5)
    omega, t = np.sqrt(GRAVITY / length), np.arange(3000) / 100.0

    def rate(_: float, y: np.ndarray) -> list[float]:
        lost = 2.0 * damping * omega * y[1] + drag * abs(y[1]) * y[1]
        return [y[1], -(omega**2) * (np.sin(y[0]) + friction * np.tanh(y[1] / SMOOTH)) - lost]

    tests = []
    for angle in np.radians(angles_deg):
        found = solve_ivp(rate, (0.0, t[-1]), [angle, 0.0], "LSODA", t, rtol=RTOL, atol=ATOL).y[0]
        x = 1e3 * length * (found + noise * angle * rng.standard_normal(t.size)) + 3.0
        tests.append(np.column_stack([t, x]))
    return LookAlike("swing", oscillator(mass, mass * GRAVITY / length, 0.0), tests)


def random_force(rate_hz: float, stiffening: float, drag: float, noise: float) -> LookAlike:
    """An oscillator of 10 Hz without friction under a random force, of two sizes.

    ``stiffening``: force of the cubic spring over that of the linear one at 2 mm; ``drag``: over the linear
    damping at 0.1 m/s.
    """
    mass, omega, rng = 0.5, 20.0 * np.pi, np.random.default_rng(5)
    stiffness, damping = mass * omega**2, 0.1 * mass * omega

    def resisting(x: float, v: float) -> float:
        spring = stiffness * x * (1.0 + stiffening * (x / 2e-3) ** 2)
        return spring + damping * v * (1.0 + drag * abs(v) / 0.1)

    samples = round(20.0 * rate_hz)
    t = np.arange(samples) / rate_hz
    tests = []
    for size in (1.0, 2.0):
        frequency = np.fft.rfftfreq(samples, 1.0 / rate_hz)
        band = (frequency > 0.3) & (frequency < 22.0)
        force = np.fft.irfft(band * np.exp(2j * np.pi * rng.random(band.size)), samples)
        force *= 5e-4 * size * stiffness / force.std()
        x = _driven(force, t, mass, resisting)
        x, seen = (each + noise * each.std() * rng.standard_normal(samples) for each in (1e3 * x, force))
        tests.append(np.column_stack([t, x, seen]))
    return LookAlike("random", oscillator(mass, stiffness, damping), tests)


def _driven(force: np.ndarray, t: np.ndarray, mass: float, resisting: Resistance) -> np.ndarray:
    """Motion (n,) under a force (n,) that has been going on for as long as it is recorded."""
    step, finer = t[1] - t[0], 4
    twice = np.tile(np.fft.irfft(np.fft.rfft(force), finer * force.size) * finer, 2)
    acting = CubicSpline(step / finer * np.arange(twice.size), twice)

    def rate(now: float, y: np.ndarray) -> list[float]:
        return [y[1], (acting(now) - resisting(y[0], y[1])) / mass]

    later = t + t.size * step
    return solve_ivp(rate, (0.0, later[-1]), [0.0, 0.0], t_eval=later, rtol=RTOL, atol=ATOL).y[0]


def damper(asymmetry: float = 0.0, play_mm: float = 0.0, bushing: float = np.inf) -> LookAlike:
    """Sines imposed on a damper with dry friction, whose rod may have play, or be held by a bushing (N/m)."""
    damping, friction, rate, within = 2000.0, 50.0, 500.0, 20
    rng, tests = np.random.default_rng(5), []
    for frequency, amplitude in ((1.0, 20.0), (2.0, 10.0), (0.5, 40.0)):
        fine = np.arange(round(9.0 / frequency * rate) * within) / (rate * within)
        x = amplitude * np.sin(2.0 * np.pi * frequency * fine)
        v = 1e-3 * np.gradient(_behind_play(x, 0.5 * play_mm), fine)
        force = damping * v * (1.0 + asymmetry * np.sign(v)) + friction * np.tanh(v / SMOOTH)
        if bushing < np.inf:
            force = _through_bushing(1e-3 * x, fine[1], bushing, damping, friction)
        x, force = (each[round(rate / frequency) * within :: within] for each in (x, force))
        x = x + 1e-4 * amplitude * rng.standard_normal(x.size)
        force = force + 1e-2 * force.std() * rng.standard_normal(x.size)
        tests.append(np.column_stack([np.arange(x.size) / rate, x, force]))
    return LookAlike("loop", oscillator(1e-3, 0.0, damping, friction), tests)


def _behind_play(x: np.ndarray, half: float) -> np.ndarray:
    """Where (n,) something is that a motion (n,) pushes and pulls through play of ``half`` to either side."""
    found, at = np.empty_like(x), x[0]
    for i, place in enumerate(x):
        found[i] = at = min(max(at, place - half), place + half)
    return found


def _through_bushing(
    x: np.ndarray, step: float, bushing: float, damping: float, friction: float
) -> np.ndarray:
    """Force (n,) on a rod at x (n,) m whose elastic bushing moves a damper, by implicit Euler steps."""
    force, at = np.empty_like(x), x[0]
    for i, place in enumerate(x):
        slack = bushing * (place - at)
        at += np.sign(slack) * max(abs(slack) - friction, 0.0) / (bushing + damping / step)
        force[i] = bushing * (place - at)
    return force


def spring(clearance_mm: float, cubic: float, offset_mm: float) -> LookAlike:
    """Motions imposed on a mass on a spring with play or a cubic part (N/m^3), seen from a shifted zero."""
    mass, stiffness, damping, friction, rate = 2.0, 5000.0, 50.0, 10.0, 500.0
    rng, tests = np.random.default_rng(7), []
    for frequency, amplitude in ((1.0, 0.02), (2.0, 0.01), (0.5, 0.015)):
        t = np.arange(round(8.0 / frequency * rate)) / rate
        tones = ((amplitude, 2.0 * np.pi * frequency, 0.0), (0.2 * amplitude, 0.74 * np.pi * frequency, 1.0))
        x, v, a = (
            sum(size * w**order * np.sin(w * t + phase + 0.5 * np.pi * order) for size, w, phase in tones)
            for order in range(3)
        )
        bent = np.sign(x) * np.maximum(np.abs(x) - 1e-3 * clearance_mm, 0.0)
        force = mass * a + stiffness * bent + cubic * x**3 + damping * v + friction * np.sign(v)
        seen = 1e3 * x + offset_mm + 3e-4 * rng.standard_normal(t.size)
        force += 0.3 + 5e-3 * force.std() * rng.standard_normal(t.size)
        tests.append(np.column_stack([t, seen, force]))
    return LookAlike("loop", oscillator(mass, stiffness, damping, friction), tests)


MADE: dict[str, Callable[[], LookAlike]] = {
    "linear, random force": lambda: random_force(250.0, 0.0, 0.0, 1e-2),
    "stiffening, random force": lambda: random_force(250.0, 0.1, 0.0, 1e-2),
    "stiffening, nine samples a period": lambda: random_force(90.0, 0.1, 0.0, 1e-3),
    "drag, random force": lambda: random_force(250.0, 0.0, 3.0, 1e-2),
    "pendulum from 10 deg": lambda: swing((10.0,), 0.003, noise=1e-2),
    "pendulum from 60 deg": lambda: swing((60.0,), 0.002),
    "pendulum with drag": lambda: swing((40.0, 60.0), 0.002, drag=0.01),
    "pendulum with dry friction": lambda: swing((50.0,), 0.001, friction=0.004),
    "damper": damper,
    "damper that differs by direction": lambda: damper(asymmetry=0.3),
    "damper with play of 1 mm": lambda: damper(play_mm=1.0),
    "damper on a bushing": lambda: damper(bushing=2e5),
    "spring with play": lambda: spring(1.0, 0.0, 0.8),
    "spring that stiffens": lambda: spring(0.0, 4e6, 3.0),
}


def diagnosed(made: LookAlike) -> DiagnosisResult:
    """The diagnosis of a look-alike, whose files are not kept."""
    with tempfile.TemporaryDirectory() as folder:
        return api.diagnose_measurement(read(made.write(Path(folder))), n_jobs=2)


def line(found: DiagnosisResult) -> str:
    """Verdict, causes, and how accurate the base model and the best explanations are."""
    causes = " + ".join(cause["effect"] for cause in found.causes) or "-"
    levels = [
        f"{' + '.join(level['effects']) or 'model on trial'} {level['accuracy']:.2%}"
        for level in found.document["ladder"]
    ]
    return f"{found.verdict}: {causes}; accuracy: {', '.join(levels)}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", action="append", choices=MADE, help="one of them; repeatable")
    for name in parser.parse_args().only or MADE:
        print(f"{name}: {line(diagnosed(MADE[name]()))}", flush=True)
